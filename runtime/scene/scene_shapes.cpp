// SPDX-License-Identifier: MIT
// Boxes, spheres and points in a scene.
#include <cmath>

#include <boxtree/scene.h>
#include <boxtree/scene_closest_batch.h>
#include <boxtree/scene_overlap_batch.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/rounding.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/point_query.h"
#include "runtime/query/shape_query.h"
#include "runtime/query/visit_result.h"
#include "runtime/scene/answer_each.h"
#include "runtime/scene/near_point_walk.h"
#include "runtime/scene/placed_box.h"
#include "runtime/scene/scene_walk.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
namespace {

// What boxes and spheres share: `run_query(placed, faces)` answers for one instance.
template <class Shape>
struct ShapeInScene : InstanceOutcome {
  Admission admission;
  const Shape& shape;
  SceneFaceVisitor visitor;

  template <class Tree>
  [[nodiscard]] Errc walk(const Tree& tree, InstanceVisitor instances) const {
    return shape.walk(tree, instances);
  }
  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    return note(shape.run_query(placed, {visitor, instance}, admission.work));
  }
};

template <class Shape>
VisitResult query_scene(const BoundScene& scene, const Shape& shape, SceneFaceVisitor visitor,
                        LayerMask layers, const QueryLimits& limits) {
  QueryWork work(limits);
  ShapeInScene<Shape> query{{}, {scene, kBoxQueries, layers, work}, shape, visitor};
  return visit_result(outcome_of(visit_overlapping_instances(scene, query), query));
}

// Boxes are compared in the world itself: only signs count, and units could lose the last bits of
// very small numbers.
struct WorldBox : BoxInFrame {
  Box<double> world;

  [[nodiscard]] Result<Visit> run_query(const BoundScene::Placed& placed,
                                        const FacesOfInstance& faces, QueryWork& work) const {
    const PlacedBoxQuery query{Placement::map_to_world(placed.tree->frame(), placed.pose), world};
    return visit_faces(*placed.tree, query, faces, work);
  }
};

// A point in the scene's units, moved to the space of a tree; 0 if it is so far away that boxes
// give no bound, and then all triangles of the tree are compared.
struct PointInTree {
  PointInTree(const Placement& placement, const Eigen::Vector3d& point) noexcept
      : at(placement.to_tree(point)), is_near(is_within_range(at)) {
    if (!is_near) at.setZero();
  }
  Eigen::Vector3d at;
  bool is_near;
};

struct SphereInUnits {
  Eigen::Vector3d center;
  double radius;
  double squared_radius;
  Eigen::Vector3d center_in_frame;
  double squared_radius_in_frame;

  template <class Tree>
  [[nodiscard]] Errc walk(const Tree& tree, InstanceVisitor instances) const {
    return walk_instances(tree, instances, center_in_frame, squared_radius_in_frame);
  }
  [[nodiscard]] Result<Visit> run_query(const BoundScene::Placed& placed,
                                        const FacesOfInstance& faces, QueryWork& work) const {
    const Placement& placement = placed.placement;
    const PlacedSphere exact{placement.to_world(), center, squared_radius};
    const PointInTree in_tree(placement, center);
    double most = 4 * kMaxCoordinate;
    double certain = 0;
    if (in_tree.is_near) {
      const Stretch stretch = stretch_of(placement.to_world().linear);
      const double error =
          placement.distance_error(in_tree.at, center, root_box<double>(*placed.tree));
      if (stretch.least > 0)
        most = std::min((radius + error) / stretch.least + kLengthUnderflow, most);
      certain = std::max(0.0, radius - error) / stretch.most;
    }
    const SphereQuery query{in_tree.at, most * most * (1 + 16 * kRoundoffF64), &exact,
                            certain * certain * (1 - 16 * kRoundoffF64)};
    return visit_sphere(*placed.tree, query, faces, work);
  }
};

struct PointInScene {
  const BoundScene& scene;
  QueryWork& work;
  Eigen::Vector3d point;
  double scene_margin;
  double best;  // squared
  std::optional<SceneClosestPoint> found = {};
  std::uint32_t found_id = 0;

  void set_bound(NearPointWalk& walk) const noexcept {
    walk.set_bound(std::sqrt(best), scene_margin);
  }
  // Takes a nearer point of the instance, if there is one.
  [[nodiscard]] Errc compare(NearPointWalk& walk, std::uint32_t instance,
                             const BoundScene::Placed& placed) {
    const Placement& placement = placed.placement;
    const BoundTree& tree = *placed.tree;
    const PointInTree in_tree(placement, point);
    PlacedPoint exact{placement.to_world(), point, best, 0, 0};
    if (in_tree.is_near) {
      exact.least_stretch = stretch_of(placement.to_world().linear).least;
      exact.error = placement.distance_error(in_tree.at, point, root_box<double>(tree));
    }
    WalkBound nodes(tree.node_count(), &work);
    PointQuery query(tree, nodes, in_tree.at, exact.bound_in_tree());
    query.placed = &exact;
    const Errc error = find_nearest(tree, query);
    if (error != Errc::kOk || !query.found) return error;
    if (found && exact.best == best &&
        !scene.comes_first(placed.id, query.found->face, found_id, found->face)) {
      return Errc::kOk;
    }
    found = SceneClosestPoint{{*query.found}, instance};
    found_id = placed.id;
    best = exact.best;
    set_bound(walk);
    return Errc::kOk;
  }
};

