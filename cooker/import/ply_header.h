// SPDX-License-Identifier: MIT
// The header of a PLY file (Turk, "The PLY Polygon File Format", 1994).
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <boxtree/error.h>

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
/// Precondition: an integer type.
[[nodiscard]] std::int64_t load_ply_integer(const char* at, PlyType type, bool swapped);

struct PlyProperty {
  std::string name;
  PlyType type;
  std::optional<PlyType> length;  // of a list: the type of its length
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  [[nodiscard]] bool has_lists() const;
};

struct PlyHeader {
  enum class Form { kText, kLittleEndian, kBigEndian } form = Form::kText;
  std::size_t bytes = 0;  // offset of the body
  std::size_t lines = 0;  // of the header, including its last one
  std::vector<PlyElement> elements;
};

/// The header at the start of `file`. kImportFailed with the line for anything that is not a
/// header. Unknown statements are refused: one could be a misspelt property, and every value after
/// it would be misread.
[[nodiscard]] Result<PlyHeader> read_ply_header(std::string_view file);

}  // namespace boxtree::cooker
