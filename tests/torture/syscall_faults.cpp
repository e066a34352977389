// SPDX-License-Identifier: MIT
// Runs a program under ptrace and lets its n-th system call fail, be short, or be the last one.
//
// A seccomp filter stops the program at the calls of kCalls alone; unlike a preloaded library it
// also sees the calls that libc makes for itself. Calls count from the program's entry point on:
// loading is not ours. Needs Linux on x86-64; exit status 77 where tracing is not permitted, 125
// for an error of this program. How the traced program ended is in the report.
#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/fs.h>
#include <linux/seccomp.h>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/ptrace.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

namespace {

constexpr const char* kUsage =
    "usage: syscall_faults [OPTION]... -- COMMAND...\n"
    "  --report FILE     how it ended, and the calls counted, as JSON\n"
    "  --log FILE        what was done to files, one JSON object a line\n"
    "  --calls A,B       count these families only\n"
    "  --refuse A,B      always fail: tmpfile, exchange, empty-path\n"
    "  --nth N           the call at which something happens, 1 is the first; and one of\n"
    "  --error ERRNO     it fails\n"
    "  --late-error E    it is done, and fails all the same\n"
    "  --short           it reads or writes half of the bytes\n"
    "  --signal S        the signal S (a number) comes instead of it\n"
    "  --signal-after S  the signal S comes after it\n"
    "  --run COMMAND     a shell runs COMMAND before it\n"
    "  --from            all counted calls from the n-th on fail\n";
constexpr int kNotPermitted = 77;
constexpr int kOwnError = 125;

// AT_FDCWD as it stands in a register.
constexpr auto kHere = static_cast<std::uint64_t>(AT_FDCWD);

struct Call {
  long number;
  const char* name;
  const char* family;
};

// The calls that open, change or name files, and those that give memory and threads.
constexpr std::array kCalls{
    Call{SYS_open, "open", "open"},
    Call{SYS_openat, "openat", "open"},
    Call{SYS_creat, "creat", "open"},
    Call{SYS_read, "read", "read"},
    Call{SYS_pread64, "pread64", "read"},
    Call{SYS_readv, "readv", "read"},
    Call{SYS_write, "write", "write"},
    Call{SYS_pwrite64, "pwrite64", "write"},
    Call{SYS_writev, "writev", "write"},
    Call{SYS_sendfile, "sendfile", "write"},
    Call{SYS_copy_file_range, "copy_file_range", "write"},
    Call{SYS_ftruncate, "ftruncate", "size"},
    Call{SYS_truncate, "truncate", "size"},
    Call{SYS_fallocate, "fallocate", "size"},
    Call{SYS_fsync, "fsync", "flush"},
    Call{SYS_fdatasync, "fdatasync", "flush"},
    Call{SYS_syncfs, "syncfs", "flush"},
    Call{SYS_stat, "stat", "stat"},
    Call{SYS_lstat, "lstat", "stat"},
    Call{SYS_fstat, "fstat", "stat"},
    Call{SYS_newfstatat, "newfstatat", "stat"},
    Call{SYS_statx, "statx", "stat"},
    Call{SYS_access, "access", "stat"},
    Call{SYS_readlink, "readlink", "stat"},
    Call{SYS_readlinkat, "readlinkat", "stat"},
    Call{SYS_getdents64, "getdents64", "list"},
    Call{SYS_fchmod, "fchmod", "mode"},
    Call{SYS_chmod, "chmod", "mode"},
    Call{SYS_fchmodat, "fchmodat", "mode"},
    Call{SYS_fchown, "fchown", "mode"},
    Call{SYS_link, "link", "link"},
    Call{SYS_linkat, "linkat", "link"},
    Call{SYS_rename, "rename", "rename"},
    Call{SYS_renameat, "renameat", "rename"},
    Call{SYS_renameat2, "renameat2", "rename"},
    Call{SYS_unlink, "unlink", "unlink"},
    Call{SYS_unlinkat, "unlinkat", "unlink"},
    Call{SYS_close, "close", "close"},
    Call{SYS_flock, "flock", "lock"},
    Call{SYS_fcntl, "fcntl", "lock"},
    Call{SYS_getrandom, "getrandom", "random"},
    Call{SYS_mmap, "mmap", "memory"},
    Call{SYS_mremap, "mremap", "memory"},
    Call{SYS_munmap, "munmap", "memory"},
    Call{SYS_brk, "brk", "memory"},
    Call{SYS_clone, "clone", "thread"},
    Call{SYS_clone3, "clone3", "thread"},
};

struct NamedError {
  const char* name;
  int number;
};
constexpr std::array kErrors{
    NamedError{"ENOSPC", ENOSPC}, NamedError{"EIO", EIO},       NamedError{"EINTR", EINTR},
    NamedError{"ENOMEM", ENOMEM}, NamedError{"EACCES", EACCES}, NamedError{"EMFILE", EMFILE},
    NamedError{"EDQUOT", EDQUOT}, NamedError{"EROFS", EROFS},
};

enum class What { kNothing, kError, kLateError, kShort, kSignal, kSignalAfter, kRun };

struct Options {
  std::string report;
  std::string log;
  std::string calls;
  std::string refuse;
  long nth = 0;
  bool from = false;
  What what = What::kNothing;
  int number = 0;       // of the error or the signal
  std::string command;  // for kRun
};

[[noreturn]] void die(const std::string& what) {
  std::fprintf(stderr, "syscall_faults: %s: %s\n", what.c_str(), std::strerror(errno));
  std::exit(kOwnError);
}

bool lists(std::string_view list, std::string_view word) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    if (list.substr(0, comma) == word) return true;
    list.remove_prefix(std::min(comma + 1, list.size()));
  }
  return false;
}

