// SPDX-License-Identifier: MIT
// What is the same on all systems.
#include "cooker/write/atomic_file.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "cooker/system/descriptor.h"
#include "cooker/system/path.h"
#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"
#include "runtime/file/mapping.h"

namespace boxtree::cooker {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

Result<fs::path> follow_links(const fs::path& target) {
  fs::path path = target;
  constexpr int kMostLinks = 40;  // as in the kernel
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (status.type() == fs::file_type::none) {
      return Error{Errc::kWriteFailed, path.string() + ": " + error.message()};
    }
    if (!fs::is_symlink(status)) return path;
    const fs::path to = fs::read_symlink(path, error);
    if (error) return Error{Errc::kWriteFailed, path.string() + ": " + error.message()};
    path = to.is_absolute() ? to : folder_of(path) / to;
  }
  return Error{Errc::kWriteFailed, target.string() + ": too many links lead on from it"};
}

AtomicFile::AtomicFile(TemporaryFile temporary, fs::path target, bool replaces)
    : temporary_(std::move(temporary)), target_(std::move(target)), replaces_(replaces) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : temporary_(std::move(other.temporary_)),
      target_(std::move(other.target_)),
      stream_(std::move(other.stream_)),
      replaces_(other.replaces_),
      directory_(std::exchange(other.directory_, -1)) {}

AtomicFile::~AtomicFile() {
  if (directory_ >= 0) close_descriptor(directory_);
}

Result<AtomicFile> AtomicFile::create(const OutputTarget& to) {
  if (!to.stream) return create_beside(to.path);
  Result<TemporaryFile> memory = TemporaryFile::create_in_memory(to.title());
  if (!memory) return memory.error();
  AtomicFile file(std::move(*memory), to.title(), false);
  file.stream_ = to.stream;
  return file;
}

Status AtomicFile::write(Bytes bytes) {
  return write_all(descriptor(), bytes) ? Status() : write_failure(target_, "cannot write");
}

bool AtomicFile::loses_bytes() const {
  std::error_code error;
  if (!replaces_ || (size_of_file(target_, error) == 0 && !error)) return false;
  const Result<Mapping> before = Mapping::map(target_.string());
  const Result<Mapping> after = Mapping::map(descriptor(), target_.string());
  return !before || !after || !std::ranges::equal(before->bytes(), after->bytes());
}

Status AtomicFile::commit() {
  return stream_ ? send() : replace_target();
}

Status AtomicFile::send() const {
  const Result<Mapping> collected = Mapping::map(descriptor(), stream_->title);
  if (!collected) return collected.error();
  if (write_all(stream_->descriptor, collected->bytes())) return {};
  return write_failure(stream_->title, "cannot be written");
}

}  // namespace boxtree::cooker
