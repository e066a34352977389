// SPDX-License-Identifier: MIT
// Queries on scenes against brute force over every placed triangle.
#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/vector3.h"
#include "runtime/scene/bound_scene.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using test::CookedScene;
using test::require;
using test::WorldTriangle;

using FaceSet = std::set<std::pair<std::uint32_t, std::uint32_t>>;  // instance, source face

class SceneQueries : public testing::TestWithParam<CodecId> {
 protected:
  SceneQueries()
      : cooked_(test::cook_scene(
            {test::sphere(8, 12), test::torus(10, 14), test::terrain(6, 1), test::soup(40, 3)},
            test::random_parts(40, 4, 7, 3, 11), {GetParam()})),
        scene_(require(Scene::bind(cooked_.file))) {}

  // Moves what moves, and compares before and after.
  template <class Body>
  void before_and_after_moving(Body body) {
    {
      SCOPED_TRACE("as cooked");
      body(test::world_triangles(cooked_, scene_));
    }
    for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
      ASSERT_TRUE(scene_.update(moving.instance, test::random_pose(random_, 4, true)).ok());
    }
    SCOPED_TRACE("moved");
    body(test::world_triangles(cooked_, scene_));
  }

  Eigen::Vector3d point(double spread = 5) {
    return spread * Eigen::Vector3d{unit(), unit(), unit()};
  }
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }

  std::mt19937_64 random_{5};
  CookedScene cooked_;
  Scene scene_;
};

TEST_P(SceneQueries, ClosestHitEqualsBruteForce) {
  before_and_after_moving([&](const std::vector<WorldTriangle>& triangles) {
    std::size_t hits = 0;
    for (int i = 0; i < 300; ++i) {
      const Ray ray{point(), point()};
      const RayShear shear(ray.origin, ray.direction);
      double best = std::numeric_limits<double>::infinity();
      const WorldTriangle* nearest = nullptr;
      for (const WorldTriangle& candidate : triangles) {
        const auto hit = intersect_ray_triangle(shear, candidate.triangle);
        if (!hit || hit->t < 0 || hit->t >= best) continue;
        best = hit->t;
        nearest = &candidate;
      }
      const auto hit = require(closest_hit(scene_, ray));
      ASSERT_EQ(hit.has_value(), nearest != nullptr) << i;
      ASSERT_EQ(require(any_hit(scene_, ray)).has_value(), nearest != nullptr);
      if (!hit) continue;
      ++hits;
      ASSERT_NEAR(hit->t, best, 1e-12 * (1 + best));
      ASSERT_EQ(hit->instance, nearest->instance);
      ASSERT_EQ(hit->face.id, nearest->face);
      ASSERT_LT((hit->point - (ray.origin + best * ray.direction)).norm(), 1e-9);
      // Mirrors turn the order of the corners over, but not the surface.
      const auto& [a, b, c] = nearest->triangle.corner;
      const Pose pose = require(scene_.pose(hit->instance));
      const double side = pose.linear().determinant() < 0 ? -1 : 1;
      ASSERT_LT((hit->normal - side * (b - a).cross(c - a).normalized()).norm(), 1e-7);
      const Triangle named = require(scene_.triangle({hit->instance, hit->face}, hit->triangle));
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_LT((named.corner[k] - nearest->triangle.corner[k]).norm(), 1e-12);
      }
    }
    EXPECT_GT(hits, 100u);
  });
}

