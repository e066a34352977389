// SPDX-License-Identifier: MIT
// S6: boxes thrown at walls a millimetre thick, by up to the thickness a step. Springs may be too
// weak to stop them; but a box that stops before one wall must stop before every wall, whatever the
// codec.
#include <array>
#include <bit>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "runtime/file/checksum.h"
#include "tests/stiff/cases.h"
#include "tests/stiff/meshes.h"
#include "tests/stiff/world.h"

namespace boxtree::stiff {
namespace case_wall {
namespace {

constexpr unsigned kWalls = 8;
constexpr double kSize = 8;
constexpr double kThickness = 1e-3;
constexpr double kHalf = 0.05;
constexpr double kMass = 1;
constexpr double kSprings = 4;
constexpr double kStiffness = 1e6;
constexpr double kStepOmega = 0.5;

struct Outcome {
  std::vector<std::uint64_t> ends;  // state of each box
  std::uint64_t crossed = 0;        // a bit each
};

// Eight throws at each wall, the first touch anywhere in a step.
Outcome simulate(const Shape& level, const Shape& body, double share_of_wall) {
  const double omega = std::sqrt(kSprings * kStiffness / kMass);
  const double dt = kStepOmega / omega;
  const double speed = share_of_wall * kThickness / dt;
  World world(level, {kStiffness, 0}, {0, 0, 0});
  constexpr unsigned kThrows = 8;
  Outcome outcome;
  for (unsigned phase = 0; phase < kThrows; ++phase) {
    world.bodies.clear();
    for (unsigned wall = 0; wall < kWalls; ++wall) {
      Body box = make_body(body, Eigen::Vector3d::Constant(kHalf), kMass);
      const double before = (3 + (phase + 0.37) / kThrows) * speed * dt;
      box.position = {wall_front(wall, kWalls, kSize) - kHalf - before, 0.11 - 0.03 * wall, 0.07};
      box.velocity = {speed, 0, 0};
      world.bodies.push_back(box);
    }
    const auto steps = static_cast<std::size_t>(20 / kStepOmega + 4 * kThickness / (speed * dt));
    for (std::size_t step = 0; step < steps; ++step) world.step_symplectic_euler(dt);
    for (unsigned wall = 0; wall < kWalls; ++wall) {
      const Body& box = world.bodies[wall];
      if (box.velocity.x() > 0) outcome.crossed |= 1ull << (kWalls * phase + wall);
      const std::array state = {box.position, box.velocity, box.spin};
      outcome.ends.push_back(checksum(std::as_bytes(std::span(state))));
    }
  }
  return outcome;
}

}  // namespace
}  // namespace case_wall

CaseResult run_wall(const Scale&) {
  using namespace case_wall;
  using enum Row::Limit;
  CaseResult result;
  const SourceMesh mesh = walls(kWalls, kThickness, kSize);
  const std::vector<Shape> bodies =
      all_shapes(box(Eigen::Vector3d::Constant(kHalf)), exact_store());
  std::vector<Shape> levels = all_shapes(mesh, exact_store());
  // A scan's candidates are more than what touches, and so would be the wall's back.
  levels.pop_back();
  const Shape nearest = make_nearest(mesh, exact_store());
  const auto crossings = [](const Outcome& outcome) {
    return static_cast<double>(std::popcount(outcome.crossed));
  };
  for (const double share : {0.05, 0.1, 0.2, 0.4, 0.6, 0.95}) {
    std::vector<std::uint64_t> hashes;
    const Outcome f32 = simulate(levels.front(), bodies.front(), share);
    std::uint64_t crossed_elsewhere = 0;
    for (std::size_t i = 0; i < levels.size(); ++i) {
      const Outcome outcome = simulate(levels[i], bodies[i], share);
      hashes.push_back(checksum_of(outcome.ends));
      crossed_elsewhere |= outcome.crossed & ~f32.crossed;
    }
    const Outcome control = simulate(nearest, bodies.front(), share);
    const std::string name = fmt::format("v dt {:.2g} of the wall", share);
    const auto add = [&](const std::string& what, double figure, Row::Limit relation,
                         double limit) {
      result.rows.push_back({"S6", name, what, figure, relation, limit});
    };
    add("crossed with plain-f32, of 64", crossings(f32), kNone, 0);
    add("crossed with another codec, not with plain-f32",
        static_cast<double>(std::popcount(crossed_elsewhere)), kAtMost, 0);
    add(fmt::format("different final states of {}", hashes.size()),
        static_cast<double>(distinct(hashes)), kAtMost, 1);
    double otherwise = 0;
    for (std::size_t i = 0; i < f32.ends.size(); ++i) {
      otherwise += control.ends[i] != f32.ends[i] ? 1 : 0;
    }
    add("control: f16 to nearest ends otherwise, of 64", otherwise, kAtLeast, 1);
  }
  return result;
}

}  // namespace boxtree::stiff
