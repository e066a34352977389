// SPDX-License-Identifier: MIT
// Every query there is, and what reads ahead for them, each once.
#pragma once

#include <cstdio>

#include <boxtree/boxtree.h>

inline const Eigen::AlignedBox3d kBox{Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)};
inline const boxtree::Ray kRay{{0, 0, 10}, {0, 0, -1}};

inline bool run_rays(const boxtree::Tree& tree) {
  boxtree::RayHit hits[2];
  const boxtree::FaceOptions front{.back_faces = boxtree::BackFaces::kIgnore};
  const auto all = [](const boxtree::RayHit& hit) { return hit.t; };
  return boxtree::closest_hit(tree, kRay, front).ok() && boxtree::any_hit(tree, kRay, front).ok() &&
         boxtree::all_hits(tree, kRay, all).ok() && boxtree::nearest_hits(tree, kRay, hits).ok();
}

inline bool run_casts(const boxtree::Tree& tree) {
  const boxtree::Sphere sphere{{0, 0, 10}, 1};
  const boxtree::Capsule capsule{{0, 0, 10}, {0, 0, 9}, 1};
  const boxtree::OrientedBox box{{0, 0, 10}, {1, 1, 1}, {1, 0, 0, 0}};
  const boxtree::Motion down{{0, 0, -1}};
  const auto shapes = [&](const auto& shape) {
    const auto all = [](const boxtree::CastHit& hit) { return hit.t; };
    return boxtree::cast_closest(tree, shape, down).ok() &&
           boxtree::cast_any(tree, shape, down).ok() &&
           boxtree::cast_all(tree, shape, down, all).ok();
  };
  return shapes(sphere) && shapes(capsule) && shapes(box);
}

inline bool run_contacts(const boxtree::Tree& tree) {
  const boxtree::Sphere sphere{{0, 0, 0}, 1};
  const boxtree::Capsule capsule{{0, 0, 0}, {0, 0, 1}, 1};
  const boxtree::OrientedBox box{{0, 0, 0}, {1, 1, 1}, {1, 0, 0, 0}};
  boxtree::Contact last;
  const auto keep = [&](const boxtree::Contact& contact) { return last = contact, true; };
  const auto face = [](const boxtree::FaceRef&) { return true; };
  const bool all = boxtree::collide(tree, sphere, keep).ok() &&
                   boxtree::collide(tree, capsule, keep).ok() &&
                   boxtree::collide(tree, box, keep).ok() &&
                   boxtree::overlap_capsule(tree, capsule, face).ok() &&
                   boxtree::overlap_oriented_box(tree, box, face).ok();
  return boxtree::merge_contacts({&last, 1}, 1) == 1 && all;
}

inline bool run_hulls(const boxtree::Tree& tree) {
  const Eigen::Vector3d points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const boxtree::ConvexHull hull{points, {0, 0, 1}, {1, 0, 0, 0}};
  const boxtree::Motion down{{0, 0, -1}};
  const auto all = [](const boxtree::CastHit& hit) { return hit.t; };
  const auto keep = [](const boxtree::Contact&) { return true; };
  const auto face = [](const boxtree::FaceRef&) { return true; };
  return boxtree::cast_closest(tree, hull, down).ok() && boxtree::cast_any(tree, hull, down).ok() &&
         boxtree::cast_all(tree, hull, down, all).ok() && boxtree::collide(tree, hull, keep).ok() &&
         boxtree::overlap_convex_hull(tree, hull, face).ok();
}

/// Casts and contacts of shapes, and rays with wishes.
inline bool run_shapes(const boxtree::Tree& tree) {
  return run_rays(tree) && run_casts(tree) && run_contacts(tree);
}

/// All others.
inline bool run_query(const boxtree::Tree& tree) {
  const boxtree::Pose pose = boxtree::Pose::Identity();
  int faces = 0;
  const auto count = [&faces](const boxtree::FaceRef&) { return ++faces > 0; };
  const bool all = boxtree::closest_hit(tree, kRay).ok() && boxtree::any_hit(tree, kRay).ok() &&
                   boxtree::overlap_box(tree, kBox, count).ok() &&
                   boxtree::overlap_sphere(tree, {0, 0, 0}, 1, count).ok() &&
                   boxtree::closest_point(tree, {0, 0, 0}, 1.0).ok() &&
                   boxtree::closest_point(tree, {0, 0, 0}, boxtree::PointOptions()).ok() &&
                   boxtree::first_contact(tree, pose, tree, pose).ok() &&
                   boxtree::distance(tree, pose, tree, pose).ok() &&
                   boxtree::overlap_within(tree, pose, tree, pose, 1).ok() &&
                   boxtree::overlap_box_within(tree, kBox, 1).ok();
  std::printf("%d faces\n", faces);
  return all;
}

inline bool run_query(boxtree::Scene& scene, const boxtree::Tree& tree) {
  const boxtree::Pose pose = boxtree::Pose::Identity();
  const auto face = [](const boxtree::SceneFace&) { return true; };
  const auto pair = [](const boxtree::ScenePair&) { return true; };
  static_cast<void>(scene.update(0, pose));
  return boxtree::closest_hit(scene, kRay).ok() && boxtree::any_hit(scene, kRay).ok() &&
         boxtree::overlap_box(scene, kBox, face).ok() &&
         boxtree::overlap_sphere(scene, {0, 0, 0}, 1, face).ok() &&
         boxtree::closest_point(scene, {0, 0, 0}).ok() && boxtree::contacts(scene, pair).ok() &&
         boxtree::overlap_pairs(scene, tree, pose, pair).ok();
}

// The status of the program.
inline int run_query(const boxtree::File& file) {
  const auto tree = boxtree::Tree::bind(file);
  if (!tree) return std::puts(tree.error().detail.c_str()), 1;
  file.advise(boxtree::Access::kWillNeed);
  tree->prefetch(4);
  bool all = run_query(*tree);
  auto scene = boxtree::Scene::bind(file);
  if (scene) all = all && run_query(*scene, *tree);
  return all ? 0 : 1;
}
