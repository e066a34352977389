// SPDX-License-Identifier: MIT
// The oracle's own geometry: hand-made cases, and small integers against an enumeration of all
// pairs of features in rational arithmetic.
#include "tests/oracle/exact/geometry.h"

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree::oracle {
namespace {

using Rational = mpq_class;

// Solves m x = b by elimination; nothing where m is singular.
std::optional<std::vector<Rational>> solve(std::vector<std::vector<Rational>> m,
                                           std::vector<Rational> b) {
  const std::size_t n = b.size();
  for (std::size_t k = 0; k < n; ++k) {
    std::size_t pivot = k;
    while (pivot < n && m[pivot][k] == 0) ++pivot;
    if (pivot == n) return std::nullopt;
    std::swap(m[k], m[pivot]);
    std::swap(b[k], b[pivot]);
    for (std::size_t i = 0; i < n; ++i) {
      if (i == k || m[i][k] == 0) continue;
      const Rational f = m[i][k] / m[k][k];
      for (std::size_t j = k; j < n; ++j) m[i][j] -= f * m[k][j];
      b[i] -= f * b[k];
    }
  }
  for (std::size_t k = 0; k < n; ++k) b[k] /= m[k][k];
  return b;
}

// The squared distance of the hulls of two sets of points: for each pair of subsets the nearest
// points of their affine hulls, where these are unique and inside.
Rational squared_by_enumeration(const std::vector<Point>& a, const std::vector<Point>& b) {
  std::optional<Rational> best;
  for (unsigned s = 1; s < (1u << a.size()); ++s) {
    for (unsigned r = 1; r < (1u << b.size()); ++r) {
      // Columns: corners of a, corners of b with the sign turned; two sums of weights are 1.
      std::vector<std::array<Rational, 3>> column;
      std::vector<bool> is_first;
      for (std::size_t i = 0; i < a.size(); ++i) {
        if (((s >> i) & 1u) == 0) continue;
        column.push_back({Rational(a[i][0]), Rational(a[i][1]), Rational(a[i][2])});
        is_first.push_back(true);
      }
      for (std::size_t i = 0; i < b.size(); ++i) {
        if (((r >> i) & 1u) == 0) continue;
        column.push_back({Rational(-b[i][0]), Rational(-b[i][1]), Rational(-b[i][2])});
        is_first.push_back(false);
      }
      const std::size_t n = column.size();
      std::vector<std::vector<Rational>> m(n + 2, std::vector<Rational>(n + 2));
      std::vector<Rational> rhs(n + 2);
      for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = 0; j < n; ++j) {
          for (std::size_t k = 0; k < 3; ++k) m[i][j] += column[i][k] * column[j][k];
        }
        m[i][is_first[i] ? n : n + 1] = m[is_first[i] ? n : n + 1][i] = 1;
      }
      rhs[n] = rhs[n + 1] = 1;
      const auto weights = solve(m, rhs);
      if (!weights) continue;
      bool is_inside = true;
      for (std::size_t i = 0; i < n; ++i) is_inside &= (*weights)[i] >= 0;
      if (!is_inside) continue;
      Rational square;
      for (std::size_t k = 0; k < 3; ++k) {
        Rational x;
        for (std::size_t i = 0; i < n; ++i) x += (*weights)[i] * column[i][k];
        square += x * x;
      }
      if (!best || square < *best) best = square;
    }
  }
  return *best;
}

class Integers {
 public:
  explicit Integers(int range) : range_(range), random_(7) {}
  double number() {
    return static_cast<double>(std::uniform_int_distribution<int>(-range_, range_)(random_));
  }
  Point point() { return {number(), number(), number()}; }
  Face face() { return {point(), point(), point()}; }
  BoxOf box() {
    const Point a = point(), b = point();
    BoxOf box;
    for (std::size_t k = 0; k < 3; ++k) {
      box.low[k] = std::min(a[k], b[k]);
      box.high[k] = std::max(a[k], b[k]);
    }
    return box;
  }

 private:
  int range_;
  std::mt19937_64 random_;
};

std::vector<Point> corners(const Face& f) {
  return {f[0], f[1], f[2]};
}

bool is_same(const Quotient& q, const Rational& r) {
  const Dyadic difference =
      q.numerator * Dyadic(r.get_den().get_d()) - q.denominator * Dyadic(r.get_num().get_d());
  return difference.sign() == 0;
}

TEST(ExactGeometry, TrianglesOfSmallIntegers) {
  int touching = 0;
  for (const int range : {1, 2, 5}) {
    Integers draw(range);
    for (int i = 0; i < 300; ++i) {
      const Face a = draw.face(), b = draw.face();
      const Rational square = squared_by_enumeration(corners(a), corners(b));
      EXPECT_EQ(triangles_touch(a, b), square == 0);
      EXPECT_EQ(triangles_touch(as<Dyadic>(a), as<Dyadic>(b)), square == 0);
      EXPECT_TRUE(is_same(squared_distance(as<Dyadic>(a), as<Dyadic>(b)), square));
      touching += square == 0 ? 1 : 0;
    }
  }
  EXPECT_GT(touching, 100);
}

TEST(ExactGeometry, PointsAndSegmentsOfSmallIntegers) {
  for (const int range : {1, 2, 6}) {
    Integers draw(range);
    for (int i = 0; i < 400; ++i) {
      const Face t = draw.face();
      const Point p = draw.point(), q = draw.point();
      EXPECT_TRUE(is_same(squared_distance(as<Dyadic>(p), as<Dyadic>(t)),
                          squared_by_enumeration({p}, corners(t))));
      EXPECT_EQ(segment_touches_triangle(p, q, t), squared_by_enumeration({p, q}, corners(t)) == 0);
    }
  }
}

