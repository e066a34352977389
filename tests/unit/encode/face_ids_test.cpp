// SPDX-License-Identifier: MIT
// Face ids: what is encoded is read back, whatever the order; how many bytes orders take; bytes
// written by hand from docs/FORMAT.md; corrupt bytes are read without leaving the section.
#include "cooker/encode/face_ids.h"

#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "format/face_ids.h"
#include "format/limits.h"
#include "tests/support/face_ids.h"

namespace boxtree::cooker {
namespace {

using test::ascending;
using test::Ids;

Ids decode(Bytes section, std::size_t count) {
  const FaceIdView view(section);
  Ids ids(count);
  for (std::uint32_t i = 0; i < count; ++i) ids[i] = view[i];
  return ids;
}

Ids shuffled(std::uint32_t count) {
  Ids ids = ascending(count);
  std::shuffle(ids.begin(), ids.end(), std::mt19937(count));
  return ids;
}

// A scan: a tree takes squares of 32 by 32 out of rows of `row` faces.
Ids of_scan(std::uint32_t row, std::uint32_t rows) {
  constexpr std::uint32_t kSquare = 32;
  Ids ids;
  for (std::uint32_t y = 0; y < rows; y += kSquare) {
    for (std::uint32_t x = 0; x < row; x += kSquare) {
      for (std::uint32_t i = 0; i < kSquare * kSquare; ++i) {
        ids.push_back((y + i / kSquare) * row + x + i % kSquare);
      }
    }
  }
  return ids;
}

double bits_per_face(const Ids& ids) {
  return 8 * static_cast<double>(test::encoded(ids).size()) / static_cast<double>(ids.size());
}

TEST(FaceIds, OfAnyOrderAreReadBack) {
  for (const std::uint32_t count : {1u, 2u, 7u, 8u, 63u, 64u, 65u, 1023u, 1024u, 1025u, 5000u}) {
    Ids descending = ascending(count);
    std::reverse(descending.begin(), descending.end());
    Ids far = shuffled(count);
    for (std::uint32_t& id : far) id = kMaxFaces - 1 - id * 1000;
    Ids pairs = ascending(count);
    for (std::uint32_t& id : pairs) id /= 2;
    Ids widest(count, 0);
    for (std::uint32_t i = 0; i < count; i += 2) widest[i] = kMaxFaces - 1;
    Ids same(count, kMaxFaces - 1);
    for (const Ids& ids :
         {ascending(count), descending, shuffled(count), far, pairs, widest, same}) {
      EXPECT_EQ(decode(test::encoded(ids), count), ids) << count;
    }
  }
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    Ids ids(1 + random() % 3000);
    std::uint32_t id = 0;
    for (std::uint32_t& next : ids) {
      if (random() % 16 == 0) id = static_cast<std::uint32_t>(random() >> (1 + random() % 24));
      next = std::min(id, kMaxFaces - 1);
      id = next + static_cast<std::uint32_t>(random() % 3);
    }
    EXPECT_EQ(decode(test::encoded(ids), ids.size()), ids) << round;
  }
}

TEST(FaceIds, TakeFewBitsWhereTheSourceHasAnOrder) {
  constexpr std::uint32_t kFaces = 1u << 17;
  constexpr double kTable = 8.0 * sizeof(FaceIdGroup) / kIdGroupFaces;  // 0.6
  EXPECT_LE(bits_per_face(ascending(kFaces)), kTable + 0.2);
  // Leaves in the order of the source, whose faces are reordered: three bits tell eight apart.
  Ids leaves = ascending(kFaces);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < leaves.size(); i += kLeafFaces) {
    const auto first = leaves.begin() + static_cast<std::ptrdiff_t>(i);
    std::shuffle(first, first + kLeafFaces, random);
  }
  EXPECT_LE(bits_per_face(leaves), 3 + kTable + 0.2);
  EXPECT_LE(bits_per_face(of_scan(512, 256)), 8.5);
  // No order at all: hardly more than the 17 bits of a number.
  EXPECT_LE(bits_per_face(shuffled(kFaces)), 17 + kTable + 0.5);
}

// The example of docs/FORMAT.md, section 8.2.
TEST(FaceIds, AreStoredAsSpecified) {
  const Ids ids = {100, 101, 9, 8};
  std::vector<std::byte> expected(12 + kIdUnit + kBitPadding);
  const auto put = [&](std::size_t at, std::initializer_list<unsigned> bytes) {
    for (const unsigned byte : bytes) expected[at++] = static_cast<std::byte>(byte);
  };
  put(0, {8, 0, 0, 0});  // base
  put(4, {3, 0, 0, 0});  // begin: 12 bytes
  // The numbers are 92, 93, 1 and 0. Two intervals of two numbers: starts 0 and 92 of 7 bits.
  // middle 14, offset_bits 1, start_bits 7, interval_bits 1, grain 6
  put(8, {14, 0, 0xe1, 0xc4});
  // start 1 = 92 in bits 0 to 6, start 0 = 0 in bits 7 to 13; then 2 bits a face: 2, 3, 1, 0.
  put(12, {92, 0b10'000000, 0b01'11});
  EXPECT_EQ(test::encoded(ids), expected);
  EXPECT_EQ(decode(expected, 4), ids);
}

TEST(FaceIds, AreThoseOfTheOrderThatIsGiven) {
  SourceMesh mesh;  // ids of its faces are their numbers
  const Ids order = {4, 2, 0, 1, 3};
  EXPECT_EQ(decode(encode_face_ids(mesh, order), 5), order);
  EXPECT_FALSE(is_in_source_order(mesh, order));
  EXPECT_TRUE(is_in_source_order(mesh, ascending(5)));
  EXPECT_TRUE(is_in_source_order(mesh, {}));
  mesh.face_ids = {0, 1, 1, 2};
  EXPECT_FALSE(is_in_source_order(mesh, ascending(4)));
}

// The section lies alone on the heap, where the address sanitizer and valgrind see every read
// outside.
TEST(FaceIds, OfCorruptBytesAreReadInsideTheSection) {
  constexpr std::uint32_t kFaces = 3000;
  std::mt19937 random(3);
  const std::vector<std::byte> valid = test::encoded(shuffled(kFaces));
  for (int round = 0; round < 300; ++round) {
    std::vector<std::byte> section = valid;
    if (round % 3 == 0) section.resize(least_id_bytes(kFaces));
    for (int change = 0; change < 1 + round; ++change) {
      section[random() % section.size()] = static_cast<std::byte>(random());
    }
    section.shrink_to_fit();
    Ids once = decode(section, kFaces);
    EXPECT_EQ(decode(section, kFaces), once);
  }
  for (const int fill : {0x00, 0xff}) {
    const std::vector<std::byte> section(least_id_bytes(kFaces), static_cast<std::byte>(fill));
    EXPECT_EQ(decode(section, kFaces).size(), kFaces);
  }
}

}  // namespace
}  // namespace boxtree::cooker
