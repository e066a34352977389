// SPDX-License-Identifier: MIT
// The walks of wide8 and wide4, in every instruction set that this machine has, against plain-f32,
// whose scalar walk shares nothing with them but the leaf predicates: the same faces and the same
// numbers to the bit, over a million random and degenerate queries in all.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/unit/walk/targets.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

struct Cast {
  std::variant<Sphere, Capsule, OrientedBox> shape;
  Motion motion;
};

// Queries about one mesh. A part of each kind is degenerate on purpose: along axes, in planes of
// the root box, through vertices, from far away, of no size.
class QuerySet {
 public:
  QuerySet(const SourceMesh& mesh, const Tree& tree, std::uint64_t seed)
      : mesh_(mesh),
        box_(BoundTree::of(tree).to_object(BoundTree::of(tree).root().box)),
        random_(seed) {}

  // Answers of thousands of faces cost more than the queries do.
  [[nodiscard]] bool is_large() const { return mesh_.faces.size() > 10'000; }

  // Rays from so far away that rounding errors exceed the mesh are tested with all of its faces: of
  // a large one a few.
  std::vector<Ray> rays(int count) {
    std::vector<Ray> rays;
    for (int i = 0; i < count; ++i) {
      Ray ray{point(), point() - point()};
      if (i % 7 == 0) ray.direction = axis();
      if (i % 11 == 0) ray.direction = vertex() - ray.origin;
      if (i % 13 == 0) ray.origin = corner();
      if (i % 17 == 0) ray.origin -= 1e5 * ray.direction;
      if (i % 19 == 0) ray.direction *= std::ldexp(1.0, -300);
      if (i % 23 == 0) ray.t_max = unit();
      if (i % 29 == 0) ray.t_min = unit() * std::min(1.0, ray.t_max);
      if (i % 31 == 0) {
        ray.direction = axis();
        const int exponent = i % (is_large() && i / 31 % 8 != 3 ? 20 : 150);
        ray.origin = point() - std::ldexp(box_.diagonal().norm(), exponent) * ray.direction;
      }
      if (ray.direction.isZero(0)) ray.direction = {1, 0, 0};
      rays.push_back(ray);
    }
    return rays;
  }

  std::vector<Eigen::AlignedBox3d> boxes(int count) {
    std::vector<Eigen::AlignedBox3d> boxes;
    for (int i = 0; i < count; ++i) {
      const double size = std::pow(unit(), 4);
      const Eigen::Vector3d a = point();
      Eigen::Vector3d b = a + size * (point() - a);
      if (i % 7 == 0) b[i % 3] = a[i % 3];
      Eigen::AlignedBox3d box(a.cwiseMin(b), a.cwiseMax(b));
      if (i % 11 == 0) box = Eigen::AlignedBox3d(vertex());
      if (i % 13 == 0) box = Eigen::AlignedBox3d(box_.min(), box_.max());
      boxes.push_back(box);
    }
    return boxes;
  }

  std::vector<std::pair<Eigen::Vector3d, double>> spheres(int count) {
    std::vector<std::pair<Eigen::Vector3d, double>> spheres;
    const double size = box_.diagonal().norm();
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3d center = point();
      double radius = size * std::pow(unit(), 4);
      if (i % 7 == 0) center = vertex();
      if (i % 14 == 0) radius = 0;
      if (i % 11 == 0) {
        center += Eigen::Vector3d::Constant(1e4 * size);
        radius = 1.7320508 * 1e4 * size;
      }
      spheres.emplace_back(center, radius);
    }
    return spheres;
  }

  // Shapes of every size along such rays.
  std::vector<Cast> casts(int count) {
    std::vector<Cast> casts;
    const double size = box_.diagonal().norm();
    for (const Ray& ray : rays(count)) {
      const double radius = casts.size() % 7 == 0 ? 0 : 0.5 * size * std::pow(unit(), 4);
      const Motion motion{ray.direction, ray.t_max};
      const Eigen::Vector3d arm(unit() - 0.5, unit() - 0.5, unit() - 0.5);
      if (casts.size() % 3 == 0) {
        casts.push_back({Sphere{ray.origin, radius}, motion});
      } else if (casts.size() % 3 == 1) {
        casts.push_back({Capsule{ray.origin, ray.origin + 3 * radius * arm, radius}, motion});
      } else {
        OrientedBox box{ray.origin, 2 * radius * arm.cwiseAbs(), {1, 0, 0, 0}};
        if (casts.size() % 2 == 0) box.rotation = {unit() - 0.5, arm[0], arm[1], arm[2]};
        casts.push_back({box, motion});
      }
    }
    return casts;
  }

