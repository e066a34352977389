// SPDX-License-Identifier: MIT
#include "cooker/import/source_stream.h"

#include "cooker/import/source_files.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using SourceStreamTest = ImportTest;

std::string bytes_of(std::size_t count) {
  std::string bytes;
  for (std::size_t i = 0; i < count; ++i) bytes += static_cast<char>(i * i >> 3);
  return bytes;
}

TEST_F(SourceStreamTest, GivesTheBytesAndTheirHash) {
  for (const std::size_t count :
       {std::size_t{1}, SourceStream::kBufferBytes, std::size_t{700'001}}) {
    const std::string bytes = bytes_of(count);
    const std::filesystem::path path = write("a", bytes);
    const std::vector<std::filesystem::path> paths = {path};
    for (const std::size_t step : {std::size_t{1}, std::size_t{13}, SourceStream::kBufferBytes}) {
      auto stream = SourceStream::open(path);
      ASSERT_TRUE(stream.ok());
      std::size_t at = 0;
      while (stream->left() >= step) {
        const char* const got = stream->take(step);
        ASSERT_NE(got, nullptr);
        ASSERT_EQ(std::string_view(got, step), std::string_view(bytes).substr(at, step));
        at += step;
      }
      EXPECT_EQ(stream->left(), count - at);
      EXPECT_EQ(stream->take(step), nullptr) << "and takes nothing";
      EXPECT_EQ(stream->left(), count - at);
      EXPECT_EQ(stream->finish().value(), hash_source_files(paths).value());
    }
  }
}

TEST_F(SourceStreamTest, SkipsAndHashesWhatItSkipped) {
  const std::string bytes = bytes_of(600'000);
  const std::filesystem::path path = write("a", bytes);
  auto stream = SourceStream::open(path);
  ASSERT_TRUE(stream.ok());
  EXPECT_EQ(stream->ahead(), std::string_view(bytes).substr(0, SourceStream::kBufferBytes));
  EXPECT_TRUE(stream->skip(500'000));
  EXPECT_EQ(*stream->take(1), bytes[500'000]);
  EXPECT_FALSE(stream->skip(100'000));
  EXPECT_FALSE(stream->skip(~std::uint64_t{0}));
  const std::vector<std::filesystem::path> paths = {path};
  EXPECT_EQ(stream->finish().value(), hash_source_files(paths).value());
}

TEST_F(SourceStreamTest, FileThatIsShortenedMeanwhile) {
  const std::filesystem::path path = write("a", bytes_of(800'000));
  auto stream = SourceStream::open(path);
  ASSERT_TRUE(stream.ok());
  std::filesystem::resize_file(path, 300'000);
  EXPECT_FALSE(stream->skip(700'000));
  EXPECT_EQ(stream->left(), 300'000 - SourceStream::kBufferBytes);
  EXPECT_EQ(stream->take(SourceStream::kBufferBytes), nullptr);
  EXPECT_TRUE(has(stream->ended_in("face 3").detail, "the file ends in face 3"));
}

TEST_F(SourceStreamTest, FileThatIsNotThere) {
  EXPECT_EQ(SourceStream::open(folder_ / "none").code(), Errc::kFileNotFound);
}

}  // namespace
}  // namespace boxtree::cooker
