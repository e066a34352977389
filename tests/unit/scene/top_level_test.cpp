// SPDX-License-Identifier: MIT
// Walks of the two trees over a scene's instances, vectorised and scalar, against all their boxes.
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
    // Each comes from where another is.
    std::vector<Box<double>> before = boxes_;
    std::rotate(before.begin(), before.begin() + 1, before.end());
    MovingTree moving(before, nullptr);
    moving_.swap(moving);
    for (std::uint32_t i = 0; i < count; ++i) moving_.refit(i, boxes_[i]);
  }

  [[nodiscard]] const TopLevel& top() const { return BoundScene::of(scene_).top_level(); }
  /// Over the same boxes.
  [[nodiscard]] const MovingTree& moving() const { return moving_; }
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
  MovingTree moving_;
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

// How often instances were visited: because they must be, one by one, and by vectors.
struct Visits {
  std::size_t needed = 0;
  std::size_t plain = 0;
  std::size_t walked = 0;

  template <class Tree, class... Region>
  void add(const Tree& tree, const Numbers& expected, const Region&... region) {
    const Numbers scalar =
        visited([&](InstanceVisitor visit) { return walk_one_by_one(tree, region..., visit); });
    const Numbers fast =
        visited([&](InstanceVisitor visit) { return walk_instances(tree, visit, region...); });
    ASSERT_TRUE(holds(scalar, expected));
    ASSERT_TRUE(holds(fast, expected));
    ASSERT_TRUE(holds(fast, scalar));
    needed += expected.size();
    plain += scalar.size();
    walked += fast.size();
  }
};

// Both trees: each walk visits all that must be; what it visits beyond that is counted.
struct Tally {
  Visits top, moving;

  template <class... Region>
  void add(const Level& level, const Numbers& expected, const Region&... region) {
    top.add(level.top(), expected, region...);
    moving.add(level.moving(), expected, region...);
  }
  void expect(std::size_t least_needed, std::size_t few) const {
    EXPECT_GT(top.needed, least_needed);
    EXPECT_LE(top.walked, top.plain + top.plain / few);
    // Both have the planes of instances in floats, which far from the origin resolve them badly.
    EXPECT_LE(moving.walked, top.walked + top.walked / few);
    EXPECT_LE(moving.plain, top.plain);
  }
};

class TopLevelWalk : public testing::TestWithParam<double> {};

TEST_P(TopLevelWalk, BoxesVisitAllThatOverlap) {
  for (const std::uint32_t count : {1u, 2u, 3u, 9u, 40u, 300u}) {
    Level level(count, GetParam(), count);
    Tally tally;
    for (int i = 0; i < 500; ++i) {
      const Vector3d at = level.point(i % 10 == 0 ? 1e5 : 2);
      const double size =
          std::exp2(-8 * std::abs(level.unit())) * (level.point(1) - level.point(1)).norm();
      const Box<double> box{{at[0], at[1], at[2]}, {at[0] + size, at[1] + size, at[2] + size}};
      tally.add(level, level.all([&](const Box<double>& b) { return boxes_overlap(b, box); }), box);
    }
    tally.expect(50, 50);
  }
}

TEST_P(TopLevelWalk, PointsVisitAllWithinTheirDistance) {
  for (const std::uint32_t count : {1u, 2u, 3u, 9u, 40u, 300u}) {
    Level level(count, GetParam(), count + 1);
    Tally tally;
    for (int i = 0; i < 500; ++i) {
      const Vector3d at = level.point(i % 10 == 0 ? 1e5 : 2);
      double bound = std::exp2(-8 * std::abs(level.unit())) * (level.point(1) - at).squaredNorm();
      if (i % 50 == 0) bound = kInfinity;
      tally.add(level,
                level.all([&](const Box<double>& b) { return squared_distance(at, b) <= bound; }),
                at, bound);
    }
    tally.expect(10, 50);
  }
}

TEST_P(TopLevelWalk, RaysVisitAllThatTheyMeet) {
  for (const std::uint32_t count : {1u, 2u, 3u, 9u, 40u, 300u}) {
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
      tally.add(level, level.all([&](const Box<double>& b) {
        const double key = ray.slab.key(b, s_min);
        return key <= bound && key < kInfinity;
      }),
                ray, bound);
    }
    tally.expect(100, 20);
  }
}

// Walks a tree from near to far of 500 points: what comes after the nearest box is visited no more.
template <class Tree>
void follow_bounds(Level& level, const Tree& tree) {
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
    ASSERT_EQ(walk_one_by_one(tree, at, bound, visit), Errc::kOk);
    EXPECT_EQ(bound, nearest);
    plain += visits;
    bound = kInfinity;
    visits = 0;
    ASSERT_EQ(walk_instances(tree, visit, at, bound), Errc::kOk);
    EXPECT_EQ(bound, nearest);
    walked += visits;
    std::size_t once = 0;
    const auto stop = [&](std::uint32_t /*instance*/) { return ++once == 0; };
    ASSERT_EQ(walk_instances(tree, stop, at, bound), Errc::kOk);
    EXPECT_EQ(once, 1u);
  }
  EXPECT_LE(walked, plain + plain / 20);
}

TEST_P(TopLevelWalk, FollowsABoundThatShrinks) {
  Level level(300, GetParam(), 5);
  follow_bounds(level, level.top());
  follow_bounds(level, level.moving());
}

INSTANTIATE_TEST_SUITE_P(Spread, TopLevelWalk, testing::Values(0.0, 1e-3, 1.0, 1e3, 1e9));

}  // namespace
}  // namespace boxtree
