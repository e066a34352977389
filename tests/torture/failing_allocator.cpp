// SPDX-License-Identifier: MIT
// Preloaded: the n-th allocation of a program fails, or all from the n-th on.
//   FAILING_ALLOCATION=N          the first is 1; 0 only counts
//   FAILING_ALLOCATION_FROM=1     and all that come after it
//   FAILING_ALLOCATION_REPORT=F   at exit, the number of allocations is written to F
// Counted from main() on, as what libraries do before it is not ours. glibc lets malloc be replaced
// and uses the replacement itself.
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
}

namespace {

using Main = int (*)(int, char**, char**);
using StartMain = int (*)(Main, int, char**, void (*)(), void (*)(), void (*)(), void*);

Main real_main = nullptr;
std::atomic<long> allocations{0};
std::atomic<bool> is_counting{false};
long failing = 0;
bool is_failing_on = false;

long number_from(const char* name) {
  const char* const text = std::getenv(name);
  return text == nullptr ? 0 : std::strtol(text, nullptr, 10);
}

bool fails() {
  if (!is_counting.load(std::memory_order_acquire)) return false;
  const long number = ++allocations;
  if (failing == 0 || (is_failing_on ? number < failing : number != failing)) return false;
  errno = ENOMEM;
  return true;
}

int counted_main(int count, char** arguments, char** environment) {
  failing = number_from("FAILING_ALLOCATION");
  is_failing_on = number_from("FAILING_ALLOCATION_FROM") != 0;
  is_counting.store(true, std::memory_order_release);
  return real_main(count, arguments, environment);
}

// By system calls: stdio would allocate, and may be closed already.
__attribute__((destructor)) void report() {
  const char* const path = std::getenv("FAILING_ALLOCATION_REPORT");
  if (path == nullptr) return;
  char text[24];
  char* at = text + sizeof(text);
  *--at = '\n';
  for (long left = allocations; left > 0; left /= 10) *--at = static_cast<char>('0' + left % 10);
  const int file = ::open(path, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (file < 0) return;
  const auto count = static_cast<std::size_t>(text + sizeof(text) - at);
  if (::write(file, at, count) != static_cast<ssize_t>(count)) ::unlink(path);
  ::close(file);
}

}  // namespace

extern "C" {

// What the startup code of every program calls with its main().
int __libc_start_main(Main program, int count, char** arguments, void (*before)(), void (*after)(),
                      void (*unload)(), void* stack_end) {
  real_main = program;
  const auto start = reinterpret_cast<StartMain>(::dlsym(RTLD_NEXT, "__libc_start_main"));
  return start(&counted_main, count, arguments, before, after, unload, stack_end);
}

void* malloc(std::size_t size) {
  return fails() ? nullptr : __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  return fails() ? nullptr : __libc_calloc(count, size);
}

void* realloc(void* old, std::size_t size) {
  return fails() ? nullptr : __libc_realloc(old, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  return fails() ? nullptr : __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return fails() ? nullptr : __libc_memalign(alignment, size);
}

int posix_memalign(void** out, std::size_t alignment, std::size_t size) {
  if (fails()) return ENOMEM;
  void* const memory = __libc_memalign(alignment, size);
  if (memory == nullptr) return ENOMEM;
  *out = memory;
  return 0;
}

}  // extern "C"
