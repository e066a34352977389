// SPDX-License-Identifier: MIT
// A mesh cooked in every codec and store, with its decoded triangles in exact numbers.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include <boxtree/boxtree.h>

#include "format/codec.h"
#include "runtime/tree/bound_tree.h"
#include "tests/oracle/exact/geometry.h"
#include "tests/oracle/exact/meshes.h"

namespace boxtree::oracle {

/// A triangle as a reader decodes it, in tree space.
struct Decoded {
  std::uint32_t face;  // number in the source
  std::uint32_t half;  // 1 for the second triangle of a quad
  Face at;
  ExactFace exact;
  BoxOf bounds;
  double largest;  // coordinate
};

/// One way to store the mesh.
struct Cooked {
  std::string name;  // codec and store
  CodecId codec;
  std::vector<std::byte> bytes;
  File file;
  Tree tree;
};

/// Trees whose decoded triangles are the same, bit for bit, and so are to be their answers.
struct Group {
  std::vector<std::unique_ptr<Cooked>> trees;
  std::vector<Decoded> triangles;  // by face and half
  double largest = 0;              // coordinate of any
  Frame space;                     // of the triangles
  [[nodiscard]] const Frame& frame() const { return space; }
};

/// A mesh and its groups: positions bit for bit (in the file, or external), and on a grid.
struct Subject {
  cooker::SourceMesh mesh;
  std::vector<Group> groups;
};

/// A mesh that cannot be cooked.
struct CookFailed {
  cooker::SourceMesh mesh;
  std::string message;
};

/// Cooks in every codec; `grid` adds the group on a grid. Throws CookFailed, but for a grid
/// that cannot be as fine as was wished, which is left out.
[[nodiscard]] std::unique_ptr<Subject> make_subject(cooker::SourceMesh mesh, bool grid);

/// Triangles in tree space, face by face, read without a look at the nodes.
[[nodiscard]] std::vector<Decoded> decoded_triangles_of(const Tree& tree);

}  // namespace boxtree::oracle
