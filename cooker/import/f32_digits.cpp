// SPDX-License-Identifier: MIT
#include "cooker/import/f32_digits.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"

namespace boxtree::cooker {

namespace {

double unnoticed_in(const Eigen::AlignedBox3d& bounds) {
  constexpr double kHalfStep = 0x1p-17;
  return bounds.isEmpty() ? 0 : kHalfStep * bounds.sizes().maxCoeff();
}

// A call, as g++ 12.2 -O2 takes x - double(float(x)) for 0 where it computes two of them in a
// vector.
[[gnu::noinline]] double lost_to_f32(double x) {
  return x - static_cast<double>(static_cast<float>(x));
}

}  // namespace

double unnoticed_move(const Positions& positions) {
  return unnoticed_in(bounds_of(positions));
}

bool may_have_moved(const Positions& positions) {
  const Eigen::AlignedBox3d bounds = bounds_of(positions);
  if (bounds.isEmpty()) return false;
  const Eigen::Vector3d farthest = bounds.min().cwiseAbs().cwiseMax(bounds.max().cwiseAbs());
  return kRoundoffF32 * farthest.norm() > unnoticed_in(bounds);
}

// The result goes into files, so it is computed in a fixed order, which Eigen's norms do not have.
double moved_by_f32(const Positions& positions) {
  double farthest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3d p = positions[i];
    const Eigen::Vector3d off(lost_to_f32(p[0]), lost_to_f32(p[1]), lost_to_f32(p[2]));
    const double scale = scale_to_one(off);
    farthest = std::max(farthest, std::sqrt(squared_length(off * scale)) / scale);
  }
  return farthest;
}

Status check_moved_by_f32(const std::string& source, double moved, double tolerance) {
  if (moved <= tolerance) return {};
  return Error{Errc::kMeshUnsupported,
               fmt::format("{}: f32 moves a vertex by up to {:.3g}, farther than the tolerance of "
                           "{}; --f64 keeps all digits",
                           source, moved, tolerance)};
}

}  // namespace boxtree::cooker
