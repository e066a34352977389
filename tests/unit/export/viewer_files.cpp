// SPDX-License-Identifier: MIT
// Two small readers that share nothing with the writers.
#include "viewer_files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <set>
#include <sstream>
#include <stdexcept>

#include "tests/support/temp_folder.h"

namespace boxtree::test {
namespace {

void demand(bool holds, const std::string& what) {
  if (!holds) throw std::runtime_error(what);
}

double number(const std::string& word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  demand(error == std::errc() && end == word.data() + word.size(), "no number: " + word);
  return value;
}

template <class T>
T at(const std::string& bytes, std::size_t offset) {
  T value;
  demand(offset + sizeof(T) <= bytes.size(), "beyond the end");
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

// The binary chunk behind a document, both checked for place, kind and length.
std::string binary_chunk(const std::string& bytes) {
  demand(bytes.substr(0, 4) == "glTF", "magic");
  demand(at<std::uint32_t>(bytes, 4) == 2, "version");
  demand(at<std::uint32_t>(bytes, 8) == bytes.size(), "total length");
  const auto json_length = at<std::uint32_t>(bytes, 12);
  demand(bytes.substr(16, 4) == "JSON" && json_length % 4 == 0, "JSON chunk");
  demand(20 + json_length <= bytes.size(), "JSON length");
  const std::size_t binary = 20 + json_length;
  if (binary == bytes.size()) return {};
  const auto binary_length = at<std::uint32_t>(bytes, binary);
  demand(bytes.substr(binary + 4, 4) == std::string("BIN\0", 4), "BIN chunk");
  demand(binary_length % 4 == 0 && binary + 8 + binary_length == bytes.size(), "BIN length");
  return bytes.substr(binary + 8);
}

class GlbReader {
 public:
  explicit GlbReader(const std::string& bytes)
      : json_(glb_document(bytes)), binary_(binary_chunk(bytes)) {
    demand(json_.at("asset").at("version") == "2.0", "asset version");
    for (const char* array : {"nodes", "meshes", "buffers", "bufferViews", "accessors"}) {
      demand(!json_.contains(array) || !json_[array].empty(), std::string("empty ") + array);
    }
    if (json_.contains("buffers")) {
      demand(json_["buffers"].size() == 1 && json_["buffers"][0]["byteLength"] == binary_.size(),
             "buffer length");
    } else {
      demand(binary_.empty(), "bytes without a buffer");
    }
    check_views();
  }

  std::vector<ViewedPart> parts() {
    const nlohmann::json& scene = json_.at("scenes").at(json_.at("scene").get<std::size_t>());
    for (const auto& root : scene.value("nodes", nlohmann::json::array())) {
      const nlohmann::json& node = json_.at("nodes").at(root.get<std::size_t>());
      walk(node, node, Eigen::Affine3d::Identity());
    }
    demand(seen_.size() == (json_.contains("meshes") ? json_["meshes"].size() : 0), "stray meshes");
    return std::move(parts_);
  }

 private:
  // Views tile the buffer: aligned, in order, nothing between them but padding of zeros.
  void check_views() {
    std::size_t end = 0;
    for (const auto& view : json_.value("bufferViews", nlohmann::json::array())) {
      const std::size_t offset = view.at("byteOffset");
      demand(view.at("buffer") == 0 && offset % 4 == 0, "view alignment");
      check_padding(end, offset);
      end = offset + view.at("byteLength").get<std::size_t>();
      demand(end > offset && end <= binary_.size(), "view bounds");
    }
    check_padding(end, binary_.size());
  }

  void check_padding(std::size_t from, std::size_t to) const {
    demand(from <= to && to - from < 4, "views overlap or leave a gap");
    demand(std::all_of(binary_.begin() + static_cast<std::ptrdiff_t>(from),
                       binary_.begin() + static_cast<std::ptrdiff_t>(to),
                       [](char c) { return c == 0; }),
           "padding");
  }

  // Offset of the elements of an accessor that fills its view.
  std::size_t elements_of(const nlohmann::json& accessor, std::size_t element_bytes, int target) {
    const nlohmann::json& view =
        json_.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    demand(view.at("target") == target, "view target");
    demand(view.at("byteLength") == element_bytes * accessor.at("count").get<std::size_t>(),
           "accessor does not fill its view");
    return view.at("byteOffset");
  }

  void read_vertices(const nlohmann::json& accessor, ViewedPart& part) {
    demand(accessor.at("componentType") == 5126 && accessor.at("type") == "VEC3", "positions");
    const std::size_t offset = elements_of(accessor, 12, 34962);
    Eigen::AlignedBox3d bounds;
    for (std::size_t i = 0; i < accessor.at("count").get<std::size_t>(); ++i) {
      Eigen::Vector3d p;
      for (std::size_t k = 0; k < 3; ++k) {
        p[static_cast<Eigen::Index>(k)] = at<float>(binary_, offset + 12 * i + 4 * k);
      }
      demand(p.allFinite(), "position not finite");
      bounds.extend(p);
      part.vertices.push_back(p);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      demand(accessor.at("min").at(k) == bounds.min()[axis], "min");
      demand(accessor.at("max").at(k) == bounds.max()[axis], "max");
    }
  }

  void read_elements(const nlohmann::json& accessor, std::size_t corners, ViewedPart& part) {
    const bool is_short = accessor.at("componentType") == 5123;
    demand(is_short || accessor.at("componentType") == 5125, "index type");
    demand(accessor.at("type") == "SCALAR", "indices");
    const std::size_t offset = elements_of(accessor, is_short ? 2 : 4, 34963);
    const std::size_t count = accessor.at("count");
    demand(count % corners == 0 && count > 0, "index count");
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t index = is_short ? at<std::uint16_t>(binary_, offset + 2 * i)
                                           : at<std::uint32_t>(binary_, offset + 4 * i);
      demand(index < part.vertices.size(), "index range");
      demand(index != (is_short ? 0xffffu : 0xffffffffu), "index restarts the primitive");
      if (i % corners == 0) part.elements.emplace_back();
      part.elements.back().push_back(index);
    }
  }

  // A matrix, which must be made of a translation, a rotation and a scale, or a translation.
  static Eigen::Affine3d transform_of(const nlohmann::json& node) {
    Eigen::Affine3d transform = Eigen::Affine3d::Identity();
    if (node.contains("translation")) {
      demand(!node.contains("matrix"), "both matrix and translation");
      for (int k = 0; k < 3; ++k) {
        transform.translation()[k] = node["translation"].at(static_cast<std::size_t>(k));
      }
    }
    if (!node.contains("matrix")) return transform;
    demand(node["matrix"].size() == 16, "numbers of a matrix");
    for (int i = 0; i < 16; ++i) {
      transform.matrix()(i % 4, i / 4) = node["matrix"].at(static_cast<std::size_t>(i));
    }
    demand(transform.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1), "last row of a matrix");
    for (int k = 0; k < 3; ++k) {
      const double cosine = transform.linear().col(k).normalized().dot(
          transform.linear().col((k + 1) % 3).normalized());
      demand(std::abs(cosine) < 1e-5, "a matrix that shears");
    }
    return transform;
  }

