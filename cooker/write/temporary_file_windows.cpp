// SPDX-License-Identifier: MIT
// While an owner has its file open, nobody else can delete it: files that can be deleted have no
// owner. Compiled elsewhere, this is nothing: see temporary_file_posix.cpp.
#ifdef _WIN32
#include <cerrno>
#include <fcntl.h>
#include <io.h>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "cooker/system/path.h"
#include "cooker/system/write_failure.h"
#include "cooker/write/folder_sweep.h"
#include "cooker/write/temporary_file.h"
#include "cooker/write/temporary_name.h"
#include "runtime/file/windows_path.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

Error cannot_create(const fs::path& folder, const std::string& name, DWORD reason) {
  const std::string path = (folder / named_path(name)).string();
  std::error_code error;
  if (reason == ERROR_PATH_NOT_FOUND && !fs::exists(status_of(folder, error))) {
    return {Errc::kWriteFailed,
            fmt::format("{}: the folder {} is not there; make it first", path, folder.string())};
  }
  return {Errc::kWriteFailed,
          fmt::format("{}: cannot create: {}", path,
                      std::system_category().message(static_cast<int>(reason)))};
}

FolderNames read_folder(const fs::path& folder) {
  FolderNames names;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    names.add(entry->path().filename().native());
  }
  return names;
}

// Files that cannot be deleted stay. Others may have names that no text stands for: halves of
// surrogate pairs.
void sweep(const fs::path& folder, const std::string& name) {
  const std::string prefix = temporary_prefix(name);
  const std::wstring wide_prefix = named_path(prefix).native();
  const auto is_left = [&](const FileName& found) {
    return found.starts_with(wide_prefix) && is_temporary_name(fs::path(found).string(), prefix);
  };
  for (const FileName& left :
       folder_sweep().take(folder, is_left, [&] { return read_folder(folder); })) {
    static_cast<void>(::DeleteFileW(wide_path((folder / left).string()).c_str()));
  }
}

}  // namespace

TemporaryFile::~TemporaryFile() {
  remove_name();
  close();
}

void TemporaryFile::close() {
  if (descriptor_ >= 0) static_cast<void>(::_close(std::exchange(descriptor_, -1)));
}

Result<TemporaryFile> TemporaryFile::create(const fs::path& folder, std::string_view name,
                                            mode_t mode) {
  TemporaryFile file;
  file.folder_ = folder;
  file.name_ = name;
  sweep(folder, file.name_);
  if (Status status = file.create_named(mode); !status) return status.error();
  return file;
}

Status TemporaryFile::choose_name() {
  const std::string name = temporary_name(name_);
  if (name.empty()) return write_failure(folder_ / named_path(name_), "no random numbers");
  path_ = folder_ / named_path(name);
  return {};
}

// Others may map what is written, and not delete it.
Status TemporaryFile::create_named(mode_t /*mode*/) {
  if (Status status = choose_name(); !status) return status;
  const HANDLE file =
      ::CreateFileW(wide_path(path_.string()).c_str(), GENERIC_READ | GENERIC_WRITE,
                    FILE_SHARE_READ, nullptr, CREATE_NEW, FILE_ATTRIBUTE_NORMAL, nullptr);
  if (file == INVALID_HANDLE_VALUE) return cannot_create(folder_, name_, ::GetLastError());
  is_named_ = true;
  descriptor_ = ::_open_osfhandle(reinterpret_cast<std::intptr_t>(file), _O_RDWR | _O_BINARY);
  if (descriptor_ >= 0) return {};
  ::CloseHandle(file);
  errno = EMFILE;
  return write_failure(folder_ / named_path(name_), "cannot create");
}

Status TemporaryFile::add_name() {
  return {};  // it has one
}

// What is open cannot be deleted.
void TemporaryFile::remove_name() {
  if (!is_named_) return;
  close();
  const bool is_gone = ::DeleteFileW(wide_path(path_.string()).c_str()) != 0 ||
                       ::GetLastError() == ERROR_FILE_NOT_FOUND;
  if (is_gone) is_named_ = false;
}

}  // namespace boxtree::cooker
#endif
