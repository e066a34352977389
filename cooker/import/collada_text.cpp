// SPDX-License-Identifier: MIT
// Elements by pugixml, which reads what assimp reads, since it reads by it, too.
#include "cooker/import/collada_text.h"

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

// Assimp's reader takes digits before the point as 64 bits; of more it takes none.
constexpr std::size_t kMaxDigits = 19;

bool is_text_piece(pugi::xml_node node) {
  return node.type() == pugi::node_pcdata || node.type() == pugi::node_cdata;
}

}  // namespace

pugi::xml_node next_element(pugi::xml_node element, pugi::xml_node root) {
  const auto or_later = [](pugi::xml_node node) {
    while (node && node.type() != pugi::node_element) node = node.next_sibling();
    return node;
  };
  if (const pugi::xml_node child = or_later(element.first_child())) return child;
  for (; element && element != root; element = element.parent()) {
    if (const pugi::xml_node next = or_later(element.next_sibling())) return next;
  }
  return {};
}

bool ColladaFaults::fail(std::string_view key, std::string_view expected, std::string_view found,
                         Errc code) {
  if (fault_) return false;
  const std::ptrdiff_t offset = element_.offset_debug();
  const std::string_view before =
      text_.substr(0, offset < 0 ? 0 : static_cast<std::size_t>(offset));
  fault_ =
      Error{code, fmt::format("line {}, {}{}{}{}: expected {}, found {}",
                              std::count(before.begin(), before.end(), '\n') + 1, element_.name(),
                              of_what_, key.empty() ? "" : ": ", key, expected, found)};
  return false;
}

bool ColladaFaults::text(pugi::xml_node element, std::string_view& out) {
  out = {};
  bool has_piece = false;
  for (const pugi::xml_node child : element.children()) {
    if (!is_text_piece(child)) continue;
    if (has_piece) {
      return fail(element.name(), "text in one piece, of which assimp reads the first alone",
                  "a comment or an element in it");
    }
    has_piece = true;
    out = child.value();
  }
  return true;
}

bool ColladaFaults::reference(pugi::xml_node element, const char* key, std::string& out) {
  const std::string_view name = element.attribute(key).as_string();
  const std::string place = fmt::format("{}: {}", element.name(), key);
  if (!name.starts_with('#')) {
    return fail(element == element_ ? key : place, "'#' and an id of this file",
                name.empty() ? "none" : in_quotes(name));
  }
  out = name.substr(1);
  return true;
}

bool ColladaFaults::whole(pugi::xml_node element, const char* key,
                          std::optional<std::uint64_t> otherwise, std::uint64_t& out) {
  const pugi::xml_attribute attribute = element.attribute(key);
  const std::optional<std::uint64_t> number =
      attribute ? read_count(without_blanks(attribute.value())) : otherwise;
  if (!number) {
    const std::string place = fmt::format("{}: {}", element.name(), key);
    return fail(element == element_ ? key : place, "a whole number of 0 or more",
                attribute ? in_quotes(attribute.value()) : "none");
  }
  out = *number;
  return true;
}

Status ColladaFaults::status() const {
  if (fault_) return *fault_;
  return {};
}

std::string in_quotes(std::string_view word) {
  constexpr std::size_t kMost = 40;
  return fmt::format("'{}'{}", word.substr(0, kMost), word.size() > kMost ? "..." : "");
}

std::optional<double> collada_number(std::string_view word) {
  const std::size_t first = std::min(word.find_first_not_of("+-0"), word.size());
  const std::size_t end = std::min(word.find_first_not_of("0123456789", first), word.size());
  if (end - first > kMaxDigits) return std::nullopt;
  if (end == word.size() || word[end] != ',') return read_number<double>(word);
  const bool has_digit = end + 1 < word.size() && word[end + 1] >= '0' && word[end + 1] <= '9';
  if (!has_digit) return std::nullopt;
  std::string with_point(word);
  with_point[end] = '.';
  return read_number<double>(with_point);
}

}  // namespace boxtree::cooker
