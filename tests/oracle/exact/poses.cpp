// SPDX-License-Identifier: MIT
// Poses that bring features together.
#include "tests/oracle/exact/poses.h"

#include <algorithm>
#include <cmath>

#include "runtime/query/relative_pose.h"

namespace boxtree::oracle {
namespace {

Eigen::Vector3d vector_of(const Point& p) {
  return {p[0], p[1], p[2]};
}

Eigen::Matrix3d rotation(Draw& d) {
  Eigen::Quaterniond q(d.unit(), d.unit(), d.unit(), d.unit());
  while (q.norm() < 0.1) q = Eigen::Quaterniond(d.unit(), d.unit(), d.unit(), d.unit());
  return q.normalized().toRotationMatrix();
}

// A corner, or a point inside, of a decoded triangle, in object space.
Eigen::Vector3d feature(Draw& d, const Group& group, const Decoded& t) {
  const Point p = d.one_in(2) ? t.at[d.below(3)] : draw_point_on(d, t.at);
  return group.frame().to_object(vector_of(p));
}

double size_of(const Group& group, const Decoded& t) {
  double size = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    size = std::max(size, t.bounds.high[k] - t.bounds.low[k]);
  }
  return size * group.frame().scale;
}

// How the image of the second mesh compares with the first in size.
double draw_scale(Draw& d, double first, double second) {
  const bool is_known = first > 0 && second > 0 && std::isfinite(first / second);
  switch (d.below(4)) {
    case 0:
      return 1;
    case 1:
      return d.power(-300, 300);
    default:
      if (!is_known) return 1;
      // About as large, or by up to 2^45 larger or smaller.
      return std::ldexp(
          1.0, std::ilogb(first / second) + (d.one_in(2) ? d.between(-2, 2) : d.between(-45, 45)));
  }
}

// Coordinates of one axis-parallel map with one number a row.
ExactPoint image_of(const Eigen::Matrix3d& linear, const ExactPoint& p) {
  ExactPoint image;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double m = linear(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
      if (m != 0) image[i] = image[i] + Dyadic(m) * p[j];
    }
  }
  return image;
}

// The inverse of a map with one power of two a row and column.
Eigen::Matrix3d inverse_of_exact(const Eigen::Matrix3d& linear) {
  Eigen::Matrix3d inverse = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 3; ++j) {
      if (linear(i, j) != 0) inverse(j, i) = 1 / linear(i, j);
    }
  }
  return inverse;
}

ExactPoint exact(const Eigen::Vector3d& v) {
  return {Dyadic(v[0]), Dyadic(v[1]), Dyadic(v[2])};
}
ExactPoint plus(const ExactPoint& a, const ExactPoint& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
ExactPoint times_power(const ExactPoint& a, int exponent) {
  return {a[0].times_power_of_two(exponent), a[1].times_power_of_two(exponent),
          a[2].times_power_of_two(exponent)};
}

}  // namespace

Point draw_point_on(Draw& d, const Face& t) {
  double u = d.part(), v = d.part();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  if (d.one_in(4)) v = 0;  // on an edge
  Point p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = (t[0][k] * (1 - u - v) + t[1][k] * u) + t[2][k] * v;
  }
  return p;
}

Eigen::Matrix3d draw_exact_linear(Draw& d, int low, int high) {
  std::array<Eigen::Index, 3> to{0, 1, 2};
  std::swap(to[0], to[d.below(3)]);
  std::swap(to[1], to[1 + d.below(2)]);
  const double size = d.power(low, high);
  Eigen::Matrix3d linear = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < 3; ++i) linear(i, to[static_cast<std::size_t>(i)]) = d.sign() * size;
  return linear;
}

