// SPDX-License-Identifier: MIT
// Quad test and ear clipping (Meisters, "Polygons have ears", 1975) on exact orientation signs.
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include <boxtree/cooker/import/polygon_split.h>
#include <boxtree/runtime/primitive/orientation.h>
#include <boxtree/runtime/primitive/vector3.h>

namespace boxtree::cooker {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint32_t kNowhere = 0xffffffffu;

// Coordinates that orient2d takes as they are, with room for products of three of them. Others
// (only f64 positions can hold such) are scaled by a power of two, which changes no sign.
constexpr double kLargest = 0x1p200;
constexpr double kSmallest = 0x1p-200;

// The power of two that brings `largest` near 1, or 1 if there is no need to scale.
double scale_for(double largest) {
  if (largest <= kLargest && (largest >= kSmallest || largest == 0)) return 1;
  return std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
}

double largest_of(const Vector3d& a) {
  return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
}

// Seen along `axis`, from its positive end.
Vector2d flattened(const Vector3d& a, int axis) {
  return {a[(axis + 1) % 3], a[(axis + 2) % 3]};
}

int dominant_axis(const Vector3d& normal) {
  int axis = 2;
  for (int other = 0; other < 2; ++other) {
    if (std::abs(normal[other]) > std::abs(normal[axis])) axis = other;
  }
  return axis;
}

// The determinant of three rows of non-negative numbers with every minus made a plus: an upper
// bound of |determinant| for all rows of at most these magnitudes.
double permanent(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return a[0] * (b[1] * c[2] + b[2] * c[1]) + a[1] * (b[2] * c[0] + b[0] * c[2]) +
         a[2] * (b[0] * c[1] + b[1] * c[0]);
}

Vector3d magnitude(const Vector3d& a) {
  return {std::abs(a[0]), std::abs(a[1]), std::abs(a[2])};
}

// A quad is planar when D = (p1-p0) . ((p2-p0) x (p3-p0)), six times the volume of its corners, is
// 0. Let the corners the author meant be q_i, planar, and p_i = q_i + d_i what rounding made of
// them, |d_i| <= r_i for each coordinate. D is linear in each row, so with rows a, b, c of p and
// e_i = d_i - d_0, |e_i| <= r_i + r_0:
//   D(p) = [terms linear in d] + [terms with two or three of e_1, e_2, e_3], where
//   linear: the derivative of D by p_1, p_2, p_3 is n_1 = b x c, n_2 = c x a, n_3 = a x b, and by
//           p_0 it is n_0 = -(n_1 + n_2 + n_3); so at most the sum of |n_i| . r_i
//   others: at most P(e1,e2,|c|) + P(e1,|b|,e3) + P(|a|,e2,e3) + P(e1,e2,e3), P the permanent.
// Evaluating D in double errs by at most kOrient3dBound P(|a|,|b|,|c|): the same eight roundings.
// A quad within the sum of these is planar as far as its coordinates can tell.
bool is_planar(const std::array<RoundedCorner, 4>& corners) {
  const Vector3d a = corners[1].position - corners[0].position;
  const Vector3d b = corners[2].position - corners[0].position;
  const Vector3d c = corners[3].position - corners[0].position;
  const Vector3d n1 = cross(b, c), n2 = cross(c, a), n3 = cross(a, b);
  const Vector3d n0 = -(n1 + n2 + n3);
  const Vector3d &r0 = corners[0].rounding, &r1 = corners[1].rounding, &r2 = corners[2].rounding,
                 &r3 = corners[3].rounding;
  const Vector3d e1 = r1 + r0, e2 = r2 + r0, e3 = r3 + r0;
  const Vector3d la = magnitude(a), lb = magnitude(b), lc = magnitude(c);
  const double linear = dot(magnitude(n0), r0) + dot(magnitude(n1), r1) + dot(magnitude(n2), r2) +
                        dot(magnitude(n3), r3);
  const double others =
      permanent(e1, e2, lc) + permanent(e1, lb, e3) + permanent(la, e2, e3) + permanent(e1, e2, e3);
  const double arithmetic = kOrient3dBound * permanent(la, lb, lc);
  return std::abs(dot(a, n1)) <= linear + others + arithmetic;
}

bool is_convex(const std::array<RoundedCorner, 4>& corners) {
  const auto position = [&corners](std::size_t i) -> const Vector3d& {
    return corners[i % 4].position;
  };
  const Vector3d normal = cross(position(2) - position(0), position(3) - position(1));
  if (largest_of(normal) == 0) {
    // No area in sum: either no area at all, or two equal halves of a bow tie.
    return is_collinear(position(0), position(1), position(2)) &&
           is_collinear(position(0), position(2), position(3)) &&
           is_collinear(position(0), position(1), position(3));
  }
  const int axis = dominant_axis(normal);
  for (std::size_t i = 0; i < 4; ++i) {
    const int turn = orient2d(flattened(position(i), axis), flattened(position(i + 1), axis),
                              flattened(position(i + 2), axis));
    if (normal[axis] > 0 ? turn < 0 : turn > 0) return false;
  }
  return true;
}

}  // namespace

