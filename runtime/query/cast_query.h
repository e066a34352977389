// SPDX-License-Identifier: MIT
// The state of a cast in one tree, shared by the walks of all codecs.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/cast.h>

#include "runtime/primitive/moving_shape.h"
#include "runtime/query/ray_query.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// The best touch so far: `s`, a lower bound, in parameters of the query, the triangle in tree
/// space.
struct CastCandidate {
  bool is_hit = false;  // if false, the rest is unspecified
  double s = 0;
  FaceRef face;
  std::uint32_t original = 0;  // the face of the tree's order that it is, or is a copy of
  std::uint32_t half = 0;
  Triangle triangle;
};

/// A query of traverse_nearest: the line of the shape's center against boxes that are widened by
/// the shape.
struct CastQuery : RayInTree {
  /// Receives each touch, those of copies after their original's; returns the largest parameter
  /// that is still of interest, or a negative number to stop.
  using Visitor = FunctionRef<double(const CastQuery& query, const CastCandidate& found)>;

  enum class Wanted : std::uint8_t { kClosest, kAny, kAll };

  /// `line`: of the shape's center; its direction is not zero. `all`: the visitor of kAll, or null.
  /// `face_options`: null: every face may be hit.
  CastQuery(const BoundTree& queried, const ConvexShape& shape, const Ray& line, bool is_moving,
            Wanted wanted_touches, const Visitor* all, WalkBound& bound,
            const FaceOptions* face_options = nullptr) noexcept
      : RayInTree(queried, line, exponent_of(largest_magnitude(line.direction)),
                  near_of(queried, shape)),
        tree(queried),
        nodes(bound),
        extent(shape.half_extents()),
        near(near_of(queried, shape)),
        moving{placed(shape), is_moving ? direction.vector() : Eigen::Vector3d::Zero(),
               MovingShape::doubt_of(near, origin_max_abs)},
        wanted(wanted_touches),
        visitor(all),
        faces(queried, face_options) {
    slab = slab.widened(AxisLanes(extent));
  }

  /// Walks the tree; `best` or the visitor has the answers then. Errors: those of corrupt bytes and
  /// limits.
  [[nodiscard]] Errc run();

  [[nodiscard]] double bound() const noexcept { return t_max; }

  [[nodiscard]] bool leaf(NodeRef ref) noexcept {
    error = tree.leaves().read(ref.first, ref.second, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count && !is_done(); ++i) {
      test(batch.triangle(i), batch.face[i], half_of_face(batch, i));
    }
    return !is_done();
  }

  /// Whether no other triangle can matter.
  [[nodiscard]] bool is_done() const noexcept {
    return faces.stopped || error != Errc::kOk || (wanted == Wanted::kAny && best.is_hit);
  }

  void test(const Triangle& triangle, std::uint32_t face_index, std::uint32_t half) noexcept;

  const BoundTree& tree;
  WalkBound& nodes;
  Eigen::Vector3d extent;  // half, of the shape's bounds
  // The largest coordinate of the tree, in every codec, and of the shape while it is near.
  double near;
  MovingShape moving;
  Wanted wanted;
  const Visitor* visitor;
  FaceWishes faces;
  CastCandidate best;
  Errc error = Errc::kOk;
  TriangleBatch batch;

 private:
  // Whether a triangle may be hit, from the side from which it is met.
  [[nodiscard]] bool admits_side(const Triangle& triangle) const noexcept;

  [[nodiscard]] static double near_of(const BoundTree& tree, const ConvexShape& shape) noexcept {
    return RaySlab::power_above(tree.largest_abs()) + 2 * largest_magnitude(shape.half_extents());
  }
  // The shape, which may be anywhere, at the start of the line.
  [[nodiscard]] ConvexShape placed(const ConvexShape& shape) const noexcept {
    ConvexShape out = shape;
    out.center = origin.vector();
    return out;
  }
};

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, CastQuery& query);

}  // namespace boxtree
