// SPDX-License-Identifier: MIT
// Every query on every codec against brute force over the source mesh, by the leaf predicates
// alone.
#include <algorithm>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include <boxtree/cooker/cook.h>
#include <boxtree/runtime/boxtree.h>
#include <boxtree/runtime/primitive/predicates.h>

#include "tests/support/meshes.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

std::vector<std::byte> cook_bytes(const SourceMesh& mesh, CodecId codec,
                                  cooker::Builder builder = cooker::Builder::kSah) {
  cooker::CookOptions options;
  options.codec = codec;
  options.builder = builder;
  Result<cooker::CookedTree> cooked = cooker::cook_mesh(mesh, options);
  EXPECT_TRUE(cooked.ok());
  return cooker::serialize(std::span(&cooked->tree, 1));
}

// Triangles of a face, in object space.
std::vector<Triangle> triangles_of(const SourceMesh& mesh, std::size_t face) {
  const cooker::Face& f = mesh.faces[face];
  const auto at = [&](std::size_t i) { return mesh.positions[f.corner[i]]; };
  std::vector<Triangle> result{{{at(0), at(1), at(2)}}};
  if (f.is_quad()) result.push_back({{at(0), at(2), at(3)}});
  return result;
}

class Queries : public testing::TestWithParam<CodecId> {
 protected:
  // Calls body(mesh, tree) for every kind of mesh and both builders.
  template <class Body>
  void for_each_mesh(Body body) {
    for (const SourceMesh& mesh : test::all_kinds()) {
      for (const auto builder : {cooker::Builder::kSah, cooker::Builder::kPaper}) {
        SCOPED_TRACE(mesh.name);
        const std::vector<std::byte> bytes = cook_bytes(mesh, GetParam(), builder);
        const Result<File> file = File::open(bytes);
        ASSERT_TRUE(file.ok()) << file.error().message();
        const Result<Tree> tree = Tree::bind(*file);
        ASSERT_TRUE(tree.ok()) << tree.error().message();
        body(mesh, *tree);
      }
    }
  }

  Eigen::Vector3d point_near(const Tree& tree) {
    const Eigen::AlignedBox3d box = tree.to_object(tree.root().box);
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
    for (int i = 0; i < 300; ++i) {
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
      ASSERT_EQ((*hit).has_value(), best < std::numeric_limits<double>::infinity());
      const auto any = any_hit(tree, ray);
      ASSERT_EQ((*any).has_value(), (*hit).has_value());
      if (!*hit) continue;
      ++hits;
      // The library clamps t to the triangle's own slab: equal up to the rounding of the shear.
      ASSERT_NEAR((*hit)->t, best, 1e-12 * (1 + best));
      ASSERT_LT((*hit)->face.id, mesh.faces.size());
    }
    if (mesh.faces.size() > 100 && mesh.name != "slivers" && mesh.name != "huge_among_tiny") {
      EXPECT_GT(hits, 20u);
    }
  });
}

TEST_P(Queries, BoxEqualsBruteForce) {
  for_each_mesh([&](const SourceMesh& mesh, const Tree& tree) {
    for (int i = 0; i < 100; ++i) {
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
    for (int i = 0; i < 100; ++i) {
      const Eigen::Vector3d p = point_near(tree);
      std::vector<double> distance(mesh.faces.size(), std::numeric_limits<double>::infinity());
      for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
        for (const Triangle& triangle : triangles_of(mesh, f)) {
          distance[f] = std::min(distance[f], (closest_point_on_triangle(p, triangle) - p).norm());
        }
      }
      const double best = *std::min_element(distance.begin(), distance.end());
      const auto closest = closest_point(tree, p);
      ASSERT_TRUE(closest.ok() && (*closest).has_value());
      ASSERT_NEAR((*closest)->distance, best, 1e-9 * (1 + best));
      ASSERT_NEAR(((*closest)->point - p).norm(), best, 1e-9 * (1 + best));
      ASSERT_FALSE((*closest_point(tree, p, best * 0.999)).has_value() && best > 0);

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
    }
  });
}

