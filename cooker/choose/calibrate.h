// SPDX-License-Identifier: MIT
// Measures the constants of cost.h on this machine.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include "cooker/choose/cost.h"
#include "cooker/choose/timed_work.h"
#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

struct Calibration {
  std::vector<CodecCost> costs;
  /// Largest ratio of modelled to measured time, or its inverse, over all meshes and kinds.
  double worst_ratio = 1;
  TimedWork timed_work;  // all that was timed
};

/// Cooks each mesh with every codec and both geometry stores, runs the queries that candidates are
/// compared by, and fits the steps to the times: processor time of one thread, medians of `runs`.
/// Use at least three meshes of different sizes. Errors: those of cooking and queries; kNoFaces if
/// no mesh has any.
Result<Calibration> calibrate(std::span<const SourceMesh> meshes, std::size_t runs,
                              const std::function<void(const std::string& step)>& progress = {});

}  // namespace boxtree::cooker
