// SPDX-License-Identifier: MIT
// Reads PLY files: a header, then a body of text or binary numbers.
#pragma once

#include <filesystem>

#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads the PLY file `path` into `out`, except the name, as specified for import_mesh. Positions
/// keep all digits of the file; polygons and triangle strips are imported in the order of the file.
Status import_ply(const SourceFile& source, const ImportOptions& options, Imported& out);

}  // namespace boxtree::cooker
