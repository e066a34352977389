// SPDX-License-Identifier: MIT
// S4: a box slides without friction over a plane that is tilted against the grid, so that every
// vertex is rounded and every inner edge becomes a kink. Gravity is the plane's normal: without
// rounding the box would go on for ever.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tests/stiff/cases.h"
#include "tests/stiff/meshes.h"
#include "tests/stiff/world.h"

namespace boxtree::stiff {
namespace case_slide {
namespace {

constexpr double kTile = 16;
constexpr unsigned kCells = 64;
constexpr double kHalf = 0.2;
constexpr double kMass = 1;
constexpr double kSprings = 4;
constexpr double kSpeed = 1;
constexpr double kWay = 10;
constexpr double kDampingRatio = 0.5;

struct Outcome {
  std::uint64_t hash = 0;
  double changed = 0;  // of the energy along the plane, at any time, share
  double lost = 0;     // of that and of height, for good
  double hop = 0;      // highest above where it would rest on the plane itself, m
  double edge_contacts = 0;
  double toggles = 0;
  std::vector<std::pair<double, double>> track;  // way, height
};

Outcome simulate(const Shape& level, const Shape& body, double stiffness) {
  const double omega = std::sqrt(kSprings * stiffness / kMass);
  const double dt = 0.1 / omega;
  const Eigen::Vector3d normal = tilted_normal();
  World world(level, {stiffness, 2 * kDampingRatio * kMass * omega / kSprings}, -kGravity * normal);
  const Eigen::Quaterniond upright =
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  // Along no edge of the mesh.
  const Eigen::Vector3d ahead = upright * Eigen::Vector3d(std::cos(0.35), std::sin(0.35), 0);
  const double rest = kHalf - kMass * kGravity / (kSprings * stiffness);
  Body box = make_body(body, Eigen::Vector3d::Constant(kHalf), kMass);
  box.orientation = upright;
  box.position = -kWay / 2 * ahead + rest * normal;
  box.velocity = kSpeed * ahead;
  world.bodies.push_back(box);

  Outcome outcome;
  const auto steps = static_cast<std::size_t>(kWay / kSpeed / dt);
  for (std::size_t step = 0; step < steps; ++step) {
    world.step_symplectic_euler(dt);
    const Body& now = world.bodies.front();
    const Eigen::Vector3d along = now.velocity - now.velocity.dot(normal) * normal;
    const double share = along.squaredNorm() / (kSpeed * kSpeed);
    const double height = now.position.dot(normal) - rest;
    outcome.changed = std::max(outcome.changed, std::abs(1 - share));
    outcome.lost = 1 - share - 2 * kGravity * height / (kSpeed * kSpeed);
    outcome.hop = std::max(outcome.hop, height);
    if (step % std::max<std::size_t>(1, steps / 500) == 0) {
      outcome.track.emplace_back(kSpeed * dt * static_cast<double>(step), height);
    }
  }
  outcome.hash = world.state_hash();
  outcome.edge_contacts = static_cast<double>(world.edge_contacts()) / static_cast<double>(steps);
  outcome.toggles = static_cast<double>(world.toggles());
  return outcome;
}

}  // namespace
}  // namespace case_slide

CaseResult run_slide(const Scale& scale) {
  using namespace case_slide;
  using enum Row::Limit;
  CaseResult result;
  const SourceMesh mesh = field(Field::kTilted, kCells, kTile);
  const std::vector<Shape> bodies =
      all_shapes(box(Eigen::Vector3d::Constant(kHalf)), exact_store());
  const std::vector<double> stiffnesses = scale.quick ? std::vector{1e4} : std::vector{1e4, 1e6};
  cooker::PagePlot plot{"way, m", "height above the plane, um", {}};
  plot.lines = true;
  for (const int bits : {16, 21, 24}) {
    if (scale.quick && bits == 24) continue;
    const Store store = grid_store(bits);
    std::vector<Shape> levels = all_shapes(mesh, store);
    // Of a linear scan there is no need over ten metres of a large mesh: S1 and S3 have it.
    levels.pop_back();
    const double q = std::ldexp(1.0, levels.front().encoded->geometry.grid_exponent);
    for (const double stiffness : stiffnesses) {
      std::vector<std::uint64_t> hashes;
      Outcome outcome;
      for (std::size_t i = 0; i < levels.size(); ++i) {
        outcome = simulate(levels[i], bodies[i], stiffness);
        hashes.push_back(outcome.hash);
      }
      const std::string name =
          fmt::format("{}, q {:.2g} m, k {} N/m", store.name, q, power_name(stiffness));
      const auto add = [&](const std::string& what, double figure, Row::Limit relation,
                           double limit) {
        result.rows.push_back({"S4", name, what, figure, relation, limit});
      };
      add("energy lost for good, share", std::abs(outcome.lost), kAtMost, 1e-3);
      // Going up by q takes m g q, whatever the contact does.
      const double lifting = 2 * kGravity * q / (kSpeed * kSpeed);
      add("energy along the plane, largest change, share", outcome.changed,
          lifting <= 1e-3 ? kAtMost : kNone, 1e-3);
      add("hop height, m", outcome.hop, kAtMost, q);
      add("contacts at inner edges a step", outcome.edge_contacts, kNone, 0);
      add("corners on or off", outcome.toggles, kNone, 0);
      add(fmt::format("different final states of {}", levels.size()),
          static_cast<double>(distinct(hashes)), kAtMost, 1);
      if (stiffness != stiffnesses.back() || bits == 24) continue;
      plot.series.push_back({fmt::format("{} bit, q {:.2g} um", bits, 1e6 * q), {}});
      for (const auto& [way, height] : outcome.track) {
        plot.series.back().points.push_back({way, 1e6 * height, ""});
      }
    }
  }
  result.plots.push_back({"s4-height", plot});
  return result;
}

}  // namespace boxtree::stiff
