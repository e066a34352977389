// SPDX-License-Identifier: MIT
// A whole file as read-only memory, mapped or copied.
#pragma once

#include <span>
#include <string>
#include <utility>

#include <boxtree/error.h>
#include <boxtree/file.h>
#include <boxtree/memory.h>

#include "format/bytes.h"

namespace boxtree {

/// Read-only bytes of one file, released on destruction. Move-only.
class Mapping {
 public:
  Mapping() = default;
  Mapping(Mapping&& other) noexcept;
  Mapping& operator=(Mapping&& other) noexcept;
  Mapping(const Mapping&) = delete;
  Mapping& operator=(const Mapping&) = delete;
  ~Mapping();

  /// Maps `path`; size and bytes come from one open descriptor, so a rename cannot mix two files.
  /// Errors: kFileNotFound, kFileUnreadable, kMapFailed, kOutOfMemory. An empty file gives empty
  /// bytes.
  ///
  /// While it is mapped the file must not be truncated in place: replace files by rename, as the
  /// cooker does. Use copy() for files that others may modify.
  static Result<Mapping> map(const std::string& path);

  /// Maps a file that is open already; `name` is for messages. The caller keeps the descriptor.
  static Result<Mapping> map(int descriptor, const std::string& name);

  /// Reads `path` into private memory, which later changes of the file do not affect. `memory`:
  /// where that is taken from, pages of the system if it has no functions.
  static Result<Mapping> copy(const std::string& path, const Memory& memory = {});

  [[nodiscard]] Bytes bytes() const noexcept { return {data_, size_}; }

  /// See File::advise. Does nothing with memory that no file is behind.
  bool advise(Access access) const noexcept;

 private:
  friend class WritableMapping;
  Mapping(const std::byte* data, std::size_t size, bool is_of_file,
          const Memory& memory = {}) noexcept
      : data_(data), size_(size), is_of_file_(is_of_file), memory_(memory) {}

  void unmap() noexcept;

  const std::byte* data_ = nullptr;
  std::size_t size_ = 0;
  bool is_of_file_ = false;  // else a copy in memory
  Memory memory_;            // where that was taken from
#ifdef _WIN32
  static Result<Mapping> map_handle(void* file, const std::string& name);

  void* file_ = nullptr;  // what keeps others from writing to a mapped file
#endif
};

/// Memory that is filled once and then becomes a Mapping. Move-only.
class WritableMapping {
 public:
  /// Memory, of the system if `memory` has no functions, which then is zeroed. Error: kOutOfMemory
  /// when there is not enough of it.
  static Result<WritableMapping> allocate(std::size_t size, const Memory& memory = {});

  [[nodiscard]] std::span<std::byte> bytes() noexcept { return {data_, mapping_.size_}; }
  [[nodiscard]] Mapping finish() && noexcept { return std::move(mapping_); }

 private:
  WritableMapping(std::byte* data, std::size_t size, const Memory& memory = {}) noexcept
      : mapping_(data, size, false, memory), data_(data) {}
  // Of the system, zeroed; nullptr where there are none. Mapping::unmap() gives them back.
  static void* pages(std::size_t size) noexcept;

  Mapping mapping_;
  std::byte* data_;
};

}  // namespace boxtree
