// SPDX-License-Identifier: MIT
// Which elements and properties of a PLY file are the mesh.
#pragma once

#include <array>

#include <boxtree/cooker/import/ply_header.h>

namespace boxtree::cooker {

/// Points into its own header, so that it must stay where it is.
struct PlyLayout {
  PlyHeader header;
  const PlyElement* vertex = nullptr;
  const PlyElement* face = nullptr;
  const PlyProperty* corners = nullptr;  // of faces: which of their lists
  std::array<const PlyProperty*, 3> xyz{};

  PlyLayout() = default;
  PlyLayout(const PlyLayout&) = delete;
  PlyLayout& operator=(const PlyLayout&) = delete;
};

/// Fills in all but the header, which is there. False if it is none of a mesh that we can read:
/// faces before their vertices, triangle strips, types that are not known, or several of what there
/// has to be one of.
[[nodiscard]] bool find_ply_parts(PlyLayout& layout);

}  // namespace boxtree::cooker
