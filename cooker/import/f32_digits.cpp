// SPDX-License-Identifier: MIT
#include "cooker/import/f32_digits.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "cooker/import/text_tokens.h"
#include "cooker/text/at_most.h"
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
  return std::max(kRoundoffF32 * farthest.norm(), kUnderflowF32) > unnoticed_in(bounds);
}

// The result goes into files, so it is computed in a fixed order, which Eigen's norms do not have.
double moved_by_f32(const Eigen::Vector3d& position) {
  const Eigen::Vector3d off(lost_to_f32(position[0]), lost_to_f32(position[1]),
                            lost_to_f32(position[2]));
  const double scale = scale_to_one(off);
  return std::sqrt(squared_length(off * scale)) / scale;
}

double moved_by_f32(const Positions& positions) {
  double farthest = 0;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    farthest = std::max(farthest, moved_by_f32(positions[i]));
  }
  return farthest;
}

double loss_in_text(std::string_view text) {
  constexpr std::string_view kNumber = "0123456789+-.eE";
  double largest = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find_first_not_of(kNumber), text.size());
    const std::optional<double> number = read_number<double>(text.substr(0, end));
    if (number && std::abs(*number) <= std::numeric_limits<float>::max()) {
      largest = std::max(largest, std::abs(lost_to_f32(*number)));
    }
    text.remove_prefix(end);
    text.remove_prefix(std::min(text.find_first_of(kNumber), text.size()));
  }
  return largest;
}

std::string remedy_of(F32Loss loss) {
  switch (loss) {
    case F32Loss::kDigits:
      return "--f64 keeps all digits";
    case F32Loss::kNodes:
      return "--f64 or a scene (--scene) keeps the places of its nodes";
    case F32Loss::kReader:
      break;
  }
  return "its reader has f32 alone, with --f64, too; those of OBJ, OFF, PLY and text STL keep all "
         "digits";
}

std::string cook_remedy_of(F32Loss loss) {
  return (loss == F32Loss::kReader ? "" : "cook ") + remedy_of(loss);
}

Status check_moved_by_f32(const SourceMesh& mesh, std::string_view what, double tolerance) {
  if (mesh.moved_by_f32 <= tolerance) return {};
  return Error{
      Errc::kMeshUnsupported,
      fmt::format("{}: f32 moves a vertex by up to {}, farther than the tolerance of "
                  "{}; {}",
                  what, at_most(mesh.moved_by_f32, 3), tolerance, remedy_of(mesh.f32_loss))};
}

}  // namespace boxtree::cooker