const Call* find_call(long number) {
  for (const Call& call : kCalls) {
    if (call.number == number) return &call;
  }
  return nullptr;
}

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

std::string hex(std::string_view bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  out.reserve(2 * bytes.size());
  for (const char c : bytes) {
    const auto byte = static_cast<unsigned char>(c);
    out += kDigits[byte >> 4];
    out += kDigits[byte & 15u];
  }
  return out;
}

// Stops at every call of kCalls. Whether it counts is decided by the tracer.
void install_filter() {
  std::vector<sock_filter> program{
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, arch)),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, AUDIT_ARCH_X86_64, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, offsetof(seccomp_data, nr)),
  };
  for (const Call& call : kCalls) {
    const sock_filter jump =
        BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(call.number), 0, 1);
    program.push_back(jump);
    program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRACE));
  }
  program.push_back(BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW));
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  if (::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) != 0 ||
      ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &filter) != 0) {
    ::_exit(kNotPermitted);
  }
}

// The memory, descriptors and paths of a traced process, seen from here.
class Process {
 public:
  explicit Process(pid_t pid) : pid_(pid) {}

  [[nodiscard]] std::string bytes(std::uint64_t address, std::size_t count) const {
    std::string out(count, '\0');
    const iovec here{out.data(), count};
    const iovec there{reinterpret_cast<void*>(address), count};
    const ssize_t got = ::process_vm_readv(pid_, &here, 1, &there, 1, 0);
    out.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return out;
  }

  // A string that ends with a zero byte. Read page by page: what lies behind it may not be there.
  [[nodiscard]] std::string text(std::uint64_t address) const {
    constexpr std::uint64_t kPage = 4096;
    std::string out;
    for (;;) {
      const std::string part = bytes(address, kPage - address % kPage);
      if (part.empty()) return out;
      const std::size_t end = part.find('\0');
      out += part.substr(0, end);
      if (end != std::string::npos) return out;
      address += part.size();
    }
  }

  [[nodiscard]] std::string link_target(const std::string& entry) const {
    std::array<char, 4096> target{};
    const ssize_t got = ::readlink(proc(entry).c_str(), target.data(), target.size());
    return got < 0 ? std::string() : std::string(target.data(), static_cast<std::size_t>(got));
  }

