// SPDX-License-Identifier: MIT
#include "runtime/walk/chosen_targets.h"

#include <atomic>

#include "runtime/walk/targets.h"
// Its macros follow those of targets.h.
#include <hwy/targets.h>

namespace boxtree {
namespace {

std::atomic<std::int64_t> known_targets = 0;  // 0: not known yet

}  // namespace

std::int64_t chosen_targets() noexcept {
  // Highway forgets that it has chosen when its targets are changed. Threads that are here for the
  // first time at once find the same.
  hwy::ChosenTarget& chosen = hwy::GetChosenTarget();
  std::int64_t targets = known_targets.load(std::memory_order_relaxed);
  if (targets != 0 && chosen.IsInitialized()) return targets;
  targets = hwy::SupportedTargets();
  chosen.Update(targets);
  known_targets.store(targets, std::memory_order_relaxed);
  return targets;
}

const char* chosen_instruction_set() noexcept {
  const std::int64_t targets = chosen_targets();
  const std::int64_t of_walks = targets & HWY_TARGETS;
  const std::int64_t best = of_walks & -of_walks;  // Highway's lowest bit is its best
#ifdef __x86_64__
  if (best == HWY_AVX3) return "AVX-512";
  if (best == HWY_AVX2 && (targets & HWY_AVX3_DL) != 0) return "AVX2, leaves of clusters AVX-512";
#endif
  return hwy::TargetName(best);
}

}  // namespace boxtree
