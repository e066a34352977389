// SPDX-License-Identifier: MIT
// A trial of work that may crash or never end: readers of assimp, which are many and not hardened.
#pragma once

#include <cstdint>
#include <functional>

#include <boxtree/error.h>

namespace boxtree::cooker {

struct TrialLimits {
  std::uint64_t cpu_seconds;
  std::uint64_t bytes;  // of address space, beside what this process has
};

/// Whether `bytes` are kept to: sanitizers take terabytes of address space for themselves.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // GCC
inline constexpr bool kLimitsMemory = false;
#elif !defined(__clang__)
inline constexpr bool kLimitsMemory = true;
#elif __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kLimitsMemory = false;
#else
inline constexpr bool kLimitsMemory = true;
#endif

/// What a file of so many bytes may take: half of the machine's memory, 30 s and another second for
/// each 100 kB, a tenth of the pace of assimp's slowest readers.
[[nodiscard]] TrialLimits trial_limits(std::uint64_t file_bytes);

/// Runs `work` in a copy of this process, and returns what it returned there; nothing else of it is
/// left. kImportFailed, with the reason, when the copy crashes, comes to a limit, sleeps for ten
/// times the limit of seconds, or cannot be started. The copy has one thread, and what it prints is
/// lost. As it begins with the same memory, what ended well in it ends well here: the same work
/// does the same, unless it looks at clocks or at other threads.
Status try_in_child(const TrialLimits& limits, const std::function<Status()>& work);

}  // namespace boxtree::cooker
