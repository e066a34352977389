// SPDX-License-Identifier: MIT
// Shapes that are cast where predicates flicker: grazing, in parallel, at rest, in contact at the
// start, from far away, along seams, into vertices. Long double decides.
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/robustness/brute_force.h"
#include "tests/robustness/cast_reference.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/support/infinity.h"

namespace boxtree::robustness {
namespace {

using Eigen::Vector3d;

using test::kInfinity;

class Random {
 public:
  explicit Random(std::uint64_t seed) : random_(seed) {}
  double part() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double unit() { return 2 * part() - 1; }
  Vector3d vector() { return {unit(), unit(), unit()}; }
  int integer(int low, int high) {
    return low + static_cast<int>(random_() % static_cast<std::uint64_t>(high - low + 1));
  }
  // A multiple of 2^-exponent in (-1, 1).
  double dyadic(int exponent) {
    const int most = (1 << exponent) - 1;
    return std::ldexp(integer(-most, most), -exponent);
  }
  std::size_t below(std::size_t n) { return static_cast<std::size_t>(random_() % n); }
  Vector3d vertex(const SourceMesh& mesh) { return mesh.positions[below(mesh.positions.size())]; }
  // Half extents that are exact in few bits.
  Vector3d half() { return Vector3d(integer(1, 8), integer(1, 8), integer(1, 8)) / 8; }

