// SPDX-License-Identifier: MIT
// Views a source mesh as the arrays that an application binds.
#pragma once

#include <boxtree/file.h>
#include <boxtree/scene.h>

#include "cooker/import/source_mesh.h"

namespace boxtree {
struct TreeRecord;
}  // namespace boxtree

namespace boxtree::cooker {

/// Points into `mesh`. Faces have four corners each; kNoCorner is the runtime's missing corner.
[[nodiscard]] MeshArrays arrays_of(const SourceMesh& mesh);

/// The hash by which a reader recognises the mesh. Precondition: import's guarantees on meshes.
[[nodiscard]] std::uint64_t hash_of(const SourceMesh& mesh);

/// Replaces the missing mesh of a tree with external geometry if no leaf is read: the tree can be
/// bound and its boxes walked.
[[nodiscard]] MeshArrays absent_arrays(const TreeRecord& record);

/// Binds a scene whose leaves are not read; external geometry need not be given, and the meshes of
/// `options` are not used. Errors: as for
/// Scene::bind.
[[nodiscard]] Result<Scene> bind_without_meshes(const File& file, SceneOptions options = {});

}  // namespace boxtree::cooker
