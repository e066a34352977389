// SPDX-License-Identifier: MIT
// A source mesh in the shape in which a runtime binds an application's arrays.
#pragma once

#include <boxtree/file.h>
#include <boxtree/scene.h>

#include "cooker/import/source_mesh.h"

namespace boxtree {
struct TreeRecord;
}  // namespace boxtree

namespace boxtree::cooker {

/// Points into `mesh`. Faces are four corners each; kNoCorner is the runtime's missing corner.
[[nodiscard]] MeshArrays arrays_of(const SourceMesh& mesh);

/// Stands for the mesh of a tree with external geometry when it is not at hand and no leaf will be
/// read: such a tree can be bound and its boxes walked.
[[nodiscard]] MeshArrays absent_arrays(const TreeRecord& record);

/// A scene of which no leaf will be read, whose external geometry need not be there. Errors as for
/// Scene::bind.
[[nodiscard]] Result<Scene> bind_without_meshes(const File& file);

}  // namespace boxtree::cooker
