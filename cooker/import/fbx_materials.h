// SPDX-License-Identifier: MIT
// Materials of the faces of an FBX file. Assimp's reader tells them by meshes of its own, one for
// each material of a mesh, which sorts the faces; so a file is read twice, and the faces of the
// sorted reading are found again in the order of the file.
#pragma once

#include <vector>

#include "format/scene_record.h"

struct aiScene;

namespace boxtree::cooker {

/// Runs of the faces of one mesh that have three corners or more, numbered from 0, ascending, the
/// first from face 0 on; materials are numbers of aiScene::mMaterials, or kNoMaterial.
using MeshMaterials = std::vector<MaterialRun>;

/// `in_order`: the file read without materials; `sorted`: with them. Gives `in_order` the materials
/// of `sorted`, and returns the runs of each mesh of `in_order`. A mesh whose faces are not found
/// again has a run of kNoMaterial: where faces that are equal to the last bit have several
/// materials, or where the two readings hold other faces.
std::vector<MeshMaterials> match_materials(aiScene& in_order, aiScene& sorted);

}  // namespace boxtree::cooker
