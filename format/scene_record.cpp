// SPDX-License-Identifier: MIT
// Checks a scene's record. Counts and boxes that pass cannot overflow later arithmetic.
#include "format/scene_record.h"

#include <cmath>
#include <string>

#include "format/limits.h"

namespace boxtree {
namespace {

bool counts_fit(const SceneRecord& record) {
  return record.instance_count <= kMaxInstances && record.static_count <= record.instance_count &&
         record.node_count <= record.static_count && record.depth <= kMaxWideDepth &&
         record.layer_count >= 1 && record.layer_count <= kMaxLayers &&
         (record.pose_bytes == 4 || record.pose_bytes == 8) &&
         (record.query_kinds & ~kAllQueries) == 0;
}

bool root_fits(const SceneRecord& record) {
  switch (record.root) {
    case RootKind::kEmpty:
      return record.static_count == 0 && record.node_count == 0;
    case RootKind::kLeaf:
      return record.static_count == 1 && record.node_count == 0;
    case RootKind::kSubtree:
      return record.static_count > 0 && record.node_count > 0;
  }
  return false;
}

bool frame_fits(const SceneRecord& record) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double low = record.root_low[k];
    const double high = record.root_high[k];
    const bool is_ordered = low <= high;  // false for NaN
    if (!std::isfinite(record.origin[k]) || !is_ordered) return false;
    if (std::abs(low) > kMaxRootCoordinate || std::abs(high) > kMaxRootCoordinate) return false;
  }
  if (!is_within(record.scale_exponent, kMaxScaleExponent)) return false;
  for (const double origin : record.origin) {
    if (!std::isfinite(std::ldexp(origin, -record.scale_exponent))) return false;
  }
  return std::isfinite(record.condition) && record.condition >= 0;
}

bool reserve_is_zero(const SceneRecord& record) {
  return (record.flags & ~kSceneKnownFlags) == 0 &&
         record.reserved1 == decltype(record.reserved1){} &&
         record.reserved2 == decltype(record.reserved2){};
}

}  // namespace

std::string_view part_name(Part part) noexcept {
  switch (part) {
    case Part::kFaceIds:
      return "face ids";
    case Part::kMaterials:
      return "materials";
    case Part::kNames:
      return "names";
    case Part::kRays:
      return "ray queries";
    case Part::kBoxes:
      return "box queries";
    case Part::kPoints:
      return "point queries";
    case Part::kPairs:
      return "pair queries";
  }
  return "unknown";
}

Status check_scene_record(const SceneRecord& record) {
  const char* what = nullptr;
  if (!counts_fit(record)) {
    what = "counts beyond the limits or contradictory";
  } else if (!root_fits(record)) {
    what = "root kind and counts contradict each other";
  } else if (!frame_fits(record)) {
    what = "origin, scale or root box out of range";
  } else if (!reserve_is_zero(record)) {
    what = "unknown flags, or reserved bytes that are not zero";
  }
  if (what == nullptr) return {};
  return Error{Errc::kRecordInvalid, std::string("section scene: ") + what};
}

}  // namespace boxtree
