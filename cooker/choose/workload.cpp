// SPDX-License-Identifier: MIT
// Seeded queries. The cooker's choice depends on them, so no result may depend on the last bits of
// a library function: sines, norms and products are computed here by the four operations and square
// roots in a fixed order (docs/ARCHITECTURE.md, "Same bytes everywhere").
#include "cooker/choose/workload.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "runtime/primitive/vector3.h"

namespace boxtree::cooker {
namespace {

// The cosine and the sine of an angle in full turns, from 0 to 1.
std::array<double, 2> cosine_sine(double turns) {
  const double quarters = std::floor(4 * turns + 0.5);
  const double x = 2 * std::numbers::pi * (turns - quarters / 4);  // at most pi / 4
  std::array<double, 2> sums{};
  double term = 1;
  for (int n = 0; n < 20; ++n) {  // pi / 4 to the 20th over 20! is below 2^-60
    sums[static_cast<std::size_t>(n % 2)] += n % 4 < 2 ? term : -term;
    term *= x / (n + 1);
  }
  const auto [cosine, sine] = sums;
  switch (static_cast<int>(quarters) % 4) {
    case 0:
      return {cosine, sine};
    case 1:
      return {-sine, cosine};
    case 2:
      return {-cosine, -sine};
    default:
      return {sine, -cosine};
  }
}

// Scaled so that no square overflows or underflows; powers of two change no other bit.
double length_of(const Eigen::Vector3d& vector) {
  const double scale = scale_to_one(vector);
  return std::sqrt(squared_length(vector * scale)) / scale;
}

// SplitMix64 (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", 2014).
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  // Uniform in [0, 1).
  double unit() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * unit(); }

  Eigen::Vector3d inside(const Eigen::AlignedBox3d& box) {
    Eigen::Vector3d p;
    for (Eigen::Index k = 0; k < 3; ++k) p[k] = between(box.min()[k], box.max()[k]);
    return p;
  }
  // Uniform on the unit sphere (Archimedes: heights are uniform).
  Eigen::Vector3d direction() {
    const double z = between(-1, 1);
    const auto [cosine, sine] = cosine_sine(unit());
    const double r = std::sqrt(1 - z * z);
    return {r * cosine, r * sine, z};
  }
  // Uniform rotation (Shoemake, "Uniform random rotations", 1992).
  Eigen::Matrix3d rotation() {
    const double u = unit();
    const auto [cosine_a, sine_a] = cosine_sine(unit());
    const auto [cosine_b, sine_b] = cosine_sine(unit());
    const double s = std::sqrt(1 - u);
    const double t = std::sqrt(u);
    return Eigen::Quaterniond(t * cosine_b, s * sine_a, s * cosine_a, t * sine_b)
        .toRotationMatrix();
  }

 private:
  std::uint64_t state_;
};

// The distance of the centres along `direction` at which a box and its rotated copy touch: the
// least over all axes that can separate two boxes (Gottschalk, Lin, Manocha, "OBBTree", 1996).
double touching_distance(const Eigen::Vector3d& half, const Eigen::Matrix3d& rotation,
                         const Eigen::Vector3d& direction) {
  double distance = std::numeric_limits<double>::infinity();
  const auto consider = [&](const Eigen::Vector3d& axis) {
    const double touching =
        dot(half, axis.cwiseAbs()) + dot(half, product(rotation.transpose(), axis).cwiseAbs());
    const double along = std::abs(dot(direction, axis));
    if (along > 0) distance = std::min(distance, touching / along);
  };
  for (Eigen::Index i = 0; i < 3; ++i) {
    consider(Eigen::Vector3d::Unit(i));
    consider(rotation.col(i));
    for (Eigen::Index j = 0; j < 3; ++j) consider(cross(Eigen::Vector3d::Unit(i), rotation.col(j)));
  }
  return distance;
}

// In bricks of 4 x 2 x 2, one after another.
std::vector<Eigen::Vector3d> lattice_points(const Eigen::AlignedBox3d& bounds, std::size_t side) {
  constexpr std::size_t kBrick[3] = {4, 2, 2};
  std::vector<Eigen::Vector3d> points;
  points.reserve(side * side * side);
  const auto place = [&](std::size_t i) {
    return static_cast<double>(i) / static_cast<double>(side - 1) - 0.5;
  };
  for (std::size_t z = 0; z < side; z += kBrick[2]) {
    for (std::size_t y = 0; y < side; y += kBrick[1]) {
      for (std::size_t x = 0; x < side; x += kBrick[0]) {
        for (std::size_t i = 0; i < kBrick[0] * kBrick[1] * kBrick[2]; ++i) {
          const Eigen::Vector3d at(place(x + i % kBrick[0]), place(y + i / kBrick[0] % kBrick[1]),
                                   place(z + i / (kBrick[0] * kBrick[1])));
          points.emplace_back(bounds.center() + 1.2 * at.cwiseProduct(bounds.sizes()));
        }
      }
    }
  }
  return points;
}