  Pose pose() {
    Pose pose = Pose::Identity();
    const double size = box_.diagonal().maxCoeff();
    pose.translate(size * 0.5 * Eigen::Vector3d(unit() - 0.5, unit() - 0.5, unit() - 0.5));
    pose.rotate(
        Eigen::Quaterniond(unit() - 0.5, unit() - 0.5, unit() - 0.5, unit() - 0.5).normalized());
    if (unit() < 0.3) pose.scale(Eigen::Vector3d(0.5 + unit(), -0.5 - unit(), 0.5 + unit()));
    return pose;
  }

 private:
  double unit() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  Eigen::Vector3d point() {
    Eigen::Vector3d p;
    for (Eigen::Index k = 0; k < 3; ++k) {
      p[k] = box_.min()[k] + (unit() * 1.4 - 0.2) * (box_.max()[k] - box_.min()[k]);
    }
    return p;
  }
  Eigen::Vector3d axis() {
    Eigen::Vector3d d = Eigen::Vector3d::Zero();
    d[static_cast<Eigen::Index>(3 * unit())] = unit() < 0.5 ? 1 : -1;
    return d;
  }
  Eigen::Vector3d corner() {
    return {unit() < 0.5 ? box_.min()[0] : box_.max()[0],
            unit() < 0.5 ? box_.min()[1] : box_.max()[1], point()[2]};
  }
  Eigen::Vector3d vertex() {
    return mesh_
        .positions[static_cast<std::size_t>(unit() * static_cast<double>(mesh_.positions.size()))];
  }

  const SourceMesh& mesh_;
  Eigen::AlignedBox3d box_;
  std::mt19937_64 random_;
};

// Sorted, each as often as it is visited.
using Faces = std::vector<std::uint32_t>;
using FacePairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

// All that a ray's answer says; without a hit the face is the last value.
using RayAnswer = std::tuple<double, std::uint32_t, std::uint32_t, double, double>;
RayAnswer query_ray(const Tree& tree, const Ray& ray) {
  const auto hit = closest_hit(tree, ray);
  const auto any = any_hit(tree, ray);
  EXPECT_TRUE(hit.ok() && any.ok());
  EXPECT_EQ(any.has_value(), hit.has_value());
  if (!hit.has_value()) return {0, kNoFaceId, 0, 0, 0};
  return {hit->t, hit->face.id, hit->triangle, hit->u, hit->v};
}

// The first touch, then all of them.
using Touch = std::tuple<double, std::uint32_t, std::uint32_t, double, double>;
std::vector<Touch> query_cast(const Tree& tree, const Cast& cast) {
  const auto touch_of = [](const CastHit& hit) {
    return Touch(hit.t_lower, hit.face.id, hit.triangle, hit.t, hit.point.sum() + hit.normal.sum());
  };
  std::vector<Touch> touches;
  std::visit(
      [&](const auto& shape) {
        const auto hit = cast_closest(tree, shape, cast.motion);
        const auto any = cast_any(tree, shape, cast.motion);
        EXPECT_TRUE(hit.ok() && any.ok());
        EXPECT_EQ(any.has_value(), hit.has_value());
        const auto keep = [&](const CastHit& each) {
          touches.push_back(touch_of(each));
          return cast.motion.t_max;
        };
        EXPECT_TRUE(cast_all(tree, shape, cast.motion, keep).ok());
        std::sort(touches.begin(), touches.end());
        EXPECT_EQ(hit.has_value(), !touches.empty());
        if (hit) {
          EXPECT_EQ(touch_of(*hit), touches.front());
          touches.insert(touches.begin(), touch_of(*hit));
        }
      },
      cast.shape);
  return touches;
}

using PointAnswer = std::tuple<double, std::uint32_t, double, double, double>;
PointAnswer query_point(const Tree& tree, const Eigen::Vector3d& point) {
  const auto closest = closest_point(tree, point);
  EXPECT_TRUE(closest.ok() && closest.has_value());
  const Eigen::Vector3d& at = closest->point;
  return {closest->distance, closest->face.id, at[0], at[1], at[2]};
}

