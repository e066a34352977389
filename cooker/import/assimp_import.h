// SPDX-License-Identifier: MIT
// Formats that we have no reader of our own for.
#pragma once

#include <cstdint>
#include <filesystem>

#include "cooker/import/import.h"
#include "cooker/import/source_scene.h"

namespace boxtree::cooker {

/// What becomes of a file: one mesh, a scene, or the one of both that its node graph is.
enum class ImportWanted : std::uint8_t { kMesh, kScene, kFitting };

/// Reads `path` into `out`, all but the name, as import.h and source_scene.h promise.
Status import_with_assimp(const std::filesystem::path& path, const ImportOptions& options,
                          ImportWanted wanted, ImportedFile& out);

}  // namespace boxtree::cooker
