// SPDX-License-Identifier: MIT
// Compares the triangles of two leaves, except where bounds show that they are too far apart.
#include "runtime/query/nearest_triangles.h"

#include <cmath>
#include <cstddef>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/child_gaps.h"
#include "runtime/walk/read_leaf.h"
#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

// Rounding leaves about 2^-46 of the largest coordinate between the bounds of two triangles
// (triangle_distance.h), and as little for moving them to the world. Pairs that can improve the
// answer by no more than this are skipped: the bounds stay within the promised 2^-44.
constexpr double kRounding = 0x1p-45;

// Such pairs are compared nevertheless until this many comparisons have brought no improvement,
// more than the pairs of faces at two vertices. Then faces lie in parallel planes or on each other,
// and all are equally near.
constexpr std::uint64_t kPatience = 1024;

// The direction that separates two triangles best: between two points of them, or along a normal.
// Where a face lies along the other triangle all three are the same except for rounding, which
// tilts the line between two points the more the nearer they are.
Eigen::Vector3d separating_direction(const Eigen::Vector3d& between, const Triangle& p,
                                     const Triangle& q, double size) noexcept {
  Eigen::Vector3d best = between;
  double most = separation_along(best, p.corner, q.corner, size);
  for (const Triangle* face : {&p, &q}) {
    Eigen::Vector3d normal =
        cross(face->corner[1] - face->corner[0], face->corner[2] - face->corner[0]);
    if (dot(normal, between) < 0) normal = -normal;
    const double apart = separation_along(normal, p.corner, q.corner, size);
    if (!(apart > most)) continue;
    most = apart;
    best = normal;
  }
  return best;
}

}  // namespace

// At least half of the best distance, so that a contact, whose keys are 0, is never skipped.
double NearestTriangles::best_to_improve(double rounding) const noexcept {
  if (in_vain_ < kPatience) return pair_.upper;
  return std::max(pair_.upper - rounding, pair_.upper / 2);
}

// An allowed error may skip what could be nearer than the pair so far, but not what could be within
// the maximal distance if that pair is not.
void NearestTriangles::set_enough() noexcept {
  const double best = best_to_improve(rounding_);
  const double enough =
      is_within() ? std::min(converged_beyond(approximation_, pair_.upper), best) : best;
  // The next double above: pairs exactly at the maximal distance count.
  const double most = std::nextafter(approximation_.max_distance * approximation_.max_distance,
                                     std::numeric_limits<double>::infinity());
  enough_ = std::min(enough * enough, most);
  best_ = std::min(best * best, most);
}

// Skips triangles whose bounds are as far as the best. The allowed error must not skip more here:
// what is found in a leaf would depend on it, and a larger error could miss the pair that ends the
// walk of a smaller one.
Errc NearestTriangles::compare(NodeRef first, NodeRef second, double key) noexcept {
  leaves_key_ = key;
  Box<double> first_extent, second_extent;
  if (const Errc error = find_extent(0, first, first_extent); error != Errc::kOk) return error;
  if (const Errc error = find_extent(1, second, second_extent); error != Errc::kOk) return error;
  if (const double apart = axes_.squared_distance(first_extent, second_extent); !(apart < best_)) {
    leave_triangles(apart);
    return Errc::kOk;
  }
  if (const Errc error = leaves_.read(first, second); error != Errc::kOk) return error;
  std::array<Box<double>, kMaxLeafTriangles> second_extents;
  for (std::uint32_t j = 0; j < leaves_.second.count; ++j) {
    second_extents[j] = axes_.extent_of(1, leaves_.second.triangle(j));
  }
  const GapWeights& gaps = metric_.in_first();
  const double upper_before = pair_.upper;
  for (std::uint32_t i = 0; i < leaves_.first.count; ++i) {
    const Triangle triangle = leaves_.first.triangle(i);
    const Box<double> extent = axes_.extent_of(0, triangle);
    const double to_leaf =
        std::max(axes_.squared_distance(extent, second_extent),
                 gaps.squared_distance(leaves_.first_bounds[i], leaves_.all_moved_bounds));
    if (!(to_leaf < best_)) {
      leave_triangles(to_leaf);
      continue;
    }
    for (std::uint32_t j = 0; j < leaves_.second.count; ++j) {
      const double apart =
          std::max(axes_.squared_distance(extent, second_extents[j]),
                   gaps.squared_distance(leaves_.first_bounds[i], leaves_.moved_bounds[j]));
      if (!(apart < best_)) {
        leave_triangles(apart);
        continue;
      }
      compare(triangle, i, leaves_.moved[j], j);
    }
  }
  if (pair_.upper < upper_before) face(between_);
  return Errc::kOk;
}

