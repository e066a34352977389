// SPDX-License-Identifier: MIT
// S2: balls bounce without damping, so that all that changes their energy is the step and the
// surface. The force is the gradient of k (r - distance)^2 / 2, whose distance closest_point gives.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "runtime/file/checksum.h"
#include "tests/stiff/cases.h"
#include "tests/stiff/meshes.h"
#include "tests/stiff/world.h"
#include "tests/support/require.h"

namespace boxtree::stiff {
namespace case_bounce {
namespace {

constexpr double kRadius = 0.5;
constexpr double kDrop = 1;  // m
constexpr double kMass = 1;
constexpr double kTile = 16;
constexpr unsigned kCells = 128;
constexpr unsigned kBalls = 32;
constexpr unsigned kBounces = 20;
constexpr double kDriftLimit = 1e-3;

enum class Stepper {
  kToJumps,  // steps end where the force jumps: where the ball touches, and between two faces
  kFixed,
};

struct Ball {
  Eigen::Vector3d position;
  Eigen::Vector3d velocity;
};

struct Setting {
  Field field;
  double stiffness;
  Stepper stepper = Stepper::kToJumps;
  double share = 0.05;  // of 1 / omega in a step

  [[nodiscard]] double step_seconds() const { return share / std::sqrt(stiffness / kMass); }
};

struct Outcome {
  std::vector<double> drift;              // largest of all balls so far, by bounces, of E0
  double rms = 0;                         // over the balls: of the largest of each
  std::vector<std::uint64_t> final_bits;  // of each ball

  [[nodiscard]] double largest() const { return drift.back(); }
};

class Bounce {
 public:
  Bounce(const Tree& tree, const Setting& setting, const Ball& ball)
      : tree_(tree),
        dt_(setting.step_seconds()),
        stiffness_(setting.stiffness),
        at_jumps_(setting.stepper == Stepper::kToJumps),
        ball_(ball),
        place_(place_of(ball)) {}

  // Down to the surface and up again.
  void until_next_bounce() {
    while (!fly_on()) {
    }
    while (!push_on()) {
    }
  }

  [[nodiscard]] double energy() const {
    return kMass * (ball_.velocity.squaredNorm() / 2 + kGravity * ball_.position.z());
  }
  [[nodiscard]] const Ball& ball() const { return ball_; }

 private:
  struct Place {
    double gap;            // from the ball to the surface; negative in contact
    std::uint32_t region;  // where the force has no jumps: in the air, or nearest to one face
  };
  [[nodiscard]] Place place_of(const Ball& ball) const {
    const auto nearest = test::require(closest_point(tree_, ball.position));
    const double gap = nearest->distance - kRadius;
    return {gap, gap > 0 ? kNoFaceId : nearest->face.id};
  }
  void move_to(const Ball& ball) {
    ball_ = ball;
    place_ = place_of(ball);
  }

  // The orbit without contact, exact for any time.
  [[nodiscard]] static Ball flown(Ball ball, double seconds) {
    ball.position += seconds * ball.velocity;
    ball.position.z() -= kGravity * seconds * seconds / 2;
    ball.velocity.z() -= kGravity * seconds;
    return ball;
  }

  // Half a move, the force there, the other half.
  [[nodiscard]] Ball pushed(Ball ball, double seconds) const {
    ball.position += seconds / 2 * ball.velocity;
    Eigen::Vector3d acceleration(0, 0, -kGravity);
    const auto nearest = test::require(closest_point(tree_, ball.position, kRadius));
    if (nearest && nearest->distance < kRadius) {
      const Eigen::Vector3d out = (ball.position - nearest->point) / nearest->distance;
      acceleration += stiffness_ / kMass * (kRadius - nearest->distance) * out;
    }
    ball.velocity += seconds * acceleration;
    ball.position += seconds / 2 * ball.velocity;
    return ball;
  }

