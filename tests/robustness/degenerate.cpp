// SPDX-License-Identifier: MIT
// Triangles without area, coincident triangles, no triangles, and meshes without volume.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "cooker/proof/proof.h"
#include "runtime/tree/bound_tree.h"
#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/support/coincident.h"
#include "tests/support/require.h"
#include "tests/unit/primitive/exact_simplex.h"
#include "tests/unit/primitive/triangle_cases.h"

namespace boxtree::robustness {
namespace {

constexpr std::int64_t kKinds = 6;  // of test::TriangleCases::degenerate
constexpr std::int64_t kRange = 8;  // coordinates of magnitude up to 32

std::vector<test::IntVector> whole(const Corners& corners) {
  std::vector<test::IntVector> points;
  for (const Eigen::Vector3d& corner : corners) points.push_back(test::to_integer(corner));
  return points;
}

// The exact sign of the squared distance between point p and segment ab, minus r * r; all integers.
int compare_distance(const test::IntVector& p, const test::IntVector& a, const test::IntVector& b,
                     std::int64_t r) {
  const auto dot = [](const test::IntVector& u, const test::IntVector& v) {
    return test::Int128(u.x) * v.x + test::Int128(u.y) * v.y + test::Int128(u.z) * v.z;
  };
  const auto minus = [](const test::IntVector& u, const test::IntVector& v) {
    return test::IntVector{u.x - v.x, u.y - v.y, u.z - v.z};
  };
  const test::IntVector edge = minus(b, a), from_a = minus(p, a), from_b = minus(p, b);
  const test::Int128 length = dot(edge, edge), along = dot(from_a, edge);
  if (along <= 0) return test::sign_of(dot(from_a, from_a) - test::Int128(r) * r);
  if (along >= length) return test::sign_of(dot(from_b, from_b) - test::Int128(r) * r);
  return test::sign_of(dot(from_a, from_a) * length - along * along - test::Int128(r) * r * length);
}

// Faces that a query reports; `visit` is the query.
template <class Query>
std::vector<std::uint32_t> faces_of(Query query) {
  std::vector<std::uint32_t> faces;
  const auto result = query([&](const FaceRef& face) {
    faces.push_back(face.id);
    return true;
  });
  if (!result) throw std::runtime_error(result.error().message());
  std::sort(faces.begin(), faces.end());
  return faces;
}

// The distance between a line and a segment.
double line_to_segment(const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                       const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d unit = direction.normalized();
  const auto across = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return v - unit.dot(v) * unit;
  };
  const Eigen::Vector3d start = across(from - point), edge = across(to - from);
  const double length = edge.squaredNorm();
  const double along = length > 0 ? std::clamp(-start.dot(edge) / length, 0.0, 1.0) : 0;
  return (start + along * edge).norm();
}

class DegenerateKind {
 public:
  DegenerateKind(Run& run, std::int64_t kind) : run_(run), cases_(0xde9, kRange) {
    for (int i = 0; i < 40; ++i) {
      corners_.push_back(cases_.degenerate(kind, kRange).corner);
      proper_.push_back(cases_.triangle(kRange).corner);
    }
    mesh_ = from_triangles("degenerate kind " + std::to_string(kind), corners_);
  }

  void check() {
    const SourceMesh proper = from_triangles("proper", proper_);
    FacePairs pairs;
    for (std::uint32_t i = 0; i < corners_.size(); ++i) {
      for (std::uint32_t j = 0; j < proper_.size(); ++j) {
        if (test::hulls_intersect(whole(corners_[i]), whole(proper_[j]))) pairs.emplace_back(i, j);
      }
    }
    const Boxes boxes = make_boxes();
    for_each_subject(mesh_, [&](const Subject& subject) {
      check_boxes(subject, boxes);
      check_spheres(subject);
      check_rays(subject);
      const Subject other =
          make_subject(proper, BoundTree::of(subject.tree()).codec(), kExactStore);
      run_.check(
          found_pairs(subject.tree(), Pose::Identity(), other.tree(), Pose::Identity()) == pairs,
          [&] { return subject.name + ": pairs"; });
    });
  }

 private:
  struct Boxes {
    std::vector<Eigen::AlignedBox3d> box;
    std::vector<std::vector<std::uint32_t>> faces;  // that touch the point
  };

  Boxes make_boxes() {
    Boxes boxes;
    for (int i = 0; i < 12; ++i) {
      const Eigen::Vector3d a = cases_.point(kRange);
      const Eigen::Vector3d b = a + cases_.point(i % 3 == 0 ? 2 : kRange);
      boxes.box.emplace_back(a.cwiseMin(b), a.cwiseMax(b));
      std::vector<test::IntVector> corners;
      for (int c = 0; c < 8; ++c) {
        corners.push_back(test::to_integer(
            boxes.box.back().corner(static_cast<Eigen::AlignedBox3d::CornerType>(c))));
      }
      boxes.faces.emplace_back();
      for (std::uint32_t f = 0; f < corners_.size(); ++f) {
        if (test::hulls_intersect(corners, whole(corners_[f]))) boxes.faces.back().push_back(f);
      }
    }
    return boxes;
  }

