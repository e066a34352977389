// SPDX-License-Identifier: MIT
// Rays for which slab tests divide by zero and triangle tests leave gaps; invalid queries.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "format/codec_packed.h"
#include "runtime/tree/bound_tree.h"
#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/support/infinity.h"
#include "tests/support/require.h"

namespace boxtree::robustness {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::ptrdiff_t kPackedHeader = sizeof(PackedHeader);
using test::kInfinity;

// Multiples of one half, the lattice of a city: every other one is in planes of its boxes. The sign
// of a zero is random.
class Lattice {
 public:
  explicit Lattice(std::uint64_t seed) : random_(seed) {}

  double coordinate() { return 0.5 * static_cast<double>(integer(-4, 20)); }
  Eigen::Vector3d point() { return {coordinate(), coordinate(), coordinate()}; }
  double zero() { return integer(0, 1) == 0 ? 0.0 : -0.0; }
  int integer(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }

 private:
  std::mt19937_64 random_;
};

// Along an axis or in a plane of two, the other components +0 or -0.
Ray lattice_ray(Lattice& lattice, bool along_axis) {
  Ray ray{lattice.point(), {lattice.zero(), lattice.zero(), lattice.zero()}};
  const int axis = lattice.integer(0, 2);
  for (int k = 0; k < 3; ++k) {
    const bool moves = along_axis ? k == axis : k != axis;
    if (moves) ray.direction[k] = lattice.integer(0, 1) == 0 ? -1 : 1;
  }
  return ray;
}

void zero_directions(Run& run) {
  Lattice lattice(10);
  QuerySet queries;
  for (std::size_t i = 0; i < run.count(600, 20'000); ++i) {
    queries.rays.push_back(lattice_ray(lattice, true));
  }
  const std::size_t hits = check_answers(run, test::city(30, 2), queries);
  run.premise(hits > 1000, "hardly any ray hits");
}

void rays_in_planes(Run& run) {
  Lattice lattice(11);
  QuerySet queries;
  for (std::size_t i = 0; i < run.count(600, 20'000); ++i) {
    queries.rays.push_back(lattice_ray(lattice, false));
  }
  std::size_t hits = check_answers(run, test::city(30, 2), queries);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    hits += check_answers(run, flat_square(12, axis), queries);
  }
  run.premise(hits > 1000, "hardly any ray hits");
}

void boxes_in_planes(Run& run) {
  Lattice lattice(12);
  QuerySet queries;
  for (std::size_t i = 0; i < run.count(300, 5'000); ++i) {
    const Eigen::Vector3d a = lattice.point(), b = lattice.point();
    Eigen::AlignedBox3d box(a.cwiseMin(b), a.cwiseMax(b));
    const int axis = lattice.integer(0, 2);
    if (i % 2 == 0) box.max()[axis] = box.min()[axis];
    if (i % 6 == 0) box.max()[(axis + 1) % 3] = box.min()[(axis + 1) % 3];
    queries.boxes.push_back(box);
  }
  std::size_t hits = check_answers(run, test::city(30, 2), queries);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    hits += check_answers(run, flat_square(12, axis), queries);
  }
  run.premise(hits > 1000, "hardly any box touches");
}

void negative_zero(Run& run) {
  SourceMesh positive = plus(test::city(24, 2), Eigen::Vector3d(-3, -2, 0));
  SourceMesh negative = positive;
  std::size_t zeros = 0;
  for (std::size_t i = 0; i < negative.positions.f32.size(); ++i) {
    // Every other zero, so that vertices equal as numbers differ in their bits.
    if (negative.positions.f32[i] != 0 || zeros++ % 2 != 0) continue;
    negative.positions.f32[i] = -0.0F;
  }
  run.premise(zeros > 10, "hardly a zero");
  QuerySet queries = queries_for(positive, 13);
  QuerySet turned = queries;
  for (Ray& ray : turned.rays) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (ray.origin[k] == 0) ray.origin[k] = -ray.origin[k];
      if (ray.direction[k] == 0) ray.direction[k] = -ray.direction[k];
    }
  }
  for (Cast& cast : turned.casts) {
    Eigen::Vector3d at = position_of(cast.shape);
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (at[k] == 0) at[k] = -at[k];
      if (cast.motion.direction[k] == 0) cast.motion.direction[k] = -cast.motion.direction[k];
    }
    cast.shape = moved_to(std::move(cast.shape), at);
  }
  for (Eigen::AlignedBox3d& box : turned.boxes) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      if (box.min()[k] == 0) box.min()[k] = -box.min()[k];
      if (box.max()[k] == 0) box.max()[k] = -box.max()[k];
    }
  }
  for (const Store& store : kStores) {
    for (const CodecInfo& codec : kCodecs) {
      const Subject a = make_subject(positive, codec.id, store);
      const Subject b = make_subject(negative, codec.id, store);
      const Answers expected = run_query(a.tree(), queries);
      run.check(count_differing(run_query(b.tree(), queries), expected) == 0,
                [&] { return b.name + ": zeros of the mesh"; });
      run.check(count_differing(run_query(a.tree(), turned), expected) == 0,
                [&] { return a.name + ": zeros of the queries"; });
    }
  }
}

