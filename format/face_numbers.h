// SPDX-License-Identifier: MIT
// Numbers of the faces of a tree (materials, user data): by runs of source faces, or of each face.
#pragma once

#include <cstdint>
#include <type_traits>

#include "format/container.h"

namespace boxtree {

/// Source faces from `first_face` up to that of the next run have one number. The first run of a
/// tree starts at face 0.
struct FaceRun {
  std::uint32_t first_face;
  std::uint32_t number;

  friend bool operator==(const FaceRun&, const FaceRun&) = default;
};
static_assert(sizeof(FaceRun) == 8 && std::is_trivially_copyable_v<FaceRun>);

/// The other form of what is stored by runs: the number of each face in tree order.
[[nodiscard]] constexpr SectionKind by_face(SectionKind runs) noexcept {
  return SectionKind{static_cast<std::uint32_t>(runs) + 1};
}
static_assert(by_face(SectionKind::kMaterialRuns) == SectionKind::kFaceMaterials);
static_assert(by_face(SectionKind::kUserDataRuns) == SectionKind::kFaceUserData);

/// Bytes of each number, if so many of them take `bytes` in all.
[[nodiscard]] constexpr std::uint8_t width_of_numbers(std::uint64_t bytes,
                                                      std::uint32_t count) noexcept {
  if (bytes <= count) return 1;
  return bytes <= std::uint64_t{2} * count ? 2 : 4;
}

}  // namespace boxtree