  // Absolute, as far as the directories that it was looked up from tell.
  [[nodiscard]] std::string path(std::uint64_t directory, std::uint64_t name) const {
    const std::string relative = text(name);
    if (relative.starts_with('/')) return relative;
    const int descriptor = static_cast<int>(directory);
    const std::string base =
        link_target(descriptor == AT_FDCWD ? "cwd" : "fd/" + std::to_string(descriptor));
    return relative.empty() ? base : base + "/" + relative;
  }

  [[nodiscard]] std::optional<struct stat> status(std::uint64_t descriptor) const {
    struct stat found {};
    if (::stat(proc("fd/" + std::to_string(descriptor)).c_str(), &found) != 0) return std::nullopt;
    return found;
  }

  // Where read() and write() of a descriptor go on.
  [[nodiscard]] std::uint64_t position(std::uint64_t descriptor) const {
    std::ifstream info(proc("fdinfo/" + std::to_string(descriptor)));
    std::string key;
    std::uint64_t at = 0;
    info >> key >> at;
    return at;
  }

  // Behind the arguments and the environment, which a fresh stack begins with. Not from /proc,
  // which may be that of another process namespace.
  [[nodiscard]] std::uint64_t entry_point(std::uint64_t stack) const {
    const auto word = [this](std::uint64_t address) {
      std::uint64_t value = 0;
      const std::string found = bytes(address, sizeof(value));
      if (found.size() == sizeof(value)) std::memcpy(&value, found.data(), sizeof(value));
      return value;
    };
    constexpr std::uint64_t kWord = sizeof(std::uint64_t);
    constexpr std::uint64_t kEntry = 9;  // AT_ENTRY
    std::uint64_t at = stack + kWord * (word(stack) + 2);
    while (word(at) != 0) at += kWord;
    for (at += kWord; word(at) != 0; at += 2 * kWord) {
      if (word(at) == kEntry) return word(at + kWord);
    }
    return 0;
  }

 private:
  [[nodiscard]] std::string proc(const std::string& entry) const {
    return "/proc/" + std::to_string(pid_) + "/" + entry;
  }

  pid_t pid_;
};

std::string object_name(const struct stat& status) {
  return std::to_string(status.st_dev) + ":" + std::to_string(status.st_ino);
}

// Writes down what calls did to files, in the order in which they returned.
class FileLog {
 public:
  explicit FileLog(const std::string& path) {
    if (!path.empty()) out_.open(path, std::ios::binary);
  }

  [[nodiscard]] bool is_open() const { return out_.is_open(); }

  // Before the call: where it will write.
  [[nodiscard]] static std::uint64_t offset_of(pid_t pid, const user_regs_struct& regs) {
    if (regs.orig_rax == SYS_pwrite64) return regs.r10;
    return regs.orig_rax == SYS_write ? Process(pid).position(regs.rdi) : 0;
  }

  // After it: `entry` has its number and arguments, and it returned `result`.
  void add(pid_t pid, const user_regs_struct& entry, std::int64_t result, std::uint64_t offset) {
    if (result < 0) return;
    const Process process(pid);
    switch (entry.orig_rax) {
      case SYS_open:
        add_open(process, kHere, entry.rdi, entry.rsi, result);
        break;
      case SYS_openat:
        add_open(process, entry.rdi, entry.rsi, entry.rdx, result);
        break;
      case SYS_write:
      case SYS_pwrite64:
        add_object(process, "write", entry.rdi,
                   ",\"offset\":" + std::to_string(offset) + ",\"bytes\":\"" +
                       hex(process.bytes(entry.rsi, static_cast<std::size_t>(result))) + '"');
        break;
      case SYS_ftruncate:
        add_object(process, "truncate", entry.rdi, ",\"size\":" + std::to_string(entry.rsi));
        break;
      case SYS_fsync:
      case SYS_fdatasync:
        add_object(process, "flush", entry.rdi, {});
        break;
      case SYS_fchmod:
        add_object(process, "mode", entry.rdi, {});
        break;
      case SYS_link:
        add_link(process.path(kHere, entry.rsi));
        break;
      case SYS_linkat:
        add_link(process.path(entry.rdx, entry.r10));
        break;
      case SYS_rename:
        add_rename(process, {kHere, entry.rdi, kHere, entry.rsi}, 0);
        break;
      case SYS_renameat:
        add_rename(process, {entry.rdi, entry.rsi, entry.rdx, entry.r10}, 0);
        break;
      case SYS_renameat2:
        add_rename(process, {entry.rdi, entry.rsi, entry.rdx, entry.r10}, entry.r8);
        break;
      case SYS_unlink:
        add_unlink(process.path(kHere, entry.rdi));
        break;
      case SYS_unlinkat:
        add_unlink(process.path(entry.rdi, entry.rsi));
        break;
      case SYS_mmap:
        if ((entry.r10 & MAP_SHARED) != 0 && (entry.rdx & PROT_WRITE) != 0 &&
            static_cast<int>(entry.r8) >= 0) {
          add_unknown("a shared writable mapping");
        }
        break;
      // Nothing of ours makes these; who begins to has to teach the log what they do.
      case SYS_creat:
      case SYS_writev:
      case SYS_sendfile:
      case SYS_copy_file_range:
      case SYS_truncate:
      case SYS_fallocate:
      case SYS_chmod:
      case SYS_fchmodat:
        add_unknown(find_call(static_cast<long>(entry.orig_rax))->name);
        break;
      default:
        break;
    }
  }

