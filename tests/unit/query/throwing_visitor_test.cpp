// SPDX-License-Identifier: MIT
// An exception of a visitor, a filter or a test of boxes ends the query and passes to its caller,
// from every query, over every codec and store.
#include <array>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

struct Stop {};

// Takes anything, and throws.
struct Thrower {
  template <class... Args>
  bool operator()(const Args&...) const {
    throw Stop{};
  }
};
struct ThrowingDouble {
  template <class... Args>
  double operator()(const Args&...) const {
    throw Stop{};
  }
};

struct Named {
  std::string name;
  std::function<void()> query;
};

// Each throws, and a query on the same tree answers as before.
void expect_all_throw(const std::vector<Named>& queries, const std::function<double()>& answer) {
  const double before = answer();
  for (const Named& each : queries) {
    EXPECT_THROW(each.query(), Stop) << each.name;
    EXPECT_EQ(answer(), before) << each.name;
  }
}

// A torus in the plane z = 0, with radius 1, is met by these.
const Ray kRay{{1, 0, 9}, {0, 0, -1}};
const Motion kMotion{{0, 0, -1}};
const Sphere kSphere{{1, 0, 0}, 0.5};
const Capsule kCapsule{{1, 0, -0.2}, {1, 0, 0.2}, 0.4};
const OrientedBox kBox{{1, 0, 0}, {0.5, 0.5, 0.5}, {1, 0, 0, 0}};
const Eigen::AlignedBox3d kBounds{Eigen::Vector3d(0.5, -0.5, -0.5), Eigen::Vector3d(1.5, 0.5, 0.5)};

const std::vector<Eigen::Vector3d>& hull_points() {
  static const std::vector<Eigen::Vector3d> points = {
      {0.5, -0.5, -0.5}, {1.5, -0.5, -0.5}, {1, 0.5, -0.5}, {1, 0, 0.5}};
  return points;
}

template <class Shape>
Shape above(Shape shape) {
  if constexpr (std::is_same_v<Shape, Capsule>) {
    shape.start.z() += 9;
    shape.end.z() += 9;
  } else {
    shape.center.z() += 9;
  }
  return shape;
}

// What a tree and a scene have alike. `options`: those with a filter that throws.
template <class Part, class Options>
void add_common(const Part& part, const Options& options, std::vector<Named>& out) {
  const Thrower thrower;
  const ThrowingDouble number;
  out.push_back(
      {"closest_hit, filter", [&part, options] { (void)closest_hit(part, kRay, options); }});
  out.push_back({"any_hit, filter", [&part, options] { (void)any_hit(part, kRay, options); }});
  out.push_back({"all_hits", [&part, number] { (void)all_hits(part, kRay, number); }});
  out.push_back({"overlap_box", [&part, thrower] { (void)overlap_box(part, kBounds, thrower); }});
  out.push_back({"overlap_boxes", [&part, thrower] {
                   const std::vector<Eigen::AlignedBox3d> boxes(9, kBounds);
                   std::vector<VisitResult> results(boxes.size());
                   (void)overlap_boxes(part, boxes, results, thrower);
                 }});
  out.push_back({"overlap_spheres", [&part, thrower] {
                   const std::vector<Sphere> spheres(9, kSphere);
                   std::vector<VisitResult> results(spheres.size());
                   (void)overlap_spheres(part, spheres, results, thrower);
                 }});
  out.push_back({"overlap_sphere", [&part, thrower] {
                   (void)overlap_sphere(part, kSphere.center, kSphere.radius, thrower);
                 }});
  out.push_back(
      {"overlap_capsule", [&part, thrower] { (void)overlap_capsule(part, kCapsule, thrower); }});
  out.push_back({"overlap_oriented_box",
                 [&part, thrower] { (void)overlap_oriented_box(part, kBox, thrower); }});
  out.push_back({"overlap_convex_hull", [&part, thrower] {
                   (void)overlap_convex_hull(part, ConvexHull{hull_points()}, thrower);
                 }});
  out.push_back(
      {"overlap_frustum", [&part, thrower] {
         (void)overlap_frustum(
             part, Frustum::of(Frustum::ViewProjection(Frustum::ViewProjection::Identity() / 4)),
             thrower);
       }});
  const auto add_shape = [&](const char* name, const auto& shape) {
    out.push_back({std::string("collide, ") + name,
                   [&part, shape, thrower] { (void)collide(part, shape, thrower); }});
    out.push_back({std::string("cast_all, ") + name, [&part, shape, number] {
                     (void)cast_all(part, above(shape), kMotion, number);
                   }});
    out.push_back({std::string("cast_closest, filter, ") + name, [&part, shape, options] {
                     (void)cast_closest(part, above(shape), kMotion, options);
                   }});
  };
  add_shape("sphere", kSphere);
  add_shape("capsule", kCapsule);
  add_shape("box", kBox);
  out.push_back({"collide, hull",
                 [&part, thrower] { (void)collide(part, ConvexHull{hull_points()}, thrower); }});
  out.push_back({"cast_all, hull", [&part, number] {
                   (void)cast_all(part, ConvexHull{hull_points()}, kMotion, number);
                 }});
}

