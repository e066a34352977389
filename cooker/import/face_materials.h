// SPDX-License-Identifier: MIT
// Materials found by boxtree's own readers, as runs of faces.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "format/face_numbers.h"

namespace boxtree::cooker {

/// The material of faces before the first material of a file that has one.
inline constexpr std::string_view kDefaultMaterial = "DefaultMaterial";

struct FaceMaterials {
  std::vector<std::string> names;  // in order of first use, without duplicates
  std::vector<FaceRun> runs;       // by face number, ascending; empty: no face has a material
};

/// Fills in FaceMaterials from statements that set the material of all faces that follow. Groups
/// are numbered the same way.
class MaterialUse {
 public:
  /// `out` must outlive this object; it is complete after finish(). `unnamed`, a constant: what
  /// faces have before any statement, and after one without a name.
  explicit MaterialUse(FaceMaterials& out, std::string_view unnamed = kDefaultMaterial)
      : out_(out), unnamed_(unnamed), current_(unnamed) {}

  /// Sets the material of the next faces; none if `name` is empty.
  void begin(std::string_view name) {
    current_ = name.empty() ? unnamed_ : name;
    has_changed_ = true;
  }
  /// `face` has the current material.
  void add_face(std::uint32_t face);
  /// Drops the materials if no face has one by name.
  void finish();

 private:
  FaceMaterials& out_;
  const std::string_view unnamed_;
  std::string current_;
  bool has_changed_ = true;  // since the last face
  std::unordered_map<std::string, std::uint32_t> numbers_;
};

}  // namespace boxtree::cooker
