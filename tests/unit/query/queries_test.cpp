// SPDX-License-Identifier: MIT
// Every query on every codec against brute force over the source mesh, by the leaf predicates
// alone.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

// Triangles of a face, in object space.
std::vector<Triangle> triangles_of(const SourceMesh& mesh, std::size_t face) {
  const cooker::Face& f = mesh.faces[face];
  const auto at = [&](std::size_t i) { return mesh.positions[f.corner[i]]; };
  std::vector<Triangle> result{{{at(0), at(1), at(2)}}};
  if (f.is_quad()) result.push_back({{at(0), at(2), at(3)}});
  return result;
}

// Of each kind of query, for each of some ten meshes, two builders and every codec.
constexpr int kRays = 400;
constexpr int kPoints = 200;

class Queries : public testing::TestWithParam<CodecId> {
 protected:
  // Calls body(mesh, tree) for every kind of mesh, both builders and both stores. With a grid, the
  // mesh is the one on the grid: rounded here, not decoded.
  template <class Body>
  void for_each_mesh(Body body) {
    for (const SourceMesh& mesh : test::all_kinds()) {
      for (const auto builder : {cooker::Builder::kSah, cooker::Builder::kPaper}) {
        SCOPED_TRACE(mesh.name);
        cooker::CookOptions options;
        options.builder = builder;
        const test::CookedTree cooked = test::cook_tree(mesh, GetParam(), options);
        body(mesh, cooked.tree);
      }
      SCOPED_TRACE(mesh.name + " on a grid");
      cooker::CookOptions options;
      options.geometry = GeometryId::kGrid;
      options.grid.bits = 12;
      const test::CookedTree cooked = test::cook_tree(mesh, GetParam(), options);
      body(rounded(mesh, BoundTree::of(cooked.tree).grid_exponent()), cooked.tree);
    }
  }

  static SourceMesh rounded(SourceMesh mesh, int step_exponent) {
    for (float& x : mesh.positions.f32) {
      x = std::ldexp(std::floor(std::ldexp(x, -step_exponent) + 0.5f), step_exponent);
    }
    return mesh;
  }

  Eigen::Vector3d point_near(const Tree& tree) {
    const Eigen::AlignedBox3d box = BoundTree::of(tree).to_object(BoundTree::of(tree).root().box);
    Eigen::Vector3d p;
    for (Eigen::Index k = 0; k < 3; ++k) {
      p[k] = box.min()[k] + (unit() * 1.4 - 0.2) * (box.max()[k] - box.min()[k]);
    }
    return p;
  }
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }

  std::mt19937_64 random_{7};
};

TEST_P(Queries, ClosestHitEqualsBruteForce) {
  for_each_mesh([&](const SourceMesh& mesh, const Tree& tree) {
    std::size_t hits = 0;
    for (int i = 0; i < kRays; ++i) {
      const Ray ray{point_near(tree), point_near(tree) - point_near(tree)};
      const RayShear shear(ray.origin, ray.direction);
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (const Triangle& triangle : triangles_of(mesh, f)) {
          const auto hit = intersect_ray_triangle(shear, triangle);
          if (hit && hit->t >= 0) best = std::min(best, hit->t);
        }
      }
      const auto hit = closest_hit(tree, ray);
      ASSERT_TRUE(hit.ok());
      ASSERT_EQ(hit.has_value(), best < std::numeric_limits<double>::infinity());
      const auto any = any_hit(tree, ray);
      ASSERT_EQ(any.has_value(), hit.has_value());
      if (!hit.has_value()) continue;
      ++hits;
      // The library clamps t to the triangle's own slab: equal up to the rounding of the shear.
      ASSERT_NEAR(hit->t, best, 1e-12 * (1 + best));
      ASSERT_LT(hit->face.id, mesh.faces.size());
    }
    if (mesh.faces.size() > 100 && mesh.name != "slivers" && mesh.name != "huge_among_tiny") {
      EXPECT_GT(hits, 20u);
    }
  });
}

TEST_P(Queries, BoxEqualsBruteForce) {
  for_each_mesh([&](const SourceMesh& mesh, const Tree& tree) {
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector3d a = point_near(tree);
      const Eigen::Vector3d b = a + (point_near(tree) - a) * 0.3;
      const Eigen::Vector3d low = a.cwiseMin(b);
      const Eigen::Vector3d high = a.cwiseMax(b);
      std::multiset<std::uint32_t> expected;
      for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
        const auto triangles = triangles_of(mesh, f);
        if (std::any_of(triangles.begin(), triangles.end(),
                        [&](const Triangle& t) { return triangle_intersects_box(t, low, high); })) {
          expected.insert(f);
        }
      }
      std::multiset<std::uint32_t> found;
      ASSERT_TRUE(overlap_box(tree, {low, high}, [&](const FaceRef& face) {
                    found.insert(face.id);
                    return true;
                  }).ok());
      ASSERT_EQ(found, expected);
    }
  });
}

