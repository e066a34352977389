// SPDX-License-Identifier: MIT
// Frustums in a scene.
#include <boxtree/scene_frustum.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/frustum_sides.h"
#include "runtime/query/invalid_query.h"
#include "runtime/scene/placed_box.h"
#include "runtime/scene/scene_line.h"
#include "runtime/scene/scene_walk.h"
#include "runtime/walk/erased_codec.h"

namespace boxtree {
namespace {

// The planes in units of the scene, not widened yet.
FrustumSides in_units(const BoundScene& scene, const Frustum& frustum) noexcept {
  FrustumSides sides;
  for (std::size_t i = 0; i < frustum.planes.size(); ++i) {
    const Frustum::Plane& plane = frustum.planes[i];
    const Eigen::Vector3d normal = plane.head<3>();
    const double power = scale_to_one(normal);
    sides.side[i] = {power * normal, scene.to_units(power * plane[3])};
  }
  return sides;
}

// For points in units whose magnitudes on each axis are at most `largest`.
FrustumSides widened(FrustumSides sides, const Eigen::Vector3d& largest) noexcept {
  for (FrustumSide& side : sides.side) {
    side.offset +=
        FrustumSides::kError * (std::abs(side.offset) + dot(side.normal.cwiseAbs(), largest));
  }
  return sides;
}

// The same in a space that `map` takes to units, for boxes in it of coordinates up to `largest`:
// by more than it takes for what they hold to pass in units, widened as there.
FrustumSides moved(const FrustumSides& units, const AffineMap& map,
                   const Eigen::Vector3d& largest) noexcept {
  const Eigen::Vector3d terms =
      product(map.linear.cwiseAbs(), largest) + map.translation.cwiseAbs();
  FrustumSides sides = units;
  for (FrustumSide& side : sides.side) {
    const double size = std::abs(side.offset) + dot(side.normal.cwiseAbs(), terms);
    side.offset += dot(side.normal, map.translation) + 2 * FrustumSides::kError * size;
    side.normal = product(map.linear.transpose(), side.normal);
  }
  return sides;
}

FrustumSides in_frame(const BoundScene& scene, const FrustumSides& units) noexcept {
  const double largest = largest_in_frame(scene);
  FrustumSides sides =
      moved(units, {Eigen::Matrix3d::Identity(), scene.to_units(scene.frame().origin)},
            Eigen::Vector3d::Constant(largest));
  for (FrustumSide& side : sides.side) {
    side.offset +=
        dot(side.normal.cwiseAbs(), Eigen::Vector3d::Constant(1)) * frame_error(scene, largest);
  }
  return sides;
}

FrustumSides in_tree(const FrustumSides& units, const BoundScene::Placed& placed) noexcept {
  return moved(units, placed.placement.to_world(), max_abs_of(root_box<double>(*placed.tree)));
}

// A frustum against a placed tree: boxes where they are, triangles where they are placed.
struct PlacedFrustum {
  using Visitor = FacesOfInstance;

  FrustumSides in_tree;
  FrustumSides in_world;
  const AffineMap& to_world;

  template <class S>
  [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
    return in_tree.overlaps(box);
  }
  [[nodiscard]] bool touches(const Triangle& triangle) const noexcept {
    return in_world.touches(to_world.apply(triangle));
  }
};

// `answer(units, instance, placed, work)` -> Result<Visit>.
template <class Answer>
struct FrustumInScene : InstanceOutcome {
  Admission admission;
  FrustumSides units;
  FrustumSides sides;  // in the scene's frame
  const Answer& answer;

  // Of a tree whose leaves are instances.
  template <class Tree>
  struct Instances {
    const FrustumInScene& query;
    const Tree& tree;
    InstanceVisitor visit;
    WalkBound nodes;

    template <class S>
    [[nodiscard]] bool overlaps(const Box<S>& box) const noexcept {
      return query.sides.overlaps(box);
    }
    [[nodiscard]] bool leaf(NodeRef ref) const { return visit(tree.instance(ref)); }
  };

  template <class Tree>
  [[nodiscard]] Errc walk(const Tree& tree, InstanceVisitor visit) const {
    Instances<Tree> instances{*this, tree, visit, WalkBound(tree.node_count())};
    return traverse_overlap(tree, tree.decoder(), instances);
  }
  [[nodiscard]] bool visit(std::uint32_t instance, const BoundScene::Placed& placed) {
    if (placed.tree->empty()) return true;
    return note(answer(units, instance, placed, admission.work));
  }
};

template <class Answer>
Result<Visit> visit_in_frustum(const Scene& queried, const Frustum& frustum, LayerMask layers,
                               const QueryLimits& limits, const Answer& answer) {
  const DefaultFloatState state;
  const BoundScene& scene = BoundScene::of(queried);
  if ((scene.query_kinds() & kBoxQueries) == 0) return Errc::kPartLeftOut;
  if (!is_finite(frustum)) return invalid_query("planes");
  const FrustumSides units = in_units(scene, frustum);
  QueryWork work(limits);
  FrustumInScene<Answer> query{
      {}, {scene, kBoxQueries, layers, work}, units, in_frame(scene, units), answer};
  return outcome_of(visit_overlapping_instances(scene, query), query);
}

}  // namespace

Result<Visit> overlap_frustum(const Scene& scene, const Frustum& frustum, SceneFaceVisitor visitor,
                              LayerMask layers, const QueryLimits& limits) {
  return visit_in_frustum(
      scene, frustum, layers, limits,
      [&](const FrustumSides& units, std::uint32_t instance, const BoundScene::Placed& placed,
          QueryWork& work) {
        const BoundTree& tree = *placed.tree;
        const AffineMap& to_world = placed.placement.to_world();
        const Eigen::Vector3d largest = max_abs_of(to_world.hull(root_box<double>(tree)));
        const PlacedFrustum placed_frustum{in_tree(units, placed), widened(units, largest),
                                           to_world};
        WalkBound nodes(tree.node_count(), &work);
        FaceWalk<PlacedFrustum> walk{{tree, {visitor, instance}}, placed_frustum, nodes};
        return outcome_of(traverse_overlap(tree, ErasedCodec{&tree}, walk), walk);
      });
}

Result<Visit> instances_in_frustum(const Scene& scene, const Frustum& frustum,
                                   SceneInstanceVisitor visitor, LayerMask layers,
                                   const QueryLimits& limits) {
  return visit_in_frustum(
      scene, frustum, layers, limits,
      [&](const FrustumSides& units, std::uint32_t instance, const BoundScene::Placed& placed,
          QueryWork&) -> Result<Visit> {
        const bool may_touch = in_tree(units, placed).overlaps(root_box<double>(*placed.tree));
        return may_touch && !visitor(instance) ? Visit::kStopped : Visit::kComplete;
      });
}

}  // namespace boxtree
