// SPDX-License-Identifier: MIT
// Triangles of two leaves, compared where their bounds do not tell that they are too far.
#include "runtime/query/nearest_triangles.h"

#include <cmath>
#include <cstddef>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"
#include "runtime/walk/traversal.h"

namespace boxtree {
namespace {

// What rounding leaves between the bounds of two triangles is some 2^-46 of their largest
// coordinate (triangle_distance.h) and as little for bringing them into the world. What can improve
// the answer by no more than this need not be looked at: the bounds stay within the 2^-44 that is
// promised.
constexpr double kRounding = 0x1p-45;

// It is looked at nevertheless until so many triangles have been compared in vain, more than what
// meets in two vertices: then faces lie in parallel planes or on each other, and all are as near.
constexpr std::uint64_t kPatience = 1024;

// The direction that tells two triangles apart best: between two points of them, or along a normal.
// Where a face lies along the other triangle all three are the same but for rounding, which tilts
// the line between two points the more the nearer they are.
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

// At least half of what was found, so that a contact, whose keys are 0, is always looked for.
double NearestTriangles::best_to_improve(double rounding) const noexcept {
  if (in_vain_ < kPatience) return pair_.upper;
  return std::max(pair_.upper - rounding, pair_.upper / 2);
}

void NearestTriangles::set_enough() noexcept {
  const double best = best_to_improve(rounding_);
  const double enough = std::min(converged_beyond(approximation_, pair_.upper), best);
  // The neighbour above: what is exactly at the maximal distance counts.
  const double most = std::nextafter(approximation_.max_distance * approximation_.max_distance,
                                     std::numeric_limits<double>::infinity());
  enough_ = std::min(enough * enough, most);
  best_ = std::min(best * best, most);
}

// Those whose bounds are as far as the best are left alone. Not those that are nearly as near:
// then what is found in a leaf would depend on the error allowed, and a walk that may err more
// could miss what ends another one early.
Errc NearestTriangles::compare(NodeRef first, NodeRef second) noexcept {
  if (const Errc error = leaves_.read(first, second); error != Errc::kOk) return error;
  const GapWeights& gaps = metric_.in_first();
  set_ends();
  if (const double key = direction_.squared_distance(first_most_, second_least_); !(key < best_)) {
    leave(key);
    return Errc::kOk;
  }
  for (std::uint32_t i = 0; i < leaves_.first.count; ++i) {
    const double to_leaf = gaps.squared_distance(leaves_.first_bounds[i], leaves_.all_moved_bounds);
    if (!(to_leaf < best_)) {
      leave(to_leaf);
      continue;
    }
    const Triangle triangle = leaves_.first.triangle(i);
    for (std::uint32_t j = 0; j < leaves_.second.count; ++j) {
      const double key =
          std::max(direction_.squared_distance(first_end_[i], second_end_[j]),
                   gaps.squared_distance(leaves_.first_bounds[i], leaves_.moved_bounds[j]));
      if (!(key < best_)) {
        leave(key);
        continue;
      }
      compare(triangle, i, leaves_.moved[j], j);
    }
  }
  return Errc::kOk;
}

// Where the triangles of the leaves at hand end along the direction.
void NearestTriangles::set_ends() noexcept {
  for (std::uint32_t i = 0; i < leaves_.first.count; ++i) {
    first_end_[i] = direction_.end_of_first(leaves_.first.triangle(i));
    first_most_ = i == 0 ? first_end_[i] : std::max(first_most_, first_end_[i]);
  }
  for (std::uint32_t j = 0; j < leaves_.second.count; ++j) {
    second_end_[j] = direction_.end_of_moved(leaves_.moved[j]);
    second_least_ = j == 0 ? second_end_[j] : std::min(second_least_, second_end_[j]);
  }
}

// Corners are taken as differences from one of them, so that rounding is that of the triangles'
// size and distance and not of their place.
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
  // Both triangles may lie off by the error of their corners.
  const double error = 2 * metric_.image_error() * max_abs;
  const double size = std::max(max_abs_of(p_world.corner), max_abs_of(q_world.corner));
  if (has_any() && is_apart(p_world, q_world, size, error)) return;
  TriangleDistance found = triangle_distance(p_world, q_world);
  found.lower = std::max(0.0, found.lower - error);
  found.upper += error;
  if (!(found.lower > 0) && triangles_intersect(p, q)) found.lower = found.upper = 0;
  pair_.lower = std::min(pair_.lower, found.lower);
  if (++in_vain_ == kPatience) set_enough();
  if (!(found.upper < pair_.upper)) return;
  if (found.upper < pair_.upper - rounding_) in_vain_ = 0;
  pair_.upper = found.upper;
  rounding_ = kRounding * size;
  between_ = separating_direction(found.second - found.first, p_world, q_world, size);
  pair_.faces = {face_ref(first_, leaves_.first.face[i]),
                 face_ref(second_, leaves_.second.face[j])};
  pair_.origin = origin;
  pair_.first = found.first;
  pair_.second = found.second;
  set_enough();
  face(between_);
  set_ends();
}

// Whether two triangles are as far as the best along the line between the nearest points so far.
// Of faces in parallel planes many are, and this costs far less than their distance does. Unlike
// the ends of boxes and leaves these are seen from one of the corners, so that no more is lost to
// rounding than the distance itself loses.
bool NearestTriangles::is_apart(const Triangle& p, const Triangle& q, double size,
                                double error) noexcept {
  const double lower = separation_along(between_, p.corner, q.corner, size) - error;
  const double key = lower * lower;
  if (!(lower > 0)) return false;
  // A comparison would leave as much of their own size open.
  if (key < best_ && lower < best_to_improve(kRounding * size)) return false;
  leave(key);
  return true;
}

}  // namespace boxtree
