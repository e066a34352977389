// SPDX-License-Identifier: MIT
// S3: boxes at rest on the exact level, which is then swapped for one on a grid. Where the surface
// comes up by d, the springs of stiffness k under a box are given k d^2 / 2 more than they hold at
// rest, and the box jumps as high as that lifts it. Hence the rule for the cooker's tolerance.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "cooker/quantise/grid.h"
#include "format/half.h"
#include "tests/stiff/cases.h"
#include "tests/stiff/meshes.h"
#include "tests/stiff/world.h"

namespace boxtree::stiff {
namespace case_swap {
namespace {

constexpr unsigned kSteps = 16;
constexpr double kLevelSize = 16;
constexpr double kHalf = 0.2;  // a box of 0.4 m: L
constexpr double kMass = 1;
constexpr double kStiffness = 1e6;  // under a box, of all springs
constexpr double kSprings = 4;
constexpr double kRestDepth = kMass * kGravity / kStiffness;

constexpr double kEnergyLimit = 1e-3 * kMass * kGravity * 2 * kHalf;

double step_seconds() {
  return 0.05 / std::sqrt(kStiffness / kMass);
}

World make_world(const Shape& level, const Shape& body) {
  const double omega = std::sqrt(kStiffness / kMass);
  World world(level, {kStiffness / kSprings, 2 * kMass * omega / kSprings}, {0, 0, -kGravity});
  for (unsigned i = 0; i < kSteps; ++i) {
    Body box = make_body(body, Eigen::Vector3d::Constant(kHalf), kMass);
    box.position = tread_middle(i, kSteps, kLevelSize);
    box.position.z() = tread_height(level, box.position) + kHalf - kRestDepth;
    world.bodies.push_back(box);
  }
  return world;
}

struct Outcome {
  std::uint64_t settled_bits = 0;
  std::uint64_t final_bits = 0;
  double moved = 0;      // how far treads moved at most: d
  double injected = 0;   // largest of all boxes, J
  double predicted = 0;  // k d^2 / 2 of the largest d upward, J
  double jump = 0;       // highest of all boxes above their new rest, m
  std::uint64_t toggles = 0;
  std::vector<std::pair<double, double>> track;  // seconds, height above rest of the highest, m
};

Outcome simulate(const Shape& exact, const Shape& swapped, const Shape& body, double seconds) {
  World world = make_world(exact, body);
  constexpr int kSettleSteps = 400;  // 20 / omega, damped critically, from the depth of rest
  for (int i = 0; i < kSettleSteps; ++i) world.step_verlet(step_seconds());
  Outcome outcome;
  outcome.settled_bits = world.state_hash();

  world.set_level(swapped);
  world.set_law({kStiffness / kSprings, 0});
  std::vector<double> rest(kSteps);
  for (unsigned i = 0; i < kSteps; ++i) {
    const Body& box = world.bodies[i];
    const double height = tread_height(swapped, box.position);
    const double up = height - tread_height(exact, box.position);
    rest[i] = height + kHalf - kRestDepth;
    outcome.moved = std::max(outcome.moved, std::abs(up));
    if (up > 0) outcome.predicted = std::max(outcome.predicted, kStiffness * up * up / 2);
  }
  world.find_contacts();
  std::vector<double> held(kSteps, -kStiffness * kRestDepth * kRestDepth / 2);
  for (const Contact& contact : world.contacts()) {
    held[contact.body] += kStiffness / kSprings * contact.depth * contact.depth / 2;
  }
  for (unsigned i = 0; i < kSteps; ++i) {
    const double lifted = world.bodies[i].position.z() - rest[i];
    outcome.injected = std::max(outcome.injected, held[i] + kMass * kGravity * lifted);
  }
  const std::uint64_t toggles_before = world.toggles();
  const auto steps = static_cast<std::size_t>(seconds / step_seconds());
  for (std::size_t step = 0; step < steps; ++step) {
    world.step_verlet(step_seconds());
    double highest = -kRestDepth;
    for (unsigned i = 0; i < kSteps; ++i) {
      highest = std::max(highest, world.bodies[i].position.z() - rest[i]);
    }
    outcome.jump = std::max(outcome.jump, highest);
    if (step % std::max<std::size_t>(1, steps / 400) == 0) {
      outcome.track.emplace_back(step_seconds() * static_cast<double>(step), highest);
    }
  }
  outcome.toggles = world.toggles() - toggles_before;
  outcome.final_bits = world.state_hash();
  return outcome;
}

// What formats of 16-bit vertices do: exact geometry of a mesh whose coordinates were rounded.
SourceMesh with_half_vertices(SourceMesh mesh) {
  for (float& coordinate : mesh.positions.f32) {
    const float size = half_to_float(half_to_nearest(std::abs(coordinate)));
    coordinate = std::copysign(size, coordinate);
  }
  return mesh;
}

}  // namespace
}  // namespace case_swap

CaseResult run_swap(const Scale& scale) {
  using namespace case_swap;
  using enum Row::Limit;
  CaseResult result;
  SourceMesh mesh = stairs(kSteps, 1, kLevelSize);
  // Up to between 4 and 8 m, where f16 has steps of 4 mm.
  for (std::size_t i = 2; i < mesh.positions.f32.size(); i += 3) mesh.positions.f32[i] += 4.1f;
  const std::vector<Shape> exact = all_shapes(mesh, exact_store());
  const std::vector<Shape> bodies =
      all_shapes(box(Eigen::Vector3d::Constant(kHalf)), exact_store());
  const double rule = std::sqrt(2e-3 * kMass * kGravity * 2 * kHalf / kStiffness);
  const double unseen = 0.1 * kMass * kGravity / kStiffness;
  struct Kind {
    Store store;
    bool half_vertices;
    bool within_rule;
  };
  const std::vector<Kind> kinds = {
      {exact_store(), true, false},          {grid_store(14), false, false},
      {grid_store(16), false, false},        {tolerance_store(rule), false, true},
      {grid_store(18), false, true},         {grid_store(21), false, true},
      {tolerance_store(unseen), false, true}};
  cooker::PagePlot plot{"time after the swap, s", "highest box above rest, mm", {}};
  plot.lines = true;
  for (const Kind& kind : kinds) {
    const SourceMesh other = kind.half_vertices ? with_half_vertices(mesh) : mesh;
    const std::vector<Shape> swapped = all_shapes(other, kind.store);
    std::vector<std::uint64_t> bits;
    Outcome outcome;
    const double seconds = scale.quick ? 0.03 : 0.5;
    for (std::size_t i = 0; i < exact.size(); ++i) {
      outcome = simulate(exact[i], swapped[i], bodies[i], seconds);
      bits.push_back(outcome.settled_bits);
      bits.push_back(outcome.final_bits);
    }
    const std::string name = kind.half_vertices ? "f16 vertices" : kind.store.name;
    const auto add = [&](const std::string& what, double figure, Row::Limit relation,
                         double limit) {
      result.rows.push_back({"S3", name, what, figure, relation, limit});
    };
    add("d: how far treads moved, m", outcome.moved, kind.within_rule ? kAtMost : kNone, rule);
    add("k d^2 / 2, J", outcome.predicted, kNone, 0);
    // Beyond the rule it is the control: 16 bits and coarser must be seen to kick.
    add("injected energy, J", outcome.injected, kind.within_rule ? kAtMost : kAtLeast,
        kEnergyLimit);
    add("highest jump, m", outcome.jump, kind.within_rule ? kAtMost : kNone, 1e-3 * 2 * kHalf);
    if (kind.store.name == tolerance_store(unseen).name) {
      add("corners on or off", static_cast<double>(outcome.toggles), kAtMost, 0);
    }
    add(fmt::format("different final states of {}", exact.size()),
        static_cast<double>(distinct(bits)) - 1, kAtMost, 1);
    if (kind.store.grid && kind.store.grid->bits != 18 && plot.series.size() < 4 &&
        !kind.store.grid->tolerance) {
      plot.series.push_back({kind.store.name, {}});
      for (const auto& [at, height] : outcome.track) {
        plot.series.back().points.push_back({at, 1e3 * height, ""});
      }
    }
  }
  result.plots.push_back({"s3-jump", plot});
  return result;
}

}  // namespace boxtree::stiff
