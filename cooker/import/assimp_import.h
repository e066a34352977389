// SPDX-License-Identifier: MIT
// Imports the formats for which boxtree has no reader of its own.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "cooker/import/import.h"
#include "cooker/import/source_scene.h"

namespace boxtree::cooker {

/// The result of an import: one mesh, a scene, or the one of these that fits the node graph.
enum class ImportWanted : std::uint8_t { kMesh, kScene, kFitting };

/// Reads `source` into `out`, except the name, as import.h and source_scene.h specify.
Status import_with_assimp(const SourceFile& source, const ImportOptions& options,
                          ImportWanted wanted, ImportedFile& out);

/// The files that import_with_assimp reads of `source`, in order of first use. Only reading tells
/// them, so this costs as much. Errors: those of it.
Result<SourceFileList> list_assimp_files(const SourceFile& source, const ImportOptions& options);

/// Endings of the names of files that assimp reads, in lower case.
[[nodiscard]] std::vector<std::string> assimp_endings();

/// "5.2.5": of the library that runs, on which what is read depends.
[[nodiscard]] std::string assimp_version();

}  // namespace boxtree::cooker
