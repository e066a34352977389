// SPDX-License-Identifier: MIT
// Finds the vertices by the header (Turk, "The PLY Polygon File Format", 1994) and rewrites their
// coordinates where they stand.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boxtree/cooker/import/ply_positions.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

enum class Type { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

std::optional<Type> type_of(std::string_view name) {
  if (name == "char" || name == "int8") return Type::kInt8;
  if (name == "uchar" || name == "uint8") return Type::kUint8;
  if (name == "short" || name == "int16") return Type::kInt16;
  if (name == "ushort" || name == "uint16") return Type::kUint16;
  if (name == "int" || name == "int32") return Type::kInt32;
  if (name == "uint" || name == "uint32") return Type::kUint32;
  if (name == "float" || name == "float32") return Type::kFloat32;
  if (name == "double" || name == "float64") return Type::kFloat64;
  return std::nullopt;
}

std::size_t size_of(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUint8:
      return 1;
    case Type::kInt16:
    case Type::kUint16:
      return 2;
    case Type::kInt32:
    case Type::kUint32:
    case Type::kFloat32:
      return 4;
    case Type::kFloat64:
      break;
  }
  return 8;
}

struct Property {
  std::string_view name;
  Type type;
};

struct Layout {
  enum class Form { kText, kLittleEndian, kBigEndian } form = Form::kText;
  std::size_t body = 0;          // where it starts in the file
  std::size_t lines_before = 0;  // text: of elements before the vertices
  std::size_t bytes_before = 0;  // binary: likewise
  std::size_t vertices = 0;
  std::vector<Property> properties;  // of a vertex
  std::array<std::size_t, 3> xyz{};  // their places among the properties
};

std::optional<std::size_t> to_count(std::string_view token) {
  std::size_t count = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), count);
  if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return count;
}

// Adds up one element that stands before the vertices.
void skip_element(std::size_t count, const std::vector<Property>& properties, Layout& layout) {
  std::size_t bytes = 0;
  for (const Property& property : properties) bytes += size_of(property.type);
  layout.lines_before += count;
  layout.bytes_before += count * bytes;
}

std::optional<Layout> read_header(std::string_view file) {
  Layout layout;
  std::size_t at = 0;
  Tokens tokens;
  bool in_vertices = false;
  bool done = false;
  std::size_t count = 0;             // of the element at hand
  std::vector<Property> properties;  // of the element at hand
  const auto end_element = [&] {
    if (in_vertices) {
      layout.vertices = count;
      layout.properties = properties;
      done = true;
    } else if (!done) {
      skip_element(count, properties, layout);
    }
    properties.clear();
  };
  while (true) {
    const std::size_t end = file.find('\n', at);
    if (end == std::string_view::npos) return std::nullopt;
    split_tokens(file.substr(at, end - at), tokens);
    at = end + 1;
    if (tokens.empty()) continue;
    if (tokens[0] == "end_header") break;
    if (tokens[0] == "format" && tokens.size() > 1) {
      layout.form = tokens[1] == "ascii"                  ? Layout::Form::kText
                    : tokens[1] == "binary_little_endian" ? Layout::Form::kLittleEndian
                                                          : Layout::Form::kBigEndian;
    }
    if (tokens[0] == "element" && tokens.size() > 2) {
      end_element();
      const std::optional<std::size_t> stated = to_count(tokens[2]);
      if (!stated || *stated > file.size()) return std::nullopt;
      count = *stated;
      in_vertices = !done && tokens[1] == "vertex";
    }
    if (tokens[0] == "property" && tokens.size() > 2 && !done) {
      const std::optional<Type> type = type_of(tokens[1]);
      if (!type) return std::nullopt;  // a list, or nothing that we know
      properties.push_back({tokens[2], *type});
    }
  }
  end_element();
  if (!done) return std::nullopt;
  layout.body = at;
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found =
        std::find_if(layout.properties.begin(), layout.properties.end(),
                     [&](const Property& property) { return property.name == kNames[k]; });
    if (found == layout.properties.end() || size_of(found->type) < 4) return std::nullopt;
    layout.xyz[k] = static_cast<std::size_t>(found - layout.properties.begin());
  }
  return layout;
}

template <class T>
double load_as(const char* at, bool swapped) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return static_cast<double>(std::bit_cast<T>(bytes));
}

