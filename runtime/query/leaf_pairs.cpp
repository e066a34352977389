// SPDX-License-Identifier: MIT
// The triangles of two leaves: bounds first, then the exact predicate.
#include <cstddef>

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/leaf_pairs.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {

Errc LeafPairTest::run(const LeafPair& leaves, const TriangleWatch* watch) {
  if (const Errc error = read_first(leaves.first); error != Errc::kOk) return error;
  if (const Errc error = read_second(leaves.second); error != Errc::kOk) return error;
  // Only what reaches into the other leaf's box can touch anything in it.
  std::array<std::uint32_t, kMaxLeafTriangles> near;  // triangles of the second leaf
  std::size_t near_count = 0;
  for (std::uint32_t j = 0; j < second_batch_.count; ++j) {
    if (boxes_overlap(leaves.first_box, moved_bounds_[j])) near[near_count++] = j;
  }
  if (near_count == 0) return Errc::kOk;
  const Box<double> second_image = pose_.hull_in_first(leaves.second_box);
  // A face is reported once: what its second half finds is compared with what the first half did.
  std::uint32_t last_face = kNoFaceId;
  std::uint64_t found = 0;  // bit j: triangle j of the second leaf touches the face at hand
  for (std::uint32_t i = 0; i < first_batch_.count; ++i) {
    if (first_batch_.face[i] != last_face) found = 0;
    last_face = first_batch_.face[i];
    if (!boxes_overlap(first_bounds_[i], second_image)) continue;
    const Triangle triangle = first_batch_.triangle(i);
    for (std::size_t n = 0; n < near_count; ++n) {
      const std::uint32_t j = near[n];
      if (!boxes_overlap(first_bounds_[i], moved_bounds_[j]) || was_found(found, j)) continue;
      if (triangles_intersect(triangle, moved_[j])) {
        found |= std::uint64_t{1} << j;
        stopped_ = !visitor_(
            {face_ref(first_, first_batch_.face[i]), face_ref(second_, second_batch_.face[j])});
      } else if (watch != nullptr) {
        stopped_ = (*watch)(triangle, moved_[j]);
      }
      if (stopped_) return Errc::kOk;
    }
  }
  return Errc::kOk;
}

// Leaves are often met several times in a row; what was read of the last one stays.
Errc LeafPairTest::read_first(NodeRef leaf) noexcept {
  if (leaf == first_read_) return Errc::kOk;
  first_read_ = kNone;
  const Errc error = first_.leaves().read(leaf.first, leaf.second, first_batch_);
  if (error != Errc::kOk) return error;
  for (std::uint32_t i = 0; i < first_batch_.count; ++i) {
    first_bounds_[i] = bounds_of(first_batch_.triangle(i));
  }
  first_read_ = leaf;
  return Errc::kOk;
}

Errc LeafPairTest::read_second(NodeRef leaf) noexcept {
  if (leaf == second_read_) return Errc::kOk;
  second_read_ = kNone;
  const Errc error = second_.leaves().read(leaf.first, leaf.second, second_batch_);
  if (error != Errc::kOk) return error;
  for (std::uint32_t j = 0; j < second_batch_.count; ++j) {
    const Triangle triangle = second_batch_.triangle(j);
    for (std::size_t c = 0; c < 3; ++c) {
      moved_[j].corner[c] = pose_.to_first().apply(triangle.corner[c]);
      // Outside the root box that the pose was checked with.
      if (!is_within_reach(moved_[j].corner[c])) return Errc::kVertexNotFinite;
    }
    moved_bounds_[j] = bounds_of(moved_[j]);
  }
  second_read_ = leaf;
  return Errc::kOk;
}

// Whether triangle j of the second leaf, or the other half of its face, was found already. Halves
// stand side by side.
bool LeafPairTest::was_found(std::uint64_t found, std::uint32_t j) const noexcept {
  const auto is_same = [&](std::uint32_t other) {
    return second_batch_.face[other] == second_batch_.face[j] && ((found >> other) & 1u) != 0;
  };
  return is_same(j) || (j > 0 && is_same(j - 1)) || (j + 1 < second_batch_.count && is_same(j + 1));
}

}  // namespace boxtree
