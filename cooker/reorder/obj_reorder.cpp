// SPDX-License-Identifier: MIT
// Writes an OBJ file: first all that is no element, in the order of the source, then the faces in
// the order of the tree, then lines and points. Statements that hold for the elements after them
// are repeated where they change.
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "cooker/import/face_materials.h"
#include "cooker/import/obj_statements.h"
#include "cooker/import/source_mesh.h"
#include "cooker/import/text_tokens.h"
#include "cooker/reorder/reorder.h"
#include "cooker/system/path.h"

namespace boxtree::cooker {
namespace {

// Statements that hold for all elements after them, and what brings back the state before the
// first. A material cannot be turned off; readers take a name that no library has for the default.
struct StateKeyword {
  std::string_view keyword;
  std::string_view reset;
};
constexpr std::array kStateKeywords = {
    StateKeyword{"o", "o default"},
    StateKeyword{"g", "g default"},
    StateKeyword{"s", "s off"},
    StateKeyword{"mg", "mg off"},
    StateKeyword{"usemtl", "usemtl DefaultMaterial"},
    StateKeyword{"usemap", "usemap off"},
    StateKeyword{"bevel", "bevel off"},
    StateKeyword{"c_interp", "c_interp off"},
    StateKeyword{"d_interp", "d_interp off"},
    StateKeyword{"lod", "lod 0"},
};
static_assert(kStateKeywords[4].reset.substr(7) == kDefaultMaterial);

// For each of these, a number of a text; 0 before the first statement.
using State = std::array<std::uint32_t, kStateKeywords.size()>;

// Vertices, texture coordinates and normals before an element: negative numbers count from there.
using ElementCounts = std::array<std::uint64_t, 3>;

std::string_view keyword_of(std::string_view statement) {
  return statement.substr(0, statement.find_first_of(" \t\\\r\n"));
}

class ObjReorder {
 public:
  ObjReorder(const Reordering& reordering, ByteSink& out)
      : reordering_(reordering), text_(statements_of(reordering.text)), out_(out) {}

  Status run() {
    scan();
    for (const SourceCorners& face : reordering_.faces) {
      if (face.polygon >= polygons_.size()) return has_changed("it has fewer faces");
      if (Status status = write_face(polygons_[face.polygon], face); !status) return status;
    }
    for (const Element& element : others_) write_other(element);
    return {};
  }

 private:
  struct Element {
    std::string_view text;
    std::uint32_t state;   // in states_
    std::uint32_t counts;  // in counts_
  };

  // Writes what is no element and keeps the elements.
  void scan() {
    const char* kept = text_.data();  // from here on nothing is written yet
    bool is_kept = true;              // whether the statement that begins there is
    ObjStatement statement{};
    for (ObjStatements statements(text_); statements.next(statement);) {
      const char* const begin = statement.text.data();
      const bool keep = take(statement);
      if (keep == is_kept) continue;
      if (is_kept) write_text({kept, static_cast<std::size_t>(begin - kept)});
      kept = begin;
      is_kept = keep;
    }
    const char* const end = text_.data() + text_.size();
    if (is_kept) write_text({kept, static_cast<std::size_t>(end - kept)});
    end_line();
  }

  // Whether a statement stays where it is.
  bool take(const ObjStatement& statement) {
    if (statement.is_element()) {
      take_element(statement.text);
      return false;
    }
    const std::string_view keyword = keyword_of(statement.text);
    if (keyword == "v") ++counted_[0];
    if (keyword == "vt") ++counted_[1];
    if (keyword == "vn") ++counted_[2];
    for (std::size_t i = 0; i < kStateKeywords.size(); ++i) {
      if (keyword != kStateKeywords[i].keyword) continue;
      set_state(i, joined_text(statement, joined_));
      return false;
    }
    if (keyword != "mtllib" || reordering_.way().empty()) return true;
    libraries_.emplace_back(without_blanks(joined_text(statement, joined_).substr(keyword.size())));
    return false;
  }

  void set_state(std::size_t keyword, std::string_view text) {
    const auto next = static_cast<std::uint32_t>(texts_.size());
    const auto [place, is_new] = number_of_text_.try_emplace(std::string(text), next);
    if (is_new) texts_.push_back(place->first);
    state_[keyword] = place->second;
  }

