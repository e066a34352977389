// SPDX-License-Identifier: MIT
// Quad test and ear clipping (Meisters, "Polygons have ears", 1975) on exact orientation signs.
#include "cooker/import/polygon_split.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <numeric>

#include "cooker/import/polygon_normal.h"
#include "runtime/primitive/orientation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree::cooker {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr std::uint32_t kNowhere = CornerSet::kNone;

// Largest coordinate that orient2d takes unscaled, with room for products of three. Larger ones
// (only f64 positions have them) are scaled by a power of two, which changes no sign.
constexpr double kLargest = 0x1p200;
constexpr double kSmallest = 0x1p-200;

// The power of two that scales `largest` to about 1, or 1 if scaling is not needed.
double scale_for(double largest) {
  if (largest <= kLargest && (largest >= kSmallest || largest == 0)) return 1;
  return std::ldexp(1.0, -std::clamp(std::ilogb(largest), -1000, 1000));
}

double largest_of(const Vector3d& a) {
  return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])});
}

// The projection along `axis`, from its positive end.
Vector2d flattened(const Vector3d& a, int axis) {
  return {a[(axis + 1) % 3], a[(axis + 2) % 3]};
}

// The determinant of three rows of non-negative numbers with all minus signs made plus: an upper
// bound of |determinant| for all rows of at most these magnitudes.
double permanent(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return a[0] * (b[1] * c[2] + b[2] * c[1]) + a[1] * (b[2] * c[0] + b[0] * c[2]) +
         a[2] * (b[0] * c[1] + b[1] * c[0]);
}

Vector3d magnitude(const Vector3d& a) {
  return {std::abs(a[0]), std::abs(a[1]), std::abs(a[2])};
}

