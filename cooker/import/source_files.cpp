// SPDX-License-Identifier: MIT
// Checks and hashes source files.
#include "cooker/import/source_files.h"

#include <cerrno>
#include <cstdio>
#include <span>
#include <system_error>

#include "cooker/import/whole_file.h"
#include "cooker/system/file_handle.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/path.h"
#include "runtime/file/checksum.h"
#include "runtime/file/checksum_stream.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

Error unreadable(const fs::path& path, const std::string& why) {
  return Error{Errc::kFileUnreadable, path.string() + ": " + why};
}

}  // namespace

Status check_source_file(const SourceFile& source, const std::string& named_in) {
  const Error empty{Errc::kImportFailed, source.title() + ": the file is empty"};
  if (source.bytes()) return source.bytes()->empty() ? Status(empty) : Status();
  const fs::path& path = source.path();
  std::error_code error;
  const fs::file_status status = status_of(path, error);
  if (!fs::exists(status)) return input_failure(path.string(), error.value(), named_in);
  if (fs::is_directory(status)) return unreadable(path, "is a directory, not a mesh file");
  // A pipe or a device cannot be read twice, and assimp reads most files more than once.
  if (!fs::is_regular_file(status)) return unreadable(path, "is not a regular file");
  const FileHandle file = open_to_read(path);
  if (!file) return input_failure(path.string(), errno, named_in);
  if (std::fgetc(file.get()) != EOF) return {};
  if (std::ferror(file.get()) != 0) return input_failure(path.string(), errno);
  return empty;
}

Result<std::uint64_t> hash_source_files(std::span<const fs::path> files) {
  ChecksumStream sum;
  for (const fs::path& file : files) {
    const Status status =
        read_chunks(file, kAnyBytes, [&sum](const char* bytes, std::size_t count) {
          sum.add(std::as_bytes(std::span(bytes, count)));
        });
    if (!status.ok()) return status.error();
  }
  return sum.value();
}

std::uint64_t hash_source_bytes(Bytes bytes) {
  return checksum(bytes);
}

}  // namespace boxtree::cooker