  void check_boxes(const Subject& subject, const Boxes& boxes) {
    for (std::size_t i = 0; i < boxes.box.size(); ++i) {
      const auto found = faces_of(
          [&](FaceVisitor visitor) { return overlap_box(subject.tree(), boxes.box[i], visitor); });
      run_.check(found == boxes.faces[i],
                 [&] { return subject.name + ": box " + std::to_string(i); });
    }
  }

  // If a sphere touches a segment exactly and double cannot decide it, either result is valid.
  void check_spheres(const Subject& subject) {
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d center = cases_.point(kRange);
      const std::int64_t radius = cases_.integer(0, 10);
      const auto found = faces_of([&](FaceVisitor visitor) {
        return overlap_sphere(subject.tree(), center, static_cast<double>(radius), visitor);
      });
      for (std::uint32_t f = 0; f < corners_.size(); ++f) {
        const auto c = whole(corners_[f]);
        const auto p = test::to_integer(center);
        const int side = std::min({compare_distance(p, c[0], c[1], radius),
                                   compare_distance(p, c[1], c[2], radius),
                                   compare_distance(p, c[2], c[0], radius)});
        const bool is_found = std::binary_search(found.begin(), found.end(), f);
        if (side == 0) continue;
        run_.check(is_found == (side < 0), [&] {
          return subject.name + ": sphere " + std::to_string(i) + ", face " + std::to_string(f);
        });
      }
    }
  }

  // A ray that passes a face without area must miss it. A ray through such a face may hit or miss,
  // because seams of closed surfaces are such faces; a reported hit must be correct.
  void check_rays(const Subject& subject) {
    for (int i = 0; i < 400; ++i) {
      const Corners& aimed = corners_[static_cast<std::size_t>(i) % corners_.size()];
      const Eigen::Vector3d direction =
          cases_.point(kRange) + Eigen::Vector3d(0.5, 0, 0);  // not zero
      const Eigen::Vector3d target = i % 2 == 0 ? aimed[0] : Eigen::Vector3d(cases_.point(kRange));
      const auto hit = closest_hit(subject.tree(), {target - 4 * direction, direction});
      const bool is_true = hit.ok() && (!hit.has_value() || is_on_face(*hit, target, direction));
      run_.check(is_true, [&] { return subject.name + ": ray " + std::to_string(i); });
    }
  }

  bool is_on_face(const RayHit& hit, const Eigen::Vector3d& target,
                  const Eigen::Vector3d& direction) const {
    const Eigen::Vector3d at = target + (hit.t - 4) * direction;
    double distance = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < 3; ++c) {
      const Corners& corners = corners_[hit.face.id];
      // Uses the ray's line, not the reported point: t is uncertain along the segment.
      distance =
          std::min(distance, line_to_segment(at, direction, corners[c], corners[(c + 1) % 3]));
    }
    return distance < 1e-12 * 64;
  }

  Run& run_;
  test::TriangleCases cases_;
  std::vector<Corners> corners_;
  std::vector<Corners> proper_;
  SourceMesh mesh_;
};

void degenerate_kinds(Run& run) {
  for (std::int64_t kind = 0; kind < kKinds; ++kind) DegenerateKind(run, kind).check();
}

long double segment_distance(const Eigen::Vector3d& point, const Eigen::Vector3d& from,
                             const Eigen::Vector3d& to) {
  using Vector = Eigen::Matrix<long double, 3, 1>;
  const Vector p = point.cast<long double>(), a = from.cast<long double>();
  const Vector edge = to.cast<long double>() - a;
  const long double length = edge.squaredNorm();
  const long double at = length > 0 ? std::clamp((p - a).dot(edge) / length, 0.0L, 1.0L) : 0.0L;
  return (a + at * edge - p).norm();
}

