// SPDX-License-Identifier: MIT
// Divides sets that are small enough to try every division: the last levels of a tree with full
// leaves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cooker/build/splitter.h"
#include "format/codec_wide.h"

namespace boxtree::cooker {

/// A small set of faces, sorted along each axis once. Its parts stay sorted when it is divided, so
/// all levels below together cost little more than one. The whole set is [0, size).
class UnitSweep {
 public:
  static constexpr std::size_t kMaxFaces = 4096;

  /// Precondition: at most kMaxFaces faces.
  explicit UnitSweep(std::span<const FaceBox> faces);

  [[nodiscard]] Box<float> bounds(std::size_t first, std::size_t last) const;

  /// The best division of the part [first, last), which will become `roots` children of a wide
  /// node: by the surface-area heuristic, along any axis, with full leaves and full nodes on the
  /// left. Precondition: more faces than kLeafFaces, two to eight roots.
  [[nodiscard]] Split best_split(std::size_t first, std::size_t last, std::size_t roots);

  /// Divides [first, last): the faces with the lowest centres along the axis go left.
  void divide(std::size_t first, std::size_t last, const Split& split);

  /// Writes the faces of a part, ordered by their numbers.
  void copy_to(std::size_t first, std::span<FaceBox> to) const;

 private:
  std::vector<FaceBox> faces_;                        // by number
  std::array<std::vector<std::uint16_t>, 3> sorted_;  // indices into faces_
  std::vector<FaceBounds> of_leaf_;  // of a part that is being divided, along one axis
};

}  // namespace boxtree::cooker
