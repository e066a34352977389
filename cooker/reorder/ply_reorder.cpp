// SPDX-License-Identifier: MIT
// Writes a PLY file whose records of faces are in another order; all other bytes stay.
#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/ply_layout.h"
#include "cooker/import/source_mesh.h"
#include "cooker/import/text_tokens.h"
#include "cooker/reorder/reorder.h"

namespace boxtree::cooker {
namespace {

// Lists of faces with as many numbers for each corner of the face.
bool is_per_corner(const PlyProperty& property) {
  return property.name == "texcoord" || property.name == "color";
}

// Corners that a record has: those of a triangle or quad, or of a part of a polygon.
class Corners {
 public:
  explicit Corners(const SourceCorners& face) : corner_(face.corner) {
    count_ = corner_[3] == kNoCorner ? 3 : 4;
  }
  [[nodiscard]] std::size_t size() const { return count_; }
  [[nodiscard]] std::uint32_t operator[](std::size_t i) const { return corner_[i]; }
  /// Whether they are all `count` corners of a polygon, in order.
  [[nodiscard]] bool are_all(std::size_t count) const {
    if (count != count_) return false;
    for (std::size_t i = 0; i < count; ++i) {
      if (corner_[i] != i) return false;
    }
    return true;
  }
  [[nodiscard]] bool are_below(std::size_t count) const {
    return std::all_of(corner_.begin(), corner_.begin() + static_cast<std::ptrdiff_t>(count_),
                       [count](std::uint32_t corner) { return corner < count; });
  }

 private:
  std::array<std::uint32_t, 4> corner_;
  std::size_t count_;
};

// Splits the body into elements and records. Import has read it before, so a record that is not
// there means that the file has changed.
class Body {
 public:
  virtual ~Body() = default;
  /// The next record; without data if there is none.
  virtual std::string_view next(const PlyElement& element) = 0;
  /// The length of a list of the last record.
  [[nodiscard]] virtual std::size_t length_of(const PlyElement& element,
                                              const PlyProperty& list) const = 0;
  /// A record like `record`, but with these corners alone.
  virtual void write_part(const PlyLayout& layout, std::string_view record, const Corners& corners,
                          ByteSink& out) = 0;
  /// What follows the last record.
  [[nodiscard]] std::string_view rest() const { return rest_; }

 protected:
  explicit Body(std::string_view bytes) : rest_(bytes) {}

  std::string_view rest_;
};

// How many numbers of a list belong to each corner of a polygon with `corners` of them; 0: the list
// is not one of corners.
std::size_t numbers_per_corner(const PlyLayout& layout, const PlyProperty& list, std::size_t length,
                               std::size_t corners) {
  if (&list == layout.corners) return 1;
  const bool is_split = is_per_corner(list) && corners > 0 && length % corners == 0;
  return is_split ? length / corners : 0;
}

class TextBody final : public Body {
 public:
  explicit TextBody(std::string_view bytes) : Body(bytes) {}

  std::string_view next(const PlyElement& element) override {
    const std::string_view from = rest_;
    if (element.properties.empty()) return from.substr(0, 0);
    while (!rest_.empty()) {
      split_tokens(take_line(rest_), words_);
      if (!words_.empty()) return from.substr(0, from.size() - rest_.size());
    }
    return {};
  }

  [[nodiscard]] std::size_t length_of(const PlyElement& element,
                                      const PlyProperty& list) const override {
    std::size_t length = 0;
    visit(element, [&](const PlyProperty& property, std::size_t, std::size_t count) {
      if (&property == &list) length = count;
    });
    return length;
  }

  void write_part(const PlyLayout& layout, std::string_view record, const Corners& corners,
                  ByteSink& out) override {
    split_tokens(record, words_);
    const std::size_t all = length_of(*layout.face, *layout.corners);
    const char* blank = "";
    const auto put = [&](std::string_view word) {
      out.print("{}{}", blank, word);
      blank = " ";
    };
    visit(*layout.face, [&](const PlyProperty& property, std::size_t at, std::size_t count) {
      const std::size_t each =
          property.length ? numbers_per_corner(layout, property, count, all) : 0;
      if (property.length) put(std::to_string(each == 0 ? count : each * corners.size()));
      if (each == 0) {
        for (std::size_t i = 0; i < count; ++i) put(words_[at + i]);
        return;
      }
      for (std::size_t i = 0; i < corners.size(); ++i) {
        for (std::size_t k = 0; k < each; ++k) put(words_[at + corners[i] * each + k]);
      }
    });
    out.print("\n");
  }