// Errors are in units in the last place of the largest number in the computation, a coordinate of
// the point relative to the segment.
void closest_point_on_degenerate(Run& run) {
  std::mt19937_64 random(16);
  // Twelve bits: differences and multiples are exact in f32, so collinear points stay collinear.
  const auto number = [&](int bits) {
    return static_cast<double>(random() >> (64 - bits)) - std::ldexp(1.0, bits - 1);
  };
  const auto vector = [&] { return Eigen::Vector3d(number(12), number(12), number(12)); };
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector3d a = vector(), step = vector();
    for (const Corners& corners :
         {Corners{a, a, a}, Corners{a, a, a + step}, Corners{a, a + step, a},
          Corners{a + step, a, a}, Corners{a, a + step, a + 3 * step},
          Corners{a, a + 2 * step, a - step}}) {
      const SourceMesh mesh = from_triangles("degenerate", {corners});
      for (const CodecInfo& codec : kCodecs) {
        const Subject subject = make_subject(mesh, codec.id, kExactStore);
        for (int q = 0; q < 10; ++q) {
          const Eigen::Vector3d point(number(20) / 64, number(20) / 64, number(20) / 64);
          const auto closest = test::require(closest_point(subject.tree(), point));
          long double expected = std::numeric_limits<long double>::infinity();
          double largest = 0;
          for (std::size_t c = 0; c < 3; ++c) {
            expected =
                std::min(expected, segment_distance(point, corners[c], corners[(c + 1) % 3]));
            largest = std::max(largest, (point - corners[c]).cwiseAbs().maxCoeff());
          }
          const double ulp = std::nextafter(largest, INFINITY) - largest;
          run.measure(static_cast<double>(
              std::abs(static_cast<long double>(closest->distance) - expected) / ulp));
        }
      }
    }
  }
}

void check_duplicates(Run& run, const Subject& subject, std::uint32_t copies) {
  const WalkFigures figures = walk_tree(subject.tree());
  const auto name = [&] { return subject.name + ": " + std::to_string(copies) + " copies"; };
  run.check(figures.leaves == 1, name);  // of one face, whose copies are listed
  run.check(figures.missed == 0 && figures.repeated == 0, name);
  run.check(figures.depth <= 2 * std::log2(copies) + 4, name);
  std::vector<std::uint32_t> all(copies);
  for (std::uint32_t i = 0; i < copies; ++i) all[i] = i;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(2, 2, 2));
  const Eigen::AlignedBox3d small(Eigen::Vector3d(0.25, 0.25, 0), Eigen::Vector3d(0.5, 0.5, 1));
  for (const Eigen::AlignedBox3d& region : {box, small}) {
    run.check(faces_of([&](FaceVisitor visitor) {
                return overlap_box(subject.tree(), region, visitor);
              }) == all,
              name);
  }
  run.check(faces_of([&](FaceVisitor visitor) {
              return overlap_sphere(subject.tree(), {0.25, 0.25, 0.2}, 0.5, visitor);
            }) == all,
            name);
  const auto hit = test::require(closest_hit(subject.tree(), {{0.25, 0.25, 3}, {0, 0, -1}}));
  run.check(hit && hit->face.id == 0, name);
  const auto closest = test::require(closest_point(subject.tree(), {0.25, 0.25, 3}));
  run.check(closest && closest->face.id == 0, name);
}

void duplicates(Run& run) {
  for (const std::uint32_t copies : {1u, 2u, 50u, 1000u}) {
    for_each_subject(test::duplicates(copies), [&](const Subject& subject) {
      check_duplicates(run, subject, copies);
      const Tree& tree = subject.tree();
      // A million pairs of coplanar triangles: too slow for every codec.
      const bool is_one_of_few = BoundTree::of(tree).codec() == CodecId::kPlainF32 ||
                                 BoundTree::of(tree).codec() == CodecId::kWide8;
      if (copies > 50 && !is_one_of_few && !run.is_full()) return;
      std::vector<bool> met(std::size_t{copies} * copies, false);
      std::uint64_t pairs = 0, repeated = 0;
      const auto note = [&](const FacePair& pair) {
        const std::size_t number = std::size_t{pair.first.id} * copies + pair.second.id;
        repeated += met[number] ? 1u : 0u;
        met[number] = true;
        ++pairs;
        return true;
      };
      const auto visit = overlap_pairs(tree, Pose::Identity(), tree, Pose::Identity(), note);
      run.check(visit.ok() && repeated == 0 && pairs == std::uint64_t{copies} * copies,
                [&] { return subject.name + ": pairs"; });
    });
  }
}

void million_duplicates(Run& run) {
  constexpr std::uint32_t kMillion = 1'000'000;
  for (const CodecInfo& codec : kCodecs) {
    const std::uint32_t copies = run.is_full() || codec.id == CodecId::kWide8 ? kMillion : 40'000;
    check_duplicates(run, make_subject(test::duplicates(copies), codec.id, kExactStore), copies);
  }
  check_duplicates(run, make_subject(test::duplicates(kMillion), CodecId::kWide4, kStores[1]),
                   kMillion);
}

void coincident_faces(Run& run) {
  std::vector<SourceMesh> meshes = test::coincident_kinds(run.is_full() ? 400 : 72);
  meshes.push_back(test::mixed(test::city(3, 2), test::city(3, 2)));
  for (const SourceMesh& mesh : meshes) {
    const std::size_t hits = check_answers(run, mesh, queries_for(mesh, 13));
    run.premise(hits > 100, mesh.name + ": hardly any answer names a face");
  }
}