 private:
  void add_open(const Process& process, std::uint64_t directory, std::uint64_t name,
                std::uint64_t flags, std::int64_t descriptor) {
    if ((flags & O_ACCMODE) == O_RDONLY) return;
    const bool is_anonymous = (flags & O_TMPFILE) == O_TMPFILE;
    add_object(process, "open", static_cast<std::uint64_t>(descriptor),
               ",\"path\":" + quoted(process.path(directory, name)) +
                   ",\"anonymous\":" + (is_anonymous ? "true" : "false") +
                   ",\"exclusive\":" + ((flags & O_EXCL) != 0 ? "true" : "false") +
                   ",\"truncate\":" + ((flags & O_TRUNC) != 0 ? "true" : "false"));
  }

  void add_object(const Process& process, const char* what, std::uint64_t descriptor,
                  const std::string& more) {
    const std::optional<struct stat> status = process.status(descriptor);
    if (!status) return;
    if (!S_ISREG(status->st_mode) && !S_ISDIR(status->st_mode)) return;
    out_ << "{\"do\":\"" << what << "\",\"object\":\"" << object_name(*status)
         << "\",\"mode\":" << (status->st_mode & 07777u);
    if (S_ISDIR(status->st_mode)) {
      out_ << ",\"directory\":" << quoted(process.link_target("fd/" + std::to_string(descriptor)));
    }
    out_ << more << "}\n";
  }

  void add_link(const std::string& path) {
    struct stat status {};
    if (::lstat(path.c_str(), &status) != 0) return add_unknown("a link that is not there");
    out_ << "{\"do\":\"link\",\"object\":\"" << object_name(status)
         << "\",\"path\":" << quoted(path) << "}\n";
  }

  void add_rename(const Process& process, const std::array<std::uint64_t, 4>& names,
                  std::uint64_t flags) {
    out_ << "{\"do\":\"" << ((flags & RENAME_EXCHANGE) != 0 ? "exchange" : "rename")
         << "\",\"from\":" << quoted(process.path(names[0], names[1]))
         << ",\"to\":" << quoted(process.path(names[2], names[3])) << "}\n";
  }

  void add_unlink(const std::string& path) {
    out_ << "{\"do\":\"unlink\",\"path\":" << quoted(path) << "}\n";
  }

  void add_unknown(const char* what) {
    out_ << "{\"do\":\"unknown\",\"what\":\"" << what << "\"}\n";
  }

  std::ofstream out_;
};

class Tracer {
 public:
  explicit Tracer(Options options) : options_(std::move(options)), log_(options_.log) {}