// A quad is planar if D = (p1-p0) . ((p2-p0) x (p3-p0)), six times the volume of its corners, is 0.
// Let q_i be the intended, planar corners and p_i = q_i + d_i the rounded ones, |d_i| <= r_i for
// each coordinate. D is linear in each row, so with rows a, b, c of p and e_i = d_i - d_0, |e_i| <=
// r_i + r_0:
//   D(p) = [terms linear in d] + [terms with two or three of e_1, e_2, e_3], where
//   linear: the derivative of D by p_1, p_2, p_3 is n_1 = b x c, n_2 = c x a, n_3 = a x b, and by
//           p_0 it is n_0 = -(n_1 + n_2 + n_3); so at most the sum of |n_i| . r_i
//   others: at most P(e1,e2,|c|) + P(e1,|b|,e3) + P(|a|,e2,e3) + P(e1,e2,e3), P the permanent.
// Evaluating D in double errs by at most kOrient3dBound P(|a|,|b|,|c|): the same eight roundings. A
// quad with |D| within the sum of these is planar up to the rounding of its coordinates.
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
  const Vector3d normal =
      polygon_normal(std::array{position(0), position(1), position(2), position(3)});
  if (largest_of(normal) == 0) {
    // The total area is zero: the quad has no area, or is a bow tie with equal halves.
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

void CornerSet::reset(std::uint32_t count, bool all) {
  std::size_t level = 0;
  for (std::uint32_t size = count;; ++level) {
    if (level == levels_.size()) levels_.emplace_back();
    const std::uint32_t words = (size + 63) / 64;
    levels_[level].assign(words, all ? ~std::uint64_t{0} : 0);
    if (all && size % 64 != 0) levels_[level].back() = (std::uint64_t{1} << (size % 64)) - 1;
    if (words <= 1) break;
    size = words;
  }
  levels_.resize(level + 1);
}

void CornerSet::insert(std::uint32_t number) {
  for (std::vector<std::uint64_t>& level : levels_) {
    std::uint64_t& word = level[number / 64];
    const bool was_empty = word == 0;
    word |= std::uint64_t{1} << (number % 64);
    if (!was_empty) return;
    number /= 64;
  }
}

void CornerSet::erase(std::uint32_t number) {
  for (std::vector<std::uint64_t>& level : levels_) {
    std::uint64_t& word = level[number / 64];
    word &= ~(std::uint64_t{1} << (number % 64));
    if (word != 0) return;
    number /= 64;
  }
}

std::uint32_t CornerSet::next_around(std::uint32_t from) const {
  const std::uint32_t found = next(from);
  return found != kNone ? found : next(0);
}

// Goes up while the rest of the word is empty, then down to the first member.
std::uint32_t CornerSet::next(std::uint32_t from) const {
  for (std::size_t level = 0; level < levels_.size(); ++level) {
    const std::size_t at = from / 64;
    if (at >= levels_[level].size()) return kNone;
    std::uint64_t word = levels_[level][at] & (~std::uint64_t{0} << (from % 64));
    if (word == 0) {
      from = static_cast<std::uint32_t>(at) + 1;
      continue;
    }
    auto found =
        static_cast<std::uint32_t>(at * 64 + static_cast<std::size_t>(std::countr_zero(word)));
    while (level-- > 0) {
      word = levels_[level][found];
      found = found * 64 + static_cast<std::uint32_t>(std::countr_zero(word));
    }
    return found;
  }
  return kNone;
}

void PolygonSplitter::Candidates::reset(std::uint32_t count) {
  corners.reset(count, true);
  blocker.assign(count, kNowhere);
  last_block.assign(count, kNowhere);
  blocks.clear();
}

void PolygonSplitter::Candidates::block(std::uint32_t corner, std::uint32_t by) {
  corners.erase(corner);
  blocker[corner] = by;
  if (by == kNowhere) return;  // it does not turn left
  blocks.push_back({corner, last_block[by]});
  last_block[by] = static_cast<std::uint32_t>(blocks.size() - 1);
}

void PolygonSplitter::Candidates::unblock(std::uint32_t by) {
  for (std::uint32_t i = last_block[by]; i != kNowhere; i = blocks[i].before) {
    const std::uint32_t corner = blocks[i].blocked;
    if (blocker[corner] == by) changed(corner);
  }
  last_block[by] = kNowhere;
}

void PolygonSplitter::Candidates::changed(std::uint32_t corner) {
  blocker[corner] = kNowhere;
  corners.insert(corner);
}

std::span<const PolygonSplitter::Triangle> PolygonSplitter::split(
    std::span<const Vector3d> corners) {
  assert(corners.size() >= 3);
  triangles_.clear();
  tests_ = 0;
  project(corners);
  const auto count = static_cast<std::uint32_t>(corners.size());
  make_grid(count);
  link(count);
  // Terminates: each step clips a corner. Clean ears come first, then corners without area, which
  // change nothing, then touching ears. If there is none, the polygon crosses itself, and any
  // corner is clipped. After a corner is clipped, its neighbour is skipped, as in earcut: a convex
  // polygon is halved repeatedly instead of becoming a fan of slivers.
  std::uint32_t corner = 1;
  for (std::uint32_t left = count; left > 3; --left) {
    std::uint32_t ear = find_ear(corner, EarKind::kClean);
    if (ear == kNowhere) ear = flat_.next_around(corner);
    if (ear == kNowhere) ear = find_ear(corner, EarKind::kTouching);
    if (ear == kNowhere || tests_ > kMaxTests) ear = corner;
    const std::uint32_t after = next_[ear];
    clip(ear);
    corner = next_[after];
  }
  // The last three, beginning with the lowest number so that a quad ends in (0,2,3).
  const std::uint32_t first = std::min({corner, next_[corner], previous_[corner]});
  triangles_.push_back({first, next_[first], previous_[first]});
  return triangles_;
}

// Drops the coordinate along which the polygon's area is largest; makes the rest counter-clockwise.
void PolygonSplitter::project(std::span<const Vector3d> corners) {
  double largest = 0;
  for (const Vector3d& corner : corners) largest = std::max(largest, largest_of(corner));
  const double scale = scale_for(largest);
  scaled_.clear();
  for (const Vector3d& corner : corners) scaled_.push_back(corner * scale);
  const Vector3d normal = polygon_normal(scaled_);
  const int axis = dominant_axis(normal);
  points_.clear();
  for (const Vector3d& corner : scaled_) {
    Vector2d point = flattened(corner, axis);
    if (normal[axis] < 0) std::swap(point[0], point[1]);
    points_.push_back(point);
  }
}

void PolygonSplitter::link(std::uint32_t count) {
  next_.resize(count);
  previous_.resize(count);
  std::iota(next_.begin(), next_.end(), 1u);
  next_.back() = 0;
  std::iota(previous_.begin() + 1, previous_.end(), 0u);
  previous_.front() = count - 1;
  flat_.reset(count, false);
  slot_.assign(count, kNowhere);
  for (Candidates& candidates : candidates_) candidates.reset(count);
  for (std::uint32_t corner = 0; corner < count; ++corner) update(corner);
}

// About four corners per cell, and square cells; polygons with few corners have one cell.
void PolygonSplitter::make_grid(std::uint32_t count) {
  Vector2d high = points_[0];
  grid_low_ = points_[0];
  for (const Vector2d& point : points_) {
    grid_low_ = grid_low_.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const Vector2d extent = high - grid_low_;
  const double cells = std::max(1.0, count / 4.0);
  const double aspect = extent[0] / std::max(extent[1], kSmallest);
  const double columns = std::clamp(std::sqrt(cells * aspect), 1.0, cells);  // extents may be zero
  const std::array<double, 2> wanted{columns, cells / columns};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const bool is_cut = extent[k] >= kSmallest;
    cell_count_[axis] = is_cut ? static_cast<std::uint32_t>(wanted[axis]) : 1;
    cells_per_length_[k] = is_cut ? cell_count_[axis] / extent[k] : 0;
  }
  const std::size_t used = std::size_t{cell_count_[0]} * cell_count_[1];
  if (cells_.size() < used) cells_.resize(used);
  for (std::size_t cell = 0; cell < used; ++cell) cells_[cell].clear();
}

// Monotone in each coordinate, so the cells of a box's corners enclose the cells of its content.
std::array<std::uint32_t, 2> PolygonSplitter::cell_of(const Vector2d& point) const {
  std::array<std::uint32_t, 2> cell;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const auto k = static_cast<Eigen::Index>(axis);
    const double place = (point[k] - grid_low_[k]) * cells_per_length_[k];
    cell[axis] = static_cast<std::uint32_t>(
        std::clamp(place, 0.0, static_cast<double>(cell_count_[axis] - 1)));
  }
  return cell;
}

