// SPDX-License-Identifier: MIT
// A stdio file that closes itself. Unlike streams, stdio reports the reason of errors.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>

#include "format/bytes.h"

namespace boxtree::cooker {

struct CloseFile {
  void operator()(std::FILE* file) const { static_cast<void>(std::fclose(file)); }
};

using FileHandle = std::unique_ptr<std::FILE, CloseFile>;

/// Opens a file to be read as bytes; null, with the reason in errno, if that fails.
[[nodiscard]] FileHandle open_to_read(const std::filesystem::path& path);

/// The same of bytes that are in memory and outlive it. Precondition: they are not empty.
[[nodiscard]] FileHandle open_to_read(Bytes bytes);

}  // namespace boxtree::cooker
