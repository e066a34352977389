// SPDX-License-Identifier: MIT
// A line scanner for OBJ, as lenient as assimp's, that looks at `v` and `f` (and `p`, `l`) alone.
#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <boxtree/cooker/import/obj_faults.h>
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

// Takes the next statement off `rest`; empty lines are statements too.
Statement take_statement(std::string_view& rest, std::size_t& line) {
  const Statement start{rest, line};
  std::size_t end = 0;
  for (; end < rest.size() && !is_line_end(rest[end]); ++end) {
    if (rest[end] != '\\' || end + 1 == rest.size() || !is_line_end(rest[end + 1])) continue;
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

// Assimp knows positions of 3 numbers, of 4 with a weight and of 6 with a colour.
bool is_known_form(const Statement& vertex, const Tokens& numbers) {
  const std::size_t count = numbers.size();
  return (count == 3 || count == 4 || count == 6) &&
         vertex.text.find('#') == std::string_view::npos;
}

class FaultMarker {
 public:
  FaultMarker(std::string_view text, ExactPositions* exact) : source_(text), exact_(exact) {}

  KnownFaults run();
  std::string take_text() { return std::move(text_); }
  [[nodiscard]] bool changed() const { return changed_; }

 private:
  void count_vertices();
  bool mark_vertex(const Statement& statement);
  bool mark_element(const Statement& statement);
  std::string corner_fault(std::string_view token, std::size_t corner, std::size_t line) const;

  std::string_view source_;
  ExactPositions* exact_;  // or null
  std::string text_;
  KnownFaults known_;
  Tokens tokens_;
  std::vector<std::size_t> face_faults_;  // those whose marker follows at the end of the text
  std::size_t vertices_ = 0;              // in the whole file
  std::size_t vertices_so_far_ = 0;
  bool changed_ = false;
};

KnownFaults FaultMarker::run() {
  count_vertices();
  text_.reserve(source_.size() + 1);
  std::string_view rest = source_;
  std::size_t line = 1;
  while (!rest.empty()) {
    const std::string_view before = rest;
    const Statement statement = take_statement(rest, line);
    const char kind = statement.text.empty() ? '\0' : statement.text[0];
    bool replaced = false;
    if (is_vertex(statement)) replaced = mark_vertex(statement);
    if (kind == 'f' || kind == 'l' || kind == 'p') replaced = mark_element(statement);
    if (!replaced) text_ += before.substr(0, before.size() - rest.size());
    changed_ = changed_ || replaced;
  }
  // At the end, where they shift no number and are behind every relative one.
  if (!text_.empty() && text_.back() != '\n') text_ += '\n';
  for (const std::size_t fault : face_faults_) text_ += marker_line(fault);
  return std::move(known_);
}

void FaultMarker::count_vertices() {
  std::string_view rest = source_;
  std::size_t line = 1;
  while (!rest.empty()) {
    const Statement statement = take_statement(rest, line);
    vertices_ += is_vertex(statement) ? 1u : 0u;
  }
}

// Whether the vertex was rewritten.
bool FaultMarker::mark_vertex(const Statement& statement) {
  split_numbers(statement, tokens_);
  ++vertices_so_far_;
  const std::size_t used = tokens_.size() == 4 ? 4 : 3;
  VertexWords words = kOrigin;
  std::copy_n(tokens_.begin(), std::min(used, tokens_.size()), words.begin());
  const Eigen::Vector3d position = read_position(words, exact_ != nullptr);
  if (position.allFinite()) {
    if (exact_ != nullptr) {
      text_ += fmt::format("v {}\n", fmt::join(exact_->add(position), " "));
      return true;
    }
    if (is_known_form(statement, tokens_)) return false;
    text_ += "v";
    for (std::size_t i = 0; i < used; ++i) text_ += fmt::format(" {}", tokens_[i]);
    text_ += '\n';
    return true;
  }
  text_ += marker_line(known_.faults.size());
  known_.faults.push_back(
      {Errc::kMeshNotFinite,
       fmt::format("vertex {} (line {}) is not finite: ({}, {}, {})", vertices_so_far_,
                   statement.line, position[0], position[1], position[2])});
  return true;
}

// Whether the face, line or point was rewritten.
bool FaultMarker::mark_element(const Statement& statement) {
  split_tokens(statement.text, tokens_);
  std::string rewritten(tokens_[0]);
  std::string fault;
  bool replaced = false;
  for (std::size_t i = 1; i < tokens_.size(); ++i) {
    const std::string_view token = tokens_[i];
    if (token[0] == '#') {
      replaced = true;  // assimp would read the comment as a corner
      break;
    }
    std::string why = corner_fault(token, i - 1, statement.line);
    rewritten += ' ';
    if (!why.empty()) {
      // Lines and points are not taken over, so any vertex will do.
      const bool is_face = tokens_[0] == "f";
      rewritten += is_face ? std::to_string(vertices_ + face_faults_.size() + 1) : "1";
      if (fault.empty() && is_face) fault = std::move(why);
      replaced = true;
      continue;
    }
    const std::size_t zero = token.find("/0");
    rewritten += zero == std::string_view::npos ? token : token.substr(0, token.find('/'));
    replaced = replaced || zero != std::string_view::npos;
  }
  if (!replaced) return false;
  text_ += rewritten + '\n';
  if (!fault.empty()) {
    face_faults_.push_back(known_.faults.size());
    known_.faults.push_back({Errc::kMeshIndexOutOfRange, std::move(fault)});
  }
  return true;
}

// Why the corner names no vertex, or nothing.
std::string FaultMarker::corner_fault(std::string_view token, std::size_t corner,
                                      std::size_t line) const {
  long long number = 0;
  const std::size_t sign = token[0] == '+' ? 1 : 0;
  std::from_chars(token.data() + sign, token.data() + token.size(), number);
  const auto count = static_cast<long long>(vertices_);
  const auto so_far = static_cast<long long>(vertices_so_far_);
  if (number > 0 && number <= count) return {};
  if (number < 0 && -number <= so_far) return {};
  const std::string start = fmt::format("corner {} (line {}) names ", corner, line);
  if (number > 0) {
    return start + fmt::format("vertex {}, but there are {} vertices", number, count);
  }
  if (number < 0) {
    return start + fmt::format("vertex {}, but {} vertices come before it", number, so_far);
  }
  return start + fmt::format("vertex '{}', but vertices are numbered from 1", token);
}

}  // namespace

Result<bool> has_unknown_vertex_forms(std::string_view text) {
  Tokens numbers;
  std::size_t line = 1;
  bool is_unknown = false;
  while (!text.empty()) {
    const Statement statement = take_statement(text, line);
    if (!is_vertex(statement)) continue;
    split_numbers(statement, numbers);
    for (const std::string_view token : numbers) {
      if (!read_number(token)) {
        return Error{Errc::kImportFailed,
                     fmt::format("line {}: '{}' is no number", statement.line, token)};
      }
    }
    if (numbers.size() < 3) {
      return Error{Errc::kImportFailed,
                   fmt::format("line {}: a vertex of {} numbers", statement.line, numbers.size())};
    }
    is_unknown = is_unknown || !is_known_form(statement, numbers);
  }
  return is_unknown;
}

KnownFaults mark_obj_faults(std::string& text, bool& changed, ExactPositions* exact) {
  FaultMarker marker(text, exact);
  KnownFaults known = marker.run();
  changed = marker.changed();
  text = marker.take_text();
  return known;
}

}  // namespace boxtree::cooker
