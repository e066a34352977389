// SPDX-License-Identifier: MIT
// The convex shapes that queries take besides boxes along the axes, and what they touch.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Geometry>

namespace boxtree {

/// A ball.
struct Sphere {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();  ///< Object space.
  double radius = 0;                                 ///< 0 or more.
};

/// All points within a radius of a segment.
struct Capsule {
  Eigen::Vector3d start = Eigen::Vector3d::Zero();  ///< One end of the segment, object space.
  Eigen::Vector3d end = Eigen::Vector3d::Zero();    ///< The other end; may be the same.
  double radius = 0;                                ///< 0 or more.
};

/// A box along axes of its own.
struct OrientedBox {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();        ///< Object space.
  Eigen::Vector3d half_extents = Eigen::Vector3d::Zero();  ///< Along its own axes, 0 or more.
  /// From its axes to those of object space. Need not have a length of 1, but not 0. Unaligned, so
  /// that its layout does not depend on compiler options.
  Eigen::Quaternion<double, Eigen::DontAlign> rotation =
      Eigen::Quaternion<double, Eigen::DontAlign>(1, 0, 0, 0);
};

/// The most points that a ConvexHull may have.
inline constexpr std::size_t kMaxHullPoints = 256;

/// The smallest convex body that holds some points. Points that are inside it, twice the same, on a
/// plane or on a line are fine: nobody needs to compute the hull.
struct ConvexHull {
  /// 1 to kMaxHullPoints, in space of their own; borrowed for the call.
  std::span<const Eigen::Vector3d> points;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< Of their origin, object space.
  /// From their space to object space, about their origin. As OrientedBox::rotation.
  Eigen::Quaternion<double, Eigen::DontAlign> rotation =
      Eigen::Quaternion<double, Eigen::DontAlign>(1, 0, 0, 0);
};

/// The part of a triangle that a contact lies on.
enum class Feature : std::uint8_t {
  kFace,    ///< Its inside.
  kEdge,    ///< An edge, without its ends.
  kVertex,  ///< A corner.
};

}  // namespace boxtree
