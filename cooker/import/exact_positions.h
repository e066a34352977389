// SPDX-License-Identifier: MIT
// Positions with all the digits of a file, past assimp, whose positions are f32: each vertex is put
// aside here and assimp is shown its number instead, which comes back through whatever order and
// grouping the reader chooses.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>
#include <assimp/vector3.h>

namespace boxtree::cooker {

class ExactPositions {
 public:
  /// Numbers that every float type tells apart: the low 24 bits, the bits above, zero.
  using Number = std::array<std::uint32_t, 3>;

  /// Puts a finite position aside; the answer is what to write in its place.
  Number add(const Eigen::Vector3d& position) {
    const std::size_t number = positions_.size();
    positions_.push_back(position);
    return {static_cast<std::uint32_t>(number & kLow), static_cast<std::uint32_t>(number >> 24), 0};
  }

  [[nodiscard]] bool empty() const { return positions_.empty(); }

  /// The position behind what assimp read; without any, and for what is not finite, that itself.
  [[nodiscard]] Eigen::Vector3d operator[](const aiVector3D& read) const {
    Eigen::Vector3d itself(read.x, read.y, read.z);
    if (empty() || !itself.allFinite()) return itself;
    const auto number = static_cast<std::size_t>(read.x) + (static_cast<std::size_t>(read.y) << 24);
    return number < positions_.size() ? positions_[number] : itself;
  }

 private:
  static constexpr std::size_t kLow = (std::size_t{1} << 24) - 1;
  std::vector<Eigen::Vector3d> positions_;
};

}  // namespace boxtree::cooker
