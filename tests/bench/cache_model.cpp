// SPDX-License-Identifier: MIT
// Calls perf_event_open(2), which has no wrapper.
#include "tests/bench/cache_model.h"

#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#include <utility>

namespace boxtree::bench {

std::optional<CacheMissCounter> CacheMissCounter::open() {
  perf_event_attr attributes{};
  attributes.type = PERF_TYPE_HARDWARE;
  attributes.size = sizeof(attributes);
  attributes.config = PERF_COUNT_HW_CACHE_MISSES;
  attributes.disabled = 1;
  attributes.exclude_kernel = 1;
  attributes.exclude_hv = 1;
  const long descriptor = ::syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0);
  if (descriptor < 0) return std::nullopt;
  return CacheMissCounter(static_cast<int>(descriptor));
}

CacheMissCounter::CacheMissCounter(CacheMissCounter&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)) {}

CacheMissCounter::~CacheMissCounter() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void CacheMissCounter::start() const {
  ::ioctl(descriptor_, PERF_EVENT_IOC_RESET, 0);
  ::ioctl(descriptor_, PERF_EVENT_IOC_ENABLE, 0);
}

std::uint64_t CacheMissCounter::stop() const {
  ::ioctl(descriptor_, PERF_EVENT_IOC_DISABLE, 0);
  std::uint64_t count = 0;
  return ::read(descriptor_, &count, sizeof(count)) == sizeof(count) ? count : 0;
}

}  // namespace boxtree::bench
