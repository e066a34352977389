// SPDX-License-Identifier: MIT
// Where triangles of two trees touch, against extended precision.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/shape_reference.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using test::LongTriangle;
using test::LongVector;

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

LongTriangle placed(const Tree& tree, const Pose& pose, const FaceRef& face, std::uint32_t half) {
  const LongTriangle triangle = test::long_triangle(test::require(tree.triangle(face, half)));
  LongTriangle out;
  for (std::size_t c = 0; c < 3; ++c) {
    out[c] =
        pose.linear().cast<long double>() * triangle[c] + pose.translation().cast<long double>();
  }
  return out;
}

long double highest(const LongTriangle& triangle, const LongVector& n) {
  return std::max({n.dot(triangle[0]), n.dot(triangle[1]), n.dot(triangle[2])});
}

// How far along a direction of length 1 the second has to move to be beyond the first.
long double depth_of(const LongTriangle& first, const LongTriangle& second, const LongVector& n) {
  return highest(first, n) + highest(second, -n);
}

long double off(const Eigen::Vector3d& point, const LongTriangle& triangle) {
  const LongVector p = point.cast<long double>();
  return test::distance_in_extended_precision({p, p, p}, triangle);
}

// The length of what a plane cuts out of both, which are not nearly in one plane.
long double shared_length(const LongTriangle& first, const LongTriangle& second) {
  const auto normal = [](const LongTriangle& t) {
    return LongVector((t[1] - t[0]).cross(t[2] - t[0]).normalized());
  };
  const LongVector along = normal(first).cross(normal(second)).normalized();
  const auto range = [&](const LongTriangle& cut, const LongTriangle& by) {
    const LongVector n = normal(by);
    std::pair<long double, long double> found{1e300L, -1e300L};
    for (std::size_t i = 0; i < 3; ++i) {
      const LongVector &a = cut[i], &b = cut[(i + 1) % 3];
      const long double of_a = n.dot(a - by[0]), of_b = n.dot(b - by[0]);
      if (std::abs(of_a) <= 1e-12L * (b - a).norm()) {  // in the plane
        found = {std::min(found.first, along.dot(a)), std::max(found.second, along.dot(a))};
      }
      if ((of_a < 0) == (of_b < 0)) continue;
      const long double at = along.dot(a + of_a / (of_a - of_b) * (b - a));
      found = {std::min(found.first, at), std::max(found.second, at)};
    }
    return found;
  };
  const auto a = range(first, second), b = range(second, first);
  return std::min(a.second, b.second) - std::max(a.first, b.first);
}

class PairContactsTest : public testing::TestWithParam<test::Encoding> {
 protected:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  void check(const Tree& first, const Pose& first_pose, const Tree& second,
             const Pose& second_pose) {
    Pairs pairs, touched;
    ASSERT_TRUE(overlap_pairs(first, first_pose, second, second_pose, [&](const FacePair& pair) {
      pairs.insert({pair.first.index, pair.second.index});
      return true;
    }));
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>> each;
    std::vector<PairContact> contacts;
    ASSERT_EQ(test::require(pair_contacts(first, first_pose, second, second_pose,
                                          [&](const PairContact& contact) {
                                            contacts.push_back(contact);
                                            return true;
                                          })),
              Visit::kComplete);
    for (const PairContact& contact : contacts) {
      const auto& [a, b] = contact.faces;
      touched.insert({a.index, b.index});
      EXPECT_TRUE(
          each.insert({a.index, b.index, contact.first_triangle, contact.second_triangle}).second);
      const LongTriangle of_a = placed(first, first_pose, a, contact.first_triangle);
      const LongTriangle of_b = placed(second, second_pose, b, contact.second_triangle);
      long double size = 0;
      for (const LongVector& c : of_a) size = std::max(size, c.cwiseAbs().maxCoeff());
      for (const LongVector& c : of_b) size = std::max(size, c.cwiseAbs().maxCoeff());
      const long double allowed = 0x1p-44L * size;
      for (const Eigen::Vector3d& point : {contact.start, contact.end, contact.point}) {
        ASSERT_LE(off(point, of_a), allowed);
        ASSERT_LE(off(point, of_b), allowed);
      }
      ASSERT_NEAR(contact.normal.norm(), 1, 1e-12);
      ASSERT_GE(contact.depth, 0);
      const LongVector normal = contact.normal.cast<long double>();
      ASSERT_LE(depth_of(of_a, of_b, normal), contact.depth + allowed);
      for (int i = 0; i < 40; ++i) {
        LongVector other = vector().cast<long double>().normalized();
        if (i % 2 == 0) other = (normal + 0.01L * other).normalized();
        ASSERT_GE(depth_of(of_a, of_b, other), contact.depth - allowed);
      }
      const auto area = [](const LongTriangle& t) -> LongVector {
        return (t[1] - t[0]).cross(t[2] - t[0]);
      };
      const LongVector m = area(of_a), n = area(of_b);
      if (m.norm() > 1e-3L * size * size && n.norm() > 1e-3L * size * size &&
          m.cross(n).norm() > 0.01L * m.norm() * n.norm()) {
        const long double length = shared_length(of_a, of_b);
        lengths_ += length > 0 ? 1 : 0;
        ASSERT_NEAR(static_cast<double>(std::max(0.0L, length)),
                    (contact.end - contact.start).norm(), 1e-9 * static_cast<double>(size));
      }
    }
    ASSERT_EQ(touched, pairs);
    count_ += contacts.size();
  }

