// SPDX-License-Identifier: MIT
// The two forms of how a visit ended: that of single queries and that of batches.
#pragma once

#include <boxtree/overlap_batch.h>

namespace boxtree {

/// Precondition: an error has no detail, as those of walks.
[[nodiscard]] inline VisitResult visit_result(const Result<Visit>& visit) noexcept {
  return visit ? VisitResult(*visit) : VisitResult(visit.code());
}

[[nodiscard]] inline Result<Visit> as_result(const VisitResult& visit) {
  if (!visit.ok()) return visit.error();
  return *visit;
}

}  // namespace boxtree
