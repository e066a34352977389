// SPDX-License-Identifier: MIT
// Where a file is written: under a name, or to a stream such as standard output.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace boxtree::cooker {

/// An open descriptor.
struct OutputStream {
  int descriptor;     // stays open
  std::string title;  // in messages, "standard output"
};

struct OutputTarget {
  OutputTarget(std::filesystem::path named)  // NOLINT(google-explicit-constructor): it is one
      : path(std::move(named)) {}
  OutputTarget(std::filesystem::path like, std::optional<OutputStream> to)
      : path(std::move(like)), stream(std::move(to)) {}

  /// In messages.
  [[nodiscard]] std::string title() const { return stream ? stream->title : path.string(); }

  std::filesystem::path path;          // with a stream: no file, but its ending says the format
  std::optional<OutputStream> stream;  // [none]
};

}  // namespace boxtree::cooker
