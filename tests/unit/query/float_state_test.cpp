// SPDX-License-Identifier: MIT
// Queries compute in a state of their own and leave the caller's as it was.
#include "tests/support/float_state.h"

#include <array>
#include <cfenv>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "runtime/primitive/float_state.h"

namespace boxtree {
namespace {

TEST(DefaultFloatState, RoundsToNearestInside) {
  const test::RoundingMode<FE_UPWARD> upward;
  volatile float one = 1, tiny = 0x1p-40F;
  {
    const DefaultFloatState state;
    EXPECT_EQ(one + tiny, 1.0F);
  }
  EXPECT_GT(one + tiny, 1.0F) << "the caller's mode is back";
}

TEST(DefaultFloatState, KeepsSubnormalNumbersInside) {
  if (!test::FlushToZero::is_supported()) GTEST_SKIP() << "no such state on this machine";
  const test::FlushToZero flush;
  volatile float tiny = 0x1p-140F;
  {
    const DefaultFloatState state;
    EXPECT_EQ(tiny * 2, 0x1p-139F);
  }
  EXPECT_EQ(tiny * 2, 0.0F) << "the caller's state is back";
}

// What computes without a tree does so, too.
TEST(DefaultFloatState, IsThatOfFrustumsAndOfMergingContacts) {
  const Frustum::ViewProjection matrix =
      Frustum::ViewProjection::Constant(0.1) + 3 * Frustum::ViewProjection::Identity() / 7;
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    corners[i] =
        Eigen::Vector3d(i == 1 || i == 2 || i == 5 || i == 6 ? 1.1 : 0.1,
                        i == 2 || i == 3 || i == 6 || i == 7 ? 1.3 : 0.3, i < 4 ? 0.7 : 2.1);
    if (i >= 4) corners[i] += (corners[i] - Eigen::Vector3d(0.6, 0.8, 0)) / 3;
  }
  std::vector<Contact> apart(2);  // by the distance, to nearest; by more, upward
  for (Contact& contact : apart) contact.normal = {0, 0, 1};
  apart[1].point = {0.1, 0.2, 0.3};
  const double distance = apart[1].point.norm();
  const auto answers = [&] {
    std::vector<double> found;
    for (const Frustum& frustum : {Frustum::of(matrix), Frustum::of(corners)}) {
      for (const Frustum::Plane& plane : frustum.planes) {
        found.insert(found.end(), plane.data(), plane.data() + plane.size());
      }
    }
    std::vector<Contact> contacts = apart;
    found.push_back(static_cast<double>(merge_contacts(contacts, distance)));
    return found;
  };
  const std::vector<double> expected = answers();
  const test::RoundingMode<FE_UPWARD> upward;
  EXPECT_EQ(answers(), expected);
}

}  // namespace
}  // namespace boxtree