  // Follows the process to its end and writes the report.
  void follow(pid_t child) {
    first_ = child;
    int status = 0;
    // It stops itself before it execs, so that options are set in time.
    if (::waitpid(child, &status, 0) != child) die("waitpid");
    if (WIFEXITED(status)) std::exit(WEXITSTATUS(status));
    constexpr long kTraced = PTRACE_O_TRACESECCOMP | PTRACE_O_TRACECLONE | PTRACE_O_TRACEFORK |
                             PTRACE_O_TRACEVFORK | PTRACE_O_TRACEEXEC | PTRACE_O_EXITKILL |
                             PTRACE_O_TRACESYSGOOD;
    if (::ptrace(PTRACE_SETOPTIONS, child, nullptr, kTraced) != 0) die("ptrace");
    resume(child, 0);
    for (;;) {
      const pid_t pid = ::waitpid(-1, &status, __WALL);
      if (pid < 0 && errno == EINTR) continue;
      if (pid < 0) die("waitpid");
      if (WIFEXITED(status) || WIFSIGNALED(status)) {
        if (pid == first_) return write_report(status);
        continue;
      }
      on_stop(pid, status);
    }
  }

 private:
  // A call between its entry and its return, where somebody waits for the return.
  struct Pending {
    user_regs_struct entry;
    std::uint64_t offset;
    bool is_faulted;
  };

  static void resume(pid_t pid, int signal) {
    ::ptrace(PTRACE_CONT, pid, nullptr, static_cast<long>(signal));
  }

  void on_stop(pid_t pid, int status) {
    const int signal = WSTOPSIG(status);
    const int event = status >> 16;
    if (event == PTRACE_EVENT_SECCOMP) return on_entry(pid);
    if (event == PTRACE_EVENT_EXEC && pid == first_ && entry_point_ == 0) plant_breakpoint(pid);
    if (event != 0) return resume(pid, 0);
    if (signal == (SIGTRAP | 0x80)) return on_return(pid);
    if (signal == SIGTRAP && is_at_entry_point(pid)) return resume(pid, 0);
    // A new thread or process begins with a stop of its own.
    const bool is_new = signal == SIGSTOP && seen_.insert({pid, true}).second;
    resume(pid, is_new ? 0 : signal);
  }

  void plant_breakpoint(pid_t pid) {
    user_regs_struct regs{};
    ::ptrace(PTRACE_GETREGS, pid, nullptr, &regs);
    entry_point_ = Process(pid).entry_point(regs.rsp);
    errno = 0;
    entry_code_ = ::ptrace(PTRACE_PEEKTEXT, pid, entry_point_, nullptr);
    constexpr long kMask = 0xff;
    constexpr long kBreakpoint = 0xcc;
    if (errno != 0 ||
        ::ptrace(PTRACE_POKETEXT, pid, entry_point_, (entry_code_ & ~kMask) | kBreakpoint) != 0) {
      die("cannot stop at the entry point");
    }
  }

  bool is_at_entry_point(pid_t pid) {
    user_regs_struct regs{};
    ::ptrace(PTRACE_GETREGS, pid, nullptr, &regs);
    if (is_counting_ || regs.rip != entry_point_ + 1) return false;
    ::ptrace(PTRACE_POKETEXT, pid, entry_point_, entry_code_);
    regs.rip = entry_point_;
    ::ptrace(PTRACE_SETREGS, pid, nullptr, &regs);
    is_counting_ = true;
    return true;
  }

  // Options that a file system may not have. Returns the error with which it says so.
  [[nodiscard]] int refusal(const user_regs_struct& regs) const {
    const auto has = [](std::uint64_t flags, std::uint64_t flag) { return (flags & flag) == flag; };
    if (lists(options_.refuse, "tmpfile") && regs.orig_rax == SYS_openat &&
        has(regs.rdx, O_TMPFILE)) {
      return EOPNOTSUPP;
    }
    if (lists(options_.refuse, "exchange") && regs.orig_rax == SYS_renameat2 &&
        has(regs.r8, RENAME_EXCHANGE)) {
      return EINVAL;
    }
    if (lists(options_.refuse, "empty-path") && regs.orig_rax == SYS_linkat &&
        has(regs.r8, AT_EMPTY_PATH)) {
      return ENOENT;
    }
    return 0;
  }