template <class T>
void store_as(char* at, std::uint32_t value, bool swapped) {
  auto bytes = std::bit_cast<std::array<char, sizeof(T)>>(static_cast<T>(value));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  std::memcpy(at, bytes.data(), sizeof(T));
}

double load_value(const char* at, Type type, bool swapped) {
  switch (type) {
    case Type::kFloat32:
      return load_as<float>(at, swapped);
    case Type::kInt32:
      return load_as<std::int32_t>(at, swapped);
    case Type::kUint32:
      return load_as<std::uint32_t>(at, swapped);
    default:
      return load_as<double>(at, swapped);
  }
}

void store_value(char* at, Type type, std::uint32_t value, bool swapped) {
  switch (type) {
    case Type::kFloat32:
      return store_as<float>(at, value, swapped);
    case Type::kInt32:
      return store_as<std::int32_t>(at, value, swapped);
    case Type::kUint32:
      return store_as<std::uint32_t>(at, value, swapped);
    default:
      return store_as<double>(at, value, swapped);
  }
}

bool number_binary(std::string& file, const Layout& layout, ExactPositions& exact) {
  std::vector<std::size_t> offset;
  std::size_t stride = 0;
  for (const Property& property : layout.properties) {
    offset.push_back(stride);
    stride += size_of(property.type);
  }
  const std::size_t first = layout.body + layout.bytes_before;
  if (stride == 0 || first > file.size()) return false;
  if (layout.vertices > (file.size() - first) / stride) return false;
  const bool swapped =
      (layout.form == Layout::Form::kBigEndian) == (std::endian::native == std::endian::little);
  for (std::size_t i = 0; i < layout.vertices; ++i) {
    char* const vertex = file.data() + first + i * stride;
    const auto place = [&](std::size_t k) { return vertex + offset[layout.xyz[k]]; };
    const auto type = [&](std::size_t k) { return layout.properties[layout.xyz[k]].type; };
    Eigen::Vector3d position;
    for (std::size_t k = 0; k < 3; ++k) {
      position[static_cast<Eigen::Index>(k)] = load_value(place(k), type(k), swapped);
    }
    if (!position.allFinite()) continue;
    const ExactPositions::Number number = exact.add(position);
    for (std::size_t k = 0; k < 3; ++k) store_value(place(k), type(k), number[k], swapped);
  }
  return true;
}

bool number_text(std::string& file, const Layout& layout, ExactPositions& exact) {
  std::string rewritten = file.substr(0, layout.body);
  std::string_view rest = std::string_view(file).substr(layout.body);
  Tokens tokens;
  for (std::size_t line = 0; line < layout.lines_before + layout.vertices;) {
    if (rest.empty()) return false;
    const std::size_t end = std::min(rest.find('\n'), rest.size() - 1) + 1;
    const std::string_view text = rest.substr(0, end);
    rest.remove_prefix(end);
    split_tokens(text, tokens);
    if (tokens.empty()) continue;  // assimp passes over empty lines, too
    if (line++ < layout.lines_before) {
      rewritten += text;
      continue;
    }
    if (tokens.size() < layout.properties.size()) return false;
    Eigen::Vector3d position;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::optional<double> value = read_exact_number(tokens[layout.xyz[k]]);
      if (!value) return false;
      position[static_cast<Eigen::Index>(k)] = *value;
    }
    std::vector<std::string> words(tokens.begin(), tokens.end());
    if (position.allFinite()) {
      const ExactPositions::Number number = exact.add(position);
      for (std::size_t k = 0; k < 3; ++k) words[layout.xyz[k]] = std::to_string(number[k]);
    }
    rewritten += fmt::format("{}\n", fmt::join(words, " "));
  }
  rewritten += rest;
  file = std::move(rewritten);
  return true;
}

}  // namespace

bool number_ply_vertices(std::string& file, ExactPositions& exact) {
  const std::optional<Layout> layout = read_header(file);
  if (!layout) return false;
  ExactPositions found;
  const bool numbered = layout->form == Layout::Form::kText ? number_text(file, *layout, found)
                                                            : number_binary(file, *layout, found);
  if (numbered) exact = std::move(found);
  return numbered;
}

}  // namespace boxtree::cooker
