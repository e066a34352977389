// SPDX-License-Identifier: MIT
// OBJ files (Wavefront, "Object Files (.obj)"): vertices, faces and the names of materials. Assimp
// refuses a file with a bad vertex number as a whole and says not where, passes over vertices in
// forms that it does not know, and rounds decimals more than once, to f32.
#pragma once

#include <filesystem>

#include "cooker/import/face_materials.h"
#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads `path`, an OBJ file, into `out`, all but the name, as import_mesh promises: faces in the
/// order of the file, whatever their objects and groups. `materials` gets the names of `usemtl`.
/// Libraries of materials that are there count among the files read, though nothing of them is
/// taken over. Free-form curves and surfaces are passed over.
Status import_obj(const std::filesystem::path& path, const ImportOptions& options, Imported& out,
                  FaceMaterials& materials);

}  // namespace boxtree::cooker
