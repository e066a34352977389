// SPDX-License-Identifier: MIT
#include "cooker/system/file_handle.h"

#ifdef _WIN32
#include <cerrno>
#include <io.h>
#include <string>

#include "cooker/system/memory_file.h"
#include "cooker/system/write_all.h"
#include "runtime/file/windows_path.h"
#endif

namespace boxtree::cooker {

#ifdef _WIN32
FileHandle open_to_read(const std::filesystem::path& path) {
  const std::wstring wide = wide_path(path.string());
  if (wide.empty()) {
    errno = ENOENT;
    return nullptr;
  }
  return FileHandle(::_wfopen(wide.c_str(), L"rb"));
}

// Streams over memory are missing there.
FileHandle open_to_read(Bytes bytes) {
  const int descriptor = open_memory_file();
  if (descriptor < 0) return nullptr;
  const bool is_filled = write_all(descriptor, bytes) && ::_lseeki64(descriptor, 0, SEEK_SET) == 0;
  FileHandle file(is_filled ? ::_fdopen(descriptor, "rb") : nullptr);
  if (!file) close_descriptor(descriptor);
  return file;
}
#else
FileHandle open_to_read(const std::filesystem::path& path) {
  return FileHandle(std::fopen(path.c_str(), "rb"));
}

// fmemopen takes void*, but a stream for reading does not write.
FileHandle open_to_read(Bytes bytes) {
  return FileHandle(::fmemopen(const_cast<std::byte*>(bytes.data()), bytes.size(), "rb"));
}
#endif

}  // namespace boxtree::cooker
