// SPDX-License-Identifier: MIT
// What touches a shape: the faces that share a point with a box or a sphere, and overlap as far as
// it matters (overlapping, disjoint, or too close to be worth telling). Queries that
// BOXTREE_QUERIES left out of this build are not declared.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/query.h>
#include <boxtree/shape.h>

namespace boxtree {

static_assert(BOXTREE_HAS_BOX_QUERIES || BOXTREE_HAS_SPHERE_QUERIES || BOXTREE_HAS_WITHIN_QUERIES ||
                  BOXTREE_HAS_FRUSTUM_QUERIES,
              "BOXTREE_QUERIES left box, sphere, frustum and within queries out of this build of "
              "boxtree");

#if BOXTREE_HAS_BOX_QUERIES
/// Visits every face that touches the closed box `box` (object space), each once, in no promised
/// order. Touching counts. Errors: kInvalidQuery (NaN, infinite or empty box) and the codes of
/// corrupt bytes and limits as for closest_hit(). Never allocates.
BOXTREE_API Result<Visit> overlap_box(const Tree& tree, const Eigen::AlignedBox3d& box,
                                      FaceVisitor visitor, const QueryLimits& limits = {});
#endif

#if BOXTREE_HAS_SPHERE_QUERIES
/// Visits every face whose distance from `center` is at most `radius` (object space), each once, in
/// no promised order. Errors: kInvalidQuery (NaN, infinite, negative radius) and the codes of
/// corrupt bytes and limits as for closest_hit(). Never allocates.
BOXTREE_API Result<Visit> overlap_sphere(const Tree& tree, const Eigen::Vector3d& center,
                                         double radius, FaceVisitor visitor,
                                         const QueryLimits& limits = {});
/// The same of a sphere as casts and collide() take it.
inline Result<Visit> overlap_sphere(const Tree& tree, const Sphere& sphere, FaceVisitor visitor,
                                    const QueryLimits& limits = {}) {
  return overlap_sphere(tree, sphere.center, sphere.radius, visitor, limits);
}
#endif

#if BOXTREE_HAS_FRUSTUM_QUERIES
/// What z / w of clip space is for what is visible.
enum class ClipDepth : std::uint8_t {
  kZeroToOne,      ///< Direct3D, Metal, Vulkan and others, also reversed.
  kMinusOneToOne,  ///< OpenGL.
};

/// The points x for which a x + b y + c z + d >= 0, for each of six planes (a, b, c, d): what a
/// camera sees. Planes have any length; one with a = b = c = 0 and d of 0 or more cuts nothing off,
/// as the far plane of a projection without one.
struct Frustum {
  /// Unaligned, so that their layout does not depend on compiler options.
  using Plane = Eigen::Matrix<double, 4, 1, Eigen::DontAlign>;
  /// A matrix of four rows of four numbers, which takes (x, y, z, 1) to clip space.
  using ViewProjection = Eigen::Matrix<double, 4, 4, Eigen::DontAlign>;

  std::array<Plane, 6> planes;  ///< Object space; normals point inside.

  /// Of the matrix that takes column vectors (x, y, z, 1) to clip space: projection * view * model,
  /// where engines with row vectors have the transposed one. The planes are left, right, bottom,
  /// top, and those of the least and the greatest depth.
  [[nodiscard]] BOXTREE_API static Frustum of(const ViewProjection& view_projection,
                                              ClipDepth depth = ClipDepth::kZeroToOne) noexcept;
  /// Of its corners: four around the near side, and those behind them in the same order. All of
  /// them are inside, but for rounding.
  [[nodiscard]] BOXTREE_API static Frustum of(
      const std::array<Eigen::Vector3d, 8>& corners) noexcept;
};

/// Visits every face that touches the frustum, each once, in no promised order: not those that are
/// near it only, as culling by boxes or by one plane after the other has them. Nothing is missed; a
/// face may be visited that touches it with its planes moved out by 2^-46 of the largest
/// coordinate, or of their distance from the origin. Errors: kInvalidQuery (planes that are not
/// finite) and the codes of corrupt bytes and limits as for closest_hit(). Never allocates.
BOXTREE_API Result<Visit> overlap_frustum(const Tree& tree, const Frustum& frustum,
                                          FaceVisitor visitor, const QueryLimits& limits = {});
#endif

#if BOXTREE_HAS_WITHIN_QUERIES
/// What is known of two things.
enum class Overlap : std::uint8_t {
  kOverlapping,  ///< Some face touches.
  kDisjoint,     ///< None does.
  kUndecided,    ///< Not told apart, and closer to each other than the given distance.
  kBudgetSpent,  ///< The budget ran out before anything was known.
};

/// Whether two surfaces touch.
struct PairOverlap {
  Overlap overlap = Overlap::kDisjoint;  ///< What is known.
  std::optional<FacePair> contact;       ///< Where they overlap.
  std::uint64_t nodes_expanded = 0;      ///< Pairs of nodes expanded and of leaves compared.
};

/// Whether two surfaces touch. Overlapping and disjoint are certain: exact predicates decide, as
/// for overlap_pairs(). Where the walk comes upon parts of both that are closer than `distance` (in
/// the world) it may end with kUndecided: the larger the distance, the earlier; never if it is 0.
/// The walk ends with kBudgetSpent rather than visit more than `node_budget` pairs. Poses as for
/// overlap_pairs(). Errors: kInvalidPose, kInvalidQuery (distance NaN or negative) and those of
/// corrupt bytes. Never allocates; takes up to 192 KB of stack.
BOXTREE_API Result<PairOverlap> overlap_within(const Tree& first, const Pose& first_pose,
                                               const Tree& second, const Pose& second_pose,
                                               double distance,
                                               std::uint64_t node_budget = kUnlimitedNodes);

/// Whether a box touches a surface.
struct BoxOverlap {
  Overlap overlap = Overlap::kDisjoint;  ///< What is known.
  std::optional<FaceRef> face;           ///< Where they overlap.
  std::uint64_t nodes_expanded = 0;      ///< Nodes expanded and leaves read.
};

/// Whether a closed box and the surface touch, in object space; kUndecided and `node_budget` as for
/// overlap_within(). Overlapping and disjoint are certain: exact predicates decide, as for
/// overlap_box(). Errors: kInvalidQuery (NaN, infinite or empty box, distance NaN or negative) and
/// the codes of corrupt bytes as for closest_hit(). Never allocates.
BOXTREE_API Result<BoxOverlap> overlap_box_within(const Tree& tree, const Eigen::AlignedBox3d& box,
                                                  double distance,
                                                  std::uint64_t node_budget = kUnlimitedNodes);
#endif

}  // namespace boxtree
