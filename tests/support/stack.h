// SPDX-License-Identifier: MIT
// What a call takes of the stack, by painting one and looking how far down it was used.
#pragma once

#include <cstddef>
#include <cstring>
#include <functional>
#include <pthread.h>
#include <sys/mman.h>

namespace boxtree::test {

/// The bytes of a stack that `work` uses.
[[nodiscard]] inline std::size_t bytes_used(const std::function<void()>& work) {
  constexpr std::size_t kStackBytes = std::size_t{4} << 20;
  constexpr unsigned char kPaint = 0xa5;
  void* const memory = ::mmap(nullptr, kStackBytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK, -1, 0);
  if (memory == MAP_FAILED) return kStackBytes;
  std::memset(memory, kPaint, kStackBytes);
  pthread_attr_t attributes;
  pthread_attr_init(&attributes);
  pthread_attr_setstack(&attributes, memory, kStackBytes);
  pthread_t thread;
  const auto run = [](void* argument) -> void* {
    (*static_cast<const std::function<void()>*>(argument))();
    return nullptr;
  };
  const int failed =
      pthread_create(&thread, &attributes, run, const_cast<void*>(static_cast<const void*>(&work)));
  pthread_attr_destroy(&attributes);
  if (failed == 0) pthread_join(thread, nullptr);
  const auto* const bytes = static_cast<const unsigned char*>(memory);
  std::size_t untouched = 0;
  while (untouched < kStackBytes && bytes[untouched] == kPaint) ++untouched;
  ::munmap(memory, kStackBytes);
  return failed == 0 ? kStackBytes - untouched : kStackBytes;
}

/// Whether frames are larger than those of a release.
[[nodiscard]] inline bool is_instrumented() {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(NDEBUG)
  return true;
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
  return true;
#endif
#endif
  return false;
}

}  // namespace boxtree::test
