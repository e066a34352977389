// SPDX-License-Identifier: MIT
// How a hull leaves a triangle soonest: through the nearest face of their Minkowski difference, the
// hull of all corners of the triangle less points of the hull. A polytope inside it grows where its
// face is the nearest, until that face is one of the difference (van den Bergen, "Proximity Queries
// and Penetration Depth Computation on 3D Game Objects", 2001).
//
// Why the depth is the least: the polytope is closed and all its corners are in the difference, so
// a ball that its faces leave free is inside the difference, too; the nearest of them is a lower
// bound, whether or not rounding has left it convex. Where the hull is, along the direction of that
// face, is an upper one.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <boxtree/shape.h>

#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/convex_points.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
// How far speeds along a unit vector are off.
constexpr double kSpeedError = 16 * kRoundoffF64;

// Every difference once, and what a flat one is thickened by.
constexpr std::size_t kMostVertices = 3 * kMaxHullPoints + 8;
constexpr std::size_t kMostFaces = 2 * kMostVertices - 4;  // Euler

class Difference {
 public:
  Difference(std::span<const Eigen::Vector3d> points, const Corners& corner, double doubt) noexcept
      : points_(points), corner_(corner) {
    for (const Eigen::Vector3d& p : points) largest_ = std::max(largest_, largest_magnitude(p));
    largest_ = std::max(largest_, max_abs_of(corner));
    error_ = 4 * doubt + 32 * kRoundoffF64 * largest_;
    begin();
  }

  // Grows until the nearest face, of those whose normal is against a direction if one is given, is
  // one of the whole difference.
  void grow(const Eigen::Vector3d* against) noexcept {
    for (std::size_t f = 0; f < count_; ++f) faces_[f].is_done = false;
    // Each step adds a corner, for which there is limited room, or is the last one of a face. A
    // face that is not against the direction grows, too: what is behind it may be against it.
    while (true) {
      const std::size_t nearest = nearest_face();
      if (nearest >= count_) break;
      Face& face = faces_[nearest];
      const bool counts = is_against(face.normal, against);
      const Vertex beyond = farthest(face.normal);
      const double reach = dot(face.normal, beyond.at);
      if (counts) consider(face.normal, nearest);
      const bool is_whole = reach - face.offset <= error_ || !add(nearest, beyond);
      if (!is_whole) continue;
      if (counts) break;
      faces_[nearest].is_done = true;  // one of the difference that does not count
    }
    // A flat difference is left across its plane, not by what it was thickened by.
    for (std::uint32_t k = 0; k < thin_; ++k) {
      for (const double side : {1.0, -1.0}) {
        const Eigen::Vector3d across = side * thin_axis_[k];
        if (is_against(across, against)) consider(across, kNoFace);
      }
    }
  }

  // The best direction: the hull has to move by `depth` along the normal.
  double depth = kUnbounded;
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  [[nodiscard]] double error() const noexcept { return error_; }

  // The point of the triangle where they part along the normal.
  [[nodiscard]] bool witness(Eigen::Vector3d& point) const noexcept {
    if (witness_face_ == kNoFace) return false;
    point = witness_;
    return true;
  }

 private:
  static constexpr std::size_t kNoFace = ~std::size_t{0};

  struct Vertex {
    Eigen::Vector3d at;
    std::uint16_t corner;  // of the triangle
  };
  struct Face {
    Eigen::Vector3d normal;  // outward
    double offset;           // of its plane along the normal; infinity for one without area
    std::array<std::uint16_t, 3> vertex;
    std::array<std::uint16_t, 3> next;  // across the edge from vertex i on
    bool is_visible;                    // from the corner that is added
    bool is_done;                       // a face of the whole difference
  };
  // From the border of what is visible: an edge, and the face on its other side.
  struct BorderEdge {
    std::uint16_t from, to, outer;
  };

  static bool is_against(const Eigen::Vector3d& n, const Eigen::Vector3d* against) noexcept {
    return against == nullptr || dot(n, *against) < -kSpeedError;
  }

