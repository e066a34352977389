// SPDX-License-Identifier: MIT
// Meshes of the exact oracle, from one triangle to some hundred.
#pragma once

#include "cooker/import/source_mesh.h"
#include "tests/oracle/exact/draw.h"

namespace boxtree::oracle {

/// Which meshes a family can use.
struct MeshWish {
  bool f64 = true;           // f64 meshes as well
  bool extreme = true;       // also kinds whose sizes differ by more than double's 53 bits
  std::uint32_t faces = 40;  // at most; one mesh in 16 has up to eight times as many
};

/// A mesh of a random kind. Its name tells the kind.
[[nodiscard]] cooker::SourceMesh draw_mesh(Draw& draw, const MeshWish& wish = {});

}  // namespace boxtree::oracle
