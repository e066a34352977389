// SPDX-License-Identifier: MIT
// Proves what a file states: every triangle is inside every decoded box above it, every face is
// reached exactly once, and the counts are as stated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boxtree/file.h>

#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

/// Findings of one check, in order of discovery. Empty if the check passes.
using Findings = std::vector<Error>;

/// The number of findings kept per tree; a damaged tree can have millions.
inline constexpr std::size_t kMaxFindings = 100;

/// The result of walking one tree.
struct TreeProof {
  std::uint32_t depth = 0;             // inner nodes on the longest path
  std::uint32_t node_count = 0;        // nodes reached from the root
  std::uint32_t face_count = 0;        // faces reached, each exactly once; copies via originals
  std::uint32_t triangle_count = 0;    // of faces that were read
  std::uint32_t degenerate_count = 0;  // of these, triangles without area
  std::uint64_t missed = 0;            // faces in no leaf
  std::uint64_t escapes = 0;           // boxes that do not contain what is below them
  Findings findings;                   // the first kMaxFindings
};

/// The message for a node at which a walk cannot continue, given the result of decoding it.
[[nodiscard]] std::string fault_of_node(std::uint32_t node, NodeState state);

/// Walks the whole tree as a reader would. With `with_geometry` false, leaves are counted but
/// triangles are not read (external geometry without its mesh). Whoever has the tree's record
/// compares degenerate_count, which a tree does not know. Safe on any bytes.
[[nodiscard]] TreeProof prove_tree(const Tree& tree, bool with_geometry);

/// Checks an open file: padding, section checksums, records, names, reserved bytes, and each tree
/// by prove_tree and against its record. `mesh` is for trees with external geometry; without
/// it their triangles are not read. Of a pack, its index, and each member likewise.
[[nodiscard]] Findings verify_file(const File& file, const std::optional<MeshArrays>& mesh = {});

}  // namespace boxtree::cooker
