// SPDX-License-Identifier: MIT
// The files of one import: checked before, recorded while assimp reads, hashed after.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <assimp/DefaultIOSystem.h>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Whether `path` is a regular file that can be opened and has at least one byte.
Status check_source_file(const std::filesystem::path& path);

/// XXH3 (64 bits) over the bytes of the files, one after the other. Does not depend on their paths.
Result<std::uint64_t> hash_source_files(std::span<const std::filesystem::path> files);

/// Lets assimp read but not write, and records each file that it opens, in order of first use.
/// Files that it only looks for are not recorded.
class RecordingIo final : public Assimp::DefaultIOSystem {
 public:
  /// Records into `files`, which must outlive this object (assimp's Importer owns this object).
  explicit RecordingIo(std::vector<std::filesystem::path>& files) : files_(files) {}

  bool Exists(const char* path) const override;
  Assimp::IOStream* Open(const char* path, const char* mode = "rb") override;
  bool CreateDirectory(const std::string&) override { return false; }
  bool ChangeDirectory(const std::string&) override { return false; }
  bool DeleteFile(const std::string&) override { return false; }

 private:
  std::vector<std::filesystem::path>& files_;
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