// Of a camera that looks at the middle from the direction (2, 1, 2) / 3; the ball of the bounds
// fills the picture.
std::vector<Ray> camera_rays(const Eigen::AlignedBox3d& bounds, double diagonal,
                             std::size_t pixels) {
  const Eigen::Vector3d back(2.0 / 3, 1.0 / 3, 2.0 / 3), right(2.0 / 3, -2.0 / 3, -1.0 / 3),
      up(-1.0 / 3, -2.0 / 3, 2.0 / 3);
  const double width = 1.15;  // twice the tangent of 30 degrees
  constexpr std::size_t kTile = 4;
  std::vector<Ray> rays;
  const auto offset = [&](std::size_t pixel) {
    return width * ((static_cast<double>(pixel) + 0.5) / static_cast<double>(pixels) - 0.5);
  };
  for (std::size_t tile_y = 0; tile_y + kTile <= pixels; tile_y += kTile) {
    for (std::size_t tile_x = 0; tile_x + kTile <= pixels; tile_x += kTile) {
      for (std::size_t i = 0; i < kTile * kTile; ++i) {
        // From the middle row on: the first of them, too, meet something.
        const double x = offset(tile_x + i % kTile);
        const double y = offset((tile_y + i / kTile + pixels / 2) % pixels);
        rays.push_back({bounds.center() + diagonal * back, x * right + y * up - back});
      }
    }
  }
  return rays;
}

Pose random_pose(const Eigen::AlignedBox3d& bounds, double share, Random& random) {
  const Eigen::Matrix3d rotation = random.rotation();
  const Eigen::Vector3d direction = random.direction();
  const double distance = share * touching_distance(bounds.sizes() / 2, rotation, direction);
  Pose pose = Pose::Identity();
  pose.linear() = rotation;
  pose.translation() = bounds.center() - product(rotation, bounds.center()) + distance * direction;
  return pose;
}

}  // namespace

Workload make_workload(const Eigen::AlignedBox3d& bounds, const WorkloadSize& size,
                       std::uint64_t seed) {
  Workload workload;
  Random random(seed);
  const double diagonal = length_of(bounds.diagonal());
  workload.cast_radius = 0.01 * diagonal;
  for (std::size_t i = 0; i < size.rays; ++i) {
    const Eigen::Vector3d away = random.direction();
    const Eigen::Vector3d origin = bounds.center() + diagonal * away;
    const Eigen::Vector3d toward = random.inside(bounds) - origin;
    const double length = length_of(toward);
    // Bounds that are a point, or one beside their distance from 0, leave no way.
    workload.rays.push_back({origin, -away});
    if (length > 0) workload.rays.back().direction = toward / length;
  }
  workload.camera = camera_rays(bounds, diagonal, size.camera);
  workload.lattice = lattice_points(bounds, size.lattice);
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.025 * diagonal);
  for (std::size_t i = 0; i < size.boxes; ++i) {
    const Eigen::Vector3d centre = random.inside(bounds);
    workload.boxes.emplace_back(centre - half, centre + half);
  }
  const Eigen::AlignedBox3d wider(bounds.center() - 0.6 * bounds.sizes(),
                                  bounds.center() + 0.6 * bounds.sizes());
  for (std::size_t i = 0; i < size.points; ++i) workload.points.push_back(random.inside(wider));
  constexpr std::array kShares = {0.6, 0.8, 0.9, 1.0};
  for (std::size_t i = 0; i < size.poses; ++i) {
    workload.poses.push_back(random_pose(bounds, kShares[i % kShares.size()], random));
  }
  constexpr std::array kSharesApart = {1.05, 1.2, 1.5, 2.0};
  for (std::size_t i = 0; i < size.apart; ++i) {
    workload.apart.push_back(random_pose(bounds, kSharesApart[i % kSharesApart.size()], random));
  }
  for (std::size_t i = 0; i < size.segments; ++i) {
    const Eigen::Vector3d origin = random.inside(bounds);
    workload.segments.push_back({origin, random.direction(), 0, 0.02 * diagonal});
  }
  return workload;
}

std::vector<Pose> tumble_poses(const Eigen::AlignedBox3d& bounds, double distance,
                               std::size_t steps) {
  std::vector<Pose> poses;
  const double unit = bounds.sizes().maxCoeff() / 2;
  for (std::size_t k = 0; k < steps; ++k) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(k) / static_cast<double>(steps);
    Pose pose = Pose::Identity();
    pose.linear() = (Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()) *
                     Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()))
                        .toRotationMatrix();
    pose.translation() =
        bounds.center() - pose.linear() * bounds.center() + Eigen::Vector3d(distance * unit, 0, 0);
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace boxtree::cooker