TEST_P(Queries, SphereAndClosestPointEqualBruteForce) {
  for_each_mesh([&](const SourceMesh& mesh, const Tree& tree) {
    for (int i = 0; i < kPoints; ++i) {
      const Eigen::Vector3d p = point_near(tree);
      std::vector<double> distance(mesh.faces.size(), std::numeric_limits<double>::infinity());
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (const Triangle& triangle : triangles_of(mesh, f)) {
          distance[f] = std::min(distance[f], (closest_point_on_triangle(p, triangle) - p).norm());
        }
      }
      const double best = *std::min_element(distance.begin(), distance.end());
      const auto closest = closest_point(tree, p);
      ASSERT_TRUE(closest.ok() && closest.has_value());
      ASSERT_NEAR(closest->distance, best, 1e-9 * (1 + best));
      ASSERT_NEAR((closest->point - p).norm(), best, 1e-9 * (1 + best));
      ASSERT_FALSE(closest_point(tree, p, best * 0.999).has_value() && best > 0);

      const double radius = best * 1.5;
      std::multiset<std::uint32_t> expected;
      for (std::uint32_t f = 0; f < distance.size(); ++f) {
        if (distance[f] <= radius) expected.insert(f);
      }
      std::multiset<std::uint32_t> found;
      ASSERT_TRUE(overlap_sphere(tree, p, radius, [&](const FaceRef& face) {
                    found.insert(face.id);
                    return true;
                  }).ok());
      ASSERT_EQ(found, expected);
      found.clear();
      ASSERT_TRUE(overlap_sphere(tree, Sphere{p, radius}, [&](const FaceRef& face) {
                    found.insert(face.id);
                    return true;
                  }).ok());
      ASSERT_EQ(found, expected);
    }
  });
}

using FacePairs = std::multiset<std::pair<std::uint32_t, std::uint32_t>>;

// Every pair of faces by the leaf predicate, in the first mesh's space.
FacePairs touching_pairs(const SourceMesh& a, const SourceMesh& b, const Pose& pose) {
  FacePairs pairs;
  for (std::uint32_t f = 0; f < a.faces.size(); ++f) {
    for (std::uint32_t g = 0; g < b.faces.size(); ++g) {
      bool touch = false;
      for (const Triangle& s : triangles_of(a, f)) {
        for (Triangle t : triangles_of(b, g)) {
          for (Eigen::Vector3d& corner : t.corner) corner = pose * corner;
          touch |= triangles_intersect(s, t);
        }
      }
      if (touch) pairs.insert({f, g});
    }
  }
  return pairs;
}

FacePairs found_pairs(const Tree& a, const Pose& pose_a, const Tree& b, const Pose& pose_b) {
  FacePairs pairs;
  EXPECT_TRUE(overlap_pairs(a, pose_a, b, pose_b, [&](const FacePair& pair) {
                pairs.insert({pair.first.id, pair.second.id});
                return true;
              }).ok());
  return pairs;
}

// The poses that users have, by turns: a shift by whole units (aligned, touching contact), a
// rotation, a scale, a mirror, a shear.
Pose random_pose(std::mt19937_64& random, int turn) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Pose pose = Pose::Identity();
  if (turn % 5 == 0) {
    pose.translation() = Eigen::Vector3d(turn % 2, turn % 4 - 1, 0);
    return pose;
  }
  pose.linear() = Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random))
                      .normalized()
                      .toRotationMatrix();
  if (turn % 5 == 2) pose.scale(Eigen::Vector3d(0.5, 2, 1.25));
  if (turn % 5 == 3) pose.scale(Eigen::Vector3d(-1, 1, 1));
  if (turn % 5 == 4) {
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    shear(0, 1) = 0.5;
    shear(1, 2) = -0.75;
    pose.linear() *= shear;
  }
  pose.translation() = 2 * Eigen::Vector3d(unit(random), unit(random), unit(random));
  return pose;
}

