// SPDX-License-Identifier: MIT
// Writes a source mesh with its faces in the order of its tree. Only faces move: everything else
// that the file says (positions, normals, texture coordinates, colours, materials, groups, names,
// comments) stays as it is, byte for byte, so no attribute can be lost or rounded.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

#include "cooker/cook.h"
#include "cooker/import/import.h"
#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {

/// Whether a mesh can be written to `target` in the order of a tree of `source`: both have the same
/// ending, which is obj, ply, gltf or glb. Reads nothing. Error: kMeshUnsupported.
Status check_reordered_names(const std::filesystem::path& source,
                             const std::filesystem::path& target);

/// Writes `source` to `target`, face i being faces[i]; the caller commits the file. Polygons that
/// import splits become their triangles. What is no face (points, lines) follows the faces. Faces
/// that skip_bad dropped are left out. References to other files lead to them from the folder of
/// `target`.
///
/// - OBJ: faces follow all vertices; material, group, smoothing and the like are set again where
///   they change from one face to the next. Vertex numbers are absolute.
/// - PLY: the records of faces, in the form of the source. Of a split polygon's lists for each
///   corner (texcoord, color), each triangle gets its part.
/// - glTF 2.0: the vertex numbers of the only primitive of triangles, in the same place of a .glb;
///   in a new buffer inside of a .gltf, which still refers to the source's others.
///
/// Errors: kMeshUnsupported for PLY with triangle strips, and for glTF with several primitives of
/// triangles, with strips or fans, placed more than once, compressed or sparse; kImportFailed if
/// the source is not what was cooked; kFileUnreadable, kWriteFailed.
Result<AtomicFile> write_reordered(const std::filesystem::path& source,
                                   std::span<const SourceCorners> faces,
                                   const std::filesystem::path& target);

/// Whether a mesh is the one that a file was cooked with: one that an earlier write_reordered()
/// has written beside it. `import`: how meshes are read; the file says with which precision.
[[nodiscard]] bool is_mesh_of(const std::filesystem::path& mesh,
                              const std::filesystem::path& cooked, ImportOptions import);

}  // namespace boxtree::cooker
