// SPDX-License-Identifier: MIT
// What stands in the place of a mesh, whatever its name says.
#pragma once

#include "cooker/import/source_file.h"

namespace boxtree::cooker {

/// What a file is that begins as no mesh does, for a message: "a picture (PNG)"; nullptr if it may
/// be a mesh.
[[nodiscard]] const char* foreign_file(const SourceFile& source);

/// Whether it begins with the byte order mark of UTF-8, which some readers skip.
[[nodiscard]] bool begins_with_mark(const SourceFile& source);

/// The ending, ".ply", of the meshes that begin as the file does, if its name has another one;
/// nullptr if it may be what its name says.
[[nodiscard]] const char* misnamed_mesh(const SourceFile& source);

}  // namespace boxtree::cooker
