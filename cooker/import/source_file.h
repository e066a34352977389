// SPDX-License-Identifier: MIT
// What an import reads: a file by its name, or bytes that are in memory already.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <boxtree/error.h>

#include "cooker/system/file_handle.h"
#include "format/bytes.h"

namespace boxtree::cooker {

/// An input without a file, such as a mesh on standard input.
struct SourceBytes {
  std::filesystem::path input;      // what stands for it among the inputs, "-"
  std::string title;                // in messages, "standard input"
  std::filesystem::path file_name;  // "stdin.obj": names the tree, and its ending is the format
  Bytes bytes;                      // must outlive the import
};

class SourceFile {
 public:
  /// A named file.
  SourceFile(std::filesystem::path path)  // NOLINT(google-explicit-constructor): it is one
      : path_(std::move(path)), title_(path_.string()) {}
  /// `bytes` if they are what `input` stands for, else the file of that name.
  SourceFile(const std::filesystem::path& input, const std::optional<SourceBytes>& bytes);

  /// The file's path; of bytes their file_name, which no other file is beside.
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// In messages.
  [[nodiscard]] const std::string& title() const { return title_; }
  /// In reports of progress: without folders.
  [[nodiscard]] std::string short_title() const;
  /// Empty if it is a named file.
  [[nodiscard]] const std::optional<Bytes>& bytes() const { return bytes_; }

  /// Opens it for reading; null, with the reason in errno, if that fails. Precondition: bytes are
  /// not empty.
  [[nodiscard]] FileHandle open() const;
  /// Errors: as read_failure.
  [[nodiscard]] Result<std::uint64_t> size() const;
  /// All of it. Errors: as read_whole_file.
  [[nodiscard]] Result<std::string> read() const;

 private:
  std::filesystem::path path_;
  std::string title_;
  std::optional<Bytes> bytes_;
};

/// The path without "." and "..", unless that names another file: what ".." leads to behind a
/// symbolic link.
[[nodiscard]] std::filesystem::path tidied(const std::filesystem::path& path);

}  // namespace boxtree::cooker