bool is_collinear(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const double scale = scale_for(std::max({largest_of(a), largest_of(b), largest_of(c)}));
  if (scale != 1) return is_collinear(a * scale, b * scale, c * scale);
  for (int axis = 0; axis < 3; ++axis) {
    if (orient2d(flattened(a, axis), flattened(b, axis), flattened(c, axis)) != 0) return false;
  }
  return true;
}

bool is_planar_convex_quad(const std::array<RoundedCorner, 4>& corners) {
  double largest = 0;
  for (const RoundedCorner& corner : corners) {
    largest = std::max(largest, largest_of(corner.position));
  }
  const double scale = scale_for(largest);
  if (scale == 1) return is_planar(corners) && is_convex(corners);
  std::array<RoundedCorner, 4> scaled = corners;
  for (RoundedCorner& corner : scaled) {
    corner.position *= scale;
    corner.rounding *= scale;
  }
  return is_planar(scaled) && is_convex(scaled);
}

std::span<const PolygonSplitter::Triangle> PolygonSplitter::split(
    std::span<const Vector3d> corners) {
  assert(corners.size() >= 3);
  triangles_.clear();
  tests_ = 0;
  project(corners);
  link(corners.size());
  // Terminates: a circle without an ear of one kind moves on to the next kind, and every corner is
  // an ear of the last kind. After a corner is clipped its neighbour is passed over, as in earcut:
  // a convex polygon is halved again and again instead of becoming a fan of slivers.
  std::uint32_t corner = 1;
  std::size_t left = corners.size();
  std::size_t tried = 0;
  EarKind kind = EarKind::kClean;
  while (left > 3) {
    if (is_ear(corner, kind)) {
      const std::uint32_t after = next_[corner];
      clip(corner);
      --left;
      corner = next_[after];
      tried = 0;
      kind = EarKind::kClean;
      continue;
    }
    corner = next_[corner];
    if (++tried == left) {
      tried = 0;
      kind = static_cast<EarKind>(static_cast<int>(kind) + 1);
    }
  }
  // The three that are left, beginning with the lowest number so that a quad ends in (0,2,3).
  const std::uint32_t first = std::min({corner, next_[corner], previous_[corner]});
  triangles_.push_back({first, next_[first], previous_[first]});
  return triangles_;
}

