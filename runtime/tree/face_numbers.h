// SPDX-License-Identifier: MIT
// Which number a face has: of its material, or what the application stored of it.
#pragma once

#include <cstdint>
#include <optional>

#include <boxtree/tree.h>

#include "format/bytes.h"
#include "format/container.h"

namespace boxtree {

/// Where they are stored: in one of both forms, or nowhere.
struct FaceNumberSections {
  Bytes runs;   // FaceRun[]
  Bytes faces;  // the number of each face in tree order
};

/// The numbers of the faces of one tree, or none.
class FaceNumberView {
 public:
  FaceNumberView() noexcept = default;
  /// `kind` is that of the runs; numbers of faces have `width` bytes. Error: kSectionSize.
  /// Preconditions: bound to none; is_number_width(width).
  Status bind(const FaceNumberSections& sections, SectionKind kind, std::uint32_t face_count,
              std::uint8_t width);

  explicit operator bool() const noexcept { return bytes_ != nullptr; }
  /// Nothing if there are none, or for want of the face's id; any number on corrupt bytes.
  /// Precondition: `face_count` is that of bind().
  [[nodiscard]] std::optional<std::uint32_t> of(const FaceRef& face,
                                                std::uint32_t face_count) const noexcept;

 private:
  const std::byte* bytes_ = nullptr;  // FaceRun[], or numbers of faces
  std::uint32_t run_count_ = 0;
  std::uint8_t width_ = 0;  // of a number, if there are no runs
};

}  // namespace boxtree