Errc NearestTriangles::begin_with(NodeRef first, NodeRef second) noexcept {
  const AlignedAxes axes = axes_;
  if (const Errc error = compare(first, second, 0); error != Errc::kOk) return error;
  left_ = pair_.lower = std::numeric_limits<double>::infinity();
  in_vain_ = 0;
  if (is_within()) return Errc::kOk;
  pair_.upper = pair_.least = std::numeric_limits<double>::infinity();
  rounding_ = 0;
  axes_ = axes;
  set_enough();
  return Errc::kOk;
}

// Most leaves have met others since the axes changed, and are not read.
Errc NearestTriangles::find_extent(std::size_t tree, NodeRef leaf, Box<double>& extent) noexcept {
  if (const Box<double>* known = known_[tree].find(leaf, true)) {
    extent = *known;
    return Errc::kOk;
  }
  const Errc error = read_leaf(tree == 0 ? first_ : second_, leaf, learnt_);
  if (error != Errc::kOk) return error;
  extent = extent_of(axes_, tree, learnt_);
  known_[tree].keep(leaf, true, extent);
  return Errc::kOk;
}

// Corners are taken relative to one of them, so that rounding depends on the triangles' size and
// distance and not on their position.
void NearestTriangles::compare(const Triangle& p, std::uint32_t i, const Triangle& q,
                               std::uint32_t j) noexcept {
  const Eigen::Vector3d& origin = p.corner[0];
  Triangle p_world, q_world;
  double max_abs = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector3d to_p = p.corner[c] - origin;
    const Eigen::Vector3d to_q = q.corner[c] - origin;
    max_abs = std::max({max_abs, to_p.cwiseAbs().maxCoeff(), to_q.cwiseAbs().maxCoeff()});
    p_world.corner[c] = metric_.to_world(to_p);
    q_world.corner[c] = metric_.to_world(to_q);
  }
  // Both triangles may be displaced by the error of their corners.
  const double error = 2 * metric_.image_error() * max_abs;
  const double size = std::max(max_abs_of(p_world.corner), max_abs_of(q_world.corner));
  if (has_any() && is_apart(p_world, q_world, size, error)) return;
  TriangleDistance found = triangle_distance(p_world, q_world);
  found.lower = std::max(0.0, found.lower - error);
  found.upper += error;
  if (!(found.lower > 0) && triangles_intersect(p, q)) found.lower = found.upper = 0;
  // What was known of the leaves can be more by some roundings: a search that goes on never tells
  // less than one that ended before them.
  found.lower = std::min(std::max(found.lower, root_below(leaves_key_)), found.upper);
  pair_.lower = std::min(pair_.lower, found.lower);
  if (++in_vain_ == kPatience) set_enough();
  if (!(found.upper < pair_.upper)) return;
  if (found.upper < pair_.upper - rounding_) in_vain_ = 0;
  pair_.upper = found.upper;
  pair_.least = found.lower;
  rounding_ = kRounding * size;
  between_ = separating_direction(found.second - found.first, p_world, q_world, size);
  pair_.faces = {face_ref(first_, leaves_.first.face[i]),
                 face_ref(second_, leaves_.second.face[j])};
  pair_.origin = origin;
  pair_.first = found.first;
  pair_.second = found.second;
  set_enough();
}

// Whether two triangles are as far as the best along the line between the nearest points so far.
// Many faces in parallel planes are, and this costs far less than their distance. Unlike the ends
// of boxes and leaves, these projections are relative to one of the corners, so that they lose no
// more to rounding than the distance itself.
bool NearestTriangles::is_apart(const Triangle& p, const Triangle& q, double size,
                                double error) noexcept {
  const double lower = separation_along(between_, p.corner, q.corner, size) - error;
  const double key = lower * lower;
  if (!(lower > 0)) return false;
  // A comparison could not narrow the bounds below this fraction of their size.
  if (key < best_ && lower < best_to_improve(kRounding * size)) return false;
  leave_triangles(key);
  return true;
}

}  // namespace boxtree
