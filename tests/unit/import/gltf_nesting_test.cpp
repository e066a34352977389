// SPDX-License-Identifier: MIT
// glTF files that nest without end are refused before assimp sees them, and no others.
#include "cooker/import/gltf_nesting.h"

#include <string>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

std::string fault(const std::string& json) {
  const Result<Json> document = parse_gltf(json);
  return document.ok() ? "" : document.error().detail;
}

std::string nested(std::size_t depth) {
  return R"({"extras":)" + std::string(depth, '[') + std::string(depth, ']') + "}";
}

// Nodes each of which has the next `children` times below itself.
std::string chain(std::size_t nodes, std::size_t children) {
  std::string json = R"({"nodes":[)";
  for (std::size_t i = 0; i < nodes; ++i) {
    json += i == 0 ? "{" : ",{";
    for (std::size_t child = 0; child < children && i + 1 < nodes; ++child) {
      json += child == 0 ? R"("children":[)" : ",";
      json += std::to_string(i + 1);
      if (child + 1 == children) json += "]";
    }
    json += "}";
  }
  return json + "]}";
}

TEST(GltfNesting, JsonHasADepth) {
  EXPECT_EQ(fault(nested(kMaxJsonDepth - 1)), "");
  EXPECT_EQ(fault(nested(kMaxJsonDepth)), "JSON values nest more than 256 deep");
  EXPECT_EQ(fault(nested(20000)), "JSON values nest more than 256 deep");
  const std::string brackets(1000, '[');
  EXPECT_EQ(fault(R"({"name":")" + brackets + R"("})"), "");
  EXPECT_EQ(fault(R"({"name":"\")" + brackets + R"("})"), "");
  EXPECT_EQ(fault("{"), "");  // for the reader to refuse
}

// Assimp took the first, and what checks the document the last.
TEST(GltfNesting, NoMemberComesTwice) {
  EXPECT_EQ(fault(R"({"nodes":[{"mesh":0,"translation":[5,0,0],"translation":[7,0,0]}]})"),
            "an object of its JSON has two members 'translation'");
  EXPECT_EQ(fault(R"({"a:b":"c:d","x":{"a:b":{}},"y":[{"x":":"}],"z":[[{"x":1}]]})"), "");
}

TEST(GltfNesting, NodesHaveADepth) {
  EXPECT_EQ(fault(chain(kMaxNodeDepth, 1)), "");
  EXPECT_EQ(fault(chain(kMaxNodeDepth + 1, 1)), "node 1024: more than 1024 nodes below each other");
  EXPECT_NE(fault(chain(200000, 1)), "");
}

TEST(GltfNesting, SharedNodesAreCountedForEachOfTheirParents) {
  EXPECT_EQ(fault(chain(18, 2)), "");
  EXPECT_EQ(fault(chain(40, 2)),
            "node 18: shared by so many parents that more than 262184 instances arise");
}

TEST(GltfNesting, ManyNodesOfTheirOwnAreNoFault) {
  std::string json = R"({"nodes":[{})";
  for (int i = 0; i < 400000; ++i) json += ",{}";
  EXPECT_EQ(fault(json + "]}"), "");
}

TEST(GltfNesting, NodesAreNotBelowThemselves) {
  EXPECT_EQ(fault(R"({"nodes":[{"children":[0]}]})"), "node 0: it is below itself");
  EXPECT_EQ(fault(R"({"nodes":[{},{"children":[2]},{"children":[3]},{"children":[1]}]})"),
            "node 1: it is below itself");
}

// Names in place of numbers; messages count nodes in the order of the file.
TEST(GltfNesting, Version1IsLookedAtLikewise) {
  EXPECT_EQ(fault(R"({"nodes":{"a":{"children":["b"]},"b":{"children":["a"]}}})"),
            "node 0: it is below itself");
  EXPECT_EQ(fault(R"({"nodes":{"a":{"children":["b","c"]},"b":{"children":["c"]},"c":{}}})"), "");
}

TEST(GltfNesting, WhatNamesNoNodeIsLeftToTheReader) {
  for (const char* json :
       {R"({"nodes":[{"children":[9,-1,1.5,"x",null]}]})", R"({"nodes":[1,[],null]})",
        R"({"nodes":7})", R"([])", R"({"nodes":{"a":[]}})", ""}) {
    EXPECT_EQ(fault(json), "") << json;
  }
}

}  // namespace
}  // namespace boxtree::cooker
