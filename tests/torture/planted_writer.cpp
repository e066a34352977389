// SPDX-License-Identifier: MIT
// Copies a file with a defect of choice: what the torture has to notice.
//   planted_writer DEFECT INPUT OUTPUT
//     in-place      writes over the output
//     fixed-name    its temporary file has the same name in every process
//     litter        leaves its temporary file after an error
//     mute          says nothing of an error
//     deaf          exits with 0 after an error
//     short         takes a short write for a whole one
//     no-flush      renames what is not flushed
//     no-folder     does not flush the folder
//     no-sweep      leaves what killed writers left
//     abort         aborts where memory runs out
//     mode          does not keep the mode of the old file
//     none          has none of these
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dirent.h>
#include <fcntl.h>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

namespace {

constexpr int kInputOutput = 2;
constexpr int kInternal = 4;

std::string_view defect;

bool has(std::string_view name) {
  return defect == name;
}

int fail(const char* what) {
  if (has("deaf")) return 0;
  if (!has("mute")) {
    std::array<char, 256> message{};
    const int count = std::snprintf(message.data(), message.size(), "planted_writer: %s: %s\n",
                                    what, std::strerror(errno));
    if (::write(STDERR_FILENO, message.data(), static_cast<std::size_t>(count)) < 0) return 5;
  }
  return kInputOutput;
}

// Removes the temporary file when it goes, unless that is the defect.
struct Temporary {
  std::string name;
  ~Temporary() {
    if (!name.empty() && !has("litter")) ::unlink(name.c_str());
  }
};

// Of a copy of a few bytes at a time, so that there are several writes to cut.
bool copy(int from, int to) {
  std::array<char, 64> buffer{};
  for (;;) {
    const ssize_t got = ::read(from, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return got == 0;
    for (ssize_t done = 0; done < got;) {
      const ssize_t wrote = ::write(to, buffer.data() + done, static_cast<std::size_t>(got - done));
      if (wrote < 0 && errno == EINTR) continue;
      if (wrote < 0) return false;
      done += has("short") ? got : wrote;
    }
  }
}

void sweep(const std::string& output) {
  const std::unique_ptr<DIR, int (*)(DIR*)> folder(::opendir("."), ::closedir);
  if (!folder) return;
  const std::string prefix = "." + output + ".";
  while (const dirent* entry = ::readdir(folder.get())) {
    const std::string name = entry->d_name;
    if (!name.starts_with(prefix) || !name.ends_with(".cooking")) continue;
    const int file = ::open(name.c_str(), O_RDONLY | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(name.c_str());
    ::close(file);
  }
}

std::string temporary_name(const std::string& output) {
  if (has("fixed-name")) return "." + output + ".0000000000000000.cooking";
  std::uint64_t random = 0;
  if (::getrandom(&random, sizeof(random), 0) != sizeof(random)) return {};
  std::array<char, 20> digits{};
  std::snprintf(digits.data(), digits.size(), "%016lx", static_cast<unsigned long>(random));
  return "." + output + "." + digits.data() + ".cooking";
}

// A temporary file that is locked and still there: a sweep may come before the lock.
int create(Temporary& temporary, const std::string& output) {
  for (;;) {
    temporary.name = temporary_name(output);
    if (temporary.name.empty()) return -1;
    const int flags = O_CREAT | (has("fixed-name") ? O_TRUNC : O_EXCL) | O_RDWR | O_CLOEXEC;
    const int file = ::open(temporary.name.c_str(), flags, 0666);
    if (file < 0) return -1;
    struct stat status {};
    if (::flock(file, LOCK_EX | LOCK_NB) != 0 || ::fstat(file, &status) != 0 ||
        status.st_nlink > 0) {
      return file;
    }
    ::close(file);
  }
}

int run(const std::string& input, const std::string& output) {
  const std::vector<char> memory(4096);  // something to allocate
  const int from = ::open(input.c_str(), O_RDONLY | O_CLOEXEC);
  if (from < 0) return fail("cannot open");
  if (has("in-place")) {
    const int to = ::open(output.c_str(), O_CREAT | O_TRUNC | O_WRONLY | O_CLOEXEC, 0666);
    if (to < 0 || !copy(from, to) || ::fsync(to) != 0) return fail("cannot write");
    return 0;
  }
  if (!has("no-sweep")) sweep(output);
  const int folder = ::open(".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder < 0) return fail("cannot open the folder");
  struct stat old {};
  const bool has_old = ::stat(output.c_str(), &old) == 0;
  if (!has_old && errno != ENOENT) return fail("cannot look at the output");
  Temporary temporary;
  const int to = create(temporary, output);
  if (to < 0) return fail("cannot create");
  if (has_old && !has("mode") && ::fchmod(to, old.st_mode & 07777u) != 0) {
    return fail("cannot keep the mode");
  }
  if (!copy(from, to)) return fail("cannot copy");
  if (!has("no-flush") && ::fsync(to) != 0) return fail("cannot flush");
  if (::rename(temporary.name.c_str(), output.c_str()) != 0) return fail("cannot rename");
  temporary.name.clear();
  if (!has("no-folder") && ::fsync(folder) != 0) return fail("cannot flush the folder");
  return 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) return 1;
  defect = arguments[1];
  std::signal(SIGXFSZ, SIG_IGN);
  try {
    return run(arguments[2], arguments[3]);
  } catch (const std::bad_alloc&) {
    if (has("abort")) std::abort();
    errno = ENOMEM;
    fail("no memory");
    return kInternal;
  }
}
