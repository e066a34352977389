// SPDX-License-Identifier: MIT
// Materials that our own readers find, by the faces that have them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "format/scene_record.h"

namespace boxtree::cooker {

/// What faces are called to have that come before the first material of a file, if there is one.
inline constexpr std::string_view kDefaultMaterial = "DefaultMaterial";

struct FaceMaterials {
  std::vector<std::string> names;  // in order of first use, no two alike
  std::vector<MaterialRun> runs;   // by face number, ascending; empty: no face has a material
};

/// Fills in FaceMaterials from statements "from here on this material".
class MaterialUse {
 public:
  /// `out` must outlive it, and is whole after finish().
  explicit MaterialUse(FaceMaterials& out) : out_(out) {}

  /// The next face has it, and so have all after it; none if it has no name.
  void begin(std::string_view name) {
    current_ = name.empty() ? kDefaultMaterial : name;
    has_changed_ = true;
  }
  /// `face` has the material at hand.
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
