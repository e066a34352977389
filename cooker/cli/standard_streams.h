// SPDX-License-Identifier: MIT
// "-" in place of a file: standard input and standard output. A file of that name is "./-".
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <boxtree/error.h>

#include "format/bytes.h"

namespace boxtree::cooker {

/// Standard input is held in memory; more than this is refused.
inline constexpr std::uint64_t kMaxStandardInput = std::uint64_t{1} << 34;

[[nodiscard]] inline bool is_standard_stream(const std::filesystem::path& path) {
  return path == "-";
}

/// All of standard input. The first call reads it; the bytes stay until the program ends. Not for
/// several threads at once. Error: kFileUnreadable for a terminal, a read that fails, and more than
/// kMaxStandardInput.
Result<Bytes> standard_input();

/// A folder for this process alone, removed with all that is in it; also where SIGHUP, SIGINT or
/// SIGTERM ends the process. The thread that makes the first one, and those that it starts later,
/// block these signals from then on: a thread of their own waits for them. Move-only.
class ScratchFolder {
 public:
  /// In the system's folder for temporary files. Error: kWriteFailed.
  static Result<ScratchFolder> make();
  ScratchFolder(ScratchFolder&& other) noexcept;
  ScratchFolder& operator=(ScratchFolder&&) = delete;
  ~ScratchFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// Before the end of its life. What is open in it can still be read.
  void remove();

 private:
  explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

/// A mesh from standard input as the file "stdin.FORMAT", for readers that want a name.
class StandardMesh {
 public:
  /// `format`: the ending of a mesh file's name, "obj". Errors: kFileUnreadable, kWriteFailed.
  static Result<StandardMesh> read(const std::string& format);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// An error of reading it, about "stdin.FORMAT".
  [[nodiscard]] Error named(Error error) const;
  /// A file that it refers to, as it names it.
  [[nodiscard]] std::filesystem::path named(const std::filesystem::path& file) const;

 private:
  StandardMesh(ScratchFolder folder, std::filesystem::path path)
      : folder_(std::move(folder)), path_(std::move(path)) {}
  ScratchFolder folder_;
  std::filesystem::path path_;
};

/// Where a command writes: the file that was named or, for "-", one that send() copies to standard
/// output once it is whole.
class OutputFile {
 public:
  /// `format`: the ending of the name that the writer expects. Errors: kInvalidQuery if standard
  /// output is a terminal, kWriteFailed.
  static Result<OutputFile> make(const std::filesystem::path& requested, const std::string& format);

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  /// As people are told: "standard output" for "-".
  [[nodiscard]] std::string name() const { return folder_ ? "standard output" : path_.string(); }
  /// Prints text for people to standard output, or to standard error where that is the file.
  void report(const std::string& text) const;
  /// Error: kWriteFailed. Nothing to do for a named file. A reader that goes away ends the process
  /// by SIGPIPE, as it ends others; nothing is left then.
  [[nodiscard]] Status send();

 private:
  OutputFile(std::optional<ScratchFolder> folder, std::filesystem::path path)
      : folder_(std::move(folder)), path_(std::move(path)) {}
  std::optional<ScratchFolder> folder_;
  std::filesystem::path path_;
};

}  // namespace boxtree::cooker
