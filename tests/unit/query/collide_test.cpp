// SPDX-License-Identifier: MIT
// Contacts of shapes against extended precision: which triangles are touched, and how deep.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/contact_bits.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/reaching_shapes.h"
#include "tests/support/require.h"
#include "tests/support/shape_reference.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using test::depth_along;
using test::LongShape;
using test::LongTriangle;
using test::LongVector;

// What collide.h allows, in units of the largest coordinate.
constexpr long double kContactDoubt = 0x1p-46L;

class Collide : public testing::TestWithParam<test::Encoding> {
 protected:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

  template <class Shape>
  void check(const Tree& tree, const Shape& shape, double size) {
    const LongShape exact = test::long_shape(shape);
    const long double doubt = kContactDoubt * (size + exact.center.cwiseAbs().maxCoeff() +
                                               2 * (exact.reach + exact.radius));
    std::vector<Contact> contacts;
    ASSERT_EQ(test::require(collide(tree, shape,
                                    [&](const Contact& contact) {
                                      contacts.push_back(contact);
                                      return true;
                                    })),
              Visit::kComplete);
    std::set<std::pair<std::uint32_t, std::uint32_t>> touched;
    for (const Contact& contact : contacts) {
      SCOPED_TRACE(contact.face.index);
      EXPECT_TRUE(touched.insert({contact.face.index, contact.triangle}).second);
      const LongTriangle triangle =
          test::long_triangle(test::require(tree.triangle(contact.face, contact.triangle)));
      const long double distance = test::distance(exact, LongVector::Zero(), triangle);
      ASSERT_LE(distance, exact.radius + doubt);
      // The point is where they are said to touch.
      const LongVector point = contact.point.cast<long double>();
      ASSERT_LE(test::distance_in_extended_precision({point, point, point}, triangle), 4 * doubt);
      ASSERT_LE(test::distance(exact, LongVector::Zero(), {point, point, point}),
                exact.radius + 4 * doubt);
      // Moved by the depth along the normal they do not overlap any more, and did a little before.
      ASSERT_NEAR(contact.normal.norm(), 1, 1e-12);
      ASSERT_GE(contact.depth, 0);
      const LongVector normal = contact.normal.cast<long double>();
      ASSERT_LE(depth_along(exact, normal, triangle), contact.depth + 8 * doubt);
      // No other way is shorter.
      for (int i = 0; i < 100; ++i) {
        LongVector other = vector().cast<long double>().normalized();
        if (i % 2 == 0) other = (normal + 0.01L * other).normalized();
        ASSERT_GE(depth_along(exact, other, triangle), contact.depth - 8 * doubt);
      }
      has_deep_ |= contact.depth > static_cast<double>(exact.radius);
    }
    for (std::uint32_t f = 0; f < tree.face_count(); ++f) {
      for (std::uint32_t half = 0; half < 2; ++half) {
        const Result<Triangle> triangle = tree.triangle({kNoFaceId, f}, half);
        if (!triangle || touched.contains({f, half})) continue;
        ASSERT_GT(test::distance(exact, LongVector::Zero(), test::long_triangle(*triangle)),
                  exact.radius);
      }
    }
    count_ += touched.size();
    // Faces, each once.
    std::set<std::uint32_t> faces, overlapped;
    for (const auto& [face, half] : touched) faces.insert(face);
    const auto note = [&](const FaceRef& face) {
      EXPECT_TRUE(overlapped.insert(face.index).second);
      return true;
    };
    if constexpr (std::is_same_v<Shape, Capsule>) {
      ASSERT_TRUE(overlap_capsule(tree, shape, note));
      ASSERT_EQ(overlapped, faces);
    } else if constexpr (std::is_same_v<Shape, OrientedBox>) {
      ASSERT_TRUE(overlap_oriented_box(tree, shape, note));
      ASSERT_EQ(overlapped, faces);
    } else if constexpr (std::is_same_v<Shape, ConvexHull>) {
      ASSERT_TRUE(overlap_convex_hull(tree, shape, note));
      ASSERT_EQ(overlapped, faces);
    }
  }

  template <class Body>
  void for_each_place(int count, const Body& body) {
    for (const SourceMesh& mesh : test::all_kinds()) {
      SCOPED_TRACE(mesh.name);
      const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
      const Eigen::AlignedBox3d box = cooked.tree.bounds();
      const double size = box.diagonal().norm();
      for (int i = 0; i < count; ++i) {
        SCOPED_TRACE(i);
        Eigen::Vector3d at = box.center() + 0.6 * vector().cwiseProduct(box.sizes());
        if (i % 3 == 1) at = closest_point(cooked.tree, at)->point;  // on the surface
        body(cooked.tree, at, size, 0.02 * size * std::pow(8.0, unit()));
        if (HasFatalFailure()) return;
      }
    }
    EXPECT_GT(count_, 100u);
  }