VisitResult visit_box(const Scene& queried, const Eigen::AlignedBox3d& box,
                      SceneFaceVisitor visitor, LayerMask layers, const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  if ((scene.query_kinds() & kBoxQueries) == 0) return Errc::kPartLeftOut;
  if (!is_finite_box(box)) return {Errc::kInvalidQuery, "box"};
  // No instance extends farther.
  const auto clamped = [](const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
    const Eigen::Vector3d a = low.cwiseMax(-kMaxCoordinate).cwiseMin(kMaxCoordinate);
    const Eigen::Vector3d b = high.cwiseMax(-kMaxCoordinate).cwiseMin(kMaxCoordinate);
    return Box<double>{{a[0], a[1], a[2]}, {b[0], b[1], b[2]}};
  };
  const WorldBox shape{
      {scene.to_frame(clamped(scene.to_units(box.min()), scene.to_units(box.max())))},
      clamped(box.min(), box.max())};
  return query_scene(scene, shape, visitor, layers, limits);
}

VisitResult visit_sphere(const Scene& queried, const Sphere& sphere, SceneFaceVisitor visitor,
                         LayerMask layers, const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  if ((scene.query_kinds() & kBoxQueries) == 0) return Errc::kPartLeftOut;
  const Eigen::Vector3d at = scene.to_units(sphere.center);
  if (!is_within_range(at)) return {Errc::kInvalidQuery, "center"};
  if (!(sphere.radius >= 0) || !std::isfinite(sphere.radius)) {
    return {Errc::kInvalidQuery, "radius"};
  }
  // As for a tree, a larger radius changes no answer.
  const double length = std::min(scene.to_units(sphere.radius), 4 * kMaxCoordinate);
  const SphereInUnits shape{at, length, largest_square_within(length), scene.to_frame(at),
                            frame_bound(length, frame_error(scene, largest_magnitude(at)))};
  return query_scene(scene, shape, visitor, layers, limits);
}

// Calls `visit(shape, visitor)` for each of a batch, one after the other.
template <class Shape, class VisitShape>
Status visit_each(std::span<const Shape> shapes, std::span<VisitResult> results,
                  SceneBatchFaceVisitor visitor, const VisitShape& visit) {
  std::size_t number = 0;
  const auto faces = [&](const SceneFace& face) { return visitor(number, face); };
  return answer_each(shapes, results, [&](const Shape& shape) {
    const VisitResult end = visit(shape, faces);
    ++number;
    return end;
  });
}

}  // namespace

Result<Visit> overlap_box(const Scene& scene, const Eigen::AlignedBox3d& box,
                          SceneFaceVisitor visitor, LayerMask layers, const QueryLimits& limits) {
  return as_result(visit_box(scene, box, visitor, layers, limits));
}

Result<Visit> overlap_sphere(const Scene& scene, const Eigen::Vector3d& center, double radius,
                             SceneFaceVisitor visitor, LayerMask layers,
                             const QueryLimits& limits) {
  return as_result(visit_sphere(scene, {center, radius}, visitor, layers, limits));
}

Status overlap_boxes(const Scene& scene, std::span<const Eigen::AlignedBox3d> boxes,
                     std::span<VisitResult> results, SceneBatchFaceVisitor visitor,
                     LayerMask layers, const QueryLimits& limits) {
  return visit_each(boxes, results, visitor, [&](const auto& box, SceneFaceVisitor faces) {
    return visit_box(scene, box, faces, layers, limits);
  });
}

Status overlap_spheres(const Scene& scene, std::span<const Sphere> spheres,
                       std::span<VisitResult> results, SceneBatchFaceVisitor visitor,
                       LayerMask layers, const QueryLimits& limits) {
  return visit_each(spheres, results, visitor, [&](const auto& sphere, SceneFaceVisitor faces) {
    return visit_sphere(scene, sphere, faces, layers, limits);
  });
}

ScenePointResult closest_point(const Scene& queried, const Eigen::Vector3d& point,
                               double max_distance, LayerMask layers, const QueryLimits& limits) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  QueryWork work(limits);
  if ((scene.query_kinds() & kPointQueries) == 0) return Errc::kPartLeftOut;
  const Eigen::Vector3d at = scene.to_units(point);
  const double most = scene.to_units(max_distance);
  if (!is_within_range(at)) return {Errc::kInvalidQuery, "point"};
  if (!(most >= 0)) return {Errc::kInvalidQuery, "max_distance"};
  PointInScene query{scene, work, at, frame_error(scene, largest_magnitude(at)),
                     largest_square_within(most)};
  const auto compare = [&](NearPointWalk& walk, std::uint32_t instance,
                           const BoundScene::Placed& placed) {
    return query.compare(walk, instance, placed);
  };
  NearPointWalk instances({scene, kPointQueries, layers, work}, scene.to_frame(at), compare);
  query.set_bound(instances);
  const Errc walked = instances.run();
  if (walked != Errc::kOk) return walked;
  if (!query.found) return {};
  query.found->point = scene.to_world(query.found->point);
  query.found->distance = scene.to_world(std::sqrt(query.found->distance));
  return *query.found;
}

Status closest_points(const Scene& scene, std::span<const Eigen::Vector3d> points,
                      std::span<ScenePointResult> results, double max_distance, LayerMask layers,
                      const QueryLimits& limits) {
  return answer_each(points, results, [&](const Eigen::Vector3d& point) {
    return closest_point(scene, point, max_distance, layers, limits);
  });
}

}  // namespace boxtree
