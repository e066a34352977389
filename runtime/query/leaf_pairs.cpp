// SPDX-License-Identifier: MIT
// The triangles of two leaves: bounds first, then the exact predicate.
#include "runtime/query/leaf_pairs.h"

#include <cstddef>

#include "runtime/primitive/predicates.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

Errc LeafPairTest::run(const LeafPair& leaves, const TriangleWatch* watch) {
  if (const Errc error = leaves_.read(leaves.first, leaves.second); error != Errc::kOk) {
    return error;
  }
  // Only triangles that overlap the other leaf's box can touch anything in it.
  std::array<std::uint32_t, kMaxLeafTriangles> near;  // triangles of the second leaf
  std::size_t near_count = 0;
  for (std::uint32_t j = 0; j < leaves_.second.count; ++j) {
    if (boxes_overlap(leaves.first_box, leaves_.moved_bounds[j])) near[near_count++] = j;
  }
  if (near_count == 0) return Errc::kOk;
  const Box<double> second_image = pose_.hull_in_first(leaves.second_box);
  // A pair of faces is reported once: not again for the second half of a quad.
  std::uint32_t last_face = kNoFaceId;
  std::uint64_t found = 0;  // bit j: triangle j of the second leaf touches the current face
  for (std::uint32_t i = 0; i < leaves_.first.count; ++i) {
    if (leaves_.first.face[i] != last_face) found = 0;
    last_face = leaves_.first.face[i];
    if (!boxes_overlap(leaves_.first_bounds[i], second_image)) continue;
    const Triangle triangle = leaves_.first.triangle(i);
    for (std::size_t n = 0; n < near_count; ++n) {
      const std::uint32_t j = near[n];
      if (!boxes_overlap(leaves_.first_bounds[i], leaves_.moved_bounds[j]) || was_found(found, j))
        continue;
      if (triangles_intersect(triangle, leaves_.moved[j])) {
        found |= std::uint64_t{1} << j;
        if (!report_.add(leaves_.first.face[i], leaves_.second.face[j])) return report_.error();
      } else if (watch != nullptr && (*watch)(triangle, leaves_.moved[j])) {
        stopped_ = true;
        return Errc::kOk;
      }
    }
  }
  return Errc::kOk;
}

// Whether triangle j of the second leaf, or the other half of its face, was found already. Halves
// are adjacent.
bool LeafPairTest::was_found(std::uint64_t found, std::uint32_t j) const noexcept {
  const auto is_same = [&](std::uint32_t other) {
    return leaves_.second.face[other] == leaves_.second.face[j] && ((found >> other) & 1u) != 0;
  };
  return is_same(j) || (j > 0 && is_same(j - 1)) ||
         (j + 1 < leaves_.second.count && is_same(j + 1));
}

}  // namespace boxtree
