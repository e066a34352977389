// SPDX-License-Identifier: MIT
#include "runtime/file/section.h"

#include <array>

#include <gtest/gtest.h>

#include "format/container.h"

namespace boxtree {
namespace {

constexpr std::array<std::byte, 12> kTwelve{};

TEST(SizedSection, ReturnsItsFirstByte) {
  const auto found = sized_section(kTwelve, SectionKind::kVertices, 3, 4);
  ASSERT_TRUE(found);
  EXPECT_EQ(*found, kTwelve.data());
}

TEST(SizedSection, MayBeAbsentWhereNothingIsNeeded) {
  EXPECT_TRUE(sized_section({}, SectionKind::kVertices, 0, 4));
}

TEST(SizedSection, AbsentNamesTheSection) {
  const auto found = sized_section({}, SectionKind::kVertices, 3, 4);
  EXPECT_EQ(found.code(), Errc::kSectionMissing);
  EXPECT_EQ(found.error().detail, "section vertices is absent");
}

TEST(SizedSection, OfAnotherSizeSaysBothSizes) {
  for (const std::uint64_t count : {std::uint64_t{0}, std::uint64_t{2}, std::uint64_t{4}}) {
    const auto found = sized_section(kTwelve, SectionKind::kCorners, count, 4);
    EXPECT_EQ(found.code(), Errc::kSectionSize);
    EXPECT_NE(found.error().detail.find("section corners: "), std::string::npos);
    EXPECT_NE(found.error().detail.find("12"), std::string::npos);
    EXPECT_NE(found.error().detail.find(std::to_string(4 * count)), std::string::npos);
  }
}

TEST(SectionError, KeepsCodeAndDetail) {
  const Error error = section_error(SectionKind::kNodes, {Errc::kNodeCorrupt, "node #3"});
  EXPECT_EQ(error.code, Errc::kNodeCorrupt);
  EXPECT_EQ(error.detail, "section nodes: node #3");
}

}  // namespace
}  // namespace boxtree
