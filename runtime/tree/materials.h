// SPDX-License-Identifier: MIT
// Which material a face has, and what materials are called: of single trees and of scenes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <boxtree/tree.h>

#include "format/bytes.h"

namespace boxtree {

/// The materials that a file names; those of all its trees.
class MaterialNames {
 public:
  MaterialNames() noexcept = default;
  /// `records`: section materials. `names`: section names.
  MaterialNames(Bytes records, Bytes names) noexcept;

  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
  /// Empty if there is no such material, it has no name, or bytes are corrupt.
  [[nodiscard]] std::string_view operator[](std::uint32_t number) const noexcept;

 private:
  const std::byte* records_ = nullptr;
  const std::byte* names_ = nullptr;
  std::uint32_t count_ = 0;
  std::uint32_t name_bytes_ = 0;
};

/// The materials of the faces of one tree, or none.
class MaterialView {
 public:
  MaterialView() noexcept = default;
  /// To sections material_runs and face_materials. Precondition: of none. Error: kSectionSize.
  Status bind(Bytes runs, Bytes faces, std::uint32_t face_count, std::uint32_t material_count);

  explicit operator bool() const noexcept { return bytes_ != nullptr; }
  /// kNoMaterial if there are none, or for want of the face's id; any number on corrupt bytes.
  /// Precondition: `face_count` is that of bind().
  [[nodiscard]] std::uint32_t of(const FaceRef& face, std::uint32_t face_count) const noexcept;

 private:
  const std::byte* bytes_ = nullptr;  // MaterialRun[], or numbers of faces
  std::uint32_t run_count_ = 0;
  std::uint8_t width_ = 0;  // of a number, if there are no runs
};

}  // namespace boxtree
