// SPDX-License-Identifier: MIT
// Where the triangles of two trees touch: what both share, and how they part.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/contact.h>

#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/float_state.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/predicates.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/triangle_distance.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/pair_query.h"
#include "runtime/query/relative_pose.h"
#include "runtime/walk/read_leaf.h"

namespace boxtree {
namespace {

using Corners = std::array<Eigen::Vector3d, 3>;

// Two triangles that touch, relative to a point near them.
class TouchingTriangles {
 public:
  TouchingTriangles(const Corners& first, const Corners& second) noexcept
      : first_(first),
        second_(second),
        // A point of an edge, of a cut and of a plane: some 20 u each.
        error_(64 * kRoundoffF64 * std::max(max_abs_of(first), max_abs_of(second))) {
    share();
    part();
  }

  // Points of both: the ends of what they share.
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  // The second leaves the first soonest along it.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double depth = std::numeric_limits<double>::infinity();

 private:
  void share() noexcept {
    cut(first_, second_);
    cut(second_, first_);
    if (count_ == 0) {
      // Too thin to have planes. Segments along each other share some of their ends.
      for (const Eigen::Vector3d& corner : first_) keep(corner);
      for (const Eigen::Vector3d& corner : second_) keep(corner);
    }
    if (count_ == 0) {
      const TriangleDistance nearest = triangle_distance({first_}, {second_});
      points_[count_++] = (nearest.first + nearest.second) / 2;
    }
    double most = -1;
    for (std::size_t i = 0; i < count_; ++i) {
      for (std::size_t j = i; j < count_; ++j) {
        const double length = squared_length(points_[j] - points_[i]);
        if (!(length > most)) continue;
        most = length;
        start = points_[i];
        end = points_[j];
      }
    }
  }

  // Collects where the plane of a triangle cuts what is left of another one above it, widened by
  // rounding, so that an edge of both is left whole.
  void cut(const Corners& base, const Corners& other) noexcept {
    const Eigen::Vector3d n = unit_normal({base});
    if (n.isZero(0)) return;
    constexpr std::size_t kMost = 6;  // each edge of the base adds one
    std::array<Eigen::Vector3d, kMost> polygon;
    std::copy(other.begin(), other.end(), polygon.begin());
    std::size_t count = other.size();
    const Corners edge = edges_of(base);
    for (std::size_t e = 0; e < edge.size(); ++e) {
      const Eigen::Vector3d inward = cross(n, edge[e]);
      const double slack = error_ * std::sqrt(squared_length(inward));
      const auto inside = [&](const Eigen::Vector3d& x) {
        return dot(inward, x - base[e]) + slack;
      };
      std::array<Eigen::Vector3d, kMost> kept;
      std::size_t left = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d& a = polygon[i];
        const Eigen::Vector3d& b = polygon[(i + 1) % count];
        const double of_a = inside(a), of_b = inside(b);
        if (of_a >= 0 && left < kMost) kept[left++] = a;
        if ((of_a >= 0) != (of_b >= 0) && left < kMost) {
          // Where the edge itself is met, not what it was widened to, from which a sharp angle
          // leads far.
          const double t = (of_a - slack) / (of_a - of_b);
          kept[left++] = a + std::clamp(t, 0.0, 1.0) * (b - a);
        }
      }
      std::copy_n(kept.begin(), left, polygon.begin());
      count = left;
    }
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& a = polygon[i];
      const Eigen::Vector3d& b = polygon[(i + 1) % count];
      const double of_a = dot(n, a - base[0]), of_b = dot(n, b - base[0]);
      if (std::abs(of_a) <= error_) keep(a);
      if ((of_a < 0) != (of_b < 0)) keep(a + (of_a / (of_a - of_b)) * (b - a));
    }
  }

  // If the point is on both; what a flat angle or a thin triangle makes of it may not be.
  void keep(const Eigen::Vector3d& point) noexcept {
    for (const Corners& of : {first_, second_}) {
      const Eigen::Vector3d off = closest_point_on_triangle(point, {of}) - point;
      if (!(std::sqrt(squared_length(off)) <= error_)) return;
    }
    if (count_ < points_.size()) points_[count_++] = point;
  }

  // By the normals of their Minkowski difference.
  void part() noexcept {
    try_axis(unit_normal({first_}));
    try_axis(unit_normal({second_}));
    for (const Eigen::Vector3d& a : edges_of(first_)) {
      for (const Eigen::Vector3d& b : edges_of(second_)) {
        try_axis(unit_normal({{Eigen::Vector3d::Zero(), a, b}}));
      }
    }
    if (!normal.isZero(0)) {
      depth = std::max(0.0, depth);
      return;
    }
    // Two segments along each other, or a point: any direction across.
    Eigen::Vector3d along = Eigen::Vector3d::Zero();
    for (const Corners& edges : {edges_of(first_), edges_of(second_)}) {
      for (const Eigen::Vector3d& edge : edges) {
        if (squared_length(edge) > squared_length(along)) along = edge;
      }
    }
    normal = unit_across(along);
    depth = 0;
  }

  // Along a vector of length 1, either way, or 0: then it is none. An earlier one wins unless a
  // later one is better by more than rounding.
  void try_axis(const Eigen::Vector3d& axis) noexcept {
    if (axis.isZero(0)) return;
    const auto range_of = [&](const Corners& corners) {
      const std::array<double, 3> at{dot(axis, corners[0]), dot(axis, corners[1]),
                                     dot(axis, corners[2])};
      return std::minmax({at[0], at[1], at[2]});
    };
    const auto [first_low, first_high] = range_of(first_);
    const auto [second_low, second_high] = range_of(second_);
    if (first_high - second_low < depth - error_) {
      depth = first_high - second_low;
      normal = axis;
    }
    if (second_high - first_low < depth - error_) {
      depth = second_high - first_low;
      normal = -axis;
    }
  }

