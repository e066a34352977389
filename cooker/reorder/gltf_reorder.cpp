// SPDX-License-Identifier: MIT
// Reorders the triangles of a glTF 2.0 file: three vertex numbers each, of the only primitive of
// triangles. Numbers of a .glb that nothing else uses are reordered in place, so no other byte
// changes; others get a new accessor.
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/glb.h"
#include "cooker/import/gltf_document.h"
#include "cooker/import/gltf_nesting.h"
#include "cooker/import/gltf_numbers.h"
#include "cooker/import/whole_file.h"
#include "cooker/reorder/reorder.h"
#include "cooker/system/path.h"
#include "cooker/text/json.h"
#include "cooker/text/percent.h"

namespace boxtree::cooker {
namespace {

constexpr std::uint64_t kNone = std::numeric_limits<std::uint64_t>::max();

bool is_array(const Json& object, std::string_view key) {
  const Json* const found = object.find(key);
  return found != nullptr && found->is_array();
}

// An object of one of the document's arrays; null if it is not there.
const Json* object_of(const Json& document, const char* array, std::uint64_t number) {
  const Json& object = element_at(array_at(document, array), number);
  return object.is_object() ? &object : nullptr;
}

// How many members of that name anywhere in a document are that number. As deep as JSON may be.
std::size_t times_named(const Json& value, const char* name, std::uint64_t number) {
  std::size_t times = number_at(value, name, kNone) == number ? 1 : 0;
  for (const Json::Member& member : value.items()) times += times_named(member.value, name, number);
  if (value.is_array()) {
    for (const Json& element : value) times += times_named(element, name, number);
  }
  return times;
}

std::size_t bytes_of_index(std::uint64_t component) {
  if (component == kUnsignedByte) return 1;
  if (component == kUnsignedShort) return 2;
  return component == kUnsignedInt ? 4 : 0;
}

Error unsupported(std::string why) {
  return {Errc::kMeshUnsupported, std::move(why)};
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

// The bytes of a data URI in base64; empty if it is none.
std::optional<std::string> data_of(std::string_view uri) {
  constexpr std::string_view kMark = ";base64,";
  const std::size_t mark = uri.find(kMark);
  if (!uri.starts_with("data:") || mark == std::string_view::npos) return std::nullopt;
  std::string bytes;
  std::uint32_t group = 0;
  unsigned bits = 0;
  for (const char c : uri.substr(mark + kMark.size())) {
    std::uint32_t digit = 0;
    if (c >= 'A' && c <= 'Z') {
      digit = static_cast<std::uint32_t>(c - 'A');
    } else if (c >= 'a' && c <= 'z') {
      digit = static_cast<std::uint32_t>(c - 'a') + 26;
    } else if (c >= '0' && c <= '9') {
      digit = static_cast<std::uint32_t>(c - '0') + 52;
    } else if (c == '+' || c == '/') {
      digit = c == '+' ? 62 : 63;
    } else {
      break;  // padding
    }
    group = group << 6 | digit;
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(group >> bits & 0xffu);
  }
  return bytes;
}

class GltfReorder {
 public:
  GltfReorder(const Reordering& reordering, bool is_binary, ByteSink& out)
      : reordering_(reordering), is_binary_(is_binary), out_(out) {}

  Status run() {
    if (Status status = read(); !status) return status;
    if (Status status = find_triangles(); !status) return status;
    if (Status status = read_numbers(); !status) return status;
    if (Status status = reorder(); !status) return status;
    const bool have_moved = move_references();
    if (is_binary_ && !have_moved && has_place_of_its_own()) {
      std::string file(reordering_.text);
      file.replace(static_cast<std::size_t>(binary_.data() - reordering_.text.data()) + offset_,
                   numbers_.size(), numbers_);
      write(file);
      return {};
    }
    add_accessor();
    return is_binary_ ? write_glb() : (write(document_.dump(2) + "\n"), Status());
  }

 private:
  Status read() {
    std::string_view json = reordering_.text;
    if (is_binary_) {
      json = glb_json(reordering_.text);
      std::array<std::uint32_t, 3> header{};
      if (json.empty()) return has_changed("it is no GLB");
      std::memcpy(header.data(), reordering_.text.data(), sizeof(header));
      if (header[0] != kGlbMagic || header[1] != kGlbVersion) {
        return unsupported("glTF 2.0 alone is written");
      }
      std::string_view rest = reordering_.text.substr(
          static_cast<std::size_t>(json.data() - reordering_.text.data()) + json.size());
      std::array<std::uint32_t, 2> chunk{};
      if (rest.size() >= kChunkHeaderBytes) std::memcpy(chunk.data(), rest.data(), sizeof(chunk));
      if (chunk[1] == kBinaryChunk) binary_ = rest.substr(kChunkHeaderBytes, chunk[0]);
    }
    Result<Json> document = parse_gltf(json);
    if (!document) return document.error();
    document_ = std::move(*document);
    const Json* const asset = document_.find("asset");
    if (asset == nullptr || !asset->is_object()) return has_changed("it is no glTF");
    const Json* const version = asset->find("version");
    const bool is_2 =
        version != nullptr && version->is_string() && version->get<std::string>().starts_with("2.");
    return is_2 ? Status() : unsupported("glTF 2.0 alone is written");
  }

  Status find_triangles() {
    if (!is_array(document_, "meshes")) return has_changed("it has no meshes");
    std::size_t count = 0;
    for (Json& mesh : document_["meshes"]) {
      if (!is_array(mesh, "primitives")) continue;
      for (Json& primitive : mesh["primitives"]) {
        const std::uint64_t mode = number_at(primitive, "mode", kModeTriangles);
        if (mode < kModeTriangles || mode > kModeTriangleFan) continue;
        if (mode != kModeTriangles) {
          return unsupported(
              "its triangles are in strips or fans, which have an order of their own: write it "
              "with triangles (mode 4)");
        }
        const Json* const extensions = primitive.find("extensions");
        if (extensions != nullptr && extensions->contains("KHR_draco_mesh_compression")) {
          return unsupported("a primitive is compressed (KHR_draco_mesh_compression)");
        }
        primitive_ = &primitive;
        ++count;
      }
    }
    if (count == 1) return {};
    return unsupported(fmt::format(
        "it has {} primitives of triangles; in glTF a triangle has a number within its primitive, "
        "so one order for all needs one primitive: join them, convert the mesh to OBJ, or keep "
        "face ids",
        count));
  }

  // The vertex numbers of all triangles.
  Status read_numbers() {
    const std::uint64_t accessor_number = number_at(*primitive_, "indices", kNone);
    if (accessor_number == kNone) return count_numbers();
    const Json* const accessor = object_of(document_, "accessors", accessor_number);
    if (accessor == nullptr) return has_changed("an accessor is missing");
    component_ = number_at(*accessor, "componentType", 0);
    const Json* const view =
        object_of(document_, "bufferViews", number_at(*accessor, "bufferView", kNone));
    if (accessor->contains("sparse") || view == nullptr || view->contains("extensions") ||
        bytes_of_index(component_) == 0) {
      return unsupported("the numbers of the vertices are sparse or compressed");
    }
    offset_ = number_at(*view, "byteOffset", 0) + number_at(*accessor, "byteOffset", 0);
    const std::uint64_t count = number_at(*accessor, "count", 0) / 3 * 3;
    buffer_ = number_at(*view, "buffer", kNone);
    const Json* const buffer = object_of(document_, "buffers", buffer_);
    if (buffer == nullptr) return has_changed("a buffer is missing");
    std::string bytes;
    std::string_view source = binary_;
    if (const Json* const named = buffer->find("uri")) {
      if (!named->is_string()) return has_changed("a buffer is missing");
      const auto uri = named->get<std::string>();
      if (const auto data = data_of(uri)) {
        bytes = *data;
      } else {
        Result<std::string> file =
            read_whole_file(reordering_.from / named_path(percent_decoded(uri)), kAnyBytes);
        if (!file) return file.error();
        bytes = std::move(*file);
      }
      source = bytes;
    }
    const std::uint64_t size = count * bytes_of_index(component_);
    if (offset_ > source.size() || size > source.size() - offset_) {
      return has_changed("a buffer is too short");
    }
    numbers_ = source.substr(offset_, size);
    return {};
  }

  // Without numbers, each three vertices in turn are a triangle.
  Status count_numbers() {
    const Json* const attributes = primitive_->find("attributes");
    const Json* const positions =
        attributes == nullptr
            ? nullptr
            : object_of(document_, "accessors", number_at(*attributes, "POSITION", kNone));
    if (positions == nullptr) return has_changed("a primitive has no positions");
    const std::uint64_t vertices = number_at(*positions, "count", 0);
    if (vertices / 3 < reordering_.faces.size()) return has_changed("it has fewer triangles");
    component_ = kUnsignedInt;
    for (std::uint64_t i = 0; i < vertices / 3 * 3; ++i) {
      const auto number = static_cast<std::uint32_t>(i);
      std::array<char, sizeof(number)> bytes{};
      std::memcpy(bytes.data(), &number, sizeof(number));
      numbers_.append(bytes.data(), bytes.size());
    }
    return {};
  }

  Status reorder() {
    const std::size_t triangle = 3 * bytes_of_index(component_);
    if (numbers_.size() / triangle < reordering_.faces.size()) {
      return unsupported("its triangles are placed more than once: give each placement a mesh");
    }
    std::string reordered;
    reordered.reserve(numbers_.size());
    for (const SourceCorners& face : reordering_.faces) {
      const std::size_t at = face.polygon * triangle;
      if (at >= numbers_.size()) {
        return unsupported("its triangles are placed more than once: give each placement a mesh");
      }
      reordered.append(numbers_, at, triangle);
    }
    numbers_ = std::move(reordered);
    return {};
  }

  // Whether the numbers may be changed where they are: nothing else names or overlaps their view
  // (sparse accessors, images, extensions), all are written, and they are in the file.
  [[nodiscard]] bool has_place_of_its_own() const {
    const std::uint64_t used = number_at(*primitive_, "indices", kNone);
    if (used == kNone || buffer_ != 0 || !first_buffer_is_chunk()) return false;
    const Json& accessor = document_["accessors"][used];
    if (number_at(accessor, "count", 0) != 3 * reordering_.faces.size()) return false;
    const std::uint64_t view = number_at(accessor, "bufferView", kNone);
    if (times_named(document_, "bufferView", view) != 1) return false;
    const Json& views = document_["bufferViews"];
    for (const Json& other : views) {
      if (&other == &views[view]) continue;
      if (other.contains("extensions")) return false;  // which may name bytes in another way
      const std::uint64_t begin = number_at(other, "byteOffset", 0);
      const std::uint64_t bytes = number_at(other, "byteLength", 0);
      const bool is_apart =
          begin >= offset_ + numbers_.size() || bytes <= offset_ - std::min(offset_, begin);
      if (number_at(other, "buffer", kNone) == buffer_ && !is_apart) return false;
    }
    return times_named(document_, "indices", used) == 1;  // by no other primitive
  }

  [[nodiscard]] bool first_buffer_is_chunk() const {
    const Json* const buffer = object_of(document_, "buffers", 0);
    return buffer != nullptr && !buffer->contains("uri");
  }

  // A buffer view and an accessor for the numbers, at the end of the binary chunk or in a buffer of
  // their own.
  void add_accessor() {
    const auto append = [this](const char* array, Json object) -> std::uint64_t {
      document_[array].push_back(std::move(object));
      return document_[array].size() - 1;
    };
    std::uint64_t buffer = 0;
    std::uint64_t offset = 0;
    if (is_binary_ && !binary_.empty() && first_buffer_is_chunk()) {
      appended_at_ = offset = chunk_bytes(binary_.size());
      document_["buffers"][0]["byteLength"] = offset + numbers_.size();
    } else {
      buffer =
          append("buffers", {{"byteLength", numbers_.size()},
                             {"uri", "data:application/octet-stream;base64," + base64(numbers_)}});
    }
    const std::uint64_t view = append("bufferViews", {{"buffer", buffer},
                                                      {"byteOffset", offset},
                                                      {"byteLength", numbers_.size()},
                                                      {"target", kElementArrayBuffer}});
    const std::uint64_t accessor =
        append("accessors", {{"bufferView", view},
                             {"componentType", component_},
                             {"count", numbers_.size() / bytes_of_index(component_)},
                             {"type", "SCALAR"}});
    (*primitive_)["indices"] = accessor;
  }

  // References to buffers and images are relative to the folder of the file. Whether any changed.
  bool move_references() {
    bool has_moved = false;
    const std::string way = percent_encoded(reordering_.way());
    if (way.empty()) return false;
    for (const char* array : {"buffers", "images"}) {
      if (!is_array(document_, array)) continue;
      for (Json& object : document_[array]) {
        const Json* const named = object.find("uri");
        if (named == nullptr || !named->is_string()) continue;
        const auto uri = named->get<std::string>();
        const std::size_t colon = uri.find(':');  // of a scheme, if no slash comes before it
        if (uri.starts_with('/') || colon < uri.find('/')) continue;
        object["uri"] = way + uri;
        has_moved = true;
      }
    }
    return has_moved;
  }

  Status write_glb() {
    std::string json = document_.dump();
    json.resize(chunk_bytes(json.size()), ' ');
    std::string chunk(binary_);
    if (appended_at_) {
      chunk.resize(*appended_at_);
      chunk += numbers_;
      chunk.resize(chunk_bytes(chunk.size()));
    }
    const std::uint64_t bytes = kGlbHeaderBytes + kChunkHeaderBytes + json.size() +
                                (chunk.empty() ? 0 : kChunkHeaderBytes + chunk.size());
    if (bytes > std::numeric_limits<std::uint32_t>::max()) {
      return Error{Errc::kMeshTooLarge, "more than the 4 GiB that a GLB holds"};
    }
    out_.put(std::array{kGlbMagic, kGlbVersion, static_cast<std::uint32_t>(bytes)});
    out_.put(std::array{static_cast<std::uint32_t>(json.size()), kJsonChunk});
    write(json);
    if (chunk.empty()) return {};
    out_.put(std::array{static_cast<std::uint32_t>(chunk.size()), kBinaryChunk});
    write(chunk);
    return {};
  }

  void write(std::string_view bytes) { out_.write(std::as_bytes(std::span(bytes))); }

  const Reordering& reordering_;
  const bool is_binary_;
  ByteSink& out_;
  Json document_;
  std::string_view binary_;      // the chunk of a .glb
  Json* primitive_ = nullptr;    // in document_
  std::string numbers_;          // of the vertices of all triangles
  std::uint64_t component_ = 0;  // their type
  std::uint64_t buffer_ = kNone;
  std::uint64_t offset_ = 0;  // of the source's numbers in its buffer
  std::optional<std::size_t> appended_at_;
};

}  // namespace

Status reorder_gltf(const Reordering& reordering, bool is_binary, ByteSink& out) {
  return GltfReorder(reordering, is_binary, out).run();
}

}  // namespace boxtree::cooker
