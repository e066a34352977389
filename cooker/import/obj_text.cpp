// SPDX-License-Identifier: MIT
// A line scanner for OBJ, as lenient as assimp's, that looks at `v` and `f` (and `p`, `l`) alone.
#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <boxtree/cooker/import/obj_text.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

// One statement, with the lines that a backslash joins to it.
struct Statement {
  std::string_view text;  // without the line end; may hold joined line ends
  std::size_t line;       // of its beginning, from 1
};

bool is_line_end(char c) {
  return c == '\n' || c == '\r' || c == '\f' || c == '\0';
}

// Where a statement may end, by the code of the character: files are long.
constexpr auto kMayEnd = [] {
  std::array<bool, 256> may_end{};
  for (const char c : {'\n', '\r', '\f', '\0', '\\'}) {
    may_end[static_cast<unsigned char>(c)] = true;
  }
  return may_end;
}();

// Takes the next statement off `rest`; empty lines are statements too.
Statement take_statement(std::string_view& rest, std::size_t& line) {
  const Statement start{rest, line};
  std::size_t end = 0;
  for (;; ++end) {
    while (end < rest.size() && !kMayEnd[static_cast<unsigned char>(rest[end])]) ++end;
    if (end == rest.size() || rest[end] != '\\') break;
    if (end + 1 == rest.size() || !is_line_end(rest[end + 1])) continue;
    end = std::min(rest.find('\n', end), rest.size() - 1);
    ++line;
  }
  const std::size_t length = end;
  if (rest.substr(end).starts_with("\r\n")) ++end;
  if (end < rest.size()) ++end;
  ++line;
  rest.remove_prefix(end);
  return {start.text.substr(0, length), start.line};
}

bool is_vertex(const Statement& statement) {
  return statement.text.size() > 1 && statement.text[0] == 'v' &&
         (statement.text[1] == ' ' || statement.text[1] == '\t');
}

// Leaves the numbers of a vertex in `tokens`: neither its keyword nor a comment.
void split_numbers(const Statement& vertex, Tokens& tokens) {
  split_tokens(vertex.text.substr(0, vertex.text.find('#')), tokens);
  tokens.erase(tokens.begin());
}

class ObjReader {
 public:
  ObjReader(std::string_view obj, KnownFaults& known, ExactPositions& exact)
      : source_(obj), known_(known), exact_(exact) {}

  Result<std::string> run();

 private:
  std::size_t vertices();
  Status add_vertex(const Statement& statement);
  bool rewrite_element(const Statement& statement);
  static long long corner_number(std::string_view token);
  bool names_vertex(long long number);
  std::string corner_fault(std::string_view token, std::size_t corner, std::size_t line);

  std::string_view source_;
  KnownFaults& known_;
  ExactPositions& exact_;
  std::string text_;
  Tokens tokens_;
  std::vector<std::size_t> face_faults_;  // those whose marker follows at the end of the text
  std::optional<std::size_t> vertices_;   // in the whole file
  std::size_t vertices_so_far_ = 0;
};

Result<std::string> ObjReader::run() {
  text_.reserve(source_.size() + 1);
  std::string_view rest = source_;
  std::size_t line = 1;
  while (!rest.empty()) {
    const std::string_view before = rest;
    const Statement statement = take_statement(rest, line);
    const char kind = statement.text.empty() ? '\0' : statement.text[0];
    if (is_vertex(statement)) {
      if (Status status = add_vertex(statement); !status.ok()) return status.error();
      continue;
    }
    if ((kind == 'f' || kind == 'l' || kind == 'p') && rewrite_element(statement)) continue;
    text_ += before.substr(0, before.size() - rest.size());
  }
  // At the end, where they shift no number and are behind every relative one.
  if (!text_.empty() && text_.back() != '\n') text_ += '\n';
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

Status ObjReader::add_vertex(const Statement& statement) {
  split_numbers(statement, tokens_);
  const auto failure = [&statement](const std::string& why) {
    return Error{Errc::kImportFailed, fmt::format("line {}: {}", statement.line, why)};
  };
  // A fourth number alone is a weight; more are a colour.
  const std::size_t used = tokens_.size() == 4 ? 4 : std::min<std::size_t>(tokens_.size(), 3);
  VertexWords words = kOrigin;
  std::copy_n(tokens_.begin(), used, words.begin());
  const std::optional<Eigen::Vector3d> position = read_position(words, exact_.precision());
  // Words behind the position are looked at so that nothing else than numbers passes for a vertex.
  const std::string_view no_number =
      find_no_number(std::span(tokens_).subspan(position ? used : 0));
  if (!no_number.empty()) return failure(fmt::format("'{}' is no number", no_number));
  if (used < 3) return failure(fmt::format("a vertex of {} numbers", used));
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

// Whether the face, line or point was rewritten.
bool ObjReader::rewrite_element(const Statement& statement) {
  split_tokens(statement.text, tokens_);
  const auto is_good = [this](std::string_view token) {
    return names_vertex(corner_number(token)) && token.find("/0") == std::string_view::npos;
  };
  if (std::all_of(tokens_.begin() + 1, tokens_.end(), is_good)) return false;
  std::string fault;
  text_ += tokens_[0];
  for (std::size_t i = 1; i < tokens_.size(); ++i) {
    const std::string_view token = tokens_[i];
    if (token[0] == '#') break;  // assimp would read the comment as a corner
    text_ += ' ';
    if (names_vertex(corner_number(token))) {
      const bool has_zero = token.find("/0") != std::string_view::npos;
      text_ += has_zero ? token.substr(0, token.find('/')) : token;
      continue;
    }
    // Lines and points are not taken over, so any vertex will do.
    const bool is_face = tokens_[0] == "f";
    text_ += is_face ? std::to_string(vertices() + face_faults_.size() + 1) : "1";
    if (fault.empty() && is_face) fault = corner_fault(token, i - 1, statement.line);
  }
  text_ += '\n';
  if (!fault.empty()) {
    face_faults_.push_back(known_.faults.size());
    known_.faults.push_back({Errc::kMeshIndexOutOfRange, std::move(fault)});
  }
  return true;
}

// Counted from 1, or backwards from -1; 0 for what is no number.
long long ObjReader::corner_number(std::string_view token) {
  long long number = 0;
  const std::size_t sign = token[0] == '+' ? 1 : 0;
  std::from_chars(token.data() + sign, token.data() + token.size(), number);
  return number;
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
