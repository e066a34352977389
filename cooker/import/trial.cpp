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
#ifdef __linux__
#include <sys/prctl.h>
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

void limit(Resource resource, std::uint64_t most) {
  rlimit now{};
  if (getrlimit(resource, &now) != 0) return;
  now.rlim_cur = now.rlim_max = std::min<rlim_t>(now.rlim_max, most);
  static_cast<void>(setrlimit(resource, &now));
}

// The code of the copy. It ends without the cleanup of exit(), which is the parent's.
[[noreturn]] void be_child(int to_parent, const TrialLimits& limits,
                           const std::function<Status()>& work) {
#ifdef __linux__  // elsewhere it goes on until it has read the file, or reaches its limits
  static_cast<void>(prctl(PR_SET_PDEATHSIG, SIGKILL));
#endif
  limit(RLIMIT_CORE, 0);
  limit(RLIMIT_CPU, limits.cpu_seconds);
  if (kLimitsMemory) limit(RLIMIT_AS, address_space() + limits.bytes);
  const int nowhere = ::open("/dev/null", O_WRONLY);
  if (nowhere >= 0) {
    static_cast<void>(dup2(nowhere, STDOUT_FILENO));
    static_cast<void>(dup2(nowhere, STDERR_FILENO));
  }
  Status status;
  try {
    status = work();
  } catch (...) {
    status = error_of_exception();
  }
  const auto code = static_cast<std::uint16_t>(status.ok() ? Errc::kOk : status.error().code);
  const std::string detail = status.ok() ? "" : status.error().detail.substr(0, kMostDetail);
  const bool is_told = write_all(to_parent, std::as_bytes(std::span(&code, 1))) &&
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
  const std::uint64_t seconds = 30 + file_bytes / 100000;
  return {seconds, 10 * seconds, memory / 2};
}

Status try_in_child(const TrialLimits& limits, const std::function<Status()>& work) {
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
  if (WEXITSTATUS(how) != 0 || said->size() < sizeof(std::uint16_t)) {
    return Error{
        Errc::kImportFailed,
        fmt::format("assimp's reader ended the process, with status {}", WEXITSTATUS(how))};
  }
  const auto code = load<std::uint16_t>(reinterpret_cast<const std::byte*>(said->data()));
  if (code == 0) return {};
  return Error{static_cast<Errc>(code), said->substr(sizeof(code))};
}

}  // namespace boxtree::cooker
