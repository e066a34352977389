// SPDX-License-Identifier: MIT
// Distances counted by hand.
#include "cooker/text/nearest_name.h"

#include <array>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

TEST(EditDistance, CountsLettersPutInLeftOutReplacedAndSwapped) {
  EXPECT_EQ(edit_distance("", ""), 0u);
  EXPECT_EQ(edit_distance("query", "query"), 0u);
  EXPECT_EQ(edit_distance("", "info"), 4u);
  EXPECT_EQ(edit_distance("info", ""), 4u);
  EXPECT_EQ(edit_distance("quary", "query"), 1u);
  EXPECT_EQ(edit_distance("cok", "cook"), 1u);
  EXPECT_EQ(edit_distance("coook", "cook"), 1u);
  EXPECT_EQ(edit_distance("verfiy", "verify"), 1u);
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3u);
  EXPECT_EQ(edit_distance("sitting", "kitten"), 3u);
}

TEST(NearestName, IsTheFirstOfThoseWithTheLeastDistance) {
  const std::array<std::string, 3> names = {"cook", "book", "query"};
  EXPECT_EQ(nearest_name("look", names), "cook");
  EXPECT_EQ(nearest_name("quary", names), "query");
  EXPECT_EQ(nearest_name("x", {}), "");
}

TEST(NearestName, OfOneMistakeBeginsAlike) {
  const std::array<std::string, 3> shells = {"bash", "zsh", "fish"};
  EXPECT_EQ(nearest_name("fsh", shells), "fish");
  EXPECT_EQ(nearest_name("zsg", shells), "zsh");
}

TEST(MeantName, IsASynonymOfANameThatThereIsOrANearName) {
  const std::array<std::string, 3> names = {"cook", "point", "query"};
  constexpr std::array<Synonym, 3> kSynonyms = {
      {{"book", "ray"}, {"book", "query"}, {"near", "point"}}};
  EXPECT_EQ(meant_name("book", names), "cook");
  EXPECT_EQ(meant_name("book", names, kSynonyms), "query") << "there is no ray";
  EXPECT_EQ(meant_name("near", names, kSynonyms), "point");
  EXPECT_EQ(meant_name("near", names), "");
  EXPECT_EQ(meant_name("pont", names, kSynonyms), "point");
  EXPECT_EQ(meant_name("book", {}, kSynonyms), "");
}

TEST(NearestInWords, IsTheNearestOrAllOfFewOrNothing) {
  const std::array<std::string, 3> names = {"cook", "book", "query"};
  EXPECT_EQ(nearest_in_words("quary", names), " (nearest: \"query\")");
  EXPECT_EQ(nearest_in_words("zebra", names), " (cook, book or query)");
  EXPECT_EQ(nearest_in_words("zebra", {}), " (there are none)");
  EXPECT_EQ(nearest_in_words("zebra", std::vector<std::string>(33, "query")), "");
}

TEST(Listed, SeparatesTheLastByOr) {
  const std::array<std::string, 3> names = {"cook", "book", "query"};
  EXPECT_EQ(listed(names), "cook, book or query");
  EXPECT_EQ(listed(std::span(names).first(2)), "cook or book");
  EXPECT_EQ(listed(std::span(names).first(1)), "cook");
  EXPECT_EQ(listed({}), "");
}

TEST(Joined, PutsAWordBetween) {
  const std::array<std::string, 3> words = {"", "book", "query"};
  EXPECT_EQ(joined(words), " book query");
  EXPECT_EQ(joined(words, " and "), " and book and query");
  EXPECT_EQ(joined(std::span(words).last(1)), "query");
  EXPECT_EQ(joined({}), "");
}

// Found by a newcomer: "a" was meant to be "5".
TEST(Suggestion, HasSomethingInCommonWithTheName) {
  const std::array<std::string, 2> names = {"5", "ab"};
  EXPECT_EQ(suggestion("a", std::span(names).first(1)), "");
  EXPECT_EQ(suggestion("", std::span(names).first(1)), "");
  EXPECT_EQ(suggestion("a", std::span(names).last(1)), "; did you mean 'ab'?");
}

}  // namespace
}  // namespace boxtree::cooker
