// SPDX-License-Identifier: MIT
// Rows as text_checks has found them whole, word by word.
#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <boxtree/cooker/import/direct_import.h>
#include <boxtree/cooker/import/file_error.h>
#include <boxtree/cooker/import/ply_layout.h>
#include <boxtree/cooker/import/ply_mesh.h>
#include <boxtree/cooker/import/source_stream.h>
#include <boxtree/cooker/import/text_checks.h>
#include <boxtree/cooker/import/text_ply.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

// A vertex number as binary files have it: those below zero become large ones, out of range in any
// case. Nothing for what is no whole number, or takes more than 32 bits.
std::optional<std::uint32_t> read_vertex_number(std::string_view word) {
  const char* const first = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* const last = word.data() + word.size();
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(first, last, number);
  constexpr std::int64_t kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr std::int64_t kMost = std::numeric_limits<std::uint32_t>::max();
  if (error != std::errc() || end != last || number < kLeast || number > kMost) return std::nullopt;
  return static_cast<std::uint32_t>(number);
}

// T is the type of the positions.
template <class T>
class Reader {
 public:
  Reader(const PlyLayout& layout, const std::string& file, PlyMesh<T>& mesh)
      : layout_(layout), file_(file), mesh_(mesh) {}

  Status read(std::string_view file) {
    const Result<std::string_view> text = text_of(file);
    if (!text.ok()) return in_file(file_, text.error());
    // Each of them takes a line: counts beyond that are lies, and cost no memory.
    if (layout_.vertex->count > text->size() || layout_.face->count > text->size()) {
      return Error{Errc::kImportFailed,
                   fmt::format("{}: {} vertices and {} faces cannot be in {} bytes", file_,
                               layout_.vertex->count, layout_.face->count, text->size())};
    }
    if (Status status = mesh_.begin_vertices(layout_.vertex->count); !status.ok()) return status;
    if (Status status = mesh_.begin_faces(layout_.face->count); !status.ok()) return status;
    Status taken;  // its errors name the file
    const Status rows = read_ply_rows(
        layout_.header, *text, [&](const PlyElement& element, const Tokens& row, std::size_t line) {
          if (&element == layout_.vertex) take_vertex(row);
          if (&element == layout_.face) taken = take_face(row, line);
          return taken;
        });
    if (!taken.ok()) return taken;
    if (!rows.ok()) return in_file(file_, rows.error());
    return mesh_.finish();
  }

 private:
  // Calls take(property, words) with the words of each property: one, or those of a list.
  template <class Take>
  static void for_each_property(const PlyElement& element, const Tokens& row, const Take& take) {
    std::size_t at = 0;
    for (const PlyProperty& property : element.properties) {
      std::size_t count = 1;
      if (property.length) count = static_cast<std::size_t>(*read_count(row[at++]));
      take(property, std::span(row).subspan(at, count));
      at += count;
    }
  }

  void take_vertex(const Tokens& row) {
    std::array<double, 3> position{};
    for_each_property(*layout_.vertex, row, [&](const PlyProperty& property, auto words) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (layout_.xyz[k] == &property) position[k] = double{*read_number<T>(words[0])};
      }
    });
    for (const double x : position) mesh_.add_coordinate(x);
  }

  Status take_face(const Tokens& row, std::size_t line) {
    Status status;
    for_each_property(*layout_.face, row, [&](const PlyProperty& property, auto words) {
      if (&property != layout_.corners) return;
      corners_.clear();
      for (const std::string_view word : words) {
        const std::optional<std::uint32_t> number = read_vertex_number(word);
        if (!number) {
          status =
              Error{Errc::kImportFailed,
                    fmt::format("{}: line {}: '{}' is no number of a vertex", file_, line, word)};
          return;
        }
        corners_.push_back(*number);
      }
      status = mesh_.add_face(corners_);
    });
    return status;
  }

  const PlyLayout& layout_;
  const std::string& file_;
  PlyMesh<T>& mesh_;
  std::vector<std::uint32_t> corners_;  // of the face at hand
};

}  // namespace

Result<bool> import_text_ply(const std::filesystem::path& path, const ImportOptions& options,
                             Imported& out) {
  Result<SourceStream> stream = SourceStream::open(path);
  if (!stream.ok()) return stream.error();
  std::optional<PlyHeader> header = read_ply_header(stream->ahead());
  if (!header || header->form != PlyHeader::Form::kText) return false;
  PlyLayout layout;
  layout.header = std::move(*header);
  if (!find_ply_parts(layout)) return false;
  const Result<std::string> text = stream->take_rest();
  if (!text.ok()) return text.error();

  const std::string file = path.string();
  return read_into(*stream, path, options, out, [&]<class T>(std::vector<T>& positions) {
    out.report.has_open_end = has_open_end(*text);
    PlyMesh<T> mesh(file, options, positions, out);
    return Reader<T>(layout, file, mesh).read(*text);
  });
}

}  // namespace boxtree::cooker