// Rays from inside a closed surface to its vertices and to points on its edges.
void watertight(Run& run) {
  struct Closed {
    SourceMesh mesh;
    bool is_torus;
  };
  std::vector<Closed> surfaces = {{icosphere_mesh(4), false}, {test::torus(60, 40), true}};
  surfaces.push_back({plus(times(icosphere_mesh(3), 3), Eigen::Vector3d(1e5, 2e5, -3e4)), false});
  surfaces.push_back({times(test::torus(30, 20), 1e-20), true});
  surfaces.push_back({times(icosphere_mesh(3), 1e20), false});
  const std::size_t rays = run.count(10'000, 1'000'000);
  for (const Closed& closed : surfaces) {
    const Eigen::AlignedBox3d bounds = bounds_of(closed.mesh);
    const double size = bounds.diagonal().maxCoeff() / 2;
    for_each_subject(closed.mesh, [&](const Subject& subject) {
      std::mt19937_64 random(14);
      const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
      const std::vector<DecodedTriangle> triangles = decoded_triangles(subject.tree());
      std::uint64_t leaks = 0;
      for (std::size_t i = 0; i < rays; ++i) {
        Eigen::Vector3d inside = Eigen::Vector3d(unit() - 0.5, unit() - 0.5, unit() - 0.5);
        if (closed.is_torus) {  // radii 1 and 0.4 of 1.4, inside the tube
          const double angle = 7 * unit();
          inside = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.2 * (unit() - 0.5)) / 1.4;
        }
        const Eigen::Vector3d origin = bounds.center() + size * inside;
        const auto& corner =
            triangles[static_cast<std::size_t>(random() % triangles.size())].triangle.corner;
        const std::size_t c = i % 3;
        const double along = i % 2 == 0 ? 0 : unit();
        const Eigen::Vector3d target =
            BoundTree::of(subject.tree())
                .frame()
                .to_object(corner[c] + along * (corner[(c + 1) % 3] - corner[c]));
        const auto hit = closest_hit(subject.tree(), {origin, target - origin});
        leaks += hit.ok() && hit.has_value() ? 0u : 1u;
      }
      for (std::uint64_t i = 0; i < rays; ++i) run.check(i >= leaks, [&] { return subject.name; });
    });
  }
}

