// SPDX-License-Identifier: MIT
// Binding codecs: a section of another size than its record says, and packed headers that cannot be
// those of any tree, are refused before a node is read.
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "format/codec_packed.h"
#include "format/codec_plain.h"
#include "format/codec_wide.h"

namespace boxtree {
namespace {

constexpr TreeCounts kThreeNodes{.node_count = 3, .faces_in_leaves = 0};

template <class Codec>
class FixedNodes : public testing::Test {};

using FixedCodecs = testing::Types<PlainCodec<float>, PlainCodec<std::uint16_t>,
                                   WideCodec<Wide4Node>, WideCodec<Wide8Node>>;
TYPED_TEST_SUITE(FixedNodes, FixedCodecs);

TYPED_TEST(FixedNodes, BindOnlyToAsManyBytesAsTheirNumberTakes) {
  constexpr std::size_t kBytes = 3 * sizeof(typename TypeParam::Node);
  const std::vector<std::byte> bytes(kBytes + 1);
  EXPECT_TRUE(TypeParam::bind(kThreeNodes, Bytes(bytes).first(kBytes)).ok());
  EXPECT_EQ(TypeParam::bind(kThreeNodes, Bytes(bytes).first(kBytes - 1)).code(),
            Errc::kSectionSize);
  EXPECT_EQ(TypeParam::bind(kThreeNodes, bytes).code(), Errc::kSectionSize);
  EXPECT_EQ(TypeParam::bind(kThreeNodes, {}).code(), Errc::kSectionSize);
}

// A header of three nodes, two of which are of other kinds than the root.
PackedHeader valid_header(std::uint8_t cut_bits, std::uint32_t cut_count) {
  PackedHeader header{};
  header.node_count = {1, 0, 1, 1};
  header.cut_count = cut_count;
  header.node_bits = 2;
  header.face_bits = 3;
  header.cut_bits = cut_bits;
  return header;
}

template <PackedCut K>
void expect_size_matters(const PackedHeader& header) {
  const std::size_t size = PackedPlaces(header).section_bytes;
  std::vector<std::byte> bytes(size + 1);
  std::memcpy(bytes.data(), &header, sizeof(header));
  EXPECT_TRUE(PackedCodec<K>::bind(kThreeNodes, Bytes(bytes).first(size)).ok());
  EXPECT_EQ(PackedCodec<K>::bind(kThreeNodes, Bytes(bytes).first(size - 1)).code(),
            Errc::kSectionSize);
  EXPECT_EQ(PackedCodec<K>::bind(kThreeNodes, bytes).code(), Errc::kSectionSize);
  EXPECT_EQ(PackedCodec<K>::bind(kThreeNodes, Bytes(bytes).first(sizeof(header) - 1)).code(),
            Errc::kSectionSize);
}

TEST(PackedCodecs, BindOnlyToAsManyBytesAsTheHeaderStates) {
  expect_size_matters<PackedCut::kF16>(valid_header(16, 0));
  expect_size_matters<PackedCut::kF32>(valid_header(32, 0));
  expect_size_matters<PackedCut::kF64>(valid_header(64, 0));
  expect_size_matters<PackedCut::kTable>(valid_header(32, 0));
  expect_size_matters<PackedCut::kTable>(valid_header(2, 3));
}

// Each width for itself, with all others in order.
TEST(PackedHeaders, FieldsOfNumbersHave1To32Bits) {
  for (std::uint8_t PackedHeader::*field : {&PackedHeader::node_bits, &PackedHeader::face_bits}) {
    for (const auto& [bits, expected] : {std::pair(0, Errc::kRecordInvalid),
                                         {1, Errc::kOk},
                                         {32, Errc::kOk},
                                         {33, Errc::kRecordInvalid},
                                         {255, Errc::kRecordInvalid}}) {
      PackedHeader header = valid_header(32, 0);
      header.*field = static_cast<std::uint8_t>(bits);
      EXPECT_EQ(check_packed_header(header, PackedCut::kF32, kThreeNodes).code(), expected) << bits;
    }
  }
}

TEST(PackedHeaders, CutsHaveTheBitsOfTheirKind) {
  struct Case {
    PackedCut cut;
    std::uint8_t bits;
    std::uint32_t count;  // of the table
    Errc expected;
  };
  constexpr Errc kInvalid = Errc::kRecordInvalid;
  for (const Case& at : {Case{PackedCut::kF16, 16, 0, Errc::kOk},
                         {PackedCut::kF16, 15, 0, kInvalid},
                         {PackedCut::kF16, 32, 0, kInvalid},
                         {PackedCut::kF16, 16, 1, kInvalid},
                         {PackedCut::kF32, 32, 0, Errc::kOk},
                         {PackedCut::kF32, 16, 0, kInvalid},
                         {PackedCut::kF32, 33, 0, kInvalid},
                         {PackedCut::kF32, 32, 1, kInvalid},
                         {PackedCut::kF64, 64, 0, Errc::kOk},
                         {PackedCut::kF64, 63, 0, kInvalid},
                         {PackedCut::kF64, 32, 0, kInvalid},
                         {PackedCut::kF64, 64, 1, kInvalid},
                         {PackedCut::kTable, 32, 0, Errc::kOk},
                         {PackedCut::kTable, 16, 0, kInvalid},
                         {PackedCut::kTable, 0, 2, kInvalid},
                         {PackedCut::kTable, 1, 2, Errc::kOk},
                         {PackedCut::kTable, 32, 2, Errc::kOk},
                         {PackedCut::kTable, 33, 2, kInvalid},
                         {PackedCut::kTable, 255, 2, kInvalid}}) {
    EXPECT_EQ(check_packed_header(valid_header(at.bits, at.count), at.cut, kThreeNodes).code(),
              at.expected)
        << static_cast<int>(at.cut) << ": " << int{at.bits} << " bits, table of " << at.count;
  }
}

TEST(PackedHeaders, CountsRootAndReserveAreChecked) {
  const auto check = [](const PackedHeader& header) {
    return check_packed_header(header, PackedCut::kF32, kThreeNodes);
  };
  const PackedHeader valid = valid_header(32, 0);
  EXPECT_TRUE(check(valid).ok());
  for (std::size_t kind = 0; kind < kNodeKinds; ++kind) {
    PackedHeader header = valid;
    ++header.node_count[kind];
    EXPECT_EQ(check(header).code(), Errc::kRecordInvalid) << "one more of kind " << kind;
    header = valid;
    header.root_kind = static_cast<std::uint8_t>(kind);
    EXPECT_EQ(check(header).ok(), valid.node_count[kind] != 0) << "root of kind " << kind;
  }
  PackedHeader header = valid;
  header.root_kind = kNodeKinds;
  EXPECT_EQ(check(header).code(), Errc::kRecordInvalid);
  // Modulo 2^32 these are the three that the record states.
  header = valid;
  header.node_count = {0xffffffffu, 0, 2, 2};
  EXPECT_EQ(check(header).code(), Errc::kRecordInvalid);
  for (std::size_t i = 0; i < valid.reserved.size(); ++i) {
    header = valid;
    header.reserved[i] = 1;
    EXPECT_EQ(check(header).code(), Errc::kRecordInvalid) << "word " << i;
  }
}

}  // namespace
}  // namespace boxtree
