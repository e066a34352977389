// SPDX-License-Identifier: MIT
// Positions as a text has them, past assimp, which rounds decimals more than once and holds f32:
// each vertex is put aside here and assimp is shown its number instead, which comes back through
// whatever order and grouping the reader chooses.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include <Eigen/Core>
#include <assimp/vector3.h>
#include <fmt/format.h>

#include <boxtree/cooker/import/source_mesh.h>

namespace boxtree::cooker {

class ExactPositions {
 public:
  explicit ExactPositions(Precision precision = Precision::kF32) {
    positions_.precision = precision;
  }

  /// Numbers that every float type tells apart: the low 24 bits, the bits above, zero.
  using Number = std::array<std::uint32_t, 3>;

  /// Puts a finite position of this precision aside; the answer is what to write in its place.
  Number add(const Eigen::Vector3d& position) {
    const std::size_t number = positions_.size();
    for (const double x : position) {
      if (precision() == Precision::kF32) {
        positions_.f32.push_back(static_cast<float>(x));
      } else {
        positions_.f64.push_back(x);
      }
    }
    return {static_cast<std::uint32_t>(number & kLow), static_cast<std::uint32_t>(number >> 24), 0};
  }

  [[nodiscard]] Precision precision() const { return positions_.precision; }
  [[nodiscard]] bool empty() const { return positions_.size() == 0; }

  /// The position behind what assimp read; without any, and for what is not finite, that itself.
  [[nodiscard]] Eigen::Vector3d operator[](const aiVector3D& read) const {
    Eigen::Vector3d itself(read.x, read.y, read.z);
    if (empty() || !itself.allFinite()) return itself;
    const auto number = static_cast<std::size_t>(read.x) + (static_cast<std::size_t>(read.y) << 24);
    return number < positions_.size() ? positions_[number] : itself;
  }

 private:
  static constexpr std::size_t kLow = (std::size_t{1} << 24) - 1;
  Positions positions_;
};

/// Appends the OBJ vertex that stands for a position put aside, as a line.
inline void append_vertex_line(const ExactPositions::Number& number, std::string& text) {
  text += 'v';
  for (const std::uint32_t part : number) {
    const fmt::format_int digits(part);
    text += ' ';
    text.append(digits.data(), digits.size());
  }
  text += '\n';
}

}  // namespace boxtree::cooker
