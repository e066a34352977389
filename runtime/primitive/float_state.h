// SPDX-License-Identifier: MIT
// Sets the floating-point state in which every query computes, whatever its caller has set.
#pragma once

#if defined(_MSC_VER) && !defined(__clang__)  // not tested
#include <intrin.h>
#endif
#if defined(__SSE2__) || defined(_M_X64)
#include <xmmintrin.h>
#elif defined(__aarch64__)
#include <cstdint>
#endif

namespace boxtree {

/// While it lives: rounding to nearest, subnormal numbers kept, no traps. Exact predicates need the
/// first two; games often run without the second (FTZ, DAZ). Reading the state costs some
/// nanoseconds; it is written only if it differs. Visitors are called in this state.
class DefaultFloatState {
 public:
#if defined(__SSE2__) || defined(_M_X64)
  DefaultFloatState() noexcept : before_(_mm_getcsr()) {
    if (is_default()) return;
    _mm_setcsr(kDefault);
    fence();
  }
  ~DefaultFloatState() {
    if (is_default()) return;
    fence();
    _mm_setcsr(before_);
  }

 private:
  static constexpr unsigned kDefault = 0x1f80;  // all exceptions masked, all else off
  static constexpr unsigned kFlags = 0x3f;      // exceptions raised so far

  [[nodiscard]] bool is_default() const noexcept {
    return (before_ & ~kFlags) == kDefault;
  }

  unsigned before_;
#elif defined(__aarch64__)
  DefaultFloatState() noexcept {
    asm volatile("mrs %0, fpcr" : "=r"(before_));
    if (before_ == 0) return;
    asm volatile("msr fpcr, %0" : : "r"(std::uint64_t{0}) : "memory");
  }
  ~DefaultFloatState() {
    if (before_ == 0) return;
    asm volatile("msr fpcr, %0" : : "r"(before_) : "memory");
  }

 private:
  std::uint64_t before_;
#else
  DefaultFloatState() noexcept = default;
  ~DefaultFloatState() = default;

 private:
#endif
  // No operand is loaded before, and no result stored after, a change of the state.
  static void fence() noexcept {
#if defined(_MSC_VER) && !defined(__clang__)
    _ReadWriteBarrier();
#else
    asm volatile("" : : : "memory");
#endif
  }

 public:
  DefaultFloatState(const DefaultFloatState&) = delete;
  DefaultFloatState& operator=(const DefaultFloatState&) = delete;
};

}  // namespace boxtree
