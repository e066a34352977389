// SPDX-License-Identifier: MIT
// Materials of faces: of each tree the smaller of two forms, and the sections of a file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cooker/encode/name_table.h"
#include "cooker/import/source_mesh.h"
#include "format/scene_record.h"

namespace boxtree::cooker {

/// Materials of one tree's faces: by runs of source faces, or per face in tree order, or neither.
struct TreeMaterials {
  std::vector<MaterialRun> runs;
  std::vector<std::uint32_t> faces;
};

/// Materials of trees without a scene.
struct Materials {
  std::vector<std::string> names;
  std::vector<TreeMaterials> of_trees;
};

struct EncodedMaterials {
  std::vector<std::byte> names;               // MaterialRecord[]
  std::vector<std::vector<std::byte>> runs;   // of each tree
  std::vector<std::vector<std::byte>> faces;  // of each tree
};

/// Lays out the sections; appends names. Precondition: materials that are referred to exist.
[[nodiscard]] EncodedMaterials encode_materials(std::span<const std::string> materials,
                                                std::span<const TreeMaterials> of_trees,
                                                NameTable& names);

/// The material of each face of a mesh. Precondition: `runs` is as in SceneMesh, and not empty.
[[nodiscard]] std::vector<std::uint32_t> materials_of_faces(const SourceMesh& mesh,
                                                            std::span<const MaterialRun> runs);

/// The runs of materials of faces with ascending ids; nothing of those in between.
/// Precondition: as many ids as materials.
[[nodiscard]] std::vector<MaterialRun> runs_of(std::span<const std::uint32_t> ids,
                                               std::span<const std::uint32_t> materials);

}  // namespace boxtree::cooker
