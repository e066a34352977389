// SPDX-License-Identifier: MIT
// What materials are called: of single trees and of scenes.
#pragma once

#include <cstdint>
#include <string_view>

#include "format/bytes.h"

namespace boxtree {

/// The materials that a file names; those of all its trees.
class MaterialNames {
 public:
  MaterialNames() noexcept = default;
  /// `records`: section materials. `names`: section names.
  MaterialNames(Bytes records, Bytes names) noexcept;

  [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
  /// Whether both are those of one file.
  [[nodiscard]] bool is_same_as(const MaterialNames& other) const noexcept {
    return records_ == other.records_ && names_ == other.names_;
  }
  /// Empty if there is no such material, it has no name, or bytes are corrupt.
  [[nodiscard]] std::string_view operator[](std::uint32_t number) const noexcept;

 private:
  const std::byte* records_ = nullptr;
  const std::byte* names_ = nullptr;
  std::uint32_t count_ = 0;
  std::uint32_t name_bytes_ = 0;
};

}  // namespace boxtree
