// SPDX-License-Identifier: MIT
// Which faces and instances of a scene rays and casts hit: all hits in order, filters, sides of
// faces, instances that are disabled; and what an application keeps for an instance.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/primitive/predicates.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::require;
using test::WorldTriangle;

using Name = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;  // instance, face, triangle

class SceneFaces : public testing::Test {
 protected:
  SceneFaces()
      : cooked_(test::cook_scene(
            {test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
            test::random_parts(40, 4, 7, 3, 11))),
        scene_(require(Scene::bind(cooked_.file))) {}

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d point() { return 5 * Eigen::Vector3d(unit(), unit(), unit()); }

  struct TrueHit {
    const WorldTriangle* triangle;
    double t;
    bool is_back;
  };
  // By brute force, of a ray that passes no edge within rounding.
  std::vector<TrueHit> true_hits(const Ray& ray) const {
    std::vector<TrueHit> hits;
    const RayShear shear(ray.origin, ray.direction);
    for (const WorldTriangle& each : triangles_) {
      const auto hit = intersect_ray_triangle(shear, each.triangle);
      if (!hit || hit->t < ray.t_min || hit->t > ray.t_max) continue;
      const auto& [a, b, c] = each.triangle.corner;
      const double side = require(scene_.pose(each.instance)).linear().determinant() < 0 ? -1 : 1;
      hits.push_back({&each, hit->t, side * (b - a).cross(c - a).dot(ray.direction) > 0});
    }
    std::sort(hits.begin(), hits.end(),
              [](const TrueHit& a, const TrueHit& b) { return a.t < b.t; });
    return hits;
  }

  std::mt19937_64 random_{5};
  CookedScene cooked_;
  Scene scene_;
  std::vector<WorldTriangle> triangles_ = test::world_triangles(cooked_, scene_);
};

TEST_F(SceneFaces, AllHitsAreThoseOfBruteForceOnEachSide) {
  std::size_t hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray{point(), point(), 0, i % 3 == 0 ? 1.0 : 1e9};
    for (const BackFaces back : {BackFaces::kHit, BackFaces::kIgnore, BackFaces::kOnly}) {
      SceneFaceOptions options;
      options.back_faces = back;
      std::vector<TrueHit> expected = true_hits(ray);
      std::erase_if(expected, [&](const TrueHit& hit) {
        return back != BackFaces::kHit && hit.is_back != (back == BackFaces::kOnly);
      });
      std::vector<SceneRayHit> found(expected.size() + 3);
      ASSERT_EQ(require(nearest_hits(scene_, ray, found, options)), expected.size()) << i;
      for (std::size_t k = 0; k < expected.size(); ++k) {
        ASSERT_NEAR(found[k].t, expected[k].t, 1e-11 * (1 + found[k].t));
        ASSERT_EQ(found[k].instance, expected[k].triangle->instance);
        ASSERT_EQ(found[k].face.id, expected[k].triangle->face);
        ASSERT_LT((found[k].point - ray.origin - found[k].t * ray.direction).norm(), 1e-9);
      }
      // The first alone, and as many as there is room for.
      const auto closest = require(closest_hit(scene_, ray, options));
      ASSERT_EQ(closest.has_value(), !expected.empty());
      ASSERT_EQ(require(any_hit(scene_, ray, options)).has_value(), !expected.empty());
      if (expected.empty()) continue;
      ASSERT_EQ(closest->t, found[0].t);
      ASSERT_EQ(closest->instance, found[0].instance);
      std::vector<SceneRayHit> few(std::min<std::size_t>(2, expected.size()));
      ASSERT_EQ(require(nearest_hits(scene_, ray, few, options)), few.size());
      for (std::size_t k = 0; k < few.size(); ++k) ASSERT_EQ(few[k].t, found[k].t);
      hits += expected.size();
    }
  }
  EXPECT_GT(hits, 1000u);
}

TEST_F(SceneFaces, AVisitorShortensTheRayOverAllInstancesOrStops) {
  for (int i = 0; i < 100; ++i) {
    const Ray ray{point(), point()};
    const std::vector<TrueHit> expected = true_hits(ray);
    if (expected.size() < 2) continue;
    // What it returns last is nearer than all that comes later.
    double least = std::numeric_limits<double>::infinity();
    ASSERT_EQ(require(all_hits(scene_, ray,
                               [&](const SceneRayHit& hit) {
                                 EXPECT_LE(hit.t, least);
                                 least = std::min(least, hit.t);
                                 return hit.t;
                               })),
              Visit::kComplete);
    ASSERT_NEAR(least, expected[0].t, 1e-11 * (1 + least));
    int count = 0;
    ASSERT_EQ(require(all_hits(scene_, ray,
                               [&](const SceneRayHit&) {
                                 ++count;
                                 return -1.0;
                               })),
              Visit::kStopped);
    ASSERT_EQ(count, 1);
  }
}