TEST_P(SceneQueries, BatchesAnswerEachRayAsAlone) {
  std::vector<Ray> rays;
  for (int i = 0; i < 100; ++i) rays.push_back({point(), point()});
  rays[7].direction.setZero();
  std::vector<SceneRayResult> closest(rays.size()), any(rays.size());
  for (const LayerMask layers : {kAllLayers, LayerMask{1}}) {
    for (const QueryLimits& limits : {QueryLimits(), QueryLimits{20}}) {
      ASSERT_TRUE(closest_hits(scene_, rays, closest, layers, limits).ok());
      ASSERT_TRUE(any_hits(scene_, rays, any, layers, limits).ok());
      for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE(i);
        const auto expect_same = [](const SceneRayResult& a, const SceneRayResult& b) {
          EXPECT_EQ(a.code(), b.code());
          EXPECT_EQ(a.error().detail, b.error().detail);
          EXPECT_EQ(a.has_value(), b.has_value());
          EXPECT_EQ(a->t, b->t);
          EXPECT_EQ(a->instance, b->instance);
          EXPECT_EQ(a->face.index, b->face.index);
          EXPECT_EQ(a->point, b->point);
          EXPECT_EQ(a->normal, b->normal);
        };
        expect_same(closest[i], closest_hit(scene_, rays[i], layers, limits));
        expect_same(any[i], any_hit(scene_, rays[i], layers, limits));
      }
    }
  }
  const auto few = std::span(closest).first(3);
  EXPECT_EQ(closest_hits(scene_, rays, few).error().detail, "results.size()");
  EXPECT_EQ(any_hits(scene_, rays, few).error().detail, "results.size()");
}

TEST_P(SceneQueries, BatchesVisitForEachShapeWhatItVisitsAlone) {
  std::vector<Eigen::AlignedBox3d> boxes;
  std::vector<Sphere> spheres;
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d at = point();
    boxes.emplace_back(at - Eigen::Vector3d::Constant(0.3), at + Eigen::Vector3d(0.1, 0.7, 0.2));
    spheres.push_back({at, 0.4});
  }
  boxes[7].min().x() = std::numeric_limits<double>::quiet_NaN();
  spheres[8].radius = -1;
  // Of even shapes two faces at most.
  using FewFaces = std::vector<std::pair<std::uint32_t, std::uint32_t>>;
  const auto keep = [](FewFaces& faces, std::size_t i, const SceneFace& face) {
    faces.emplace_back(face.instance, face.face.index);
    return i % 2 == 1 || faces.size() < 2;
  };
  std::size_t found = 0;
  for (const LayerMask layers : {kAllLayers, LayerMask{1}}) {
    for (const QueryLimits& limits : {QueryLimits(), QueryLimits{20}}) {
      const auto expect_as_alone = [&](const auto& shapes, const auto& visit_all,
                                       const auto& visit) {
        std::vector<FewFaces> faces(shapes.size());
        std::vector<VisitResult> results(shapes.size());
        ASSERT_TRUE(visit_all(shapes, results, [&](std::size_t i, const SceneFace& face) {
                      return keep(faces[i], i, face);
                    }).ok());
        for (std::size_t i = 0; i < shapes.size(); ++i) {
          SCOPED_TRACE(i);
          FewFaces alone;
          const Result<Visit> end =
              visit(shapes[i], [&](const SceneFace& face) { return keep(alone, i, face); });
          EXPECT_EQ(faces[i], alone);
          ASSERT_EQ(results[i].code(), end.code());
          if (end) {
            EXPECT_EQ(*results[i], *end);
          } else {
            EXPECT_EQ(results[i].error().detail, end.error().detail);
          }
          found += alone.size();
        }
      };
      expect_as_alone(
          boxes,
          [&](const auto& shapes, auto& results, const auto& visitor) {
            return overlap_boxes(scene_, shapes, results, visitor, layers, limits);
          },
          [&](const Eigen::AlignedBox3d& box, const auto& visitor) {
            return overlap_box(scene_, box, visitor, layers, limits);
          });
      expect_as_alone(
          spheres,
          [&](const auto& shapes, auto& results, const auto& visitor) {
            return overlap_spheres(scene_, shapes, results, visitor, layers, limits);
          },
          [&](const Sphere& sphere, const auto& visitor) {
            return overlap_sphere(scene_, sphere, visitor, layers, limits);
          });
    }
  }
  EXPECT_GT(found, 100u);
  std::vector<VisitResult> results(3);
  const auto visitor = [](std::size_t, const SceneFace&) { return true; };
  EXPECT_EQ(overlap_boxes(scene_, boxes, results, visitor).error().detail, "results.size()");
  EXPECT_EQ(overlap_spheres(scene_, spheres, results, visitor).error().detail, "results.size()");
}

