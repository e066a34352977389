// SPDX-License-Identifier: MIT
// Which elements and properties of a PLY file are the mesh.
#pragma once

#include <array>

#include "cooker/import/ply_header.h"

namespace boxtree::cooker {

/// Points into its own header, so that it must stay where it is.
struct PlyLayout {
  PlyHeader header;
  const PlyElement* vertex = nullptr;
  const PlyElement* face = nullptr;       // one polygon each
  const PlyElement* tristrips = nullptr;  // any number of triangles each, as Stanford's files have
  const PlyProperty* corners = nullptr;   // of faces: which of their properties
  const PlyProperty* strip = nullptr;     // of strips likewise
  std::array<const PlyProperty*, 3> xyz{};

  PlyLayout() = default;
  PlyLayout(const PlyLayout&) = delete;
  PlyLayout& operator=(const PlyLayout&) = delete;
};

/// Fills in all but the header, which is there. kImportFailed where there are several of what there
/// has to be one of, or faces come before their vertices, which have to be known by then; kNoFaces
/// where no element is to hold any.
Status find_ply_parts(PlyLayout& layout);

}  // namespace boxtree::cooker