  const Corners& first_;
  const Corners& second_;
  const double error_;
  std::array<Eigen::Vector3d, 24> points_;  // of each triangle, two for each of six edges of a cut
  std::size_t count_ = 0;
};

// The triangles of a face. Pairs are found leaf by leaf, so the leaf that was read last is kept.
class FaceTriangles {
 public:
  explicit FaceTriangles(const BoundTree& tree) noexcept : tree_(tree) {}

  /// Errors: those of corrupt leaves.
  [[nodiscard]] Errc read(std::uint32_t face) noexcept {
    const std::uint32_t original = tree_.original_of(face);
    if (const std::uint32_t first = original / kLeafFaces * kLeafFaces; first != first_read_) {
      first_read_ = kNoFaceId;
      const std::uint32_t faces = tree_.leaves().mesh().face_count;
      const Errc error = read_leaf(tree_, {first, std::min(kLeafFaces, faces - first)}, leaf_);
      if (error != Errc::kOk) return error;
      first_read_ = first;
    }
    begin_ = 0;
    while (begin_ < leaf_.count && leaf_.face[begin_] != original) ++begin_;
    count_ = 0;
    while (begin_ + count_ < leaf_.count && leaf_.face[begin_ + count_] == original) ++count_;
    return count_ == 0 ? Errc::kFaceOutOfRange : Errc::kOk;
  }

  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
  [[nodiscard]] Triangle operator[](std::uint32_t half) const noexcept {
    return leaf_.triangle(begin_ + half);
  }

 private:
  const BoundTree& tree_;
  std::uint32_t first_read_ = kNoFaceId;  // of the faces of leaf_
  TriangleBatch leaf_;
  std::uint32_t begin_ = 0, count_ = 0;  // of its triangles
};

// The contacts of pairs of faces.
class PairContacts {
 public:
  PairContacts(const BoundTree& first, const Pose& first_pose, const BoundTree& second,
               const RelativePose& pose, PairContactVisitor visitor) noexcept
      : first_(first),
        first_pose_(first_pose),
        pose_(pose),
        visitor_(visitor),
        of_first_(first),
        of_second_(second) {}

  /// kOk, or why a face could not be read.
  [[nodiscard]] Errc error() const noexcept { return error_; }

  // Returns whether to go on.
  [[nodiscard]] bool visit(const FacePair& faces) {
    error_ = of_first_.read(faces.first.index);
    if (error_ == Errc::kOk) error_ = of_second_.read(faces.second.index);
    if (error_ != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < of_first_.count(); ++i) {
      const Triangle fixed = of_first_[i];
      for (std::uint32_t j = 0; j < of_second_.count(); ++j) {
        const Triangle moved = pose_.to_first().apply(of_second_[j]);
        if (!triangles_intersect(fixed, moved)) continue;
        PairContact contact = contact_of(fixed, moved);
        contact.faces = faces;
        contact.first_triangle = i;
        contact.second_triangle = j;
        if (!visitor_(contact)) return false;
      }
    }
    return true;
  }

 private:
  // Both in the first tree's space.
  [[nodiscard]] PairContact contact_of(const Triangle& first, const Triangle& second) const {
    const Frame& frame = first_.frame();
    const Eigen::Vector3d& near = first.corner[0];
    const Eigen::Matrix3d linear = first_pose_.linear();
    const auto placed = [&](const Triangle& triangle) {
      Corners corners;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i] = product(linear, frame.scale * (triangle.corner[i] - near));
      }
      return corners;
    };
    const Corners of_first = placed(first), of_second = placed(second);
    const TouchingTriangles touching(of_first, of_second);
    const Eigen::Vector3d origin =
        product(linear, frame.to_object(near)) + first_pose_.translation();
    PairContact contact;
    contact.start = origin + touching.start;
    contact.end = origin + touching.end;
    contact.point = origin + (touching.start + touching.end) / 2;
    contact.normal = touching.normal;
    contact.depth = touching.depth;
    return contact;
  }

  const BoundTree& first_;
  const Pose& first_pose_;
  const RelativePose& pose_;
  PairContactVisitor visitor_;
  FaceTriangles of_first_, of_second_;
  Errc error_ = Errc::kOk;
};

}  // namespace

Result<Visit> visit_pair_contacts(const BoundTree& first, const Pose& first_pose,
                                  const BoundTree& second, const Pose& second_pose,
                                  PairContactVisitor visitor, QueryWork& work) {
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  PairContacts contacts(first, first_pose, second, *pose, visitor);
  const auto visit_pair = [&](const FacePair& faces) { return contacts.visit(faces); };
  const Result<Visit> visit = visit_pairs(first, first_pose, second, second_pose, visit_pair, work);
  if (contacts.error() != Errc::kOk) return contacts.error();
  return visit;
}

Result<Visit> pair_contacts(const Tree& first, const Pose& first_pose, const Tree& second,
                            const Pose& second_pose, PairContactVisitor visitor,
                            const QueryLimits& limits) {
  const DefaultFloatState state;
  QueryWork work(limits);
  return visit_pair_contacts(BoundTree::of(first), first_pose, BoundTree::of(second), second_pose,
                             visitor, work);
}

}  // namespace boxtree
