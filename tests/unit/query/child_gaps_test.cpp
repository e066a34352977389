// SPDX-License-Identifier: MIT
// Gaps of children by vectors are those of one child at a time, bit for bit: keys decide which pair
// is next, so answers would differ from machine to machine.
#include "runtime/query/child_gaps.h"

#include <cstdint>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/tree/root_box.h"
#include "runtime/walk/read_leaf.h"
#include "runtime/walk/traversal.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

struct ChildGapsCase {
  explicit ChildGapsCase(CodecId codec)
      : first(test::cook_tree(test::torus(24, 16), codec)),
        second(test::cook_tree(test::terrain(12, 3), codec)) {}

  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  }
  Eigen::Vector3d vector() {
    const double x = between(-1, 1), y = between(-1, 1);
    return {x, y, between(-1, 1)};
  }
  // A rotation; every other one with uneven scales and a shear.
  Pose pose(int turn) {
    Pose made = Pose::Identity();
    made.linear() = Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), 0.3)
                        .normalized()
                        .toRotationMatrix();
    if (turn % 2 == 1) {
      Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
      shear(0, 1) = 0.5;
      made.linear() *= shear * Eigen::Vector3d(0.5, -2, 1.25).asDiagonal();
    }
    made.translation() = 20 * vector();
    return made;
  }
  Box<double> box() {
    const Eigen::Vector3d a = 1000 * vector(), b = 1000 * vector();
    Box<double> made = empty_box<double>();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      made.low[k] = std::min(a[axis], b[axis]);
      made.high[k] = std::max(a[axis], b[axis]);
    }
    return made;
  }

  std::mt19937_64 random{7};
  test::CookedTree first, second;
};

TEST(ChildGaps, ByVectorsAreTheSameToTheBit) {
  std::size_t compared = 0, apart = 0;
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4, CodecId::kPackedF32}) {
    ChildGapsCase of(codec);
    const BoundTree &first = BoundTree::of(of.first.tree), &second = BoundTree::of(of.second.tree);
    for (int turn = 0; turn < 40; ++turn) {
      const Pose moved = of.pose(turn);
      const auto pose = RelativePose::make(first, Pose::Identity(), second, moved);
      ASSERT_TRUE(pose.has_value());
      const auto metric = WorldMetric::make(first, Pose::Identity(), second, *pose);
      ASSERT_TRUE(metric.has_value());
      const AlignedAxes axes = metric->axes_along(of.vector(), *pose);
      const GapMaps maps{pose->to_second(), metric->in_first(), metric->in_second(), axes, 0};
      // Down a random path.
      NodeRef node = first.root_ref();
      Box<double> box = root_box<double>(first);
      for (bool is_inner = true; is_inner;) {
        const OtherSubtree other{of.box(), of.box(), of.box()};
        ErasedCodec::Children children, plain_children;
        ChildGaps gaps, plain;
        PairBound bound(first, second, nullptr);
        ASSERT_EQ(expand_with_gaps(first, bound, node, box, maps, other, children, gaps),
                  Errc::kOk);
        ASSERT_EQ(
            expand_with_gaps_scalar(first, bound, node, box, maps, other, plain_children, plain),
            Errc::kOk);
        ASSERT_EQ(children.count, plain_children.count);
        ASSERT_EQ(children.leaf_mask, plain_children.leaf_mask);
        for (std::uint32_t i = 0; i < children.count; ++i) {
          ++compared;
          EXPECT_EQ(children.box(i), plain_children.box(i));
          EXPECT_EQ(children.ref[i], plain_children.ref[i]);
          EXPECT_EQ(gaps.extent(i), plain.extent(i));
          EXPECT_EQ(gaps.along[i], plain.along[i]);
          EXPECT_EQ(gaps.apart[i], plain.apart[i]);
          apart += gaps.apart[i] > 0 && gaps.along[i] > 0 ? 1u : 0u;
        }
        const auto next = static_cast<std::uint32_t>(of.between(0, children.count - 0.001));
        is_inner = !children.is_leaf(next);
        node = children.ref[next];
        box = children.box(next);
      }
      TriangleBatch leaf;
      ASSERT_EQ(read_leaf(first, node, leaf), Errc::kOk);
      EXPECT_EQ(extent_of(axes, 0, leaf), extent_scalar(axes, 0, leaf));
      leaf.count = 1 + static_cast<std::uint32_t>(turn) % leaf.count;
      EXPECT_EQ(extent_of(axes, 0, leaf), extent_scalar(axes, 0, leaf));
    }
  }
  EXPECT_GT(compared, 500u);
  EXPECT_GT(apart, 50u);
}

}  // namespace
}  // namespace boxtree