  void take_element(std::string_view text) {
    if (states_.empty() || states_.back() != state_) states_.push_back(state_);
    if (counts_.empty() || counts_.back() != counted_) counts_.push_back(counted_);
    const Element element{text, static_cast<std::uint32_t>(states_.size() - 1),
                          static_cast<std::uint32_t>(counts_.size() - 1)};
    bool is_polygon = text[0] == 'f';
    if (is_polygon) {
      split(element);
      is_polygon = words_.size() >= 3;
    }
    (is_polygon ? polygons_ : others_).push_back(element);
  }

  // The words of an element after its keyword.
  void split(const Element& element) {
    split_tokens(joined_text({element.text, 0}, joined_), words_);
    words_.erase(words_.begin());
  }

  Status write_face(const Element& polygon, const SourceCorners& face) {
    split(polygon);
    set(states_[polygon.state]);
    out_.print("f");
    for (const std::uint32_t corner : face.corner) {
      if (corner == kNoCorner) continue;
      if (corner >= words_.size()) return has_changed("a face has fewer corners");
      write_corner(words_[corner], counts_[polygon.counts]);
    }
    out_.print("\n");
    return {};
  }

  void write_other(const Element& element) {
    split(element);
    set(states_[element.state]);
    out_.print("{}", element.text.substr(0, 1));
    for (const std::string_view word : words_) write_corner(word, counts_[element.counts]);
    out_.print("\n");
  }

  // A corner, its numbers counted from the first of the file: 7, 7/1, 7//2, 7/1/2.
  void write_corner(std::string_view word, const ElementCounts& counts) {
    if (word.find('-') == std::string_view::npos) {
      out_.print(" {}", word);
      return;
    }
    out_.print(" ");
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const std::size_t slash = word.find('/');
      const std::string_view part = word.substr(0, slash);
      const std::int64_t number = read_integer(part).value_or(0);
      if (number < 0) {
        out_.print("{}", static_cast<std::int64_t>(counts[i]) + 1 + number);
      } else {
        out_.print("{}", part);
      }
      if (slash == std::string_view::npos) return;
      out_.print("/");
      word.remove_prefix(slash + 1);
    }
  }

  // Writes the statements that lead to a state.
  void set(const State& state) {
    for (std::size_t i = 0; i < state.size(); ++i) {
      if (state[i] == written_[i]) continue;
      out_.print("{}\n", state[i] == 0 ? kStateKeywords[i].reset : texts_[state[i]]);
    }
    written_ = state;
  }

  void write_text(std::string_view text) {
    if (text.empty()) return;
    out_.write(std::as_bytes(std::span(text)));
    ends_line_ = text.back() == '\n' || text.back() == '\r';
  }

  // Ends the text before the first face, and names the libraries that are in another folder.
  void end_line() {
    if (!ends_line_) out_.print("\n");
    for (const std::string& names : libraries_) {
      // One name with blanks, or several names.
      std::error_code ignored;
      if (std::filesystem::is_regular_file(
              status_of(reordering_.from / named_path(names), ignored))) {
        out_.print("mtllib {}\n", reordering_.moved(names));
        continue;
      }
      split_tokens(names, words_);
      for (const std::string_view name : words_) {
        out_.print("mtllib {}\n", reordering_.moved(std::string(name)));
      }
    }
  }

  const Reordering& reordering_;
  const std::string_view text_;
  ByteSink& out_;
  std::vector<Element> polygons_;  // three corners or more, by their number in the source
  std::vector<Element> others_;
  std::vector<State> states_;
  std::vector<ElementCounts> counts_;
  State state_{};
  State written_{};
  ElementCounts counted_{};
  std::vector<std::string_view> texts_ = {{}};  // of statements; the first stands for none
  std::unordered_map<std::string, std::uint32_t> number_of_text_;
  std::vector<std::string> libraries_;
  bool ends_line_ = true;
  std::string joined_;
  Tokens words_;
};

}  // namespace

Status reorder_obj(const Reordering& reordering, ByteSink& out) {
  return ObjReorder(reordering, out).run();
}

}  // namespace boxtree::cooker
