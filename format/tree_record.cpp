// SPDX-License-Identifier: MIT
// Checks one tree record. Counts and boxes that pass cannot overflow later arithmetic.
#include "format/tree_record.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "format/codec_wide.h"
#include "format/limits.h"
#include "format/message.h"
#include "format/numbers.h"

namespace boxtree {
namespace {

// Grid coordinates have at most 33 bits and the extent has 16 in tree space, so in valid files the
// exponents of the two differ by less than this.
constexpr int kMaxGridShift = 64;

bool counts_fit(const TreeRecord& record) {
  const std::uint64_t faces = record.face_count;
  const std::uint32_t deepest = is_wide(record.codec) ? kMaxWideDepth : kMaxDepth;
  return faces <= kMaxFaces && record.duplicate_count <= faces && record.node_count <= kMaxNodes &&
         record.depth <= deepest && record.triangle_count >= faces &&
         record.triangle_count <= 2 * faces && record.degenerate_count <= record.triangle_count;
}

bool root_fits(const TreeRecord& record) {
  switch (record.root) {
    case RootKind::kEmpty:
      return record.face_count == 0 && record.node_count == 0;
    case RootKind::kLeaf:
      return record.face_count > 0 && record.node_count == 0;
    case RootKind::kSubtree:
      return record.face_count > 0 && record.node_count > 0;
  }
  return false;
}

// Each leaf has its own faces: eight in wide trees, one in binary ones. No walk could find faces
// beyond what the nodes can hold, but readers would allocate for them.
bool leaves_fit(const TreeRecord& record) {
  const std::uint64_t faces_of_node = is_wide(record.codec) ? kWideChildren * kLeafFaces : 2;
  const std::uint64_t nodes = std::max(record.node_count, 1u);
  return counts_of(record).faces_in_leaves <= faces_of_node * nodes;
}

bool frame_fits(const TreeRecord& record) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = record.root_low[k];
    const double high = record.root_high[k];
    const bool ordered = -kMaxRootCoordinate <= low && low <= high && high <= kMaxRootCoordinate;
    if (!std::isfinite(record.origin[k]) || !ordered) return false;  // NaN is not ordered
  }
  return is_within(record.scale_exponent, kMaxScaleExponent);
}

// Copies need an original. They come after all other faces: in source order, too, if the source has
// been written in tree order.
bool duplicates_fit(const TreeRecord& record) {
  if (record.duplicate_count == 0) return record.duplicate_bytes == 0;
  return is_number_width(record.duplicate_bytes) && counts_of(record).faces_in_leaves > 0;
}

bool geometry_fits(const TreeRecord& record) {
  const double error = record.max_vertex_error;
  if (!(error >= 0) || !std::isfinite(error)) return false;  // NaN is not at least 0
  if (record.geometry != GeometryId::kGrid && record.grid_exponent != 0) return false;
  if (record.geometry == GeometryId::kExternal) {
    return record.corner_bytes == 0 && record.corners_per_face == 0;
  }
  if (record.corners_per_face != 3 && record.corners_per_face != 4) return false;
  if (record.geometry == GeometryId::kArrays) {
    return record.corner_bytes == 2 || record.corner_bytes == 4;
  }
  if (record.corner_bytes != 0) return false;
  return record.geometry == GeometryId::kExact ||
         (is_within(record.grid_exponent, kMaxScaleExponent) &&
          is_within(std::int64_t{record.grid_exponent} - record.scale_exponent, kMaxGridShift));
}

Status check_fields(const TreeRecord& record) {
  if (codec_name(record.codec) == "unknown") {
    return error_with(Errc::kCodecUnsupported, {}, "codec #",
                      {static_cast<std::uint64_t>(record.codec)});
  }
  if (geometry_name(record.geometry) == "unknown") {
    return error_with(Errc::kGeometryUnsupported, {}, "geometry #",
                      {static_cast<std::uint64_t>(record.geometry)});
  }
  // Unknown flags may change the meaning of the fields below.
  if ((record.flags & ~kTreeKnownFlags) != 0) {
    return error_with(Errc::kFeatureUnsupported, {}, "flags #; this reader knows those of #",
                      {record.flags, kTreeKnownFlags});
  }
  std::string_view fault;
  if (!counts_fit(record) || !leaves_fit(record) || !duplicates_fit(record)) {
    fault = "counts contradict each other or exceed the limits";
  } else if (!root_fits(record)) {
    fault = "kind of root contradicts the counts";
  } else if (!frame_fits(record)) {
    fault = "origin, scale or root box is not finite, ordered and within limits";
  } else if (!geometry_fits(record)) {
    fault = "corners, grid or its error are not as specified";
  } else {
    return {};
  }
  return error_with(Errc::kRecordInvalid, {}, fault);
}

}  // namespace

Status check_tree_record(const TreeRecord& record, std::uint32_t tree) {
  Status status = check_fields(record);
  return status ? status : error_of("tree", tree, status.error());
}

}  // namespace boxtree
