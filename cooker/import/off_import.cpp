// SPDX-License-Identifier: MIT
// Reads word by word, as the format defines; lines matter only for the length of a colour.
#include "cooker/import/off_import.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/direct_import.h"
#include "cooker/import/file_error.h"
#include "cooker/import/indexed_mesh.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

using Words = std::span<const std::string_view>;

// Of any length: the number of edges is not used.
bool is_integer(std::string_view word) {
  const std::string_view digits = word.substr(word.find_first_not_of("+-") == 1 ? 1 : 0);
  return !digits.empty() && digits.find_first_not_of("0123456789") == std::string_view::npos;
}

// T is the type of the positions.
template <class T>
class OffReader {
 public:
  OffReader(std::string_view text, const std::string& file, const ImportOptions& options,
            IndexedMesh<T>& mesh)
      : rest_(text), file_(file), options_(options), mesh_(mesh) {}

  Status read();

 private:
  bool find_word();
  [[nodiscard]] Words rest_of_line() const { return Words(line_words_).subspan(word_); }
  Status take_words(std::size_t count, const char* of);
  Status read_header();
  Status read_dimensions();
  Status read_counts();
  Status read_vertex();
  Status read_face();
  Result<std::optional<FaceFault>> read_corners();

  [[nodiscard]] Error failure(std::string_view why) const {
    return Error{Errc::kImportFailed, fmt::format("{}: line {}: {}", file_, line_, why)};
  }

  std::string_view rest_;  // after the current line
  std::size_t line_ = 0;   // current line, from 1
  Tokens line_words_;      // words of the current line
  std::size_t word_ = 0;   // index of the next one
  Tokens taken_;           // words of the current element
  const std::string& file_;
  const ImportOptions& options_;
  IndexedMesh<T>& mesh_;
  std::size_t dimensions_ = 3;
  bool is_homogeneous_ = false;
  bool has_colors_ = false;
  std::size_t others_ = 0;  // number of normal and texture coordinates
  std::uint64_t vertices_ = 0;
  std::uint64_t faces_ = 0;
  std::vector<std::uint32_t> corners_;
};

template <class T>
Status OffReader<T>::read() {
  if (Status status = read_header(); !status.ok()) return status;
  if (Status status = read_counts(); !status.ok()) return status;
  if (Status status = mesh_.begin_vertices(vertices_); !status.ok()) return status;
  for (std::uint64_t i = 0; i < vertices_; ++i) {
    if (!find_word()) {
      return failure(
          fmt::format("the file ends after {} of {} vertices{}", i, vertices_, kAsIfCut));
    }
    if (Status status = read_vertex(); !status.ok()) return status;
  }
  mesh_.end_vertices();
  if (Status status = mesh_.reserve_faces(faces_); !status.ok()) return status;
  for (std::uint64_t i = 0; i < faces_; ++i) {
    if (!find_word()) {
      return failure(fmt::format("the file ends after {} of {} faces{}", i, faces_, kAsIfCut));
    }
    if (Status status = read_face(); !status.ok()) return status;
  }
  std::uint64_t left_over = 0;
  std::size_t first = 0;
  for (; find_word(); word_ = line_words_.size()) {
    if (left_over++ == 0) first = line_;
  }
  mesh_.add_left_over("line", left_over, first);
  return mesh_.finish();
}

// Moves to the next word that is not a comment; false at the end.
template <class T>
bool OffReader<T>::find_word() {
  while (word_ == line_words_.size()) {
    if (rest_.empty()) return false;
    const std::string_view text = take_line(rest_);
    ++line_;
    split_tokens(text.substr(0, text.find('#')), line_words_);
    word_ = 0;
  }
  return true;
}

// Appends the next words to `taken_`, across line ends.
template <class T>
Status OffReader<T>::take_words(std::size_t count, const char* of) {
  for (std::size_t i = 0; i < count; ++i) {
    if (!find_word()) return failure(fmt::format("the file ends within {}{}", of, kAsIfCut));
    taken_.push_back(line_words_[word_++]);
  }
  return {};
}

// [ST][C][N][4][n]OFF, or missing: then the counts come first.
template <class T>
Status OffReader<T>::read_header() {
  if (!find_word()) return failure("no OFF header");
  std::string_view key = line_words_[word_];
  if (read_integer(key)) return {};
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
    if (!key.starts_with(prefix)) continue;
    key.remove_prefix(prefix.size());
    if (prefix == "4") is_homogeneous_ = true;
    if (prefix == "ST") others_ += 2;
    if (prefix == "C") has_colors_ = true;
    if (prefix == "N") others_ += 3;
    if (prefix == "n") dimensions_ = 0;
  }
  if (key != "OFF") return failure("no OFF header");
  ++word_;
  if (!rest_of_line().empty() && rest_of_line()[0] == "BINARY") {
    return failure("binary OFF is not supported");
  }
  return dimensions_ == 0 ? read_dimensions() : Status();
}

