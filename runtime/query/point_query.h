// SPDX-License-Identifier: MIT
// The search for the closest point, whatever the codec.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/closest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/approximation.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/scaled_length.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/read_leaf.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// A point of the space in which triangles are placed (the world, or the units of a scene) and the
/// best that was found there, for the exact test.
struct PlacedPoint {
  AffineMap to_world;     // from tree space
  Eigen::Vector3d point;  // world
  double best;            // squared distance in the world; shrinks
  double least_stretch;   // lower bound: at least how long a unit of tree space becomes
  double error;           // of distances in the world

  /// No point of tree space whose squared distance is larger can be as near as `best`.
  [[nodiscard]] double bound_in_tree() const noexcept {
    const double radius = (std::sqrt(best) + error) / least_stretch + kLengthUnderflow;
    return least_stretch > 0 ? radius * radius * (1 + 16 * kRoundoffF64)
                             : std::numeric_limits<double>::infinity();
  }
};

/// A query of traverse_nearest, in tree space.
struct PointQuery {
  /// `most`: the largest squared distance of interest.
  PointQuery(const BoundTree& queried, WalkBound& bound, const Eigen::Vector3d& at,
             double most) noexcept
      : tree(queried), nodes(bound), point(at), best(most) {}

  const BoundTree& tree;
  WalkBound& nodes;
  Eigen::Vector3d point;  // tree space
  double best;            // squared distance; shrinks
  std::optional<ClosestPoint> found;
  Errc error = Errc::kOk;
  TriangleBatch batch;
  // For answers with bounds: what may be skipped, in tree space, and a lower bound of the distances
  // of all triangles tested.
  const Approximation* approximation = nullptr;
  double tested_lower = std::numeric_limits<double>::infinity();
  std::uint64_t nodes_expanded = 0;  // and leaves read
  // For a placed tree: the exact test is done in the world, where `found` is then.
  PlacedPoint* placed = nullptr;

  [[nodiscard]] double bound() const noexcept { return best; }

  template <class S>
  [[nodiscard]] double key(const Box<S>& box) const noexcept {
    return squared_distance(point, box);
  }

  [[nodiscard]] bool leaf(NodeRef ref) noexcept {
    ++nodes_expanded;
    return read(ref);
  }

  /// Tests the faces of a leaf; whether to go on.
  [[nodiscard]] bool read(NodeRef ref) noexcept {
    error = read_leaf(tree, ref, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      test(batch.triangle(i), batch.face[i], half_of_face(batch, i));
    }
    return true;
  }

  void test(const Triangle& triangle, std::uint32_t face_index, std::uint32_t half) noexcept {
    const double bounds_distance = squared_distance(point, bounds_of(triangle));
    if (bounds_distance > best) return;
    if (placed != nullptr) {
      test_placed(triangle, face_index, half);
      return;
    }
    const Eigen::Vector3d closest = closest_point_on_triangle(point, triangle);
    // Never below the distance of the bounds, so that it agrees with every key above.
    const double distance = std::max(bounds_distance, squared_length(closest - point));
    if (approximation != nullptr) note_lower(triangle, closest, std::min(distance, best));
    FaceRef face{kNoFaceId, face_index};
    if (distance > best || (distance == best && !wins_tie(face, half))) return;
    best = approximation == nullptr ? distance : enough(distance);
    found = ClosestPoint{closest, distance, face, half};
  }

  /// Adds what the walk left out: the id of the face that was found.
  void name_face() noexcept {
    if (found) name(tree, found->face);
  }

 private:
  // Names both faces. Ties are common, since neighbours share edges and vertices.
  [[nodiscard]] bool wins_tie(FaceRef& face, std::uint32_t half) noexcept {
    if (!found) return true;
    name(tree, face);
    name(tree, found->face);
    return comes_before(tree, face, half, found->face, found->triangle);
  }

  void test_placed(const Triangle& triangle, std::uint32_t face_index,
                   std::uint32_t half) noexcept {
    const Eigen::Vector3d closest =
        closest_point_on_triangle(placed->point, placed->to_world.apply(triangle));
    const double distance = squared_length(closest - placed->point);
    if (distance > placed->best) return;
    FaceRef face{kNoFaceId, face_index};
    if (distance == placed->best && !wins_tie(face, half)) return;
    placed->best = distance;
    best = placed->bound_in_tree();
    found = ClosestPoint{closest, distance, face, half};
  }

  // The squared distance from which triangles can be skipped; unchanged if no error is allowed.
  [[nodiscard]] double enough(double squared) const noexcept {
    if (approximation->relative_error == 0 && approximation->absolute_error == 0) return squared;
    const double least = converged_beyond(*approximation, std::sqrt(squared));
    return std::min(squared, least * least);
  }

  // Computed relative to the point, so that rounding depends on the distance and the triangle's
  // size.
  void note_lower(const Triangle& triangle, const Eigen::Vector3d& closest,
                  double squared) noexcept {
    std::array<Eigen::Vector3d, 3> corner;
    for (std::size_t c = 0; c < 3; ++c) corner[c] = triangle.corner[c] - point;
    const double max_abs = max_abs_of(corner);
    // Each corner is off by a rounding of its difference on each axis, less than this in length.
    const double off = 2 * kRoundoffF64 * max_abs;
    const std::array<Eigen::Vector3d, 1> here{Eigen::Vector3d::Zero()};
    const double lower = separation_near(here[0], Eigen::Vector3d(closest - point), here, corner,
                                         max_abs, std::sqrt(squared) - 16 * off)
                             .lower;
    tested_lower = std::min(tested_lower, std::max(0.0, lower - off));
  }
};

/// A caller's point, checked, in tree space.
struct QueriedPoint {
  QueriedPoint(const BoundTree& tree, const Eigen::Vector3d& queried, double max_distance) noexcept;

  Eigen::Vector3d point;
  double most = 0;                // squared distance
  const char* invalid = nullptr;  // the argument that is not valid, or null
};

/// The answer of a query whose walk is over, without an error, in object space.
[[nodiscard]] PointResult described(PointQuery& query) noexcept;

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, PointQuery& query);

/// closest_point for callers that have made the query themselves. Returns the first error, if any.
Errc find_nearest(const BoundTree& tree, PointQuery& query);

}  // namespace boxtree
