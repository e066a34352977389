// SPDX-License-Identifier: MIT
// Finds the materials of the faces of an FBX file. Assimp states them by splitting a mesh into one
// per material, which sorts the faces. The file is therefore read twice, and the faces of the
// sorted reading are matched with those in the order of the file.
#pragma once

#include <vector>

#include "format/face_numbers.h"

struct aiScene;

namespace boxtree::cooker {

/// Runs of the faces of one mesh with three corners or more, numbered from 0: ascending, the first
/// run starts at face 0. Materials are indices into aiScene::mMaterials, or kNoMaterial.
using MeshMaterials = std::vector<FaceRun>;

/// `in_order`: the file read without materials; `sorted`: with them. Moves the materials of
/// `sorted` to `in_order` and returns the runs of each mesh of `in_order`. A mesh whose faces
/// cannot be matched gets one run of kNoMaterial: if bitwise equal faces have several materials, or
/// if the two readings contain different faces.
std::vector<MeshMaterials> match_materials(aiScene& in_order, aiScene& sorted);

}  // namespace boxtree::cooker
