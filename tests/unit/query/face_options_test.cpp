// SPDX-License-Identifier: MIT
// Which faces rays and casts hit: all of them, those met from in front or behind, those that a
// filter accepts; against loops over all triangles in extended precision.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <set>
#include <tuple>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using LongVector = Eigen::Matrix<long double, 3, 1>;

// Options keep what they borrow beyond the statement: returning some with a lambda was a crash.
// What they refuse compiles up to a message, which tests/consumer sees.
template <class Filter, class Callable>
constexpr bool kTakes = std::is_assignable_v<std::optional<Filter>&, Callable>;
using OfFace = decltype([](const FaceRef&) { return true; });
static_assert(kTakes<FaceFilter, OfFace&> && kTakes<FaceFilter, const OfFace&> &&
              kTakes<FaceFilter, bool (&)(const FaceRef&)>);
static_assert(kTakes<FaceFilter, FaceFilter> && kTakes<FaceFilter, std::nullopt_t> &&
              !std::is_default_constructible_v<FaceFilter>);

struct TrueHit {
  std::uint32_t face;  // index
  std::uint32_t half;
  long double t;
  bool is_back;
};

// Of a ray that passes no edge within rounding, which random ones do not.
std::vector<TrueHit> true_hits(const Tree& tree, const Ray& ray) {
  std::vector<TrueHit> hits;
  const LongVector o = ray.origin.cast<long double>(), d = ray.direction.cast<long double>();
  for (std::uint32_t f = 0; f < tree.face_count(); ++f) {
    for (std::uint32_t half = 0; half < 2; ++half) {
      const Result<Triangle> triangle = tree.triangle({kNoFaceId, f}, half);
      if (!triangle) continue;
      const LongVector a = triangle->corner[0].cast<long double>();
      const LongVector e = triangle->corner[1].cast<long double>() - a;
      const LongVector g = triangle->corner[2].cast<long double>() - a;
      const LongVector n = e.cross(g);
      const long double across = n.dot(d);
      if (across == 0) continue;
      const long double t = n.dot(a - o) / across;
      const LongVector w = o + t * d - a;
      const long double u = n.dot(w.cross(g)) / n.squaredNorm();
      const long double v = n.dot(e.cross(w)) / n.squaredNorm();
      if (u < 0 || v < 0 || u + v > 1 || t < ray.t_min || t > ray.t_max) continue;
      hits.push_back({f, half, t, across > 0});
    }
  }
  return hits;
}

using Named = std::set<std::pair<std::uint32_t, std::uint32_t>>;

Named named(const std::vector<TrueHit>& hits, BackFaces back) {
  Named names;
  for (const TrueHit& hit : hits) {
    if (back == BackFaces::kHit || hit.is_back == (back == BackFaces::kOnly)) {
      names.insert({hit.face, hit.half});
    }
  }
  return names;
}

class FacesHit : public testing::TestWithParam<test::Encoding> {
 protected:
  template <class Body>
  void for_each_ray(int count, const Body& body) {
    for (const SourceMesh& mesh : test::all_kinds()) {
      if (mesh.name == "slivers") continue;  // too thin for the reference
      SCOPED_TRACE(mesh.name);
      const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
      const Eigen::AlignedBox3d box = cooked.tree.bounds();
      for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        const auto point = [&](double scale) {
          Eigen::Vector3d p;
          for (Eigen::Index k = 0; k < 3; ++k) {
            p[k] = box.center()[k] + scale * (box.sizes()[k] + 0.1) *
                                         std::uniform_real_distribution<double>(-1, 1)(random_);
          }
          return p;
        };
        const Eigen::Vector3d from = point(1.5);
        body(cooked.tree, Ray{from, point(0.4) - from});
        if (HasFatalFailure()) return;
      }
    }
  }

  std::mt19937_64 random_{17};
};

TEST_P(FacesHit, AllHitsAreThoseOfALoop) {
  std::size_t total = 0, behind = 0;
  for_each_ray(40, [&](const Tree& tree, const Ray& ray) {
    const std::vector<TrueHit> truth = true_hits(tree, ray);
    for (const BackFaces back : {BackFaces::kHit, BackFaces::kIgnore, BackFaces::kOnly}) {
      FaceOptions options;
      options.back_faces = back;
      Named found;
      std::vector<RayHit> hits;
      ASSERT_TRUE(all_hits(
          tree, ray,
          [&](const RayHit& hit) {
            EXPECT_TRUE(found.insert({hit.face.index, hit.triangle}).second);
            hits.push_back(hit);
            return ray.t_max;
          },
          options));
      ASSERT_EQ(found, named(truth, back));
      (back == BackFaces::kOnly ? behind : total) += found.size();

      // The closest of them, and some.
      const RayResult closest = closest_hit(tree, ray, options);
      ASSERT_EQ(closest.has_value(), !hits.empty());
      ASSERT_EQ(any_hit(tree, ray, options).has_value(), !hits.empty());
      if (hits.empty()) continue;
      const auto first = std::min_element(
          hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) { return a.t < b.t; });
      ASSERT_EQ(closest->t, first->t);

      // As many as there is room for, in order.
      std::vector<RayHit> room(3);
      const std::size_t count = test::require(nearest_hits(tree, ray, room, options));
      ASSERT_EQ(count, std::min<std::size_t>(3, hits.size()));
      std::sort(hits.begin(), hits.end(), [](const RayHit& a, const RayHit& b) {
        return std::tuple(a.t, a.face.id, a.triangle) < std::tuple(b.t, b.face.id, b.triangle);
      });
      for (std::size_t i = 0; i < count; ++i) {
        ASSERT_EQ(room[i].t, hits[i].t);
        ASSERT_EQ(room[i].face.id, hits[i].face.id);
      }
    }
  });
  EXPECT_GT(total, 100u);
  EXPECT_GT(behind, 20u);
}