  void walk(const nlohmann::json& node, const nlohmann::json& root, const Eigen::Affine3d& above) {
    demand(!node.contains("children") || !node["children"].empty(), "empty children");
    const Eigen::Affine3d pose = above * transform_of(node);
    if (node.contains("mesh")) add(root, node, pose);
    for (const auto& child : node.value("children", nlohmann::json::array())) {
      walk(json_.at("nodes").at(child.get<std::size_t>()), root, pose);
    }
  }

  void add(const nlohmann::json& root, const nlohmann::json& node, const Eigen::Affine3d& pose) {
    const std::size_t number = node.at("mesh");
    seen_.insert(number);
    const nlohmann::json& mesh = json_.at("meshes").at(number);
    demand(mesh.at("primitives").size() == 1, "one primitive a mesh");
    const nlohmann::json& primitive = mesh["primitives"][0];
    ViewedPart part;
    part.object = root.at("name");
    part.name = node.at("name");
    part.translation = transform_of(root).translation();
    part.pose = pose;
    part.mesh = number;
    const int mode = primitive.at("mode");
    demand(mode == 1 || mode == 4, "mode");
    part.has_lines = mode == 1;
    demand(primitive.at("material").get<std::size_t>() < json_.at("materials").size(), "material");
    const auto& accessors = json_.at("accessors");
    read_vertices(accessors.at(primitive.at("attributes").at("POSITION").get<std::size_t>()), part);
    read_elements(accessors.at(primitive.at("indices").get<std::size_t>()), mode == 1 ? 2 : 3,
                  part);
    parts_.push_back(std::move(part));
  }

  nlohmann::json json_;
  std::string binary_;
  std::set<std::size_t> seen_;  // meshes
  std::vector<ViewedPart> parts_;
};

}  // namespace

Eigen::AlignedBox3d ViewedPart::box(std::uint64_t i) const {
  Eigen::AlignedBox3d bounds;
  for (std::size_t corner = 0; corner < 8; ++corner) bounds.extend(vertices.at(8 * i + corner));
  return bounds;
}

std::vector<ViewedPart> read_obj(const std::string& text) {
  std::vector<ViewedPart> parts;
  std::string object;
  std::uint32_t first = 1;  // number of the part's first vertex
  std::istringstream lines(text);
  std::string line;
  while (std::getline(lines, line)) {
    const std::string kind = line.substr(0, line.find(' '));
    const std::string rest = kind.size() < line.size() ? line.substr(kind.size() + 1) : "";
    std::istringstream words(rest);
    std::string x, y, z;
    if (kind == "#") continue;
    if (kind == "o") {
      object = rest;
    } else if (kind == "g") {
      if (!parts.empty()) first += static_cast<std::uint32_t>(parts.back().vertices.size());
      parts.emplace_back();
      parts.back().object = object;
      parts.back().name = rest;
    } else if (kind == "v") {
      words >> x >> y >> z;
      parts.at(parts.size() - 1).vertices.emplace_back(number(x), number(y), number(z));
    } else if (kind == "f" || kind == "l") {
      ViewedPart& part = parts.at(parts.size() - 1);
      part.has_lines = kind == "l";
      part.elements.emplace_back();
      for (std::uint32_t corner = 0; words >> corner;) {
        demand(corner >= first && corner - first < part.vertices.size(), "corner: " + line);
        part.elements.back().push_back(corner - first);
      }
      demand(words.eof(), "corners: " + line);
    } else {
      demand(false, "statement: " + line);
    }
  }
  return parts;
}

nlohmann::json glb_document(const std::string& bytes) {
  return nlohmann::json::parse(bytes.substr(20, at<std::uint32_t>(bytes, 12)));
}

std::vector<ViewedPart> read_glb(const std::string& bytes) {
  return GlbReader(bytes).parts();
}

std::vector<ViewedPart> read_viewer_file(const std::filesystem::path& path) {
  const std::string bytes = read_text(path);
  return path.extension() == ".glb" ? read_glb(bytes) : read_obj(bytes);
}

}  // namespace boxtree::test
