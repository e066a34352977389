// SPDX-License-Identifier: MIT
// Reads rows one by one without storing them.
#include "cooker/import/text_ply.h"

#include <array>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/file_error.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

using Words = std::span<const std::string_view>;

// An integer as in binary files: negative numbers become large ones. Empty if it is not an integer
// or has more than 32 bits.
std::optional<std::uint32_t> read_32_bits(std::string_view word) {
  const std::optional<std::int64_t> number = read_integer(word);
  constexpr std::int64_t kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (!number || *number < kLeast || *number > kMost) return std::nullopt;
  return static_cast<std::uint32_t>(*number);
}

// T is the type of the positions.
template <class T>
class TextPlyReader {
 public:
  TextPlyReader(std::string_view text, const PlyLayout& layout, const std::string& file,
                IndexedMesh<T>& mesh)
      : rest_(text.substr(layout.header.bytes)),
        line_(layout.header.lines),
        layout_(layout),
        file_(file),
        mesh_(mesh) {}

  Status read();

 private:
  Status check_counts() const;
  bool next_row();
  Status read_element(const PlyElement& element);
  Status check_row(const PlyElement& element, std::uint64_t number);
  Result<std::uint64_t> count_words(const PlyElement& element) const;
  Status check_numbers(const PlyElement& element);
  Status take_row(const PlyElement& element);
  Status take_corners(Words words);

  [[nodiscard]] Error failure(std::string_view why) const {
    return Error{Errc::kImportFailed, fmt::format("{}: line {}: {}", file_, line_, why)};
  }

  std::string_view rest_;
  std::size_t line_;       // current line, from 1
  Tokens row_;             // its words
  std::vector<T> vertex_;  // the numbers of the current vertex, one for each of its words
  const PlyLayout& layout_;
  const std::string& file_;
  IndexedMesh<T>& mesh_;
  std::array<double, 3> position_{};        // of the current vertex
  std::vector<std::uint32_t> corners_;      // of the current face or strip
  std::optional<std::uint32_t> user_data_;  // of the current face, if it is wanted
  std::int64_t face_id_ = 0;                // likewise
};

template <class T>
Status TextPlyReader<T>::read() {
  if (Status status = check_counts(); !status.ok()) return status;
  if (Status status = mesh_.begin_vertices(layout_.vertex->count); !status.ok()) return status;
  if (layout_.face != nullptr) {
    if (Status status = mesh_.reserve_faces(layout_.face->count); !status.ok()) return status;
  }
  for (const PlyElement& element : layout_.header.elements) {
    if (Status status = read_element(element); !status.ok()) return status;
    if (&element == layout_.vertex) mesh_.end_vertices();
  }
  std::uint64_t left_over = 0;
  std::size_t first = 0;
  while (next_row()) {
    if (left_over++ == 0) first = line_;
  }
  mesh_.add_left_over("line", left_over, first);
  return mesh_.finish();
}

// Each element takes a line: a larger count is false, and no memory is reserved for it.
template <class T>
Status TextPlyReader<T>::check_counts() const {
  for (const PlyElement& element : layout_.header.elements) {
    if (element.count <= rest_.size() || element.properties.empty()) continue;
    return Error{Errc::kImportFailed,
                 fmt::format("{}: {} elements '{}' cannot be in {} bytes{}", file_, element.count,
                             element.name, rest_.size(), kAsIfCut)};
  }
  return {};
}

// Moves to the next line with a word; false at the end.
template <class T>
bool TextPlyReader<T>::next_row() {
  while (!rest_.empty()) {
    split_tokens(take_line(rest_), row_);
    ++line_;
    if (!row_.empty()) return true;
  }
  return false;
}

template <class T>
Status TextPlyReader<T>::read_element(const PlyElement& element) {
  if (element.properties.empty()) return {};
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (!next_row()) {
      return failure(fmt::format("the file ends after {} of {} '{}'{}", i, element.count,
                                 element.name, kAsIfCut));
    }
    if (Status status = check_row(element, i); !status.ok()) return status;
    if (Status status = take_row(element); !status.ok()) return status;
  }
  return {};
}

