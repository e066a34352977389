// SPDX-License-Identifier: MIT
// The header of a PLY file (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boxtree::cooker {

enum class PlyType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kFloat32,
  kFloat64
};

[[nodiscard]] std::size_t size_of(PlyType type);
[[nodiscard]] bool is_integer(PlyType type);

/// A value in a binary file. Every type fits into a double without rounding.
[[nodiscard]] double load_ply_value(const char* at, PlyType type, bool swapped);
/// Of an integer type.
[[nodiscard]] std::int64_t load_ply_integer(const char* at, PlyType type, bool swapped);

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> length;  // of a list: how its length is stored
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
  bool is_understood = true;  // no property of a type that we do not know

  [[nodiscard]] bool has_lists() const;
};

struct PlyHeader {
  enum class Form { kText, kLittleEndian, kBigEndian } form = Form::kText;
  std::size_t bytes = 0;  // the body starts there
  std::vector<PlyElement> elements;
  bool is_plain = true;  // it begins with the magic word and a format that we know
};

/// Whether a line of `file` is the last one of a header, and ends.
[[nodiscard]] bool has_ply_header_end(std::string_view file);

/// The header at the start of `file`; nothing if it does not end there, an element has no
/// count, or a property no element.
[[nodiscard]] std::optional<PlyHeader> read_ply_header(std::string_view file);

}  // namespace boxtree::cooker