  // Standard error stays as it is: a message is what a fault is answered with.
  [[nodiscard]] bool counts(const user_regs_struct& regs, const Call& call) const {
    if (!is_counting_) return false;
    if (std::string_view(call.family) == "write" && regs.rdi == STDERR_FILENO) return false;
    return options_.calls.empty() || lists(options_.calls, call.family);
  }

  static void skip(pid_t pid, user_regs_struct regs, int error) {
    regs.orig_rax = ~std::uint64_t{0};
    regs.rax = static_cast<std::uint64_t>(-static_cast<std::int64_t>(error));
    ::ptrace(PTRACE_SETREGS, pid, nullptr, &regs);
  }

  // Calls with another argument. When it returns the register is what it was: callers rely on that.
  void replace_argument(pid_t pid, const user_regs_struct& entry,
                        unsigned long long user_regs_struct::*argument, std::uint64_t value) {
    user_regs_struct regs = entry;
    regs.*argument = value;
    ::ptrace(PTRACE_SETREGS, pid, nullptr, &regs);
    wait_for_return(pid, entry, true);
  }

  void on_entry(pid_t pid) {
    user_regs_struct regs{};
    ::ptrace(PTRACE_GETREGS, pid, nullptr, &regs);
    const Call* call = find_call(static_cast<long>(regs.orig_rax));
    if (call == nullptr) return resume(pid, 0);
    const bool is_counted = counts(regs, *call);
    if (is_counted) counted_.push_back(call);
    const auto count = static_cast<long>(counted_.size());
    const bool is_faulted = is_counted && options_.nth > 0 &&
                            (count == options_.nth || (options_.from && count > options_.nth));
    if (is_faulted) {
      ++faults_;
      if (faulted_ == nullptr) faulted_ = call;
      unlink_faulted_ = unlink_faulted_ || std::string_view(call->family) == "unlink";
      if (options_.what == What::kRun) run_status_ = std::system(options_.command.c_str());
      if (options_.what == What::kError) {
        // Linux closes a descriptor whatever close() returns.
        if (regs.orig_rax == SYS_close) return wait_for_return(pid, regs, true);
        // brk() fails by returning the break as it is.
        if (regs.orig_rax == SYS_brk) return replace_argument(pid, regs, &user_regs_struct::rdi, 0);
        skip(pid, regs, options_.number);
        return resume(pid, 0);
      }
      if (options_.what == What::kSignal) {
        skip(pid, regs, EINTR);
        ::kill(first_, options_.number);
        return resume(pid, 0);
      }
      if (options_.what == What::kShort && has_half(regs, *call)) {
        return replace_argument(pid, regs, &user_regs_struct::rdx, regs.rdx / 2);
      }
      if (options_.what == What::kLateError || options_.what == What::kSignalAfter) {
        return wait_for_return(pid, regs, true);
      }
    } else if (const int error = refusal(regs); error != 0) {
      skip(pid, regs, error);
      return resume(pid, 0);
    }
    if (log_.is_open()) return wait_for_return(pid, regs, false);
    resume(pid, 0);
  }

  // Whether it can be made to take half as many bytes.
  static bool has_half(const user_regs_struct& regs, const Call& call) {
    const std::string_view family = call.family;
    if ((family != "read" && family != "write") || regs.rdx < 2) return false;
    return regs.orig_rax != SYS_readv && regs.orig_rax != SYS_writev;
  }

  void wait_for_return(pid_t pid, const user_regs_struct& entry, bool is_faulted) {
    const std::uint64_t offset = log_.is_open() ? FileLog::offset_of(pid, entry) : 0;
    pending_[pid] = {entry, offset, is_faulted};
    ::ptrace(PTRACE_SYSCALL, pid, nullptr, 0L);
  }