TEST_P(Queries, PairsEqualBruteForce) {
  const std::vector<SourceMesh> meshes{test::sphere(8, 12), test::city(9, 2), test::soup(120, 3),
                                       test::duplicates(10)};
  for (const SourceMesh& a : meshes) {
    for (const SourceMesh& b : meshes) {
      SCOPED_TRACE(a.name + " against " + b.name);
      const test::CookedTree tree_a = test::cook_tree(a, GetParam());
      const test::CookedTree tree_b = test::cook_tree(b, CodecId::kPlainF16);
      for (int i = 0; i < 15; ++i) {
        const Pose pose = random_pose(random_, i);
        const FacePairs expected = touching_pairs(a, b, pose);
        ASSERT_EQ(found_pairs(tree_a.tree, Pose::Identity(), tree_b.tree, pose), expected);
        const auto contact = first_contact(tree_a.tree, Pose::Identity(), tree_b.tree, pose);
        ASSERT_EQ(contact.has_value(), !expected.empty());
      }
    }
  }
}

// Both trees placed: only their relation counts, also a thousand kilometres away.
TEST_P(Queries, PairsDependOnTheRelativePoseAlone) {
  const SourceMesh mesh = test::sphere(8, 12);
  const test::CookedTree a = test::cook_tree(mesh, GetParam());
  const test::CookedTree b = test::cook_tree(mesh, GetParam());
  Pose away = Pose::Identity();
  away.translation() = Eigen::Vector3d(0x1p20, -0x1p20, 0x1p19);  // exact: a shift adds no rounding
  for (int i = 0; i < 20; ++i) {
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(0.125 * i, 0.0625 * (i % 5), 0);
    Pose there = pose;
    there.translation() += away.translation();
    ASSERT_EQ(found_pairs(a.tree, away, b.tree, there),
              found_pairs(a.tree, Pose::Identity(), b.tree, pose));
    ASSERT_EQ(found_pairs(a.tree, Pose::Identity(), b.tree, pose),
              touching_pairs(mesh, mesh, pose));
  }
}

SourceMesh scaled(SourceMesh mesh, double scale) {
  for (float& x : mesh.positions.f32) x = static_cast<float>(x * scale);
  return mesh;
}

// A power of two rounds nothing: the same faces, and every length scaled to the bit.
TEST_P(Queries, ScalingByAPowerOfTwoScalesTheAnswers) {
  const SourceMesh mesh = test::torus(40, 30);
  const test::CookedTree unit_size = test::cook_tree(mesh, GetParam());
  for (const int exponent : {-60, -13, 7, 13, 60}) {
    const double scale = std::ldexp(1.0, exponent);
    const test::CookedTree other = test::cook_tree(scaled(mesh, scale), GetParam());
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d from = point_near(unit_size.tree);
      const Eigen::Vector3d direction = point_near(unit_size.tree) - from;
      const auto hit = closest_hit(unit_size.tree, {from, direction});
      const auto other_hit = closest_hit(other.tree, {scale * from, scale * direction});
      ASSERT_EQ(hit.has_value(), other_hit.has_value());
      if (hit.has_value()) {
        ASSERT_EQ(hit->face.id, other_hit->face.id);
        ASSERT_EQ(hit->t, other_hit->t);
      }
      const auto closest = closest_point(unit_size.tree, from);
      const auto other_closest = closest_point(other.tree, scale * from);
      ASSERT_EQ(closest->face.id, other_closest->face.id);
      ASSERT_EQ(scale * closest->distance, other_closest->distance);
    }
  }
}

// Any other factor moves vertices by a rounding; answers are those of the moved mesh.
TEST_P(Queries, ScaledMeshesEqualBruteForce) {
  for (const double scale : {1e-4, 1.0, 100.0, 1e4}) {
    SCOPED_TRACE(scale);
    const SourceMesh mesh = scaled(test::torus(12, 9), scale);
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    for (int turn = 0; turn < 10; ++turn) {
      Pose pose = random_pose(random_, turn);
      pose.translation() *= scale;
      ASSERT_EQ(found_pairs(cooked.tree, Pose::Identity(), cooked.tree, pose),
                touching_pairs(mesh, mesh, pose));
    }
    for (int i = 0; i < 100; ++i) {
      const Ray ray{point_near(cooked.tree), point_near(cooked.tree) - point_near(cooked.tree)};
      const RayShear shear(ray.origin, ray.direction);
      double best = std::numeric_limits<double>::infinity();
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (const Triangle& triangle : triangles_of(mesh, f)) {
          const auto hit = intersect_ray_triangle(shear, triangle);
          if (hit && hit->t >= 0) best = std::min(best, hit->t);
        }
      }
      const auto hit = closest_hit(cooked.tree, ray);
      ASSERT_EQ(hit.has_value(), best < std::numeric_limits<double>::infinity());
      if (hit.has_value()) {
        ASSERT_NEAR(hit->t, best, 1e-12 * (1 + best));
      }
    }
  }
}

