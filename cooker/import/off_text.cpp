// SPDX-License-Identifier: MIT
// A line reader for OFF (http://www.geomview.org/docs/html/OFF.html) that writes OBJ.
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include <boxtree/cooker/import/off_text.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

class OffReader {
 public:
  OffReader(std::string_view off, KnownFaults& known, ExactPositions& exact)
      : rest_(off), known_(known), exact_(exact) {}

  Result<std::string> run();

 private:
  bool next_line();
  [[nodiscard]] Error failure(const std::string& why) const;
  Status read_header();
  Status read_counts();
  Status read_vertices();
  Status read_faces();
  bool add_vertex(std::size_t vertex);
  Status add_face();

  std::string_view rest_;
  KnownFaults& known_;
  ExactPositions& exact_;
  std::string obj_;
  Tokens tokens_;  // of the line at hand
  std::size_t line_ = 0;
  std::size_t dimensions_ = 3;
  bool is_homogeneous_ = false;
  std::size_t attributes_ = 0;  // numbers behind a position, at least: colours may have a fourth
  std::size_t vertices_ = 0;
  std::size_t faces_ = 0;
  std::vector<std::size_t> face_faults_;
};

std::optional<long long> to_integer(std::string_view token) {
  long long number = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), number);
  if (error != std::errc() || end != token.data() + token.size()) return std::nullopt;
  return number;
}

Result<std::string> OffReader::run() {
  const Result<std::string_view> text = text_of(rest_);
  if (!text.ok()) return text.error();
  rest_ = *text;
  for (Status (OffReader::*step)() : {&OffReader::read_header, &OffReader::read_counts,
                                      &OffReader::read_vertices, &OffReader::read_faces}) {
    if (Status status = (this->*step)(); !status.ok()) return status.error();
  }
  for (const std::size_t fault : face_faults_) obj_ += marker_line(fault);
  return std::move(obj_);
}

// Moves to the next line that holds anything but a comment.
bool OffReader::next_line() {
  while (!rest_.empty()) {
    const std::string_view text = take_line(rest_);
    ++line_;
    split_tokens(text.substr(0, text.find('#')), tokens_);
    if (!tokens_.empty()) return true;
  }
  return false;
}

Error OffReader::failure(const std::string& why) const {
  return Error{Errc::kImportFailed, fmt::format("line {}: {}", line_, why)};
}

// [ST][C][N][4][n]OFF, or nothing: then the counts come first.
Status OffReader::read_header() {
  if (!next_line()) return failure("no OFF header");
  std::string_view key = tokens_.front();
  if (to_integer(key)) return {};
  for (const std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
    if (!key.starts_with(prefix)) continue;
    key.remove_prefix(prefix.size());
    if (prefix == "4") is_homogeneous_ = true;
    if (prefix == "ST") attributes_ += 2;
    if (prefix == "C" || prefix == "N") attributes_ += 3;
    if (prefix == "n") dimensions_ = 0;
  }
  if (key != "OFF") return failure("no OFF header");
  if (tokens_.size() > 1 && tokens_[1] == "BINARY") return failure("binary OFF is not supported");
  tokens_.erase(tokens_.begin());
  if (tokens_.empty() && !next_line()) return failure("no counts");
  if (dimensions_ != 0) return {};
  const std::optional<long long> dimensions = to_integer(tokens_.front());
  if (!dimensions || *dimensions < 1 || *dimensions > 3) {
    return failure("vertices of 1, 2 or 3 coordinates are supported");
  }
  dimensions_ = static_cast<std::size_t>(*dimensions);
  tokens_.erase(tokens_.begin());
  return tokens_.empty() && !next_line() ? Status(failure("no counts")) : Status();
}

