// SPDX-License-Identifier: MIT
// Choice of a grid, and rounding to it: to nearest, halves up, per axis.
#include "cooker/quantise/grid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "format/grid.h"
#include "format/limits.h"

namespace boxtree::cooker {
namespace {

// Halves the largest extent, as the whole of it may not be finite.
double half_extent(const Eigen::AlignedBox3d& bounds) {
  return (bounds.max() / 2 - bounds.min() / 2).maxCoeff();
}

// A position in steps from the origin, not rounded. Computed in halves where the difference
// overflows.
double in_steps(double position, double origin, int step_exponent) {
  const double difference = position - origin;
  if (std::isfinite(difference)) return std::ldexp(difference, -step_exponent);
  return std::ldexp(position / 2 - origin / 2, 1 - step_exponent);
}

// The result goes into the file, so it uses only operations that IEEE 754 defines to the bit, in a
// fixed order. Eigen's norms add in an order that depends on alignment and instruction set. The
// scaling by a power of two prevents overflow of squares and underflow of those that matter.
double length_of(const std::array<double, 3>& vector) {
  double largest = 0;
  for (const double x : vector) largest = std::max(largest, std::abs(x));
  if (largest == 0) return 0;
  const int exponent = std::ilogb(largest);
  double squared = 0;
  for (const double x : vector) {
    const double scaled = std::ldexp(x, -exponent);
    squared += scaled * scaled;
  }
  return std::ldexp(std::sqrt(squared), exponent);
}

// At least the binary logarithm of the largest extent, at most 1 more; 0 for a single point.
int extent_exponent(const Eigen::AlignedBox3d& bounds) {
  const double half = half_extent(bounds);
  return half > 0 ? exponent_above(half) + 1 : 0;
}

Grid grid_over(const Eigen::AlignedBox3d& bounds, int step_exponent) {
  Grid grid;
  grid.step_exponent = std::clamp(step_exponent, -kMaxStepExponent, kMaxStepExponent);
  for (Eigen::Index k = 0; k < 3; ++k) {
    // Beyond 2^53 steps every double is a multiple of the step.
    const double steps = std::floor(std::ldexp(bounds.min()[k], -grid.step_exponent));
    grid.origin[k] = std::isfinite(steps) ? std::ldexp(steps, grid.step_exponent) : bounds.min()[k];
  }
  return grid;
}

// Rounds vertices of a mesh to a grid, in steps from the middle of the mesh.
class Rounding {
 public:
  // `bounds`: of the mesh.
  Rounding(const Eigen::AlignedBox3d& bounds, const Grid& grid) : grid_(grid) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double low = steps_of(bounds.min()[axis], k);  // rounding is monotone
      const double high = steps_of(bounds.max()[axis], k);
      middle_[k] = std::floor((low + high) / 2);
      farthest_ = std::max({farthest_, high - middle_[k], middle_[k] - low});
      origin_[k] = grid.origin[axis] + std::ldexp(middle_[k], grid.step_exponent);
    }
  }

  [[nodiscard]] const std::array<double, 3>& origin() const { return origin_; }
  [[nodiscard]] double farthest() const { return farthest_; }  // steps, of any coordinate

  struct Rounded {
    std::array<double, 3> steps;  // whole numbers
    double moved;                 // distance from the source, object space
  };
  [[nodiscard]] Rounded operator()(const Eigen::Vector3d& source) const {
    Rounded rounded;
    std::array<double, 3> moved;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      rounded.steps[k] = steps_of(source[axis], k) - middle_[k];
      // The position as a reader computes it, halved so that nothing overflows.
      const double decoded = std::ldexp(rounded.steps[k], grid_.step_exponent) + origin_[k];
      moved[k] = decoded / 2 - source[axis] / 2;
    }
    rounded.moved = 2 * length_of(moved);
    return rounded;
  }

 private:
  [[nodiscard]] double steps_of(double position, std::size_t k) const {
    const double origin = grid_.origin[static_cast<Eigen::Index>(k)];
    return std::floor(in_steps(position, origin, grid_.step_exponent) + 0.5);
  }

  const Grid& grid_;
  std::array<double, 3> middle_{};  // steps from the grid's origin
  std::array<double, 3> origin_{};  // of the middle, object space
  double farthest_ = 0;
};

bool is_within_tolerance(const MeshOnGrid& each, const Eigen::AlignedBox3d& mesh_bounds,
                         const Grid& grid) {
  const Positions& positions = each.mesh->positions;
  if (positions.size() == 0) return true;
  const Rounding round(mesh_bounds, grid);
  const double left = tolerance_left(each.tolerance, *each.mesh);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (round(positions[i]).moved > left) return false;
  }
  return true;
}

}  // namespace

int exponent_above(double x) {
  int exponent = 0;
  return std::frexp(x, &exponent) == 0.5 ? exponent - 1 : exponent;
}

Eigen::AlignedBox3d bounds_of(const SourceMesh& mesh) {
  return bounds_of(mesh.positions);
}

// A length of at most the result makes no sum with moved_by_f32 that rounds to more than tolerance.
double tolerance_left(double tolerance, const SourceMesh& mesh) noexcept {
  const double left = tolerance - mesh.moved_by_f32;
  return left + mesh.moved_by_f32 > tolerance ? std::nextafter(left, 0.0) : left;
}