TEST_P(SceneQueries, BatchesAnswerEachPointAsAlone) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 100; ++i) points.push_back(point());
  points[7].x() = std::numeric_limits<double>::quiet_NaN();
  std::vector<ScenePointResult> closest(points.size());
  for (const LayerMask layers : {kAllLayers, LayerMask{1}}) {
    for (const QueryLimits& limits : {QueryLimits(), QueryLimits{20}}) {
      ASSERT_TRUE(closest_points(scene_, points, closest, 3, layers, limits).ok());
      for (std::size_t i = 0; i < points.size(); ++i) {
        SCOPED_TRACE(i);
        const ScenePointResult alone = closest_point(scene_, points[i], 3, layers, limits);
        EXPECT_EQ(closest[i].code(), alone.code());
        EXPECT_EQ(closest[i].error().detail, alone.error().detail);
        EXPECT_EQ(closest[i].has_value(), alone.has_value());
        EXPECT_EQ(closest[i]->distance, alone->distance);
        EXPECT_EQ(closest[i]->instance, alone->instance);
        EXPECT_EQ(closest[i]->face.index, alone->face.index);
        EXPECT_EQ(closest[i]->point, alone->point);
      }
    }
  }
  EXPECT_EQ(closest_points(scene_, points, std::span(closest).first(3)).error().detail,
            "results.size()");
}

TEST_P(SceneQueries, BoxEqualsBruteForce) {
  before_and_after_moving([&](const std::vector<WorldTriangle>& triangles) {
    std::size_t touched = 0;
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector3d middle = point();
      const Eigen::Vector3d half = (0.05 + (i % 10) * 0.2) * point(1).cwiseAbs();
      const Eigen::AlignedBox3d box(middle - half, middle + half);
      FaceSet expected, found;
      for (const WorldTriangle& candidate : triangles) {
        if (triangle_intersects_box(candidate.triangle, box.min(), box.max())) {
          expected.insert({candidate.instance, candidate.face});
        }
      }
      std::size_t visits = 0;
      const auto visit = overlap_box(scene_, box, [&](const SceneFace& face) {
        ++visits;
        return found.insert({face.instance, face.face.id}).second;
      });
      ASSERT_EQ(require(visit), Visit::kComplete);
      ASSERT_EQ(found, expected);
      ASSERT_EQ(visits, expected.size());
      touched += visits;
    }
    EXPECT_GT(touched, 500u);
  });
}

TEST_P(SceneQueries, SphereEqualsBruteForce) {
  before_and_after_moving([&](const std::vector<WorldTriangle>& triangles) {
    std::size_t touched = 0;
    for (int i = 0; i < 150; ++i) {
      const Eigen::Vector3d center = point();
      const double radius = (i % 10) * 0.15;
      FaceSet expected, found;
      for (const WorldTriangle& candidate : triangles) {
        const Eigen::Vector3d closest = closest_point_on_triangle(center, candidate.triangle);
        if (squared_length(closest - center) <= radius * radius) {
          expected.insert({candidate.instance, candidate.face});
        }
      }
      const auto visit = overlap_sphere(scene_, center, radius, [&](const SceneFace& face) {
        return found.insert({face.instance, face.face.id}).second;
      });
      ASSERT_EQ(require(visit), Visit::kComplete);
      ASSERT_EQ(found, expected);
      touched += found.size();
      found.clear();
      const Sphere sphere{center, radius};
      ASSERT_TRUE(overlap_sphere(scene_, sphere, [&](const SceneFace& face) {
                    return found.insert({face.instance, face.face.id}).second;
                  }).ok());
      ASSERT_EQ(found, expected);
      ASSERT_EQ(*overlap_sphere(
                    scene_, sphere, [](const SceneFace&) { return false; }, 0),
                Visit::kComplete);
    }
    EXPECT_GT(touched, 500u);
  });
}

