// SPDX-License-Identifier: MIT
#include "cooker/cli/standard_streams.h"

#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <mutex>
#include <pthread.h>
#include <span>
#include <system_error>
#include <thread>
#include <unistd.h>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/system/file_handle.h"
#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"

namespace boxtree::cooker {
namespace {

Error unreadable(const std::string& why) {
  return {Errc::kFileUnreadable, "standard input: " + why};
}

Result<std::vector<std::byte>> read_standard_input() {
  if (::isatty(STDIN_FILENO) == 1) return unreadable("expected a file, found a terminal");
  std::vector<std::byte> bytes;
  std::size_t size = 0;
  while (true) {
    if (size == bytes.size()) bytes.resize(size + size / 2 + (std::size_t{1} << 16));
    const ssize_t read = ::read(STDIN_FILENO, bytes.data() + size, bytes.size() - size);
    if (read < 0 && errno == EINTR) continue;
    if (read < 0) return unreadable(std::generic_category().message(errno));
    if (read == 0) break;
    size += static_cast<std::size_t>(read);
    if (size > kMaxStandardInput) {
      return unreadable(fmt::format("more than {} bytes; name a file instead", kMaxStandardInput));
    }
  }
  bytes.resize(size);
  return bytes;
}

// The scratch folders there are, and a thread that removes them when a signal is to end the
// process.
class FoldersToRemove {
 public:
  static FoldersToRemove& instance() {
    static auto* const folders = new FoldersToRemove;  // for ever: the thread may outlive statics
    return *folders;
  }

  // Makes a folder by mkdtemp.
  Result<std::filesystem::path> make(std::string name) {
    const std::lock_guard lock(mutex_);
    if (!is_watched_) watch();
    if (::mkdtemp(name.data()) == nullptr) return write_failure(name, "cannot be made");
    folders_.emplace_back(name);
    return folders_.back();
  }

  void remove(const std::filesystem::path& folder) {
    const std::lock_guard lock(mutex_);
    std::error_code ignored;  // what is left is the system's to clear
    std::filesystem::remove_all(folder, ignored);
    std::erase(folders_, folder);
  }

 private:
  // Signals that are ignored, as by nohup, stay so.
  void watch() {
    is_watched_ = true;
    ::sigemptyset(&signals_);
    bool has_any = false;
    for (const int number : {SIGHUP, SIGINT, SIGTERM}) {
      struct sigaction now {};
      if (::sigaction(number, nullptr, &now) != 0 || now.sa_handler != SIG_DFL) continue;
      ::sigaddset(&signals_, number);
      has_any = true;
    }
    if (!has_any) return;
    ::pthread_sigmask(SIG_BLOCK, &signals_, nullptr);
    std::thread([this] { wait(); }).detach();
  }

  void wait() {
    int number = 0;
    if (::sigwait(&signals_, &number) != 0) return;
    mutex_.lock();  // and never unlocked: no more folders
    std::error_code ignored;
    for (const auto& folder : folders_) std::filesystem::remove_all(folder, ignored);
    // The process ends as it would have without this thread.
    ::pthread_sigmask(SIG_UNBLOCK, &signals_, nullptr);
    static_cast<void>(::kill(::getpid(), number));
  }

  std::mutex mutex_;
  bool is_watched_ = false;
  sigset_t signals_{};
  std::vector<std::filesystem::path> folders_;
};

}  // namespace

Result<Bytes> standard_input() {
  static const Result<std::vector<std::byte>> input = read_standard_input();
  if (!input) return input.error();
  return Bytes(*input);
}

Result<ScratchFolder> ScratchFolder::make() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) {
    return Error{Errc::kWriteFailed, "no folder for temporary files: " + error.message()};
  }
  Result<std::filesystem::path> made =
      FoldersToRemove::instance().make((folder / "boxtree-XXXXXX").string());
  if (!made) return made.error();
  return ScratchFolder(std::move(*made));
}

ScratchFolder::ScratchFolder(ScratchFolder&& other) noexcept
    : path_(std::exchange(other.path_, std::filesystem::path())) {}

ScratchFolder::~ScratchFolder() {
  remove();
}

void ScratchFolder::remove() {
  if (!path_.empty()) FoldersToRemove::instance().remove(std::exchange(path_, {}));
}

Result<StandardMesh> StandardMesh::read(const std::string& format) {
  const Result<Bytes> input = standard_input();
  if (!input) return input.error();
  Result<ScratchFolder> folder = ScratchFolder::make();
  if (!folder) return folder.error();
  const std::filesystem::path path = folder->path() / ("stdin." + format);
  const FileHandle file(std::fopen(path.c_str(), "wb"));
  if (!file || !write_all(::fileno(file.get()), *input)) {
    return write_failure(path, "a copy of standard input");
  }
  return StandardMesh(std::move(*folder), path);
}

Error StandardMesh::named(Error error) const {
  const std::string folder = folder_.path().string() + "/";
  for (std::size_t at = 0; (at = error.detail.find(folder, at)) != std::string::npos;) {
    error.detail.erase(at, folder.size());
  }
  return error;
}

std::filesystem::path StandardMesh::named(const std::filesystem::path& file) const {
  return file.parent_path() == folder_.path() ? file.filename() : file;
}

Result<OutputFile> OutputFile::make(const std::filesystem::path& requested,
                                    const std::string& format) {
  if (!is_standard_stream(requested)) return OutputFile(std::nullopt, requested);
  if (::isatty(STDOUT_FILENO) == 1) {
    return Error{Errc::kInvalidQuery, "standard output is a terminal; expected a file or a pipe"};
  }
  Result<ScratchFolder> folder = ScratchFolder::make();
  if (!folder) return folder.error();
  std::filesystem::path path = folder->path() / ("stdout." + format);
  return OutputFile(std::move(*folder), std::move(path));
}

// Nothing of standard error is checked: what was cooked is whole. main checks standard output.
void OutputFile::report(const std::string& text) const {
  static_cast<void>(std::fputs(text.c_str(), folder_ ? stderr : stdout));
}

Status OutputFile::send() {
  if (!folder_) return {};
  const FileHandle file(std::fopen(path_.c_str(), "rb"));
  if (!file) return write_failure(path_, "cannot be read again");
  folder_->remove();
  std::vector<std::byte> block(std::size_t{1} << 18);
  while (const std::size_t read = std::fread(block.data(), 1, block.size(), file.get())) {
    if (!write_all(STDOUT_FILENO, std::span(block).first(read))) {
      return write_failure("standard output", "cannot be written");
    }
  }
  if (std::ferror(file.get()) != 0) return write_failure(path_, "cannot be read again");
  return {};
}

}  // namespace boxtree::cooker