  // One step, or the part of it after which the ball has come into another region, to the last bit.
  template <class Move>
  void move_within_region(const Move& move) {
    const std::uint32_t here = place_.region;
    const Ball whole = move(ball_, dt_);
    const Place there = place_of(whole);
    if (!at_jumps_ || there.region == here) {
      short_parts_ = 0;
      ball_ = whole;
      place_ = there;
      return;
    }
    double before = 0;
    double after = dt_;
    for (double middle = dt_ / 2; middle > before && middle < after;
         middle = before + (after - before) / 2) {
      (place_of(move(ball_, middle)).region == here ? before : after) = middle;
    }
    // Nearest to an edge, its faces may take turns by rounding, where no force jumps: after a few
    // parts that bring the ball nowhere, the whole step.
    constexpr double kShort = 0x1p-10;
    constexpr unsigned kManyShort = 8;
    short_parts_ = after < kShort * dt_ ? short_parts_ + 1 : 0;
    move_to(short_parts_ > kManyShort ? whole : move(ball_, after));
  }

  // Whether it has come down.
  [[nodiscard]] bool fly_on() {
    wrap();
    // The longest time t with speed * t + g t^2 <= gap.
    const double free = std::max(0.0, place_.gap);
    const double speed = ball_.velocity.norm();
    const double time = 2 * free / (speed + std::sqrt(speed * speed + 4 * kGravity * free));
    if (time > dt_) {
      move_to(flown(ball_, at_jumps_ ? time : dt_ * std::floor(time / dt_)));
      return false;
    }
    // With fixed steps the force of one decides that is taken in its middle.
    if (!at_jumps_ && place_of(flown(ball_, dt_ / 2)).gap <= 0) return true;
    move_within_region(flown);
    return at_jumps_ && place_.gap <= 0;
  }

  // Whether it has left the surface.
  [[nodiscard]] bool push_on() {
    move_within_region([this](const Ball& ball, double seconds) { return pushed(ball, seconds); });
    return place_.gap > 0;
  }

  // The sine repeats: a ball that leaves the middle of the tile flies on where the same lies.
  void wrap() {
    constexpr double kPeriod = kTile / kSineWaves;
    Ball ball = ball_;
    for (Eigen::Index axis = 0; axis < 2; ++axis) {
      if (std::abs(ball.position[axis]) <= kPeriod) continue;
      ball.position[axis] -= kPeriod * std::round(ball.position[axis] / kPeriod);
    }
    if (ball.position != ball_.position) move_to(ball);
  }

