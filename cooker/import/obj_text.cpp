// SPDX-License-Identifier: MIT
// A line scanner for OBJ that looks at `v` and `f` (and `p`, `l`) alone. Indentation, comments and
// a byte order mark do not reach assimp, which passes over a line that begins with any of them.
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <assimp/material.h>
#include <fmt/format.h>

#include <boxtree/cooker/import/obj_text.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

// One statement, with the lines that a backslash joins to it.
struct Statement {
  std::string_view text;  // from its keyword on, without comment and line end; may hold joined ones
  std::size_t line;       // of its beginning, from 1
};

bool is_line_end(char c) {
  return c == '\n' || c == '\r' || c == '\f';
}

bool is_blank(char c) {
  return c == ' ' || c == '\t';
}

// Where something may end, by the code of the character: files are long.
constexpr std::array<bool, 256> set_of(std::string_view characters) {
  std::array<bool, 256> set{};
  for (const char c : characters) set[static_cast<unsigned char>(c)] = true;
  return set;
}
constexpr auto kLineEnds = set_of("\n\r\f");
constexpr auto kLineEndsOrJoins = set_of("\n\r\f\\");
constexpr auto kElementEnds = set_of("\n\r\f\\#");

std::size_t find_of(const std::array<bool, 256>& set, std::string_view text, std::size_t from) {
  while (from < text.size() && !set[static_cast<unsigned char>(text[from])]) ++from;
  return from;
}

// Statements of numbers: there a hash begins a comment, while names may hold one.
bool is_element(std::string_view text) {
  constexpr std::string_view kKeywords = "vflp";
  return text.size() > 1 && kKeywords.find(text[0]) != std::string_view::npos &&
         (is_blank(text[1]) || text[1] == '\\');
}

// Statements of numbers that mean nothing without texture coordinates and normals.
bool is_left_out(std::string_view text) {
  const std::string_view keyword = text.substr(0, text.find_first_of(" \t\\"));
  return keyword == "vt" || keyword == "vn" || keyword == "vp" || keyword == "s";
}

// Takes the next statement off `rest`; empty lines and comments are empty statements. A comment
// ends with its line: paths end in backslashes, too.
Statement take_statement(std::string_view& rest, std::size_t& line) {
  while (!rest.empty() && is_blank(rest[0])) rest.remove_prefix(1);
  const std::string_view from = rest;
  const std::size_t first_line = line;
  const bool has_comments = is_element(rest) || is_left_out(rest);
  const auto& ends = has_comments ? kElementEnds : kLineEndsOrJoins;
  std::size_t end = 0;
  std::size_t length = rest.starts_with('#') ? 0 : std::string_view::npos;
  while (length == std::string_view::npos) {
    end = find_of(ends, rest, end);
    if (end == rest.size() || rest[end] != '\\') {
      length = end;
    } else if (end + 1 < rest.size() && is_line_end(rest[end + 1])) {
      end += rest.substr(end + 1).starts_with("\r\n") ? 3u : 2u;
      ++line;
    } else {
      ++end;
    }
  }
  end = find_of(kLineEnds, rest, end);
  if (rest.substr(end).starts_with("\r\n")) ++end;
  if (end < rest.size()) ++end;
  ++line;
  rest.remove_prefix(end);
  return {from.substr(0, length), first_line};
}

std::string_view keyword_of(std::string_view text) {
  return text.substr(0, text.find_first_of(" \t"));
}

// A keyword of the format, or of one that adds to it; not bytes that an editor does not show, and
// not a vertex or a face in capitals, which would be passed over as unknown.
bool is_known(std::string_view keyword) {
  return keyword != "V" && keyword != "F" &&
         std::all_of(keyword.begin(), keyword.end(), [](char c) { return c > ' ' && c < 127; });
}

bool is_vertex(const Statement& statement) {
  return is_element(statement.text) && statement.text[0] == 'v';
}

Error failure(const Statement& statement, const std::string& why) {
  return Error{Errc::kImportFailed, fmt::format("line {}: {}", statement.line, why)};
}

