// SPDX-License-Identifier: MIT
// The counter counts what is read, and local questions read little of a large file.
#include "cooker/report/pages.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/bench/generated_mesh.h"
#include "tests/support/cooked.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using test::TempFolder;

constexpr std::size_t kPage = 4096;

std::filesystem::path write(const TempFolder& folder, const std::vector<std::byte>& bytes) {
  return folder.write("tree.bxt", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

TEST(PagesRead, AreThoseThatAreRead) {
  const TempFolder folder;
  const auto path = folder.write("bytes", std::string(9 * kPage + 1, 'x'));
  const auto pages = pages_read(path, [](Bytes file) -> Status {
    const auto read = [&](std::size_t at) { return file[at] == std::byte{'x'}; };
    // Both ends of a page, twice; a page that is not whole.
    const bool all = read(3 * kPage) && read(4 * kPage - 1) && read(3 * kPage) &&
                     read(7 * kPage - 1) && read(9 * kPage);
    return all ? Errc::kOk : Errc::kInternal;
  });
  ASSERT_TRUE(pages.ok()) << pages.error().message();
  EXPECT_EQ(*pages, (std::vector<std::size_t>{3, 6, 9}));
}

TEST(PagesRead, NothingWithoutReading) {
  const TempFolder folder;
  const auto path = folder.write("bytes", std::string(5 * kPage, 'x'));
  const auto pages = pages_read(path, [](Bytes) { return Status(); });
  ASSERT_TRUE(pages.ok());
  EXPECT_TRUE(pages->empty());
}

TEST(PagesRead, ErrorsComeBack) {
  const TempFolder folder;
  const auto path = folder.write("bytes", std::string(kPage, 'x'));
  EXPECT_EQ(pages_read(path, [](Bytes) -> Status { return Errc::kInvalidQuery; }).code(),
            Errc::kInvalidQuery);
  EXPECT_EQ(pages_read(folder.path() / "none", [](Bytes) { return Status(); }).code(),
            Errc::kMapFailed);
}

class ColdFiles : public testing::TestWithParam<test::Encoding> {};

// The promise is 64 pages for 10 M triangles; a level more of a tree is a page or two more.
TEST_P(ColdFiles, LocalQuestionsReadLittle) {
  const SourceMesh mesh = bench::make_city(1'000'000, 1);
  CookOptions options;
  options.geometry = GetParam().geometry;
  options.grid.bits = 20;
  const std::vector<std::byte> bytes = test::cook_bytes(mesh, GetParam().codec, options);
  const TempFolder folder;
  const Result<PageFigures> figures = measure_pages(write(folder, bytes), 0, 200);
  ASSERT_TRUE(figures.ok()) << figures.error().message();
  EXPECT_EQ(figures->file_pages, (bytes.size() + kPage - 1) / kPage);
  EXPECT_GT(figures->file_pages, 1000u);
  EXPECT_LE(figures->open, 3u);  // header and tables at the start, the tree table
  for (const PageCount& count : {figures->ray, figures->box, figures->point}) {
    EXPECT_EQ(count.questions, 200u);
    EXPECT_GT(count.median, figures->open);
    EXPECT_LE(count.median, count.worst);
  }
  EXPECT_LT(figures->ray.worst, 64u);
  EXPECT_LT(figures->box.worst, 64u);
  EXPECT_LT(figures->point.worst, 64u);
}

INSTANTIATE_TEST_SUITE_P(WideCodecs, ColdFiles,
                         testing::Values(test::Encoding{CodecId::kWide4, GeometryId::kExact},
                                         test::Encoding{CodecId::kWide4, GeometryId::kGrid},
                                         test::Encoding{CodecId::kWide8, GeometryId::kExact}),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree::cooker
