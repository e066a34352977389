// SPDX-License-Identifier: MIT
// The counter counts what is read, and local queries read little of a large file.
#include "cooker/report/pages.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "format/codec_packed.h"
#include "tests/bench/generated_mesh.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
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

// A node of a packed codec that is its own children: nothing of it alone is wrong.
TEST(ColdFiles, NodesInACircleEnd) {
  const TempFolder folder;
  std::vector<std::byte> bytes = test::cook_bytes(test::torus(24, 16), CodecId::kPackedF16);
  const SectionEntry nodes = test::entry_of(bytes, SectionKind::kNodes);
  const auto header = load<PackedHeader>(bytes.data() + nodes.offset);
  constexpr auto kInner = static_cast<std::uint8_t>(NodeKind::kNoLeaves);
  ASSERT_EQ(header.root_kind, kInner);
  std::byte* const root = bytes.data() + nodes.offset + PackedPlaces(header).array_at[kInner];
  const PackedLayout layout(NodeKind::kNoLeaves, header);
  std::fill_n(root, (layout.number_at[1] + layout.number_bits[1]) / 8, std::byte{0});
  *root = std::byte{kInner << 2 | kInner << 4};  // axis 0, both children inner nodes, both number 0
  test::repair_checksums(bytes);
  const auto path = write(folder, bytes);
  EXPECT_EQ(measure_pages(path, 0, 4).code(), Errc::kNodeCorrupt);
}

class ColdFileOf : public testing::TestWithParam<test::Encoding> {};

// The promise is 64 pages for 10 M triangles; a level more of a tree is a page or two more.
TEST_P(ColdFileOf, LocalQueriesReadLittle) {
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
    EXPECT_EQ(count.queries, 200u);
    EXPECT_GT(count.median, figures->open);
    EXPECT_LE(count.median, count.worst);
  }
  EXPECT_LT(figures->ray.worst, 64u);
  EXPECT_LT(figures->box.worst, 64u);
  EXPECT_LT(figures->point.worst, 64u);
}

// Nodes that are read ahead are not read by rays, and nothing else is spared them.
TEST_P(ColdFileOf, PrefetchSparesTheFirstRays) {
  const SourceMesh mesh = bench::make_city(100'000, 1);
  CookOptions options;
  options.geometry = GetParam().geometry;
  options.grid.bits = 20;
  const std::vector<std::byte> bytes = test::cook_bytes(mesh, GetParam().codec, options);
  const TempFolder folder;
  const auto figures = measure_first_rays(write(folder, bytes), 0, 200);
  ASSERT_TRUE(figures.ok()) << figures.error().message();
  ASSERT_GT(figures->size(), 4u);
  const FirstRays& without = figures->front();
  EXPECT_EQ(without.levels, 0u);
  EXPECT_EQ(without.nodes, 0u);
  for (std::size_t i = 1; i < figures->size(); ++i) {
    const FirstRays& before = (*figures)[i - 1];
    const FirstRays& first = (*figures)[i];
    EXPECT_EQ(first.levels, i);
    EXPECT_GT(first.nodes, before.nodes);
    EXPECT_GE(first.pages_before, before.pages_before);
    EXPECT_LE(first.pages_more, before.pages_more);
    // A page is read once, by prefetch or by the rays.
    EXPECT_GE(first.pages_before + first.pages_more, without.pages_before + without.pages_more);
  }
  const std::size_t node_pages =
      test::entry_of(bytes, SectionKind::kNodes).size / kPage + 2;  // both ends are shared
  EXPECT_LT(figures->back().pages_more, without.pages_more);
  EXPECT_LE(without.pages_more, figures->back().pages_more + node_pages);
  EXPECT_LE(figures->back().pages_before, without.pages_before + node_pages);
}

INSTANTIATE_TEST_SUITE_P(WideCodecs, ColdFileOf,
                         testing::Values(test::Encoding{CodecId::kWide4, GeometryId::kExact},
                                         test::Encoding{CodecId::kWide4, GeometryId::kGrid},
                                         test::Encoding{CodecId::kWide8, GeometryId::kExact}),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree::cooker