// A visitor that stops is not called again.
TEST_P(Queries, VisitorsCanStop) {
  const test::CookedTree cooked = test::cook_tree(test::city(9, 2), GetParam());
  for (int limit = 1; limit < 4; ++limit) {
    int pairs = 0;
    const auto stop = [&](const auto&) { return ++pairs < limit; };
    const auto visit =
        overlap_pairs(cooked.tree, Pose::Identity(), cooked.tree, Pose::Identity(), stop);
    ASSERT_EQ(*visit, Visit::kStopped);
    ASSERT_EQ(pairs, limit);
    pairs = 0;
    ASSERT_EQ(*overlap_sphere(cooked.tree, {0, 0, 0}, 1e3, stop), Visit::kStopped);
    ASSERT_EQ(pairs, limit);
  }
}

// A tree of one leaf has no nodes of its codec to be walked with.
TEST_P(Queries, TreesOfOneLeafMeetAllOthers) {
  const SourceMesh one = test::duplicates(1);
  const SourceMesh many = test::city(9, 2);
  const test::CookedTree leaf = test::cook_tree(one, GetParam());
  const test::CookedTree nodes = test::cook_tree(many, GetParam());
  const test::CookedTree none = test::cook_tree(SourceMesh(), GetParam());
  const Pose here = Pose::Identity();
  ASSERT_FALSE(touching_pairs(many, one, here).empty());
  EXPECT_EQ(found_pairs(leaf.tree, here, nodes.tree, here), touching_pairs(one, many, here));
  EXPECT_EQ(found_pairs(nodes.tree, here, leaf.tree, here), touching_pairs(many, one, here));
  EXPECT_TRUE(found_pairs(none.tree, here, nodes.tree, here).empty());
  EXPECT_TRUE(found_pairs(nodes.tree, here, none.tree, here).empty());
}

// The box of such a tree is f64 when its positions are, and walks that take f32 must not lose it.
TEST_P(Queries, OneFaceInDoubleIsFoundAtItsCorners) {
  for (const double divisor : {3.0, 5.0, 7.0, 11.0, 13.0}) {
    SourceMesh mesh = test::duplicates(1);
    mesh.positions.precision = cooker::Precision::kF64;
    for (std::size_t i = 0; i < mesh.positions.f32.size(); ++i) {
      const double factor = std::sqrt(divisor + static_cast<double>(i % 3));
      mesh.positions.f64.push_back(double{mesh.positions.f32[i]} * factor);
    }
    mesh.positions.f32.clear();
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d corner = mesh.positions[i];
      int found = 0;
      const auto count = [&](const FaceRef&) { return ++found > 0; };
      ASSERT_TRUE(overlap_box(cooked.tree, Eigen::AlignedBox3d(corner), count).ok());
      EXPECT_EQ(found, 1) << "corner " << i << ", divisor " << divisor;
    }
  }
}

TEST_P(Queries, InvalidQueriesAreRefused) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(6, 8), GetParam());
  const Tree* tree = &cooked.tree;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  const auto refused = [](const auto& result, const char* argument) {
    EXPECT_EQ(result.error().code, Errc::kInvalidQuery);
    EXPECT_EQ(result.error().detail, argument);
  };
  const auto all = [](const FaceRef&) { return true; };
  refused(closest_hit(*tree, {zero, zero}), "direction");
  refused(any_hit(*tree, {zero, {nan, 0, 0}}), "direction");
  refused(closest_hit(*tree, {{nan, 0, 0}, {1, 0, 0}}), "origin");
  refused(closest_hit(*tree, {zero, {1, 0, 0}, 2, 1}), "t_max");
  refused(closest_hit(*tree, {zero, {1, 0, 0}, -1, 1}), "t_min");
  refused(closest_point(*tree, {nan, 0, 0}), "point");
  refused(closest_point(*tree, zero, nan), "max_distance");
  refused(overlap_box(*tree, Eigen::AlignedBox3d(), all), "box");
  refused(overlap_sphere(*tree, zero, -1, all), "radius");
  refused(overlap_sphere(*tree, {0, 0, nan}, 1, all), "center");
  Pose flat = Pose::Identity();
  flat.linear().setZero();
  EXPECT_EQ(first_contact(*tree, flat, *tree, Pose::Identity()).code(), Errc::kInvalidPose);
}

INSTANTIATE_TEST_SUITE_P(Codecs, Queries, testing::ValuesIn(test::all_codecs()), test::test_name);

}  // namespace
}  // namespace boxtree
