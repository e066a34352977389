// SPDX-License-Identifier: MIT
#include "tests/support/tree_queries.h"

#include <array>
#include <limits>

namespace boxtree::test {
namespace {

template <class T, class Value>
Outcome outcome(const Result<T>& result, const Value& value) {
  return result ? Outcome{Errc::kOk, static_cast<double>(value(*result))}
                : Outcome{result.code(), 0};
}
template <class T, class Value>
Outcome outcome(const QueryResult<T>& result, const Value& value) {
  if (!result.ok()) return {result.code(), 0};
  return {Errc::kOk, result.has_value() ? static_cast<double>(value(*result)) : -1};
}
// The number of visitor calls of a query.
template <class RunQuery>
Outcome outcome_of_visit(const RunQuery& run_query) {
  std::size_t told = 0;
  return outcome(run_query([&told](const auto&) { return ++told > 0; }),
                 [&](Visit) { return told; });
}

double distance_of(const RayHit& hit) {
  return hit.t;
}
// The ray several times, beside others; of the last.
template <class Batch>
Outcome outcome_of_batch(const Batch& batch, const Tree& tree, const Ray& ray,
                         const QueryLimits& limits) {
  std::array<Ray, 20> rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i] = ray;
    rays[i].origin[0] += 0.01 * static_cast<double>(rays.size() - 1 - i);
  }
  std::array<RayResult, 20> results;
  const Status status = batch(tree, rays, results, limits);
  return status.ok() ? outcome(results.back(), distance_of) : Outcome{status.error().code, 0};
}
double length_of(const ClosestPoint& closest) {
  return closest.distance;
}
// The same of a point.
Outcome outcome_of_batch(const Tree& tree, const Eigen::Vector3d& point,
                         const QueryLimits& limits) {
  std::array<Eigen::Vector3d, 20> points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    points[i] = point;
    points[i][0] += 0.01 * static_cast<double>(points.size() - 1 - i);
  }
  std::array<PointResult, 20> results;
  const Status status =
      closest_points(tree, points, results, std::numeric_limits<double>::infinity(), limits);
  return status.ok() ? outcome(results.back(), length_of) : Outcome{status.error().code, 0};
}
// And of a shape: the number of visitor calls for the last.
template <class Shape, class Batch>
Outcome outcome_of_shapes(const Shape& shape, const Batch& batch) {
  std::array<Shape, 20> shapes;
  shapes.fill(shape);
  std::array<VisitResult, 20> results;
  std::size_t told = 0;
  const Status status = batch(shapes, results, [&](std::size_t i, const FaceRef&) {
    told += i + 1 == shapes.size() ? 1 : 0;
    return true;
  });
  if (!status.ok()) return {status.error().code, 0};
  return outcome(results.back(), [&](Visit) { return told; });
}
double t_of(const CastHit& hit) {
  return hit.t;
}
double number_of(const FacePair& pair) {
  return double{pair.first.id * 1e6} + pair.second.id;
}

std::array<Eigen::Vector3d, 5> hull_points(double size) {
  return {Eigen::Vector3d(-size, 0, 0), {size, 0, 0}, {0, size, 0}, {0, 0, size}, {0, 0, 0}};
}

}  // namespace