  // How far the hull has to move along a unit vector.
  void consider(const Eigen::Vector3d& n, std::size_t face) noexcept {
    double high = -kUnbounded, low = kUnbounded;
    for (const Eigen::Vector3d& c : corner_) high = std::max(high, dot(n, c));
    for (const Eigen::Vector3d& p : points_) low = std::min(low, dot(n, p));
    if (!(high - low < depth)) return;
    depth = high - low;
    normal = n;
    witness_face_ = face;
    if (face == kNoFace) return;
    Corners difference, on_triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vertex& vertex = vertices_[faces_[face].vertex[i]];
      difference[i] = vertex.at;
      on_triangle[i] = corner_[vertex.corner];
    }
    const Eigen::Vector3d weight = weights_in(difference, Eigen::Vector3d::Zero());
    witness_ = weight[0] * on_triangle[0] + weight[1] * on_triangle[1] + weight[2] * on_triangle[2];
  }

  [[nodiscard]] Vertex farthest(const Eigen::Vector3d& n) const noexcept {
    const DifferencePoint most = least_difference(points_, corner_, -n);
    Vertex found{most.at, static_cast<std::uint16_t>(most.corner)};
    for (std::uint32_t k = 0; k < thin_; ++k) {
      found.at += (dot(n, thin_axis_[k]) < 0 ? -thickness_ : thickness_) * thin_axis_[k];
    }
    return found;
  }

  // Calls with each difference.
  template <class Visitor>
  void for_each(const Visitor& visit) const noexcept {
    for (std::size_t i = 0; i < 3; ++i) {
      for (const Eigen::Vector3d& p : points_) {
        visit(Vertex{corner_[i] - p, static_cast<std::uint16_t>(i)});
      }
    }
  }

  // Four differences that are not in a plane; where all are, some that are thickened across it.
  void begin() noexcept {
    std::array<Vertex, 4> first;
    first[0] = {corner_[0] - points_[0], 0};
    Eigen::Vector3d line = Eigen::Vector3d::Zero(), across = Eigen::Vector3d::Zero();
    std::size_t found = 1;
    double most = 0;
    for_each([&](const Vertex& v) {
      const double length = squared_length(v.at - first[0].at);
      if (!(length > most)) return;
      most = length;
      first[1] = v;
    });
    if (std::sqrt(most) > error_) {
      found = 2;
      line = (first[1].at - first[0].at) / std::sqrt(most);
      most = 0;
      for_each([&](const Vertex& v) {
        const Eigen::Vector3d off = cross(line, v.at - first[0].at);
        const double length = squared_length(off);
        if (!(length > most)) return;
        most = length;
        across = off;
        first[2] = v;
      });
      if (std::sqrt(most) > error_) {
        found = 3;
        across = unit_normal({{first[0].at, first[1].at, first[2].at}});
        most = 0;
        for_each([&](const Vertex& v) {
          const double off = std::abs(dot(across, v.at - first[0].at));
          if (!(off > most)) return;
          most = off;
          first[3] = v;
        });
        if (most > error_) found = 4;
      }
    }
    thin_ = static_cast<std::uint32_t>(4 - found);
    if (thin_ != 0) thicken(found, line, across, first);
    for (const Vertex& v : first) vertices_[vertex_count_++] = v;
    const Eigen::Vector3d n = unit_normal({{first[0].at, first[1].at, first[2].at}});
    const bool is_above = dot(n, first[3].at - first[0].at) > 0;
    // Seen from outside counterclockwise.
    constexpr std::array<std::array<std::uint16_t, 3>, 4> kSides = {
        {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
    for (const std::array<std::uint16_t, 3>& side : kSides) {
      std::array<std::uint16_t, 3>& vertex = faces_[count_++].vertex;
      vertex = side;
      if (!is_above) std::swap(vertex[1], vertex[2]);
    }
    for (std::size_t f = 0; f < count_; ++f) {
      set_plane(faces_[f]);
      for (std::size_t i = 0; i < 3; ++i) faces_[f].next[i] = across_edge(f, i);
    }
  }

  // Of four faces, each of which borders each.
  [[nodiscard]] std::uint16_t across_edge(std::size_t f, std::size_t i) const noexcept {
    const std::uint16_t a = faces_[f].vertex[i], b = faces_[f].vertex[(i + 1) % 3];
    for (std::size_t g = 0; g < count_; ++g) {
      const auto has = [&](std::uint16_t v) {
        return std::find(faces_[g].vertex.begin(), faces_[g].vertex.end(), v) !=
               faces_[g].vertex.end();
      };
      if (g != f && has(a) && has(b)) return static_cast<std::uint16_t>(g);
    }
    return static_cast<std::uint16_t>(f);
  }

  // `found`: how many of `first` there are, in no smaller space than they span.
  void thicken(std::size_t found, const Eigen::Vector3d& line, const Eigen::Vector3d& across,
               std::array<Vertex, 4>& first) noexcept {
    // Half the digits for what is thin, half for what it is thinner than.
    constexpr double kThickness = 0x1p-26;
    thickness_ = kThickness * largest_;
    if (found == 3) {
      thin_axis_[0] = across;
    } else if (found == 2) {
      thin_axis_[0] = unit_across(line);
      thin_axis_[1] = unit_normal({{Eigen::Vector3d::Zero(), line, thin_axis_[0]}});
    } else {
      thin_axis_ = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
    }
    for (std::size_t i = 0; i < found; ++i) {
      for (std::uint32_t k = 0; k < thin_; ++k) first[i].at -= thickness_ * thin_axis_[k];
    }
    for (std::uint32_t k = 0; k < thin_; ++k) {
      first[found + k] = first[0];
      first[found + k].at += 2 * thickness_ * thin_axis_[k];
    }
  }

  void set_plane(Face& face) const noexcept {
    const Corners at{vertices_[face.vertex[0]].at, vertices_[face.vertex[1]].at,
                     vertices_[face.vertex[2]].at};
    face.normal = unit_normal({at});
    face.offset = face.normal.isZero(0) ? kUnbounded : dot(face.normal, at[0]);
    face.is_visible = false;
    face.is_done = false;
  }

  // count_ if there is none.
  [[nodiscard]] std::size_t nearest_face() const noexcept {
    std::size_t nearest = count_;
    double least = kUnbounded;
    for (std::size_t f = 0; f < count_; ++f) {
      if (!(faces_[f].offset < least) || faces_[f].is_done) continue;
      least = faces_[f].offset;
      nearest = f;
    }
    return nearest;
  }

  // Replaces the faces that see a corner, `from` first, by those from their border to it. Returns
  // whether it could: there is room, and rounding has not torn the border.
  [[nodiscard]] bool add(std::size_t from, const Vertex& vertex) noexcept {
    if (vertex_count_ == kMostVertices) return false;
    const auto apex = static_cast<std::uint16_t>(vertex_count_);
    vertices_[apex] = vertex;
    // What is in the plane of a face but for rounding does not see it.
    const double plane_error = 16 * kRoundoffF64 * largest_;
    std::array<std::uint16_t, kMostFaces> visible;
    std::size_t visible_count = 0;
    visible[visible_count++] = static_cast<std::uint16_t>(from);
    faces_[from].is_visible = true;
    std::array<BorderEdge, kMostVertices> border;
    std::size_t border_count = 0;
    bool has_room = true;
    for (std::size_t i = 0; i < visible_count; ++i) {
      const Face& seen = faces_[visible[i]];
      for (std::size_t e = 0; e < 3; ++e) {
        Face& face = faces_[seen.next[e]];
        if (face.is_visible) continue;
        const bool is_seen =
            face.offset == kUnbounded || dot(face.normal, vertex.at) - face.offset > plane_error;
        if (is_seen) {
          face.is_visible = true;
          visible[visible_count++] = seen.next[e];
        } else if (border_count < border.size()) {
          border[border_count++] = {seen.vertex[e], seen.vertex[(e + 1) % 3], seen.next[e]};
        } else {
          has_room = false;
        }
      }
    }
    const std::size_t added = border_count > visible_count ? border_count - visible_count : 0;
    if (!has_room || count_ + added > kMostFaces || !is_loop({border.data(), border_count})) {
      for (std::size_t i = 0; i < visible_count; ++i) faces_[visible[i]].is_visible = false;
      return false;
    }
    ++vertex_count_;
    const auto place = [&](std::size_t n) {
      return n < visible_count ? visible[n]
                               : static_cast<std::uint16_t>(count_ + (n - visible_count));
    };
    for (std::size_t n = 0; n < border_count; ++n) {
      const BorderEdge& edge = border[n];
      Face& outer = faces_[edge.outer];
      for (std::size_t e = 0; e < 3; ++e) {
        if (outer.vertex[e] == edge.to && outer.vertex[(e + 1) % 3] == edge.from) {
          outer.next[e] = place(n);
        }
      }
      begins_[edge.from] = place(n);
      ends_[edge.to] = place(n);
    }
    for (std::size_t n = 0; n < border_count; ++n) {
      const BorderEdge& edge = border[n];
      Face& side = faces_[place(n)];
      side.vertex = {edge.from, edge.to, apex};
      side.next = {edge.outer, begins_[edge.to], ends_[edge.from]};
      set_plane(side);
    }
    for (std::size_t n = border_count; n < visible_count; ++n)
      faces_[visible[n]].offset = kUnbounded;
    count_ += added;
    return true;
  }

  // Whether edges are one way around, through each of their corners once.
  [[nodiscard]] bool is_loop(std::span<const BorderEdge> border) noexcept {
    for (const BorderEdge& edge : border) begins_[edge.from] = kNoEdge;
    for (std::size_t n = 0; n < border.size(); ++n) {
      if (begins_[border[n].from] != kNoEdge) return false;
      begins_[border[n].from] = static_cast<std::uint16_t>(n);
    }
    std::size_t at = 0, steps = 0;
    do {
      at = begins_[border[at].to];
      ++steps;
    } while (at != 0 && steps <= border.size());
    return steps == border.size();
  }
  static constexpr std::uint16_t kNoEdge = 0xffff;

  std::span<const Eigen::Vector3d> points_;
  const Corners& corner_;
  double largest_ = 0;  // coordinate
  double error_ = 0;
  std::uint32_t thin_ = 0;  // axes along which the difference has no extent
  std::array<Eigen::Vector3d, 3> thin_axis_;
  double thickness_ = 0;
  std::size_t witness_face_ = kNoFace;
  Eigen::Vector3d witness_ = Eigen::Vector3d::Zero();
  std::size_t vertex_count_ = 0, count_ = 0;
  std::array<Vertex, kMostVertices> vertices_;
  std::array<Face, kMostFaces> faces_;
  std::array<std::uint16_t, kMostVertices> begins_, ends_;  // the face whose edge does at a corner
};

// Of the points where lines between the hull's points meet the triangle's plane, one that is in the
// triangle to within `error`, or else the nearest to it: there, on the triangle. False if the hull
// is on one side, or the triangle has no plane. Quadratic in the points, but called for few
// contacts.
bool plane_crossing(std::span<const Eigen::Vector3d> points, const Corners& corner, double error,
                    Eigen::Vector3d& crossing) noexcept {
  const Eigen::Vector3d n = unit_normal({corner});
  std::array<double, kMaxHullPoints> height;
  for (std::size_t i = 0; i < points.size(); ++i) height[i] = dot(n, points[i] - corner[0]);
  double least = kUnbounded;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(height[i] < 0)) continue;
    for (std::size_t j = 0; j < points.size(); ++j) {
      if (!(height[j] > 0)) continue;
      const Eigen::Vector3d met =
          points[i] + height[i] / (height[i] - height[j]) * (points[j] - points[i]);
      const Eigen::Vector3d on_triangle = closest_point_on_triangle(met, {corner});
      const double off = squared_length(on_triangle - met);
      if (!(off < least)) continue;
      least = off;
      crossing = on_triangle;
      if (least <= error * error) return true;
    }
  }
  return least < kUnbounded;
}

