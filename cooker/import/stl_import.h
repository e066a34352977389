// SPDX-License-Identifier: MIT
// Reads STL files, binary or text.
#pragma once

#include <filesystem>

#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads the STL file `path` into `out`, except the name, as specified for import_mesh. Facets
/// become faces in the order of the file; their normals are ignored.
Status import_stl(const SourceFile& source, const ImportOptions& options, Imported& out);

}  // namespace boxtree::cooker
