// SPDX-License-Identifier: MIT
// S5: a heavy box on a light plate on the ground, the stiffness chosen for the plate. Explicit
// steps follow the lightest body's frequency and need ever more of them; the implicit step does
// not.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tests/stiff/cases.h"
#include "tests/stiff/meshes.h"
#include "tests/stiff/world.h"

namespace boxtree::stiff {
namespace case_stack {
namespace {

constexpr unsigned kSteps = 4;
constexpr double kLevelSize = 8;
constexpr double kPlateMass = 1;
constexpr double kSprings = 4;  // ground to plate, and plate to box
constexpr double kStiffness = 1e8;
constexpr unsigned kStep = 2;  // of the stairs, on which they stand

const Eigen::Vector3d kPlateHalf(0.25, 0.25, 0.05);
const Eigen::Vector3d kBoxHalf(0.2, 0.2, 0.2);

struct Group {
  std::vector<Shape> levels = all_shapes(stairs(kSteps, 8, kLevelSize), exact_store());
  std::vector<Shape> plates = all_shapes(box(kPlateHalf), exact_store());
  std::vector<Shape> boxes = all_shapes(box(kBoxHalf), exact_store());
};

struct Outcome {
  std::uint64_t hash = 0;
  double depth = 0;  // of the plate in the ground at the end
  std::uint64_t toggles = 0;
  std::vector<std::pair<double, double>> track;  // seconds, depth
};

struct Run {
  double mass;  // of the box
  bool implicit;
  double step_seconds;
  std::size_t steps;

  // What carries most is damped critically.
  [[nodiscard]] double damping() const {
    const double carried = implicit ? mass + kPlateMass : kPlateMass;
    return 2 * std::sqrt(kSprings * kStiffness * carried) / kSprings;
  }
};

Outcome simulate(const Group& group, std::size_t codec, const Run& run) {
  World world(group.levels[codec], {kStiffness, run.damping()}, {0, 0, -kGravity});
  const Eigen::Vector3d ground = tread_middle(kStep, kSteps, kLevelSize);
  Body plate = make_body(group.plates[codec], kPlateHalf, kPlateMass);
  plate.position = ground + Eigen::Vector3d(0.01, 0.013, kPlateHalf.z());
  Body heavy = make_body(group.boxes[codec], kBoxHalf, run.mass);
  // Turned a little: no edge lies above an edge.
  heavy.orientation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ());
  heavy.position = plate.position + Eigen::Vector3d(0, 0, kPlateHalf.z() + kBoxHalf.z());
  world.bodies = {plate, heavy};

  Outcome outcome;
  const auto depth = [&] {
    return ground.z() + kPlateHalf.z() - world.bodies.front().position.z();
  };
  std::uint64_t toggles_at_half = 0;
  for (std::size_t step = 0; step < run.steps; ++step) {
    run.implicit ? world.step_implicit(run.step_seconds)
                 : world.step_symplectic_euler(run.step_seconds);
    if (step == run.steps / 2) toggles_at_half = world.toggles();
    if (step % std::max<std::size_t>(1, run.steps / 300) == 0) {
      outcome.track.emplace_back(run.step_seconds * static_cast<double>(step), depth());
    }
  }
  outcome.hash = world.state_hash();
  outcome.depth = depth();
  outcome.toggles = world.toggles() - toggles_at_half;
  return outcome;
}

}  // namespace
}  // namespace case_stack

CaseResult run_stack(const Scale& scale) {
  using namespace case_stack;
  using enum Row::Limit;
  CaseResult result;
  const Group group;
  // The plate alone between its springs to both sides.
  const double omega = std::sqrt(2 * kSprings * kStiffness / kPlateMass);
  const double explicit_step = 0.1 / omega;
  constexpr double kImplicitStep = 1e-3;
  const std::size_t implicit_steps = scale.quick ? 1500 : 3000;
  std::vector<Run> runs = {{1, true, kImplicitStep, implicit_steps},
                           {1e2, true, kImplicitStep, implicit_steps},
                           {1e4, true, kImplicitStep, implicit_steps},
                           {1e6, true, kImplicitStep, implicit_steps},
                           {1, false, explicit_step, 5000}};
  if (!scale.quick) runs.push_back({1e2, false, explicit_step, 60000});
  cooker::PagePlot plot{"time, s", "log10 of the share that the depth is off rest", {}};
  plot.lines = true;
  for (const Run& run : runs) {
    std::vector<std::uint64_t> hashes;
    Outcome outcome;
    for (std::size_t i = 0; i < group.levels.size(); ++i) {
      outcome = simulate(group, i, run);
      hashes.push_back(outcome.hash);
    }
    const double wanted = (run.mass + kPlateMass) * kGravity / (kSprings * kStiffness);
    const std::string name =
        fmt::format("M {} m, {} {:.2g} s", power_name(run.mass),
                    run.implicit ? "implicit" : "symplectic", run.step_seconds);
    const auto add = [&](const std::string& what, double figure, double limit) {
      result.rows.push_back({"S5", name, what, figure, kAtMost, limit});
    };
    add("depth off (M + m) g / n k, share", std::abs(outcome.depth / wanted - 1), 0.01);
    add("corners on or off, last half", static_cast<double>(outcome.toggles), 0);
    add(fmt::format("different final states of {}", hashes.size()),
        static_cast<double>(distinct(hashes)), 1);
    if (!run.implicit) continue;
    plot.series.push_back({fmt::format("M {} m", power_name(run.mass)), {}});
    for (const auto& [seconds, depth] : outcome.track) {
      // As near as double comes.
      const double off = std::max(std::abs(depth / wanted - 1), 1e-16);
      plot.series.back().points.push_back({seconds, std::log10(off), ""});
    }
  }
  result.plots.push_back({"s5-depth", plot});
  return result;
}

}  // namespace boxtree::stiff
