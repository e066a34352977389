// SPDX-License-Identifier: MIT
// XXH3-64 of the amalgamation against xxHash's own: every length around each of its cases, whole,
// in two parts and byte by byte.
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/file/checksum.h"
#include "runtime/file/checksum_stream.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

namespace boxtree {
namespace {

std::vector<std::byte> random_bytes(std::size_t size) {
  std::mt19937 random(7);
  std::vector<std::byte> bytes(size);
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random());
  return bytes;
}

TEST(AmalgamatedChecksum, IsThatOfXxHash) {
  // Two blocks of 1024 bytes and the stripes around them.
  const std::vector<std::byte> bytes = random_bytes(2200);
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const Bytes all(bytes.data(), size);
    const std::uint64_t expected = XXH3_64bits(all.data(), all.size());
    ASSERT_EQ(checksum(all), expected) << size;
    ASSERT_EQ(checksum(all.first(size / 3), all.subspan(size / 3)), expected) << size;
    ASSERT_EQ(checksum(all.first(size - size / 7), all.subspan(size - size / 7)), expected) << size;
  }
}

TEST(AmalgamatedChecksum, OfAStreamHasAValueAfterEveryByte) {
  const std::vector<std::byte> bytes = random_bytes(1200);
  ChecksumStream stream;
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    ASSERT_EQ(stream.value(), XXH3_64bits(bytes.data(), size)) << size;
    stream.add(Bytes(bytes.data() + size, 1));
  }
}

}  // namespace
}  // namespace boxtree
