// SPDX-License-Identifier: MIT
// Whether a file is a blob is known from its header alone.
#include "cooker/cli/open_file.h"

#include <charconv>

#include <boxtree/blob.h>

namespace boxtree::cooker {

Result<OpenedFile> open_file(const std::filesystem::path& path) {
  Result<File> mapped = File::open(path);
  if (mapped) return OpenedFile{std::move(*mapped)};
  if (mapped.code() != Errc::kFeatureUnsupported) return mapped.error();
  Result<File> blob = open_blob(path);
  if (!blob) return blob.error();
  std::error_code ignored;
  return OpenedFile{std::move(*blob), std::filesystem::file_size(path, ignored)};
}

Result<std::uint32_t> find_tree(const File& file, const std::string& which) {
  std::uint32_t index = 0;
  const char* const end = which.data() + which.size();
  const auto [parsed, error] = std::from_chars(which.data(), end, index);
  if (error == std::errc() && parsed == end) return index;
  return file.find_tree(which);
}

}  // namespace boxtree::cooker