// Drops the coordinate along which the polygon looks largest, and turns it counter-clockwise.
void PolygonSplitter::project(std::span<const Vector3d> corners) {
  double largest = 0;
  for (const Vector3d& corner : corners) largest = std::max(largest, largest_of(corner));
  const double scale = scale_for(largest);
  Vector3d normal = Vector3d::Zero();  // Newell's: twice the area seen along each axis
  const Vector3d origin = corners[0] * scale;
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    normal += cross(corners[i] * scale - origin, corners[i + 1] * scale - origin);
  }
  const int axis = dominant_axis(normal);
  points_.clear();
  for (const Vector3d& corner : corners) {
    Vector2d point = flattened(corner * scale, axis);
    if (normal[axis] < 0) std::swap(point[0], point[1]);
    points_.push_back(point);
  }
}

void PolygonSplitter::link(std::size_t count) {
  next_.resize(count);
  previous_.resize(count);
  std::iota(next_.begin(), next_.end(), 1u);
  next_.back() = 0;
  std::iota(previous_.begin() + 1, previous_.end(), 0u);
  previous_.front() = static_cast<std::uint32_t>(count - 1);
  reflex_.clear();
  reflex_slot_.assign(count, kNowhere);
  for (std::uint32_t corner = 0; corner < count; ++corner) update_reflex(corner);
}

int PolygonSplitter::turn(std::uint32_t corner) const {
  return orient2d(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
}

bool PolygonSplitter::is_ear(std::uint32_t corner, EarKind kind) {
  if (kind == EarKind::kAny || tests_ > kMaxTests) return true;
  const int turned = turn(corner);
  if (kind == EarKind::kFlat) return turned == 0;
  if (turned <= 0) return false;
  // A corner that turns left cannot be the only one inside, so the others need not be tested: of
  // those inside the ear the one farthest from its diagonal does not turn left.
  for (const std::uint32_t other : reflex_) {
    ++tests_;
    if (blocks(other, corner, kind == EarKind::kClean)) return false;
  }
  return true;
}

// Whether `other` keeps the ear at `corner` from being clipped.
bool PolygonSplitter::blocks(std::uint32_t other, std::uint32_t corner, bool border_blocks) const {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  if (other == before || other == corner || other == after) return false;
  const Vector2d &a = points_[before], &b = points_[corner], &c = points_[after];
  const Vector2d& p = points_[other];
  for (int i = 0; i < 2; ++i) {
    if (p[i] < std::min({a[i], b[i], c[i]}) || p[i] > std::max({a[i], b[i], c[i]})) return false;
  }
  // The outline may touch itself, as where a bridge leads to a hole. Edges that start at a or c and
  // enter the ear would have to end in it or to cross an edge; those that start at its tip can
  // leave through the diagonal, so look where they go.
  if (p == a || p == c) return false;
  if (p == b) {
    const auto enters = [&](const Vector2d& to) {
      return orient2d(a, b, to) > 0 && orient2d(b, c, to) > 0;
    };
    return enters(points_[previous_[other]]) || enters(points_[next_[other]]);
  }
  const int lowest = std::min({orient2d(a, b, p), orient2d(b, c, p), orient2d(c, a, p)});
  return border_blocks ? lowest >= 0 : lowest > 0;
}

void PolygonSplitter::clip(std::uint32_t corner) {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  triangles_.push_back({before, corner, after});
  next_[before] = after;
  previous_[after] = before;
  next_[corner] = previous_[corner] = corner;
  update_reflex(corner);
  update_reflex(before);
  update_reflex(after);
}

void PolygonSplitter::update_reflex(std::uint32_t corner) {
  const bool clipped = next_[corner] == corner;
  const bool is_reflex = !clipped && turn(corner) <= 0;
  std::uint32_t& slot = reflex_slot_[corner];
  if (is_reflex == (slot != kNowhere)) return;
  if (is_reflex) {
    slot = static_cast<std::uint32_t>(reflex_.size());
    reflex_.push_back(corner);
    return;
  }
  // The last one takes its place.
  reflex_slot_[reflex_.back()] = slot;
  reflex_[slot] = reflex_.back();
  reflex_.pop_back();
  slot = kNowhere;
}

}  // namespace boxtree::cooker
