// SPDX-License-Identifier: MIT
// A capsule touches a triangle where a ball touches the sum of the triangle and the capsule's
// segment: a prism, whose faces, edges and corners are tried one after the other. It is convex, so
// that a ball that touches the inside of a face touches nothing before.
#include "runtime/primitive/touch_estimate.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// A ball that moves from the origin. Its functions are called up to twenty times for one triangle,
// and would take 4 KB more if each call were compiled inline.
class MovingBall {
 public:
  MovingBall(double radius, const Eigen::Vector3d& direction) noexcept
      : radius_(radius), direction_(direction), squared_speed_(squared_length(direction)) {}

  [[nodiscard]] const Eigen::Vector3d& direction() const noexcept { return direction_; }

  // When it touches the inside of a parallelogram, or of the triangle that is its first half, whose
  // normal, of any length, is n.
  [[nodiscard, gnu::noinline]] double touch_of_face(const Eigen::Vector3d& at,
                                                    const Eigen::Vector3d& first,
                                                    const Eigen::Vector3d& second,
                                                    const Eigen::Vector3d& n,
                                                    bool is_triangle) const noexcept {
    const double height = dot(n, at), speed = dot(n, direction_);
    const double toward = height < 0 ? -speed : speed;
    if (!(toward > 0)) return kNever;
    const double square = squared_length(n), length = std::sqrt(square);
    const double gap = std::abs(height) - radius_ * length;
    if (!(gap >= 0)) return kNever;
    const double t = gap / toward;
    const double reach = (height < 0 ? -radius_ : radius_) / length;
    const Eigen::Vector3d w = (t * direction_ + reach * n) - at;
    const double along_first = dot(cross(w, second), n), along_second = dot(cross(first, w), n);
    const bool is_inside = along_first >= 0 && along_second >= 0 &&
                           (is_triangle ? along_first + along_second <= square
                                        : along_first <= square && along_second <= square);
    return is_inside ? t : kNever;
  }

  // What one needs to know of a point, and of a segment that begins there.
  struct Point {
    double squared;  // its distance
    double ahead;    // its product with the direction
  };
  struct Segment {
    double squared;  // its length
    double along;    // the product of its vector and the point in which it begins
    double moved;    // of its vector and the direction
  };

  [[nodiscard, gnu::noinline]] double touch_of_point(Point at) const noexcept {
    return smaller_root(squared_speed_, at.ahead, at.squared - radius_ * radius_);
  }
  // When it touches a segment between its ends.
  [[nodiscard, gnu::noinline]] double touch_of_segment(Point at,
                                                       const Segment& edge) const noexcept {
    // Of the parts orthogonal to the edge, times its length.
    const double a = squared_speed_ * edge.squared - edge.moved * edge.moved;
    const double b = at.ahead * edge.squared - edge.along * edge.moved;
    const double c = (at.squared - radius_ * radius_) * edge.squared - edge.along * edge.along;
    const double t = smaller_root(a, b, c);
    const double along = t * edge.moved - edge.along;
    return along >= 0 && along <= edge.squared ? t : kNever;
  }

 private:
  // Of a t^2 - 2 b t + c = 0, if it is not negative.
  [[nodiscard]] static double smaller_root(double a, double b, double c) noexcept {
    const double discriminant = b * b - a * c;
    if (!(discriminant >= 0) || !(b > 0) || !(c >= 0)) return kNever;
    return c / (b + std::sqrt(discriminant));
  }

  double radius_;
  const Eigen::Vector3d& direction_;
  double squared_speed_;
};

double touch_of_sphere(const MovingBall& ball, const Corners& corner) noexcept {
  const Corners edge = edges_of(corner);
  const double of_face =
      ball.touch_of_face(corner[0], edge[0], -edge[2], cross(edge[0], -edge[2]), true);
  if (of_face != kNever) return of_face;
  double first = kNever;
  for (std::size_t i = 0; i < 3; ++i) {
    const MovingBall::Point at{squared_length(corner[i]), dot(corner[i], ball.direction())};
    first = std::min({first, ball.touch_of_point(at),
                      ball.touch_of_segment(at, {squared_length(edge[i]), dot(corner[i], edge[i]),
                                                 dot(edge[i], ball.direction())})});
  }
  return first;
}

// The faces of a prism that look against the motion: nothing else is touched first.
class PrismFaces {
 public:
  PrismFaces(const Corners& edge, const Eigen::Vector3d& arm,
             const Eigen::Vector3d& direction) noexcept
      : of_cap(cross(edge[0], -edge[2])) {
    const Eigen::Vector3d core = 2 * arm;
    for (std::size_t i = 0; i < 3; ++i) of_side[i] = cross(edge[i], core);
    // Positive where all normals, that of the cap in the arm's direction, point outward. Of a prism
    // that is flat but for rounding either sign will do: then its back is its front.
    const double outward = dot(of_cap, arm);
    if (outward == 0) return;
    const double speed = dot(of_cap, direction);
    faces_ = outward * speed < 0 ? kLastCap : speed != 0 ? kFirstCap : 0;
    for (std::size_t i = 0; i < 3; ++i) {
      faces_ |= outward * dot(of_side[i], direction) < 0 ? 1u << i : 0;
    }
  }