 private:
  // Calls `use` with each property of the last record, its first word and how many it has.
  template <class Use>
  void visit(const PlyElement& element, const Use& use) const {
    std::size_t at = 0;
    for (const PlyProperty& property : element.properties) {
      std::size_t count = 1;
      if (property.length) {
        count =
            static_cast<std::size_t>(at < words_.size() ? read_count(words_[at]).value_or(0) : 0);
        ++at;
      }
      if (at > words_.size() || count > words_.size() - at) return;
      use(property, at, count);
      at += count;
    }
  }

  Tokens words_;  // of the last record
};

class BinaryBody final : public Body {
 public:
  BinaryBody(std::string_view bytes, bool is_big_endian)
      : Body(bytes), swapped_(is_big_endian == (std::endian::native == std::endian::little)) {}

  std::string_view next(const PlyElement& element) override {
    record_ = rest_;
    std::size_t size = 0;
    const bool is_whole =
        visit(element, [&](const PlyProperty& property, std::size_t at, std::size_t count) {
          size = at + count * size_of(property.type);
        });
    if (!is_whole) return {};
    record_ = rest_.substr(0, size);
    rest_.remove_prefix(size);
    return record_;
  }

  [[nodiscard]] std::size_t length_of(const PlyElement& element,
                                      const PlyProperty& list) const override {
    std::size_t length = 0;
    visit(element, [&](const PlyProperty& property, std::size_t, std::size_t count) {
      if (&property == &list) length = count;
    });
    return length;
  }

  void write_part(const PlyLayout& layout, std::string_view record, const Corners& corners,
                  ByteSink& out) override {
    record_ = record;
    const std::size_t all = length_of(*layout.face, *layout.corners);
    visit(*layout.face, [&](const PlyProperty& property, std::size_t at, std::size_t count) {
      const std::size_t size = size_of(property.type);
      const std::size_t each =
          property.length ? numbers_per_corner(layout, property, count, all) : 0;
      if (property.length) {
        put_integer(each == 0 ? count : each * corners.size(), *property.length, out);
      }
      if (each == 0) {
        put(record.substr(at, count * size), out);
        return;
      }
      for (std::size_t i = 0; i < corners.size(); ++i) {
        put(record.substr(at + corners[i] * each * size, each * size), out);
      }
    });
  }

 private:
  // Calls `use` with each property of the record, where its values begin and how many it has. False
  // if the record is not whole.
  template <class Use>
  bool visit(const PlyElement& element, const Use& use) const {
    std::size_t at = 0;
    for (const PlyProperty& property : element.properties) {
      std::size_t count = 1;
      if (property.length) {
        const std::size_t size = size_of(*property.length);
        if (record_.size() - at < size) return false;
        const std::int64_t stated =
            load_ply_integer(record_.data() + at, *property.length, swapped_);
        at += size;
        if (stated < 0) return false;
        count = static_cast<std::size_t>(stated);
      }
      const std::size_t size = size_of(property.type);
      if (count > (record_.size() - at) / size) return false;
      use(property, at, count);
      at += count * size;
    }
    return true;
  }

  static void put(std::string_view bytes, ByteSink& out) {
    out.write(std::as_bytes(std::span(bytes)));
  }

  void put_integer(std::size_t value, PlyType type, ByteSink& out) const {
    std::array<char, sizeof(std::uint64_t)> bytes{};
    const std::size_t size = size_of(type);
    for (std::size_t i = 0; i < size; ++i) {
      bytes[i] = static_cast<char>(value >> (8 * i) & 0xffu);
    }
    const bool is_big_endian = swapped_ == (std::endian::native == std::endian::little);
    if (is_big_endian)
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    put({bytes.data(), size}, out);
  }

  const bool swapped_;
  std::string_view record_;  // the last record
};

class PlyReorder {
 public:
  PlyReorder(const Reordering& reordering, const PlyLayout& layout, Body& body, ByteSink& out)
      : reordering_(reordering), layout_(layout), body_(body), out_(out) {}

