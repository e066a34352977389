// SPDX-License-Identifier: MIT
// Boxes must contain what is below them for all numbers: narrow types, rounding of the traversal,
// all sizes.
#include <algorithm>
#include <cmath>
#include <random>

#include "runtime/tree/bound_tree.h"
#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"

namespace boxtree::robustness {
namespace {

void check_boxes(Run& run, const Subject& subject) {
  const WalkFigures figures = walk_tree(subject.tree());
  const auto name = [&] { return subject.name; };
  run.check(figures.escapes == 0, name);
  run.check(figures.boxes_infinite == 0, name);
  run.check(figures.missed == 0 && figures.repeated == 0, name);
  run.premise(figures.leaves > 0, subject.name + ": no leaf");
}

void boxes_hold_triangles(Run& run) {
  for (const SourceMesh& mesh : test::all_kinds()) {
    for_each_subject(mesh, [&](const Subject& subject) { check_boxes(run, subject); });
    // Coordinates that no codec represents exactly: every cut is rounded.
    const SourceMesh odd = times(mesh, std::sqrt(2.0) / 3);
    for_each_subject(odd, [&](const Subject& subject) { check_boxes(run, subject); });
  }
}

// 65504 is the largest f16; 65520 is the smallest number that rounds to infinity.
void boxes_beyond_half_range(Run& run) {
  for (const double scale : {1e5, 1e6, 65504.0, 65520.0, 1e12, 1e-5, 1e-8}) {
    for (const SourceMesh& mesh : {test::sphere(16, 24), test::city(24, 2), test::soup(200, 3)}) {
      for_each_subject(times(mesh, scale),
                       [&](const Subject& subject) { check_boxes(run, subject); });
    }
  }
}

// Poses with rounding in every step: traversal must not lose a pair of triangles.
void traversal_rounding(Run& run) {
  std::mt19937_64 random(3);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  const std::vector<SourceMesh> meshes = {test::terrain(10, 1), test::city(12, 2),
                                          test::torus(16, 12), test::soup(150, 3)};
  std::size_t pairs = 0;
  for (const SourceMesh& mesh : meshes) {
    std::vector<Pose> poses;
    const double size = bounds_of(mesh).diagonal().maxCoeff();
    for (std::size_t i = 0; i < run.count(8, 400); ++i) {
      Pose pose = Pose::Identity();
      // Rotations near multiples of 90 degrees: aligned faces that graze each other.
      const double off = i % 2 == 0 ? std::ldexp(unit() - 0.5, -static_cast<int>(i % 50)) : unit();
      pose.rotate(Eigen::AngleAxisd(std::acos(0.0) * static_cast<double>(i % 4) + off,
                                    Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i % 3))));
      const Eigen::Vector3d shift(unit() - 0.5, unit() - 0.5, unit() - 0.5);
      pose.pretranslate(Eigen::Vector3d(size * (i % 3 == 0 ? 0.01 : 0.5) * shift));
      poses.push_back(pose);
    }
    for_each_subject(mesh, [&](const Subject& subject) {
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const FacePairs expected =
            brute_pairs(subject.tree(), Pose::Identity(), subject.tree(), poses[i]);
        const FacePairs found =
            found_pairs(subject.tree(), Pose::Identity(), subject.tree(), poses[i]);
        pairs += expected.size();
        run.check(found == expected, [&] { return subject.name + ": pose " + std::to_string(i); });
      }
    });
  }
  run.premise(pairs > 1000, "hardly any pair of faces touches");
}

// Every face must be found at its place: a small box around its centroid reports it, a ray at the
// centroid hits it, and the closest point to the centroid is as near as rounding allows.
void check_every_face_is_found(Run& run, const SourceMesh& mesh) {
  for_each_subject(mesh, [&](const Subject& subject) {
    const Frame& frame = BoundTree::of(subject.tree()).frame();
    for (const DecodedTriangle& t : decoded_triangles(subject.tree())) {
      const auto& c = t.triangle.corner;
      const Eigen::Vector3d middle = frame.to_object((c[0] + c[1] + c[2]) / 3);
      const double size = std::max((c[1] - c[0]).norm(), (c[2] - c[0]).norm()) * frame.scale;
      const Eigen::Vector3d margin = Eigen::Vector3d::Constant(size * 1e-3);
      bool found = false;
      const auto visit =
          overlap_box(subject.tree(), {middle - margin, middle + margin}, [&](const FaceRef& face) {
            found |= face.id == t.face;
            return true;
          });
      const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
      const auto hit =
          closest_hit(subject.tree(), {middle + size * normal, Eigen::Vector3d(-normal * size)});
      const auto closest = closest_point(subject.tree(), middle);
      run.check(visit.ok() && found && hit.ok() && hit.has_value() && closest.ok() &&
                    closest.has_value() && closest->distance <= size * 1e-6,
                [&] { return subject.name + ": face " + std::to_string(t.face); });
    }
  });
}

void tiny_triangles(Run& run) {
  for (const double scale : {1e-3, 1e-6}) {  // a millimetre and a micrometre in metres
    check_every_face_is_found(run, times(test::terrain(12, 1), scale));
    check_every_face_is_found(run, times(test::torus(20, 12), scale));
  }
}

void tiny_models(Run& run) {
  SourceMesh mesh = test::sphere(23, 22);
  run.premise(mesh.faces.size() == 968, "not 968 faces");
  for (const double scale : {1e-6, 1e-12, 1e-20}) {
    check_every_face_is_found(run, times(mesh, scale));
  }
}

// A flat surface in one plane, at coordinates that exceed its extent by any power of two.
void flat_and_far(Run& run) {
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const int exponent : {20, 24, 26, 41, 60, 64, 85, 100, 126}) {
      for (const int size : {0, -100}) {
        Eigen::Vector3d offset = Eigen::Vector3d::Zero();
        offset[axis] = std::ldexp(1.0, exponent);
        const SourceMesh mesh = plus(times(flat_square(5, axis), std::ldexp(1.0, size)), offset);
        check_every_face_is_found(run, mesh);
        check_every_face_is_found(run, in_double(mesh));
      }
    }
  }
}

}  // namespace

std::vector<Case> range_cases() {
  return {
      {"R01", "BoundsHoldTriangles", "every decoded box holds every triangle below it",
       "violations", 0, boxes_hold_triangles},
      {"R02", "BoundsBeyondHalfRange", "the same for coordinates beyond f16 (1e5 to 1e12, 1e-8)",
       "violations", 0, boxes_beyond_half_range},
      {"R03", "TraversalRounding", "poses that round everything lose no pair", "wrong pair sets", 0,
       traversal_rounding},
      {"R14", "TinyTriangles", "triangles of 1e-3 and 1e-6 are found one by one", "faces lost", 0,
       tiny_triangles},
      {"E14", "FlatAndFar", "faces in one plane, up to 2^226 extents from the origin", "faces lost",
       0, flat_and_far},
      {"R20", "TinyModels", "968 faces at scales 1e-6, 1e-12, 1e-20", "faces lost", 0, tiny_models},
  };
}

}  // namespace boxtree::robustness
