// SPDX-License-Identifier: MIT
// Walks of a scene's top level, vectorised and scalar, against the boxes of all its instances.
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/query/ray_query.h"
#include "runtime/query/relative_pose.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/scene/top_level_walk.h"
#include "runtime/tree/root_box.h"
#include "runtime/walk/traversal.h"
#include "tests/support/infinity.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using Eigen::Vector3d;
using test::kInfinity;
using Numbers = std::vector<std::uint32_t>;

// Instances of one small mesh, `spread` apart at most, and their boxes in the scene's frame.
class Level {
 public:
  Level(std::uint32_t count, double spread, unsigned seed)
      : cooked_(test::cook_scene({test::sphere(4, 4)}, parts(count, spread, seed))),
        scene_(test::require(Scene::bind(cooked_.file))),
        random_(seed) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto placed = BoundScene::of(scene_).place(i);
      boxes_.push_back(BoundScene::of(scene_).to_frame(placed.value().bounds().value().world));
    }
  }

  [[nodiscard]] const TopLevel& top() const { return BoundScene::of(scene_).top_level(); }
  [[nodiscard]] double condition() const { return BoundScene::of(scene_).condition(); }
  [[nodiscard]] const Box<double>& box(std::uint32_t instance) const { return boxes_[instance]; }
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  // In the scene's frame: about some instance, in its box for `spread` 1.
  Vector3d point(double spread) {
    const Box<double>& near = boxes_[random_() % boxes_.size()];
    Vector3d p;
    for (std::size_t k = 0; k < 3; ++k) {
      p[static_cast<Eigen::Index>(k)] =
          (near.low[k] + near.high[k]) / 2 + spread * unit() * (near.high[k] - near.low[k]) / 2;
    }
    return p;
  }

  // Numbers of the boxes that pass.
  template <class Test>
  [[nodiscard]] Numbers all(const Test& test) const {
    Numbers found;
    for (std::uint32_t i = 0; i < boxes_.size(); ++i) {
      if (test(boxes_[i])) found.push_back(i);
    }
    return found;
  }

 private:
  static cooker::SceneParts parts(std::uint32_t count, double spread, unsigned seed) {
    cooker::SceneParts parts = test::random_parts(count, 1, 0, 1, seed);
    for (cooker::PlacedTree& placed : parts.instances) placed.pose.translation() *= spread;
    return parts;
  }

  test::CookedScene cooked_;
  Scene scene_;
  std::mt19937_64 random_;
  std::vector<Box<double>> boxes_;
};

