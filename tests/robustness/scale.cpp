// SPDX-License-Identifier: MIT
// Sizes, distances from the origin and floating-point states that must not affect results.
#include <cfenv>
#include <cmath>
#include <random>

#include "runtime/paper/any_codec.h"
#include "runtime/query/pair_walk.h"
#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/support/float_state.h"

namespace boxtree::robustness {
namespace {

// Bits are compared, which takes no time.
constexpr QueryCounts kScaledQueries = {200, 60, 60, 60, 6, 40};

// Mesh and queries scaled by 2^exponent give the same bits scaled by 2^exponent, in every codec and
// store.
void check_scaling(Run& run, const SourceMesh& mesh, const std::vector<int>& exponents,
                   const std::vector<Store>& stores = {kStores.begin(), kStores.end()}) {
  const QuerySet queries = queries_for(mesh, 6, kScaledQueries);
  for (const Store& store : stores) {
    for (const CodecInfo& codec : kCodecs) {
      const Subject unit = make_subject(mesh, codec.id, store);
      const Answers expected = run_query(unit.tree(), queries);
      run.premise(count_hits(expected) > 100, unit.name + ": hardly any answer names a face");
      for (const int exponent : exponents) {
        const Subject other = make_subject(times(mesh, std::ldexp(1.0, exponent)), codec.id, store);
        const Answers answers = run_query(other.tree(), scaled(queries, exponent), exponent);
        const std::size_t differing = count_differing(answers, expected);
        run.check(differing == 0, [&] {
          return other.name + ", 2^" + std::to_string(exponent) + ": " + std::to_string(differing) +
                 " answers differ";
        });
      }
    }
  }
}

void exponents(Run& run) {
  // Multiples of 2^-12, so that they are exact in f32 at 2^-100.
  const SourceMesh mesh = snapped(test::torus(20, 14), -12);
  check_scaling(run, mesh, {-100, -60, -13, 13, 60, 100});
  check_scaling(run, in_double(mesh), {-950, -500, 500, 950});
}

// Cuts, planes and grids are relative: the position of a mesh must not affect the number of visits.
void far_from_origin(Run& run) {
  std::mt19937_64 random(5);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-53 - 0.5; };
  struct Count {
    std::uint64_t* visits;
    void node_pair(NodeRef, bool, NodeRef, bool) const { ++*visits; }
    void leaf_pair(NodeRef, NodeRef) const { ++*visits; }
  };
  std::vector<Eigen::Vector3d> shifts;
  for (int i = 0; i < 20; ++i) shifts.emplace_back(100 * unit(), 100 * unit(), 100 * unit());
  const auto visits = [&](const Tree& queried) {
    const BoundTree& tree = BoundTree::of(queried);
    std::uint64_t count = 0;
    for (const Eigen::Vector3d& shift : shifts) {
      Pose pose = Pose::Identity();
      pose.translation() = shift;
      const auto relative = RelativePose::make(tree, Pose::Identity(), tree, pose);
      with_codec(tree, [&]<class C>(const C& codec) {
        PairBound bound(tree, tree, nullptr);
        static_cast<void>(PairWalk<C, C, Count>(
                              tree, codec, tree, codec, *relative,
                              [](const FacePair&) { return true; }, bound, Count{&count})
                              .run());
      });
    }
    return static_cast<double>(count);
  };
  const SourceMesh sphere = times(test::sphere(24, 36), 50);
  for (const double distance : {1e4, 1e5, 1e6}) {
    const Eigen::Vector3d offset(distance, -distance / 2, distance / 3);
    // Positions rounded to f32 at the offset, moved back without rounding: the same shape at both
    // places.
    const SourceMesh away = plus(sphere, offset);
    const SourceMesh here = plus(away, -offset.cast<float>().cast<double>());
    for (const Store& store : kStores) {
      for (const CodecInfo& codec : kCodecs) {
        const Subject at_origin = make_subject(here, codec.id, store);
        const Subject far_away = make_subject(away, codec.id, store);
        run.measure(visits(far_away.tree()) / visits(at_origin.tree()));
      }
    }
  }
}

// Runs the same queries with and without a floating-point state; cooks without it.
template <class State>
void check_state(Run& run, const SourceMesh& mesh) {
  const QuerySet queries = queries_for(mesh, 7, kScaledQueries);
  for_each_subject(mesh, [&](const Subject& subject) {
    const Answers expected = run_query(subject.tree(), queries);
    Answers answers;
    {
      const State state;
      answers = run_query(subject.tree(), queries);
    }
    const std::size_t differing = count_differing(answers, expected);
    run.check(differing == 0,
              [&] { return subject.name + ": " + std::to_string(differing) + " answers differ"; });
  });
}

// Lattice meshes in f32 subnormals, and normal numbers that are subnormal in tree space.
std::vector<SourceMesh> meshes_with_subnormals() {
  SourceMesh whole = snapped(times(test::torus(10, 8), 64), 0);
  SourceMesh mixed = times(test::soup(60, 3), 1e-30);
  mixed.positions.f32[0] = 1e30F;
  mixed.positions.f32[4] = -1e30F;
  mixed.name = "1e30 among 1e-30";
  return {times(whole, 0x1p-149), times(whole, 0x1p-140), mixed, test::torus(10, 8)};
}

void flush_to_zero(Run& run) {
  run.premise(test::FlushToZero::is_supported(), "no such state on this machine");
  {
    const test::FlushToZero state;
    volatile float tiny = 0x1p-140F;
    run.premise(tiny * 1.0F == 0.0F, "the state has no effect");
  }
  for (const SourceMesh& mesh : meshes_with_subnormals()) check_state<test::FlushToZero>(run, mesh);
  // Files cooked in that state are identical byte for byte.
  for (const SourceMesh& mesh : meshes_with_subnormals()) {
    for (const CodecInfo& codec : kCodecs) {
      const auto expected = test::cook_bytes(mesh, codec.id);
      const test::FlushToZero state;
      const bool is_same = test::cook_bytes(mesh, codec.id) == expected;
      run.check(is_same,
                [&] { return mesh.name + ": cooked to other bytes, " + std::string(codec.name); });
    }
  }
}

void rounding_modes(Run& run) {
  for (const SourceMesh& mesh : {test::torus(16, 12), test::city(12, 2), test::soup(120, 3)}) {
    check_state<test::RoundingMode<FE_UPWARD>>(run, mesh);
    check_state<test::RoundingMode<FE_DOWNWARD>>(run, mesh);
    check_state<test::RoundingMode<FE_TOWARDZERO>>(run, mesh);
  }
}

// Multiples of the smallest f32 behave like the corresponding integers.
void denormal_extents(Run& run) {
  const SourceMesh whole = snapped(times(test::torus(16, 12), 4096), 0);
  check_scaling(run, whole, {-149, -145, -130});
  check_scaling(run, in_double(whole), {-960});
  check_scaling(run, in_double(whole), {-1000, -1010}, {kExactStore});
}

void huge_among_tiny(Run& run) {
  for (const double huge : {1e30, 1e15}) {
    SourceMesh mesh = times(test::soup(200, 3), 1e-30);
    mesh.name = "one huge triangle";
    const std::vector<Corners> large = {{Eigen::Vector3d(-huge, -huge, 0),
                                         Eigen::Vector3d(huge, -huge, 0),
                                         Eigen::Vector3d(0, huge, 1e-31)}};
    const SourceMesh extra = from_triangles("", large);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.f32.insert(mesh.positions.f32.end(), extra.positions.f32.begin(),
                              extra.positions.f32.end());
    mesh.faces.push_back({{first, first + 1, first + 2, cooker::kNoCorner}});
    for (const CodecInfo& codec : kCodecs) {
      const Subject subject = make_subject(mesh, codec.id, kExactStore);
      const WalkFigures figures = walk_tree(subject.tree());
      run.check(figures.escapes == 0 && figures.missed == 0, [&] { return subject.name; });
      // Queries at both scales.
      check_brute_force(run, subject, queries_for(mesh, 8));
      check_brute_force(run, subject,
                        queries_for(times(test::soup(200, 3), 1e-30), 9, {200, 60, 60, 60, 0, 10}));
    }
  }
}

}  // namespace

std::vector<Case> scale_cases() {
  return {
      {"R05", "BakedFarFromOrigin", "visits of a mesh at 1e4, 1e5, 1e6 over those at the origin",
       "largest ratio", 1.005, far_from_origin},
      {"R06", "Exponents", "sizes of 2^-100 to 2^100 (f64: 2^-950 to 2^950) give the same bits",
       "trees that differ", 0, exponents},
      {"R07", "FlushToZero", "answers and files with FTZ and DAZ set", "trees that differ", 0,
       flush_to_zero},
      {"E04", "DenormalExtents", "meshes of subnormal f32, f64 down to 2^-1010",
       "trees that differ", 0, denormal_extents},
      {"E05", "HugeAmongTiny", "one triangle of 1e30 among many of 1e-30", "wrong answers", 0,
       huge_among_tiny},
      {"E10", "RoundingModes", "answers when the caller rounds up, down or toward zero",
       "trees that differ", 0, rounding_modes},
  };
}

}  // namespace boxtree::robustness
