// SPDX-License-Identifier: MIT
#include "runtime/tree/face_numbers.h"

#include <algorithm>

#include "format/face_numbers.h"
#include "format/numbers.h"
#include "runtime/file/section.h"

namespace boxtree {

Status FaceNumberView::bind(const FaceNumberSections& sections, SectionKind kind,
                            std::uint32_t face_count, std::uint8_t width) {
  const auto& [runs, faces] = sections;
  const bool has_runs = faces.empty();
  if (has_runs && runs.empty()) return {};  // a section of no bytes has an address
  std::uint64_t count = face_count;
  if (has_runs) count = std::min<std::uint64_t>(runs.size() / sizeof(FaceRun), count);
  const auto bytes = sized_section(has_runs ? runs : faces, has_runs ? kind : by_face(kind), count,
                                   has_runs ? sizeof(FaceRun) : width);
  if (!bytes) return bytes.error();
  bytes_ = *bytes;
  if (has_runs) run_count_ = static_cast<std::uint32_t>(count);
  width_ = width;
  return {};
}

std::optional<std::uint32_t> FaceNumberView::of(const FaceRef& face,
                                                std::uint32_t face_count) const noexcept {
  if (bytes_ == nullptr) return std::nullopt;
  if (run_count_ == 0) {
    if (face.index >= face_count) return std::nullopt;
    return NumberView(bytes_, width_)[face.index];
  }
  // A single run covers all faces, whatever their ids; else finds the last one that starts at or
  // before it.
  std::uint32_t first = 0;
  std::uint32_t count = run_count_;
  if (count > 1 && face.id == kNoFaceId) return std::nullopt;
  while (count > 1) {
    const std::uint32_t half = count / 2;
    const bool is_right = load<FaceRun>(bytes_, first + half).first_face <= face.id;
    first += is_right ? half : 0;
    count = is_right ? count - half : half;
  }
  return load<FaceRun>(bytes_, first).number;
}

}  // namespace boxtree
