// SPDX-License-Identifier: MIT
// Materials found by boxtree's own readers, as runs of faces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "format/scene_record.h"

namespace boxtree::cooker {

/// The material of faces before the first material of a file that has one.
inline constexpr std::string_view kDefaultMaterial = "DefaultMaterial";

struct FaceMaterials {
  std::vector<std::string> names;  // in order of first use, without duplicates
  std::vector<MaterialRun> runs;   // by face number, ascending; empty: no face has a material
};

/// Fills in FaceMaterials from statements that set the material of all faces that follow.
class MaterialUse {
 public:
  /// `out` must outlive this object; it is complete after finish().
  explicit MaterialUse(FaceMaterials& out) : out_(out) {}

  /// Sets the material of the next faces; none if `name` is empty.
  void begin(std::string_view name) {
    current_ = name.empty() ? kDefaultMaterial : name;
    has_changed_ = true;
  }
  /// `face` has the current material.
  void add_face(std::uint32_t face);
  /// Drops the materials if no face has one by name.
  void finish();

 private:
  FaceMaterials& out_;
  std::string current_ = std::string(kDefaultMaterial);
  bool has_changed_ = true;  // since the last face
  std::unordered_map<std::string, std::uint32_t> numbers_;
};

}  // namespace boxtree::cooker
