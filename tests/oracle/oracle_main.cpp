// SPDX-License-Identifier: MIT
// boxtree_oracle: pairs of triangles before CGAL's exact kernel, triangles and convex shapes before
// its exact quadratic programs, rays at edges and vertices of closed meshes, ours and the installed
// libraries' wrong answers side by side. Exits with 7 when one of ours is wrong.
#include <cmath>
#include <cstdio>
#include <exception>
#include <numeric>
#include <optional>
#include <random>

#include <fmt/format.h>

#include "tests/bench/libraries.h"
#include "tests/oracle/cgal_classifier.h"
#include "tests/oracle/cgal_distance.h"
#include "tests/oracle/pair_tester.h"
#include "tests/oracle/shape_tester.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/support/program_options.h"
#include "tests/unit/primitive/triangle_cases.h"

namespace boxtree::test {
namespace {

constexpr int kDifferenceFound = 7;  // as the command line of the cooker has it

// Pairs of one family in f32, about the size of 1, so that no library needs more digits than
// it takes or for another size than it is made for.
class FloatPairs {
 public:
  explicit FloatPairs(Family family) : family_(family), cases_(0xc6a1, kRange), random_(0xd17) {}

  TrianglePair next() {
    TrianglePair pair = cases_.pair(family_);
    const auto kind = random_() % 3;
    const double angle = std::ldexp(static_cast<double>(random_() >> 11), -52);
    const double sine = std::sin(angle), cosine = std::cos(angle);
    for (Triangle* triangle : {&pair.first, &pair.second}) {
      for (Eigen::Vector3d& c : triangle->corner) {
        // A third as they are; a third turned, which turns contact into contact to within an ulp;
        // a third moved by single ulps.
        if (kind == 1) {
          c = Eigen::Vector3d(cosine * c[0] - sine * c[1], sine * c[0] + cosine * c[1], c[2] / 3);
        }
        for (Eigen::Index k = 0; k < 3; ++k) {
          auto x = static_cast<float>(c[k] / kRange);
          if (kind == 2) x = nudged(x);
          c[k] = x;
        }
      }
    }
    return pair;
  }

 private:
  static constexpr std::int64_t kRange = 1 << 18;  // coordinates below 2^23: f32 holds them

  float nudged(float x) {
    const auto choice = random_() % 3;
    if (choice == 0 || x == 0) return x;
    return std::nextafter(x, choice == 1 ? -INFINITY : INFINITY);
  }

  Family family_;
  TriangleCases cases_;
  std::mt19937_64 random_;
};

std::vector<PairTester> all_testers() {
  std::vector<PairTester> testers;
  add_boxtree_testers(testers);
  add_cgal_testers(testers);
#ifdef BOXTREE_BENCH_FCL
  add_fcl_testers(testers);
#endif
#ifdef BOXTREE_BENCH_BULLET
  add_bullet_testers(testers);
#endif
#ifdef BOXTREE_BENCH_ODE
  add_ode_testers(testers);
#endif
  return testers;
}

bool is_ours(const std::string& library) {
  return library.starts_with("boxtree");
}

struct Wrong {
  std::uint64_t missed = 0;    // contacts
  std::uint64_t invented = 0;  // contacts
};

// Returns how many of ours were wrong.
std::uint64_t classify_pairs(std::size_t count) {
  std::vector<PairTester> testers = all_testers();
  std::vector<std::vector<Wrong>> wrong(testers.size(), std::vector<Wrong>(kFamilies.size()));
  std::vector<std::uint64_t> intersecting(kFamilies.size(), 0);
  for (std::size_t f = 0; f < kFamilies.size(); ++f) {
    FloatPairs pairs(kFamilies[f]);
    for (std::size_t i = 0; i < count; ++i) {
      const TrianglePair pair = pairs.next();
      const bool truth = cgal_triangles_intersect<ExactKernel>(pair.first, pair.second);
      intersecting[f] += truth ? 1u : 0u;
      for (std::size_t t = 0; t < testers.size(); ++t) {
        if (i % testers[t].every != 0) continue;
        const bool answer = testers[t].intersect(pair.first, pair.second);
        wrong[t][f].missed += truth && !answer ? 1u : 0u;
        wrong[t][f].invented += !truth && answer ? 1u : 0u;
      }
    }
  }
  fmt::print("Triangle pairs, {} a family: contacts missed / invented\n\n| library |", count);
  for (const Family family : kFamilies) fmt::print(" {} |", name_of(family));
  fmt::print("\n|---|");
  for (std::size_t f = 0; f < kFamilies.size(); ++f) fmt::print("---|");
  fmt::print("\n| pairs that intersect |");
  for (const std::uint64_t n : intersecting) fmt::print(" {} |", n);
  std::uint64_t ours = 0;
  for (std::size_t t = 0; t < testers.size(); ++t) {
    fmt::print("\n| {} {} |", testers[t].library, testers[t].variant);
    for (const Wrong& w : wrong[t]) {
      fmt::print(" {} / {} |", w.missed, w.invented);
      if (is_ours(testers[t].library)) ours += w.missed + w.invented;
    }
  }
  fmt::print("\n\n");
  return ours;
}

enum class Placing { kRandom, kGrid };

// Shapes about the size of the triangle: anywhere, or with whole coordinates up to 4, so that many
// touch with nothing to spare.
class Shapes {
 public:
  explicit Shapes(Placing placing) : placing_(placing), random_(0x5a9e) {}

