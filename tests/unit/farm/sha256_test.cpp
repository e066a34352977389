// SPDX-License-Identifier: MIT
// SHA-256 of the examples of FIPS 180-4, in parts and of files.
#include "cooker/farm/sha256.h"

#include <string>

#include <gtest/gtest.h>

#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

TEST(Sha256, IsThatOfTheStandard) {
  EXPECT_EQ(hex_of(sha256_of("abc")),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex_of(sha256_of("")),
            "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  Sha256 in_parts;
  for (int i = 0; i < 1000; ++i) in_parts.add(std::string(1000, 'a'));
  EXPECT_EQ(hex_of(in_parts.finish()),
            "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Sha256, OfAFile) {
  const test::TempFolder folder;
  EXPECT_EQ(test::require(sha256_of_file(folder.write("f", "abc"))), sha256_of("abc"));
  EXPECT_EQ(sha256_of_file(folder.path() / "absent").code(), Errc::kFileNotFound);
}

TEST(Sha256, HexadecimalDigitsAreReadAsTheyAreWritten) {
  const Digest digest = sha256_of("abc");
  const std::string hex = hex_of(digest);
  EXPECT_EQ(digest_of(hex), digest);
  EXPECT_FALSE(digest_of(hex.substr(1)));
  EXPECT_FALSE(digest_of(hex + "0"));
  for (const char wrong : {'G', 'A', '-', '+', ' ', '\0'}) {
    std::string other = hex;
    other[10] = wrong;
    EXPECT_FALSE(digest_of(other)) << wrong;
  }
}

}  // namespace
}  // namespace boxtree::cooker
