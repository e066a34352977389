// SPDX-License-Identifier: MIT
// Whether a file is a blob is known from its header alone.
#include <boxtree/cooker/cli/open_file.h>
#include <boxtree/runtime/blob/blob.h>

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

}  // namespace boxtree::cooker