  std::mt19937_64 random_{7};
  std::size_t count_ = 0;
  bool has_deep_ = false;
};

TEST_P(Collide, ASphereIsThatOfExtendedPrecision) {
  for_each_place(12, [&](const Tree& tree, const Eigen::Vector3d& at, double size, double radius) {
    check(tree, Sphere{at, radius}, size);
  });
}

TEST_P(Collide, ACapsuleIsThatOfExtendedPrecision) {
  for_each_place(12, [&](const Tree& tree, const Eigen::Vector3d& at, double size, double radius) {
    check(tree, Capsule{at, at + 0.1 * size * vector(), radius}, size);
  });
  EXPECT_TRUE(has_deep_);
}

TEST_P(Collide, ABoxIsThatOfExtendedPrecision) {
  for_each_place(6, [&](const Tree& tree, const Eigen::Vector3d& at, double size, double radius) {
    OrientedBox box;
    box.center = at;
    box.half_extents = radius * (vector() + Eigen::Vector3d::Constant(1.1));
    if (random_() % 3 != 0) box.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(tree, box, size);
  });
}

TEST_P(Collide, AHullIsThatOfExtendedPrecision) {
  for_each_place(4, [&](const Tree& tree, const Eigen::Vector3d& at, double size, double radius) {
    std::vector<Eigen::Vector3d> points;
    const std::size_t kind = random_() % 4;
    for (std::size_t i = 0; i < 1 + random_() % 7; ++i) {
      Eigen::Vector3d point = radius * vector();
      if (kind == 1) point[2] = 0;
      if (kind == 2 && i % 2 == 1) point = points.back();
      points.push_back(point);
    }
    ConvexHull hull;
    hull.points = points;
    hull.position = at;
    if (random_() % 3 != 0) hull.rotation.coeffs() << unit(), unit(), unit(), unit();
    check(tree, hull, size);
  });
}

// Of as many points as there may be, whose hull is nearly a ball.
TEST_P(Collide, AHullOfManyPointsIsNearlyABall) {
  const test::CookedTree cooked = test::cook_tree(test::terrain(8, 3), GetParam());
  const Eigen::AlignedBox3d bounds = cooked.tree.bounds();
  const double radius = 0.2 * bounds.diagonal().norm();
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < kMaxHullPoints; ++i) {
    points.push_back(radius * vector().normalized());
  }
  ConvexHull hull;
  hull.points = points;
  for (int n = 0; n < 8; ++n) {
    hull.position = closest_point(cooked.tree, bounds.center() + vector())->point;
    ASSERT_TRUE(collide(cooked.tree, hull, [&](const Contact& contact) {
      const Triangle triangle = test::require(cooked.tree.triangle(contact.face, contact.triangle));
      const LongTriangle exact = test::long_triangle(triangle);
      const LongShape shape = test::long_shape(hull);
      const LongVector normal = contact.normal.cast<long double>();
      EXPECT_NEAR(static_cast<double>(depth_along(shape, normal, exact)), contact.depth,
                  1e-12 * radius);
      for (int i = 0; i < 1000; ++i) {
        LongVector other = vector().cast<long double>().normalized();
        if (i % 2 == 0) other = (normal + 0.05L * other).normalized();
        EXPECT_GE(depth_along(shape, other, exact), contact.depth - 1e-12 * radius);
      }
      return true;
    }));
  }
}

