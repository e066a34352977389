// SPDX-License-Identifier: MIT
// Every pose that a pair query refuses is said to have a fault, and which.
#include "cooker/text/pose_fault.h"

#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree::cooker {
namespace {

struct Case {
  const char* fault;
  std::function<void(Pose&)> spoil;
};

TEST(PoseFault, NamesWhatThePairQueryRefuses) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  const test::CookedTree cooked = test::cook_tree(test::city(2, 1), CodecId::kWide8);
  const Case cases[] = {
      {"is not finite: row 1, column 4 is inf", [&](Pose& p) { p(0, 3) = kInf; }},
      {"is not finite: row 3, column 2 is -inf", [&](Pose& p) { p(2, 1) = -kInf; }},
      {"is not finite: row 2, column 1 is nan", [](Pose& p) { p(1, 0) = std::nan(""); }},
      {"is not invertible: its matrix is zero", [](Pose& p) { p.linear().setZero(); }},
      {"is not invertible: it flattens what it places", [](Pose& p) { p(2, 2) = 0; }},
      {"is not invertible: it flattens what it places",
       [](Pose& p) { p.linear() << 1, 2, 3, 4, 5, 6, 7, 8, 9; }},
      {"is not invertible: it flattens what it places",
       [](Pose& p) { p.linear() << 1e-300, 0, 0, 0, 1e-300, 0, 0, 0, 0; }},
      {"leads too far away: coordinates may be 2^185 mesh extents",
       [](Pose& p) { p(1, 3) = 1e300; }},
  };
  for (const Case& each : cases) {
    Pose pose = Pose::Identity();
    each.spoil(pose);
    EXPECT_EQ(first_contact(cooked.tree, Pose::Identity(), cooked.tree, pose).code(),
              Errc::kInvalidPose)
        << each.fault;
    EXPECT_EQ(pose_fault(pose), each.fault);
  }
}

}  // namespace
}  // namespace boxtree::cooker
