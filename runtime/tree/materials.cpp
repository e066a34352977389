// SPDX-License-Identifier: MIT
#include "runtime/tree/materials.h"

#include <algorithm>

#include "format/numbers.h"
#include "format/scene_record.h"
#include "runtime/file/section.h"

namespace boxtree {
namespace {

constexpr std::uint32_t kMostBytes = 0xffffffffu;  // that offsets reach

}  // namespace

MaterialNames::MaterialNames(Bytes records, Bytes names) noexcept
    : records_(records.data()),
      names_(names.data()),
      count_(static_cast<std::uint32_t>(records.size() / sizeof(MaterialRecord))),
      name_bytes_(static_cast<std::uint32_t>(std::min<std::uint64_t>(names.size(), kMostBytes))) {}

std::string_view MaterialNames::operator[](std::uint32_t number) const noexcept {
  if (number >= count_) return {};
  const auto [offset, size] = load<MaterialRecord>(records_, number);
  if (!in_range(offset, size, name_bytes_)) return {};
  return {reinterpret_cast<const char*>(names_) + offset, size};
}

Status MaterialView::bind(Bytes runs, Bytes faces, std::uint32_t face_count,
                          std::uint32_t material_count) {
  const std::uint64_t run_count =
      std::min<std::uint64_t>(runs.size() / sizeof(MaterialRun), face_count);
  const auto run_bytes =
      sized_section(runs, SectionKind::kMaterialRuns, run_count, sizeof(MaterialRun));
  if (!run_bytes) return run_bytes.error();
  const std::uint8_t width = material_number_bytes(material_count);
  const auto face_bytes =
      sized_section(faces, SectionKind::kFaceMaterials, faces.empty() ? 0 : face_count, width);
  if (!face_bytes) return face_bytes.error();
  if (runs.empty() && faces.empty()) return {};  // a section of no bytes has an address
  bytes_ = faces.empty() ? *run_bytes : *face_bytes;
  run_count_ = faces.empty() ? static_cast<std::uint32_t>(run_count) : 0;
  width_ = width;
  return {};
}

std::uint32_t MaterialView::of(const FaceRef& face, std::uint32_t face_count) const noexcept {
  if (bytes_ == nullptr) return kNoMaterial;
  if (run_count_ == 0) {
    return face.index < face_count ? NumberView(bytes_, width_)[face.index] : kNoMaterial;
  }
  // A single run covers all faces, whatever their ids; else finds the last one that starts at or
  // before it.
  std::uint32_t first = 0;
  std::uint32_t count = run_count_;
  if (count > 1 && face.id == kNoFaceId) return kNoMaterial;
  while (count > 1) {
    const std::uint32_t half = count / 2;
    const bool is_right = load<MaterialRun>(bytes_, first + half).first_face <= face.id;
    first += is_right ? half : 0;
    count = is_right ? count - half : half;
  }
  return load<MaterialRun>(bytes_, first).material;
}

}  // namespace boxtree
