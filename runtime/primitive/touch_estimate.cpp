// SPDX-License-Identifier: MIT
// A capsule touches a triangle where a ball touches the sum of the triangle and the capsule's
// segment: a prism, whose faces, edges and corners are tried one after the other. It is convex, so
// that a ball that touches the inside of a face touches nothing before.
#include "runtime/primitive/touch_estimate.h"

#include <cmath>
#include <limits>

#include "runtime/primitive/separation.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

// A ball that moves from the origin. Its functions are called up to twenty times for one triangle,
// and would take 9 KB if each call were compiled inline.
class MovingBall {
 public:
  MovingBall(double radius, const Eigen::Vector3d& direction) noexcept
      : radius_(radius), direction_(direction), squared_speed_(squared_length(direction)) {}

  // When it touches the inside of a parallelogram, or of the triangle that is its first half.
  [[nodiscard, gnu::noinline]] double touch_of_face(const Eigen::Vector3d& at,
                                                    const Eigen::Vector3d& first,
                                                    const Eigen::Vector3d& second,
                                                    bool is_triangle) const noexcept {
    const Eigen::Vector3d n = cross(first, second);
    const double square = squared_length(n), height = dot(n, at);
    const double length = std::sqrt(square), speed = dot(n, direction_);
    const double gap = std::abs(height) - radius_ * length;
    const double toward = height < 0 ? -speed : speed;
    if (!(gap >= 0) || !(toward > 0)) return kNever;
    const double t = gap / toward;
    const double reach = (height < 0 ? -radius_ : radius_) / length;
    const Eigen::Vector3d w = (t * direction_ + reach * n) - at;
    const double along_first = dot(cross(w, second), n), along_second = dot(cross(first, w), n);
    const bool is_inside = along_first >= 0 && along_second >= 0 &&
                           (is_triangle ? along_first + along_second <= square
                                        : along_first <= square && along_second <= square);
    return is_inside ? t : kNever;
  }

  // When it touches a segment between its ends.
  [[nodiscard, gnu::noinline]] double touch_of_segment(const Eigen::Vector3d& at,
                                                       const Eigen::Vector3d& edge) const noexcept {
    // Of the parts orthogonal to the edge, times its length.
    const double square = squared_length(edge);
    const double at_along = dot(at, edge), moved_along = dot(direction_, edge);
    const double a = squared_speed_ * square - moved_along * moved_along;
    const double b = dot(at, direction_) * square - at_along * moved_along;
    const double c = (squared_length(at) - radius_ * radius_) * square - at_along * at_along;
    const double t = smaller_root(a, b, c);
    const double along = t * moved_along - at_along;
    return along >= 0 && along <= square ? t : kNever;
  }

  [[nodiscard, gnu::noinline]] double touch_of_point(const Eigen::Vector3d& at) const noexcept {
    return smaller_root(squared_speed_, dot(at, direction_),
                        squared_length(at) - radius_ * radius_);
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
  double first = ball.touch_of_face(corner[0], edge[0], -edge[2], true);
  if (first != kNever) return first;
  for (std::size_t i = 0; i < 3; ++i) {
    first = std::min(
        {first, ball.touch_of_segment(corner[i], edge[i]), ball.touch_of_point(corner[i])});
  }
  return first;
}

double touch_of_capsule(const MovingBall& ball, const Corners& corner,
                        const Eigen::Vector3d& arm) noexcept {
  const Corners edge = edges_of(corner);
  const Eigen::Vector3d core = 2 * arm;
  const std::array<Eigen::Vector3d, 2> ends = {-arm, arm};
  double first = kNever;
  for (const Eigen::Vector3d& end : ends) {
    first = std::min(first, ball.touch_of_face(corner[0] + end, edge[0], -edge[2], true));
  }
  for (std::size_t i = 0; i < 3; ++i) {
    first = std::min(first, ball.touch_of_face(corner[i] - arm, edge[i], core, false));
  }
  if (first != kNever) return first;
  for (std::size_t i = 0; i < 3; ++i) {
    first = std::min(first, ball.touch_of_segment(corner[i] - arm, core));
    for (const Eigen::Vector3d& end : ends) {
      first = std::min(first, ball.touch_of_segment(corner[i] + end, edge[i]));
      first = std::min(first, ball.touch_of_point(corner[i] + end));
    }
  }
  return first;
}

}  // namespace

double estimated_touch(const ConvexShape& shape, const Eigen::Vector3d& direction,
                       const Corners& corner) noexcept {
  const MovingBall ball(shape.radius, direction);
  return shape.axes == 0 ? touch_of_sphere(ball, corner)
                         : touch_of_capsule(ball, corner, shape.half[0] * shape.axis[0]);
}

}  // namespace boxtree