TEST_P(SceneQueries, ClosestPointEqualsBruteForce) {
  before_and_after_moving([&](const std::vector<WorldTriangle>& triangles) {
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d at = point(i % 2 == 0 ? 5 : 50);
      double best = std::numeric_limits<double>::infinity();
      std::tuple<std::uint32_t, std::uint32_t> first{};
      for (const WorldTriangle& candidate : triangles) {
        const double squared =
            squared_length(closest_point_on_triangle(at, candidate.triangle) - at);
        const std::tuple name{candidate.id, candidate.face};
        if (squared > best || (squared == best && name >= first)) continue;
        best = squared;
        first = name;
      }
      const auto found = require(closest_point(scene_, at));
      ASSERT_TRUE(found.has_value());
      ASSERT_EQ(found->distance, std::sqrt(best));  // to the last bit
      ASSERT_EQ(std::tuple(require(scene_.info(found->instance)).id, found->face.id), first);
      // Just within the radius it is found, just beyond it is not.
      const double distance = found->distance;
      ASSERT_TRUE(require(closest_point(scene_, at, distance * (1 + 1e-15))).has_value());
      ASSERT_FALSE(require(closest_point(scene_, at, distance * (1 - 1e-15))).has_value());
    }
  });
}

TEST_P(SceneQueries, ContactsEqualEveryPairOfTrees) {
  using Pair = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
  before_and_after_moving([&](const std::vector<WorldTriangle>& /*triangles*/) {
    const auto condition = [&](std::uint32_t instance) {
      const std::uint32_t tree = require(scene_.info(instance)).tree;
      return Placement::make(BoundTree::of(scene_.trees()[tree]), require(scene_.pose(instance)))
          ->condition();
    };
    std::set<Pair> expected;
    for (std::uint32_t a = 0; a < scene_.instance_count(); ++a) {
      for (std::uint32_t b = 0; b < scene_.instance_count(); ++b) {
        const InstanceInfo first = require(scene_.info(a)), second = require(scene_.info(b));
        if (!first.moves || a == b || (second.moves && b < a)) continue;
        const bool swap = condition(b) < condition(a);
        const Tree& x = scene_.trees()[first.tree];
        const Tree& y = scene_.trees()[second.tree];
        const Pose pose_x = require(scene_.pose(a)), pose_y = require(scene_.pose(b));
        const auto add = [&](std::uint32_t own, std::uint32_t other) {
          expected.insert({a, own, b, other});
          return true;
        };
        if (swap) {
          static_cast<void>(require(overlap_pairs(y, pose_y, x, pose_x, [&](const FacePair& pair) {
            return add(pair.second.id, pair.first.id);
          })));
        } else {
          static_cast<void>(require(overlap_pairs(x, pose_x, y, pose_y, [&](const FacePair& pair) {
            return add(pair.first.id, pair.second.id);
          })));
        }
      }
    }
    std::set<Pair> found;
    ASSERT_EQ(require(contacts(scene_,
                               [&](const ScenePair& pair) {
                                 return found
                                     .insert({pair.first.instance, pair.first.face.id,
                                              pair.second.instance, pair.second.face.id})
                                     .second;
                               })),
              Visit::kComplete);
    EXPECT_EQ(found, expected);
    EXPECT_GT(found.size(), 100u);

    // One instance at a time: the same pairs, those of two moving ones from both sides.
    std::set<Pair> of_each;
    for (const BoundScene::Moving& moving : BoundScene::of(scene_).moving()) {
      ASSERT_EQ(require(contacts_of(scene_, moving.instance,
                                    [&](const ScenePair& pair) {
                                      EXPECT_EQ(pair.first.instance, moving.instance);
                                      Pair name{pair.first.instance, pair.first.face.id,
                                                pair.second.instance, pair.second.face.id};
                                      const bool is_later =
                                          pair.second.instance < moving.instance &&
                                          require(scene_.info(pair.second.instance)).moves;
                                      if (!is_later) of_each.insert(name);
                                      return true;
                                    })),
                Visit::kComplete);
    }
    EXPECT_EQ(of_each, expected);
  });
}