  Status run() {
    // The header states how many records of faces there are, so they are read before it is written.
    const char* const begin = reordering_.text.data() + layout_.header.bytes;
    const char* faces_begin = nullptr;
    const char* faces_end = nullptr;
    for (const PlyElement& element : layout_.header.elements) {
      if (&element == layout_.face) faces_begin = body_.rest().data();
      for (std::uint64_t i = 0; i < element.count; ++i) {
        const std::string_view record = body_.next(element);
        if (record.data() == nullptr) return has_changed("it ends early");
        if (&element == layout_.face) take(record);
        if (record.empty() && element.properties.empty()) break;  // no bytes, whatever the count
      }
      if (&element == layout_.face) faces_end = body_.rest().data();
    }
    const char* const end = reordering_.text.data() + reordering_.text.size();
    write_header();
    write({begin, static_cast<std::size_t>(faces_begin - begin)});
    if (Status status = write_faces(); !status) return status;
    write({faces_end, static_cast<std::size_t>(end - faces_end)});
    return {};
  }

 private:
  void take(std::string_view record) {
    const std::size_t corners = body_.length_of(*layout_.face, *layout_.corners);
    if (corners < 3) {
      others_.push_back(record);
      return;
    }
    polygons_.push_back(record);
    corners_.push_back(corners);
  }

  void write_header() {
    std::string_view rest = reordering_.text.substr(0, layout_.header.bytes);
    Tokens words;
    while (!rest.empty()) {
      const std::string_view from = rest;
      const std::string_view line = take_line(rest);
      split_tokens(line, words);
      if (words.size() != 3 || words[0] != "element" || words[1] != "face") {
        write(from.substr(0, from.size() - rest.size()));
        continue;
      }
      out_.print("element face {}", reordering_.faces.size() + others_.size());
      write(from.substr(line.size(), from.size() - rest.size() - line.size()));
    }
  }

  Status write_faces() {
    for (const SourceCorners& face : reordering_.faces) {
      if (face.polygon >= polygons_.size()) return has_changed("it has fewer faces");
      const std::string_view record = polygons_[face.polygon];
      const Corners corners(face);
      if (!corners.are_below(corners_[face.polygon])) {
        return has_changed("a face has fewer corners");
      }
      if (corners.are_all(corners_[face.polygon])) {
        write_record(record);
      } else {
        body_.write_part(layout_, record, corners, out_);
      }
    }
    for (const std::string_view record : others_) write_record(record);
    return {};
  }

  // The last line of a text may have no end.
  void write_record(std::string_view record) {
    write(record);
    const bool is_text = layout_.header.form == PlyHeader::Form::kText;
    if (is_text && record.back() != '\n' && record.back() != '\r') out_.print("\n");
  }

  void write(std::string_view bytes) { out_.write(std::as_bytes(std::span(bytes))); }

  const Reordering& reordering_;
  const PlyLayout& layout_;
  Body& body_;
  ByteSink& out_;
  std::vector<std::string_view> polygons_;  // records of three corners or more, by their number
  std::vector<std::size_t> corners_;        // how many each of these has
  std::vector<std::string_view> others_;
};

}  // namespace

Status reorder_ply(const Reordering& reordering, ByteSink& out) {
  Result<PlyHeader> header = read_ply_header(reordering.text);
  if (!header) return header.error();
  PlyLayout layout;
  layout.header = std::move(*header);
  if (Status status = find_ply_parts(layout); !status) return status;
  if (layout.tristrips != nullptr && layout.tristrips->count > 0) {
    return Error{Errc::kMeshUnsupported,
                 "its triangles are in strips (element tristrips), which have an order of their "
                 "own: write it with an element face"};
  }
  const std::string_view bytes = reordering.text.substr(layout.header.bytes);
  if (layout.header.form == PlyHeader::Form::kText) {
    TextBody body(bytes);
    return PlyReorder(reordering, layout, body, out).run();
  }
  BinaryBody body(bytes, layout.header.form == PlyHeader::Form::kBigEndian);
  return PlyReorder(reordering, layout, body, out).run();
}

}  // namespace boxtree::cooker
