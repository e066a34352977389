// SPDX-License-Identifier: MIT
// Finds the vertices by the header and rewrites the coordinates line by line.
#include <algorithm>
#include <optional>
#include <string_view>

#include <fmt/format.h>

#include <boxtree/cooker/import/ply_header.h>
#include <boxtree/cooker/import/ply_positions.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

struct Layout {
  std::size_t body = 0;          // where it starts in the file
  std::size_t lines_before = 0;  // of elements before the vertices
  std::size_t vertices = 0;
  std::size_t words = 0;             // of a vertex
  std::array<std::size_t, 3> xyz{};  // which of them are the coordinates
};

std::optional<Layout> find_vertices(std::string_view file) {
  const std::optional<PlyHeader> header = read_ply_header(file);
  if (!header || header->form != PlyHeader::Form::kText) return std::nullopt;
  Layout layout;
  layout.body = header->bytes;
  for (const PlyElement& element : header->elements) {
    if (!element.is_understood || element.has_lists()) return std::nullopt;
    if (element.count > file.size()) return std::nullopt;  // a line is a byte at least
    layout.lines_before += element.count;
    if (element.name != "vertex") continue;
    layout.lines_before -= element.count;
    layout.vertices = element.count;
    layout.words = element.properties.size();
    constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto found =
          std::find_if(element.properties.begin(), element.properties.end(),
                       [&](const PlyProperty& property) { return property.name == kNames[k]; });
      if (found == element.properties.end() || size_of(found->type) < 4) return std::nullopt;
      layout.xyz[k] = static_cast<std::size_t>(found - element.properties.begin());
    }
    return layout;
  }
  return std::nullopt;
}

}  // namespace

bool number_ply_vertices(std::string& file, ExactPositions& exact) {
  const std::optional<Layout> layout = find_vertices(file);
  if (!layout) return false;
  ExactPositions found(exact.precision());
  std::string rewritten = file.substr(0, layout->body);
  rewritten.reserve(file.size());
  std::string_view rest = std::string_view(file).substr(layout->body);
  Tokens tokens;
  for (std::size_t line = 0; line < layout->lines_before + layout->vertices;) {
    if (rest.empty()) return false;
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(end);
    split_tokens(text, tokens);
    if (tokens.empty()) continue;  // assimp passes over empty lines, too
    if (line++ < layout->lines_before) {
      rewritten += text;
      continue;
    }
    if (tokens.size() < layout->words) return false;
    VertexWords words = kOrigin;
    for (std::size_t k = 0; k < 3; ++k) words[k] = tokens[layout->xyz[k]];
    const std::optional<Eigen::Vector3d> position = read_position(words, exact.precision());
    if (!position) return false;
    if (!position->allFinite()) {
      rewritten += text;
      continue;
    }
    const ExactPositions::Number number = found.add(*position);
    std::array<fmt::format_int, 3> digits = {fmt::format_int(number[0]), fmt::format_int(number[1]),
                                             fmt::format_int(number[2])};
    for (std::size_t k = 0; k < 3; ++k) {
      tokens[layout->xyz[k]] = std::string_view(digits[k].data(), digits[k].size());
    }
    for (const std::string_view token : tokens) (rewritten += token) += ' ';
    rewritten.back() = '\n';
  }
  rewritten += rest;
  file = std::move(rewritten);
  exact = std::move(found);
  return true;
}

}  // namespace boxtree::cooker
