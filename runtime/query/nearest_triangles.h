// SPDX-License-Identifier: MIT
// The nearest triangles of two trees so far: what distance walks of all codecs share, compiled
// once.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <boxtree/query.h>

#include "format/children.h"
#include "format/limits.h"
#include "runtime/primitive/rounding.h"
#include "runtime/query/approximation.h"
#include "runtime/query/known_extents.h"
#include "runtime/query/leaf_reading.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/scaled_length.h"
#include "runtime/query/world_metric.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree {

/// The nearest pair of triangles so far, in the metric's units.
struct NearestPair {
  double lower = std::numeric_limits<double>::infinity();  // of all triangles compared
  double upper = std::numeric_limits<double>::infinity();
  double least = std::numeric_limits<double>::infinity();  // these are at least that far apart
  FacePair faces{};
  Eigen::Vector3d origin;  // first tree's space; the points are differences from here
  Eigen::Vector3d first;
  Eigen::Vector3d second;
};

/// A lower bound of the distance whose squared lower bound is `key`. The root of a rounded square
/// may be too large by a factor of 1 + u, that of one that underflows by less than
/// kLengthUnderflow.
[[nodiscard]] inline double root_below(double key) noexcept {
  return std::max(0.0, std::sqrt(key) * (1 - 2 * kRoundoffF64) - kLengthUnderflow);
}

/// Compares the triangles of leaves and keeps the distance from which pairs can be skipped.
/// Everything passed by reference must outlive it.
class NearestTriangles {
 public:
  /// `approximation` is in the metric's units.
  NearestTriangles(const BoundTree& first, const BoundTree& second, const RelativePose& pose,
                   const WorldMetric& metric, const Approximation& approximation) noexcept
      : first_(first),
        second_(second),
        pose_(pose),
        metric_(metric),
        approximation_(approximation),
        leaves_(first, second, pose) {
    set_enough();
  }

  /// The triangles of two leaves, whose squared distance is at least `key`. Errors: those of
  /// corrupt leaves.
  [[nodiscard]] Errc compare(NodeRef first, NodeRef second, double key) noexcept;
  /// The same before the search, which comes upon them again: only what is found counts, and that
  /// only within the maximal distance.
  [[nodiscard]] Errc begin_with(NodeRef first, NodeRef second) noexcept;

  /// From now on boxes are also compared along this world vector and across it.
  void face(const Eigen::Vector3d& along) noexcept {
    axes_ = metric_.axes_along(along, pose_);
    for (KnownExtents& known : known_) known.forget();
  }
  /// Along the line between the nearest points so far; at first the vector passed to face().
  [[nodiscard]] const AlignedAxes& axes() const noexcept { return axes_; }
  /// What is known of extents along them, of the first tree, 0, or the second, 1. Those of leaves
  /// are added where they are needed.
  [[nodiscard]] KnownExtents& known(std::size_t tree) noexcept { return known_[tree]; }
  /// Finds the extent of a leaf along the axes, and reads it where that is not known. Errors: those
  /// of corrupt leaves.
  [[nodiscard]] Errc find_extent(std::size_t tree, NodeRef leaf, Box<double>& extent) noexcept;

  /// The squared distance from which pairs can be skipped: they could improve the answer by no more
  /// than the allowed error or rounding, or are beyond the maximal distance.
  [[nodiscard]] double enough() const noexcept { return enough_; }
  /// The same for an allowed error of 0.
  [[nodiscard]] double best() const noexcept { return best_; }
  /// Records a skipped pair, by the lower bound of its squared distance.
  void leave(double key) noexcept { left_ = std::min(left_, key); }
  /// The least key of the skipped pairs.
  [[nodiscard]] double left() const noexcept { return left_; }

  [[nodiscard]] bool has_any() const noexcept {
    return pair_.upper != std::numeric_limits<double>::infinity();
  }
  /// Whether it is within the maximal distance, to within rounding.
  [[nodiscard]] bool is_within() const noexcept {
    return has_any() && pair_.least <= approximation_.max_distance;
  }
  [[nodiscard]] const NearestPair& pair() const noexcept { return pair_; }

 private:
  // Triangles are no nearer than their leaves, of which more may be known than now tells them
  // apart.
  void leave_triangles(double key) noexcept { leave(std::max(key, leaves_key_)); }
  void compare(const Triangle& p, std::uint32_t i, const Triangle& q, std::uint32_t j) noexcept;
  [[nodiscard]] bool is_apart(const Triangle& p, const Triangle& q, double size,
                              double error) noexcept;
  // The distance from which a pair cannot improve the answer by more than `rounding`.
  [[nodiscard]] double best_to_improve(double rounding) const noexcept;
  void set_enough() noexcept;

  const BoundTree& first_;
  const BoundTree& second_;
  const RelativePose& pose_;
  const WorldMetric& metric_;
  const Approximation& approximation_;
  double leaves_key_ = 0;  // of the pair of leaves that is compared
  double enough_ = 0;
  double best_ = 0;
  double left_ = std::numeric_limits<double>::infinity();
  NearestPair pair_;
  double rounding_ = 0;                                // of the best distance
  std::uint64_t in_vain_ = 0;                          // triangles compared since it was found
  Eigen::Vector3d between_ = Eigen::Vector3d::Zero();  // separates its triangles; world
  AlignedAxes axes_;
  LeafReading leaves_;
  TriangleBatch learnt_;  // from the leaf whose extent was found last
  std::array<KnownExtents, 2> known_;
};

}  // namespace boxtree
