// SPDX-License-Identifier: MIT
// Materials of faces, and the sections of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cooker/encode/face_numbers.h"
#include "cooker/encode/name_table.h"

namespace boxtree::cooker {

/// Materials of trees without a scene.
struct Materials {
  std::vector<std::string> names;
  std::vector<FaceNumbers> of_trees;
};

struct EncodedMaterials {
  std::vector<std::byte> names;  // MaterialRecord[]
  std::vector<EncodedFaceNumbers> of_trees;
};

/// Lays out the sections; appends names. Precondition: materials that are referred to exist.
[[nodiscard]] EncodedMaterials encode_materials(std::span<const std::string> materials,
                                                std::span<const FaceNumbers> of_trees,
                                                NameTable& names);

}  // namespace boxtree::cooker
