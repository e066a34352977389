// SPDX-License-Identifier: MIT
// Documents beside those that nlohmann/json builds and prints itself.
#include "cooker/text/json.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace boxtree::cooker {
namespace {

using Library = nlohmann::ordered_json;
using Fault = ParsedJson::Fault;

// The document of Value, either class, with everything that documents of the program are made of.
template <class Value>
Value document() {
  const std::string name = "\xc3\xa9 \"quoted\" \\ \n\x01 \xf0\x9f\x8c\x8d";
  Value json = {{"name", name},
                {"flag", true},
                {"none", nullptr},
                {"int", -3},
                {"least", std::numeric_limits<std::int64_t>::min()},
                {"most", std::numeric_limits<std::uint64_t>::max()},
                {"size", std::size_t{7}},
                {"real", 0.1},
                {"whole", 1.0},
                {"tiny", 5e-324},
                {"large", 1.5e300},
                {"minus_zero", -0.0},
                {"infinite", std::numeric_limits<double>::infinity()},
                {"not_a_number", std::nan("")},
                {"float", 0.1f},
                {"nested", {{"a", {{"b", 1}}}, {"c", {1, 2.5, "three"}}}},
                {"two_numbers", {1, 2}},
                {"of_pairs", {{1, 2}, {3, 4}}},
                {"empty", Value::array()},
                {"empty_object", Value::object()},
                {"listed", Value::array({Value::object(), name})}};
  json["added"]["deep"] = "text";
  json["name_again"] = json["name"];
  json["name"] = "another";
  json["list"].push_back({{"x", 1}});
  json["list"].push_back({json["nested"], json["flag"]});
  json["list"].emplace_back() = 9u;
  Value more = {{"flag", false}, {"more", {{"last", 'x' - 'a'}}}};
  json.update(more);
  return json;
}

TEST(Json, PrintsAsTheLibraryDoes) {
  const Json ours = document<Json>();
  const auto theirs = document<Library>();
  for (const int indent : {-1, 0, 1, 2}) {
    for (const bool ascii : {false, true}) {
      EXPECT_EQ(ours.dump(indent, ascii), theirs.dump(indent, ' ', ascii));
    }
  }
  EXPECT_EQ(Json().dump(), "null");
  EXPECT_EQ(Json("a\xff").dump(), "\"a\xef\xbf\xbd\"");
}

TEST(Json, TakesSequences) {
  EXPECT_EQ(Json::array_of(std::array{0.5f, 1.0f}).dump(), "[0.5,1.0]");
  EXPECT_EQ(Json::array_of(std::array<std::uint32_t, 2>{1, 2}).dump(), "[1,2]");
  EXPECT_EQ(Json::array_of(std::vector<std::string>{"a", "b"}).dump(), R"(["a","b"])");
  EXPECT_EQ(Json::array_of(std::vector<std::string>{}).dump(), "[]");
  EXPECT_EQ((Json{{"all", Json::array_of(std::vector<Json>(2, Json(1)))}}).dump(),
            R"({"all":[1,1]})");
}

TEST(Json, CopiesAndMoves) {
  Json first = document<Json>();
  const std::string text = first.dump();
  Json second = first;
  second["nested"]["a"] = nullptr;
  EXPECT_EQ(first.dump(), text);
  Json third = std::move(first);
  EXPECT_EQ(third.dump(), text);
  third = second;
  EXPECT_EQ(third.dump(), second.dump());
  third = third["nested"];
  EXPECT_EQ(third.dump(), second["nested"].dump());
  Json inner = {{"a", 1}};
  const Json outer = {{"inner", std::move(inner)}, {"end", 2}};
  EXPECT_EQ(outer.dump(), R"({"inner":{"a":1},"end":2})");
}

TEST(Json, TellsWhatItHolds) {
  const Json json = document<Json>();
  EXPECT_EQ(json["most"].get<std::uint64_t>(), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(json["int"].get<double>(), -3);
  EXPECT_EQ(json["size"].get<std::uint32_t>(), 7u);
  EXPECT_EQ(json["real"].get<double>(), 0.1);
  EXPECT_EQ(json["name"].get<std::string>(), "another");
  EXPECT_FALSE(json["flag"].get<bool>());
  EXPECT_TRUE(json["none"].is_null() && json["name"].is_string() && json["real"].is_number_float());
  EXPECT_TRUE(json["two_numbers"].is_array() && json.is_object() && json["int"].is_number());
  EXPECT_TRUE(json["most"].is_number_unsigned() && !json["int"].is_number_unsigned());
  EXPECT_STREQ(json["two_numbers"].type_name(), "array");
  EXPECT_EQ(json.find("nothing"), nullptr);
  EXPECT_EQ(Json(3).find("nothing"), nullptr);
  EXPECT_EQ(json["two_numbers"].back().get<double>(), 2);
  EXPECT_EQ(json["empty"].size() + json["empty_object"].size() + json["none"].size(), 0u);
  double sum = 0;
  for (const Json& each : json["two_numbers"]) sum += each.get<double>();
  EXPECT_EQ(sum, 3);
  EXPECT_EQ(json.items().front().key, "name");
  EXPECT_EQ(json.items().size(), json.size());
}

TEST(ParsedJson, IsWhatTheLibraryReads) {
  const std::string text = document<Library>().dump(2);
  const ParsedJson parsed = parse_json(text);
  EXPECT_EQ(parsed.fault, Fault::kNone);
  EXPECT_EQ(parsed.value.dump(2), text);
  EXPECT_EQ(parsed.keys.size(), parsed.value.size());
  EXPECT_EQ(parse_json("[1, -2, 3.5, \"a\", null, true, {}]").value.dump(),
            R"([1,-2,3.5,"a",null,true,{}])");
  EXPECT_EQ(parse_json(" 7 ").value.get<double>(), 7);
}

TEST(ParsedJson, HasTheLastOfMembersWithOneName) {
  const ParsedJson parsed = parse_json(R"({"a": 1, "b": {"a": 2}, "a": [3]})");
  EXPECT_EQ(parsed.value.dump(), R"({"a":[3],"b":{"a":2}})");
  EXPECT_EQ(parsed.keys, (std::vector<std::string>{"a", "b", "a"}));
}

TEST(ParsedJson, SaysWhereTextIsNoJson) {
  for (const char* text : {"", "{", "[1,]", "{\"a\":1}x", "nul", "\"a", "[\"\xff\"]"}) {
    const ParsedJson parsed = parse_json(text);
    std::size_t byte = 0;
    try {
      ADD_FAILURE() << Library::parse(text);
    } catch (const Library::parse_error& error) {
      byte = error.byte;
    }
    EXPECT_EQ(parsed.fault, Fault::kNoJson) << text;
    EXPECT_EQ(parsed.byte, byte) << text;
    EXPECT_TRUE(parsed.value.is_null());
  }
  EXPECT_EQ(parse_json("[1e999]").fault, Fault::kTooLarge);
}

TEST(ParsedJson, IsAtMostSoDeep) {
  EXPECT_EQ(parse_json("[[1]]", 2).fault, Fault::kNone);
  EXPECT_EQ(parse_json("[[[]]]", 2).fault, Fault::kNone);
  EXPECT_EQ(parse_json("[[[[]]]]", 2).fault, Fault::kTooDeep);
  EXPECT_EQ(parse_json("[[[1]]]", 2).fault, Fault::kTooDeep);
  EXPECT_EQ(parse_json("[[[1]]", 2).fault, Fault::kNoJson);
  const ParsedJson parsed = parse_json(R"({"a": 1, "b": [{"c": 2}], "d": 3})", 1);
  EXPECT_EQ(parsed.fault, Fault::kTooDeep);
  EXPECT_EQ(parsed.keys, (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ(parse_json(std::string(1'000'000, '[')).fault, Fault::kNoJson);
  EXPECT_EQ(parse_json(std::string(1'000'000, '[') + std::string(1'000'000, ']')).fault,
            Fault::kTooDeep);
}

TEST(ParsedJson, HasTheLastOfMembersWithOneNameInThePlaceOfTheFirst) {
  const ParsedJson parsed =
      parse_json(R"({"a": 1, "b": {"x": 1, "x": 2, "x": [3]}, "a": 4, "": 5, "c": 6})");
  EXPECT_EQ(parsed.value.dump(), R"({"a":4,"b":{"x":[3]},"":5,"c":6})");
  EXPECT_EQ(parsed.twice, "x");
  EXPECT_EQ(parsed.keys, (std::vector<std::string>{"a", "b", "a", "", "c"}));
  EXPECT_EQ(parse_json(R"({"a": {"b": 1}, "b": [{"a": 1}, {"a": 2}]})").twice, std::nullopt);
  EXPECT_EQ(parse_json(R"({"": 1, "": 2})").twice, "");
}

// Found by reading: each member was looked for among all before, so that a glTF file of 2 MB took
// half a minute to reorder, and one of 20 MB an hour.
TEST(ParsedJson, MayHaveVeryManyMembers) {
  constexpr std::uint64_t kMany = 300'000;
  std::string text = "{";
  for (std::uint64_t i = 0; i < kMany; ++i)
    text += "\"k" + std::to_string(i * 7919 % kMany) + "\":" + std::to_string(i) + ",";
  Json value = parse_json(text + "\"last\":7}").value;
  EXPECT_EQ(value.size(), kMany + 1);
  const auto expect_all = [&] {
    for (std::uint64_t i = 0; i < kMany; ++i) {
      const Json* const found = value.find("k" + std::to_string(i * 7919 % kMany));
      ASSERT_TRUE(found != nullptr && found->get<std::uint64_t>() == i);
    }
  };
  expect_all();
  EXPECT_EQ(value.find("k"), nullptr);
  EXPECT_EQ(value.find("k" + std::to_string(kMany)), nullptr);
  EXPECT_EQ(value.items().front().key, "k0");
  EXPECT_EQ(value.items().back().key, "last");
  for (int i = 0; i < 1000; ++i) value["added " + std::to_string(i)] = i;
  value["last"] = 8;
  expect_all();
  EXPECT_EQ(value["last"].get<std::uint32_t>(), 8u);
  EXPECT_EQ(value["added 999"].get<std::uint32_t>(), 999u);
  EXPECT_EQ(value.size(), kMany + 1001);
}

// With as many members as are compared one by one, and one more.
TEST(JsonObjects, FindTheirMembersHoweverManyThereAre) {
  Json value = Json::object();
  for (int count = 0; count < 40; ++count) {
    EXPECT_EQ(value.find("k" + std::to_string(count)), nullptr);
    value["k" + std::to_string(count)] = count;
    const Json copy = value;
    for (int i = 0; i <= count; ++i) {
      const std::string name = "k" + std::to_string(i);
      ASSERT_NE(copy.find(name), nullptr);
      EXPECT_EQ(copy.find(name)->get<std::uint32_t>(), static_cast<std::uint32_t>(i));
    }
  }
  EXPECT_EQ(value.items().back().key, "k39");
}

}  // namespace
}  // namespace boxtree::cooker