// A sphere leaves a triangle soonest away from the point closest to its center, however near it is:
// the depth is the radius less that distance. Near an edge, rounding tilts the line between them.
TEST_P(Collide, ASphereNearlyCenteredOnAnEdgeIsAsDeepAsItIs) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(6, 8), GetParam());
  std::size_t count = 0;
  for (std::uint32_t f = 0; f < cooked.tree.face_count(); ++f) {
    for (int exponent = 1; exponent < 50; ++exponent) {
      const auto corner = test::require(cooked.tree.triangle({kNoFaceId, f}, 0)).corner;
      const Eigen::Vector3d on = corner[0] + 0.5 * (1 + unit()) * (corner[1] - corner[0]);
      const Eigen::Vector3d out = corner[0] + corner[1] - 2 * corner[2] + vector();
      const Sphere sphere{on + std::ldexp(out.norm(), -exponent) * out.normalized(), 1.5};
      const LongShape exact = test::long_shape(sphere);
      ASSERT_TRUE(collide(cooked.tree, sphere, [&](const Contact& contact) {
        const LongTriangle triangle = test::long_triangle(
            test::require(cooked.tree.triangle(contact.face, contact.triangle)));
        const long double distance = test::distance(exact, LongVector::Zero(), triangle);
        EXPECT_LE(contact.depth, 1.5L - distance + 4 * kContactDoubt) << f << " 2^-" << exponent;
        EXPECT_GE(contact.depth, 1.5L - distance - 4 * kContactDoubt) << f << " 2^-" << exponent;
        ++count;
        return true;
      }));
    }
  }
  EXPECT_GT(count, 10'000u);
}

INSTANTIATE_TEST_SUITE_P(Encodings, Collide,
                         testing::Values(test::Encoding{CodecId::kWide8, GeometryId::kExact},
                                         test::Encoding{CodecId::kWide4, GeometryId::kGrid},
                                         test::Encoding{CodecId::kPlainF32, GeometryId::kArrays}),
                         test::encoding_name);

// Faces that are a segment, whose first corners are one, and a point, with shapes that are a point:
// the normal leads away from the segment, and there is one where both are a point.
TEST(CollideWithoutSize, HasANormalAndNoDepth) {
  SourceMesh mesh;
  mesh.name = "segment and point";
  mesh.positions.f32 = {0, 0, 0, 0, 0, 0, 8, 0, 0, 1, 2, 3, 1, 2, 3, 1, 2, 3};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}, {{3, 4, 5, cooker::kNoCorner}}};
  const std::vector<Eigen::Vector3d> none(2, Eigen::Vector3d::Zero());
  for (const test::Encoding& encoding : test::all_encodings()) {
    const test::CookedTree cooked = test::cook_tree(mesh, encoding);
    for (const auto& [at, face] : {std::pair(Eigen::Vector3d(2, 0, 0), 0u), {{1, 2, 3}, 1u}}) {
      const auto check = [&, at = at, face = face](const auto& shape) {
        std::size_t count = 0;
        ASSERT_TRUE(collide(cooked.tree, shape, [&](const Contact& contact) {
          ++count;
          EXPECT_EQ(contact.face.id, face);
          EXPECT_EQ(contact.depth, 0);
          EXPECT_NEAR(contact.normal.norm(), 1, 1e-12);
          EXPECT_TRUE(face != 0 || std::abs(contact.normal.x()) < 1e-12);
          EXPECT_EQ(contact.point, at);
          return true;
        }));
        EXPECT_EQ(count, 1u);
      };
      check(Sphere{at, 0});
      check(Capsule{at, at, 0});
      check(ConvexHull{none, at, {1, 0, 0, 0}});
    }
  }
}

// Found by an independent oracle: where rounding put the closest point beside the center, the way
// out was along the segment, to its end.
TEST(CollideOnASegment, IsAcrossIt) {
  SourceMesh mesh;
  mesh.name = "segments";
  mesh.positions.f32 = {0, 0, 0, 4277.992f, 0, 0, 17111.969f, 0, 0, 3, 4, -7, 4, 5, -9, 0, 1, -1};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}, {{3, 4, 5, cooker::kNoCorner}}};
  std::mt19937_64 random(0x5e6);
  for (const test::Encoding& encoding : test::all_encodings()) {
    if (encoding.geometry == GeometryId::kGrid) continue;
    const test::CookedTree cooked = test::cook_tree(mesh, encoding);
    for (int i = 0; i < 200; ++i) {
      const double share = std::uniform_real_distribution<double>(0.01, 0.99)(random);
      const Eigen::Vector3d along(17111.969f, 0, 0);
      const Eigen::Vector3d at = share * along;
      const auto check = [&](const auto& shape, double depth) {
        std::size_t count = 0;
        ASSERT_TRUE(collide(cooked.tree, shape, [&](const Contact& contact) {
          if (contact.face.id != 0) return true;
          ++count;
          EXPECT_NEAR(contact.depth, depth, 1e-9);
          EXPECT_NEAR(contact.normal.x(), 0, 1e-12);
          EXPECT_NEAR(contact.normal.norm(), 1, 1e-12);
          return true;
        }));
        EXPECT_EQ(count, 1u);
      };
      check(Sphere{at, 1}, 1);
      check(Sphere{at, 0}, 0);
      check(Capsule{at, at, 1}, 1);
      check(Capsule{at, at + Eigen::Vector3d(7, 0, 0), 2}, 2);
    }
  }
}

