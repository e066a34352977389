// SPDX-License-Identifier: MIT
// The placement of an instance: the map from its tree's space to the world, and bounds of its
// rounding errors and of its distortion.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include <boxtree/query.h>
#include <boxtree/ray.h>

#include "format/box.h"
#include "runtime/primitive/triangle.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// Bounds of a placed tree's extent and of its rounding errors.
struct PlacementBounds {
  /// A world box that holds the tree, including the rounding of its triangles; widened by error().
  Box<double> world;
  /// Upper bound of how much the map back from the world magnifies errors: 1 for an axis-parallel
  /// map, up to 3 for a rotation, more for a map that shears or stretches unevenly.
  double condition;
  double magnitude;  // no term of a world coordinate's sum is larger

  /// Upper bound, on any axis and in the world, of the rounding of what is compared with the tree:
  /// on the way to the world, or back to where the tree compares it.
  [[nodiscard]] double error() const noexcept;
  /// error() of a tree that is the origin.
  static constexpr double kLeastError = std::numeric_limits<double>::min();
};

/// A tree and its pose. The world coordinates of a triangle are to_world().apply() of each corner
/// as the tree decodes it: what brute force over all instances compares, and what box, sphere and
/// point queries of a scene compare in the end. Keeps only what every query needs, as queries make
/// one for each instance that they visit. Computed in one fixed order of operations that IEEE 754
/// defines, because the bytes of cooked files depend on it.
class Placement {
 public:
  /// Nothing when the pose is not finite or not invertible.
  static std::optional<Placement> make(const Frame& frame, const Pose& pose) noexcept;
  /// The same for a tree with that frame.
  static std::optional<Placement> make(const BoundTree& tree, const Pose& pose) noexcept {
    return make(tree.frame(), pose);
  }

  [[nodiscard]] const AffineMap& to_world() const noexcept { return to_world_; }
  /// The map to the world alone, without checks.
  [[nodiscard]] static AffineMap map_to_world(const Frame& frame, const Pose& pose) noexcept;
  /// The ray in object space; its parameters are unchanged.
  [[nodiscard]] Ray to_object(const Ray& world) const noexcept;
  /// A point of the world in tree space.
  [[nodiscard]] Eigen::Vector3d to_tree(const Eigen::Vector3d& world) const noexcept;

  /// A vector of the world in tree space.
  [[nodiscard]] Eigen::Vector3d vector_to_tree(const Eigen::Vector3d& world) const noexcept;

  /// See PlacementBounds.
  [[nodiscard]] double condition() const noexcept;
  /// For a tree with this root box. Nothing when they are not finite or beyond kMaxCoordinate.
  /// Precondition: the tree is not empty.
  [[nodiscard]] std::optional<PlacementBounds> bounds(const Box<double>& root) const noexcept;
  /// How far, in the world, `tree` = to_tree(world) may be from `world`; no distance to a triangle
  /// of the tree is off by more. `root`: the box of the tree.
  [[nodiscard]] double distance_error(const Eigen::Vector3d& tree, const Eigen::Vector3d& world,
                                      const Box<double>& root) const noexcept;

  /// How long, in the world, what is missing of `world` in the image of `tree` may be, for
  /// `tree` = vector_to_tree(world).
  [[nodiscard]] double vector_error(const Eigen::Vector3d& tree,
                                    const Eigen::Vector3d& world) const noexcept;

 private:
  Placement() = default;
  [[nodiscard]] Eigen::Matrix3d linear() const noexcept;
  [[nodiscard]] double magnitude(const Box<double>& root) const noexcept;

  AffineMap to_world_;              // from tree space
  Eigen::Matrix3d inverse_;         // of the pose's linear part: world to object
  Eigen::Vector3d translation_;     // of the pose
  Eigen::Vector3d frame_origin_;    // of the tree
  double frame_inverse_scale_ = 1;  // object to tree
};

/// How much a placement changes lengths between tree space and world: for all vectors v,
/// least |v| <= |L v| <= most |v|. `least` is 0 where nothing better is known.
struct Stretch {
  double least;
  double most;
};
[[nodiscard]] Stretch stretch_of(const Eigen::Matrix3d& linear) noexcept;

}  // namespace boxtree
