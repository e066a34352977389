// SPDX-License-Identifier: MIT
// Converts values parsed by toml++. Values nest at most TOML_MAX_NESTED_VALUES deep, which bounds
// the recursion.
#include <algorithm>

#define TOML_HEADER_ONLY 1
#define TOML_EXCEPTIONS 0
#define TOML_ENABLE_FORMATTERS 0
#define TOML_MAX_NESTED_VALUES 64
#include <fmt/format.h>
#include <toml++/toml.h>

#include "cooker/scene/toml_checks.h"
#include "cooker/scene/toml_tree.h"

namespace boxtree::cooker {
namespace {

constexpr std::size_t kLongestShown = 40;  // characters of a text in a message

TomlTable table_of(const toml::table& source);

TomlNode node_of(const toml::node& source) {
  TomlNode node;
  node.line = source.source().begin.line;
  if (const auto* flag = source.as_boolean()) {
    node.value = flag->get();
  } else if (const auto* integer = source.as_integer()) {
    node.value = integer->get();
  } else if (const auto* number = source.as_floating_point()) {
    node.value = number->get();
  } else if (const auto* text = source.as_string()) {
    node.value = text->get();
  } else if (const auto* array = source.as_array()) {
    TomlArray elements;
    elements.reserve(array->size());
    for (const toml::node& element : *array) elements.push_back(node_of(element));
    node.value = std::move(elements);
  } else if (const auto* table = source.as_table()) {
    node.value = table_of(*table);
  }
  return node;
}

TomlTable table_of(const toml::table& source) {
  TomlTable table;
  table.reserve(source.size());
  for (const auto& [key, value] : source) {
    table.push_back({std::string(key.str()), key.source().begin.line, node_of(value)});
  }
  std::stable_sort(table.begin(), table.end(),
                   [](const TomlEntry& a, const TomlEntry& b) { return a.line < b.line; });
  return table;
}

struct Shown {
  std::string operator()(TomlDate) const { return "a date or time"; }
  std::string operator()(bool flag) const { return flag ? "true" : "false"; }
  std::string operator()(std::int64_t number) const { return fmt::format("{}", number); }
  std::string operator()(double number) const { return fmt::format("{}", number); }
  std::string operator()(const std::string& text) const {
    if (text.size() <= kLongestShown) return '"' + text + '"';
    std::size_t end = kLongestShown;  // not inside a multi-byte character
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0) == 0x80) --end;
    return '"' + text.substr(0, end) + "\"...";
  }
  std::string operator()(const TomlArray& array) const {
    return fmt::format("an array of {}", array.size());
  }
  std::string operator()(const TomlTable&) const { return "a table"; }
};

}  // namespace

Result<TomlTable> parse_toml(std::string_view text, std::string_view path) {
  if (const auto fault = find_unreadable_toml(text)) {
    return Error{Errc::kProfileInvalid, fmt::format("{}:{}: {}", path, fault->line, fault->what)};
  }
  const toml::parse_result parsed = toml::parse(text);
  if (!parsed) {
    const toml::parse_error& error = parsed.error();
    const std::string_view what = error.description();
    // A word that stands for a value; it may begin as nan, inf, true or false do.
    const bool is_no_value = what.find("could not determine value type") != what.npos ||
                             what.find("parsing floating-point: expected '") != what.npos ||
                             what.find("parsing boolean") != what.npos;
    return Error{
        Errc::kProfileInvalid,
        fmt::format("{}:{}: {}{}", path, error.source().begin.line, what,
                    is_no_value ? "; a text stands in quotes, and a flag is true or false" : "")};
  }
  return table_of(parsed.table());
}

std::string shown(const TomlNode& node) {
  return std::visit(Shown(), node.value);
}

}  // namespace boxtree::cooker
