// SPDX-License-Identifier: MIT
// Where an instance lies: the map from its tree's space to the world, and bounds of what rounding
// and the shape of that map can do.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Core>

#include <boxtree/format/box.h>
#include <boxtree/runtime/primitive/triangle.h>
#include <boxtree/runtime/query/ray.h>
#include <boxtree/runtime/query/relative_pose.h>
#include <boxtree/runtime/query/types.h>

namespace boxtree {

/// A tree and its pose. The world coordinates of a triangle are to_world().apply() of each corner
/// as the tree decodes it: what brute force over all instances compares, and what box, sphere and
/// point queries of a scene compare in the end.
class Placement {
 public:
  /// Nothing when the pose is not finite or not invertible. Computed in one fixed order of
  /// operations that IEEE 754 defines, because a cooked file rests on it.
  /// Precondition: the tree is not empty.
  static std::optional<Placement> make(const Tree& tree, const Pose& pose) noexcept;
  /// The same for a tree with this frame and root box.
  static std::optional<Placement> make(const Frame& frame, const Box<double>& root,
                                       const Pose& pose) noexcept;

  [[nodiscard]] const AffineMap& to_world() const noexcept { return to_world_; }

  /// A box of the world that holds the tree, whatever rounding makes of its triangles; widened by
  /// error().
  [[nodiscard]] const Box<double>& world_box() const noexcept { return world_box_; }

  /// How far on any axis what is compared with the tree can be off by rounding, in the world: on
  /// its way here, or back to where the tree compares it. The share of the tree; of another body's
  /// coordinates it is error_of().
  [[nodiscard]] double error() const noexcept { return error_of(magnitude_); }
  [[nodiscard]] double error_of(double magnitude) const noexcept;
  /// By how much going back from the world magnifies errors at most: 1 for an axis-parallel map, up
  /// to 3 for a rotation, more for a map that shears or stretches unevenly.
  [[nodiscard]] double condition() const noexcept { return condition_; }

  /// The ray in object space; parameters stay.
  [[nodiscard]] Ray to_object(const Ray& world) const noexcept;
  /// A point of the world in tree space, and how far, in the world, it may be from there.
  [[nodiscard]] Eigen::Vector3d to_tree(const Eigen::Vector3d& world) const noexcept;
  [[nodiscard]] double distance_error(const Eigen::Vector3d& tree,
                                      const Eigen::Vector3d& world) const noexcept;

 private:
  Placement() = default;

  AffineMap to_world_;              // from tree space
  Eigen::Matrix3d inverse_;         // of the pose's linear part: world to object
  Eigen::Vector3d translation_;     // of the pose
  Eigen::Vector3d frame_origin_;    // of the tree
  double frame_inverse_scale_ = 1;  // object to tree
  Box<double> world_box_{};
  double magnitude_ = 0;
  double condition_ = 0;
};

/// How much a placement changes lengths between tree space and world: for all vectors v,
/// least |v| <= |L v| <= most |v|. `least` is 0 where nothing better is known.
struct Stretch {
  double least;
  double most;
};
[[nodiscard]] Stretch stretch_of(const Eigen::Matrix3d& linear) noexcept;

}  // namespace boxtree
