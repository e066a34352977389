// SPDX-License-Identifier: MIT
// Reads files by stdio, which reports the reason of errors.
#include "cooker/import/whole_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "cooker/system/file_handle.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/path.h"

namespace boxtree::cooker {
namespace {

constexpr std::size_t kChunkBytes = std::size_t{1} << 18;

}  // namespace

Status read_chunks(const std::filesystem::path& path, std::uint64_t most,
                   const std::function<void(const char* bytes, std::size_t count)>& sink,
                   const std::string& named_in) {
  const FileHandle file = open_to_read(path);
  if (!file) return input_failure(path.string(), errno, named_in);
  std::vector<char> chunk(kChunkBytes);
  std::uint64_t left = most;
  for (;;) {
    const std::size_t got = std::fread(chunk.data(), 1, chunk.size(), file.get());
    if (got > left) {
      return Error{
          Errc::kFileUnreadable,
          fmt::format("{}: more than the {} bytes that such a file may have", path.string(), most)};
    }
    left -= got;
    sink(chunk.data(), got);
    if (got == chunk.size()) continue;
    return std::ferror(file.get()) != 0 ? Status(input_failure(path.string(), errno)) : Status();
  }
}

Result<std::string> read_whole_file(const std::filesystem::path& path, std::uint64_t most,
                                    const std::string& named_in) {
  std::string text;
  // Without this, the text takes twice its size while it grows for the last time.
  std::error_code none;
  const std::uintmax_t size = size_of_file(path, none);
  if (!none) text.reserve(static_cast<std::size_t>(std::min<std::uintmax_t>(size, most)));
  const Status status = read_chunks(
      path, most, [&text](const char* bytes, std::size_t count) { text.append(bytes, count); },
      named_in);
  if (!status.ok()) return status.error();
  return text;
}

}  // namespace boxtree::cooker
