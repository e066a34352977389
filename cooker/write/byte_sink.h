// SPDX-License-Identifier: MIT
// Collects small pieces into large writes, so that exporters can pass one vertex at a time.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {

/// Keeps the first error and discards later bytes: callers check once, by finish().
class ByteSink {
 public:
  /// `file` must outlive it.
  explicit ByteSink(AtomicFile& file) : file_(file) { buffer_.reserve(kBufferBytes); }

  void write(Bytes bytes) {
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    if (buffer_.size() >= kBufferBytes) flush();
  }

  /// Appends the bytes of a value as in memory.
  template <class T>
  requires std::is_trivially_copyable_v<T>
  void put(const T& value) { write(std::as_bytes(std::span(&value, 1))); }

  template <class... Values>
  void print(fmt::format_string<Values...> format, Values&&... values) {
    // Not fmt::format_to: the code that prints numbers would be compiled here again.
    const std::string text = fmt::format(format, std::forward<Values>(values)...);
    write(std::as_bytes(std::span(text)));
  }

  /// Number of bytes appended so far.
  [[nodiscard]] std::uint64_t size() const { return flushed_ + buffer_.size(); }

  [[nodiscard]] Status finish() {
    flush();
    return status_;
  }

 private:
  static constexpr std::size_t kBufferBytes = std::size_t{1} << 16;

  void flush() {
    if (status_) status_ = file_.write(buffer_);
    flushed_ += buffer_.size();
    buffer_.clear();
  }

  AtomicFile& file_;
  std::vector<std::byte> buffer_;
  std::uint64_t flushed_ = 0;
  Status status_;
};

}  // namespace boxtree::cooker