// A box whose sides have two triangles each and whose lid is a fan with `parts` triangles per edge.
// A row of triangles without area closes the seam at each of these edges. Integer coordinates,
// rotated by an integer matrix, so that collinear points stay collinear.
SourceMesh box_with_seams(int parts) {
  Eigen::Matrix3d turn;
  turn << 3, 1, 0, -1, 5, 2, 1, 0, 7;
  const double p = parts;
  const std::array<Eigen::Vector3d, 4> low = {{{-p, -p, -p}, {p, -p, -p}, {p, p, -p}, {-p, p, -p}}};
  std::array<Eigen::Vector3d, 4> high = low;
  for (Eigen::Vector3d& corner : high) corner[2] = p;
  std::vector<Corners> triangles = {{low[0], low[1], low[2]}, {low[0], low[2], low[3]}};
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t next = (i + 1) % 4;
    triangles.push_back({low[i], low[next], high[next]});
    triangles.push_back({low[i], high[next], high[i]});
    const Eigen::Vector3d step = (high[next] - high[i]) / p;
    for (int k = 0; k < parts; ++k) {
      const Eigen::Vector3d from = high[i] + k * step, to = from + step;
      triangles.push_back({from, to, Eigen::Vector3d(0, 0, p)});
      if (k > 0) triangles.push_back({high[i], from, to});
    }
  }
  for (Corners& corners : triangles) {
    for (Eigen::Vector3d& corner : corners) corner = turn * corner;
  }
  return from_triangles("box with seams", triangles);
}

