// SPDX-License-Identifier: MIT
// The inside of a File: its mapping, its checked section table and its sections.
#pragma once

#include <cstdint>
#include <memory>
#include <string_view>

#include <boxtree/file.h>

#include "format/container.h"
#include "format/memory.h"
#include "runtime/file/mapping.h"

namespace boxtree {

struct PackRow;
struct TreeRecord;

/// A file whose header and section table have been checked, and the size of its tree table or
/// index.
class OpenFile {
 public:
  /// As File::open, on the caller's memory or on memory that the file takes over.
  static Result<File> open(Bytes memory, const OpenOptions& options);
  static Result<File> open(Mapping owned, const OpenOptions& options);

  /// The inside of a File.
  [[nodiscard]] static const OpenFile& of(const File& file) noexcept { return *file.open_; }

  /// What all that it owns is allocated from.
  [[nodiscard]] const Memory& memory() const noexcept { return memory_; }
  [[nodiscard]] Bytes bytes() const noexcept { return bytes_; }
  /// See File::advise.
  bool advise(Access access) const noexcept { return mapping_.advise(access); }
  [[nodiscard]] const Container& container() const noexcept { return container_; }
  [[nodiscard]] std::uint32_t tree_count() const noexcept { return tree_count_; }
  [[nodiscard]] bool is_pack() const noexcept;

  /// The record of tree `index`, not yet checked (BoundTree::bind checks it). Precondition:
  /// index < tree_count(), and the file is no pack: sections of trees, too, are those of members.
  [[nodiscard]] TreeRecord tree_record(std::uint32_t index) const noexcept;

  /// The row of tree `index` of a pack, not yet checked. Precondition: index < tree_count().
  [[nodiscard]] PackRow pack_row(std::uint32_t index) const noexcept;

  /// The member of a pack that tree `index` is in. Its bytes are those of this file. Precondition:
  /// index < tree_count(). Errors: those of File::open; kRecordInvalid if it is outside the
  /// section.
  [[nodiscard]] Result<File> open_member(std::uint32_t index) const;

  /// Name of tree `index`, empty if it has none or the record points outside the names section.
  [[nodiscard]] std::string_view tree_name(std::uint32_t index) const noexcept;

  /// Bytes of a section; empty when the file has none of that kind and owner.
  [[nodiscard]] Bytes section(SectionKind kind, std::uint32_t owner = kNoOwner) const noexcept;

  /// Whether the bytes of every section, from number `section` on, have the checksum of the section
  /// table. If not, `section` is the first that has another.
  [[nodiscard]] Status verify_checksums(std::size_t& section) const;

 private:
  using Owner = std::unique_ptr<OpenFile, File::Ends>;

  explicit OpenFile(const Memory& memory) noexcept : memory_(memory) {}
  static Owner make(const Memory& memory);
  static Result<File> check(Owner file, const OpenOptions& options, std::uint32_t known_features);

  Memory memory_;
  Mapping mapping_;
  Bytes bytes_;
  Container container_;
  std::uint32_t tree_count_ = 0;
};

}  // namespace boxtree
