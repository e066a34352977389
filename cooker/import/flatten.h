// SPDX-License-Identifier: MIT
// An assimp scene becomes one SourceMesh: instances, transforms, welding, polygons.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <assimp/vector3.h>

#include <boxtree/cooker/import/exact_positions.h>
#include <boxtree/cooker/import/face_intake.h>
#include <boxtree/cooker/import/import.h>

struct aiScene;

namespace boxtree::cooker {

/// Faults that were found before assimp saw the file, and how assimp was told: a face that has one
/// refers to a vertex whose position is marker(number of the fault).
struct KnownFaults {
  std::vector<FaceFault> faults;

  /// NaN, +infinity, number: no file holds that by chance, and if one did, the face would be
  /// refused as well. 2^24 numbers are told apart; further faults share the last.
  static aiVector3D marker(std::size_t fault);
  [[nodiscard]] const FaceFault* find(const aiVector3D& position) const;
};

/// Flattens `scene` into `out.mesh` and counts in `out.report`, as import.h says. Frees each mesh
/// of the scene as soon as its last instance is taken over, so that the two never coexist whole.
/// `file` is what errors call the file; `exact` holds positions that assimp knows by number alone.
Status flatten_scene(aiScene& scene, const ImportOptions& options, const std::string& file,
                     const KnownFaults& known, const ExactPositions& exact, Imported& out);

}  // namespace boxtree::cooker
