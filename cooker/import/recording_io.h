// SPDX-License-Identifier: MIT
// What assimp sees of files: the source and those that it refers to, each recorded.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <assimp/DefaultIOSystem.h>

#include <boxtree/error.h>

#include "cooker/import/source_file.h"

namespace boxtree::cooker {

/// What a reader opened.
struct SourceUse {
  std::vector<std::filesystem::path> files;    // by their names
  std::vector<std::filesystem::path> named;    // the same, as the reader named them
  std::vector<std::filesystem::path> present;  // looked for and there, whether opened or not
  std::vector<std::filesystem::path> absent;   // looked for, and not there or not opened
  /// The first file that could not be, because the source is bytes, beside no file; empty if none.
  std::filesystem::path inaccessible;
  /// Why the first file that could not be opened beside a named source could not be.
  std::optional<Error> failure;
  /// ReaderLog::guessed_material().
  std::string guessed_material;
  /// Called, unless empty, whenever another file has been opened, with the bytes of all until then.
  std::function<void(std::uint64_t bytes)> opened;
  std::uint64_t bytes_opened = 0;
};

/// What is changed in a source that is text before assimp gets it, without which it reads another
/// text than is there.
struct TextMends {
  /// A line end behind a last line that has none: its reader of SMD goes on behind the end of its
  /// buffer without one.
  bool line_end = false;
  /// A blank behind a comma between two digits, unless the file is packed. Its readers of XGL, X
  /// and X3D take such a comma for a decimal point, where in these formats it ends a number.
  bool commas = false;
};

/// Lets assimp read but not write, and records each file that it opens, in order of first use.
/// Files that it only looks for are not recorded. Of a source that is bytes, nothing else can be
/// opened.
class RecordingIo final : public Assimp::DefaultIOSystem {
 public:
  /// Source and use must outlive this object, which assimp's Importer owns.
  RecordingIo(const SourceFile& source, SourceUse& use, TextMends mends)
      : source_(source), use_(use), mends_(mends) {}

  bool Exists(const char* path) const override;
  Assimp::IOStream* Open(const char* path, const char* mode = "rb") override;
  bool CreateDirectory(const std::string&) override { return false; }
  bool ChangeDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

 private:
  [[nodiscard]] bool is_source(const char* path) const { return source_.path() == path; }
  // The file that `path` names: as it is, or where there is none, without the escapes of an URI
  // (%20) behind the folder of the source.
  [[nodiscard]] std::filesystem::path found(const char* path) const;
  void note_failure(const std::filesystem::path& file);
  [[nodiscard]] bool has_mends() const { return mends_.line_end || mends_.commas; }
  // The source with mends; null if it cannot be read.
  [[nodiscard]] Assimp::IOStream* open_mended() const;

  const SourceFile& source_;
  SourceUse& use_;
  TextMends mends_;
};

/// While it exists, this thread reads numbers in the "C" locale, whatever the process has set: some
/// of assimp's readers use strtod, which may read "1,5" as one and a half.
class CLocaleScope {
 public:
  CLocaleScope();
  ~CLocaleScope();
  CLocaleScope(const CLocaleScope&) = delete;
  CLocaleScope& operator=(const CLocaleScope&) = delete;

 private:
  void* locale_;
  void* previous_;
};

}  // namespace boxtree::cooker
