// SPDX-License-Identifier: MIT
// S1: sixteen boxes come to rest on stairs. The codec must not show in the last bit of what they
// do, at any stiffness; boxes of a tree that are rounded to nearest drop contacts as soon as m g /
// n k is less than what they fall short by.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tests/stiff/cases.h"
#include "tests/stiff/meshes.h"
#include "tests/stiff/world.h"

namespace boxtree::stiff {
namespace case_rest {
namespace {

constexpr unsigned kSteps = 16;  // of the stairs, a box on each
constexpr double kLevelSize = 8;
constexpr double kHalf = 0.2;
constexpr double kMass = 1;
constexpr double kSprings = 4;  // corners that carry a box
constexpr double kDampingRatio = 0.5;

enum class Stepper { kSymplectic, kImplicit };

struct Setting {
  double stiffness;
  Stepper stepper;
  double step_seconds;
  std::size_t steps;

  [[nodiscard]] double rest_depth() const { return kMass * kGravity / (kSprings * stiffness); }
};

Setting setting_of(double stiffness, Stepper stepper, const Scale& scale) {
  const double omega = std::sqrt(kSprings * stiffness / kMass);
  Setting setting{stiffness, stepper, 0.1 / omega, 0};
  constexpr double kImplicitStep = 1e-3;
  if (stepper == Stepper::kImplicit) setting.step_seconds = kImplicitStep;
  constexpr double kSeconds = 3;
  const double most = scale.quick ? 600 : 20000;
  setting.steps = static_cast<std::size_t>(std::min(kSeconds / setting.step_seconds, most));
  if (stepper == Stepper::kImplicit && scale.quick) setting.steps = 600;
  return setting;
}

struct Sample {
  double seconds;
  std::vector<double> depth;  // of each body's centre below where it would just touch
  double energy;
  std::uint64_t toggles;
};

struct Outcome {
  std::uint64_t hash = 0;
  double rms_g = 0;           // of the worst body, last half
  std::uint64_t toggles = 0;  // last half
  unsigned restless = 0;      // bodies whose rms is above the limit
  double sink = 0;            // deepest below the depth of rest, last half
  std::vector<Sample> samples;
};

constexpr double kRmsLimitG = 0.01;

World make_world(const Shape& level, const Shape& body, const Setting& setting) {
  const double omega = std::sqrt(kSprings * setting.stiffness / kMass);
  World world(level, {setting.stiffness, 2 * kDampingRatio * kMass * omega / kSprings},
              {0, 0, -kGravity});
  // At most a millimetre, and no more than is fallen while there is time to settle.
  const double fall_seconds = (setting.steps > 1000 ? 20 : 10) / omega;
  const double drop = std::min(1e-3, kGravity * fall_seconds * fall_seconds / 2);
  for (unsigned i = 0; i < kSteps; ++i) {
    Body box = make_body(body, Eigen::Vector3d::Constant(kHalf), kMass);
    box.position = tread_middle(i, kSteps, kLevelSize);
    box.position.y() = -3.6 + 0.48 * i + 0.013;
    box.position.z() = tread_height(level, box.position) + kHalf + drop;
    // Up to 12 degrees: the diagonal still stands on the tread.
    box.orientation = Eigen::AngleAxisd(0.014 * i, Eigen::Vector3d::UnitZ());
    world.bodies.push_back(box);
  }
  return world;
}

Outcome simulate(const Shape& level, const Shape& body, const Setting& setting) {
  World world = make_world(level, body, setting);
  Outcome outcome;
  std::vector<double> squares(kSteps, 0);
  std::vector<double> treads;
  for (const Body& box : world.bodies) treads.push_back(tread_height(level, box.position));
  const auto depth_of_body = [&](unsigned i) {
    return treads[i] + kHalf - world.bodies[i].position.z();
  };
  const std::size_t half = setting.steps / 2;
  constexpr std::size_t kSamples = 250;
  std::uint64_t toggles_at_half = 0;
  for (std::size_t step = 0; step < setting.steps; ++step) {
    if (setting.stepper == Stepper::kSymplectic) {
      world.step_symplectic_euler(setting.step_seconds);
    } else {
      world.step_implicit(setting.step_seconds);
    }
    if (step + 1 == half) toggles_at_half = world.toggles();
    for (unsigned i = 0; i < kSteps && step >= half; ++i) {
      squares[i] += world.bodies[i].acceleration.squaredNorm();
      outcome.sink = std::max(outcome.sink, depth_of_body(i) - setting.rest_depth());
    }
    if (step % std::max<std::size_t>(1, setting.steps / kSamples) == 0) {
      world.find_contacts();
      Sample sample{
          setting.step_seconds * static_cast<double>(step), {}, world.energy(), world.toggles()};
      for (unsigned i = 0; i < kSteps; ++i) sample.depth.push_back(depth_of_body(i));
      outcome.samples.push_back(std::move(sample));
    }
  }
  outcome.hash = world.state_hash();
  outcome.toggles = world.toggles() - toggles_at_half;
  for (const double sum : squares) {
    const double rms = std::sqrt(sum / static_cast<double>(setting.steps - half)) / kGravity;
    outcome.rms_g = std::max(outcome.rms_g, rms);
    outcome.restless += rms > kRmsLimitG ? 1u : 0u;
  }
  return outcome;
}

struct Group {
  std::vector<Shape> levels;
  std::vector<Shape> bodies;
  std::string store;
};

Group group_of(const Store& store) {
  return {all_shapes(stairs(kSteps, kSteps, kLevelSize), store),
          all_shapes(box(Eigen::Vector3d::Constant(kHalf)), exact_store()), store.name};
}

// All settings of the group at one stiffness; returns one of the equal outcomes.
Outcome add_rows(const Group& group, const Setting& setting, std::vector<Row>& rows) {
  std::vector<std::uint64_t> hashes;
  Outcome worst;
  for (std::size_t i = 0; i < group.levels.size(); ++i) {
    Outcome outcome = simulate(group.levels[i], group.bodies[i], setting);
    hashes.push_back(outcome.hash);
    outcome.rms_g = std::max(outcome.rms_g, worst.rms_g);
    outcome.toggles = std::max(outcome.toggles, worst.toggles);
    worst = std::move(outcome);
  }
  const std::string name =
      fmt::format("k {} N/m, {}, {}", power_name(setting.stiffness),
                  setting.stepper == Stepper::kSymplectic ? "symplectic" : "implicit", group.store);
  const std::string states = fmt::format("different final states of {}", hashes.size());
  using enum Row::Limit;
  rows.push_back({"S1", name, states, static_cast<double>(distinct(hashes)), kAtMost, 1});
  rows.push_back({"S1", name, "rms acceleration, last half, g", worst.rms_g, kAtMost, kRmsLimitG});
  rows.push_back(
      {"S1", name, "corners on or off, last half", static_cast<double>(worst.toggles), kAtMost, 0});
  return worst;
}

// From this stiffness on m g / 4 k is below what f16 rounded to nearest is off by on an 8 m level.
constexpr double kNearestFails = 1e5;

Outcome add_control(const Shape& nearest, const Shape& body, const Setting& setting,
                    std::vector<Row>& rows) {
  Outcome outcome = simulate(nearest, body, setting);
  const std::string name =
      fmt::format("k {} N/m, control: f16 to nearest", power_name(setting.stiffness));
  using enum Row::Limit;
  // Falling through, as chattering: a box in free fall has 1 g.
  const bool must_fail = setting.stiffness >= kNearestFails;
  const auto relation = must_fail ? kAtLeast : kNone;
  rows.push_back({"S1", name, fmt::format("restless boxes of {}", kSteps),
                  static_cast<double>(outcome.restless), relation, kSteps / 2});
  rows.push_back({"S1", name, "rms acceleration, last half, g", outcome.rms_g, relation, 0.5});
  rows.push_back(
      {"S1", name, "corners on or off, last half", static_cast<double>(outcome.toggles), kNone, 0});
  rows.push_back({"S1", name, "deepest below rest, m", outcome.sink, kNone, 0});
  return outcome;
}

// Depth, energy and chatter over time, where rounding to nearest fails on all but a few boxes.
void add_time_plots(const Outcome& right, const Outcome& wrong, std::vector<NamedPlot>& plots) {
  // The body that moves most when it ought to rest.
  const auto unrest = [&](unsigned body) {
    double low = 1;
    double high = -1;
    for (std::size_t s = wrong.samples.size() / 2; s < wrong.samples.size(); ++s) {
      low = std::min(low, wrong.samples[s].depth[body]);
      high = std::max(high, wrong.samples[s].depth[body]);
    }
    return high - low;
  };
  unsigned shown = 0;
  for (unsigned i = 1; i < kSteps; ++i) shown = unrest(i) > unrest(shown) ? i : shown;

  const auto plot_of = [](const std::string& title) {
    cooker::PagePlot plot{"time, s", title, {{"f16 to nearest", {}}, {"all codecs, no tree", {}}}};
    plot.lines = true;
    return plot;
  };
  cooker::PagePlot depth = plot_of("depth of one box at k 1e5 N/m, mm");
  cooker::PagePlot energy = plot_of("energy of all boxes at k 1e5 N/m above rest, mJ");
  cooker::PagePlot chatter = plot_of("corners on or off so far at k 1e5 N/m");
  const double rest = right.samples.back().energy;
  for (std::size_t series = 0; series < 2; ++series) {
    for (const Sample& sample : (series == 0 ? wrong : right).samples) {
      depth.series[series].points.push_back({sample.seconds, 1e3 * sample.depth[shown], ""});
      energy.series[series].points.push_back({sample.seconds, 1e3 * (sample.energy - rest), ""});
      chatter.series[series].points.push_back(
          {sample.seconds, static_cast<double>(sample.toggles), ""});
    }
  }
  plots.push_back({"s1-depth", depth});
  plots.push_back({"s1-energy", energy});
  plots.push_back({"s1-toggles", chatter});
}

}  // namespace
}  // namespace case_rest

CaseResult run_rest(const Scale& scale) {
  using namespace case_rest;
  CaseResult result;
  const Group exact = group_of(exact_store());
  const Group grid = group_of(grid_store(16));
  const Shape nearest = make_nearest(stairs(kSteps, kSteps, kLevelSize), exact_store());
  cooker::PagePlot chatter{"log10 of the stiffness in N/m",
                           "log10 of the rms acceleration in g",
                           {{"f16 to nearest", {}}, {"all codecs, no tree", {}}, {"limit", {}}}};
  chatter.lines = true;
  for (const double stiffness : {1e3, 1e4, 1e5, 1e6, 1e7, 1e8}) {
    const Setting symplectic = setting_of(stiffness, Stepper::kSymplectic, scale);
    const Outcome right = add_rows(exact, symplectic, result.rows);
    const Outcome wrong = add_control(nearest, exact.bodies.front(), symplectic, result.rows);
    if (!scale.quick || stiffness == 1e3 || stiffness == 1e8) {
      const Setting implicit = setting_of(stiffness, Stepper::kImplicit, scale);
      static_cast<void>(add_rows(exact, implicit, result.rows));
    }
    if (!scale.quick || stiffness == 1e8) {
      static_cast<void>(add_rows(grid, symplectic, result.rows));
    }
    // A box that is quite still has no logarithm.
    const auto log_rms = [](double rms) { return std::log10(std::max(rms, 1e-15)); };
    const double x = std::log10(stiffness);
    chatter.series[0].points.push_back({x, log_rms(wrong.rms_g), ""});
    chatter.series[1].points.push_back({x, log_rms(right.rms_g), ""});
    chatter.series[2].points.push_back({x, log_rms(kRmsLimitG), ""});
    if (stiffness == kNearestFails) add_time_plots(right, wrong, result.plots);
  }
  result.plots.push_back({"s1-chatter", chatter});
  return result;
}

}  // namespace boxtree::stiff