class ObjReader {
 public:
  ObjReader(std::string_view obj, KnownFaults& known, ExactPositions& exact)
      : source_(obj), known_(known), exact_(exact) {}

  Result<std::string> run();

 private:
  std::size_t vertices();
  Status add_vertex(const Statement& statement);
  void split(const Statement& statement);
  Status rewrite_element(const Statement& statement);
  static long long corner_number(std::string_view token);
  bool names_vertex(long long number);
  std::string corner_fault(std::string_view token, std::size_t corner, std::size_t line);

  std::string_view source_;
  KnownFaults& known_;
  ExactPositions& exact_;
  std::string text_;
  Tokens tokens_;
  std::string joined_;                    // lines of the statement at hand
  std::vector<std::size_t> face_faults_;  // those whose marker follows at the end of the text
  std::optional<std::size_t> vertices_;   // in the whole file
  std::size_t vertices_so_far_ = 0;
  bool has_material_ = true;  // assimp need not be told that faces have none
};

Result<std::string> ObjReader::run() {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (source_.starts_with(kByteOrderMark)) source_.remove_prefix(kByteOrderMark.size());
  const Result<std::string_view> text = text_of(source_);
  if (!text.ok()) return text.error();
  source_ = *text;
  if (source_.ends_with('\x1a')) source_.remove_suffix(1);  // how DOS ended a text
  // Assimp wants 16 bytes of any file, even of one that holds comments alone.
  constexpr std::string_view kStart = "# statements of an OBJ file\n";
  text_.reserve(kStart.size() + source_.size() + 1);
  text_ = kStart;
  has_material_ = source_.find("usemtl") == std::string_view::npos &&
                  source_.find("mtllib") == std::string_view::npos;
  std::string_view rest = source_;
  std::size_t line = 1;
  while (!rest.empty()) {
    const Statement statement = take_statement(rest, line);
    if (is_vertex(statement)) {
      if (Status status = add_vertex(statement); !status.ok()) return status.error();
      continue;
    }
    if (is_left_out(statement.text)) continue;
    if (is_element(statement.text)) {
      if (Status status = rewrite_element(statement); !status.ok()) return status.error();
      continue;
    }
    has_material_ = has_material_ || keyword_of(statement.text) == "usemtl";
    if (!is_known(keyword_of(statement.text))) {
      return failure(statement, fmt::format("no statement of OBJ begins with {:?}",
                                            keyword_of(statement.text)));
    }
    text_ += statement.text;
    text_ += '\n';
  }
  // At the end, where they shift no number and are behind every relative one.
  for (const std::size_t fault : face_faults_) text_ += marker_line(fault);
  return std::move(text_);
}

// Counted when a face names a vertex that has not come yet: most files need no such pass.
std::size_t ObjReader::vertices() {
  if (vertices_) return *vertices_;
  std::string_view rest = source_;
  std::size_t line = 1, count = 0;
  while (!rest.empty()) count += is_vertex(take_statement(rest, line)) ? 1u : 0u;
  vertices_ = count;
  return count;
}

// Into words, of which a backslash at the end of a line is none.
void ObjReader::split(const Statement& statement) {
  if (statement.text.find('\\') == std::string_view::npos) {
    split_tokens(statement.text, tokens_);
    return;
  }
  joined_ = statement.text;
  for (std::size_t i = 0; i + 1 < joined_.size(); ++i) {
    if (joined_[i] == '\\' && is_line_end(joined_[i + 1])) joined_[i] = ' ';
  }
  if (joined_.ends_with('\\')) joined_.back() = ' ';
  split_tokens(joined_, tokens_);
}

