// SPDX-License-Identifier: MIT
// Reads OBJ files (Wavefront, "Object Files (.obj)"): vertices, faces and names of materials.
// Assimp is not used: it refuses a file with a bad vertex number as a whole without its place,
// skips vertices in forms that it does not know, and rounds decimals more than once, to f32.
#pragma once

#include <filesystem>
#include <vector>

#include "cooker/import/face_materials.h"
#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads the OBJ file `path` into `out`, except the name, as specified for import_mesh: faces in
/// the order of the file, whatever their objects and groups. `materials` gets the names in
/// `usemtl`; Imported::user_data the numbers of groups, if they are wanted. Existing material
/// libraries count among the files read, but nothing is imported from them. Free-form curves and
/// surfaces are skipped.
Status import_obj(const SourceFile& source, const ImportOptions& options, Imported& out,
                  FaceMaterials& materials);

/// The file and the material libraries that import_obj would find. Reads the text, and no vertex of
/// it. Errors: as for a text that cannot be read.
Result<SourceFileList> list_obj_files(const SourceFile& source);

}  // namespace boxtree::cooker
