// SPDX-License-Identifier: MIT
// Calls the version of a function for the best instruction set that the machine has, as
// HWY_EXPORT and HWY_DYNAMIC_DISPATCH of Highway do, but for one thing: an index into their tables
// depends on the instruction sets of the source that uses it, yet is computed by an inline
// function of one name. Builds that inline nothing (without -O) keep one of these functions for all
// sources of a program, those of other libraries included, and call null pointers. The one here is
// each source's own.
//
// Included after <hwy/highway.h>, where HWY_ONCE.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include "runtime/walk/chosen_targets.h"

#if (HWY_TARGETS & (HWY_TARGETS - 1)) == 0  // one alone

#define BOXTREE_EXPORT(function) static_assert(true)
#define BOXTREE_DISPATCH(function) HWY_STATIC_DISPATCH(function)

#else

namespace boxtree {
namespace {

// Place in tables of BOXTREE_EXPORT: the lowest bit is the best, the last is what runs anywhere.
inline std::size_t dispatch_index() noexcept {
  const auto chosen = static_cast<std::uint64_t>(chosen_targets() & HWY_TARGETS);
  constexpr std::uint64_t kFallback = HWY_CHOSEN_TARGET_MASK_SCALAR;
  return static_cast<std::size_t>(
      std::countr_zero((HWY_CHOSEN_TARGET_SHIFT(chosen) | kFallback) >> 1));
}

}  // namespace
}  // namespace boxtree

// In the namespace of boxtree around that of the instruction set.
#define BOXTREE_EXPORT(function)                                                \
  constexpr decltype(&HWY_STATIC_DISPATCH(function)) function##_by_target[] = { \
      HWY_CHOOSE_TARGET_LIST(function), HWY_CHOOSE_FALLBACK(function)}
#define BOXTREE_DISPATCH(function) (*function##_by_target[dispatch_index()])

#endif
