// SPDX-License-Identifier: MIT
#include "cooker/import/trial.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <optional>
#include <poll.h>
#include <span>
#include <string>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <utility>
#include <vector>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include <fmt/format.h>

#include "cooker/import/exception_error.h"
#include "cooker/system/file_handle.h"
#include "cooker/system/posix.h"
#include "cooker/system/write_all.h"
#include "format/bytes.h"

namespace boxtree::cooker {
namespace {

constexpr std::uint64_t kMostDetail = 1u << 16;  // of a message

// What the copy says first; of an error its detail comes behind.
struct Outcome {
  std::uint32_t code;
  std::uint32_t reserved;
  std::uint64_t value;
};
static_assert(static_cast<int>(Errc::kOk) == 0);

std::uint64_t page_bytes() {
  return static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

// Where limits of memory are enforced (kLimitsMemory).
std::uint64_t address_space() {
#ifdef __linux__
  std::array<char, 64> line{};  // numbers of pages, and other figures
  const FileHandle file(std::fopen("/proc/self/statm", "r"));
  const bool is_read = file && std::fgets(line.data(), line.size(), file.get()) != nullptr;
  return is_read ? std::strtoull(line.data(), nullptr, 10) * page_bytes() : 0;
#else
  return 0;
#endif
}

// An enumeration in the GNU C library, else an int.
using Resource = decltype(RLIMIT_CPU);

// Where it can be extended.
void limit(Resource resource, std::uint64_t most) {
  rlimit now{};
  if (getrlimit(resource, &now) != 0) return;
  now.rlim_cur = std::min<rlim_t>(now.rlim_max, most);
  static_cast<void>(setrlimit(resource, &now));
}

// Of the copy, when it began.
std::uint64_t bytes_at_start = 0;

// What is allocated holds bytes that are neither zero nor a small number, of integers as of floats,
// and so does what lies behind it: blocks come from a megabyte of such bytes, not from gaps that
// work before has left.
void disturb_memory() {
#ifdef __GLIBC__
  constexpr int kBytes = 0x69;
  constexpr int kRegion = 1 << 20;
  // Of blocks that are freed the library keeps 7 of each size up to this, and others.
  constexpr std::size_t kMostSmall = 1040;
  constexpr int kKept = 16;
  static std::vector<void*> kept;
  static_cast<void>(mallopt(M_MMAP_THRESHOLD, 2 * kRegion));
  static_cast<void>(mallopt(M_TRIM_THRESHOLD, 2 * kRegion));
  static_cast<void>(mallopt(M_PERTURB, kBytes));
  for (std::size_t bytes = 16; bytes <= kMostSmall; bytes += 16) {
    for (int i = 0; i < kKept; ++i) kept.push_back(std::malloc(bytes));
  }
  void* volatile region = std::malloc(kRegion);
  std::free(region);  // joins the free end of the heap, filled
#endif
}

// The code of the copy. It ends without the cleanup of exit(), which is the parent's.
[[noreturn]] void be_child(int to_parent, const TrialLimits& limits,
                           const std::function<Result<std::uint64_t>()>& work) {
#ifdef __linux__  // elsewhere it goes on until it has read the file, or reaches its limits
  static_cast<void>(prctl(PR_SET_PDEATHSIG, SIGKILL));
#endif
  limit(RLIMIT_CORE, 0);
  // Of the limit of processor time: who started this process may have told it to ignore that.
  static_cast<void>(std::signal(SIGXCPU, SIG_DFL));
  bytes_at_start = address_space();
  extend_trial(limits);
  disturb_memory();
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere >= 0) {
    static_cast<void>(dup2(nowhere, STDOUT_FILENO));
    static_cast<void>(dup2(nowhere, STDERR_FILENO));
  }
  Result<std::uint64_t> result = Error{Errc::kInternal, ""};
  try {
    result = work();
  } catch (...) {
    result = error_of_exception();
  }
  const Outcome outcome{result.ok() ? 0u : static_cast<std::uint32_t>(result.error().code), 0,
                        result.ok() ? *result : 0};
  const std::string detail = result.ok() ? "" : result.error().detail.substr(0, kMostDetail);
  const bool is_told = write_all(to_parent, std::as_bytes(std::span(&outcome, 1))) &&
                       write_all(to_parent, std::as_bytes(std::span(detail)));
  _exit(is_told ? 0 : 1);
}

// What the copy says until it ends; nothing if that takes more seconds. Counts the seconds in which
// this process waits, so that it may itself be stopped (Ctrl-Z) for as long as one likes.
std::optional<std::string> read_all(int from, std::uint64_t seconds) {
  std::string text;
  std::array<char, 4096> chunk;
  while (seconds > 0) {
    pollfd end{from, POLLIN, 0};
    const int ready = ::poll(&end, 1, 1000);
    if (ready == 0) --seconds;
    if (ready <= 0) continue;
    const ssize_t got = ::read(from, chunk.data(), chunk.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return text;
    text.append(chunk.data(), static_cast<std::size_t>(got));
  }
  return std::nullopt;
}

Error no_child(const char* what, int error) {
  const char* const remedy =
      error == EAGAIN ? " (a limit of processes, as ulimit -u; --trusted needs none)" : "";
  return {error == ENOMEM ? Errc::kOutOfMemory : Errc::kImportFailed,
          fmt::format("no process to try it in: {}: {}{}", what,
                      std::generic_category().message(error), remedy)};
}

Error ended(const std::string& how, const TrialLimits& limits) {
  return {Errc::kImportFailed,
          fmt::format("assimp's reader was ended, {}: it may take {} s of processor time, {} s by "
                      "the clock and {} MB",
                      how, limits.cpu_seconds, limits.clock_seconds, limits.bytes >> 20)};
}

Error crashed(int signal, const TrialLimits& limits) {
  if (signal == SIGXCPU || signal == SIGKILL) {
    return ended(fmt::format("by signal {}", signal), limits);
  }
  return {Errc::kImportFailed, fmt::format("assimp's reader crashed on it, by signal {}", signal)};
}

}  // namespace

TrialLimits trial_limits(std::uint64_t file_bytes) {
  const long pages = sysconf(_SC_PHYS_PAGES);
  const std::uint64_t memory =
      pages > 0 ? static_cast<std::uint64_t>(pages) * page_bytes() : std::uint64_t{1} << 33;
  const std::uint64_t seconds = 10 + file_bytes / 100000;
  constexpr std::uint64_t kLeast = std::uint64_t{1} << 30;
  constexpr std::uint64_t kOfByte = 1024;
  const bool is_huge = file_bytes >= memory / kOfByte;
  return {seconds, 10 * seconds + 200,
          is_huge ? memory / 2 : std::min(memory / 2, kLeast + kOfByte * file_bytes)};
}

void extend_trial(const TrialLimits& limits) {
  limit(RLIMIT_CPU, limits.cpu_seconds);
  if (kLimitsMemory) limit(RLIMIT_AS, bytes_at_start + limits.bytes);
}

Result<std::uint64_t> try_in_child(const TrialLimits& limits,
                                   const std::function<Result<std::uint64_t>()>& work) {
  std::array<int, 2> ends;
  if (!open_pipe(ends)) return no_child("pipe", errno);
  const pid_t child = ::fork();
  if (child < 0) {
    const int error = errno;
    ::close(ends[0]);
    ::close(ends[1]);
    return no_child("fork", error);
  }
  if (child == 0) {
    ::close(ends[0]);
    be_child(ends[1], limits, work);
  }
  ::close(ends[1]);
  const std::optional<std::string> said = read_all(ends[0], limits.clock_seconds);
  ::close(ends[0]);
  // Of no effect on a copy that has ended; one that is stopped, or closed its end, would not end.
  static_cast<void>(::kill(child, SIGKILL));
  int how = 0;
  while (::waitpid(child, &how, 0) < 0) {
    if (errno != EINTR) return no_child("waitpid", errno);
  }
  if (!said) return ended("since it did not end by itself", limits);
  if (WIFSIGNALED(how)) return crashed(WTERMSIG(how), limits);
  if (WEXITSTATUS(how) != 0 || said->size() < sizeof(Outcome)) {
    return Error{
        Errc::kImportFailed,
        fmt::format("assimp's reader ended the process, with status {}", WEXITSTATUS(how))};
  }
  const auto outcome = load<Outcome>(reinterpret_cast<const std::byte*>(said->data()));
  if (outcome.code == 0) return outcome.value;
  return Error{static_cast<Errc>(outcome.code), said->substr(sizeof(outcome))};
}

}  // namespace boxtree::cooker
