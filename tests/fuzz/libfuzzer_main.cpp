// SPDX-License-Identifier: MIT
// A target as libFuzzer wants it, and the time that one input may take.
#include <algorithm>
#include <cstdint>
#include <ctime>

#include "tests/fuzz/target.h"

namespace boxtree::fuzz {
namespace {

// Of the processor's, so that a busy machine changes nothing.
double cpu_seconds() {
  std::timespec now{};
  static_cast<void>(clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now));
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double timed(Bytes input) {
  const double begin = cpu_seconds();
  run(input);
  return cpu_seconds() - begin;
}

#if __has_feature(address_sanitizer) || __has_feature(memory_sanitizer)  // always clang here
constexpr double kSlowdown = 4;  // they cost 6 to 30 times on the corpus: no laxer than without
#else
constexpr double kSlowdown = 1;
#endif

constexpr double kMostSeconds = 0.1 * kSlowdown;

}  // namespace
}  // namespace boxtree::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace boxtree;
  const Bytes input = std::as_bytes(std::span(data, size));
  double seconds = fuzz::timed(input);
  // The first run may have paid for pages and caches.
  for (int i = 0; i < 2 && seconds > fuzz::kMostSeconds; ++i) {
    seconds = std::min(seconds, fuzz::timed(input));
  }
  if (seconds > fuzz::kMostSeconds) fuzz::finding("one input takes more than 100 ms");
  return 0;
}
