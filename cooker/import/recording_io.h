// SPDX-License-Identifier: MIT
// What assimp sees of files: the source and those that it refers to, each recorded.
#pragma once

#include <cstdint>
#include <filesystem>
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
};

/// Whether assimp gets a line end behind a last line of the source that has none. Its reader of SMD
/// goes on behind the end of its buffer without one.
enum class LastLine : std::uint8_t { kAsItIs, kEnded };

/// Lets assimp read but not write, and records each file that it opens, in order of first use.
/// Files that it only looks for are not recorded. Of a source that is bytes, nothing else can be
/// opened.
class RecordingIo final : public Assimp::DefaultIOSystem {
 public:
  /// Source and use must outlive this object, which assimp's Importer owns.
  RecordingIo(const SourceFile& source, SourceUse& use, LastLine last_line)
      : source_(source), use_(use), last_line_(last_line) {}

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
  // The source with an end of its last line; null if it cannot be read.
  [[nodiscard]] Assimp::IOStream* open_with_line_end() const;

  const SourceFile& source_;
  SourceUse& use_;
  LastLine last_line_;
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
