// SPDX-License-Identifier: MIT
// The fixed-width record that describes one tree: where it lies, how it is stored, and what the
// cooker proved of it after it had written it; `boxtree verify` proves that again.
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
inline constexpr std::uint8_t kTreeFacesInSourceOrder = 1u;
/// TreeRecord::flags: positions are f64, otherwise f32.
inline constexpr std::uint8_t kTreePositionsF64 = 2u;
inline constexpr std::uint8_t kTreeKnownFlags = 3u;

/// One tree of the file. Its coordinates are in two spaces:
///   object space  the coordinates of the source mesh, as the application knows them;
///   tree space    (object - origin) * 2^-scale_exponent, computed in double: where boxes live.
/// The scale is a power of two and therefore exact; it brings the largest extent into
/// [2^14, 2^15), where cuts of every codec resolve well, whatever the unit of the mesh.
struct TreeRecord {
  CodecId codec;
  GeometryId geometry;
  RootKind root;
  std::uint8_t depth;  // inner nodes on the longest path; at most kMaxDepth
  std::uint8_t flags;
  std::uint8_t corner_bytes;      // 2 or 4; 0 unless geometry is arrays
  std::uint8_t corners_per_face;  // 3, or 4 when the mesh has quads; 0 when external
  std::uint8_t duplicate_bytes;   // width (format/numbers.h); 0 without a duplicates section
  std::uint32_t face_count;
  std::uint32_t triangle_count;  // a quad counts as two
  std::uint32_t node_count;
  std::uint32_t duplicate_count;   // faces in no leaf; they come after all others
  std::uint32_t degenerate_count;  // triangles without area, kept
  std::uint32_t name_offset;       // into the names section
  std::uint32_t name_bytes;
  std::int16_t scale_exponent;
  std::int16_t grid_exponent;    // geometry grid: its step is 2^grid_exponent; otherwise 0
  double max_vertex_error;       // largest distance of a stored from a source vertex, object space
  std::array<double, 3> origin;  // object space
  std::array<double, 3> root_low;   // tree space
  std::array<double, 3> root_high;  // tree space
  std::uint64_t geometry_hash;      // XXH3-64 of the faces' corner positions; docs/FORMAT.md
};
static_assert(sizeof(TreeRecord) == 128 && std::is_trivially_copyable_v<TreeRecord>);
static_assert(offsetof(TreeRecord, face_count) == 8 && offsetof(TreeRecord, scale_exponent) == 36);
static_assert(offsetof(TreeRecord, origin) == 48 && offsetof(TreeRecord, root_high) == 96);
static_assert(offsetof(TreeRecord, geometry_hash) == 120);

/// The counts that codecs need. Faces in leaves come first in tree order; the others are copies of
/// them.
[[nodiscard]] constexpr TreeCounts counts_of(const TreeRecord& record) noexcept {
  return {record.node_count, record.face_count - record.duplicate_count};
}

/// Checks everything about a record that can be checked without its sections: known codec, geometry
/// and flags, counts within limits, finite ordered root box, consistent root kind. `tree` is the
/// record's number, for the message.
Status check_tree_record(const TreeRecord& record, std::uint32_t tree);

}  // namespace boxtree