 private:
  std::mt19937_64 random_;
};

// Compares the casts of each store with the triangles of the source or of the grid, and those of
// all codecs bit by bit.
struct Touches {
  std::size_t casts = 0;     // that touch
  std::size_t contacts = 0;  // at starts
};
Touches check_casts(Run& run, const SourceMesh& mesh, const std::vector<Cast>& casts) {
  Touches touches;
  QuerySet queries;
  queries.casts = casts;
  for (const Store& store : kStores) {
    Answers first;
    for (const CodecInfo& codec : kCodecs) {
      const Subject subject = make_subject(mesh, codec.id, store);
      const Answers answers = run_query(subject.tree(), queries);
      if (codec.id == kCodecs.front().id) {
        first = answers;
        const CastReference reference = store.geometry == GeometryId::kExact
                                            ? CastReference(mesh)
                                            : CastReference(subject.tree());
        for (std::size_t i = 0; i < casts.size(); ++i) {
          const std::string name = subject.name + ": cast " + std::to_string(i);
          touches.casts += reference.check_cast(run, subject.tree(), casts[i], name) ? 1u : 0u;
          touches.contacts += reference.check_contacts(run, subject.tree(), casts[i].shape, name);
        }
        continue;
      }
      for (std::size_t i = 0; i < answers.size(); ++i) {
        run.check(answers[i] == first[i], [&] {
          return subject.name + ": answer " + std::to_string(i) + " is not that of " +
                 std::string(kCodecs.front().name);
        });
      }
    }
  }
  return touches;
}

// What came of all casts of a case.
struct Outcome {
  Touches touches;
  std::size_t casts = 0;
};

// Checks `count` casts for each mesh: make(mesh, bounds, i) is the ith.
template <class Make>
Outcome check_all(Run& run, const std::vector<SourceMesh>& meshes, std::size_t count,
                  const Make& make) {
  Outcome outcome;
  for (const SourceMesh& mesh : meshes) {
    const Eigen::AlignedBox3d bounds = bounds_of(mesh);
    std::vector<Cast> casts;
    for (std::size_t i = 0; i < count; ++i) casts.push_back(make(mesh, bounds, i));
    const Touches found = check_casts(run, mesh, casts);
    outcome.touches.casts += found.casts;
    outcome.touches.contacts += found.contacts;
    outcome.casts += casts.size() * kStores.size();
  }
  return outcome;
}

// The axis along which a floor is thin.
Eigen::Index thin_axis(const Eigen::AlignedBox3d& bounds) {
  Eigen::Index axis = 2;
  for (Eigen::Index k = 0; k < 2; ++k) axis = bounds.sizes()[k] == 0 ? k : axis;
  return axis;
}

// Floors of whole coordinates with seams: level along each axis, and a slope that stays exact.
std::vector<SourceMesh> floors() {
  std::vector<SourceMesh> meshes;
  for (Eigen::Index axis = 0; axis < 3; ++axis) meshes.push_back(flat_square(6, axis));
  SourceMesh slope = flat_square(6, 2);
  slope.name = "slope";
  for (std::size_t v = 0; v < slope.positions.size(); ++v) {
    const Vector3d p = slope.positions[v];
    slope.positions.f32[3 * v + 2] = static_cast<float>(p[0] / 4 + p[1] / 8);
  }
  meshes.push_back(slope);
  return meshes;
}

// Beside the bounds at a gap of 0 or of +-2^-k: a side, an edge or a vertex of the mesh is grazed.
void grazing(Run& run) {
  Random random(41);
  const auto make = [&](const SourceMesh& mesh, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const Eigen::Index axis = random.integer(0, 2), along = (axis + random.integer(1, 2)) % 3;
    const Vector3d half = random.half();
    std::vector<Shape> shapes = shapes_of(half);
    const std::size_t kind = i % shapes.size();
    // How far the shape reaches: the sphere is as wide as its first extent.
    const double reach = kind == 0 ? half[0] : half[axis];
    const double gap =
        i % 3 == 0 ? 0 : (i % 3 == 1 ? 1 : -1) * std::ldexp(1.0, -random.integer(8, 44));
    Vector3d at = random.vertex(mesh);
    const bool above = random.integer(0, 1) == 1;
    at[axis] = above ? bounds.max()[axis] + (reach + gap) : bounds.min()[axis] - (reach + gap);
    const double length = 2 * bounds.sizes()[along] + 8;
    const double sign = random.integer(0, 1) == 1 ? 1 : -1;
    at[along] -= sign * std::round(length / 2);
    return Cast{moved_to(shapes[kind], at), Motion{sign * length * Vector3d::Unit(along), 2}};
  };
  const Outcome outcome = check_all(run,
                                    {flat_square(6, 2), box_mesh({2, 1, 3}), icosphere_mesh(1),
                                     test::city(8, 2), snapped(test::torus(8, 6), -8)},
                                    run.count(15, 600), make);
  run.premise(outcome.touches.casts > outcome.casts / 4 && outcome.touches.casts < outcome.casts,
              "all touch, or hardly any");
}

// Flat sides come down flat onto faces, or turned by next to nothing; shapes without height move in
// the plane of the faces.
void parallel(Run& run) {
  Random random(42);
  const auto make = [&](const SourceMesh&, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const Eigen::Index axis = thin_axis(bounds);
    Vector3d half = random.half();
    const bool in_plane = i % 3 == 2;
    if (in_plane) half[axis] = 0;
    std::vector<Shape> shapes = shapes_of(half);
    Shape shape = shapes[1 + i % (shapes.size() - 1)];
    if (i % 3 == 1) {
      const Eigen::AngleAxisd turn(std::pow(10.0, -random.integer(3, 9)),
                                   Vector3d::Unit((axis + 1) % 3));
      std::visit(
          [&](auto& held) {
            if constexpr (requires { held.rotation; }) held.rotation = Eigen::Quaterniond(turn);
          },
          shape);
    }
    Vector3d at =
        bounds.center() +
        Vector3d(random.dyadic(4), random.dyadic(4), random.dyadic(4)).cwiseProduct(bounds.sizes());
    Motion motion;
    if (in_plane) {
      at[axis] = bounds.center()[axis];
      at[(axis + 1) % 3] -= 12;
      motion.direction = 12 * Vector3d::Unit((axis + 1) % 3);
      motion.t_max = 2;
    } else {
      at[axis] = bounds.max()[axis] + 3;
      motion.direction = -Vector3d::Unit(axis);
      if (i % 2 == 1) motion.direction[(axis + 1) % 3] = random.dyadic(3);
    }
    return Cast{moved_to(std::move(shape), at), motion};
  };
  const Outcome outcome = check_all(run, floors(), run.count(15, 600), make);
  run.premise(outcome.touches.casts > outcome.casts / 4, "hardly any touches");
}

// Motions without length, of length next to nothing and next to infinite, and without time.
void without_length(Run& run) {
  Random random(43);
  const auto make = [&](const SourceMesh& mesh, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const double size = bounds.sizes().maxCoeff();
    std::vector<Shape> shapes = shapes_of(0.2 * size * random.half());
    Vector3d at = bounds.center() + 0.7 * random.vector().cwiseProduct(bounds.sizes());
    if (i % 3 == 0) at = random.vertex(mesh);
    Motion motion;
    const Vector3d way = bounds.center() - at;
    const double times[] = {0, 1, kInfinity};
    motion.t_max = times[i % 3];
    const int lengths[] = {-1000, -300, -60, 60, 300};
    if (i % 7 == 1) motion = {way, 0};
    if (i % 7 >= 2) motion = {std::ldexp(1.0, lengths[i % 7 - 2]) * way, kInfinity};
    return Cast{moved_to(shapes[i % shapes.size()], at), motion};
  };
  const Outcome outcome = check_all(run, {test::city(8, 2), icosphere_mesh(1), test::soup(40, 3)},
                                    run.count(21, 700), make);
  run.premise(
      outcome.touches.casts > outcome.casts / 4 && outcome.touches.contacts > outcome.casts / 4,
      "hardly any touches");
}

// Around points of the surface, deep and hardly; beside a face at a gap of 0 or of +-2^-k; wholly
// inside, where nothing is touched.
void in_contact(Run& run) {
  Random random(44);
  const auto make = [&](const SourceMesh& mesh, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const Vector3d half = random.half();
    std::vector<Shape> shapes = shapes_of(half);
    const std::size_t kind = i % shapes.size();
    const std::size_t f = random.below(mesh.faces.size());
    const auto& corner = source_triangle(mesh, f, 0).corner;
    const double u = random.part(), v = (1 - u) * random.part();
    Vector3d at = corner[0] + u * (corner[1] - corner[0]) + v * (corner[2] - corner[0]);
    if (i % 4 == 1) at = corner[i % 3];
    if (i % 4 == 2) {
      const Eigen::Index axis = random.integer(0, 2);
      const double gap = i % 3 == 0 ? 0 : std::ldexp(random.unit(), -random.integer(8, 44));
      at = (4 * bounds.center()).array().round() / 4;
      at[axis] = bounds.max()[axis] + (kind == 0 ? half[0] : half[axis]) + gap;
    }
    if (i % 4 == 3) {
      shapes = shapes_of(0.1 * half);
      at = bounds.center();
    }
    const Vector3d out = at - bounds.center();
    return Cast{moved_to(shapes[kind], at), Motion{i % 2 == 0 ? out : Vector3d(-out), 2}};
  };
  const Outcome outcome = check_all(
      run, {box_mesh({2, 1, 3}), icosphere_mesh(1), test::slivers(40, 3), test::city(8, 2)},
      run.count(15, 600), make);
  run.premise(outcome.touches.casts > 50 && outcome.touches.contacts > 200, "hardly any touches");
}

// A million diagonals away and farther, past the mesh, too.
void from_afar(Run& run) {
  Random random(45);
  const auto make = [&](const SourceMesh& mesh, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const double diagonal = bounds.diagonal().norm();
    std::vector<Shape> shapes = shapes_of(0.1 * diagonal * random.half());
    const double far = i % 2 == 0 ? 1e6 : std::ldexp(1.0, random.integer(10, 40));
    const Vector3d to = i % 5 == 4 ? Vector3d(bounds.center() + 0.8 * diagonal * random.vector())
                                   : random.vertex(mesh);
    Vector3d from = to + far * diagonal * random.vector().normalized();
    if (i % 3 == 0) from = to + far * diagonal * Vector3d::Unit(random.integer(0, 2));
    return Cast{moved_to(shapes[i % shapes.size()], from), Motion{to - from, 2}};
  };
  const Outcome outcome = check_all(
      run, {test::city(8, 2), icosphere_mesh(1), test::slivers(40, 3)}, run.count(15, 600), make);
  run.premise(outcome.touches.casts > outcome.casts / 2, "hardly any touches");
}

// Onto seams of faces in one plane, along them in their plane, and down along them.
void along_seams(Run& run) {
  Random random(46);
  const auto make = [&](const SourceMesh& mesh, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const Eigen::Index axis = thin_axis(bounds);
    const auto& corner = source_triangle(mesh, random.below(mesh.faces.size()), 0).corner;
    const std::size_t c = random.below(3);
    const Vector3d seam = corner[(c + 1) % 3] - corner[c];
    const Vector3d on = corner[c] + 0.5 * (1 + random.dyadic(4)) * seam;
    std::vector<Shape> shapes = shapes_of(random.half());
    Vector3d from = on - 8 * seam;
    Motion motion{seam, 16};
    if (i % 3 != 0) {
      from = on + 4 * Vector3d::Unit(axis);
      motion.direction = on - from;
    }
    if (i % 3 == 2) {
      from -= 2 * seam;
      motion.direction += 2 * seam;
    }
    return Cast{moved_to(shapes[i % shapes.size()], from), motion};
  };
  const Outcome outcome = check_all(run, floors(), run.count(15, 600), make);
  run.premise(outcome.touches.casts > outcome.casts / 2, "hardly any touches");
}

// The middle of a shape, or a corner of it, moves exactly into a vertex.
void into_vertices(Run& run) {
  Random random(47);
  std::vector<SourceMesh> meshes = {icosphere_mesh(1), test::city(8, 2),
                                    snapped(test::torus(8, 6), -8), test::soup(40, 3),
                                    test::slivers(40, 3)};
  const auto make = [&](const SourceMesh& mesh, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const double size = std::ldexp(1.0, std::ilogb(bounds.sizes().maxCoeff()));
    const Vector3d half = 0.25 * size * random.half();
    std::vector<Shape> shapes = shapes_of(half);
    const Vector3d vertex = random.vertex(mesh);
    const Vector3d way = 2 * size * Vector3d(random.dyadic(3), random.dyadic(3), random.dyadic(3));
    Vector3d lead = Vector3d::Zero();  // what meets the vertex, of the shape
    if (i % 3 == 1) {
      for (Eigen::Index k = 0; k < 3; ++k) lead[k] = std::copysign(half[k], way[k]);
    }
    if (i % 3 == 2) lead = half[0] * Vector3d::Unit(0);
    return Cast{moved_to(shapes[i % shapes.size()], vertex - lead - way), Motion{way, 2}};
  };
  const Outcome outcome = check_all(run, meshes, run.count(15, 600), make);
  run.premise(outcome.touches.casts > outcome.casts / 2, "hardly any touches");
}

// Every kind of mesh, near and far from the origin, of every size; shapes turned by any rotation,
// by next to none, by right angles, with quaternions of any length.
void kinds_sizes_poses(Run& run) {
  Random random(48);
  std::vector<SourceMesh> meshes = test::all_kinds();
  meshes.push_back(times(icosphere_mesh(1), 1e-20));
  meshes.push_back(times(icosphere_mesh(1), 1e20));
  meshes.push_back(in_double(times(icosphere_mesh(1), 1.0 / 3)));
  meshes.push_back(plus(icosphere_mesh(1), Vector3d(1e5, -2e4, 3e5)));
  meshes.push_back(times(test::city(8, 2), Vector3d(1, 1e-4, 1e4)));
  const auto make = [&](const SourceMesh&, const Eigen::AlignedBox3d& bounds, std::size_t i) {
    const double diagonal = bounds.diagonal().norm();
    const Vector3d sizes = bounds.sizes().cwiseMax(diagonal / 64);
    const double reach = 0.1 * diagonal * std::pow(10.0, random.unit());
    std::vector<Shape> shapes = shapes_of(reach * (random.vector() + Vector3d::Constant(1.1)));
    Shape shape = shapes[i % shapes.size()];
    decltype(OrientedBox::rotation) turn(random.unit(), random.unit(), random.unit(),
                                         random.unit());
    if (i % 4 == 1) turn = decltype(turn)(1, std::pow(10.0, -random.integer(3, 12)), 0, 0);
    if (i % 4 == 2) turn = decltype(turn)(3, 0, -3, 0);
    if (i % 4 == 3) turn.coeffs() *= std::ldexp(1.0, random.integer(-100, 100));
    std::visit(
        [&](auto& held) {
          if constexpr (requires { held.rotation; }) held.rotation = turn;
        },
        shape);
    const Vector3d from = bounds.center() + random.vector().cwiseProduct(sizes);
    const Vector3d to = bounds.center() + 0.5 * random.vector().cwiseProduct(sizes);
    return Cast{moved_to(std::move(shape), from), Motion{to - from, 1.5}};
  };
  const Outcome outcome = check_all(run, meshes, run.count(8, 300), make);
  run.premise(outcome.touches.casts > outcome.casts / 4, "hardly any touches");
}

}  // namespace

std::vector<Case> cast_cases() {
  return {
      {"E15", "CastsThatGraze", "casts beside sides, edges, vertices at gaps of 0 and +-2^-k",
       "wrong answers", 0, grazing},
      {"E16", "CastsInParallel", "flat sides onto faces, shapes in the planes of faces",
       "wrong answers", 0, parallel},
      {"E17", "CastsWithoutLength", "motions of length 0, of 2^-1000 to 2^300, without time",
       "wrong answers", 0, without_length},
      {"E18", "CastsInContact", "casts and contacts of shapes that touch at the start",
       "wrong answers", 0, in_contact},
      {"E19", "CastsFromAfar", "casts from a million and 2^40 diagonals away", "wrong answers", 0,
       from_afar},
      {"E20", "CastsAlongSeams", "casts onto and along seams of faces in one plane",
       "wrong answers", 0, along_seams},
      {"E21", "CastsIntoVertices", "casts whose middle or corner meets a vertex", "wrong answers",
       0, into_vertices},
      {"E22", "CastsOfAllKinds", "casts at every kind, size and place of mesh, shapes turned",
       "wrong answers", 0, kinds_sizes_poses},
  };
}

}  // namespace boxtree::robustness