TEST_F(SceneFaces, FiltersOfFacesAndInstancesCount) {
  std::size_t hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Ray ray{point(), point()};
    const auto wants_face = [](const SceneFace& face) {
      return (face.instance + face.face.id) % 3 != 0;
    };
    const auto wants_instance = [](std::uint32_t instance) { return instance % 4 != 1; };
    SceneFaceOptions options;
    options.filter = SceneFaceFilter(wants_face);
    options.instance_filter = InstanceFilter(wants_instance);
    options.layers = 0b101;
    std::vector<TrueHit> expected = true_hits(ray);
    std::erase_if(expected, [&](const TrueHit& hit) {
      const SceneFace face{hit.triangle->instance, {hit.triangle->face, 0}};
      return !wants_face(face) || !wants_instance(face.instance) ||
             require(scene_.info(face.instance)).layer == 1;
    });
    const auto hit = require(closest_hit(scene_, ray, options));
    ASSERT_EQ(hit.has_value(), !expected.empty());
    // A cast of a point is the same, but for the roundings that it may be off.
    const auto cast =
        require(cast_closest(scene_, Sphere{ray.origin, 0}, {ray.direction}, options));
    ASSERT_EQ(cast.has_value(), !expected.empty());
    if (!hit) continue;
    ++hits;
    ASSERT_EQ(hit->instance, expected[0].triangle->instance);
    ASSERT_EQ(hit->face.id, expected[0].triangle->face);
    ASSERT_NEAR(cast->t, hit->t, 1e-10 * (1 + hit->t));
    ASSERT_EQ(cast->instance, hit->instance);
  }
  EXPECT_GT(hits, 50u);
}

TEST_F(SceneFaces, ADisabledInstanceIsNotThere) {
  for (std::uint32_t instance = 0; instance < scene_.instance_count(); ++instance) {
    ASSERT_TRUE(scene_.is_enabled(instance));
  }
  const Eigen::AlignedBox3d everything(Eigen::Vector3d::Constant(-99),
                                       Eigen::Vector3d::Constant(99));
  const auto instances = [&] {
    std::set<std::uint32_t> seen;
    const auto note = [&](const SceneFace& face) {
      seen.insert(face.instance);
      return true;
    };
    EXPECT_TRUE(overlap_box(scene_, everything, note));
    std::set<std::uint32_t> touched, met;
    EXPECT_TRUE(collide(scene_, Sphere{{0, 0, 0}, 99}, [&](const SceneContact& contact) {
      touched.insert(contact.instance);
      return true;
    }));
    EXPECT_EQ(touched, seen);
    EXPECT_TRUE(contacts(scene_, [&](const ScenePair& pair) {
      met.insert(pair.first.instance);
      met.insert(pair.second.instance);
      return true;
    }));
    EXPECT_TRUE(std::includes(seen.begin(), seen.end(), met.begin(), met.end()));
    return seen;
  };
  const std::set<std::uint32_t> all = instances();
  ASSERT_EQ(all.size(), scene_.instance_count());
  for (const std::uint32_t off : {0u, 7u, 8u, 39u}) {  // the first two move
    ASSERT_TRUE(scene_.set_enabled(off, false).ok());
    EXPECT_FALSE(scene_.is_enabled(off));
    std::set<std::uint32_t> without = all;
    without.erase(off);
    EXPECT_EQ(instances(), without);
    EXPECT_EQ(require(contacts_of(scene_, off, [](const ScenePair&) { return false; })),
              Visit::kComplete);
    ASSERT_TRUE(scene_.set_enabled(off, true).ok());
    EXPECT_EQ(instances(), all);
  }
  EXPECT_EQ(scene_.set_enabled(40, false).code(), Errc::kInstanceIndex);
  EXPECT_FALSE(scene_.is_enabled(40));
}

TEST_F(SceneFaces, AnInstanceKeepsANumberOfTheApplication) {
  EXPECT_EQ(scene_.user_data(3), 0u);
  ASSERT_TRUE(scene_.set_user_data(3, 0xfedcba9876543210u).ok());
  EXPECT_EQ(scene_.user_data(3), 0xfedcba9876543210u);
  EXPECT_EQ(scene_.user_data(4), 0u);
  EXPECT_EQ(scene_.user_data(40), 0u);
  EXPECT_EQ(scene_.set_user_data(40, 1).code(), Errc::kInstanceIndex);
}

}  // namespace
}  // namespace boxtree