  std::mt19937_64 random_{19};
  std::size_t count_ = 0, lengths_ = 0;
};

TEST_P(PairContactsTest, AreThoseOfExtendedPrecision) {
  for (const SourceMesh& mesh : test::all_kinds()) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree first = test::cook_tree(mesh, GetParam());
    const test::CookedTree second = test::cook_tree(test::soup(60, 4), GetParam());
    const Eigen::AlignedBox3d box = first.tree.bounds();
    const double fit = box.diagonal().norm() / second.tree.bounds().diagonal().norm();
    for (int i = 0; i < 4; ++i) {
      SCOPED_TRACE(i);
      Pose pose = Pose::Identity(), first_pose = Pose::Identity();
      if (i > 0) {
        first_pose.linear() =
            Eigen::Quaterniond(unit(), unit(), unit(), 0.4).normalized().toRotationMatrix() *
            (i > 1 ? 3.0 : 1.0);
        first_pose.translation() = vector();
      }
      pose.linear() = first_pose.linear() * fit;
      pose.translation() = first_pose * box.center() + 0.1 * fit * vector();
      check(first.tree, first_pose, second.tree, pose);
      if (HasFatalFailure()) return;
    }
    check(first.tree, Pose::Identity(), first.tree, Pose::Identity());  // in one plane
    if (HasFatalFailure()) return;
  }
  EXPECT_GT(count_, 500u);
  EXPECT_GT(lengths_, 20u);
}

INSTANTIATE_TEST_SUITE_P(Encodings, PairContactsTest,
                         testing::Values(test::Encoding{CodecId::kWide8, GeometryId::kExact},
                                         test::Encoding{CodecId::kWide4, GeometryId::kGrid},
                                         test::Encoding{CodecId::kPlainF32, GeometryId::kArrays}),
                         test::encoding_name);

SourceMesh one_triangle(std::vector<float> corners) {
  SourceMesh mesh;
  mesh.name = "triangle";
  mesh.positions.f32 = std::move(corners);
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  return mesh;
}

PairContact only_contact(const SourceMesh& first, const SourceMesh& second) {
  const test::CookedTree a = test::cook_tree(first, CodecId::kWide8);
  const test::CookedTree b = test::cook_tree(second, CodecId::kWide8);
  std::vector<PairContact> contacts;
  EXPECT_TRUE(pair_contacts(a.tree, Pose::Identity(), b.tree, Pose::Identity(),
                            [&](const PairContact& contact) {
                              contacts.push_back(contact);
                              return true;
                            }));
  EXPECT_EQ(contacts.size(), 1u);
  return contacts.empty() ? PairContact() : contacts[0];
}