TEST_P(FacesHit, AFilterIsCalledWithEachFace) {
  std::size_t passed = 0;
  for_each_ray(40, [&](const Tree& tree, const Ray& ray) {
    const auto accepts = [](const FaceRef& face) { return face.id % 3 != 0; };
    FaceOptions options;
    options.filter = accepts;
    long double first = std::numeric_limits<long double>::infinity();
    std::size_t accepted = 0;
    for (const TrueHit& hit : true_hits(tree, ray)) {
      if (BoundTree::of(tree).face_id(hit.face) % 3 == 0) continue;
      first = std::min(first, hit.t);
      ++accepted;
    }
    const RayResult closest = closest_hit(tree, ray, options);
    ASSERT_EQ(closest.has_value(), accepted > 0);
    if (closest) {
      ASSERT_NE(closest->face.id % 3, 0u);
      ASSERT_NEAR(closest->t, static_cast<double>(first), 1e-9);
      ++passed;
    }
    std::size_t visited = 0;
    ASSERT_TRUE(all_hits(
        tree, ray,
        [&](const RayHit&) {
          ++visited;
          return ray.t_max;
        },
        options));
    ASSERT_EQ(visited, accepted);
  });
  EXPECT_GT(passed, 20u);
}

TEST_P(FacesHit, ACastHitsTheSameSides) {
  std::size_t hits = 0;
  for_each_ray(30, [&](const Tree& tree, const Ray& ray) {
    // So small that it touches what the ray hits, but for edges that it grazes.
    const Sphere sphere{ray.origin, 1e-9 * tree.bounds().diagonal().norm()};
    for (const BackFaces back : {BackFaces::kHit, BackFaces::kIgnore, BackFaces::kOnly}) {
      FaceOptions options;
      options.back_faces = back;
      const auto accepts = [](const FaceRef& face) { return face.id % 5 != 0; };
      options.filter = accepts;
      const RayResult by_ray = closest_hit(tree, ray, options);
      const CastResult by_cast = cast_closest(tree, sphere, Motion{ray.direction}, options);
      ASSERT_EQ(by_cast.has_value(), by_ray.has_value());
      if (!by_cast) continue;
      ++hits;
      ASSERT_NEAR(by_cast->t, by_ray->t, 1e-5);
    }
  });
  EXPECT_GT(hits, 50u);
}

INSTANTIATE_TEST_SUITE_P(Encodings, FacesHit,
                         testing::Values(test::Encoding{CodecId::kWide8, GeometryId::kExact},
                                         test::Encoding{CodecId::kWide4, GeometryId::kGrid},
                                         test::Encoding{CodecId::kDedup, GeometryId::kExact}),
                         test::encoding_name);

TEST(FaceOptions, AFilterMayAcceptACopyAlone) {
  const test::CookedTree cooked = test::cook_tree(test::duplicates(20), CodecId::kWide8);
  const Triangle triangle = test::require(cooked.tree.triangle({0, 0}));
  const Eigen::Vector3d middle = (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3;
  const Eigen::Vector3d normal = (triangle.corner[1] - triangle.corner[0])
                                     .cross(triangle.corner[2] - triangle.corner[0])
                                     .normalized();
  const Ray ray{middle + normal, -normal};
  FaceOptions options;
  const auto is_seven = [](const FaceRef& face) { return face.id == 7; };
  options.filter = is_seven;
  const RayResult hit = closest_hit(cooked.tree, ray, options);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit->face.id, 7u);
  std::set<std::uint32_t> all;
  ASSERT_TRUE(all_hits(cooked.tree, ray, [&](const RayHit& each) {
    all.insert(each.face.id);
    return 1e9;
  }));
  EXPECT_EQ(all.size(), 20u);
  options.back_faces = BackFaces::kOnly;
  EXPECT_FALSE(closest_hit(cooked.tree, ray, options));
}

TEST(FaceOptions, AVisitorShortensAndStops) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(20, 20), CodecId::kWide4);
  const Ray ray{{0.1, 0.2, 5}, {0, 0, -1}};
  int visits = 0;
  EXPECT_EQ(test::require(all_hits(cooked.tree, ray,
                                   [&](const RayHit&) {
                                     ++visits;
                                     return -1.0;
                                   })),
            Visit::kStopped);
  EXPECT_EQ(visits, 1);
  double last = 0;
  ASSERT_TRUE(all_hits(cooked.tree, ray, [&](const RayHit& hit) { return last = hit.t; }));
  EXPECT_EQ(last, closest_hit(cooked.tree, ray)->t);
  EXPECT_EQ(test::require(nearest_hits(cooked.tree, ray, {})), 0u);
  EXPECT_EQ(nearest_hits(cooked.tree, {{0, 0, 5}, {0, 0, 0}}, {}).error().detail, "direction");
}

}  // namespace
}  // namespace boxtree
