// SPDX-License-Identifier: MIT
// A mesh cooked with every codec and store.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tests/support/cooked.h"

namespace boxtree::robustness {

using cooker::SourceMesh;

struct Store {
  GeometryId geometry;
  int grid_bits;  // of geometry grid
};

/// The stores; answers are compared with brute force over the triangles that they decode to.
inline constexpr std::array kStores = {Store{GeometryId::kExact, 24}, Store{GeometryId::kGrid, 24}};
inline constexpr Store kExactStore = kStores[0];

/// One mesh cooked with one codec and store.
struct Subject {
  test::CookedTree cooked;
  std::string name;  // mesh, codec, store

  [[nodiscard]] const Tree& tree() const { return cooked.tree; }
};

[[nodiscard]] Subject make_subject(const SourceMesh& mesh, CodecId codec, const Store& store);

/// Calls body(subject) for every codec with every store.
template <class Body>
void for_each_subject(const SourceMesh& mesh, Body body) {
  for (const Store& store : kStores) {
    for (const CodecInfo& codec : kCodecs) body(make_subject(mesh, codec.id, store));
  }
}

/// A triangle as a reader decodes it, in tree space.
struct DecodedTriangle {
  std::uint32_t face;  // number in the source
  std::uint32_t half;  // 1 for the second triangle of a quad
  Triangle triangle;
};

/// All triangles, read only from the geometry, face by face, without nodes. Ordered by face and
/// half. Throws on corrupt bytes.
[[nodiscard]] std::vector<DecodedTriangle> decoded_triangles(const Tree& tree);

/// The results of a walk over all nodes.
struct WalkFigures {
  std::uint64_t escapes = 0;         // pairs of a box and a triangle below it that is not inside
  std::uint64_t boxes_infinite = 0;  // boxes with a non-finite coordinate
  std::uint64_t missed = 0;          // faces in no leaf
  std::uint64_t repeated = 0;        // faces of leaves that were reached before
  std::uint64_t leaves = 0;
  std::uint32_t depth = 0;  // inner nodes on the longest path
};

/// Decodes every node and compares every triangle with every box on the path to it.
[[nodiscard]] WalkFigures walk_tree(const Tree& tree);

}  // namespace boxtree::robustness
