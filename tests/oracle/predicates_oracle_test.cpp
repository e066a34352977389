// SPDX-License-Identifier: MIT
// orient3d, orient2d and triangles_intersect against CGAL in exact rational arithmetic, on doubles
// with all their bits in use.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <tests/unit/primitive/triangle_cases.h>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "tests/oracle/cgal_classifier.h"

namespace boxtree {
namespace {

using Kernel = test::ExactKernel;

constexpr int kPairsPerFamily = 20000;

Kernel::Point_3 to_cgal(const Eigen::Vector3d& v) {
  return test::to_cgal<Kernel>(v);
}

// Gives integer coordinates the noise of real ones: a rotation with its rounding, which turns exact
// contacts into contacts to within an ulp, or a shift by single ulps.
class Disturber {
 public:
  explicit Disturber(std::uint64_t seed) : random_(seed) {}

  void disturb(test::TrianglePair& pair) {
    const int kind = std::uniform_int_distribution<int>(0, 2)(random_);
    if (kind == 0) return;
    const double angle = std::uniform_real_distribution<double>(0, 3)(random_);
    const double sine = std::sin(angle), cosine = std::cos(angle);
    for (Triangle* t : {&pair.first, &pair.second}) {
      for (Eigen::Vector3d& c : t->corner) {
        const Eigen::Vector3d turned(cosine * c[0] - sine * c[1], sine * c[0] + cosine * c[1],
                                     c[2] / 3);
        c = kind == 1 ? turned : nudged(c);
      }
    }
  }

 private:
  Eigen::Vector3d nudged(Eigen::Vector3d v) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      for (int i = std::uniform_int_distribution<int>(0, 2)(random_); i > 0; --i) {
        // Not from zero to a subnormal: orient3d does not promise that range of magnitudes.
        const double step = v[k] == 0 ? 0x1p-200 : v[k] - std::nextafter(v[k], 0.0);
        v[k] += i == 1 ? step : -step;
      }
    }
    return v;
  }

  std::mt19937_64 random_;
};

class PredicatesOracle : public testing::TestWithParam<test::Family> {};

TEST_P(PredicatesOracle, TrianglesIntersect) {
  test::TriangleCases cases(0x0c6a1, 1 << 20);
  Disturber disturber(0xd15);
  int intersecting = 0;
  for (int i = 0; i < kPairsPerFamily; ++i) {
    test::TrianglePair pair = cases.pair(GetParam());
    disturber.disturb(pair);
    const bool expected = test::cgal_triangles_intersect<Kernel>(pair.first, pair.second);
    intersecting += expected;
    ASSERT_EQ(triangles_intersect(pair.first, pair.second), expected) << "pair " << i;
  }
  RecordProperty("intersecting", intersecting);
}

TEST_P(PredicatesOracle, Orientation) {
  test::TriangleCases cases(0x0713, 1 << 20);
  Disturber disturber(0xd16);
  for (int i = 0; i < kPairsPerFamily; ++i) {
    test::TrianglePair pair = cases.pair(GetParam());
    disturber.disturb(pair);
    const auto& p = pair.first.corner;
    for (const Eigen::Vector3d& d : pair.second.corner) {
      // CGAL's sign is that of the opposite convention: positive above the plane.
      const auto expected =
          -CGAL::orientation(to_cgal(p[0]), to_cgal(p[1]), to_cgal(p[2]), to_cgal(d));
      ASSERT_EQ(orient3d(p[0], p[1], p[2], d), static_cast<int>(expected)) << "pair " << i;
      const Eigen::Vector2d a = p[0].head<2>(), b = p[1].head<2>(), c = d.head<2>();
      const auto turn = CGAL::orientation(Kernel::Point_2(a[0], a[1]), Kernel::Point_2(b[0], b[1]),
                                          Kernel::Point_2(c[0], c[1]));
      ASSERT_EQ(orient2d(a, b, c), static_cast<int>(turn)) << "pair " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, PredicatesOracle, testing::ValuesIn(test::kFamilies),
                         [](const auto& tested) {
                           std::string name = test::name_of(tested.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace boxtree