template <class T>
Status TextPlyReader<T>::check_row(const PlyElement& element, std::uint64_t number) {
  const Result<std::uint64_t> wanted = count_words(element);
  if (!wanted.ok()) return wanted.error();
  if (*wanted != row_.size()) {
    const bool is_cut = *wanted > row_.size() && rest_.empty();
    return failure(fmt::format("'{}' {} has {} words; its properties take {}{}", element.name,
                               number, row_.size(), *wanted, is_cut ? kAsIfCut : ""));
  }
  return check_numbers(element);
}

// Those of a vertex are kept, so that coordinates are read once.
template <class T>
Status TextPlyReader<T>::check_numbers(const PlyElement& element) {
  std::string_view no_number;
  if (&element == layout_.vertex) {
    vertex_.clear();
    for (const std::string_view word : row_) {
      const std::optional<T> number = read_number<T>(word);
      if (!number) {
        no_number = word;
        break;
      }
      vertex_.push_back(*number);
    }
  } else {
    no_number = find_no_number(row_);
  }
  return no_number.empty() ? Status() : failure(fmt::format("'{}' is no number", no_number));
}

// Number of words of an element, given its properties and the lengths of its lists.
template <class T>
Result<std::uint64_t> TextPlyReader<T>::count_words(const PlyElement& element) const {
  std::uint64_t wanted = 0;
  for (const PlyProperty& property : element.properties) {
    if (property.length && wanted < row_.size()) {
      const std::optional<std::uint64_t> count = read_count(row_[wanted]);
      if (!count || *count > row_.size()) {
        return failure(fmt::format("a list of '{}' numbers, but the line has {} words{}",
                                   row_[wanted], row_.size(), rest_.empty() ? kAsIfCut : ""));
      }
      wanted += *count;
    }
    ++wanted;
  }
  return wanted;
}

// Precondition: check_row() has found no fault.
template <class T>
Status TextPlyReader<T>::take_row(const PlyElement& element) {
  std::size_t at = 0;
  for (const PlyProperty& property : element.properties) {
    std::size_t count = 1;
    if (property.length) count = static_cast<std::size_t>(*read_count(row_[at++]));
    if (&property == layout_.corners || &property == layout_.strip) {
      if (Status status = take_corners(Words(row_).subspan(at, count)); !status.ok()) return status;
    } else if (&property == layout_.user_data) {
      user_data_ = read_32_bits(row_[at]);
      if (!user_data_) {
        return failure(fmt::format("user data '{}' is no integer of 32 bits", row_[at]));
      }
    } else if (&property == layout_.face_ids) {
      const std::optional<std::int64_t> id = read_integer(row_[at]);
      if (!id) return failure(fmt::format("the id '{}' of a face is no integer", row_[at]));
      face_id_ = *id;
    } else if (&element == layout_.vertex) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (layout_.xyz[k] == &property) position_[k] = double{vertex_[at]};
      }
    }
    at += count;
  }
  if (&element == layout_.vertex) {
    for (const double x : position_) mesh_.add_coordinate(x);
  } else if (&element == layout_.face) {
    if (layout_.face_ids != nullptr) {
      if (Status status = mesh_.number_next_face(face_id_); !status.ok()) return status;
    }
    return mesh_.add_face(corners_, user_data_);
  } else if (&element == layout_.tristrips) {
    return mesh_.add_strips(corners_);
  }
  return {};
}

template <class T>
Status TextPlyReader<T>::take_corners(Words words) {
  corners_.clear();
  for (const std::string_view word : words) {
    const std::optional<std::uint32_t> number = read_32_bits(word);
    if (!number) return failure(fmt::format("'{}' is no number of a vertex", word));
    corners_.push_back(*number);
  }
  return {};
}

}  // namespace

template <class T>
Status read_text_ply(std::string_view text, const PlyLayout& layout, const std::string& file,
                     IndexedMesh<T>& mesh) {
  const Result<std::string_view> checked = text_of(text);
  if (!checked.ok()) return in_file(file, checked.error());
  return TextPlyReader<T>(*checked, layout, file, mesh).read();
}

template Status read_text_ply(std::string_view, const PlyLayout&, const std::string&,
                              IndexedMesh<float>&);
template Status read_text_ply(std::string_view, const PlyLayout&, const std::string&,
                              IndexedMesh<double>&);

}  // namespace boxtree::cooker
