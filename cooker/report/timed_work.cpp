// SPDX-License-Identifier: MIT
// Compares processor time with elapsed time.
#include "cooker/report/timed_work.h"

#include <algorithm>

namespace boxtree::cooker {
namespace {

// Measured on two processors by `report --quick` of samples/meshes/level.obj, as processor_share of
// --json: 0.996 to 0.998 before all other programs (chrt --fifo 50), 0.31 to 0.40 beside two
// builds. One rival for the processor leaves 0.5.
constexpr double kLeastShare = 0.9;

}  // namespace

double TimedWork::processor_share() const noexcept {
  return elapsed_seconds_ > 0 ? std::min(1.0, processor_seconds_ / elapsed_seconds_) : 1;
}

bool is_disturbed(double processor_share) noexcept {
  return processor_share < kLeastShare;
}

}  // namespace boxtree::cooker
