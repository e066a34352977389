// SPDX-License-Identifier: MIT
// Compares processor time with elapsed time, and equal pieces of work with each other.
#include "cooker/choose/timed_work.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

// Measured on two processors by `report --quick` of samples/meshes/level.obj, as processor_share of
// --json: 0.996 to 0.998 before all other programs (chrt --fifo 50), 0.31 to 0.40 beside two
// builds. One rival for the processor leaves 0.5.
constexpr double kLeastShare = 0.9;

// Stores of wide8 differ by about as much in their times (docs/MEASUREMENTS.md): a processor whose
// speed varies by more says nothing of which is faster. Measured by `report --quick` on a virtual
// machine: 1.17 to 1.49, alone on it as well as beside other programs; five reports of one mesh
// named two encodings as the fastest.
constexpr double kMostSpeedRatio = 1.15;

// Work that waits for its own results and for a small table, as a walk down a tree does.
double time_of_piece() {
  using Clock = std::chrono::steady_clock;
  constexpr std::uint32_t kPieceSteps = 100000;  // half a millisecond
  static const std::array<std::uint32_t, 1u << 14> table = [] {
    std::array<std::uint32_t, 1u << 14> numbers{};
    for (std::uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i * 2654435761u;
    return numbers;
  }();
  const Clock::time_point start = Clock::now();
  std::uint32_t at = 1;
  double sum = 0;
  for (std::uint32_t i = 0; i < kPieceSteps; ++i) {
    at = table[(at * 2654435761u + i) % table.size()];
    sum = sum * 0.5 + at;
  }
  [[maybe_unused]] const volatile double kept = sum;  // so that it is computed
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

void TimedWork::add_piece() {
  // The least of several: what an interrupt takes does not count.
  constexpr int kTimes = 5;
  double seconds = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTimes; ++i) seconds = std::min(seconds, time_of_piece());
  fastest_piece_ = fastest_piece_ == 0 ? seconds : std::min(fastest_piece_, seconds);
  slowest_piece_ = std::max(slowest_piece_, seconds);
}

double TimedWork::processor_share() const noexcept {
  return elapsed_seconds_ > 0 ? std::min(1.0, processor_seconds_ / elapsed_seconds_) : 1;
}

double TimedWork::speed_ratio() const noexcept {
  return fastest_piece_ > 0 ? slowest_piece_ / fastest_piece_ : 1;
}

bool TimedWork::lacks_processor() const noexcept {
  return processor_share() < kLeastShare;
}

bool TimedWork::is_disturbed() const noexcept {
  return lacks_processor() || speed_ratio() > kMostSpeedRatio;
}

std::string TimedWork::disturbance() const {
  if (!is_disturbed()) return {};
  return lacks_processor()
             ? fmt::format(
                   "other programs had the processor for {:.0f} % of the time in which queries "
                   "were timed",
                   100 * (1 - processor_share()))
             : fmt::format(
                   "the processor took up to {:.0f} % longer for the same work at some times "
                   "than at others while queries were timed",
                   100 * (speed_ratio() - 1));
}

std::string TimedWork::warning(const std::string& what_follows) const {
  if (!is_disturbed()) return {};
  return fmt::format("{}, so {}: measure again when the machine, and its host, do nothing else",
                     disturbance(), what_follows);
}

}  // namespace boxtree::cooker
