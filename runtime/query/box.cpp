// SPDX-License-Identifier: MIT
// Box queries over any codec.
#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/box.h>
#include <boxtree/runtime/query/face_visit.h>

namespace boxtree {
namespace {

struct BoxQuery {
  Eigen::Vector3d low;  // tree space
  Eigen::Vector3d high;

  // Comparisons only: exact, closed, monotone.
  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    bool apart = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      apart |= box.low[k] > high[axis] || box.high[k] < low[axis];
    }
    return !apart;
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    return triangle_intersects_box(triangle, low, high);
  }
};

}  // namespace

Result<Visit> overlap_box(const Tree& tree, const Eigen::AlignedBox3d& box, FaceVisitor visitor) {
  const bool ordered = (box.min().array() <= box.max().array()).all();  // false for NaN
  if (!ordered || !box.min().allFinite() || !box.max().allFinite()) return Errc::kInvalidQuery;
  const BoxQuery query{tree.frame().to_tree(box.min()).cwiseMax(-kReach).cwiseMin(kReach),
                       tree.frame().to_tree(box.max()).cwiseMax(-kReach).cwiseMin(kReach)};
  return visit_faces(tree, query, visitor);
}

}  // namespace boxtree
