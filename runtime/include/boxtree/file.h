// SPDX-License-Identifier: MIT
// An open .bxt file: checked header and section table over mapped bytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include "format/container.h"
#include "format/tree_record.h"
#include "runtime/file/mapping.h"

namespace boxtree {

struct OpenOptions {
  /// Read the file into private memory instead of mapping it [default false]: for files that other
  /// programs may modify in place. Only for open(path).
  bool copy = false;
  /// Check the XXH3 of every section [default false]: reads the whole file.
  bool verify_checksums = false;
};

/// Immutable once open; safe to use from many threads. Move-only; trees bound to it point into its
/// bytes and must not outlive it (moving the File keeps them valid).
class File {
 public:
  /// Maps `path` and checks header and section table; no section but the tree table is touched, so
  /// the cost does not depend on the size of the file. Safe for untrusted bytes.
  /// Errors: kFileNotFound, kFileUnreadable, kMapFailed and the codes 10..29.
  static Result<File> open(const std::filesystem::path& path, const OpenOptions& options = {});

  /// The same over memory of the caller, which must stay unchanged while the File or a Tree bound
  /// to it lives. Any alignment.
  static Result<File> open(Bytes memory, const OpenOptions& options = {});

  /// The same over memory that the File takes over.
  static Result<File> open(Mapping owned, const OpenOptions& options = {});

  [[nodiscard]] Bytes bytes() const noexcept { return bytes_; }
  [[nodiscard]] const Container& container() const noexcept { return container_; }
  [[nodiscard]] std::uint32_t tree_count() const noexcept { return tree_count_; }
  [[nodiscard]] bool has_scene() const noexcept { return !section(SectionKind::kScene).empty(); }

  /// The record of tree `index`, not yet checked (Tree::bind checks it). Precondition:
  /// index < tree_count().
  [[nodiscard]] TreeRecord tree_record(std::uint32_t index) const noexcept;

  /// Name of tree `index`, empty if it has none or the record points outside the names section.
  [[nodiscard]] std::string_view tree_name(std::uint32_t index) const noexcept;

  /// Number of the tree with that name; the first if several share it. Error: kTreeIndex.
  [[nodiscard]] Result<std::uint32_t> find_tree(std::string_view name) const;

  /// Bytes of a section; empty when the file has none of that kind and owner.
  [[nodiscard]] Bytes section(SectionKind kind, std::uint32_t owner = kNoOwner) const noexcept;

 private:
  File() = default;
  static Result<File> check(File file, const OpenOptions& options);

  Mapping mapping_;
  Bytes bytes_;
  Container container_;
  std::uint32_t tree_count_ = 0;
};

/// Whether the bytes of every section have the checksum of the section table; reads the whole file.
Status verify_checksums(const File& file);

}  // namespace boxtree
