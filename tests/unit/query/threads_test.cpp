// SPDX-License-Identifier: MIT
// Many threads query one tree at once; the tsan build watches, and every thread gets the answers
// that one thread got.
#include <thread>

#include <gtest/gtest.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

class Threads : public testing::TestWithParam<CodecId> {};

// One number from all kinds of query.
double query_everything(const File& file, const Tree& tree) {
  double sum = 0;
  const Result<Tree> own = Tree::bind(file);  // binding is safe too
  file.advise(Access::kWillNeed);
  for (int i = 0; i < 200; ++i) {
    sum += tree.prefetch(static_cast<std::uint32_t>(i) % 4);
    const double x = 0.01 * i - 1;
    const auto hit = closest_hit(tree, {{x, 0.3, 9}, {0.01, 0.02, -1}});
    if (hit.has_value()) sum += hit->t;
    const auto touch =
        cast_closest(tree, Capsule{{x, 0.3, 9}, {x, 0.5, 9}, 0.2}, Motion{{0.01, 0.02, -1}});
    if (touch.has_value()) sum += touch->t;
    sum += closest_point(*own, {x, 2, 1})->distance;
    const auto count = [&sum](const auto&) {
      sum += 1;
      return true;
    };
    static_cast<void>(overlap_sphere(tree, {x, 0, 0}, 0.4, count));
    Pose pose = Pose::Identity();
    pose.translation().x() = 1 + x;
    if (i % 20 == 0) {
      static_cast<void>(overlap_pairs(tree, Pose::Identity(), *own, pose, count));
    }
  }
  return sum;
}

TEST_P(Threads, GetTheAnswersOfOne) {
  const test::CookedTree cooked = test::cook_tree(test::torus(24, 16), GetParam());
  const double expected = query_everything(cooked.file, cooked.tree);
  std::vector<double> sums(8);
  std::vector<std::thread> threads;
  for (double& sum : sums) {
    threads.emplace_back([&cooked, &sum] { sum = query_everything(cooked.file, cooked.tree); });
  }
  for (std::thread& thread : threads) thread.join();
  for (const double sum : sums) EXPECT_EQ(sum, expected);
}

INSTANTIATE_TEST_SUITE_P(Codecs, Threads, testing::ValuesIn(test::all_codecs()), test::test_name);

}  // namespace
}  // namespace boxtree