int PolygonSplitter::turn(std::uint32_t corner) const {
  return orient2d(points_[previous_[corner]], points_[corner], points_[next_[corner]]);
}

// The first ear of a kind from `from` on, around the polygon; kNowhere if there is none.
std::uint32_t PolygonSplitter::find_ear(std::uint32_t from, EarKind kind) {
  Candidates& candidates = candidates_[static_cast<std::size_t>(kind)];
  for (std::uint32_t corner = candidates.corners.next_around(from); corner != kNowhere;
       corner = candidates.corners.next_around(corner)) {
    if (tests_ > kMaxTests) return corner;
    std::uint32_t blocker = kNowhere;
    if (turn(corner) > 0) {
      blocker = find_blocker(corner, kind);
      if (blocker == kNowhere) return corner;
    }
    candidates.block(corner, blocker);
  }
  return kNowhere;
}

// Only corners that do not turn left are tested: of the corners inside an ear, the one farthest
// from its diagonal does not turn left.
std::uint32_t PolygonSplitter::find_blocker(std::uint32_t corner, EarKind kind) {
  const Vector2d &a = points_[previous_[corner]], &b = points_[corner], &c = points_[next_[corner]];
  const auto low = cell_of(a.cwiseMin(b).cwiseMin(c)), high = cell_of(a.cwiseMax(b).cwiseMax(c));
  for (std::uint32_t row = low[1]; row <= high[1]; ++row) {
    for (std::uint32_t column = low[0]; column <= high[0]; ++column) {
      ++tests_;  // counts empty cells, too
      for (const std::uint32_t other : cells_[row * cell_count_[0] + column]) {
        ++tests_;
        if (blocks(other, corner, kind == EarKind::kClean)) return other;
      }
    }
  }
  return kNowhere;
}

