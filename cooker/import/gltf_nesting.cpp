// SPDX-License-Identifier: MIT
// Computes the depth of JSON without recursion, and counts members.
#include "cooker/import/gltf_nesting.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cooker/import/file_error.h"

namespace boxtree::cooker {
namespace {

using Json = nlohmann::json;

Error fault(std::string what) {
  return {Errc::kImportFailed, std::move(what)};
}

struct JsonShape {
  bool is_too_deep = false;
  std::uint64_t members = 0;  // of all objects, if it is not too deep
};

JsonShape shape_of(std::string_view json) {
  JsonShape shape;
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
      if (++depth > kMaxJsonDepth) {
        shape.is_too_deep = true;
        return shape;
      }
    } else if ((c == '}' || c == ']') && depth > 0) {
      --depth;
    } else if (c == ':') {
      ++shape.members;
    }
  }
  return shape;
}

// Those with a name of their own.
std::uint64_t count_members(const Json& document) {
  std::uint64_t count = 0;
  std::vector<const Json*> values{&document};
  while (!values.empty()) {
    const Json& value = *values.back();
    values.pop_back();
    if (value.is_object()) count += value.size();
    for (const Json& each : value) {
      if (each.is_structured()) values.push_back(&each);
    }
  }
  return count;
}

// Children of each node. Nodes have numbers in glTF 2 and names in glTF 1. Invalid references are
// left to the reader to refuse.
NodeChildren children_of(const Json& nodes) {
  std::map<std::string, std::uint32_t> numbers;
  if (nodes.is_object()) {
    for (const auto& [name, node] : nodes.items()) {
      numbers.emplace(name, static_cast<std::uint32_t>(numbers.size()));
    }
  }
  NodeChildren children(nodes.size());
  std::uint32_t number = 0;
  for (const Json& node : nodes) {
    std::vector<std::uint32_t>& of_node = children[number++];
    const auto listed = node.is_object() ? node.find("children") : node.end();
    if (listed == node.end() || !listed->is_array()) continue;
    for (const Json& child : *listed) {
      if (child.is_number_unsigned() && child.get<std::uint64_t>() < nodes.size()) {
        of_node.push_back(child.get<std::uint32_t>());
      } else if (child.is_string()) {
        const auto found = numbers.find(child.get<std::string>());
        if (found != numbers.end()) of_node.push_back(found->second);
      }
    }
  }
  return children;
}

// Values without effect, up to the first fault.
struct FaultListener : nlohmann::json_sax<Json> {
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(Json::number_integer_t) override { return true; }
  bool number_unsigned(Json::number_unsigned_t) override { return true; }
  bool number_float(Json::number_float_t, const std::string&) override { return true; }
  bool string(std::string&) override { return true; }
  bool binary(Json::binary_t&) override { return true; }
  bool start_object(std::size_t) override { return true; }
  bool key(std::string&) override { return true; }
  bool end_object() override { return true; }
  bool start_array(std::size_t) override { return true; }
  bool end_array() override { return true; }
  bool parse_error(std::size_t position, const std::string&,
                   const nlohmann::detail::exception&) override {
    at = position;
    return false;
  }

  std::optional<std::size_t> at;  // bytes read, the one at fault included
};

// Up to the first name that an object has twice.
struct DuplicateListener : FaultListener {
  bool start_object(std::size_t) override {
    names.emplace_back();
    return true;
  }
  bool key(std::string& name) override {
    if (names.back().insert(name).second) return true;
    twice = name;
    return false;
  }
  bool end_object() override {
    names.pop_back();
    return true;
  }

  std::vector<std::set<std::string>> names;  // of the objects around
  std::string twice;
};

std::string duplicate_in(std::string_view text) {
  DuplicateListener listener;
  Json::sax_parse(text, &listener);
  return listener.twice;
}

}  // namespace

std::string json_fault(std::string_view text) {
  FaultListener listener;
  if (Json::sax_parse(text, &listener) || !listener.at) return {};
  const std::string_view before = text.substr(0, std::max<std::size_t>(*listener.at, 1) - 1);
  if (*listener.at > text.size()) {
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
  const JsonShape shape = shape_of(text);
  if (shape.is_too_deep) {
    return fault(fmt::format("JSON values nest more than {} deep", kMaxJsonDepth));
  }
  Json document = Json::parse(text, nullptr, false);
  if (document.is_discarded()) return document;
  // Of two members of a name this document has the last, and assimp's the first.
  if (count_members(document) != shape.members) {
    return fault(fmt::format("an object of its JSON has two members '{}'", duplicate_in(text)));
  }
  const auto nodes = document.is_object() ? document.find("nodes") : document.end();
  if (nodes == document.end()) return document;
  const auto at_node = find_nesting_fault(children_of(*nodes));
  if (at_node) return fault(fmt::format("node {}: {}", at_node->node, at_node->what));
  return document;
}

Status check_gltf(std::string_view text) {
  const Result<Json> document = parse_gltf(text);
  return document ? Status() : document.error();
}

}  // namespace boxtree::cooker