  [[nodiscard]] bool has_side(std::size_t i) const noexcept { return has(1u << i); }
  [[nodiscard]] bool has_cap(std::size_t end) const noexcept { return has(kFirstCap << end); }
  // Or one of the faces beside it: of the edge between two sides, of an edge of a cap, of a corner.
  [[nodiscard]] bool has_between_sides(std::size_t i) const noexcept {
    return has(1u << i | 1u << before(i));
  }
  [[nodiscard]] bool has_edge(std::size_t i, std::size_t end) const noexcept {
    return has(1u << i | kFirstCap << end);
  }
  [[nodiscard]] bool has_corner(std::size_t i, std::size_t end) const noexcept {
    return has(1u << i | 1u << before(i) | kFirstCap << end);
  }

  Eigen::Vector3d of_cap;
  Corners of_side;

 private:
  static constexpr std::uint32_t kFirstCap = 8, kLastCap = 16, kAllFaces = 31;

  [[nodiscard]] static std::size_t before(std::size_t i) noexcept { return i == 0 ? 2 : i - 1; }
  [[nodiscard]] bool has(std::uint32_t faces) const noexcept { return (faces_ & faces) != 0; }

  std::uint32_t faces_ = kAllFaces;
};

TouchEstimate touch_of_capsule(const MovingBall& ball, const Corners& corner,
                               const Eigen::Vector3d& arm) noexcept {
  const Eigen::Vector3d& direction = ball.direction();
  const Corners edge = edges_of(corner);
  const PrismFaces faces(edge, arm, direction);
  TouchEstimate first;
  const auto consider = [&first](double s, CoreGuess of_core) {
    if (s < first.s) first = {s, of_core};
  };
  // A point of the prism is one of the triangle less one of the core.
  constexpr std::array<CoreGuess, 2> kEnds = {CoreGuess::kLastEnd, CoreGuess::kFirstEnd};
  constexpr std::array<CoreGuess, 3> kEdges = {CoreGuess::kEdge0, CoreGuess::kEdge1,
                                               CoreGuess::kEdge2};
  constexpr std::array<double, 2> kSides = {-1, 1};  // an end is this many arms away
  for (std::size_t end = 0; end < 2; ++end) {
    if (!faces.has_cap(end)) continue;
    consider(
        ball.touch_of_face(corner[0] + kSides[end] * arm, edge[0], -edge[2], faces.of_cap, true),
        kEnds[end]);
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (!faces.has_side(i)) continue;
    consider(ball.touch_of_face(corner[i] - arm, edge[i], 2 * arm, faces.of_side[i], false),
             kEdges[i]);
  }
  if (first.s != kNever) return first;
  const double squared_arm = squared_length(arm), moved_arm = dot(arm, direction);
  for (std::size_t i = 0; i < 3; ++i) {
    const double squared = squared_length(corner[i]) + squared_arm;
    const double along_arm = dot(corner[i], arm), ahead = dot(corner[i], direction);
    const MovingBall::Segment side{squared_length(edge[i]), dot(corner[i], edge[i]),
                                   dot(edge[i], direction)};
    const double side_along_arm = dot(edge[i], arm);
    if (faces.has_between_sides(i)) {
      consider(
          ball.touch_of_segment({squared - 2 * along_arm, ahead - moved_arm},
                                {4 * squared_arm, 2 * (along_arm - squared_arm), 2 * moved_arm}),
          kEdges[i]);
    }
    for (std::size_t end = 0; end < 2; ++end) {
      const double arms = kSides[end];
      const MovingBall::Point at{squared + 2 * arms * along_arm, ahead + arms * moved_arm};
      if (faces.has_edge(i, end)) {
        consider(ball.touch_of_segment(
                     at, {side.squared, side.along + arms * side_along_arm, side.moved}),
                 kEnds[end]);
      }
      if (faces.has_corner(i, end)) consider(ball.touch_of_point(at), kEnds[end]);
    }
  }
  return first;
}

}  // namespace

TouchEstimate estimated_touch(const ConvexShape& shape, const Eigen::Vector3d& direction,
                              const Corners& corner) noexcept {
  const MovingBall ball(shape.radius, direction);
  if (shape.axes == 0) return {touch_of_sphere(ball, corner), CoreGuess::kNone};
  return touch_of_capsule(ball, corner, shape.half[0] * shape.axis[0]);
}

}  // namespace boxtree