// Faces without area close a surface where its vertices do not meet: rays at the seams must hit.
void seams_without_area(Run& run) {
  for (const int parts : {3, 8, 100}) {
    const SourceMesh mesh = box_with_seams(parts);
    for_each_subject(mesh, [&](const Subject& subject) {
      std::mt19937_64 random(12);
      const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
      const std::size_t rays = run.count(4000, 200'000);
      const std::vector<DecodedTriangle> triangles = decoded_triangles(subject.tree());
      for (std::size_t i = 0; i < rays; ++i) {
        const Eigen::Vector3d origin = parts * Eigen::Vector3d{unit(), unit(), unit()};
        const auto& corner =
            triangles[static_cast<std::size_t>(random() % triangles.size())].triangle.corner;
        const double along = i % 2 == 0 ? 0 : unit() + 0.5;
        const Eigen::Vector3d target =
            BoundTree::of(subject.tree())
                .frame()
                .to_object(corner[i % 3] + along * (corner[(i + 1) % 3] - corner[i % 3]));
        const auto hit = closest_hit(subject.tree(), {origin, target - origin});
        run.check(hit.ok() && hit.has_value(), [&] { return subject.name; });
      }
    });
  }
}

// A triangle through which bodies fell in another engine.
void real_world_triangle(Run& run) {
  const Corners corners = {Eigen::Vector3d(2832.862F, 200.0F, -641.5822F),
                           Eigen::Vector3d(2834.611F, 200.0066F, -643.3685F),
                           Eigen::Vector3d(2834.289F, 200.0F, -640.1809F)};
  const Eigen::Vector3d normal =
      (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
  const SourceMesh mesh = from_triangles("real-world triangle", {corners});
  std::mt19937_64 random(30);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for_each_subject(mesh, [&](const Subject& subject) {
    for (std::size_t i = 0; i < run.count(500, 100'000); ++i) {
      const double u = 0.05 + 0.4 * unit(), v = 0.05 + 0.4 * unit();
      const Eigen::Vector3d at = (1 - u - v) * corners[0] + u * corners[1] + v * corners[2];
      const Eigen::Vector3d aside(unit() - 0.5, unit() - 0.5, unit() - 0.5);
      const Eigen::Vector3d from =
          at + std::ldexp(i % 2 == 0 ? 1.0 : -1.0, static_cast<int>(i % 14)) * (normal + aside);
      const auto hit = closest_hit(subject.tree(), {from, at - from});
      run.check(hit.ok() && hit.has_value() && std::abs(hit->t - 1) < 1e-3,
                [&] { return subject.name + ": ray " + std::to_string(i); });
      // A small triangle perpendicular to the face.
      const Eigen::Vector3d side = 0.01 * aside.cross(normal);
      const SourceMesh other = from_triangles(
          "probe", {{at - 0.01 * normal, Eigen::Vector3d(at + 0.01 * normal), at + side}},
          cooker::Precision::kF64);
      if (i >= run.count(20, 1000)) continue;
      const Subject probe = make_subject(other, CodecId::kPackedF64, kExactStore);
      const auto contact =
          first_contact(subject.tree(), Pose::Identity(), probe.tree(), Pose::Identity());
      run.check(contact.ok() && contact.has_value(),
                [&] { return subject.name + ": contact " + std::to_string(i); });
    }
  });
}

// Along axes nothing is rounded on the way, so distance must not matter.
void rays_from_afar(Run& run) {
  const SourceMesh mesh = icosphere_mesh(1);
  for_each_subject(mesh, [&](const Subject& subject) {
    std::mt19937_64 random(15);
    const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
    for (int exponent = 1; exponent <= 170; ++exponent) {
      for (int i = 0; i < 12; ++i) {
        Ray ray{{unit(), unit(), unit()}, Eigen::Vector3d::Zero()};
        const Eigen::Index axis = i % 3;
        const double sign = i % 2 == 0 ? 1 : -1;
        ray.origin[axis] = -sign * std::ldexp(1.0, exponent);
        ray.direction[axis] = sign;
        const auto hit = closest_hit(subject.tree(), ray);
        run.check(hit.ok() && hit.has_value() && std::isfinite(hit->t),
                  [&] { return subject.name + ": from 2^" + std::to_string(exponent); });
      }
    }
  });
}

// Invalid queries are refused with an error code before any node is read. The tree's nodes are all
// damaged, so reading one would give another code.
void invalid_queries(Run& run) {
  const auto all = [](const auto&) { return true; };
  const SourceMesh mesh = test::sphere(10, 12);
  for (const CodecInfo& codec : kCodecs) {
    cooker::EncodedTree encoded = test::require(cooker::cook_as(mesh, codec.id));
    // Keeps the header of packed nodes, which binding checks.
    const auto first = encoded.nodes.bytes.begin() + (is_packed(codec.id) ? kPackedHeader : 0);
    std::fill(first, encoded.nodes.bytes.end(), std::byte{0xff});
    const Tree tree = test::require(cooker::bind_encoded(encoded));
    run.premise(!closest_hit(tree, {{0, 0, 0}, {1, 0, 0}}).ok(),
                "the damage goes unseen: " + std::string(codec.name));
    const auto refused = [&](Errc code, Errc expected, const char* what) {
      run.check(code == expected, [&] { return std::string(codec.name) + ": " + what; });
    };
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero(), one = Eigen::Vector3d::Ones();
    for (Eigen::Index k = 0; k < 3; ++k) {
      for (const double bad : {kNaN, kInfinity, -kInfinity}) {
        Eigen::Vector3d v = one;
        v[k] = bad;
        refused(closest_hit(tree, {v, one}).code(), Errc::kInvalidQuery, "ray origin");
        refused(closest_hit(tree, {zero, v}).code(), Errc::kInvalidQuery, "ray direction");
        refused(any_hit(tree, {v, one}).code(), Errc::kInvalidQuery, "any-hit ray origin");
        refused(any_hit(tree, {zero, v}).code(), Errc::kInvalidQuery, "any-hit ray direction");
        refused(closest_point(tree, v).code(), Errc::kInvalidQuery, "point");
        refused(overlap_sphere(tree, v, 1, all).code(), Errc::kInvalidQuery, "sphere center");
        for (const Shape& shape : shapes_of(one)) {
          const auto visit = [](const CastHit&) { return 1.0; };
          const auto refuse = [&](const Shape& placed, const Motion& motion) {
            with_shape(placed, [&](const auto& s) {
              refused(cast_closest(tree, s, motion).code(), Errc::kInvalidQuery, "cast");
              refused(cast_any(tree, s, motion).code(), Errc::kInvalidQuery, "any cast");
              refused(cast_all(tree, s, motion, visit).code(), Errc::kInvalidQuery, "all casts");
            });
          };
          refuse(moved_to(shape, v), Motion{one, 1});
          refuse(shape, Motion{v, 1});
          if (std::isnan(bad) || bad < 0) refuse(shape, Motion{one, bad});
          with_shape(moved_to(shape, v), [&](const auto& s) {
            refused(collide(tree, s, all).code(), Errc::kInvalidQuery, "shape");
          });
        }
        refused(overlap_box(tree, {zero, v}, all).code(), Errc::kInvalidQuery, "box");
        refused(overlap_box(tree, {v, one}, all).code(), Errc::kInvalidQuery, "box");
        Pose pose = Pose::Identity();
        pose.translation() = v;
        refused(first_contact(tree, pose, tree, Pose::Identity()).code(), Errc::kInvalidPose,
                "translation");
        refused(overlap_pairs(tree, Pose::Identity(), tree, pose, all).code(), Errc::kInvalidPose,
                "translation");
        pose = Pose::Identity();
        pose.linear()(k, (k + 1) % 3) = bad;
        refused(first_contact(tree, pose, tree, Pose::Identity()).code(), Errc::kInvalidPose,
                "matrix");
        refused(first_contact(tree, Pose::Identity(), tree, pose).code(), Errc::kInvalidPose,
                "matrix");
      }
      Pose flat = Pose::Identity();
      flat.linear()(k, k) = 0;
      refused(first_contact(tree, flat, tree, Pose::Identity()).code(), Errc::kInvalidPose,
              "singular matrix");
      refused(first_contact(tree, Pose::Identity(), tree, flat).code(), Errc::kInvalidPose,
              "singular matrix");
      Eigen::AlignedBox3d turned(zero, one);
      turned.max()[k] = -1;
      refused(overlap_box(tree, turned, all).code(), Errc::kInvalidQuery, "box inside out");
    }
    for (const double bad : {kNaN, -1.0}) {
      refused(closest_point(tree, zero, bad).code(), Errc::kInvalidQuery, "distance");
      refused(overlap_sphere(tree, zero, bad, all).code(), Errc::kInvalidQuery, "radius");
      refused(closest_hit(tree, {zero, one, bad}).code(), Errc::kInvalidQuery, "t_min");
    }
    refused(overlap_sphere(tree, zero, kInfinity, all).code(), Errc::kInvalidQuery, "radius");
    refused(closest_hit(tree, {zero, zero}).code(), Errc::kInvalidQuery, "zero direction");
    refused(closest_hit(tree, {zero, -zero}).code(), Errc::kInvalidQuery, "zero direction");
    refused(closest_hit(tree, {zero, one, 2, 1}).code(), Errc::kInvalidQuery, "t interval");
    refused(closest_hit(tree, {zero, one, 0, kNaN}).code(), Errc::kInvalidQuery, "t_max");
    refused(closest_hit(tree, {1e300 * one, one}).code(), Errc::kInvalidQuery, "origin far out");
  }
}

}  // namespace

std::vector<Case> ray_cases() {
  return {
      {"R09", "InvalidQueries", "NaN, infinity, zero directions, singular poses are refused unread",
       "not refused", 0, invalid_queries},
      {"R10", "ZeroDirections", "rays along axes in box faces, components +0 and -0",
       "wrong answers", 0, zero_directions},
      {"R11", "Watertight", "rays at edges and vertices from inside closed meshes", "leaks", 0,
       watertight},
      {"R30", "RealWorldTriangle", "a nearly level triangle at 2834, 200, -641: rays, contacts",
       "misses", 0, real_world_triangle},
      {"E01", "BoxesInPlanes", "query boxes that lie in planes of the mesh, flat ones too",
       "wrong answers", 0, boxes_in_planes},
      {"E02", "RaysInPlanes", "diagonal rays that lie in planes of the mesh", "wrong answers", 0,
       rays_in_planes},
      {"E03", "NegativeZero", "-0 for 0 in meshes and in queries", "trees that differ", 0,
       negative_zero},
      {"E12", "SeamsWithoutArea", "rays at seams that triangles without area close", "leaks", 0,
       seams_without_area},
      {"E11", "RaysFromAfar", "rays along axes from 2 to 2^170 away", "misses", 0, rays_from_afar},
  };
}

}  // namespace boxtree::robustness
