// SPDX-License-Identifier: MIT
// Blobs come back bit for bit; bombs, truncated and damaged streams are refused.
#include <algorithm>
#include <cstring>
#include <string>

#include <gtest/gtest.h>

#include <boxtree/blob.h>

#include "format/container.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

class Blobs : public testing::TestWithParam<BlobMethod> {
 protected:
  const std::vector<std::byte> file_ = test::cook_bytes(test::torus(24, 16), CodecId::kPlainF32);
  std::vector<std::byte> blob_ = *make_blob(file_, GetParam());

  // Changes the blob's own header and repairs the checksums around it.
  template <class Change>
  void edit(Change change) {
    const SectionEntry entry = test::sections_of(blob_).front();
    auto header = load<BlobHeader>(blob_.data() + entry.offset);
    change(header);
    std::memcpy(blob_.data() + entry.offset, &header, sizeof(header));
    test::repair_checksums(blob_);
  }
};

TEST_P(Blobs, ComeBackBitForBitAndAnswer) {
  EXPECT_LT(blob_.size(), file_.size());
  const Result<File> opened = open_blob(blob_);
  ASSERT_TRUE(opened.ok()) << opened.error().message();
  EXPECT_TRUE(std::ranges::equal(opened->bytes(), file_));
  const Result<Tree> tree = Tree::bind(*opened);
  ASSERT_TRUE(tree.ok());
  EXPECT_TRUE(closest_hit(*tree, {{1, 0.01, 9}, {0, 0, -1}}).has_value());
  EXPECT_EQ(blob_, *make_blob(file_, GetParam()));
}

TEST_P(Blobs, AreNotMappedAndFilesAreNotBlobs) {
  const Result<File> mapped = File::open(Bytes(blob_));
  EXPECT_EQ(mapped.code(), Errc::kFeatureUnsupported);
  EXPECT_NE(mapped.error().message().find("open_blob()"), std::string::npos);  // the remedy
  EXPECT_EQ(open_blob(file_).code(), Errc::kFeatureUnsupported);
}

TEST_P(Blobs, KeepTheirMemoryLimit) {
  EXPECT_EQ(open_blob(blob_, file_.size() - 1).code(), Errc::kBlobLimit);
  edit([](BlobHeader& header) { header.file_bytes = std::uint64_t{1} << 60; });
  EXPECT_EQ(open_blob(blob_).code(), Errc::kBlobLimit);
}

// The limit is for the file inside and what the decompressor needs besides, to the byte.
TEST(LzmaBlobs, TheDecoderCountsAgainstTheMemoryLimit) {
  const std::vector<std::byte> file = test::cook_bytes(test::torus(24, 16), CodecId::kPlainF32);
  const std::vector<std::byte> blob = *make_blob(file, BlobMethod::kLzma);
  const Result<File> refused = open_blob(blob, file.size());
  ASSERT_EQ(refused.code(), Errc::kBlobLimit);
  const std::string& detail = refused.error().detail;
  const std::string before = "the lzma decoder needs ";
  ASSERT_TRUE(detail.starts_with(before)) << detail;
  const std::uint64_t needed = std::stoull(detail.substr(before.size()));
  EXPECT_TRUE(open_blob(blob, file.size() + needed).ok());
  EXPECT_EQ(open_blob(blob, file.size() + needed - 1).code(), Errc::kBlobLimit);
}

// A bomb states a small size and holds a large one.
TEST_P(Blobs, BombsAreRefused) {
  const std::vector<std::byte> zeros(std::size_t{64} << 20);
  blob_ = *make_blob(zeros, GetParam());
  EXPECT_LT(blob_.size(), 64u << 10);
  edit([](BlobHeader& header) { header.file_bytes = 4096; });
  EXPECT_EQ(open_blob(blob_).code(), Errc::kBlobCorrupt);
  edit([](BlobHeader& header) { header.file_bytes = std::uint64_t{65} << 20; });
  EXPECT_EQ(open_blob(blob_).code(), Errc::kBlobCorrupt);
}

TEST_P(Blobs, EveryTruncationIsRefused) {
  for (std::size_t size = 0; size < blob_.size(); size += 7) {
    ASSERT_FALSE(open_blob(Bytes(blob_).first(size)).ok()) << size;
  }
}

TEST_P(Blobs, EveryFlippedBitIsFound) {
  for (std::size_t i = 0; i < blob_.size(); ++i) {
    const std::byte kept = blob_[i];
    for (int bit = 0; bit < 8; ++bit) {
      blob_[i] = kept ^ std::byte(1u << bit);
      ASSERT_FALSE(open_blob(blob_).ok()) << "byte " << i << ", bit " << bit;
    }
    blob_[i] = kept;
  }
}

TEST_P(Blobs, EveryDamagedByteIsFound) {
  const SectionEntry section = test::sections_of(blob_).front();
  for (std::size_t i = 0; i < blob_.size(); i += 5) {
    const bool may_change = i / 2 == 5 || i / 4 == 5;  // minor version, compatible features
    blob_[i] ^= std::byte{0x10};
    test::repair_checksums(blob_);  // so that the stream's own checks are reached
    const Result<File> opened = open_blob(blob_);
    const bool padding = i >= table_end(1) && i < section.offset;
    const bool tail = i >= section.end();
    if (!may_change && !padding && !tail) {
      ASSERT_TRUE(!opened.ok() || std::ranges::equal(opened->bytes(), file_)) << i;
    }
    blob_[i] ^= std::byte{0x10};
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, Blobs, testing::Values(BlobMethod::kLzma, BlobMethod::kZstd),
                         [](const auto& method) {
                           return method.param == BlobMethod::kLzma ? "Lzma" : "Zstd";
                         });

}  // namespace
}  // namespace boxtree