Faces query_box(const Tree& tree, const Eigen::AlignedBox3d& box) {
  Faces faces;
  EXPECT_TRUE(overlap_box(tree, box, [&](const FaceRef& face) {
                faces.push_back(face.id);
                return true;
              }).ok());
  std::sort(faces.begin(), faces.end());
  return faces;
}

Faces query_sphere(const Tree& tree, const std::pair<Eigen::Vector3d, double>& sphere) {
  Faces faces;
  EXPECT_TRUE(overlap_sphere(tree, sphere.first, sphere.second, [&](const FaceRef& face) {
                faces.push_back(face.id);
                return true;
              }).ok());
  std::sort(faces.begin(), faces.end());
  return faces;
}

FacePairs query_pairs(const Tree& tree, const Pose& pose) {
  FacePairs pairs;
  EXPECT_TRUE(overlap_pairs(tree, Pose::Identity(), tree, pose, [&](const FacePair& pair) {
                pairs.emplace_back(pair.first.id, pair.second.id);
                return true;
              }).ok());
  std::sort(pairs.begin(), pairs.end());
  const auto first = first_contact(tree, Pose::Identity(), tree, pose);
  EXPECT_TRUE(first.ok());
  EXPECT_EQ(first.has_value(), !pairs.empty());
  if (first.has_value()) {
    EXPECT_TRUE(std::binary_search(pairs.begin(), pairs.end(),
                                   std::pair(first->first.id, first->second.id)));
  }
  return pairs;
}

// Runs all queries on all trees; answers[i] are plain-f32's.
template <class Query, class RunQuery>
void expect_same(const std::vector<Query>& queries, const Tree& plain,
                 const std::vector<const Tree*>& trees, RunQuery run_query) {
  using Answer = std::invoke_result_t<RunQuery, const Tree&, const Query&>;
  std::vector<Answer> answers;
  for (const Query& query : queries) answers.push_back(run_query(plain, query));
  for (const Tree* tree : trees) {
    for_each_target([&](const char* target) {
      for (std::size_t i = 0; i < queries.size(); ++i) {
        ASSERT_EQ(run_query(*tree, queries[i]), answers[i])
            << codec_name(BoundTree::of(*tree).codec()) << ", " << target << ", query " << i;
      }
    });
  }
}

// Applies change(coordinate, axis) to all positions.
template <class Change>
SourceMesh changed(SourceMesh mesh, const char* name, Change change) {
  mesh.name = name;
  for (std::size_t i = 0; i < mesh.positions.f32.size(); ++i) {
    mesh.positions.f32[i] = change(mesh.positions.f32[i], i % 3);
  }
  return mesh;
}

SourceMesh in_double(SourceMesh mesh, const char* name) {
  mesh.name = name;
  mesh.positions.precision = cooker::Precision::kF64;
  for (const float x : mesh.positions.f32) {
    mesh.positions.f64.push_back(std::sqrt(2.0) * double{x});
  }
  mesh.positions.f32.clear();
  return mesh;
}

// A torus that has a quad in place of every `period`-th pair of triangles.
SourceMesh with_quads(std::size_t period) {
  SourceMesh mesh = test::torus(30, 20);
  const std::vector<cooker::Face> triangles = std::exchange(mesh.faces, {});
  mesh.name = "every_quad_" + std::to_string(period);
  for (std::size_t i = 0; i + 1 < triangles.size(); i += 2) {
    const auto& first = triangles[i].corner;
    const auto& second = triangles[i + 1].corner;
    if (i / 2 % period == 0) {
      mesh.faces.push_back({{first[0], first[1], first[2], second[2]}});
    } else {
      mesh.faces.push_back(triangles[i]);
      mesh.faces.push_back(triangles[i + 1]);
    }
  }
  return mesh;
}

// Small meshes of every kind, one with more vertices than 16 bits can name, those with quads, a
// small one far from the origin, one in double precision.
std::vector<SourceMesh> make_meshes() {
  std::vector<SourceMesh> meshes = test::all_kinds();
  meshes.push_back(
      changed(test::torus(300, 220), "large_torus", [](float x, std::size_t) { return x; }));
  for (const std::size_t period : {1u, 3u, 50u}) meshes.push_back(with_quads(period));
  meshes.push_back(changed(test::sphere(40, 60), "far_away", [](float x, std::size_t axis) {
    return x * 1e-4f + (axis == 0 ? 1.0f : -2.0f);
  }));
  meshes.push_back(in_double(test::torus(30, 20), "in_double"));
  return meshes;
}
// Made once: the name of each test needs them.
const std::vector<SourceMesh>& meshes() {
  static const std::vector<SourceMesh> meshes = make_meshes();
  return meshes;
}