// A point of both, which touch. Closest points that are less than rounding apart may be off by the
// size of a hull that is much smaller than the triangle: projections on the one and the other, by
// turns, come nearer to both; where both are nearly in one plane, too slowly.
Eigen::Vector3d point_inside_hull(std::span<const Eigen::Vector3d> points, const Corners& corner,
                                  double error) noexcept {
  constexpr int kMostTurns = 64;
  const CoreDistance at = hull_distance(points, corner);
  Eigen::Vector3d best = at.core + at.between, tried = best;
  double least = kUnbounded;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    const CoreDistance off = hull_distance(points, {tried, tried, tried});
    if (!(off.length < least)) break;
    least = off.length;
    best = tried;
    if (least <= error) return best;
    tried = closest_point_on_triangle(off.core, {corner});
  }
  if (plane_crossing(points, corner, error, tried) &&
      hull_distance(points, {tried, tried, tried}).length < least) {
    return tried;
  }
  return best;
}

}  // namespace

Penetration hull_penetration(std::span<const Eigen::Vector3d> points, const Corners& corner,
                             double doubt, const Eigen::Vector3d* against) noexcept {
  Difference difference(points, corner, doubt);
  difference.grow(against);
  if (difference.normal.isZero(0)) difference.grow(nullptr);  // no face is against the direction
  Penetration found;
  found.normal = difference.normal;
  found.depth = std::max(0.0, difference.depth);
  if (found.normal.isZero(0)) {  // both are one place
    found.normal = Eigen::Vector3d::UnitX();
    found.depth = 0;
  }
  found.feature = farthest_feature(found.normal, corner, difference.error());
  if (difference.witness(found.point) &&
      hull_distance(points, {found.point, found.point, found.point}).lower <= 2 * doubt) {
    return found;
  }
  found.point = point_inside_hull(points, corner, 2 * doubt);
  return found;
}

}  // namespace boxtree