Pose random_pose(std::mt19937_64& random, double reach) {
  std::uniform_real_distribution<double> unit(-1, 1);
  Pose pose = Pose::Identity();
  pose.linear() = Eigen::Quaterniond(unit(random), unit(random), unit(random), unit(random))
                      .normalized()
                      .toRotationMatrix();
  pose.translation() = reach * Eigen::Vector3d(unit(random), unit(random), unit(random));
  return pose;
}

TEST_P(Queries, PairsEqualBruteForce) {
  std::vector<SourceMesh> meshes{test::sphere(8, 12), test::city(9, 2), test::soup(120, 3),
                                 test::duplicates(10)};
  for (const SourceMesh& a : meshes) {
    for (const SourceMesh& b : meshes) {
      SCOPED_TRACE(a.name + " against " + b.name);
      const auto bytes_a = cook_bytes(a, GetParam());
      const auto bytes_b = cook_bytes(b, CodecId::kPlainF16);
      const Result<File> file_a = File::open(bytes_a);
      const Result<File> file_b = File::open(bytes_b);
      const Result<Tree> tree_a = Tree::bind(*file_a);
      const Result<Tree> tree_b = Tree::bind(*file_b);
      for (int i = 0; i < 12; ++i) {
        // Every third pose moves by whole units without turning: aligned, touching contact.
        Pose pose = random_pose(random_, 2);
        if (i % 3 == 0) {
          pose = Pose::Identity();
          pose.translation() = Eigen::Vector3d(i % 2, i % 4 - 1, 0);
        }
        std::multiset<std::pair<std::uint32_t, std::uint32_t>> found;
        ASSERT_TRUE(
            overlap_pairs(*tree_a, Pose::Identity(), *tree_b, pose, [&](const FacePair& pair) {
              found.insert({pair.first.id, pair.second.id});
              return true;
            }).ok());
        std::multiset<std::pair<std::uint32_t, std::uint32_t>> expected;
        for (std::uint32_t f = 0; f < a.faces.size(); ++f) {
          for (std::uint32_t g = 0; g < b.faces.size(); ++g) {
            bool touch = false;
            for (const Triangle& s : triangles_of(a, f)) {
              for (Triangle t : triangles_of(b, g)) {
                for (Eigen::Vector3d& corner : t.corner) corner = pose * corner;
                touch |= triangles_intersect(s, t);
              }
            }
            if (touch) expected.insert({f, g});
          }
        }
        ASSERT_EQ(found, expected);
        const auto contact = first_contact(*tree_a, Pose::Identity(), *tree_b, pose);
        ASSERT_EQ((*contact).has_value(), !expected.empty());
      }
    }
  }
}

TEST_P(Queries, InvalidQuestionsAreRefused) {
  const auto bytes = cook_bytes(test::sphere(6, 8), GetParam());
  const Result<File> file = File::open(bytes);
  const Result<Tree> tree = Tree::bind(*file);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  EXPECT_EQ(closest_hit(*tree, {zero, zero}).code(), Errc::kInvalidQuery);
  EXPECT_EQ(closest_hit(*tree, {{nan, 0, 0}, {1, 0, 0}}).code(), Errc::kInvalidQuery);
  EXPECT_EQ(closest_hit(*tree, {zero, {1, 0, 0}, 2, 1}).code(), Errc::kInvalidQuery);
  EXPECT_EQ(closest_point(*tree, {nan, 0, 0}).code(), Errc::kInvalidQuery);
  EXPECT_EQ(overlap_sphere(*tree, zero, -1, [](const FaceRef&) { return true; }).code(),
            Errc::kInvalidQuery);
  Pose flat = Pose::Identity();
  flat.linear().setZero();
  EXPECT_EQ(first_contact(*tree, flat, *tree, Pose::Identity()).code(), Errc::kInvalidPose);
}

INSTANTIATE_TEST_SUITE_P(Codecs, Queries, testing::Values(CodecId::kPlainF32, CodecId::kPlainF16),
                         [](const auto& info) {
                           return info.param == CodecId::kPlainF32 ? "PlainF32" : "PlainF16";
                         });

}  // namespace
}  // namespace boxtree
