// SPDX-License-Identifier: MIT
// Runs the queries that PARTS names on a mapped file, each once: what each part of the runtime
// takes in a program that calls it.
#include <cstdio>
#include <type_traits>

#include <boxtree/boxtree.h>

namespace {

enum Parts : unsigned {
  kRay = 1,
  kHits = 2,  // sides and filters of rays, all hits, the nearest ones
  kCast = 4,
  kCollide = 8,
  kHull = 16,
  kBox = 32,
  kSphere = 64,
  kFrustum = 128,
  kPoint = 256,
  kPair = 512,
  kPairContacts = 1024,
  kDistance = 2048,
  kWithin = 4096,
  kScene = 8192,
  kRayBatch = 16384,
  kPointBatch = 32768,
  kShapeBatch = 65536,
  kAll = 131071
};
#ifndef PARTS
#define PARTS kAll
#endif

// What is not named is not called: the linker drops it.
constexpr bool has(unsigned part) {
  return ((PARTS)&part) != 0;
}

using boxtree::Pose;
using boxtree::Tree;

const Eigen::AlignedBox3d kCube{Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)};
const boxtree::Capsule kUpright{{0, 0, 0}, {0, 0, 1}, 1};
const boxtree::OrientedBox kTurned{{0, 0, 0}, {1, 1, 1}, {1, 0, 0, 1}};
const Eigen::Vector3d kPoints[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const boxtree::Ray kDown{{0, 0, 10}, {0, 0, -1}};
constexpr auto kGoOn = [](const auto&...) { return true; };
constexpr auto kFurther = [](const auto& hit) { return hit.t; };

boxtree::Frustum view() {
  boxtree::Frustum frustum;
  frustum.planes.fill({0, 0, 0, 1});
  return frustum;
}

template <class World>
bool query_rays(const World& world) {
  using Options = std::conditional_t<std::is_same_v<World, Tree>, boxtree::FaceOptions,
                                     boxtree::SceneFaceOptions>;
  using Hit =
      std::conditional_t<std::is_same_v<World, Tree>, boxtree::RayHit, boxtree::SceneRayHit>;
  bool all = closest_hit(world, kDown).ok() && any_hit(world, kDown).ok();
  if constexpr (has(kHits)) {
    Options front;
    front.back_faces = boxtree::BackFaces::kIgnore;
    Hit hits[2];
    all = all && closest_hit(world, kDown, front).ok() && any_hit(world, kDown, front).ok() &&
          nearest_hits(world, kDown, hits).ok() && all_hits(world, kDown, kFurther).ok();
  }
  if constexpr (has(kRayBatch) && std::is_same_v<World, Tree>) {
    const boxtree::Ray rays[] = {kDown};
    boxtree::RayResult results[1];
    all = all && closest_hits(world, rays, results).ok() && any_hits(world, rays, results).ok();
  }
  return all;
}

template <class World, class Shape>
bool query_shape(const World& world, const Shape& shape) {
  bool all = true;
  if constexpr (has(kCast)) {
    const boxtree::Motion down{{0, 0, -1}};
    all = cast_closest(world, shape, down).ok() && cast_any(world, shape, down).ok() &&
          cast_all(world, shape, down, kFurther).ok();
  }
  if constexpr (has(kCollide)) all = all && collide(world, shape, kGoOn).ok();
  return all;
}

// Queries that trees and scenes have.
template <class World>
bool query(const World& world) {
  const boxtree::ConvexHull hull{kPoints};
  bool all = query_shape(world, boxtree::Sphere{{0, 0, 0}, 1}) && query_shape(world, kUpright) &&
             query_shape(world, kTurned);
  if constexpr (has(kRay)) all = all && query_rays(world);
  if constexpr (has(kHull)) all = all && query_shape(world, hull);
  if constexpr (has(kCollide)) {
    all = all && overlap_capsule(world, kUpright, kGoOn).ok() &&
          overlap_oriented_box(world, kTurned, kGoOn).ok();
    if constexpr (has(kHull)) all = all && overlap_convex_hull(world, hull, kGoOn).ok();
  }
  if constexpr (has(kBox)) all = all && overlap_box(world, kCube, kGoOn).ok();
  if constexpr (has(kSphere)) all = all && overlap_sphere(world, {0, 0, 0}, 1, kGoOn).ok();
  if constexpr (has(kFrustum)) all = all && overlap_frustum(world, view(), kGoOn).ok();
  if constexpr (has(kPoint)) all = all && closest_point(world, {0, 0, 0}).ok();
  if constexpr (has(kPointBatch) && std::is_same_v<World, Tree>) {
    boxtree::PointResult results[4];
    all = all && closest_points(world, kPoints, results).ok();
  }
  if constexpr (has(kShapeBatch) && std::is_same_v<World, Tree>) {
    constexpr auto kGoOnWithAll = [](std::size_t, const boxtree::FaceRef&) { return true; };
    boxtree::VisitResult results[4];
    const boxtree::Sphere spheres[4] = {};
    const Eigen::AlignedBox3d boxes[4];
    all = all && overlap_boxes(world, boxes, results, kGoOnWithAll).ok() &&
          overlap_spheres(world, spheres, results, kGoOnWithAll).ok();
  }
  return all;
}

bool query_pairs(const Tree& tree) {
  const Pose pose = Pose::Identity();
  bool all = true;
  if constexpr (has(kPair)) {
    all = first_contact(tree, pose, tree, pose).ok() &&
          overlap_pairs(tree, pose, tree, pose, kGoOn).ok();
  }
  if constexpr (has(kPairContacts)) {
    all = all && pair_contacts(tree, pose, tree, pose, kGoOn).ok();
  }
  if constexpr (has(kDistance)) all = all && distance(tree, pose, tree, pose).ok();
  if constexpr (has(kWithin)) {
    all = all && overlap_within(tree, pose, tree, pose, 1).ok() &&
          overlap_box_within(tree, kCube, 1).ok();
  }
  return all;
}

bool query_scene(const boxtree::File& file, const Tree& tree) {
  auto scene = boxtree::Scene::bind(file);
  if (!scene) return true;  // it has none
  const Pose pose = Pose::Identity();
  bool all = scene->update(0, pose).ok() && query(*scene) && contacts(*scene, kGoOn).ok() &&
             overlap_pairs(*scene, tree, pose, kGoOn).ok();
  if constexpr (has(kFrustum)) all = all && instances_in_frustum(*scene, view(), kGoOn).ok();
  if constexpr (has(kDistance)) {
    all = all && distance(*scene, tree, pose).ok() && distance_of(*scene, 0).ok();
  }
  if constexpr (has(kPairContacts)) {
    all = all && pair_contacts(*scene, kGoOn).ok() && pair_contacts(*scene, tree, pose, kGoOn).ok();
  }
  return all;
}

}  // namespace

int main(int, char** argv) {
  const auto file = boxtree::File::open(argv[1]);
  if (!file) return std::puts(file.error().detail.c_str()), 1;
  const auto tree = Tree::bind(*file, 0);
  if (!tree) return std::puts(tree.error().detail.c_str()), 1;
  bool all = query(*tree) && query_pairs(*tree);
  if constexpr (has(kScene)) all = all && query_scene(*file, *tree);
  return all ? 0 : 1;
}