// Found by an independent oracle: the point was 55 times the size of the hull beside it, since of
// two closest corners that were one its weights were those of the other.
TEST(CollideWithATinyHull, HasAPointInsideBoth) {
  SourceMesh mesh;
  mesh.name = "face";
  mesh.positions.f32 = {1, 4, 0, 3, 1, 0, 3, 0, 2};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const test::CookedTree cooked = test::cook_tree(mesh, {CodecId::kWide8, GeometryId::kExact});
  const Eigen::Vector3d at(2.4999998876273599, 1.0000000192317071, 1.4999999461133791);
  const std::vector<Eigen::Vector3d> points = {
      {6.2058636549938111e-07, -3.0204008161183276e-07, -3.7781919322670998e-08},
      {-3.3607341437441632e-07, -6.1310234316919073e-07, 1.7846581730078167e-07},
      {7.725043735595934e-08, -2.3817502317115143e-07, 1.4696443250459772e-07},
      {-5.1563939566965023e-07, 2.7934545265421399e-07, 3.7333265166569574e-07}};
  std::size_t count = 0;
  ASSERT_TRUE(collide(cooked.tree, ConvexHull{points, at, {1, 0, 0, 0}}, [&](const Contact& each) {
    ++count;
    // Inside of the four faces of the tetrahedron.
    const Eigen::Vector3d point = each.point - at;
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d &a = points[i], &b = points[(i + 1) % 4], &c = points[(i + 2) % 4],
                            &d = points[(i + 3) % 4];
      const Eigen::Vector3d normal = (b - a).cross(c - a).normalized();
      const double inner = normal.dot(d - a);
      EXPECT_GT(normal.dot(point - a) * (inner > 0 ? 1 : -1), -1e-12);
    }
    return true;
  }));
  EXPECT_EQ(count, 1u);
}

std::vector<test::ContactBits> contacts_of(const Tree& tree, const Sphere& sphere,
                                           std::size_t most = SIZE_MAX) {
  std::vector<test::ContactBits> all;
  EXPECT_TRUE(collide(tree, sphere, [&](const Contact& contact) {
    all.push_back(test::bits_of(contact));
    return all.size() < most;
  }));
  return all;
}

// A triangle of one of the kinds that need care.
std::array<Eigen::Vector3f, 3> strange_triangle(std::mt19937_64& random, int kind) {
  const auto unit = [&] { return std::uniform_real_distribution<float>(-1, 1)(random); };
  const auto vector = [&] { return Eigen::Vector3f(unit(), unit(), unit()); };
  const Eigen::Vector3f a = vector(), b = vector(), c = vector();
  const float tiny = std::ldexp(1.0f, -3 * (kind / 8));
  switch (kind % 8) {
    case 0:
      return {a, b, c};
    case 1:
      return {a, a + tiny * b, a + tiny * c};  // small
    case 2:
      return {a, b, a + 0.5f * (b - a) + tiny * c};  // nearly collinear
    case 3:
      return {a, a + tiny * b, c};  // a needle with a short first edge
    case 4:
      return {a, b, b + tiny * c};  // and with a short second one
    case 5:
      return {a, b, a};  // two corners in one point
    case 6:
      return {a, a, a};
    default:
      return {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(unit(), 0, 0),
              Eigen::Vector3f(unit(), unit(), 0)};  // zeros
  }
}

