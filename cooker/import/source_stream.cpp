// SPDX-License-Identifier: MIT
// One buffer over stdio; large reads bypass it.
#include "cooker/import/source_stream.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstring>
#include <span>
#include <string>
#include <utility>

#include "cooker/import/file_error.h"
#include "cooker/system/input_failure.h"

namespace boxtree::cooker {

Result<SourceStream> SourceStream::open(const SourceFile& source) {
  SourceStream stream;
  stream.title_ = source.title();
  stream.file_ = source.open();
  if (!stream.file_) return input_failure(source.title(), errno);
  const Result<std::uint64_t> size = source.size();
  if (!size) return size.error();
  stream.unread_ = *size;
  stream.buffer_.resize(kBufferBytes);
  stream.at_ = stream.end_ = stream.buffer_.data();
  stream.refill(static_cast<std::size_t>(std::min<std::uint64_t>(stream.unread_, kBufferBytes)));
  if (stream.error_ != 0) return stream.ended_in("its first bytes");
  return stream;
}

// Moves the remaining bytes to the front and fills the buffer behind them.
bool SourceStream::refill(std::size_t count) {
  assert(count <= kBufferBytes);
  if (count > left()) return false;
  const auto kept = static_cast<std::size_t>(end_ - at_);
  std::memmove(buffer_.data(), at_, kept);
  const auto wanted =
      static_cast<std::size_t>(std::min<std::uint64_t>(unread_, kBufferBytes - kept));
  char* const behind = buffer_.data() + kept;
  const std::size_t got = std::fread(behind, 1, wanted, file_.get());
  sum_.add(std::as_bytes(std::span(behind, got)));
  unread_ -= got;
  if (got < wanted) {
    // The file cannot be read, or has shrunk: there are no more bytes in either case.
    if (std::ferror(file_.get()) != 0) error_ = errno;
    unread_ = 0;
  }
  at_ = buffer_.data();
  end_ = behind + got;
  return kept + got >= count;
}

Result<std::string> SourceStream::take_rest() {
  std::string rest;
  rest.reserve(left());
  while (left() > 0) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(left(), kBufferBytes));
    const char* const bytes = take(step);
    if (bytes == nullptr) return ended_in("its last bytes");
    rest.append(bytes, step);
  }
  return rest;
}

bool SourceStream::skip(std::uint64_t count) {
  if (count > left()) return false;
  while (count > 0) {
    const auto step = static_cast<std::size_t>(std::min<std::uint64_t>(count, kBufferBytes));
    if (take(step) == nullptr) return false;
    count -= step;
  }
  return true;
}

Error SourceStream::ended_in(std::string_view what) const {
  if (error_ != 0) return input_failure(title_, error_);
  return Error{Errc::kImportFailed, title_ + ": the file ends in " + std::string(what) + kAsIfCut};
}

Result<std::uint64_t> SourceStream::finish() {
  if (!skip(left()) || error_ != 0) return ended_in("its last bytes");
  return sum_.value();
}

}  // namespace boxtree::cooker
