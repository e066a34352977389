// SPDX-License-Identifier: MIT
#include "runtime/tree/materials.h"

#include <algorithm>

#include "format/scene_record.h"

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

}  // namespace boxtree