std::vector<TreeQuery> tree_queries(const QuerySet& q) {
  const Pose here = Pose::Identity();
  PointOptions bounds;
  bounds.relative_error = 1e-3;
  bounds.node_budget = q.node_budget;
  const Motion motion{q.ray.direction, q.ray.t_max};
  const Sphere ball{q.ray.origin, q.thickness};
  const Capsule capsule{q.ray.origin, q.ray.origin + Eigen::Vector3d(0.5, 0.25, 0), q.thickness};
  const OrientedBox turned{
      q.ray.origin, {q.thickness, 2 * q.thickness, 3 * q.thickness}, {1, 0.5, 0.25, 0.125}};
  return {
      {"closest_hit", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome(closest_hit(tree, q.ray, limits), distance_of);
       }},
      {"any_hit", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome(any_hit(tree, q.ray, limits), distance_of);
       }},
      {"closest_hits", 96, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_batch([](auto&... a) { return closest_hits(a...); }, tree, q.ray,
                                 limits);
       }},
      {"any_hits", 96, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_batch([](auto&... a) { return any_hits(a...); }, tree, q.ray, limits);
       }},
      {"all_hits", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         std::size_t told = 0;
         const auto count = [&](const RayHit&) { return ++told, q.ray.t_max; };
         return outcome(all_hits(tree, q.ray, count, {.limits = limits}),
                        [&](Visit) { return told; });
       }},
      {"nearest_hits", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         std::array<RayHit, 8> hits;
         return outcome(nearest_hits(tree, q.ray, hits, {.limits = limits}),
                        [](std::size_t count) { return count; });
       }},
      {"cast_closest of a sphere", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome(cast_closest(tree, ball, motion, {.limits = limits}), t_of);
       }},
      {"cast_closest of a capsule", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome(cast_closest(tree, capsule, motion, {.limits = limits}), t_of);
       }},
      {"cast_closest of a box", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome(cast_closest(tree, turned, motion, {.limits = limits}), t_of);
       }},
      {"cast_any", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome(cast_any(tree, turned, motion, {.limits = limits}), t_of);
       }},
      {"cast_all", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         std::size_t told = 0;
         const auto count = [&](const CastHit&) { return ++told, motion.t_max; };
         return outcome(cast_all(tree, capsule, motion, count, {.limits = limits}),
                        [&](Visit) { return told; });
       }},
      {"cast_closest of a hull", 200, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         const std::array<Eigen::Vector3d, 5> points = hull_points(q.thickness);
         const ConvexHull hull{points, q.ray.origin, turned.rotation};
         return outcome(cast_closest(tree, hull, motion, {.limits = limits}), t_of);
       }},
      {"collide of a hull", 200, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         const std::array<Eigen::Vector3d, 5> points = hull_points(q.radius);
         const ConvexHull hull{points, q.point, turned.rotation};
         return outcome_of_visit(
             [&](ContactVisitor visitor) { return collide(tree, hull, visitor, limits); });
       }},
      {"overlap_frustum", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         std::array<Eigen::Vector3d, 8> corners;
         corners.fill(q.point);
         for (std::size_t i = 4; i < 8; ++i) {
           corners[i] += q.radius * Eigen::Vector3d(i == 5 || i == 6 ? 1 : -1, i > 5 ? 1 : -1, 2);
         }
         return outcome_of_visit([&](FaceVisitor visitor) {
           return overlap_frustum(tree, Frustum::of(corners), visitor, limits);
         });
       }},
      {"collide", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_visit([&](ContactVisitor visitor) {
           return collide(tree, Sphere{q.point, q.radius}, visitor, limits);
         });
       }},
      {"overlap_capsule", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_visit([&](FaceVisitor visitor) {
           return overlap_capsule(tree, {q.point, q.point, q.radius}, visitor, limits);
         });
       }},
      {"overlap_oriented_box", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         const OrientedBox around{q.point, Eigen::Vector3d::Constant(q.radius), turned.rotation};
         return outcome_of_visit([&](FaceVisitor visitor) {
           return overlap_oriented_box(tree, around, visitor, limits);
         });
       }},
      {"overlap_box", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_visit(
             [&](FaceVisitor visitor) { return overlap_box(tree, q.box, visitor, limits); });
       }},
      {"overlap_sphere", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_visit([&](FaceVisitor visitor) {
           return overlap_sphere(tree, q.point, q.radius, visitor, limits);
         });
       }},
      {"overlap_boxes", 96, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_shapes(q.box, [&](const auto& shapes, auto& results, auto visitor) {
           return overlap_boxes(tree, shapes, results, visitor, limits);
         });
       }},
      {"overlap_spheres", 96, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_shapes(Sphere{q.point, q.radius},
                                  [&](const auto& shapes, auto& results, auto visitor) {
                                    return overlap_spheres(tree, shapes, results, visitor, limits);
                                  });
       }},
      {"closest_point", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome(closest_point(tree, q.point, 1e9, limits), length_of);
       }},
      {"closest_points", 96, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         return outcome_of_batch(tree, q.point, limits);
       }},
      {"closest_point with bounds", 160, false, false,
       [=](const Tree& tree, const Tree&, const QueryLimits&) {
         return outcome(closest_point(tree, q.point, bounds),
                        [](const auto& found) { return found.lower; });
       }},
      {"traverse", 64, false, true,
       [=](const Tree& tree, const Tree&, const QueryLimits& limits) {
         const auto touches = [&](const Eigen::AlignedBox3d& box) { return box.intersects(q.box); };
         return outcome_of_visit(
             [&](TriangleVisitor visitor) { return traverse(tree, touches, visitor, limits); });
       }},
      {"overlap_box_within", 64, false, false,
       [=](const Tree& tree, const Tree&, const QueryLimits&) {
         return outcome(overlap_box_within(tree, q.box, 0),
                        [](const BoxOverlap& found) { return static_cast<int>(found.overlap); });
       }},
      {"overlap_pairs", 320, true, true,
       [=](const Tree& first, const Tree& second, const QueryLimits& limits) {
         return outcome_of_visit([&](PairVisitor visitor) {
           return overlap_pairs(first, here, second, q.near, visitor, limits);
         });
       }},
      {"pair_contacts", 320, true, true,
       [=](const Tree& first, const Tree& second, const QueryLimits& limits) {
         return outcome_of_visit([&](PairContactVisitor visitor) {
           return pair_contacts(first, here, second, q.near, visitor, limits);
         });
       }},
      {"first_contact", 320, true, true,
       [=](const Tree& first, const Tree& second, const QueryLimits& limits) {
         return outcome(first_contact(first, here, second, q.near, limits), number_of);
       }},
      {"overlap_within", 192, true, false,
       [=](const Tree& first, const Tree& second, const QueryLimits&) {
         return outcome(overlap_within(first, here, second, q.near, 0),
                        [](const PairOverlap& found) { return static_cast<int>(found.overlap); });
       }},
      {"distance", 512, true, false,
       [=](const Tree& first, const Tree& second, const QueryLimits&) {
         return outcome(distance(first, here, second, q.far),
                        [](const Distance& found) { return found.lower; });
       }},
  };
}

}  // namespace boxtree::test