Result<Grid> choose_grid(const Eigen::AlignedBox3d& bounds, const GridChoice& choice) {
  Grid grid;
  if (choice.tolerance && !(*choice.tolerance > 0 && std::isfinite(*choice.tolerance))) {
    return Error{Errc::kMeshUnsupported,
                 fmt::format("a tolerance of {} is no length", *choice.tolerance)};
  }
  if (bounds.isEmpty()) return grid;
  const int extent = extent_exponent(bounds);
  int step_exponent = extent - choice.bits;
  if (choice.tolerance) {
    // A vertex moves at most half a step on each axis: sqrt(3)/2 < 0.8661 steps in all. kLargest
    // keeps the quotient finite; steps above the limit are reduced to the limit in any case.
    constexpr double kLargest = 0x1p1000;
    static_assert(kMaxStepExponent < 1000);
    step_exponent = std::ilogb(std::min(*choice.tolerance, kLargest) / 0.8661);
  }
  if (choice.step_exponent) step_exponent = *choice.step_exponent;
  const int bits = extent - step_exponent;
  const double half = half_extent(bounds);
  if (half > 0 && bits > kMaxGridBits) {
    const int least = extent - kMaxGridBits;
    const auto [requested, possible] =
        choice.step_exponent
            ? std::pair(fmt::format("a step of 2^{}", *choice.step_exponent),
                        fmt::format("a step of 2^{}", least))
            : std::pair(fmt::format("a tolerance of {}", choice.tolerance.value_or(0)),
                        fmt::format("a tolerance of {}", 0.8661 * std::ldexp(1.0, least)));
    return Error{Errc::kMeshUnsupported,
                 fmt::format("{} needs a grid of {} bits over an extent of {}; at most {} are "
                             "possible, {}",
                             requested, bits, 2 * half, kMaxGridBits, possible)};
  }
  return grid_over(bounds, step_exponent);
}

Result<Grid> choose_grid(std::span<const SourceMesh* const> meshes, const GridChoice& choice) {
  Eigen::AlignedBox3d bounds;
  GridChoice finest = choice;
  for (const SourceMesh* mesh : meshes) {
    bounds.extend(bounds_of(*mesh));
    if (!choice.tolerance) continue;
    finest.tolerance = std::min(*finest.tolerance, tolerance_left(*choice.tolerance, *mesh));
  }
  const Result<Grid> grid = choose_grid(bounds, finest);
  if (!grid || !choice.tolerance || choice.step_exponent || bounds.isEmpty()) return grid;
  std::vector<MeshOnGrid> all;
  all.reserve(meshes.size());
  for (const SourceMesh* mesh : meshes) all.push_back({mesh, bounds, *grid, *choice.tolerance});
  coarsen_together(all);
  return all.front().grid;
}

void coarsen_together(std::span<MeshOnGrid> meshes) {
  if (meshes.empty()) return;
  std::vector<Eigen::AlignedBox3d> mesh_bounds;
  mesh_bounds.reserve(meshes.size());
  for (const MeshOnGrid& each : meshes) mesh_bounds.push_back(bounds_of(*each.mesh));
  for (;;) {
    std::vector<Grid> coarser;
    coarser.reserve(meshes.size());
    for (std::size_t i = 0; i < meshes.size(); ++i) {
      const MeshOnGrid& each = meshes[i];
      const int step_exponent = each.grid.step_exponent + 1;
      const int largest =
          std::min({each.largest_step_exponent, extent_exponent(each.bounds), kMaxStepExponent});
      if (step_exponent > largest) return;
      coarser.push_back(grid_over(each.bounds, step_exponent));
      if (!is_within_tolerance(each, mesh_bounds[i], coarser.back())) return;
    }
    for (std::size_t i = 0; i < meshes.size(); ++i) meshes[i].grid = coarser[i];
  }
}

QuantisedPositions quantise(const SourceMesh& mesh, const Grid& grid) {
  QuantisedPositions out;
  out.step_exponent = grid.step_exponent;
  const std::size_t count = mesh.positions.size();
  if (count == 0) return out;

  const Rounding round(bounds_of(mesh), grid);
  out.origin = round.origin();
  constexpr double kFloatHolds = 1 << std::numeric_limits<float>::digits;
  const bool fits_float = round.farthest() <= kFloatHolds;
  Positions& positions = out.positions;
  positions.precision = fits_float ? Precision::kF32 : Precision::kF64;
  (fits_float ? positions.f32.resize(3 * count) : positions.f64.resize(3 * count));
  for (std::size_t i = 0; i < count; ++i) {
    const Rounding::Rounded rounded = round(mesh.positions[i]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (fits_float) {
        positions.f32[3 * i + k] = static_cast<float>(rounded.steps[k]);
      } else {
        positions.f64[3 * i + k] = rounded.steps[k];
      }
    }
    out.max_vertex_error = std::max(out.max_vertex_error, rounded.moved);
  }
  out.max_vertex_error += mesh.moved_by_f32;
  return out;
}

}  // namespace boxtree::cooker
