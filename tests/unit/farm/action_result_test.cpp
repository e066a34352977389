// SPDX-License-Identifier: MIT
// Entries in the wire format of protocol buffers: bytes that protoc agrees with, and nothing of any
// others.
#include "cooker/farm/action_result.h"

#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/unit/farm/cache_values.h"

namespace boxtree::cooker {
namespace {

using test::kKey;
const CookCache::Entry kEntry{sha256_of("output"), 300, "[\"a warning\"]"};

void expect_entry(const std::string& bytes) {
  const auto entry = entry_in_action_result(bytes, kKey);
  ASSERT_TRUE(entry);
  EXPECT_EQ(entry->output, kEntry.output);
  EXPECT_EQ(entry->bytes, kEntry.bytes);
  EXPECT_EQ(entry->report, kEntry.report);
}

// Byte by byte from the specifications: tags are 8 * field + type.
TEST(ActionResult, IsTheMessageOfTheRemoteExecutionApi) {
  const std::string bytes = action_result_of(kKey, kEntry);
  expect_entry(bytes);
  const std::string name = hex_of(sha256_of("boxtree cache 1\n" + hex_of(kKey) + "\n" +
                                            hex_of(kEntry.output) + "\n300\n" + kEntry.report)) +
                           ".bxt";
  const std::string digest = std::string("\x0a\x40") + hex_of(kEntry.output) + "\x10\xac\x02";
  const std::string file = std::string("\x0a\x44") + name + "\x12\x45" + digest;
  ASSERT_EQ(digest.size(), 0x45u);
  ASSERT_EQ(file.size(), 0x8du);
  EXPECT_EQ(bytes, std::string("\x12\x8d\x01") + file + "\x3a\x0d" + kEntry.report);
}

TEST(ActionResult, LargeNumbersAndEmptyReports) {
  for (const std::uint64_t size : {std::uint64_t{0}, std::uint64_t{127}, std::uint64_t{128},
                                   (std::uint64_t{1} << 63) - 1, ~std::uint64_t{0}}) {
    const auto entry =
        entry_in_action_result(action_result_of(kKey, {sha256_of("o"), size, ""}), kKey);
    ASSERT_TRUE(entry) << size;
    EXPECT_EQ(entry->bytes, size);
    EXPECT_EQ(entry->report, "");
  }
}

// As bazel-remote, which adds the worker that has put it (field 9), and others that order fields in
// another way.
TEST(ActionResult, AServerMayWriteItAnew) {
  const std::string bytes = action_result_of(kKey, kEntry);
  const std::size_t report = bytes.size() - kEntry.report.size() - 2;
  expect_entry(bytes + std::string("\x4a\x06\x0a\x04host"));
  expect_entry(bytes.substr(report) + bytes.substr(0, report));
  expect_entry(std::string("\x20\0", 2) + bytes);  // exit_code, 0
  expect_entry(bytes +
               "\x79"
               "12345678"
               "\x7d"
               "1234"
               "\x78\x01");  // none of ours
}

TEST(ActionResult, OfAnotherKeyIsNone) {
  EXPECT_FALSE(entry_in_action_result(action_result_of(kKey, kEntry), sha256_of("other")));
}

// A field that is begun; it was taken for the end.
TEST(ActionResult, HalfAFieldBehindItIsNone) {
  for (const char* half : {"x", "\x80", "\x3a",
                           "\x3a\x05"
                           "four",
                           "\x7d"
                           "123",
                           "\x7b\x01", "\x7e\x01"}) {
    EXPECT_FALSE(entry_in_action_result(action_result_of(kKey, kEntry) + half, kKey)) << half;
  }
}

TEST(ActionResult, EveryTruncationAndEveryFlippedBitIsNone) {
  const std::string bytes = action_result_of(kKey, kEntry);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_FALSE(entry_in_action_result(bytes.substr(0, size), kKey)) << size;
  }
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    std::string flipped = bytes;
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
    EXPECT_FALSE(entry_in_action_result(flipped, kKey)) << bit;
  }
}

TEST(ActionResult, RandomBytesAreNone) {
  std::mt19937 random(25);
  const std::string good = action_result_of(kKey, kEntry);
  for (int i = 0; i < 20000; ++i) {
    std::string bytes(random() % 200, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random() % (i % 2 == 0 ? 256 : 32));
    EXPECT_FALSE(entry_in_action_result(bytes, kKey));
    std::string changed = good;
    for (int k = 0; k < 3; ++k) changed[random() % changed.size()] = static_cast<char>(random());
    EXPECT_TRUE(changed == good || !entry_in_action_result(changed, kKey));
  }
  for (const char* text :
       {"", "<html>", "boxtree cache 1 ", "\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff\xff",
        "\x12\xff\xff\xff\xff\xff\xff\xff\xff\xff\x01"}) {
    EXPECT_FALSE(entry_in_action_result(text, kKey)) << text;
  }
}

}  // namespace
}  // namespace boxtree::cooker