TEST_P(SceneQueries, ABodyThatIsNoPartOfTheSceneMeetsIt) {
  using Pair = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
  const test::CookedTree body = test::cook_tree(test::torus(8, 8), GetParam());
  std::size_t pairs = 0;
  for (int i = 0; i < 20; ++i) {
    std::set<Pair> expected, found;
    const Pose pose = test::random_pose(random_, 4, i % 2 == 0);
    const auto placed = Placement::make(BoundTree::of(body.tree), pose);
    for (std::uint32_t other = 0; other < scene_.instance_count(); ++other) {
      const Tree& tree = scene_.trees()[require(scene_.info(other)).tree];
      const Pose at = require(scene_.pose(other));
      const bool swap = Placement::make(BoundTree::of(tree), at)->condition() < placed->condition();
      const auto add = [&](std::uint32_t of_scene, std::uint32_t of_body) {
        return expected.insert({other, of_scene, of_body}).second;
      };
      static_cast<void>(
          require(swap ? overlap_pairs(tree, at, body.tree, pose,
                                       [&](const FacePair& pair) {
                                         return add(pair.first.id, pair.second.id);
                                       })
                       : overlap_pairs(body.tree, pose, tree, at, [&](const FacePair& pair) {
                           return add(pair.second.id, pair.first.id);
                         })));
    }
    const auto visit = overlap_pairs(scene_, body.tree, pose, [&](const ScenePair& pair) {
      EXPECT_EQ(pair.second.instance, kNoInstance);
      return found.insert({pair.first.instance, pair.first.face.id, pair.second.face.id}).second;
    });
    ASSERT_EQ(require(visit), Visit::kComplete);
    EXPECT_EQ(found, expected);
    pairs += found.size();
  }
  EXPECT_GT(pairs, 100u);
}

INSTANTIATE_TEST_SUITE_P(Codecs, SceneQueries,
                         testing::Values(CodecId::kPlainF32, CodecId::kPackedF16, CodecId::kWide8,
                                         CodecId::kWide4),
                         test::test_name);

// What an instance answers is decided by its layer.
TEST(SceneLayers, AreFilteredAndAnswerTheirKindsAlone) {
  cooker::SceneParts parts = test::random_parts(30, 2, 3, 3, 4);
  parts.layers[1].queries = kRayQueries;
  parts.layers[2].collides_with = 0b011;
  parts.layers[0].collides_with = 0b111;
  parts.layers[1].collides_with = 0b101 | 0b010;
  const CookedScene cooked = test::cook_scene({test::sphere(6, 8), test::torus(6, 8)}, parts);
  const Scene scene = require(Scene::bind(cooked.file));
  std::mt19937_64 random(3);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-5, 5)(random); };
  std::set<std::uint32_t> hit_layers, box_layers;
  for (int i = 0; i < 300; ++i) {
    const Ray ray{{unit(), unit(), unit()}, {unit(), unit(), unit()}};
    if (const auto hit = require(closest_hit(scene, ray))) {
      hit_layers.insert(require(scene.info(hit->instance)).layer);
    }
    if (const auto hit = require(closest_hit(scene, ray, 0b100))) {
      EXPECT_EQ(require(scene.info(hit->instance)).layer, 2u);
    }
  }
  EXPECT_EQ(hit_layers, (std::set<std::uint32_t>{0, 1, 2}));
  static_cast<void>(
      require(overlap_box(scene, {Eigen::Vector3d::Constant(-9), Eigen::Vector3d::Constant(9)},
                          [&](const SceneFace& face) {
                            box_layers.insert(require(scene.info(face.instance)).layer);
                            return true;
                          })));
  EXPECT_EQ(box_layers, (std::set<std::uint32_t>{0, 2}));
  // Layer 2 does not collide with itself, and layer 1 answers rays alone.
  std::set<std::pair<std::uint32_t, std::uint32_t>> met;
  static_cast<void>(require(contacts(scene, [&](const ScenePair& pair) {
    met.insert(std::minmax(require(scene.info(pair.first.instance)).layer,
                           require(scene.info(pair.second.instance)).layer));
    return true;
  })));
  EXPECT_EQ(met, (std::set<std::pair<std::uint32_t, std::uint32_t>>{{0, 0}, {0, 2}}));
}

