// SPDX-License-Identifier: MIT
// Sets a state of the floating-point unit, as an application may, for the lifetime of an object.
#pragma once

#include <cfenv>

#if defined(__SSE__)
#include <xmmintrin.h>
#endif

namespace boxtree::test {

/// Subnormal results and operands count as zero (FTZ and DAZ).
class FlushToZero {
 public:
#if defined(__SSE__)
  FlushToZero() : before_(_mm_getcsr()) {
    _mm_setcsr(before_ | kFlushToZero | kDenormalsAreZero);
  }
  ~FlushToZero() {
    _mm_setcsr(before_);
  }
  [[nodiscard]] static constexpr bool is_supported() {
    return true;
  }

 private:
  static constexpr unsigned kFlushToZero = 1u << 15, kDenormalsAreZero = 1u << 6;
  unsigned before_;
#elif defined(__aarch64__)
  FlushToZero() {
    asm volatile("mrs %0, fpcr" : "=r"(before_));
    asm volatile("msr fpcr, %0" : : "r"(before_ | kFlush));
  }
  ~FlushToZero() {
    asm volatile("msr fpcr, %0" : : "r"(before_));
  }
  [[nodiscard]] static constexpr bool is_supported() {
    return true;
  }

 private:
  static constexpr unsigned long kFlush = 1ul << 24;
  unsigned long before_;
#else
  [[nodiscard]] static constexpr bool is_supported() {
    return false;
  }
#endif

 public:
  FlushToZero(const FlushToZero&) = delete;
  FlushToZero& operator=(const FlushToZero&) = delete;
};

template <int Mode>
class RoundingMode {
 public:
  RoundingMode() : before_(std::fegetround()) { std::fesetround(Mode); }
  ~RoundingMode() { std::fesetround(before_); }
  RoundingMode(const RoundingMode&) = delete;
  RoundingMode& operator=(const RoundingMode&) = delete;

 private:
  int before_;
};

}  // namespace boxtree::test
