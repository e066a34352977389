// SPDX-License-Identifier: MIT
// Texts that toml++ crashes on are refused before it sees them, and no others.
#include "cooker/scene/toml_checks.h"

#include <functional>
#include <string>

#include <gtest/gtest.h>

#include "cooker/scene/toml_tree.h"

namespace boxtree::cooker {
namespace {

// "LINE: WHAT", or nothing.
std::string fault(std::string_view text) {
  const auto found = find_unreadable_toml(text);
  return found ? std::to_string(found->line) + ": " + found->what : "";
}

std::string key_of(std::size_t parts) {
  std::string key = "a";
  for (std::size_t i = 1; i < parts; ++i) key += ".a";
  return key;
}

constexpr const char* kTooManyParts = "a key of more than 64 parts";
constexpr const char* kUnclosed = "the name of a table has to end on its line, by ']'";

TEST(TomlChecks, KeysOfManyPartsAreRefused) {
  using Text = std::function<std::string(const std::string& key)>;
  for (const Text& text : std::initializer_list<Text>{
           [](const std::string& key) { return key + " = 1\n"; },
           [](const std::string& key) { return "[" + key + "]\n"; },
           [](const std::string& key) { return "[[" + key + "]]\n"; },
           [](const std::string& key) { return "x = { " + key + " = 1 }\n"; },
           [](const std::string& key) {
             return "x = [ { y = 1 }, { " + key + " = 1 },\n 2 ]\n";
           }}) {
    EXPECT_EQ(fault(text(key_of(64))), "");
    EXPECT_TRUE(parse_toml(text(key_of(64)), "t").ok()) << text(key_of(64));
    EXPECT_EQ(fault(text(key_of(65))), std::string("1: ") + kTooManyParts);
    EXPECT_EQ(parse_toml(text(key_of(20000)), "t").error().detail,
              std::string("t:1: ") + kTooManyParts);
  }
  EXPECT_EQ(fault("\n\n" + key_of(65)), std::string("3: ") + kTooManyParts);
}

TEST(TomlChecks, NamesOfTablesEndOnTheirLine) {
  EXPECT_EQ(fault("[[\nob"), std::string("1: ") + kUnclosed);
  EXPECT_EQ(fault("x = 1\n[mesh\n]\n"), std::string("2: ") + kUnclosed);
  EXPECT_EQ(fault("[["), std::string("1: ") + kUnclosed);
  EXPECT_EQ(fault("[mesh # ]\n"), std::string("1: ") + kUnclosed);
  EXPECT_EQ(fault("['a]\nb = 1\n"), std::string("1: ") + kUnclosed);
  EXPECT_EQ(parse_toml("[[\nob", "t").code(), Errc::kProfileInvalid);
}

// Found by the fuzzer: toml++ takes a quote behind a bare word for a part of it, and then looks at
// what the quotes hold, where characters beyond ASCII lead it to undefined behaviour.
TEST(TomlChecks, StringsStandByThemselves) {
  const std::string beside = ": a string stands by itself, not beside a word or another string";
  EXPECT_EQ(fault("e = [7\":..\"St\"\xcb\x9c"), "1" + beside);
  EXPECT_EQ(fault("a = 1\nb = 7'x'\n"), "2" + beside);
  EXPECT_EQ(fault("a\"b\" = 1\n"), "1" + beside);
  EXPECT_EQ(fault("a = {b = [1], c = 1979$0c.\"d\xc5\x85"), "1" + beside);
  EXPECT_EQ(fault("a = 1.'b'\n"), "1" + beside);
  EXPECT_EQ(fault("a = [1.\"b\"]\n"), "1" + beside);
  EXPECT_EQ(fault("a = \"b\"'c'\n"), "1" + beside);
  EXPECT_EQ(fault("a = [1]\"c\"\n"), "1" + beside);
  for (const std::string text :
       {"\"a\" = 1\n", "\xef\xbb\xbf'a' = 1\n", "a.'b'.\"c\" = 1\n", "['a'.\"b\"]\n",
        "a=['b',\"c\"]\n", "a={'b'='c',\"d\"=1}\n", "a = {b.\"c\" = 1, d.'e' = [{f.\"g\" = 2}]}\n",
        "a = \"\"\"b\"\"\"\"\n", "a = '''b'''''\nc = 'd'\n", "a = [\n\t'b',\r\n'c']\n"}) {
    EXPECT_EQ(fault(text), "") << text;
    EXPECT_TRUE(parse_toml(text, "t").ok()) << text;
  }
}

TEST(TomlChecks, OtherTextsAreLeftToTheParser) {
  const std::string dots(1000, '.');
  for (const std::string& text :
       {std::string(), std::string("[mesh]\nname = 'a.b.c'\n"), "name = \"" + dots + "\"\n",
        "name = '" + dots + "'\n", "name = \"\"\"\n" + dots + "\n\"\"\"\n",
        "name = '''\n[\n" + dots + "'''\n", "name = \"\\\"" + dots + "\" # " + dots + "\n",
        "# " + dots + "\n", std::string("pose = [\n[1.5, 2.5],\n[3.5, 4.5]\n]\n[mesh]\n"),
        std::string("x = [\n  [1],\n]\ny = { a.b = 1, c.d = 2.5 }\n"),
        std::string("'[quoted' = 1\n\"]\" = 2\n"),
        std::string("[mesh] # a comment\n[[object]]\n")}) {
    EXPECT_EQ(fault(text), "") << text;
    EXPECT_TRUE(parse_toml(text, "t").ok()) << text;
  }
  for (const char* text : {"name = \"no end\n[mesh]\n", "x = [[[\n", "]]\n", "x = }\n", "= 1\n",
                           "name = \"\"\"no end", "a b = 1\n", "\"\\", "'''"}) {
    EXPECT_EQ(fault(text), "") << text;
    EXPECT_FALSE(parse_toml(text, "t").ok()) << text;
  }
}

// Found by fuzzing profiles: undefined behaviour in the tables of toml++.
TEST(TomlChecks, CharactersBeyondAsciiStandInQuotesOrComments) {
  EXPECT_FALSE(find_unreadable_toml("\xef\xbb\xbf# W\xc3\xbcrfel\n\"\xcd\xb8\" = '\xcd\xb8'\n"));
  for (const std::string_view text :
       {"a = 1\nrotati\xcd\xb8 = 1\n", "\n\xff", "a = 1\nb = \xc3\xbc\n"}) {
    const auto found = find_unreadable_toml(text);
    ASSERT_TRUE(found.has_value()) << text;
    EXPECT_EQ(found->what, "characters beyond ASCII stand in quotes or comments");
    EXPECT_EQ(found->line, text[0] == '\n' || text[0] == 'a' ? 2u : 1u);
  }
}

}  // namespace
}  // namespace boxtree::cooker
