// SPDX-License-Identifier: MIT
// `boxtree cook --manifest`: many jobs in one process.
#pragma once

#include "cooker/cli/farm_arguments.h"
#include "cooker/farm/cook_cache.h"

namespace boxtree::cooker {

/// How a run over a manifest reports and works.
struct ManifestRun {
  const FarmArguments& farm;
  const CookCache* cache;  // null: none
  int threads;
  bool json;   // a line for each job on standard output
  bool quiet;  // errors and warnings alone
};

/// Cooks all jobs of the manifest and says what became of each. The exit status: 0 if all are done;
/// kExitInputOutput if any may pass when it is run again; else that of what failed.
int cook_manifest(const ManifestRun& run);

}  // namespace boxtree::cooker
