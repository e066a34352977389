// SPDX-License-Identifier: MIT
// A ray and a triangle in the plane across the ray.
#include "tests/oracle/exact/ray_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace boxtree::oracle {
namespace {

// A corner, relative to the ray and times the direction's largest component: then it is dyadic.
ExactPoint sheared(const ExactRay& ray, const Point& corner) {
  const auto [x, y, z] = ray.axis;
  const Dyadic dz = ray.direction[z];
  const Dyadic along = Dyadic(corner[z]) - Dyadic(ray.origin[z]);
  const auto across = [&](std::size_t k) {
    return (Dyadic(corner[k]) - Dyadic(ray.origin[k])) * dz - Dyadic(ray.direction[k]) * along;
  };
  return {across(x), across(y), along};
}

Dyadic area_of(const ExactPoint& a, const ExactPoint& b) {
  return a[0] * b[1] - a[1] * b[0];
}

double ratio(const Dyadic& numerator, const Dyadic& denominator) {
  return mpf_class(numerator.to_mpf() / denominator.to_mpf(), 320).get_d();
}

}  // namespace

ExactRay::ExactRay(const Point& from, const Point& along)
    : origin(from), direction(along), axis{1, 2, 0} {
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::abs(along[k]) > std::abs(along[axis[2]])) axis = {(k + 1) % 3, (k + 2) % 3, k};
  }
}

RayTruth truth_of(const ExactRay& ray, const Face& triangle, double tolerance, double more,
                  int exponent) {
  std::array<ExactPoint, 3> s;
  double farthest = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    s[c] = sheared(ray, triangle[c]);
    for (std::size_t k = 0; k < 3; ++k) {
      farthest = std::max(farthest, std::abs(triangle[c][k] - ray.origin[k]));
    }
  }
  const double dz = ray.direction[ray.axis[2]];
  const Dyadic allowed = Dyadic(farthest) * Dyadic(tolerance) + Dyadic(more);
  const Dyadic off = allowed * Dyadic(std::abs(dz));
  const Dyadic square_off = off * off;

  RayTruth truth{};
  std::array<Dyadic, 3> part;
  Dyadic whole, longest;
  bool is_inside = true;
  for (std::size_t c = 0; c < 3; ++c) {
    const ExactPoint& a = s[(c + 1) % 3];
    const ExactPoint& b = s[(c + 2) % 3];
    part[c] = area_of(a, b);
    whole = whole + part[c];
    const Dyadic x = b[0] - a[0], y = b[1] - a[1];
    const Dyadic square = x * x + y * y;
    if (longest < square) longest = square;
    is_inside &= square_off * square < part[c] * part[c];
  }
  const bool same_signs = part[0].sign() == part[1].sign() && part[1].sign() == part[2].sign();
  truth.is_surely_hit = is_inside && same_signs && whole.sign() != 0;
  ExactFace seen = s;
  for (ExactPoint& p : seen) p[2] = 0.0;
  truth.may_be_hit = !(Quotient{square_off, 1.0} < squared_distance(ExactPoint{}, seen));

  std::array<double, 3> t{};
  for (std::size_t c = 0; c < 3; ++c) t[c] = ratio(s[c][2].times_power_of_two(exponent), dz);
  truth.t_low = std::min({t[0], t[1], t[2]});
  truth.t_high = std::max({t[0], t[1], t[2]});
  truth.t = std::numeric_limits<double>::quiet_NaN();
  double weight_error = 1;
  if (whole.sign() != 0) {
    const Dyadic depth = part[0] * s[0][2] + part[1] * s[1][2] + part[2] * s[2][2];
    truth.t = std::clamp(ratio(depth.times_power_of_two(exponent), whole * Dyadic(dz)), truth.t_low,
                         truth.t_high);
    // The tolerance over the smallest height of the sheared triangle.
    const mpf_class error(off.to_mpf() * sqrt(longest.to_mpf()) / abs(whole.to_mpf()), 320);
    weight_error = std::min(1.0, error.get_d());
  }
  const double largest_t = std::max(std::abs(truth.t_low), std::abs(truth.t_high));
  truth.t_tolerance = ratio(allowed.times_power_of_two(exponent), std::abs(dz)) +
                      (truth.t_high - truth.t_low) * weight_error + 0x1p-50 * largest_t;
  return truth;
}

}  // namespace boxtree::oracle