// Vectors compute several contacts together, doubles one: the same bits, for each store, and the
// same that a visitor gets who stops early.
TEST(CollideWithASphere, HasTheSameBitsByVectors) {
  std::mt19937_64 random(11);
  const auto unit = [&] { return std::uniform_real_distribution<double>(-1, 1)(random); };
  std::vector<SourceMesh> meshes = test::all_kinds();
  for (const double scale : {1.0, 0x1p-60, 0x1p40}) {
    SourceMesh mesh;
    mesh.name = "strange triangles";
    for (std::uint32_t f = 0; f < 600; ++f) {
      for (const Eigen::Vector3f& corner : strange_triangle(random, static_cast<int>(f) % 64)) {
        for (const float x : corner) {
          mesh.positions.f32.push_back(static_cast<float>(scale * double{x}));
        }
      }
      mesh.faces.push_back({{3 * f, 3 * f + 1, 3 * f + 2, cooker::kNoCorner}});
    }
    meshes.push_back(std::move(mesh));
  }
  std::size_t count = 0, of_faces = 0;
  for (const SourceMesh& mesh : meshes) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree plain = test::cook_tree(mesh, {CodecId::kPlainF32, GeometryId::kArrays});
    const double size = plain.tree.bounds().diagonal().norm();
    for (const test::Encoding& encoding : {test::Encoding{CodecId::kWide8, GeometryId::kArrays},
                                           test::Encoding{CodecId::kWide8, GeometryId::kExact},
                                           test::Encoding{CodecId::kWide4, GeometryId::kExact}}) {
      const test::CookedTree wide = test::cook_tree(mesh, encoding);
      for (int i = 0; i < 60; ++i) {
        // Around a point of a triangle: a corner, one of an edge, one inside; or beside it.
        const auto face = static_cast<std::uint32_t>(random() % wide.tree.face_count());
        const auto corner = test::require(wide.tree.triangle({kNoFaceId, face}, 0)).corner;
        const double s = i % 4 == 0 ? 0 : 0.5 + 0.5 * unit(),
                     t = i % 4 < 2 ? 0 : s * (0.5 + 0.5 * unit());
        const Eigen::Vector3d on =
            corner[0] + s * (corner[1] - corner[0]) + t * (corner[2] - corner[1]);
        const double off = i % 3 == 0 ? 0 : size * std::ldexp(1.0, -3 - i % 50);
        const Eigen::Vector3d at = on + off * Eigen::Vector3d(unit(), unit(), unit());
        double radius = size * std::ldexp(1.0, -1 - i % 9);
        // That it may just touch.
        if (i % 5 == 0) radius = (at - corner[static_cast<std::size_t>(i % 3)]).norm();
        const Sphere sphere{at, radius};
        auto expected = contacts_of(plain.tree, sphere);
        auto found = contacts_of(wide.tree, sphere);
        const auto in_order = found;
        std::ranges::sort(expected);
        std::ranges::sort(found);
        ASSERT_EQ(found, expected)
            << test::encoding_name(testing::TestParamInfo<test::Encoding>(encoding, 0)) << ' ' << i;
        count += found.size();
        for (const auto& contact : found) of_faces += std::size_t{contact[2] == 0};
        const std::size_t most = 1 + random() % 9;
        if (most > in_order.size()) continue;
        const std::vector first(in_order.begin(),
                                in_order.begin() + static_cast<std::ptrdiff_t>(most));
        ASSERT_EQ(contacts_of(wide.tree, sphere, most), first) << i;
      }
    }
  }
  EXPECT_GT(count, 20'000u);
  EXPECT_GT(of_faces, 1'000u);
}

template <class Shape>
std::set<std::uint32_t> touched_faces(const Tree& tree, const Shape& shape) {
  std::set<std::uint32_t> faces;
  EXPECT_TRUE(collide(tree, shape, [&](const Contact& contact) {
    faces.insert(contact.face.index);
    return true;
  }));
  return faces;
}

// Where the faces alone are wanted, vectors see of most that they touch: not of one that does not,
// or hardly does.
TEST(OverlapOfShapes, IsWhereContactsAre) {
  std::mt19937_64 random(13);
  test::ReachingShapes shapes(random);
  std::vector<SourceMesh> meshes = test::all_kinds();
  SourceMesh strange;
  strange.name = "strange triangles";
  for (std::uint32_t f = 0; f < 600; ++f) {
    for (const Eigen::Vector3f& corner : strange_triangle(random, static_cast<int>(f) % 64)) {
      for (const float x : corner) strange.positions.f32.push_back(x);
    }
    strange.faces.push_back({{3 * f, 3 * f + 1, 3 * f + 2, cooker::kNoCorner}});
  }
  meshes.push_back(std::move(strange));
  constexpr std::array<double, 6> kTiny = {0,
                                           1e-30,
                                           1e-45,
                                           1e-60,
                                           std::numeric_limits<double>::min(),
                                           std::numeric_limits<double>::denorm_min()};
  std::size_t count = 0;
  for (const SourceMesh& mesh : meshes) {
    SCOPED_TRACE(mesh.name);
    for (const test::Encoding& encoding : {test::Encoding{CodecId::kWide8, GeometryId::kArrays},
                                           test::Encoding{CodecId::kWide4, GeometryId::kExact}}) {
      const test::CookedTree cooked = test::cook_tree(mesh, encoding);
      const Tree& tree = cooked.tree;
      const double size = tree.bounds().diagonal().norm();
      for (int i = 0; i < 100; ++i) {
        SCOPED_TRACE(i);
        const auto face = static_cast<std::uint32_t>(random() % tree.face_count());
        const Eigen::Vector3d at = test::require(tree.triangle({kNoFaceId, face}, 0)).corner[0];
        // More than it takes to touch the corner, or less, by down to what rounds away.
        const double more = 1 + (i % 2 == 0 ? 1 : -1) * std::ldexp(1.0, -2 - i % 53);
        const double extent = size * std::ldexp(1.0, -1 - i % 9);
        const auto note = [](std::set<std::uint32_t>& faces) {
          return [&faces](const FaceRef& found) { return faces.insert(found.index).second; };
        };
        const Capsule capsule = shapes.capsule(at, extent, more);
        std::set<std::uint32_t> overlapped;
        ASSERT_TRUE(overlap_capsule(tree, capsule, note(overlapped)));
        ASSERT_EQ(overlapped, touched_faces(tree, capsule));
        count += overlapped.size();

        // Next to no radius, in double or in float, nearly on the corner.
        const Eigen::Vector3d along = extent * shapes.vector();
        const double off = size * std::ldexp(1.0, -10 - i % 40);
        const Capsule thin{at + off * shapes.vector() + along, at + off * shapes.vector() - along,
                           kTiny[static_cast<std::size_t>(i) % kTiny.size()]};
        overlapped.clear();
        ASSERT_TRUE(overlap_capsule(tree, thin, note(overlapped)));
        ASSERT_EQ(overlapped, touched_faces(tree, thin));

        const OrientedBox box = shapes.box(at, extent, more);
        overlapped.clear();
        ASSERT_TRUE(overlap_oriented_box(tree, box, note(overlapped)));
        ASSERT_EQ(overlapped, touched_faces(tree, box));
        count += overlapped.size();
      }
    }
  }
  EXPECT_GT(count, 20'000u);
}

// Its radius is less than what the middle of its ends rounds.
TEST(CollideFarFromTheOrigin, ACapsuleWhoseMiddleRoundsMissesNothing) {
  SourceMesh mesh;
  mesh.name = "far face";
  mesh.positions.precision = cooker::Precision::kF64;
  mesh.positions.f64 = {-0x1.48f29c392ccc5p+22, 0x1.a7708179f04b1p+24, -0x1.e5b541d413e63p+22,
                        -0x1.48f2986fc4ab8p+22, 0x1.a7708230a4023p+24, -0x1.e5b5441b514e5p+22,
                        -0x1.48f298b9d2e79p+22, 0x1.a77081aaff03fp+24, -0x1.e5b53df24d679p+22};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const Eigen::Vector3d start(-0x1.48f29b48ff065p+22, 0x1.a77081a03f374p+24,
                              -0x1.e5b5420b7ebffp+22);
  Eigen::Vector3d end = start;
  end.x() = std::nextafter(end.x(), 0);
  for (const test::Encoding& encoding : test::all_encodings()) {
    if (encoding.geometry == GeometryId::kGrid) continue;
    const test::CookedTree cooked = test::cook_tree(mesh, encoding);
    std::size_t count = 0;
    ASSERT_TRUE(collide(cooked.tree, Capsule{start, end, 0x1.2ec4c9a61afd6p-30},
                        [&](const Contact&) { return ++count > 0; }));
    EXPECT_EQ(count, 1u);
  }
}

// A face 2^26 times as long as it is wide, along whose plane a point moves, 2^-40 of its length
// away: the line to the closest point is tilted by rounding and shows no gap.
TEST(CastBesideANeedle, OfAPointInParallelTouchesNothing) {
  SourceMesh mesh;
  mesh.name = "needle";
  mesh.positions.f32 = {0x1.57p-141f,     -0x1.fc920ap+94f, 0x1.a57ab8p+114f,
                        -0x1.ae3398p+88f, 0x1.ea6da2p+33f,  0x1.03132p-26f,
                        0x1.f2103cp-5f,   0x1.dd36fap-116f, 0x1.9ede32p+30f};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const Sphere point{{-0x1.1f1953592464ep+88, -0x1.1b07da01abeffp+93, 0x1.d51fc6e45f31ap+112}, 0};
  for (const test::Encoding& encoding : test::all_encodings()) {
    if (encoding.geometry == GeometryId::kGrid) continue;
    const test::CookedTree cooked = test::cook_tree(mesh, encoding);
    const auto hit = cast_closest(cooked.tree, point, {{0x1.151499b04bc78p+114, 0, 0}, 1});
    ASSERT_TRUE(hit.ok());
    EXPECT_FALSE(hit.has_value());
  }
}

// It flies past nearly in parallel, at first six roundings of the face's size away from touching.
TEST(CastBesideAFace, OfATinyCapsuleDoesNotTouchAtOnce) {
  SourceMesh mesh;
  mesh.name = "large face";
  mesh.positions.precision = cooker::Precision::kF64;
  mesh.positions.f64 = {0, 0, -0x1p+157, 0x1p+157, 0, 0x1p+156, 0, 0x1p+157, 0x1p+157};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const Capsule capsule{{0x1.7ab3231a06908p+152, 0x1.b819ac59024dap+156, 0x1.93b423fc76791p+156},
                        {0x1.7ab32319fc93fp+152, 0x1.b819ac590221ap+156, 0x1.93b423fc76bd5p+156},
                        0x1.b3c650a9d9313p+114};
  const Eigen::Vector3d direction(0x1.7f8b31b6de90cp+155, -0x1.b819ac59024dap+156,
                                  -0x1.284579b46f778p+157);
  for (const test::Encoding& encoding : test::all_encodings()) {
    if (encoding.geometry == GeometryId::kGrid) continue;
    const test::CookedTree cooked = test::cook_tree(mesh, encoding);
    const auto hit = cast_closest(cooked.tree, capsule, {direction, 1});
    ASSERT_TRUE(hit.has_value());
    EXPECT_GT(hit->t_lower, 1e-3);
  }
}

// Where a small flat hull is nearly in the plane of a triangle, projections from the one to the
// other hardly move: the point was up to a hundredth of its size beside it.
TEST(CollideHull, PointsOfSmallFlatHullsLieInThem) {
  SourceMesh mesh;
  mesh.name = "triangle";
  mesh.positions.f32 = {3, 4, 0, 0, 2, 2, 4, 4, 2};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8);
  const Triangle triangle = test::require(cooked.tree.triangle({0, 0}, 0));
  const Eigen::Vector3d e1 = triangle.corner[1] - triangle.corner[0];
  const Eigen::Vector3d e2 = triangle.corner[2] - triangle.corner[0];
  const Eigen::Vector3d n = e1.cross(e2).normalized(), u = e1.normalized(), v = n.cross(u);
  std::mt19937_64 random(12);
  std::uniform_real_distribution<double> unit(0, 1), both(-1, 1);
  int touching = 0;
  for (int i = 0; i < 4000; ++i) {
    const double angle = std::pow(10, -6 * unit(random)),
                 size = std::pow(10, -2 - 5 * unit(random));
    const Eigen::Vector3d across = std::cos(angle) * v + std::sin(angle) * n;
    std::array<Eigen::Vector3d, 3> points;
    for (Eigen::Vector3d& point : points) {
      point = size * (both(random) * u + both(random) * across);
    }
    ConvexHull hull;
    hull.points = points;
    hull.position =
        triangle.corner[0] + (0.2 + 0.3 * unit(random)) * e1 + (0.2 + 0.3 * unit(random)) * e2;
    test::LongTriangle placed;
    for (std::size_t c = 0; c < 3; ++c) {
      placed[c] = points[c].cast<long double>() + hull.position.cast<long double>();
    }
    static_cast<void>(test::require(collide(cooked.tree, hull, [&](const Contact& contact) {
      const test::LongVector p = contact.point.cast<long double>();
      EXPECT_LE(test::distance_in_extended_precision({p, p, p}, placed), 4 * 0x1p-46L)
          << i << " angle " << angle << " size " << size;
      ++touching;
      return true;
    })));
  }
  EXPECT_GT(touching, 1000);
}

TEST(MergeContacts, NeighboursOfOnePointBecomeTheDeepest) {
  const auto contact = [](double x, const Eigen::Vector3d& normal, double depth) {
    Contact c;
    c.point = {x, 0, 0};
    c.normal = normal;
    c.depth = depth;
    return c;
  };
  const Eigen::Vector3d up(0, 0, 1), side(1, 0, 0);
  std::vector<Contact> contacts = {contact(0, up, 1), contact(0.001, up, 2), contact(0, side, 1),
                                   contact(5, up, 1), contact(0, up, 1.5)};
  ASSERT_EQ(merge_contacts(contacts, 0.01), 3u);
  EXPECT_EQ(contacts[0].depth, 2);
  EXPECT_EQ(contacts[1].normal, side);
  EXPECT_EQ(contacts[2].point[0], 5);
  EXPECT_EQ(merge_contacts(std::span<Contact>(), 1), 0u);
}

// Those that are kept are in their order; none is like another; each that is left out is like one
// that is kept and no less deep. Contacts at x of depths.
TEST(MergeContacts, TheDeepestOfThoseLeftIsKept) {
  using Places = std::vector<std::pair<double, double>>;  // x, depth
  const auto merged = [](const Places& places) {
    std::vector<Contact> contacts;
    for (const auto& [x, depth] : places) {
      contacts.emplace_back();
      contacts.back().point = {x, 0, 0};
      contacts.back().normal = {0, 0, 1};
      contacts.back().depth = depth;
    }
    contacts.resize(merge_contacts(contacts, 1));
    Places kept;
    for (const Contact& contact : contacts) kept.emplace_back(contact.point[0], contact.depth);
    return kept;
  };
  EXPECT_EQ(merged({{0, 1}, {10, 1}, {0, 2}}), (Places{{10, 1}, {0, 2}}));
  EXPECT_EQ(merged({{0, 1}, {1.5, 1}, {0.8, 2}}), (Places{{0.8, 2}}));
  EXPECT_EQ(merged({{0, 1}, {0.9, 0.5}, {-0.9, 2}}), (Places{{0.9, 0.5}, {-0.9, 2}}));
  EXPECT_EQ(merged({{0, 0}, {0.5, 0}, {2, 0}, {2.5, 0}}), (Places{{0, 0}, {2, 0}}));

  std::mt19937 random(4);
  for (int turn = 0; turn < 200; ++turn) {
    Places all;
    for (int i = 0; i < 20; ++i) {
      all.emplace_back(static_cast<double>(random() % 24) / 2, static_cast<double>(random() % 4));
    }
    std::vector<std::size_t> by_depth(all.size());
    std::iota(by_depth.begin(), by_depth.end(), std::size_t{0});
    std::stable_sort(by_depth.begin(), by_depth.end(),
                     [&](std::size_t a, std::size_t b) { return all[a].second > all[b].second; });
    std::set<std::size_t> kept;
    for (const std::size_t i : by_depth) {
      const auto is_like_i = [&](std::size_t k) {
        return std::abs(all[k].first - all[i].first) <= 1;
      };
      if (std::none_of(kept.begin(), kept.end(), is_like_i)) kept.insert(i);
    }
    Places of_kept;
    for (const std::size_t i : kept) of_kept.push_back(all[i]);
    EXPECT_EQ(merged(all), of_kept);
  }
}

TEST(CollideErrors, NameTheField) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(8, 8), CodecId::kWide8);
  const auto none = [](const Contact&) { return true; };
  EXPECT_EQ(collide(cooked.tree, Sphere{{0, 0, 0}, -1}, none).error().detail, "radius");
  EXPECT_EQ(collide(cooked.tree, Sphere{{NAN, 0, 0}, 1}, none).error().detail, "center");
  OrientedBox box;
  box.half_extents = {1, -1, 1};
  EXPECT_EQ(collide(cooked.tree, box, none).error().detail, "half_extents");
  box.half_extents = {1, 1, 1};
  box.rotation.coeffs().setZero();
  EXPECT_EQ(collide(cooked.tree, box, none).error().detail, "rotation");
  EXPECT_EQ(collide(cooked.tree, Capsule{{0, 0, INFINITY}, {0, 0, 0}, 1}, none).error().detail,
            "start");
  ConvexHull hull;
  EXPECT_EQ(collide(cooked.tree, hull, none).error().detail, "points");
  std::vector<Eigen::Vector3d> points(kMaxHullPoints + 1, Eigen::Vector3d::Zero());
  hull.points = points;
  EXPECT_EQ(collide(cooked.tree, hull, none).error().detail, "points");
  hull.points = hull.points.first(kMaxHullPoints);
  EXPECT_TRUE(collide(cooked.tree, hull, none).ok());
  points[7].y() = NAN;
  EXPECT_EQ(collide(cooked.tree, hull, none).error().detail, "points");
  points[7].y() = 1e308;
  EXPECT_EQ(collide(cooked.tree, hull, none).error().detail, "points");
  points[7].y() = 0;
  hull.position.x() = INFINITY;
  EXPECT_EQ(collide(cooked.tree, hull, none).error().detail, "position");
  hull.position.x() = 0;
  hull.rotation.coeffs().setZero();
  EXPECT_EQ(collide(cooked.tree, hull, none).error().detail, "rotation");
}

}  // namespace
}  // namespace boxtree