Status ObjReader::add_vertex(const Statement& statement) {
  split(statement);
  tokens_.erase(tokens_.begin());
  // A fourth number alone is a weight; more are a colour.
  const std::size_t used = tokens_.size() == 4 ? 4 : std::min<std::size_t>(tokens_.size(), 3);
  VertexWords words = kOrigin;
  std::copy_n(tokens_.begin(), used, words.begin());
  const std::optional<Eigen::Vector3d> position = read_position(words, exact_.precision());
  // Words behind the position are looked at so that nothing else than numbers passes for a vertex.
  const std::string_view no_number =
      find_no_number(std::span(tokens_).subspan(position ? used : 0));
  if (!no_number.empty()) return failure(statement, fmt::format("'{}' is no number", no_number));
  if (used < 3) return failure(statement, fmt::format("a vertex of {} numbers", used));
  ++vertices_so_far_;
  if (position->allFinite()) {
    append_vertex_line(exact_.add(*position), text_);
    return {};
  }
  text_ += marker_line(known_.faults.size());
  known_.faults.push_back(
      {Errc::kMeshNotFinite,
       fmt::format("vertex {} (line {}) is not finite: ({}, {}, {})", vertices_so_far_,
                   statement.line, (*position)[0], (*position)[1], (*position)[2])});
  return {};
}

// Corners become the numbers of their vertices alone. Assimp would give faces that come before the
// first material that one.
Status ObjReader::rewrite_element(const Statement& statement) {
  split(statement);
  const bool is_face = tokens_[0] == "f";
  if (is_face && !has_material_) {
    text_ += "usemtl " AI_DEFAULT_MATERIAL_NAME "\n";
    has_material_ = true;
  }
  std::string fault;
  text_ += tokens_[0];
  for (std::size_t i = 1; i < tokens_.size(); ++i) {
    const long long number = corner_number(tokens_[i]);
    // Lines and points are not taken over, so any vertex will do.
    long long shown = 1;
    if (names_vertex(number)) {
      shown = number > 0 ? number : static_cast<long long>(vertices_so_far_) + number + 1;
    } else if (is_face) {
      shown = static_cast<long long>(vertices()) + static_cast<long long>(face_faults_.size()) + 1;
      if (fault.empty()) fault = corner_fault(tokens_[i], i - 1, statement.line);
    }
    const fmt::format_int digits(shown);
    text_ += ' ';
    text_.append(digits.data(), digits.size());
  }
  text_ += '\n';
  // With fewer corners it is no face, and its fault none that skip_bad could leave out.
  if (!fault.empty() && tokens_.size() < 4) return Error{Errc::kMeshIndexOutOfRange, fault};
  if (!fault.empty()) {
    face_faults_.push_back(known_.faults.size());
    known_.faults.push_back({Errc::kMeshIndexOutOfRange, std::move(fault)});
  }
  return {};
}

// Counted from 1, or backwards from -1; 0 for what is no number.
long long ObjReader::corner_number(std::string_view token) {
  long long number = 0;
  const std::size_t sign = token[0] == '+' ? 1 : 0;
  const char* const last = token.data() + token.size();
  const char* const end = std::from_chars(token.data() + sign, last, number).ptr;
  // Numbers of texture coordinates and normals may follow, and nothing else.
  const std::string_view rest(end, static_cast<std::size_t>(last - end));
  const bool is_corner =
      rest.empty() ||
      (rest[0] == '/' && rest.find_first_not_of("0123456789+-/") == std::string_view::npos);
  return is_corner ? number : 0;
}

bool ObjReader::names_vertex(long long number) {
  const auto so_far = static_cast<long long>(vertices_so_far_);
  if (number <= so_far) return number >= -so_far && number != 0;
  return number <= static_cast<long long>(vertices());
}

// Why the corner names no vertex.
std::string ObjReader::corner_fault(std::string_view token, std::size_t corner, std::size_t line) {
  const long long number = corner_number(token);
  const std::string start = fmt::format("corner {} (line {}) names ", corner, line);
  if (number > 0) {
    return start + fmt::format("vertex {}, but there are {} vertices", number, vertices());
  }
  if (number < 0) {
    return start +
           fmt::format("vertex {}, but {} vertices come before it", number, vertices_so_far_);
  }
  return start + fmt::format("vertex '{}', but vertices are numbered from 1", token);
}

}  // namespace

Result<std::string> obj_for_assimp(std::string_view obj, KnownFaults& known,
                                   ExactPositions& exact) {
  return ObjReader(obj, known, exact).run();
}

}  // namespace boxtree::cooker