  const Tree& tree_;
  double dt_;
  double stiffness_;
  bool at_jumps_;
  unsigned short_parts_ = 0;  // one after the other
  Ball ball_;
  Place place_;  // of ball_
};

Ball ball_of(Field field, unsigned number) {
  // On the flat only heights differ, so that the first touch falls anywhere in a step.
  const double height = kDrop + (field == Field::kFlat ? 0.0037 * number : 0);
  const Eigen::Vector3d at(-1.7 + 0.1025 * number, 1.3 - 0.0725 * number, 0);
  const double ground = field == Field::kFlat ? kFlatHeight : kSineHeight;
  return {at + Eigen::Vector3d(0, 0, ground + kRadius + height), Eigen::Vector3d::Zero()};
}

Outcome simulate(const Shape& level, const Setting& setting, unsigned balls) {
  Outcome outcome;
  outcome.drift.assign(kBounces, 0);
  double squares = 0;
  for (unsigned i = 0; i < balls; ++i) {
    Bounce bounce(*level.tree, setting, ball_of(setting.field, i));
    const double start = bounce.energy();
    double largest = 0;
    for (unsigned n = 0; n < kBounces; ++n) {
      bounce.until_next_bounce();
      const double drift = std::abs(bounce.energy() - start) / (kMass * kGravity * kDrop);
      largest = std::max(largest, drift);
      outcome.drift[n] = std::max(outcome.drift[n], largest);
    }
    squares += largest * largest;
    const Ball& ball = bounce.ball();
    outcome.final_bits.push_back(checksum(std::as_bytes(std::span(&ball, 1))));
  }
  outcome.rms = std::sqrt(squares / balls);
  return outcome;
}

// One surface in one store: the measured codec first.
std::vector<Shape> levels_of(const SourceMesh& mesh, const Store& store) {
  std::vector<Shape> levels;
  levels.push_back(make_shape(mesh, CodecId::kWide8, store));
  for (const CodecInfo& codec : kCodecs) {
    if (codec.id != CodecId::kWide8) levels.push_back(make_shape(mesh, codec.id, store));
  }
  return levels;
}

std::size_t count_final_states(const std::vector<Shape>& levels, const Setting& setting,
                               unsigned balls) {
  std::vector<std::uint64_t> states;
  for (const Shape& level : levels) {
    const std::vector<std::uint64_t> bits = simulate(level, setting, balls).final_bits;
    states.push_back(checksum_of(bits));
  }
  return distinct(states);
}

std::string setting_name(const Setting& setting, const std::string& rest) {
  return fmt::format("{}, k {} N/m, {}", setting.field == Field::kFlat ? "flat" : "sine",
                     power_name(setting.stiffness), rest);
}

// The softest contact, on facets: in a step of 1.6 ms the ball rolls over several of them, and one
// cut a step is not enough, with the exact mesh either.
bool passes_many_facets(const Setting& setting) {
  return setting.field == Field::kSine && setting.stiffness < 1e4;
}

void add_surface(Field kind, const Scale& scale, CaseResult& result) {
  using enum Row::Limit;
  const unsigned compared = scale.quick ? 1 : 8;
  std::vector<Store> stores = {exact_store(), grid_store(16), grid_store(21), grid_store(24)};
  if (scale.quick) stores.resize(2);
  cooker::PagePlot plot{"bounces", "largest drift so far of 32 balls, 1e-6 of E0", {}};
  plot.lines = true;
  std::vector<double> exact_rms;
  for (const Store& store : stores) {
    const std::vector<Shape> levels = levels_of(field(kind, kCells, kTile), store);
    std::size_t number = 0;
    for (const double stiffness : {1e3, 1e4, 1e5, 1e6, 1e7, 1e8}) {
      const Setting setting{kind, stiffness};
      const Outcome outcome = simulate(levels.front(), setting, kBalls);
      const std::string name = setting_name(setting, store.name);
      const auto add = [&](const std::string& what, double figure, Row::Limit relation,
                           double limit) {
        result.rows.push_back({"S2", name, what, figure, relation, limit});
      };
      add(fmt::format("energy drift of E0, rms of {} balls", kBalls), outcome.rms, kAtMost,
          kDriftLimit);
      add("energy drift of E0, largest", outcome.largest(),
          passes_many_facets(setting) ? kNone : kAtMost, kDriftLimit);
      if (passes_many_facets(setting)) {
        const Setting finer{kind, stiffness, Stepper::kToJumps, setting.share / 2};
        add("the same in steps of half the length",
            simulate(levels.front(), finer, kBalls).largest(), kAtMost, kDriftLimit);
      }
      if (!store.grid) {
        exact_rms.push_back(outcome.rms);
        const Setting fixed{kind, stiffness, Stepper::kFixed};
        result.rows.push_back({"S2", setting_name(fixed, "steps not cut at jumps"),
                               "energy drift of E0, largest",
                               simulate(levels.front(), fixed, kBalls).largest(), kNone, 0});
      } else {
        add("rms drift over that of exact", outcome.rms / exact_rms[number], kAtMost, 2);
      }
      add(fmt::format("different final states of {}", levels.size()),
          static_cast<double>(count_final_states(levels, setting, compared)), kAtMost, 1);
      if (stiffness == 1e6) {
        plot.series.push_back({store.name, {}});
        for (unsigned n = 0; n < kBounces; ++n) {
          plot.series.back().points.push_back({n + 1.0, 1e6 * outcome.drift[n], ""});
        }
      }
      ++number;
    }
  }
  result.plots.push_back({kind == Field::kFlat ? "s2-energy-flat" : "s2-energy-sine", plot});
}

}  // namespace
}  // namespace case_bounce

CaseResult run_bounce(const Scale& scale) {
  using namespace case_bounce;
  CaseResult result;
  for (const Field kind : {Field::kFlat, Field::kSine}) add_surface(kind, scale, result);
  return result;
}

}  // namespace boxtree::stiff
