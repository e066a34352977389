// SPDX-License-Identifier: MIT
// Checks candidates by the walk that proves a written file.
#include "cooker/proof/gates.h"

#include "cooker/proof/proof.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

Gates check_gates(const EncodedTree& tree, const MeshArrays& source) {
  BindOptions options;
  options.mesh = source;
  const Result<Tree> bound = bind_encoded(tree, options);
  if (!bound) return {tree.face_count, 0, false};
  const TreeProof proof = prove_tree(*bound, true);
  const bool holds = proof.degenerate_count == tree.degenerate_count;
  // Any finding other than a missed face or an escape contradicts the counts.
  return {proof.missed, proof.escapes,
          holds && (proof.findings.empty() || proof.missed + proof.escapes > 0)};
}

}  // namespace boxtree::cooker