  Triangle triangle() { return {{vector(1), vector(1), vector(1)}}; }
  TestedShape next(int kind) {
    TestedShape shape;
    shape.kind = kind;
    const Eigen::Vector3d at = vector(1);
    if (kind <= 1) shape.radius = placing_ == Placing::kGrid ? 1 : 0.5 * (1 + unit());
    if (kind <= 1) shape.points = {at};
    if (kind == 1) shape.points.push_back(vector(1));
    if (kind == 1 && shape.points[0] == at && shape.points[1] == at) shape.points[1][2] += 1;
    if (kind < 2) return shape;
    const Eigen::Vector3d size =
        placing_ == Placing::kGrid
            ? Eigen::Vector3d(vector(1).cwiseAbs() + Eigen::Vector3d::Ones())
            : Eigen::Vector3d(vector(0.25).cwiseAbs() + Eigen::Vector3d::Constant(0.25));
    // Of a hull, a box that is sheared: its corners stay in their planes.
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    if (kind == 3) shear(0, 1) = shear(1, 2) = 1;
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d corner((i & 1) != 0 ? size[0] : 0, (i & 2) != 0 ? size[1] : 0,
                                   (i & 4) != 0 ? size[2] : 0);
      shape.points.push_back(at + shear * corner);
    }
    return shape;
  }

 private:
  double unit() { return std::ldexp(static_cast<double>(random_() >> 40), -23) - 1; }
  Eigen::Vector3d vector(double size) {
    Eigen::Vector3d v(unit(), unit(), unit());
    if (placing_ == Placing::kGrid) return (4 * v).array().round();
    return 4 * size * v;
  }

  Placing placing_;
  std::mt19937_64 random_;
};

bool touches_exactly(const Triangle& triangle, const TestedShape& shape) {
  std::vector<oracle::ExactVector> points, corners;
  for (const Eigen::Vector3d& p : shape.points) points.push_back(oracle::exact(p));
  for (const Eigen::Vector3d& c : triangle.corner) corners.push_back(oracle::exact(c));
  const oracle::ExactNumber radius(shape.radius);
  return oracle::squared_distance(points, corners) <= oracle::ExactSquare(radius * radius);
}

// Returns how many of ours were wrong.
std::uint64_t classify_shapes(std::size_t count) {
  std::vector<ShapeTester> testers;
  add_boxtree_testers(testers);
#ifdef BOXTREE_BENCH_FCL
  add_fcl_testers(testers);
#endif
  std::vector<std::string> rows(testers.size() + 1);
  std::uint64_t ours = 0;
  for (const Placing placing : {Placing::kRandom, Placing::kGrid}) {
    for (int kind = 0; kind < 4; ++kind) {
      Shapes shapes(placing);
      std::vector<Wrong> wrong(testers.size());
      std::uint64_t touching = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const Triangle triangle = shapes.triangle();
        const TestedShape shape = shapes.next(kind);
        const bool truth = touches_exactly(triangle, shape);
        touching += truth ? 1u : 0u;
        for (std::size_t t = 0; t < testers.size(); ++t) {
          const bool answer = testers[t].touch(triangle, shape);
          wrong[t].missed += truth && !answer ? 1u : 0u;
          wrong[t].invented += !truth && answer ? 1u : 0u;
        }
      }
      rows[0] += fmt::format(" {} |", touching);
      for (std::size_t t = 0; t < testers.size(); ++t) {
        rows[t + 1] += fmt::format(" {} / {} |", wrong[t].missed, wrong[t].invented);
        if (is_ours(testers[t].library)) ours += wrong[t].missed + wrong[t].invented;
      }
    }
  }
  fmt::print("A triangle and a shape, {} a kind: contacts missed / invented\n\n| library |", count);
  for (const char* placing : {"random", "whole coordinates"}) {
    for (const char* name : kShapeNames) fmt::print(" {}, {} |", name, placing);
  }
  fmt::print("\n|---|---|---|---|---|---|---|---|---|\n| that touch |{}", rows[0]);
  for (std::size_t t = 0; t < testers.size(); ++t) {
    fmt::print("\n| {} {} |{}", testers[t].library, testers[t].variant, rows[t + 1]);
  }
  fmt::print("\n\n");
  return ours;
}

