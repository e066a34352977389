// SPDX-License-Identifier: MIT
// Gates by the same walk that proves a written file.
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
  const bool holds = certificate_holds(certificate_of(tree), proof.certificate, true);
  // A finding that is neither a missed face nor an escape is a contradiction in the counts.
  return {proof.missed, proof.escapes,
          holds && (proof.findings.empty() || proof.missed + proof.escapes > 0)};
}

}  // namespace boxtree::cooker