#if defined(BOXTREE_TEST_TARGETS) && defined(__x86_64__)
TEST(WideTargets, HoldPlainCodeAndEveryInstructionSetOfMachineAndBuild) {
  // Whether the build has an instruction set at all.
  const auto is_in = [](std::int64_t target) { return (BOXTREE_LEFT_OUT_TARGETS & target) == 0; };
  std::set<std::string> names;
  for_each_target([&](const char* name) { names.insert(name); });
  EXPECT_TRUE(names.contains("SCALAR") || names.contains("EMU128"));
  EXPECT_EQ(names.contains("SSE4"), is_in(HWY_SSE4) && __builtin_cpu_supports("sse4.2") != 0);
  EXPECT_EQ(names.contains("AVX2"), is_in(HWY_AVX2) && __builtin_cpu_supports("avx2") != 0);
  EXPECT_EQ(names.contains("AVX2 with leaves by AVX3_DL"),
            is_in(HWY_AVX2) && __builtin_cpu_supports("avx512vbmi2") != 0);
  EXPECT_EQ(names.contains("AVX3"), is_in(HWY_AVX3) && __builtin_cpu_supports("avx512dq") != 0);
}
#endif

// All kinds of queries on all three codecs of one mesh.
void expect_equal(const SourceMesh& mesh, const cooker::CookOptions& options, std::uint64_t seed) {
  SCOPED_TRACE(mesh.name);
  const test::CookedTree plain = test::cook_tree(mesh, CodecId::kPlainF32, options);
  const test::CookedTree wide8 = test::cook_tree(mesh, CodecId::kWide8, options);
  const test::CookedTree wide4 = test::cook_tree(mesh, CodecId::kWide4, options);
  const std::vector<const Tree*> trees = {&wide8.tree, &wide4.tree};
  QuerySet queries(mesh, plain.tree, seed);
  const bool is_large = queries.is_large();
  expect_same(queries.rays(is_large ? 1500 : 3000), plain.tree, trees, query_ray);
  expect_same(queries.casts(is_large ? 25 : 150), plain.tree, trees, query_cast);
  expect_same(queries.boxes(is_large ? 50 : 800), plain.tree, trees, query_box);
  const auto spheres = queries.spheres(is_large ? 50 : 800);
  expect_same(spheres, plain.tree, trees, query_sphere);
  std::vector<Eigen::Vector3d> points;
  for (const auto& sphere : spheres) points.push_back(sphere.first);
  expect_same(points, plain.tree, trees, query_point);
  std::vector<Pose> poses;
  for (int i = 0; i < (is_large ? 10 : 40); ++i) poses.push_back(queries.pose());
  expect_same(poses, plain.tree, trees, query_pairs);
}

class WideWalks : public testing::TestWithParam<std::size_t> {};

TEST_P(WideWalks, EqualTheScalarWalkOfPlainNodes) {
  expect_equal(meshes()[GetParam()], {}, GetParam());
}

TEST_P(WideWalks, EqualTheScalarWalkOfPlainNodesOnAGrid) {
  for (const int bits : {14, 30}) {  // exact in single precision, and not
    cooker::CookOptions options;
    options.geometry = GeometryId::kGrid;
    options.grid.bits = bits;
    expect_equal(meshes()[GetParam()], options, GetParam());
  }
}

TEST_P(WideWalks, EqualTheScalarWalkOfPlainNodesOfArrays) {
  cooker::CookOptions options;
  options.geometry = GeometryId::kArrays;
  expect_equal(meshes()[GetParam()], options, GetParam());
}

std::string mesh_name(const testing::TestParamInfo<std::size_t>& mesh) {
  return meshes()[mesh.param].name + "_" + std::to_string(mesh.param);
}

INSTANTIATE_TEST_SUITE_P(Meshes, WideWalks, testing::Range<std::size_t>(0, meshes().size()),
                         mesh_name);

}  // namespace
}  // namespace boxtree
