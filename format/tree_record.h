// SPDX-License-Identifier: MIT
// The fixed-width record that describes one tree: where it lies, how it is stored.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include <boxtree/error.h>

#include "format/children.h"
#include "format/codec.h"

namespace boxtree {

/// TreeRecord::flags: the tree's face numbers are those of the source, so that no face_ids section
/// is needed: because nodes hold them (external geometry), or the source is in tree order.
/// Otherwise faces are in tree order.
inline constexpr std::uint32_t kTreeFacesInSourceOrder = 1u;
/// TreeRecord::flags: positions are f64, otherwise f32.
inline constexpr std::uint32_t kTreePositionsF64 = 2u;
inline constexpr std::uint32_t kTreeKnownFlags = 3u;

/// One tree of the file. Its coordinates are in two spaces:
///   object space  the coordinates of the source mesh, as the application knows them;
///   tree space    (object - origin) * 2^-scale_exponent, computed in double: where boxes live.
/// The scale is a power of two and therefore exact; it brings the largest extent into
/// [2^14, 2^15), where cuts of every codec resolve well, whatever the unit of the mesh.
struct TreeRecord {
  CodecId codec;
  GeometryId geometry;
  std::uint32_t flags;
  std::uint32_t face_count;
  std::uint32_t triangle_count;  // a quad counts as two
  std::uint32_t vertex_count;
  std::uint32_t node_count;
  RootKind root;
  std::uint32_t depth;            // inner nodes on the longest path; at most kMaxDepth
  std::uint8_t corner_bytes;      // 2 or 4; 0 unless geometry is arrays
  std::uint8_t corners_per_face;  // 3, or 4 when the mesh has quads; 0 when external
  std::uint8_t has_face_ids;      // 1 with a face_ids section, else 0
  std::uint8_t duplicate_bytes;   // width (format/numbers.h); 0 without a duplicates section
  std::int32_t scale_exponent;
  std::uint32_t name_offset;  // into the names section
  std::uint32_t name_bytes;
  std::array<double, 3> origin;     // object space
  std::array<double, 3> root_low;   // tree space
  std::array<double, 3> root_high;  // tree space
  std::uint64_t geometry_hash;      // XXH3-64 of the faces' corner positions; docs/FORMAT.md
  std::int32_t grid_exponent;       // geometry grid: its step is 2^grid_exponent; otherwise 0
  std::uint32_t duplicate_count;    // faces in no leaf; they come after all others
  std::array<std::uint64_t, 7> reserved2;
};
static_assert(sizeof(TreeRecord) == 192 && std::is_trivially_copyable_v<TreeRecord>);
static_assert(offsetof(TreeRecord, origin) == 48 && offsetof(TreeRecord, root_high) == 96);
static_assert(offsetof(TreeRecord, geometry_hash) == 120);
static_assert(offsetof(TreeRecord, grid_exponent) == 128);
static_assert(offsetof(TreeRecord, duplicate_bytes) == 35);
static_assert(offsetof(TreeRecord, duplicate_count) == 132);

/// The counts that codecs need. Faces in leaves come first in tree order; the others are copies of
/// them.
[[nodiscard]] constexpr TreeCounts counts_of(const TreeRecord& record) noexcept {
  return {record.node_count, record.face_count - record.duplicate_count};
}

/// Checks everything about a record that can be checked without its sections: known codec, geometry
/// and flags, counts within limits, finite ordered root box, consistent root kind, reserved fields
/// zero. `tree` is the record's number, for the message.
Status check_tree_record(const TreeRecord& record, std::uint32_t tree);

}  // namespace boxtree
