// SPDX-License-Identifier: MIT
// The registry of node codecs and geometry stores: pinned numbers and the names users type.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace boxtree {

/// How nodes are stored. Numbers are pinned.
enum class CodecId : std::uint8_t {
  kPlainF32 = 1,
  kPlainF16 = 2,
  kPackedF32 = 3,
  kPackedF16 = 4,
  kPackedF64 = 5,
  kDedup = 6,
  kWide8 = 7,
  kWide4 = 8,
};

/// How vertices and corners are stored. Numbers are pinned.
enum class GeometryId : std::uint8_t {
  kExternal = 1,  // not in the file; the application gives its arrays when binding
  kArrays = 2,    // f32 or f64 positions bit for bit, corners as 16 or 32-bit vertex numbers
  kGrid = 3,      // positions rounded to a grid, in clusters (format/cluster.h)
  kExact = 4,     // f32 or f64 positions bit for bit, in clusters
};

struct CodecInfo {
  CodecId id;
  std::string_view name;
};

/// All codecs; adding one starts with a line here.
inline constexpr std::array kCodecs = {
    CodecInfo{CodecId::kPlainF32, "plain-f32"},   CodecInfo{CodecId::kPlainF16, "plain-f16"},
    CodecInfo{CodecId::kPackedF32, "packed-f32"}, CodecInfo{CodecId::kPackedF16, "packed-f16"},
    CodecInfo{CodecId::kPackedF64, "packed-f64"}, CodecInfo{CodecId::kDedup, "dedup"},
    CodecInfo{CodecId::kWide8, "wide8"},          CodecInfo{CodecId::kWide4, "wide4"},
};

/// Whether a codec has leaves of several faces and its own order of faces.
[[nodiscard]] constexpr bool is_wide(CodecId id) noexcept {
  return id == CodecId::kWide8 || id == CodecId::kWide4;
}

/// Whether nodes are bit fields, whose widths differ from tree to tree.
[[nodiscard]] constexpr bool is_packed(CodecId id) noexcept {
  return id == CodecId::kPackedF32 || id == CodecId::kPackedF16 || id == CodecId::kPackedF64 ||
         id == CodecId::kDedup;
}

[[nodiscard]] constexpr std::string_view codec_name(CodecId id) noexcept {
  for (const CodecInfo& info : kCodecs) {
    if (info.id == id) return info.name;
  }
  return "unknown";
}

[[nodiscard]] constexpr std::optional<CodecId> find_codec(std::string_view name) noexcept {
  for (const CodecInfo& info : kCodecs) {
    if (info.name == name) return info.id;
  }
  return std::nullopt;
}

/// Whether positions are those of the source, bit for bit.
[[nodiscard]] constexpr bool is_lossless(GeometryId id) noexcept {
  return id == GeometryId::kArrays || id == GeometryId::kExact;
}

/// Whether faces are stored in clusters.
[[nodiscard]] constexpr bool has_clusters(GeometryId id) noexcept {
  return id == GeometryId::kGrid || id == GeometryId::kExact;
}

[[nodiscard]] constexpr std::string_view geometry_name(GeometryId id) noexcept {
  switch (id) {
    case GeometryId::kExternal:
      return "external";
    case GeometryId::kArrays:
      return "arrays";
    case GeometryId::kGrid:
      return "grid";
    case GeometryId::kExact:
      return "exact";
  }
  return "unknown";
}

}  // namespace boxtree
