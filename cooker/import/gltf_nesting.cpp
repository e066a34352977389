// SPDX-License-Identifier: MIT
// Computes the depth of JSON without recursion.
#include "cooker/import/gltf_nesting.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/file_error.h"

namespace boxtree::cooker {
namespace {

Error fault(std::string what) {
  return {Errc::kImportFailed, std::move(what)};
}

// Of text that need not be JSON, which assimp may still read.
bool is_too_deep(std::string_view json) {
  std::uint32_t depth = 0;
  bool in_string = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (in_string) {
      if (c == '\\') ++i;
      in_string = c != '"';
    } else if (c == '"') {
      in_string = true;
    } else if (c == '{' || c == '[') {
      if (++depth > kMaxJsonDepth) return true;
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
  return false;
}

// Children of each node. Nodes have numbers in glTF 2 and names in glTF 1. Invalid references are
// left to the reader to refuse.
NodesBelow children_of(const Json& nodes) {
  std::map<std::string, std::uint32_t> numbers;
  for (const auto& [name, node] : nodes.items()) {
    numbers.emplace(name, static_cast<std::uint32_t>(numbers.size()));
  }
  NodesBelow children(nodes.size());
  std::uint32_t number = 0;
  const auto add = [&](const Json& node) {
    std::vector<std::uint32_t>& of_node = children[number++];
    const Json* const listed = node.find("children");
    if (listed == nullptr) return;
    for (const Json& child : *listed) {
      if (child.is_number_unsigned() && child.get<std::uint64_t>() < nodes.size()) {
        of_node.push_back(child.get<std::uint32_t>());
      } else if (child.is_string()) {
        const auto found = numbers.find(child.get<std::string>());
        if (found != numbers.end()) of_node.push_back(found->second);
      }
    }
  };
  for (const Json& node : nodes) add(node);
  for (const auto& [name, node] : nodes.items()) add(node);
  return children;
}

}  // namespace

std::string json_fault(std::string_view text) {
  const ParsedJson parsed = parse_json(text, kMaxJsonDepth);
  if (parsed.fault == ParsedJson::Fault::kNone || parsed.fault == ParsedJson::Fault::kTooDeep) {
    return {};
  }
  const std::string_view before = text.substr(0, std::max<std::size_t>(parsed.byte, 1) - 1);
  if (parsed.byte > text.size()) {
    return fmt::format("its JSON ends within a value, after {} bytes{}", text.size(), kAsIfCut);
  }
  // JSON itself is ASCII: what is wrong about other bytes, or behind one, is their encoding.
  const std::string_view around = text.substr(before.empty() ? 0 : before.size() - 1, 2);
  const bool is_text =
      std::any_of(around.begin(), around.end(), [](char c) { return (c & 0x80) != 0; });
  return fmt::format("its JSON is {} in line {}, at byte {} of {}", is_text ? "no UTF-8" : "broken",
                     std::count(before.begin(), before.end(), '\n') + 1, before.size(),
                     text.size());
}

Result<Json> parse_gltf(std::string_view text) {
  if (is_too_deep(text)) {
    return fault(fmt::format("JSON values nest more than {} deep", kMaxJsonDepth));
  }
  ParsedJson parsed = parse_json(text, kMaxJsonDepth);
  if (parsed.fault != ParsedJson::Fault::kNone) return Json();
  // Of two members of a name this document has the last, and assimp's the first.
  if (parsed.twice) {
    return fault(fmt::format("an object of its JSON has two members '{}'", *parsed.twice));
  }
  const Json* const nodes = parsed.value.find("nodes");
  if (nodes == nullptr) return std::move(parsed.value);
  const auto at_node = find_nesting_fault(children_of(*nodes));
  if (at_node) return fault(fmt::format("node {}: {}", at_node->node, at_node->what));
  return std::move(parsed.value);
}

}  // namespace boxtree::cooker