TEST(PairContact, OfCrossingTrianglesIsTheirSegment) {
  const SourceMesh floor = one_triangle({-4, -4, 0, 4, -4, 0, 0, 4, 0});
  // Dips into the floor by 1/4.
  const PairContact contact = only_contact(floor, one_triangle({0, 0, -0.25, 1, 0, 1, -1, 0, 1}));
  EXPECT_NEAR(std::abs(contact.end.x() - contact.start.x()), 0.4, 1e-12);
  EXPECT_NEAR(contact.point.norm(), 0, 1e-12);
  EXPECT_NEAR((contact.normal - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-12);
  EXPECT_NEAR(contact.depth, 0.25, 1e-12);
}

TEST(PairContact, OfACornerOnAFaceIsThePoint) {
  const SourceMesh floor = one_triangle({-4, -4, 0, 4, -4, 0, 0, 4, 0});
  const PairContact contact = only_contact(floor, one_triangle({0.5, 0, 0, 1, 0, 1, -1, 0, 1}));
  EXPECT_NEAR((contact.start - contact.end).norm(), 0, 1e-12);
  EXPECT_NEAR((contact.point - Eigen::Vector3d(0.5, 0, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(contact.depth, 0);
}

TEST(PairContact, InOnePlaneSharesAPolygon) {
  const SourceMesh floor = one_triangle({0, 0, 0, 4, 0, 0, 0, 4, 0});
  const PairContact contact = only_contact(floor, one_triangle({1, 1, 0, -1, 1, 0, 1, -1, 0}));
  // The corners (1,1), (0,1), (0,0) and (1,0).
  EXPECT_NEAR((contact.end - contact.start).norm(), std::sqrt(2), 1e-12);
  EXPECT_NEAR((contact.point - Eigen::Vector3d(0.5, 0.5, 0)).norm(), 0, 1e-12);
  EXPECT_EQ(contact.depth, 0);
  EXPECT_EQ(std::abs(contact.normal.z()), 1);
}

TEST(PairContact, OfTrianglesWithoutAreaIsAPointOfBoth) {
  const SourceMesh line = one_triangle({-1, 0, 0, 1, 0, 0, 1, 0, 0});
  const PairContact crossing = only_contact(line, one_triangle({0, -1, 0, 0, 1, 0, 0, 1, 0}));
  EXPECT_NEAR(crossing.point.norm(), 0, 1e-12);
  EXPECT_NEAR(crossing.normal.norm(), 1, 1e-12);
  EXPECT_EQ(crossing.depth, 0);
  const PairContact along = only_contact(line, one_triangle({0, 0, 0, 3, 0, 0, 3, 0, 0}));
  EXPECT_NEAR(along.normal.norm(), 1, 1e-12);
  EXPECT_NEAR(along.normal.x(), 0, 1e-12);
  EXPECT_EQ(along.depth, 0);
  EXPECT_NEAR((along.end - along.start).norm(), 1, 1e-12);
  const PairContact with_itself = only_contact(line, line);
  EXPECT_NEAR((with_itself.end - with_itself.start).norm(), 2, 1e-12);
}

// Ends were lost where an edge is met at a sharp angle.
TEST(PairContact, InOnePlaneHasTheEndsThatAreFarthestApart) {
  const SourceMesh first = one_triangle({0.5, 1, 2.5, 0.5, 1, -1.5, 0.5, 0, 2.5});
  const SourceMesh second = one_triangle({0.5, 3.5, -0.25, 0.5, -0.5, 0, 0.5, 2.5, 0});
  const Eigen::Vector3d start(0.5, 0.625, 0), end(0.5, 1, -0.09375);
  for (const PairContact& contact : {only_contact(first, second), only_contact(second, first)}) {
    EXPECT_NEAR((contact.end - contact.start).norm(), (end - start).norm(), 1e-12);
    EXPECT_NEAR((contact.point - (start + end) / 2).norm(), 0, 1e-12);
  }
  const PairContact segment =
      only_contact(one_triangle({-2.5, 0, 0.5, -2.5, -4, 1.5, -2.5, 0, 1.5}),
                   one_triangle({-2.5, -0.5, 1, -2.5, -1.5, 0, -2.5, -3.5, -2}));
  EXPECT_NEAR((segment.end - segment.start).norm(), std::hypot(0.3, 0.3), 1e-12);
}

// The longest distance of points that both triangles in the plane z = 0 share: corners of one in
// the other, and where edges cross. Negative if they share none.
double longest_shared(const std::array<LongVector, 3>& first,
                      const std::array<LongVector, 3>& second) {
  const auto side = [](const LongVector& a, const LongVector& b, const LongVector& p) {
    return (b - a).cross(p - a).z();
  };
  std::vector<LongVector> shared;
  for (const auto& [of, in] : {std::pair{&first, &second}, std::pair{&second, &first}}) {
    for (const LongVector& p : *of) {
      int left = 0, right = 0;
      for (std::size_t e = 0; e < 3; ++e) {
        const long double at = side((*in)[e], (*in)[(e + 1) % 3], p);
        left += at >= 0 ? 1 : 0;
        right += at <= 0 ? 1 : 0;
      }
      if (left == 3 || right == 3) shared.push_back(p);
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const LongVector &a = first[i], &b = first[(i + 1) % 3];
      const LongVector &c = second[j], &d = second[(j + 1) % 3];
      const long double of_a = side(c, d, a), of_b = side(c, d, b);
      const long double of_c = side(a, b, c), of_d = side(a, b, d);
      if (of_a * of_b >= 0 || of_c * of_d > 0) continue;
      shared.emplace_back(a + of_a / (of_a - of_b) * (b - a));
    }
  }
  double longest = -1;
  for (const LongVector& a : shared) {
    for (const LongVector& b : shared) {
      longest = std::max(longest, static_cast<double>((a - b).norm()));
    }
  }
  return longest;
}

TEST(PairContact, OfRandomTrianglesInOnePlaneIsWhatTheyShare) {
  std::mt19937 random(11);
  int touching = 0;
  while (touching < 300) {
    std::array<std::array<LongVector, 3>, 2> corners;
    std::array<std::vector<float>, 2> numbers;
    bool have_areas = true;
    for (std::size_t t = 0; t < 2; ++t) {
      for (LongVector& corner : corners[t]) {
        const auto next = [&] { return static_cast<float>(random() % 17) / 2 - 4; };
        const float x = next(), y = next();
        corner = LongVector(x, y, 0);
        numbers[t].insert(numbers[t].end(), {x, y, 0});
      }
      const LongVector normal =
          (corners[t][1] - corners[t][0]).cross(corners[t][2] - corners[t][0]);
      have_areas = have_areas && normal.z() != 0;
    }
    if (!have_areas) continue;
    const double longest = longest_shared(corners[0], corners[1]);
    if (longest < 0) continue;
    ++touching;
    const PairContact contact = only_contact(one_triangle(numbers[0]), one_triangle(numbers[1]));
    EXPECT_NEAR((contact.end - contact.start).norm(), longest, 1e-12);
  }
}

}  // namespace
}  // namespace boxtree