Status OffReader::read_counts() {
  if (tokens_.size() < 2) return failure("no counts of vertices and faces");
  const std::optional<long long> vertices = to_integer(tokens_[0]), faces = to_integer(tokens_[1]);
  // Each takes a line: a count beyond the bytes left is a lie, and costs no memory here.
  const auto most = static_cast<long long>(rest_.size());
  if (!vertices || !faces || *vertices < 0 || *faces < 0 || *vertices > most || *faces > most) {
    return failure(fmt::format("{} vertices and {} faces cannot be in a file of this size",
                               tokens_[0], tokens_[1]));
  }
  vertices_ = static_cast<std::size_t>(*vertices);
  faces_ = static_cast<std::size_t>(*faces);
  // Assimp wants 16 bytes of any OBJ file, even of one without a vertex.
  obj_ = "# an OFF file as OBJ\n";
  obj_.reserve(rest_.size() + (vertices_ + faces_) * 4);
  return {};
}

Status OffReader::read_vertices() {
  const std::size_t wanted = dimensions_ + (is_homogeneous_ ? 1 : 0) + attributes_;
  for (std::size_t vertex = 0; vertex < vertices_; ++vertex) {
    if (!next_line()) {
      return failure(fmt::format("the file ends after {} of {} vertices", vertex, vertices_));
    }
    if (tokens_.size() < wanted) {
      return failure(fmt::format("a vertex of {} numbers; it has {}", tokens_.size(), wanted));
    }
    if (!add_vertex(vertex)) {
      return failure(
          fmt::format("'{}' is no number", find_no_number(std::span(tokens_).first(wanted))));
    }
  }
  return {};
}

// False if a word is no number.
bool OffReader::add_vertex(std::size_t vertex) {
  VertexWords words = kOrigin;
  for (std::size_t i = 0; i < dimensions_; ++i) words[i] = tokens_[i];
  if (is_homogeneous_) words[3] = tokens_[dimensions_];
  const std::optional<Eigen::Vector3d> read = read_position(words, exact_.precision());
  if (!read) return false;
  const Eigen::Vector3d& position = *read;
  if (!position.allFinite()) {
    obj_ += marker_line(known_.faults.size());
    known_.faults.push_back(
        {Errc::kMeshNotFinite, fmt::format("vertex {} (line {}) is not finite: ({}, {}, {})",
                                           vertex, line_, position[0], position[1], position[2])});
    return true;
  }
  append_vertex_line(exact_.add(position), obj_);
  return true;
}

Status OffReader::read_faces() {
  for (std::size_t face = 0; face < faces_; ++face) {
    if (!next_line()) {
      return failure(fmt::format("the file ends after {} of {} faces", face, faces_));
    }
    if (Status status = add_face(); !status.ok()) return status;
  }
  return {};
}

Status OffReader::add_face() {
  const std::optional<long long> count = to_integer(tokens_.front());
  if (!count || *count < 1 || *count >= static_cast<long long>(tokens_.size())) {
    return failure(
        fmt::format("'{}' corners, but {} words follow", tokens_.front(), tokens_.size() - 1));
  }
  // Two corners make a line and one a point, as assimp has it for other formats.
  std::string text = *count == 1 ? "p" : *count == 2 ? "l" : "f";
  std::string fault;
  for (std::size_t corner = 0; corner < static_cast<std::size_t>(*count); ++corner) {
    const std::string_view token = tokens_[corner + 1];
    const std::optional<long long> vertex = to_integer(token);
    const bool is_good = vertex && *vertex >= 0 && *vertex < static_cast<long long>(vertices_);
    const std::size_t marker = *count < 3 ? 1 : vertices_ + face_faults_.size() + 1;
    text += fmt::format(" {}", is_good ? static_cast<std::size_t>(*vertex) + 1 : marker);
    if (is_good || !fault.empty()) continue;
    fault = fmt::format("corner {} (line {}) names vertex {}, but there are {} vertices", corner,
                        line_, token, vertices_);
  }
  obj_ += text + '\n';
  if (fault.empty() || *count < 3) return {};
  face_faults_.push_back(known_.faults.size());
  known_.faults.push_back({Errc::kMeshIndexOutOfRange, std::move(fault)});
  return {};
}

}  // namespace

Result<std::string> obj_from_off(std::string_view off, KnownFaults& known, ExactPositions& exact) {
  return OffReader(off, known, exact).run();
}

}  // namespace boxtree::cooker
