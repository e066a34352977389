// SPDX-License-Identifier: MIT
// Finds the elements and properties of a PLY file that form the mesh.
#pragma once

#include <array>
#include <string>

#include "cooker/import/ply_header.h"

namespace boxtree::cooker {

/// Points into its own header, so it must not be moved.
struct PlyLayout {
  PlyHeader header;
  const PlyElement* vertex = nullptr;
  const PlyElement* face = nullptr;        // one polygon each
  const PlyElement* tristrips = nullptr;   // any number of triangles each, as in Stanford's files
  const PlyProperty* corners = nullptr;    // the property of faces that holds their corners
  const PlyProperty* strip = nullptr;      // the same for strips
  const PlyProperty* user_data = nullptr;  // of faces, if it is wanted
  const PlyProperty* face_ids = nullptr;   // likewise
  std::array<const PlyProperty*, 3> xyz{};

  PlyLayout() = default;
  PlyLayout(const PlyLayout&) = delete;
  PlyLayout& operator=(const PlyLayout&) = delete;
};

/// Fills in all members except the header, which is given. kImportFailed if an element or property
/// that must be unique is not, or if faces precede their vertices; kNoFaces if no element holds
/// faces.
Status find_ply_parts(PlyLayout& layout);

/// Fills in user_data: the property `name` of faces. kMeshUnsupported if there is none such, or it
/// is not one integer a face. Precondition: the other members are filled in.
Status find_user_data(const std::string& name, PlyLayout& layout);
/// Fills in face_ids, likewise.
Status find_face_ids(const std::string& name, PlyLayout& layout);

}  // namespace boxtree::cooker