void few_triangles(Run& run) {
  const auto all = [](const auto&) { return true; };
  SourceMesh none;
  none.name = "no triangle";
  const SourceMesh some = test::sphere(6, 8);
  for_each_subject(none, [&](const Subject& subject) {
    const Tree& tree = subject.tree();
    const auto name = [&] { return subject.name; };
    run.check(tree.empty(), name);
    run.check(!test::require(closest_hit(tree, {{0, 0, 5}, {0, 0, -1}})), name);
    run.check(!test::require(any_hit(tree, {{0, 0, 5}, {0, 0, -1}})), name);
    run.check(!test::require(closest_point(tree, {0, 0, 0})), name);
    std::size_t faces = 0;
    const auto count = [&](const FaceRef&) {
      ++faces;
      return true;
    };
    run.check(
        overlap_box(
            tree, Eigen::AlignedBox3d(Eigen::Vector3d(-1, -1, -1), Eigen::Vector3d(1, 1, 1)), count)
                .ok() &&
            overlap_sphere(tree, {0, 0, 0}, 9, count).ok() && faces == 0,
        name);
    const Subject other = make_subject(some, BoundTree::of(tree).codec(), kExactStore);
    for (const auto& [a, b] : {std::pair(&tree, &other.tree()), std::pair(&other.tree(), &tree),
                               std::pair(&tree, &tree)}) {
      run.check(!test::require(first_contact(*a, Pose::Identity(), *b, Pose::Identity())), name);
      run.check(overlap_pairs(*a, Pose::Identity(), *b, Pose::Identity(), all).ok(), name);
    }
    run.check(cooker::verify_file(subject.cooked.file).empty(), name);
  });
  const Corners one = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0),
                       Eigen::Vector3d(0, 1, 0.5)};
  const Corners two = {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, -1),
                       Eigen::Vector3d(0.25, 1, 0.5)};
  for (const auto& triangles : {std::vector<Corners>{one}, std::vector<Corners>{one, two}}) {
    const SourceMesh mesh = from_triangles(std::to_string(triangles.size()), triangles);
    run.premise(check_answers(run, mesh, queries_for(mesh, 21)) > 100, "hardly any hit");
    // Coordinates that are not exact in f32: boxes and spheres at the corners detect rounding.
    const SourceMesh fine = times(in_double(mesh), 1.0 / 3);
    run.premise(check_answers(run, fine, queries_for(fine, 22)) > 100, "hardly any hit");
  }
}

// Bounds without extent on one, two and three axes, at the origin and elsewhere.
void flat_bounds(Run& run) {
  std::vector<SourceMesh> meshes;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    meshes.push_back(flat_square(8, axis));
    std::vector<Corners> line, points;
    const Eigen::Vector3d unit = Eigen::Vector3d::Unit(axis);
    for (int i = 0; i < 40; ++i) {
      line.push_back({i * unit, (i % 7) * unit, (2.0 * (i % 11)) * unit});
      points.push_back({3 * unit, 3 * unit, 3 * unit});
    }
    meshes.push_back(from_triangles("line", line));
    meshes.push_back(from_triangles("point", points));
  }
  std::size_t hits = 0;
  for (const SourceMesh& mesh : meshes) {
    hits += check_answers(run, mesh, queries_for(mesh, 31));
    const SourceMesh away = plus(mesh, Eigen::Vector3d(1e4, -5e3, 77));
    hits += check_answers(run, away, queries_for(away, 32));
  }
  run.premise(hits > 10'000, "hardly any answer names a face");
}

}  // namespace

std::vector<Case> degenerate_cases() {
  return {
      {"R13", "DegenerateKinds", "six kinds of degenerate triangles against integer arithmetic",
       "wrong answers", 0, degenerate_kinds},
      {"R16", "ClosestPointOnDegenerate", "closest points of segments and points, in long double",
       "ulp of the coordinates", 4, closest_point_on_degenerate},
      {"R18", "Duplicates", "1, 2, 50, 1000 identical triangles: leaves, depth, each face once",
       "wrong", 0, duplicates},
      {"R21", "FewTriangles", "trees of 0, 1 and 2 triangles", "wrong answers", 0, few_triangles},
      {"E06", "MillionDuplicates", "a million triangles in one place", "wrong", 0,
       million_duplicates},
      {"E13", "CoincidentFaces", "faces that are the same, coplanar or both, in every codec",
       "wrong answers", 0, coincident_faces},
      {"E07", "FlatBounds", "bounds flat on one, two, three axes", "wrong answers", 0, flat_bounds},
  };
}

}  // namespace boxtree::robustness