// Whether `other` prevents clipping the ear at `corner`.
bool PolygonSplitter::blocks(std::uint32_t other, std::uint32_t corner, bool border_blocks) const {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  if (other == before || other == corner || other == after) return false;
  const Vector2d &a = points_[before], &b = points_[corner], &c = points_[after];
  const Vector2d& p = points_[other];
  for (int i = 0; i < 2; ++i) {
    if (p[i] < std::min({a[i], b[i], c[i]}) || p[i] > std::max({a[i], b[i], c[i]})) return false;
  }
  // The outline may touch itself, for example where a bridge leads to a hole. Edges that start at a
  // or c and enter the ear must end in it or cross an edge. Edges that start at its tip can leave
  // through the diagonal, so their directions are tested.
  if (p == a || p == c) return false;
  if (p == b) {
    const auto enters = [&](const Vector2d& to) {
      return orient2d(a, b, to) > 0 && orient2d(b, c, to) > 0;
    };
    return enters(points_[previous_[other]]) || enters(points_[next_[other]]);
  }
  // Many corners lie on the line of one edge and clearly outside of another: exact signs only of
  // what is not clear.
  const int clear[3] = {orient2d_filter(a, b, p), orient2d_filter(b, c, p),
                        orient2d_filter(c, a, p)};
  if (std::min({clear[0], clear[1], clear[2]}) < 0) return false;
  const auto is_inside = [&](int sign, const Vector2d& from, const Vector2d& to) {
    return (sign != 0 ? sign : orient2d_exact(from, to, p)) >= (border_blocks ? 0 : 1);
  };
  return is_inside(clear[0], a, b) && is_inside(clear[1], b, c) && is_inside(clear[2], c, a);
}

void PolygonSplitter::clip(std::uint32_t corner) {
  const std::uint32_t before = previous_[corner], after = next_[corner];
  triangles_.push_back({before, corner, after});
  next_[before] = after;
  previous_[after] = before;
  next_[corner] = previous_[corner] = corner;
  for (const std::uint32_t changed : {corner, before, after}) update(changed);
  for (Candidates& candidates : candidates_) {
    for (const std::uint32_t changed : {corner, before, after}) candidates.unblock(changed);
    for (const std::uint32_t changed : {before, after}) candidates.changed(changed);
    candidates.corners.erase(corner);
  }
}

// Records how a corner turns, after its neighbours have changed or it was clipped.
void PolygonSplitter::update(std::uint32_t corner) {
  const bool is_clipped = next_[corner] == corner;
  const int turned = is_clipped ? 1 : turn(corner);
  if (turned == 0) {
    flat_.insert(corner);
  } else {
    flat_.erase(corner);
  }
  const bool is_reflex = turned <= 0;
  std::uint32_t& slot = slot_[corner];
  if (is_reflex == (slot != kNowhere)) return;
  const auto at = cell_of(points_[corner]);
  std::vector<std::uint32_t>& cell = cells_[at[1] * cell_count_[0] + at[0]];
  if (is_reflex) {
    slot = static_cast<std::uint32_t>(cell.size());
    cell.push_back(corner);
    return;
  }
  // The last corner of the cell takes its place.
  slot_[cell.back()] = slot;
  cell[slot] = cell.back();
  cell.pop_back();
  slot = kNowhere;
}

}  // namespace boxtree::cooker