struct Closed {
  const char* name;
  cooker::SourceMesh mesh;
  bool is_torus;
};

std::vector<Closed> closed_meshes() {
  using robustness::icosphere_mesh;
  const Eigen::Vector3d away(1000, -2000, 500);
  return {{"icosphere 20480", icosphere_mesh(5), false},
          {"sphere 42840", test::sphere(120, 180), false},
          {"torus 40000", test::torus(200, 100), true},
          {"icosphere at 1000, -2000, 500", robustness::plus(icosphere_mesh(5), away), false},
          {"icosphere x 1e-6", robustness::times(icosphere_mesh(4), 1e-6), false}};
}

// From inside at vertices and at points of edges, by turns.
std::vector<Ray> rays_inside(const Closed& closed, std::size_t count) {
  std::mt19937_64 random(0x1ea4);
  const auto unit = [&] { return std::ldexp(static_cast<double>(random() >> 11), -53); };
  const Eigen::AlignedBox3d bounds = cooker::bounds_of(closed.mesh);
  const double size = bounds.diagonal().maxCoeff() / 2;
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d inside(unit() - 0.5, unit() - 0.5, unit() - 0.5);
    if (closed.is_torus) {  // radii 1 and 0.4 of 1.4
      const double angle = 7 * unit();
      inside = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.2 * (unit() - 0.5)) / 1.4;
    }
    const auto face = static_cast<std::size_t>(random() % closed.mesh.faces.size());
    const auto& corner = robustness::source_triangle(closed.mesh, face, 0).corner;
    const double along = i % 2 == 0 ? 0 : unit();
    const Eigen::Vector3d target = corner[i % 3] + along * (corner[(i + 1) % 3] - corner[i % 3]);
    const Eigen::Vector3d origin = bounds.center() + size * inside;
    rays.push_back({origin, target - origin});
  }
  return rays;
}

std::uint64_t count_leaks(std::size_t count) {
  const std::vector<Closed> meshes = closed_meshes();
  const std::vector<bench::Library> libraries = bench::all_libraries(cooker::Builder::kSah);
  fmt::print("Rays at edges and vertices from inside, {} a mesh: leaks\n\n| library |", count);
  for (const Closed& closed : meshes) fmt::print(" {} |", closed.name);
  fmt::print("\n|---|");
  for (std::size_t m = 0; m < meshes.size(); ++m) fmt::print("---|");
  std::uint64_t ours = 0;
  std::vector<bench::TriangleMesh> triangles;
  std::vector<std::vector<Ray>> rays;
  for (const Closed& closed : meshes) {
    triangles.push_back(bench::make_triangle_mesh(closed.mesh, closed.name, 0));
    rays.push_back(rays_inside(closed, count));
  }
  std::vector<double> answers(count);
  for (const bench::Library& library : libraries) {
    std::string row;
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      const auto subject = library.build(triangles[m]);
      if (!subject->rays(rays[m], answers)) break;
      const auto leaks = static_cast<std::uint64_t>(std::count_if(
          answers.begin(), answers.end(), [](double t) { return !std::isfinite(t); }));
      row += fmt::format(" {} |", leaks);
      if (is_ours(library.name)) ours += leaks;
    }
    if (!row.empty()) fmt::print("\n| {} {} |{}", library.name, library.variant, row);
    std::fflush(stdout);
  }
  fmt::print("\n\n");
  return ours;
}

}  // namespace
}  // namespace boxtree::test

int main(int argc, char** argv) {
  std::size_t pairs = 20'000, rays = 20'000, shapes = 1'000;
  boxtree::test::ProgramOptions program("Ours and other libraries before exact arithmetic.");
  program.add("--pairs", pairs, "triangle pairs of each family [20000]");
  program.add("--rays", rays, "rays at each closed mesh [20000]");
  program.add("--shapes", shapes, "shapes of each kind [1000]");
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  try {
    const std::uint64_t wrong = (pairs > 0 ? boxtree::test::classify_pairs(pairs) : 0) +
                                (shapes > 0 ? boxtree::test::classify_shapes(shapes) : 0) +
                                (rays > 0 ? boxtree::test::count_leaks(rays) : 0);
    for (const std::string& library : boxtree::bench::missing_libraries()) {
      fmt::print("{} is not installed\n", library);
    }
    fmt::print("ours: {} wrong\n", wrong);
    return wrong == 0 ? 0 : boxtree::test::kDifferenceFound;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 4;
  }
}
