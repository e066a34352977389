// SPDX-License-Identifier: MIT
// Parses the words of header lines and the values of bodies.
#include "cooker/import/ply_header.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include <fmt/format.h>

#include "cooker/import/file_error.h"
#include "cooker/import/text_tokens.h"

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

class HeaderReader {
 public:
  explicit HeaderReader(std::string_view file) : file_(file) {}

  Result<PlyHeader> read();

 private:
  bool next_line();
  Status take_statement();
  Status take_format();
  Status take_element();
  Status take_property();

  [[nodiscard]] Error failure(std::string_view why) const {
    return Error{Errc::kImportFailed, fmt::format("line {}: {}", header_.lines, why)};
  }

  std::string_view file_;
  PlyHeader header_;
  Tokens tokens_;  // of the current line
  char line_end_ = '\n';
  bool has_format_ = false;
};

Result<PlyHeader> HeaderReader::read() {
  // Old Macintosh files end lines with a carriage return only.
  if (file_.starts_with("ply\r") && !file_.starts_with("ply\r\n")) line_end_ = '\r';
  if (!next_line() || tokens_.size() != 1 || tokens_[0] != "ply") {
    return Error{Errc::kImportFailed, "no PLY file: its first line is not 'ply'"};
  }
  while (next_line()) {
    if (tokens_.size() == 1 && tokens_[0] == "end_header") {
      if (!has_format_) return failure("the header ends without a 'format'");
      return std::move(header_);
    }
    if (Status status = take_statement(); !status.ok()) return status.error();
  }
  return failure(std::string("the header has no 'end_header' behind it") + kAsIfCut);
}

// False at the end of the file, and for a last line without an end.
bool HeaderReader::next_line() {
  const std::size_t end = file_.find(line_end_, header_.bytes);
  if (end == std::string_view::npos) return false;
  split_tokens(file_.substr(header_.bytes, end - header_.bytes), tokens_);
  header_.bytes = end + 1;
  ++header_.lines;
  return true;
}

Status HeaderReader::take_statement() {
  for (const std::string_view word : tokens_) {
    if (word.find('\0') != std::string_view::npos) return failure("a zero byte");
  }
  if (tokens_.empty() || tokens_[0] == "comment" || tokens_[0] == "obj_info") return {};
  if (tokens_[0] == "format") return take_format();
  if (tokens_[0] == "element") return take_element();
  if (tokens_[0] == "property") return take_property();
  return failure(fmt::format("no statement of a PLY header begins with {:?}", tokens_[0]));
}

// format FORM VERSION
Status HeaderReader::take_format() {
  const std::optional<PlyHeader::Form> form =
      tokens_.size() > 1 ? form_of(tokens_[1]) : std::nullopt;
  if (!form || has_format_) {
    return failure("one 'format' is expected: ascii, binary_little_endian or binary_big_endian");
  }
  has_format_ = true;
  header_.form = *form;
  return {};
}

// element NAME COUNT
Status HeaderReader::take_element() {
  const std::optional<std::uint64_t> count =
      tokens_.size() == 3 ? read_count(tokens_[2]) : std::nullopt;
  if (!count) return failure("'element' is to be followed by a name and a count");
  header_.elements.push_back({std::string(tokens_[1]), *count, {}});
  return {};
}

// property TYPE NAME, or property list TYPE TYPE NAME
Status HeaderReader::take_property() {
  if (header_.elements.empty()) return failure("a property before the first element");
  const bool is_list = tokens_.size() > 1 && tokens_[1] == "list";
  const std::size_t at = is_list ? 3 : 1;
  if (tokens_.size() != at + 2) {
    return failure(
        "'property' is to be followed by a type and a name, or by 'list', two types and "
        "a name");
  }
  const std::optional<PlyType> type = type_of(tokens_[at]);
  const std::optional<PlyType> length = is_list ? type_of(tokens_[2]) : std::nullopt;
  if (!type || length.has_value() != is_list) {
    return failure(fmt::format("PLY has no type {:?}", tokens_[type ? 2 : at]));
  }
  if (length && !is_integer(*length)) {
    return failure(fmt::format("the length of a list is to be an integer, not {:?}", tokens_[2]));
  }
  header_.elements.back().properties.push_back({std::string(tokens_[at + 1]), *type, length});
  return {};
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

Result<PlyHeader> read_ply_header(std::string_view file) {
  return HeaderReader(file).read();
}

}  // namespace boxtree::cooker