  void on_return(pid_t pid) {
    const auto found = pending_.find(pid);
    if (found == pending_.end()) return resume(pid, 0);
    const Pending call = found->second;
    pending_.erase(found);
    user_regs_struct regs{};
    ::ptrace(PTRACE_GETREGS, pid, nullptr, &regs);
    if (log_.is_open()) {
      log_.add(pid, call.entry, static_cast<std::int64_t>(regs.rax), call.offset);
    }
    if (call.is_faulted && options_.what == What::kSignalAfter) ::kill(first_, options_.number);
    if (call.is_faulted && options_.what != What::kSignalAfter) {
      regs.rdi = call.entry.rdi;
      regs.rdx = call.entry.rdx;
      if (options_.what != What::kShort && call.entry.orig_rax != SYS_brk) {
        regs.rax = static_cast<std::uint64_t>(-static_cast<std::int64_t>(options_.number));
      }
      ::ptrace(PTRACE_SETREGS, pid, nullptr, &regs);
    }
    resume(pid, 0);
  }

  void write_report(int status) const {
    std::ofstream out(options_.report);
    out << "{\"exit\":" << (WIFEXITED(status) ? std::to_string(WEXITSTATUS(status)) : "null")
        << ",\"signal\":" << (WIFSIGNALED(status) ? std::to_string(WTERMSIG(status)) : "null")
        << ",\"faults\":" << faults_ << ",\"faulted\":";
    out << (faulted_ != nullptr ? quoted(faulted_->name) : "null")
        << ",\"unlink_faulted\":" << (unlink_faulted_ ? "true" : "false");
    if (run_status_) out << ",\"run_status\":" << WEXITSTATUS(*run_status_);
    out << ",\"calls\":[";
    for (std::size_t i = 0; i < counted_.size(); ++i) {
      out << (i > 0 ? "," : "") << "[\"" << counted_[i]->name << "\",\"" << counted_[i]->family
          << "\"]";
    }
    out << "]}\n";
    if (!out.flush()) die(options_.report);
  }

  Options options_;
  FileLog log_;
  pid_t first_ = 0;
  std::uint64_t entry_point_ = 0;
  long entry_code_ = 0;
  bool is_counting_ = false;
  std::vector<const Call*> counted_;
  long faults_ = 0;
  const Call* faulted_ = nullptr;  // the first
  bool unlink_faulted_ = false;
  std::optional<int> run_status_;
  std::map<pid_t, Pending> pending_;
  std::map<pid_t, bool> seen_;
};

[[noreturn]] void usage() {
  std::fputs(kUsage, stderr);
  std::exit(kOwnError);
}

int error_number(std::string_view name) {
  for (const NamedError& error : kErrors) {
    if (name == error.name) return error.number;
  }
  usage();
}

// Returns the options and leaves `argv` at the command.
Options parse(char**& argv) {
  Options options;
  for (++argv; *argv != nullptr && std::string_view(*argv) != "--"; ++argv) {
    const std::string_view name = *argv;
    const auto value = [&argv] {
      if (*++argv == nullptr) usage();
      return std::string(*argv);
    };
    const auto set = [&options](What what, int number) {
      options.what = what;
      options.number = number;
    };
    if (name == "--report")
      options.report = value();
    else if (name == "--log")
      options.log = value();
    else if (name == "--calls")
      options.calls = value();
    else if (name == "--refuse")
      options.refuse = value();
    else if (name == "--nth")
      options.nth = std::stol(value());
    else if (name == "--from")
      options.from = true;
    else if (name == "--error")
      set(What::kError, error_number(value()));
    else if (name == "--late-error")
      set(What::kLateError, error_number(value()));
    else if (name == "--short")
      set(What::kShort, 0);
    else if (name == "--signal")
      set(What::kSignal, std::stoi(value()));
    else if (name == "--signal-after")
      set(What::kSignalAfter, std::stoi(value()));
    else if (name == "--run") {
      set(What::kRun, 0);
      options.command = value();
    } else
      usage();
  }
  if (*argv == nullptr || *++argv == nullptr) usage();
  return options;
}

}  // namespace

int main(int, char** argv) {
  Options options = parse(argv);
  const pid_t child = ::fork();
  if (child < 0) die("fork");
  if (child == 0) {
    if (::ptrace(PTRACE_TRACEME, 0, nullptr, nullptr) != 0) ::_exit(kNotPermitted);
    ::raise(SIGSTOP);
    install_filter();
    ::execvp(argv[0], argv);
    ::_exit(kOwnError);
  }
  Tracer(std::move(options)).follow(child);
}