TEST(ExactGeometry, BoxesOfSmallIntegers) {
  int touching = 0;
  for (const int range : {1, 3, 8}) {
    Integers draw(range);
    for (int i = 0; i < 20000; ++i) {
      const Face t = draw.face();
      const BoxOf box = draw.box();
      // A corner is inside, or an edge meets a side, or an edge of the box meets the triangle.
      bool touches = false;
      for (const Point& c : t) touches |= boxes_touch({c, c}, box);
      for (std::size_t k = 0; k < 3 && !touches; ++k) {
        const std::size_t u = (k + 1) % 3, v = (k + 2) % 3;
        for (const double at : {box.low[k], box.high[k]}) {
          std::array<Point, 4> side;
          for (std::size_t c = 0; c < 4; ++c) {
            side[c][k] = at;
            side[c][u] = c == 1 || c == 2 ? box.high[u] : box.low[u];
            side[c][v] = c >= 2 ? box.high[v] : box.low[v];
          }
          touches |= triangles_touch(t, {side[0], side[1], side[2]}) ||
                     triangles_touch(t, {side[0], side[2], side[3]});
        }
      }
      ASSERT_EQ(triangle_touches_box(t, box), touches);
      touching += touches ? 1 : 0;
    }
  }
  EXPECT_GT(touching, 5000);
}

TEST(ExactGeometry, DistanceToABoxIsZeroWhereItTouches) {
  Integers draw(4);
  for (int i = 0; i < 500; ++i) {
    const Face t = draw.face();
    const BoxOf box = draw.box();
    std::vector<Point> corners_of_box;
    for (unsigned c = 0; c < 8; ++c) {
      corners_of_box.push_back({(c & 1u) != 0 ? box.high[0] : box.low[0],
                                (c & 2u) != 0 ? box.high[1] : box.low[1],
                                (c & 4u) != 0 ? box.high[2] : box.low[2]});
    }
    const Quotient square = squared_distance(t, box);
    EXPECT_EQ(square.sign() == 0, triangle_touches_box(t, box));
    if (i < 5) {
      EXPECT_TRUE(is_same(square, squared_by_enumeration(corners(t), corners_of_box)));
    }
  }
}

TEST(ExactGeometry, UnitsInTheLastPlaceDecide) {
  const Face floor{{{0, 0, 0}, {0x1p60, 0, 0}, {0, 0x1p60, 0}}};
  const double tiny = std::numeric_limits<double>::denorm_min();
  const auto touching = [&](double z) {
    return triangles_touch(floor, Face{{{1, 1, z}, {2, 1, 1}, {1, 2, 1}}});
  };
  EXPECT_TRUE(touching(0));
  EXPECT_TRUE(touching(-tiny));
  EXPECT_FALSE(touching(tiny));
  EXPECT_TRUE(triangle_touches_box(floor, {{1, 1, 0}, {1, 1, 1}}));
  EXPECT_FALSE(triangle_touches_box(floor, {{1, 1, tiny}, {1, 1, 1}}));
  // A slanted plane x + y + z = 0 and a corner of a box one unit in the last place above it.
  const Face slanted{{{3, -3, 0}, {-3, 0, 3}, {0, 3, -3}}};
  EXPECT_TRUE(triangle_touches_box(slanted, {{0, 0, 0}, {1, 1, 1}}));
  EXPECT_FALSE(triangle_touches_box(slanted, {{0, 0, tiny}, {1, 1, 1}}));
}

TEST(ExactGeometry, EveryDoubleIsADyadicNumber) {
  std::mt19937_64 random(3);
  for (int i = 0; i < 10000; ++i) {
    const double x = std::ldexp(static_cast<double>(static_cast<long>(random())),
                                static_cast<int>(random() % 2100) - 1130);
    const double y = std::ldexp(static_cast<double>(static_cast<long>(random())),
                                static_cast<int>(random() % 2100) - 1130);
    if (!std::isfinite(x) || !std::isfinite(y)) continue;
    EXPECT_EQ(Dyadic(x).as_double(), x);
    EXPECT_EQ((Dyadic(x) - Dyadic(y)).sign(), (x > y) - (x < y));
    EXPECT_EQ(((Dyadic(x) + Dyadic(y)) - Dyadic(x) - Dyadic(y)).sign(), 0);
    EXPECT_EQ((Dyadic(x) * Dyadic(y)).sign(), Dyadic(x).sign() * Dyadic(y).sign());
  }
}

// A sign that an interval tells is the exact one.
TEST(ExactGeometry, IntervalsNeverTellAWrongSign) {
  std::mt19937_64 random(5);
  int told = 0;
  const auto number = [&random] {
    const int range = static_cast<int>(random() % 3) * 350;
    const double x = static_cast<double>(static_cast<int>(random() % 65) - 32);
    return std::ldexp(x, range == 0 ? 0 : static_cast<int>(random() % 700) - range);
  };
  for (int i = 0; i < 100000; ++i) {
    const Point a{number(), number(), number()}, b{number(), number(), number()},
        c{number(), number(), number()};
    const int exact = sign_of(dot(as<Dyadic>(a), cross(as<Dyadic>(b), as<Dyadic>(c))));
    try {
      EXPECT_EQ(sign_of(dot(as<Interval>(a), cross(as<Interval>(b), as<Interval>(c)))), exact);
      ++told;
    } catch (const Uncertain&) {
    }
  }
  EXPECT_GT(told, 10000);
}

}  // namespace
}  // namespace boxtree::oracle
