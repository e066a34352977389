// SPDX-License-Identifier: MIT
// Write, FlushFileBuffers, ReplaceFile. A file that others have mapped cannot be written over or
// deleted there, but it can be renamed: ReplaceFile puts it aside, and the next writer of the
// target deletes what then was still in use. Compiled elsewhere, this is nothing: see
// atomic_file_posix.cpp.
#ifdef _WIN32
#include <io.h>
#include <string>
#include <system_error>
#include <utility>

#include "cooker/system/path.h"
#include "cooker/system/write_failure.h"
#include "cooker/write/atomic_file.h"
#include "cooker/write/temporary_name.h"
#include "runtime/file/windows_path.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

Error windows_failure(const fs::path& path, const char* what) {
  const auto reason = static_cast<int>(::GetLastError());
  return {Errc::kWriteFailed,
          path.string() + ": " + what + ": " + std::system_category().message(reason)};
}

}  // namespace

Result<AtomicFile> AtomicFile::create_beside(const fs::path& given) {
  const Result<fs::path> target = follow_links(given);
  if (!target) return target.error();
  std::error_code error;
  const fs::file_status status = status_of(*target, error);
  const bool exists = fs::exists(status);
  if (!exists && status.type() != fs::file_type::not_found) {
    return Error{Errc::kWriteFailed,
                 given.string() + ": cannot tell whether it exists: " + error.message()};
  }
  if (exists && fs::is_directory(status)) {
    return Error{Errc::kWriteFailed, given.string() + ": is a folder; expected the name of a file"};
  }
  if (exists && !fs::is_regular_file(status)) {
    return Error{Errc::kWriteFailed, given.string() + ": exists and is not a regular file"};
  }
  if (!target->has_filename()) return Error{Errc::kWriteFailed, "a file without a name"};
  Result<TemporaryFile> temporary =
      TemporaryFile::create(folder_of(*target), target->filename().string(), kNewFileMode);
  if (!temporary) return temporary.error();
  return AtomicFile(std::move(*temporary), *target, exists);
}

// Until the names are exchanged, the old file is there. What is open cannot be renamed; between
// closing and renaming, another writer may sweep it away, and then the target stays what it was.
Status AtomicFile::replace_target() {
  const auto file = reinterpret_cast<HANDLE>(::_get_osfhandle(descriptor()));
  if (::FlushFileBuffers(file) == 0) return windows_failure(target_, "cannot flush");
  temporary_.close();
  const std::wstring from = wide_path(temporary_.path().string());
  const std::wstring to = wide_path(target_.string());
  const std::string aside_name = temporary_name(target_.filename().string());
  if (aside_name.empty()) return write_failure(target_, "no random numbers");
  const std::wstring aside = wide_path((folder_of(target_) / named_path(aside_name)).string());
  if (replaces_ && ::ReplaceFileW(to.c_str(), from.c_str(), aside.c_str(),
                                  REPLACEFILE_IGNORE_MERGE_ERRORS, nullptr, nullptr) != 0) {
    temporary_.release_name();
    static_cast<void>(::DeleteFileW(aside.c_str()));
    return {};
  }
  const DWORD reason = replaces_ ? ::GetLastError() : DWORD{ERROR_FILE_NOT_FOUND};
  if (reason == ERROR_UNABLE_TO_MOVE_REPLACEMENT_2) {  // the old one is aside
    static_cast<void>(::MoveFileExW(aside.c_str(), to.c_str(), MOVEFILE_WRITE_THROUGH));
  }
  ::SetLastError(reason);
  // The old file may be gone by now.
  const bool is_new = reason == ERROR_FILE_NOT_FOUND;
  if (!is_new || ::MoveFileExW(from.c_str(), to.c_str(),
                               MOVEFILE_REPLACE_EXISTING | MOVEFILE_WRITE_THROUGH) == 0) {
    return windows_failure(target_, "cannot rename");
  }
  temporary_.release_name();
  return {};
}

}  // namespace boxtree::cooker
#endif
