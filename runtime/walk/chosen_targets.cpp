// SPDX-License-Identifier: MIT
#include "runtime/walk/chosen_targets.h"

#include <atomic>
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

}  // namespace boxtree
