// SPDX-License-Identifier: MIT
// Words of header lines, values of bodies.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include <boxtree/cooker/import/ply_header.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

std::optional<PlyType> type_of(std::string_view name) {
  if (name == "char" || name == "int8") return PlyType::kInt8;
  if (name == "uchar" || name == "uint8") return PlyType::kUint8;
  if (name == "short" || name == "int16") return PlyType::kInt16;
  if (name == "ushort" || name == "uint16") return PlyType::kUint16;
  if (name == "int" || name == "int32") return PlyType::kInt32;
  if (name == "uint" || name == "uint32") return PlyType::kUint32;
  if (name == "float" || name == "float32") return PlyType::kFloat32;
  if (name == "double" || name == "float64") return PlyType::kFloat64;
  return std::nullopt;
}

template <class T>
T load_as(const char* at, bool swapped) {
  std::array<char, sizeof(T)> bytes;
  std::memcpy(bytes.data(), at, sizeof(T));
  if (swapped) std::reverse(bytes.begin(), bytes.end());
  return std::bit_cast<T>(bytes);
}

std::optional<PlyHeader::Form> form_of(std::string_view name) {
  if (name == "ascii") return PlyHeader::Form::kText;
  if (name == "binary_little_endian") return PlyHeader::Form::kLittleEndian;
  if (name == "binary_big_endian") return PlyHeader::Form::kBigEndian;
  return std::nullopt;
}

// property TYPE NAME, or property list TYPE TYPE NAME
void add_property(const Tokens& tokens, PlyElement& element) {
  const bool is_list = tokens.size() > 1 && tokens[1] == "list";
  const std::size_t at = is_list ? 3 : 1;
  const std::optional<PlyType> type = tokens.size() > at + 1 ? type_of(tokens[at]) : std::nullopt;
  const std::optional<PlyType> length = is_list && type ? type_of(tokens[2]) : std::nullopt;
  if (!type || length.has_value() != is_list) {
    element.is_understood = false;
    return;
  }
  element.properties.push_back({std::string(tokens[at + 1]), *type, length});
}

// One line of the header but the last. False if there is no going on. Lines that mean nothing to us
// are comments, as they are to other readers.
bool read_line(const Tokens& tokens, PlyHeader& header) {
  if (tokens[0] == "format" && tokens.size() > 1) {
    const std::optional<PlyHeader::Form> form = form_of(tokens[1]);
    header.form = form.value_or(PlyHeader::Form::kText);
    header.is_plain = header.is_plain && form.has_value();
  } else if (tokens[0] == "element") {
    const std::optional<std::uint64_t> count =
        tokens.size() > 2 ? read_count(tokens[2]) : std::nullopt;
    if (!count) return false;
    header.elements.push_back({std::string(tokens[1]), *count, {}});
  } else if (tokens[0] == "property") {
    if (header.elements.empty()) return false;
    add_property(tokens, header.elements.back());
  }
  return true;
}

}  // namespace

std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 2;
    case PlyType::kInt32:
    case PlyType::kUint32:
    case PlyType::kFloat32:
      return 4;
    case PlyType::kFloat64:
      break;
  }
  return 8;
}

bool is_integer(PlyType type) {
  return type != PlyType::kFloat32 && type != PlyType::kFloat64;
}

double load_ply_value(const char* at, PlyType type, bool swapped) {
  if (type == PlyType::kFloat32) return double{load_as<float>(at, swapped)};
  if (type == PlyType::kFloat64) return load_as<double>(at, swapped);
  return static_cast<double>(load_ply_integer(at, type, swapped));
}

std::int64_t load_ply_integer(const char* at, PlyType type, bool swapped) {
  switch (type) {
    case PlyType::kInt8:
      return load_as<std::int8_t>(at, swapped);
    case PlyType::kUint8:
      return load_as<std::uint8_t>(at, swapped);
    case PlyType::kInt16:
      return load_as<std::int16_t>(at, swapped);
    case PlyType::kUint16:
      return load_as<std::uint16_t>(at, swapped);
    case PlyType::kInt32:
      return load_as<std::int32_t>(at, swapped);
    default:
      return load_as<std::uint32_t>(at, swapped);
  }
}

bool PlyElement::has_lists() const {
  return std::any_of(properties.begin(), properties.end(),
                     [](const PlyProperty& property) { return property.length.has_value(); });
}

bool has_ply_header_end(std::string_view file) {
  constexpr std::string_view kWord = "end_header";
  for (std::size_t at = file.find(kWord); at != std::string_view::npos;
       at = file.find(kWord, at + 1)) {
    const std::size_t before = file.substr(0, at).find_last_not_of(" \t");
    const std::size_t after = file.find_first_not_of(" \t", at + kWord.size());
    const auto ends_line = [&](std::size_t i) {
      return i != std::string_view::npos && (file[i] == '\n' || file[i] == '\r');
    };
    if (ends_line(before) && ends_line(after)) return true;
  }
  return false;
}

std::optional<PlyHeader> read_ply_header(std::string_view file) {
  PlyHeader header;
  Tokens tokens;
  // Old Macintosh files end lines by a carriage return alone.
  const bool has_returns = file.starts_with("ply\r") && !file.starts_with("ply\r\n");
  for (std::size_t line = 0;; ++line) {
    const std::size_t end = file.find(has_returns ? '\r' : '\n', header.bytes);
    if (end == std::string_view::npos) return std::nullopt;
    split_tokens(file.substr(header.bytes, end - header.bytes), tokens);
    header.bytes = end + 1;
    if (tokens.size() == 1 && tokens[0] == "end_header") return header;
    // The format follows the magic word at once: readers look for it nowhere else.
    const std::string_view expected = line == 0 ? "ply" : line == 1 ? "format" : "";
    if (line < 2 && (tokens.empty() || tokens[0] != expected)) header.is_plain = false;
    if (line == 0 || tokens.empty()) continue;
    if (!read_line(tokens, header)) return std::nullopt;
  }
}

}  // namespace boxtree::cooker
