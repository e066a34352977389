// SPDX-License-Identifier: MIT
// Tries work that may crash or never end: assimp's many readers, which are not hardened.
#pragma once

#include <cstdint>
#include <functional>

#include <boxtree/error.h>

namespace boxtree::cooker {

struct TrialLimits {
  std::uint64_t cpu_seconds;
  std::uint64_t clock_seconds;  // while this process waits for it
  std::uint64_t bytes;          // of address space, in addition to this process's own
};

/// Whether `bytes` is enforced: sanitizers reserve terabytes of address space, and what this
/// process has of it only Linux tells.
#if !defined(__linux__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)  // GCC
inline constexpr bool kLimitsMemory = false;
#elif !defined(__clang__)
inline constexpr bool kLimitsMemory = true;
#elif __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
inline constexpr bool kLimitsMemory = false;
#else
inline constexpr bool kLimitsMemory = true;
#endif

/// Limits for files of this size in all. Memory: 1 GiB plus 1 KiB a byte, ten times what readers of
/// compressed formats take, but at most half of the machine's. Processor time: 10 s plus a second
/// per 100 kB, a tenth of the speed of assimp's slowest readers. By the clock ten times that and
/// 200 s more, since a machine may have more to do.
[[nodiscard]] TrialLimits trial_limits(std::uint64_t file_bytes);

/// In the copy that try_in_child() made: from now on these limits of memory and processor time hold
/// instead of those it began with, in all.
void extend_trial(const TrialLimits& limits);

/// Runs `work` in a copy of this process and returns its result; other effects are lost, including
/// what the copy prints. kOutOfMemory if the copy needs more than `limits.bytes`, kImportFailed
/// with the reason if it crashes, takes more of either time than its limit, stopped or not, or
/// cannot be started. The copy has one thread. It starts with the same memory, so work that
/// succeeds in it succeeds here, unless it depends on clocks or other threads, or on memory that it
/// has not set: in the copy what is allocated holds other bytes than zero (GNU C library), so that
/// a result that depends on them differs.
Result<std::uint64_t> try_in_child(const TrialLimits& limits,
                                   const std::function<Result<std::uint64_t>()>& work);

}  // namespace boxtree::cooker
