// SPDX-License-Identifier: MIT
// The proof behind the certificate: every triangle lies inside every decoded box above it, every
// face is reached exactly once, and the counts are as stated.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <boxtree/file.h>

#include "format/certificate_record.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

/// Findings of one check, in order of discovery. Empty means: it holds.
using Findings = std::vector<Error>;

/// At most this many findings are kept of one tree; a damaged tree has millions of them.
inline constexpr std::size_t kMaxFindings = 100;

/// What a walk of one tree found.
struct TreeProof {
  CertificateRecord certificate{};  // the counts met
  std::uint64_t missed = 0;         // faces in no leaf
  std::uint64_t escapes = 0;        // boxes that do not hold what is below them
  Findings findings;                // the first kMaxFindings of all that does not hold
};

/// What is found of a node that a walk cannot go on from, by what decoding it gave.
[[nodiscard]] std::string fault_of_node(std::uint32_t node, NodeState state);

/// Walks the whole tree as a reader would. With `with_geometry` false, leaves are counted but
/// triangles not looked at (external geometry whose mesh is not at hand). Safe on any bytes.
[[nodiscard]] TreeProof prove_tree(const Tree& tree, bool with_geometry);

/// Whether a stated certificate is well formed and says what was found.
[[nodiscard]] bool certificate_holds(const CertificateRecord& stated,
                                     const CertificateRecord& found, bool with_geometry);

/// Everything that can be checked of an open file: padding, section checksums, records, names,
/// bytes that have to be zero, each tree by prove_tree and against its certificate. `mesh` serves
/// trees with external geometry; without it their triangles are not looked at.
[[nodiscard]] Findings verify_file(const File& file, const std::optional<MeshArrays>& mesh = {});

}  // namespace boxtree::cooker