// Boxes that touch in a plane of the world, far from its origin and turned: touching counts.
TEST(SceneContacts, ThatOnlyTouchAreFound) {
  cooker::SourceMesh floor;
  floor.name = "floor";
  floor.positions.f32 = {-1, 0, -1, 1, 0, -1, 1, 0, 1, -1, 0, 1};
  floor.faces = {{{0, 1, 2, 3}}};
  for (const double far : {0.0, 1e3, 1e6, 1e9}) {
    cooker::SceneParts parts;
    for (std::uint32_t i = 0; i < 2; ++i) {
      cooker::PlacedTree placed;
      placed.id = i;
      placed.moves = i == 1;
      placed.pose.translation() = Eigen::Vector3d(far, far, far);
      parts.instances.push_back(placed);
    }
    const CookedScene cooked = test::cook_scene({floor}, parts);
    Scene scene = require(Scene::bind(cooked.file));
    for (int turn = 0; turn < 8; ++turn) {
      Pose pose = Pose::Identity();
      pose.linear() = Eigen::AngleAxisd(turn * 0.7, Eigen::Vector3d::UnitY()).toRotationMatrix();
      pose.translation() = Eigen::Vector3d(far, far, far);
      ASSERT_TRUE(scene.update(1, pose).ok());
      int pairs = 0;
      static_cast<void>(require(contacts(scene, [&](const ScenePair&) { return ++pairs > 0; })));
      EXPECT_EQ(pairs, 1) << far << " turned " << turn;
    }
  }
}

TEST(SceneQueriesErrors, InvalidQueriesAreRefused) {
  const CookedScene cooked =
      test::cook_scene({test::sphere(6, 8)}, test::random_parts(4, 1, 0, 1, 1));
  const Scene scene = require(Scene::bind(cooked.file));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto none = [](const SceneFace&) { return true; };
  const auto refused = [](const auto& result, const char* argument) {
    EXPECT_EQ(result.error().code, Errc::kInvalidQuery);
    EXPECT_EQ(result.error().detail, argument);
  };
  refused(closest_hit(scene, {{nan, 0, 0}, {1, 0, 0}}), "origin");
  refused(any_hit(scene, {{0, 0, 0}, {0, 0, 0}}), "direction");
  refused(overlap_box(scene, {Eigen::Vector3d(1, 1, 1), Eigen::Vector3d(0, 2, 2)}, none), "box");
  refused(overlap_sphere(scene, {0, 0, 0}, -1, none), "radius");
  refused(overlap_sphere(scene, {nan, 0, 0}, 1, none), "center");
  refused(closest_point(scene, {0, nan, 0}), "point");
  refused(closest_point(scene, {0, 0, 0}, nan), "max_distance");
  EXPECT_EQ(contacts_of(scene, 4, [](const ScenePair&) { return true; }).code(),
            Errc::kInstanceIndex);
}

}  // namespace
}  // namespace boxtree