Eigen::Matrix3d draw_linear(Draw& d) {
  Eigen::Matrix3d linear = rotation(d);
  switch (d.below(6)) {
    case 0:
      return draw_exact_linear(d, 0, 0);
    case 1:
    case 2:
      return linear;
    case 3: {
      Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
      shear(d.below(2), 2) = d.unit() * d.power(0, 20);
      return linear * shear;
    }
    case 4: {
      Eigen::Vector3d scale(1, 1, 1);
      scale[d.below(3)] = d.one_in(2) ? 1e-20 : d.part() * d.power(-30, 0);
      return d.one_in(2) ? Eigen::Matrix3d(linear * scale.asDiagonal())
                         : Eigen::Matrix3d(scale.asDiagonal() * linear);
    }
    default:
      return linear * Eigen::Vector3d(d.sign(), d.sign(), d.sign() * (0.5 + d.part())).asDiagonal();
  }
}

PlacedPair draw_poses(Draw& d, const Group& first, const Group& second) {
  PlacedPair poses;
  poses.may_be_exact = d.one_in(3);
  const Decoded& s = first.triangles[d.below(static_cast<std::uint32_t>(first.triangles.size()))];
  const Decoded& t = second.triangles[d.below(static_cast<std::uint32_t>(second.triangles.size()))];
  double scale = draw_scale(d, size_of(first, s), size_of(second, t));
  if (poses.may_be_exact) {
    if (d.one_in(2)) poses.first.linear() = draw_exact_linear(d, -20, 20);
    poses.second.linear() = draw_exact_linear(d, 0, 0) * scale;
  } else {
    if (d.one_in(2)) scale *= 0.5 + d.part();
    if (d.one_in(2)) {
      poses.first.linear() = draw_linear(d) * (d.one_in(2) ? 1 : d.power(-300, 300));
      poses.first.translation() =
          Eigen::Vector3d(d.unit(), d.unit(), d.unit()) * (d.one_in(2) ? 1 : d.power(-60, 60));
    }
    poses.second.linear() = draw_linear(d) * (scale * poses.first.linear().col(0).norm());
  }
  const Eigen::Vector3d at = feature(d, first, s), from = feature(d, second, t);
  poses.second.translation() = poses.first * at - poses.second.linear() * from;
  if (d.one_in(8)) {  // some way off
    const double away = size_of(first, s) * d.power(-50, 2);
    for (Eigen::Index k = 0; k < 3; ++k) poses.second.translation()[k] += d.unit() * away;
  }
  return poses;
}

std::optional<std::vector<Face>> exact_images(const Group& first, const Group& second,
                                              const PlacedPair& poses) {
  const Frame& f = first.frame();
  const Frame& s = second.frame();
  const Eigen::Matrix3d inverse = inverse_of_exact(poses.first.linear());
  const ExactPoint shift =
      minus(exact(poses.second.translation()), exact(poses.first.translation()));
  std::vector<Face> all;
  for (const Decoded& t : second.triangles) {
    Face image;
    for (std::size_t c = 0; c < 3; ++c) {
      const ExactPoint object = plus(times_power(t.exact[c], std::ilogb(s.scale)), exact(s.origin));
      const ExactPoint world = plus(image_of(poses.second.linear(), object), shift);
      const ExactPoint in_first =
          times_power(minus(image_of(inverse, world), exact(f.origin)), -std::ilogb(f.scale));
      for (std::size_t k = 0; k < 3; ++k) {
        image[c][k] = in_first[k].as_double();
        if (std::isnan(image[c][k])) return std::nullopt;
      }
    }
    all.push_back(image);
  }
  return all;
}

std::optional<Images> images(const Tree& first, const Group& second, const PlacedPair& poses,
                             const Tree& second_tree) {
  const auto relative = RelativePose::make(BoundTree::of(first), poses.first,
                                           BoundTree::of(second_tree), poses.second);
  if (!relative) return std::nullopt;
  const Eigen::Matrix3d& m = relative->to_first().linear;
  const Eigen::Vector3d& shift = relative->to_first().translation;
  Images all;
  for (const Decoded& t : second.triangles) {
    Face image;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        image[c][k] =
            ((shift[i] + m(i, 0) * t.at[c][0]) + m(i, 1) * t.at[c][1]) + m(i, 2) * t.at[c][2];
      }
    }
    all.triangles.push_back(
        {t.face, t.half, image, as<Dyadic>(image), bounds_of(image), largest(image)});
  }
  return all;
}

}  // namespace boxtree::oracle