class ThrowingVisitor : public testing::TestWithParam<test::Encoding> {};

TEST_P(ThrowingVisitor, PassesThroughTreesQueries) {
  const test::CookedTree cooked = test::cook_tree(test::torus(10, 14), GetParam());
  const Tree& tree = cooked.tree;
  const Thrower thrower;
  FaceOptions options;
  options.filter = thrower;
  std::vector<Named> queries;
  add_common(tree, options, queries);
  queries.push_back({"closest_hits, filter", [&] {
                       const std::vector<Ray> rays(20, kRay);
                       std::vector<RayResult> results(rays.size());
                       (void)closest_hits(tree, rays, results, options);
                     }});
  queries.push_back({"traverse, boxes", [&] {
                       (void)traverse(tree, thrower, [](const LeafTriangle&) { return true; });
                     }});
  queries.push_back({"traverse, triangles", [&] {
                       (void)traverse(
                           tree, [](const Eigen::AlignedBox3d&) { return true; }, thrower);
                     }});
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.1, 0.2, 0.03);
  queries.push_back(
      {"overlap_pairs", [&] { (void)overlap_pairs(tree, Pose::Identity(), tree, pose, thrower); }});
  queries.push_back(
      {"pair_contacts", [&] { (void)pair_contacts(tree, Pose::Identity(), tree, pose, thrower); }});
  expect_all_throw(queries, [&] { return closest_hit(tree, kRay)->t; });
}

TEST_P(ThrowingVisitor, PassesThroughScenesQueries) {
  cooker::SceneParts parts = test::random_parts(4, 1, 2, 1, 1);
  for (auto& instance : parts.instances) instance.pose = Pose::Identity();
  const test::CookedScene cooked =
      test::cook_scene({test::torus(10, 14)}, parts, {GetParam().codec});
  const Scene scene = test::require(Scene::bind(cooked.file));
  const Thrower thrower;
  std::vector<Named> queries;
  for (const bool of_instances : {false, true}) {
    SceneFaceOptions options;
    if (of_instances) {
      options.instance_filter = thrower;
    } else {
      options.filter = thrower;
    }
    add_common(scene, options, queries);
  }
  queries.push_back(
      {"instances_in_frustum", [&] {
         (void)instances_in_frustum(
             scene, Frustum::of(Frustum::ViewProjection(Frustum::ViewProjection::Identity() / 4)),
             thrower);
       }});
  queries.push_back({"contacts", [&] { (void)contacts(scene, thrower); }});
  queries.push_back({"contacts_of", [&] { (void)contacts_of(scene, 0, thrower); }});
  queries.push_back({"pair_contacts", [&] { (void)pair_contacts(scene, thrower); }});
  queries.push_back({"pair_contacts_of", [&] { (void)pair_contacts_of(scene, 0, thrower); }});
  expect_all_throw(queries, [&] { return closest_hit(scene, kRay)->t; });
}

INSTANTIATE_TEST_SUITE_P(Encodings, ThrowingVisitor, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree
