// SPDX-License-Identifier: MIT
// Reads the text twice: vertices first, because a face may refer to a later one.
#include "cooker/import/obj_import.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/direct_import.h"
#include "cooker/import/indexed_mesh.h"
#include "cooker/import/obj_statements.h"
#include "cooker/import/source_files.h"
#include "cooker/import/text_tokens.h"
#include "cooker/system/path.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// The group of faces that are in no other, by the format.
constexpr std::string_view kDefaultGroup = "default";

// Whether a keyword belongs to the format or a common extension. Invisible bytes and keywords in
// capitals are unknown, so that no vertex or face is skipped.
bool is_known(std::string_view keyword) {
  return keyword != "V" && keyword != "F" &&
         std::all_of(keyword.begin(), keyword.end(), [](char c) { return c > ' ' && c < 127; });
}

// Of a statement in one line.
std::string_view keyword_of(std::string_view statement) {
  return statement.substr(0, statement.find_first_of(" \t"));
}

// What a statement in one line names as material libraries; empty if it is another one.
constexpr std::string_view kLibrary = "mtllib";
std::string_view library_of(std::string_view statement) {
  const std::string_view keyword = keyword_of(statement);
  return keyword == kLibrary ? without_blanks(statement.substr(keyword.size()))
                             : std::string_view();
}

// Statements that make and place no face: attributes of vertices and faces, names, and how to draw.
constexpr std::array<std::string_view, 18> kWithoutGeometry = {
    "vt",     "vn",     "vp",    "g",        "o",        "s",   "mg",         "usemtl",    "mtllib",
    "usemap", "maplib", "bevel", "c_interp", "d_interp", "lod", "shadow_obj", "trace_obj", "ctech"};

// Different statements that are listed, of those that are not read: more are counted as one.
constexpr std::size_t kMostListed = 32;

// Counted from 1, or backwards from -1; nothing if not a number. Numbers of texture coordinates and
// normals may follow, and nothing else: 7, 7/1, 7/1/2, 7//2.
std::optional<std::int64_t> corner_number(std::string_view word) {
  const std::size_t slash = std::min(word.find('/'), word.size());
  const std::string_view rest = word.substr(slash);
  const bool is_corner = std::count(rest.begin(), rest.end(), '/') <= 2 &&
                         rest.find_first_not_of("0123456789+-/") == std::string_view::npos;
  return is_corner ? read_integer(word.substr(0, slash)) : std::nullopt;
}

// T is the type of the positions.
template <class T>
class ObjReader {
 public:
  ObjReader(std::string_view text, const std::string& file, const ImportOptions& options,
            IndexedMesh<T>& mesh, ImportReport& report, FaceMaterials& materials,
            FaceMaterials& groups)
      : text_(text),
        file_(file),
        options_(options),
        mesh_(mesh),
        report_(report),
        materials_(materials),
        groups_(groups, kDefaultGroup) {}

  Status read();

  /// The rest of each `mtllib`: a name that may contain blanks, or several names.
  [[nodiscard]] const std::vector<std::string>& libraries() const { return libraries_; }

 private:
  Status read_vertex();
  Status read_statement();
  Status read_element();
  Status read_face();
  void add_unread(std::string_view keyword);
  [[nodiscard]] bool is_cut() const;
  [[nodiscard]] std::optional<std::uint32_t> vertex_of(std::string_view word) const;
  [[nodiscard]] FaceFault fault_of(std::string_view word, std::size_t corner) const;

  [[nodiscard]] Status failure(std::string_view why) const {
    return Error{Errc::kImportFailed, fmt::format("{}: line {}: {}{}", file_, statement_.line, why,
                                                  is_cut() ? kAsIfCut : "")};
  }

  const std::string_view text_;
  const std::string& file_;
  const ImportOptions& options_;
  IndexedMesh<T>& mesh_;
  ImportReport& report_;
  MaterialUse materials_;
  MaterialUse groups_;
  std::vector<std::string> libraries_;
  std::size_t vertices_so_far_ = 0;
  ObjStatement statement_{};  // current statement
  std::string joined_;        // its lines, if it has several
  Tokens words_;              // after its keyword
  std::vector<std::uint32_t> corners_;
};

template <class T>
Status ObjReader<T>::read() {
  for (ObjStatements statements(text_); statements.next(statement_);) {
    if (!statement_.is_vertex()) continue;
    if (Status status = read_vertex(); !status.ok()) return status;
  }
  mesh_.end_vertices();
  for (ObjStatements statements(text_); statements.next(statement_);) {
    if (Status status = read_statement(); !status.ok()) return status;
  }
  materials_.finish();
  const Status status = mesh_.finish();
  const bool has_elements =
      mesh_.next_face_id() + report_.points_skipped + report_.lines_skipped > 0;
  if (status.code() != Errc::kNoFaces || vertices_so_far_ > 0 || has_elements) return status;
  return Error{Errc::kNoFaces, file_ + ": no faces: no line of it is a vertex or a face of OBJ"};
}

template <class T>
Status ObjReader<T>::read_vertex() {
  split_tokens(joined_text(statement_, joined_), words_);
  words_.erase(words_.begin());
  // A fourth number alone is a weight; more are a colour.
  const std::size_t used = words_.size() == 4 ? 4 : std::min<std::size_t>(words_.size(), 3);
  VertexWords words = kOrigin;
  std::copy_n(words_.begin(), used, words.begin());
  const std::optional<Eigen::Vector3d> position = read_position(words, options_.precision);
  // Words after the position are checked, so that only numbers pass as a vertex.
  const std::string_view no_number = find_no_number(std::span(words_).subspan(position ? used : 0));
  if (!no_number.empty()) return failure(fmt::format("'{}' is no number", no_number));
  if (used < 3) return failure(fmt::format("expected a vertex of 3 numbers, found {}", used));
  return mesh_.add_vertex(*position, statement_.line);
}

template <class T>
Status ObjReader<T>::read_statement() {
  if (statement_.text.empty()) return {};
  if (statement_.is_vertex()) {
    ++vertices_so_far_;
    return {};
  }
  if (statement_.is_element()) return read_element();
  const std::string_view text = joined_text(statement_, joined_);
  const std::string_view keyword = keyword_of(text);
  const std::string_view name = without_blanks(text.substr(keyword.size()));
  if (!is_known(keyword)) {
    return failure(fmt::format("no statement of OBJ begins with {:?}", keyword));
  }
  if (keyword == "usemtl") materials_.begin(name);
  if (keyword == "g") {
    split_tokens(name, words_);
    groups_.begin(fmt::format("{}", fmt::join(words_, " ")));
  }
  if (keyword == kLibrary && !name.empty()) libraries_.emplace_back(name);
  // Vertex numbers count those of that file, too.
  if (keyword == "call") {
    return failure(
        fmt::format("'call' reads another file here, {}; write the lines of that file in its place",
                    name.empty() ? "which it does not name" : name));
  }
  if (std::find(kWithoutGeometry.begin(), kWithoutGeometry.end(), keyword) ==
      kWithoutGeometry.end()) {
    add_unread(keyword);
  }
  return {};
}

template <class T>
void ObjReader<T>::add_unread(std::string_view keyword) {
  std::vector<Unread>& unread = report_.unread;
  const auto is_same = [&keyword](const Unread& each) { return each.what == keyword; };
  auto known = std::find_if(unread.begin(), unread.end(), is_same);
  if (known == unread.end() && unread.size() > kMostListed) --known;
  if (known == unread.end()) {
    const bool is_last = unread.size() == kMostListed;
    unread.push_back({is_last ? "other statements" : std::string(keyword), 0, statement_.line,
                      "faces are read from 'f' alone: convert curves and surfaces to polygons"});
    known = unread.end() - 1;
  }
  ++known->count;
}

template <class T>
Status ObjReader<T>::read_element() {
  const bool is_face = statement_.text[0] == 'f';  // f or fo
  split_tokens(joined_text(statement_, joined_), words_);
  if (is_face) {
    words_.erase(words_.begin());
    return read_face();
  }
  const std::size_t vertices = words_.size() - 1;
  if (words_[0] == "p") report_.points_skipped += vertices;
  if (words_[0] == "l") report_.lines_skipped += vertices < 2 ? 0 : vertices - 1;
  return {};
}

template <class T>
Status ObjReader<T>::read_face() {
  if (words_.size() < 3 && is_cut()) {
    report_.has_half_face = true;
    return {};
  }
  corners_.clear();
  std::optional<FaceFault> fault;
  for (std::size_t i = 0; i < words_.size() && !fault; ++i) {
    const std::optional<std::uint32_t> vertex = vertex_of(words_[i]);
    corners_.push_back(vertex.value_or(0));
    if (!vertex) fault = fault_of(words_[i], i);
  }
  // With fewer corners it is not a face, so skip_bad does not apply.
  if (fault && words_.size() < 3) return Error{fault->code, file_ + ": " + fault->reason};
  if (words_.size() >= 3) {
    materials_.add_face(mesh_.next_face_id());
    groups_.add_face(mesh_.next_face_id());
  }
  return fault ? mesh_.add_bad_face(std::move(*fault)) : mesh_.add_face(corners_);
}

// Whether the current statement reaches the end of a text whose last line has no end.
template <class T>
bool ObjReader<T>::is_cut() const {
  return report_.has_open_end &&
         statement_.text.data() + statement_.text.size() == text_.data() + text_.size();
}

template <class T>
std::optional<std::uint32_t> ObjReader<T>::vertex_of(std::string_view word) const {
  const std::int64_t number = corner_number(word).value_or(0);
  const auto so_far = static_cast<std::int64_t>(vertices_so_far_);
  if (number > 0 && number <= static_cast<std::int64_t>(mesh_.vertices())) {
    return static_cast<std::uint32_t>(number - 1);
  }
  if (number < 0 && number >= -so_far) return static_cast<std::uint32_t>(so_far + number);
  return std::nullopt;
}

// The fault of a corner that refers to no vertex. Its word is quoted, since we count from 0.
template <class T>
FaceFault ObjReader<T>::fault_of(std::string_view word, std::size_t corner) const {
  const std::optional<std::int64_t> number = corner_number(word);
  const std::string fault =
      !number       ? "which is no number of a vertex"
      : *number < 0 ? fmt::format("but {} vertices come before it", vertices_so_far_)
                    : fmt::format("but OBJ counts the {} vertices from 1", mesh_.vertices());
  std::string why = fmt::format("corner {} (line {}) says '{}', {}{}", corner, statement_.line,
                                word, fault, !number && is_cut() ? kAsIfCut : "");
  return {Errc::kMeshIndexOutOfRange, std::move(why)};
}

// Adds the libraries that can be read to the files read and the others to those that are missing,
// without duplicates.
// `looked_for`: gets the names that were tried, unless it is null.
void find_libraries(const SourceFile& source, const std::vector<std::string>& names,
                    ImportReport& report, SourceFileList* looked_for = nullptr) {
  const auto name_of = [&](std::string_view name) {
    return source.path().parent_path() / named_path(name);
  };
  const auto add_to = [](std::vector<fs::path>& files, const fs::path& library) {
    if (std::find(files.begin(), files.end(), library) == files.end()) files.push_back(library);
  };
  const auto add = [&](std::string_view name) {
    if (source.bytes()) return false;  // beside no file
    const fs::path library = tidied(name_of(name));
    std::error_code ignored;
    const bool is_file = fs::is_regular_file(status_of(library, ignored));
    const bool is_found = is_file && SourceStream::open(library).ok();
    if (looked_for != nullptr) {
      (is_found ? looked_for->named : looked_for->absent).push_back(name_of(name));
    }
    if (is_found) add_to(report.files_read, library);
    return is_found;
  };
  Tokens words;
  for (const std::string& name : names) {
    if (add(name)) continue;
    split_tokens(name, words);
    for (const std::string_view word : words) {
      if (!add(word)) add_to(report.files_missing, tidied(name_of(word)));
    }
  }
}

}  // namespace

Status import_obj(const SourceFile& source, const ImportOptions& options, Imported& out,
                  FaceMaterials& materials) {
  if (!options.user_data.empty() && options.user_data != kGroups) {
    return Error{Errc::kMeshUnsupported,
                 fmt::format("{}: user data of faces '{}': an OBJ file has '{}' alone{}",
                             source.title(), options.user_data, kGroups,
                             suggestion(options.user_data, std::array{std::string(kGroups)}))};
  }
  std::vector<std::string> libraries;
  FaceMaterials groups;
  const auto read = [&]<class T>(std::string_view text, const std::string& file,
                                 std::vector<T>& positions) {
    IndexedMesh<T> mesh(file, options, positions, out);
    ObjReader<T> reader(statements_of(text), file, options, mesh, out.report, materials, groups);
    Status status = reader.read();
    libraries = reader.libraries();
    return status;
  };
  if (Status status = read_text_into(source, options, out, read); !status.ok()) return status;
  if (!options.user_data.empty()) {
    out.report.has_no_groups = groups.names == std::vector<std::string>{std::string(kDefaultGroup)};
    out.user_data = std::move(groups.runs);
    out.report.groups = std::move(groups.names);
  }
  find_libraries(source, libraries, out.report);
  if (out.report.files_read.size() <= 1) return {};
  const Result<std::uint64_t> hash = hash_source_files(out.report.files_read);
  if (!hash.ok()) return hash.error();
  out.report.content_hash = hash.value();
  return {};
}

Result<SourceFileList> list_obj_files(const SourceFile& source) {
  const Result<std::string> bytes = source.read();
  if (!bytes.ok()) return bytes.error();
  const Result<std::string_view> text = text_of(*bytes);
  if (!text.ok()) return in_file(source.title(), text.error());
  SourceFileList found;
  if (!source.bytes()) {
    found.files = {tidied(source.path())};
    found.named = {source.path()};
  }
  if (text->find(kLibrary) == std::string_view::npos) return found;
  std::vector<std::string> libraries;
  std::string joined;
  ObjStatement statement{};
  for (ObjStatements statements(statements_of(*text)); statements.next(statement);) {
    if (!statement.text.starts_with(kLibrary)) continue;
    const std::string_view name = library_of(joined_text(statement, joined));
    if (!name.empty()) libraries.emplace_back(name);
  }
  ImportReport report;
  report.files_read = std::move(found.files);
  find_libraries(source, libraries, report, &found);
  found.files = std::move(report.files_read);
  return found;
}

}  // namespace boxtree::cooker
