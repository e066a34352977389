// SPDX-License-Identifier: MIT
// Binary PLY and STL files of generated meshes.
#pragma once

#include <filesystem>

#include "cooker/import/source_mesh.h"

namespace boxtree::bench {

/// Writes `mesh`, triangles with f32 positions, as little-endian PLY or as STL, depending on the
/// extension of `path`. Throws std::runtime_error on failure.
void write_mesh(const cooker::SourceMesh& mesh, const std::filesystem::path& path);

}  // namespace boxtree::bench