template <class T>
Status OffReader<T>::read_dimensions() {
  const std::optional<std::int64_t> dimensions =
      find_word() ? read_integer(line_words_[word_]) : std::nullopt;
  if (!dimensions || *dimensions < 1 || *dimensions > 3) {
    return failure("vertices of 1, 2 or 3 coordinates are supported");
  }
  dimensions_ = static_cast<std::size_t>(*dimensions);
  ++word_;
  return {};
}

// Numbers of vertices, faces and edges; the last may be missing.
template <class T>
Status OffReader<T>::read_counts() {
  taken_.clear();
  if (!take_words(2, "the counts").ok()) return failure("no counts of vertices and faces");
  const std::optional<std::uint64_t> vertices = read_count(taken_[0]);
  const std::optional<std::uint64_t> faces = read_count(taken_[1]);
  // Each takes at least one word: a count beyond the bytes left is false, and no memory is
  // reserved.
  if (!vertices || !faces || *vertices > rest_.size() || *faces > rest_.size()) {
    return failure(fmt::format("{} vertices and {} faces cannot be in a file of this size",
                               taken_[0], taken_[1]));
  }
  vertices_ = *vertices;
  faces_ = *faces;
  if (!rest_of_line().empty()) {
    if (is_integer(rest_of_line()[0])) ++word_;
  } else if (find_word() && line_words_.size() == 1 && is_integer(line_words_[0])) {
    ++word_;
  }
  return {};
}

// A line per element, as in nearly all files, or `count` words. Only the line shows whether a color
// has three numbers or four.
template <class T>
Status OffReader<T>::read_vertex() {
  const std::size_t needed = dimensions_ + (is_homogeneous_ ? 1 : 0);
  const bool is_line =
      word_ == 0 && line_words_.size() >= needed + others_ + (has_colors_ ? 3u : 0u);
  const std::size_t line = line_;
  taken_.clear();
  const std::size_t count =
      is_line ? line_words_.size() : needed + others_ + (has_colors_ ? 4u : 0u);
  if (Status status = take_words(count, "a vertex"); !status.ok()) return status;
  if (const std::string_view wrong = find_no_number(taken_); !wrong.empty()) {
    return failure(fmt::format("'{}' is no number", wrong));
  }
  VertexWords words = kOrigin;
  for (std::size_t i = 0; i < dimensions_; ++i) words[i] = taken_[i];
  if (is_homogeneous_) words[3] = taken_[dimensions_];
  return mesh_.add_vertex(*read_position(words, options_.precision), line);
}

// The number of corners and their vertices; the rest of the line is a color.
template <class T>
Status OffReader<T>::read_face() {
  const std::string_view stated = line_words_[word_++];
  const std::optional<std::uint64_t> count = read_count(stated);
  if (!count || *count > rest_.size() + line_words_.size()) {
    return failure(fmt::format("a face of '{}' corners", stated));
  }
  taken_.clear();
  if (Status status = take_words(static_cast<std::size_t>(*count), "a face"); !status.ok()) {
    return status;
  }
  Result<std::optional<FaceFault>> fault = read_corners();
  if (!fault.ok()) return fault.error();
  if (const std::string_view wrong = find_no_number(rest_of_line()); !wrong.empty()) {
    return failure(fmt::format("'{}' behind a face is no number of a color", wrong));
  }
  word_ = line_words_.size();
  return fault->has_value() ? mesh_.add_bad_face(std::move(**fault)) : mesh_.add_face(corners_);
}

// Reads into `corners_`. The first corner without a vertex is a fault of the face, if it is a face.
template <class T>
Result<std::optional<FaceFault>> OffReader<T>::read_corners() {
  std::optional<FaceFault> fault;
  corners_.clear();
  for (const std::string_view word : taken_) {
    const std::optional<std::int64_t> vertex = read_integer(word);
    const bool is_good = vertex && *vertex >= 0 && *vertex < static_cast<std::int64_t>(vertices_);
    if (!is_good && !fault) {
      fault =
          FaceFault{Errc::kMeshIndexOutOfRange,
                    fmt::format("corner {} (line {}) names vertex {}, but there are {} vertices",
                                corners_.size(), line_, word, vertices_)};
    }
    if (!vertex && taken_.size() < 3) return failure(fmt::format("'{}' is no vertex", word));
    corners_.push_back(is_good ? static_cast<std::uint32_t>(*vertex) : 0);
  }
  if (taken_.size() < 3) fault.reset();
  return fault;
}

}  // namespace

Status import_off(const SourceFile& source, const ImportOptions& options, Imported& out) {
  const auto read = [&]<class T>(std::string_view text, const std::string& file,
                                 std::vector<T>& positions) {
    IndexedMesh<T> mesh(file, options, positions, out);
    return OffReader<T>(text, file, options, mesh).read();
  };
  return read_text_into(source, options, out, read);
}

}  // namespace boxtree::cooker