// What a walk visits, sorted.
template <class Walk>
Numbers visited(const Walk& walk) {
  Numbers numbers;
  const Errc walked = walk([&](std::uint32_t instance) {
    numbers.push_back(instance);
    return true;
  });
  EXPECT_EQ(walked, Errc::kOk);
  std::sort(numbers.begin(), numbers.end());
  EXPECT_EQ(std::adjacent_find(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

bool holds(const Numbers& more, const Numbers& fewer) {
  return std::includes(more.begin(), more.end(), fewer.begin(), fewer.end());
}

// Both walks visit all that must be; what both visit beyond it is counted.
struct Tally {
  std::size_t needed = 0;
  std::size_t plain = 0;
  std::size_t walked = 0;

  template <class... Region>
  void add(const TopLevel& top, const Numbers& expected, const Region&... region) {
    const Numbers scalar = visited(
        [&](InstanceVisitor visit) { return walk_top_level_scalar(top, region..., visit); });
    const Numbers fast =
        visited([&](InstanceVisitor visit) { return walk_top_level(top, visit, region...); });
    ASSERT_TRUE(holds(scalar, expected));
    ASSERT_TRUE(holds(fast, expected));
    ASSERT_TRUE(holds(fast, scalar));
    needed += expected.size();
    plain += scalar.size();
    walked += fast.size();
  }
};

class TopLevelWalk : public testing::TestWithParam<double> {};

TEST_P(TopLevelWalk, BoxesVisitAllThatOverlap) {
  for (const std::uint32_t count : {1u, 2u, 9u, 300u}) {
    Level level(count, GetParam(), count);
    Tally tally;
    for (int i = 0; i < 500; ++i) {
      const Vector3d at = level.point(i % 10 == 0 ? 1e5 : 2);
      const double size =
          std::exp2(-8 * std::abs(level.unit())) * (level.point(1) - level.point(1)).norm();
      const Box<double> box{{at[0], at[1], at[2]}, {at[0] + size, at[1] + size, at[2] + size}};
      tally.add(level.top(), level.all([&](const Box<double>& b) { return boxes_overlap(b, box); }),
                box);
    }
    EXPECT_GT(tally.needed, 50u);
    EXPECT_LE(tally.walked, tally.plain + tally.plain / 50);
  }
}

TEST_P(TopLevelWalk, PointsVisitAllWithinTheirDistance) {
  for (const std::uint32_t count : {1u, 2u, 9u, 300u}) {
    Level level(count, GetParam(), count + 1);
    Tally tally;
    for (int i = 0; i < 500; ++i) {
      const Vector3d at = level.point(i % 10 == 0 ? 1e5 : 2);
      double bound = std::exp2(-8 * std::abs(level.unit())) * (level.point(1) - at).squaredNorm();
      if (i % 50 == 0) bound = kInfinity;
      tally.add(level.top(),
                level.all([&](const Box<double>& b) { return squared_distance(at, b) <= bound; }),
                at, bound);
    }
    EXPECT_GT(tally.needed, 10u);
    EXPECT_LE(tally.walked, tally.plain + tally.plain / 50);
  }
}

TEST_P(TopLevelWalk, RaysVisitAllThatTheyMeet) {
  for (const std::uint32_t count : {1u, 2u, 9u, 300u}) {
    Level level(count, GetParam(), count + 2);
    Tally tally;
    for (int i = 0; i < 1000; ++i) {
      const Vector3d from = level.point(i % 10 == 0 ? 1e5 : 5);
      Vector3d direction = level.point(1) - from;
      for (Eigen::Index k = 0; k < 3; ++k) {
        if (i % 5 == k) direction[k] = 0;  // along an axis plane
      }
      if (direction.isZero(0)) continue;
      direction = std::ldexp(1.0, -exponent_of(largest_magnitude(direction))) * direction;
      const double largest = max_abs_of(level.top());
      const double origin = from.cwiseAbs().maxCoeff();
      const double spread = largest + 16 * level.condition() * (origin + largest);
      const double s_min = i % 3 == 0 ? direction.norm() * largest * std::abs(level.unit()) : 0;
      const TopLevelRay ray{from, direction, spread, RaySlab(from, direction, spread), s_min};
      const double bound = i % 2 == 0 ? kInfinity : s_min + 2 * largest * std::abs(level.unit());
      tally.add(level.top(), level.all([&](const Box<double>& b) {
        const double key = ray.slab.key(b, s_min);
        return key <= bound && key < kInfinity;
      }),
                ray, bound);
    }
    EXPECT_GT(tally.needed, 100u);
    EXPECT_LE(tally.walked, tally.plain + tally.plain / 20);
  }
}

// The bound is read again after each visit: what is beyond it is visited no more.
TEST_P(TopLevelWalk, FollowsABoundThatShrinks) {
  Level level(300, GetParam(), 5);
  std::size_t plain = 0, walked = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3d at = level.point(1.5);
    double nearest = kInfinity;
    for (const std::uint32_t n : level.all([](const Box<double>&) { return true; })) {
      nearest = std::min(nearest, squared_distance(at, level.box(n)));
    }
    double bound = kInfinity;
    std::size_t visits = 0;
    const auto visit = [&](std::uint32_t instance) {
      ++visits;
      bound = std::min(bound, squared_distance(at, level.box(instance)));
      return true;
    };
    ASSERT_EQ(walk_top_level_scalar(level.top(), at, bound, visit), Errc::kOk);
    EXPECT_EQ(bound, nearest);
    plain += visits;
    bound = kInfinity;
    visits = 0;
    ASSERT_EQ(walk_top_level(level.top(), visit, at, bound), Errc::kOk);
    EXPECT_EQ(bound, nearest);
    walked += visits;
    std::size_t once = 0;
    const auto stop = [&](std::uint32_t /*instance*/) { return ++once == 0; };
    ASSERT_EQ(walk_top_level(level.top(), stop, at, bound), Errc::kOk);
    EXPECT_EQ(once, 1u);
  }
  EXPECT_LE(walked, plain + plain / 20);
}

INSTANTIATE_TEST_SUITE_P(Spread, TopLevelWalk, testing::Values(0.0, 1e-3, 1.0, 1e3, 1e9));

}  // namespace
}  // namespace boxtree
