// SPDX-License-Identifier: MIT
// Plans the file first, because the JSON precedes the bytes that it describes; then streams it.
#include "cooker/export/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>

#include "cooker/export/placed_shape.h"
#include "cooker/import/gltf_numbers.h"
#include "cooker/text/json.h"
#include "cooker/version.h"
#include "cooker/write/byte_sink.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

using Position = std::array<float, 3>;

// The largest number of each index type restarts primitives and may not be used.
constexpr std::uint64_t kMaxShortVertices = 0xffff;
constexpr std::uint64_t kMaxVertexCount = 0xffffffff;

// A material per use: triangles, leaves, or a level.
constexpr int kTriangleMaterial = -2;
constexpr int kLeafMaterial = -1;

// One mesh with one primitive: its place in the buffer and the values of its accessors.
struct GlbPart {
  const BoxGroup* group = nullptr;  // null: the triangles
  std::uint64_t vertex_count = 0;
  std::uint64_t index_count = 0;
  Position low{};
  Position high{};
  std::uint64_t offset = 0;  // of positions; indices follow

  [[nodiscard]] bool has_short_indices() const { return vertex_count <= kMaxShortVertices; }
  [[nodiscard]] std::uint64_t position_bytes() const { return vertex_count * sizeof(Position); }
  [[nodiscard]] std::uint64_t index_bytes() const {
    return index_count * (has_short_indices() ? sizeof(std::uint16_t) : sizeof(std::uint32_t));
  }
  [[nodiscard]] std::uint64_t end() const {
    return chunk_bytes(offset + position_bytes() + index_bytes());
  }
  [[nodiscard]] std::string name() const { return group == nullptr ? "triangles" : group->name(); }
  [[nodiscard]] int material() const {
    if (group == nullptr) return kTriangleMaterial;
    return group->level ? static_cast<int>(*group->level) : kLeafMaterial;
  }
};

struct PlannedTree {
  const ShownTree* shown;
  Eigen::Vector3d translation;
  std::vector<GlbPart> parts;
};

// Subtraction and rounding are monotone, so points stay inside their boxes.
Position placed(const Eigen::Vector3d& object, const Eigen::Vector3d& translation) {
  Position position;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    const double from = object[axis] - translation[axis];
    const double limit = std::numeric_limits<float>::max();
    position[k] =
        std::abs(from) <= limit ? static_cast<float>(from) : std::numeric_limits<float>::infinity();
  }
  return position;
}

struct PlacedBox {
  Position low;
  Position high;

  [[nodiscard]] Position corner(unsigned number) const {
    Position position;
    for (std::size_t k = 0; k < 3; ++k) position[k] = (number >> k & 1u) != 0 ? high[k] : low[k];
    return position;
  }
};

PlacedBox placed(const Eigen::AlignedBox3d& box, const Eigen::Vector3d& translation) {
  PlacedBox result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto axis = static_cast<Eigen::Index>(k);
    result.low[k] = f32_below(box.min()[axis] - translation[axis]);
    result.high[k] = f32_above(box.max()[axis] - translation[axis]);
  }
  return result;
}

void extend(GlbPart& part, const Position& low, const Position& high) {
  for (std::size_t k = 0; k < 3; ++k) {
    part.low[k] = std::min(part.low[k], low[k]);
    part.high[k] = std::max(part.high[k], high[k]);
  }
}

GlbPart empty_part() {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  GlbPart part;
  part.low.fill(kInfinity);
  part.high.fill(-kInfinity);
  return part;
}

Result<GlbPart> plan_faces(const ShownTree& shown, const Eigen::Vector3d& translation) {
  const DecodedFaces& faces = *shown.faces;
  GlbPart part = empty_part();
  part.vertex_count = faces.vertex_count();
  part.index_count = 3 * faces.triangle_count();
  for (std::uint32_t v = 0; v < faces.vertex_count(); ++v) {
    const Position position = placed(faces.position(v), translation);
    extend(part, position, position);
  }
  for (const float bound : part.high) {
    if (std::isfinite(bound)) continue;
    return Error{Errc::kMeshUnsupported, shown.name + ": positions beyond what f32 of glTF holds"};
  }
  return part;
}

GlbPart plan_boxes(const ShownTree& shown, const BoxGroup& group, bool solid,
                   const Eigen::Vector3d& translation) {
  GlbPart part = empty_part();
  part.group = &group;
  part.vertex_count = 8 * group.count;
  part.index_count = group.count * (solid ? 6 * kBoxSides.size() : 2 * kBoxEdges.size());
  visit_group(shown.tree, group, [&](const Box<double>& box) {
    const PlacedBox bounds = placed(BoundTree::of(shown.tree).to_object(box), translation);
    extend(part, bounds.low, bounds.high);
  });
  return part;
}

Result<std::vector<PlannedTree>> plan(std::span<const ShownTree> trees, bool solid,
                                      std::uint64_t& bytes) {
  std::vector<PlannedTree> planned;
  bytes = 0;
  for (const ShownTree& shown : trees) {
    PlannedTree tree{&shown, glb_translation(shown.tree), {}};
    if (shown.faces && shown.faces->face_count() > 0) {
      Result<GlbPart> part = plan_faces(shown, tree.translation);
      if (!part) return part.error();
      tree.parts.push_back(*part);
    }
    for (const BoxGroup& group : shown.boxes) {
      tree.parts.push_back(plan_boxes(shown, group, solid, tree.translation));
    }
    for (GlbPart& part : tree.parts) {
      part.offset = bytes;
      bytes = part.end();
      if (part.vertex_count > kMaxVertexCount ||
          bytes > std::numeric_limits<std::uint32_t>::max()) {
        return Error{Errc::kMeshTooLarge, shown.name +
                                              ": more than the 4 GiB that a GLB holds; "
                                              "show fewer levels, or write OBJ"};
      }
    }
    planned.push_back(std::move(tree));
  }
  return planned;
}

// Hues differ by the golden ratio, so neighbouring levels differ; triangles are grey, leaves white.
Json colour(int material) {
  if (material == kTriangleMaterial) return {0.6, 0.6, 0.6, 1};
  if (material == kLeafMaterial) return {1, 1, 1, 1};
  const double hue = std::fmod(material * 0.6180339887498949, 1.0);
  Json rgba = Json::array();
  for (const double shift : {0.0, 2.0 / 3, 1.0 / 3}) {
    rgba.push_back(std::clamp(std::abs(std::fmod(hue + shift, 1.0) * 6 - 3) - 1, 0.0, 1.0));
  }
  rgba.push_back(1);
  return rgba;
}

class Document {
 public:
  Document(const Shown& shown, const std::vector<PlannedTree>& trees, bool solid,
           std::uint64_t bytes)
      : solid_(solid) {
    json_["asset"] = {{"version", "2.0"}, {"generator", "boxtree " + std::string(kVersion)}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({Json::object()});
    if (shown.instances) {
      add_instances(*shown.instances, trees);
    } else {
      for (const PlannedTree& tree : trees) add_tree(tree);
    }
    if (bytes > 0) append("buffers", {{"byteLength", bytes}});
  }

  [[nodiscard]] std::string text() const { return json_.dump(); }

 private:
  // Appends to one of the document's arrays and returns the index. glTF forbids empty arrays, so
  // the array is created on first use.
  std::size_t append(const char* array, Json item) {
    json_[array].push_back(std::move(item));
    return json_[array].size() - 1;
  }

  void add_tree(const PlannedTree& tree) {
    Json node = {{"name", tree.shown->name}};
    if (!tree.translation.isZero(0)) {
      node["translation"] = {tree.translation[0], tree.translation[1], tree.translation[2]};
    }
    for (const GlbPart& part : tree.parts) {
      const std::size_t mesh = add_mesh(part, part.name());
      node["children"].push_back(append("nodes", {{"name", part.name()}, {"mesh", mesh}}));
    }
    add_root(std::move(node));
  }

  void add_root(Json node) {
    json_["scenes"][0]["nodes"].push_back(append("nodes", std::move(node)));
  }

  void add_instances(const std::vector<ShownInstance>& instances,
                     const std::vector<PlannedTree>& trees) {
    std::vector<std::size_t> first_mesh;  // of each tree; those of its other parts follow
    for (const PlannedTree& tree : trees) {
      first_mesh.push_back(json_.contains("meshes") ? json_["meshes"].size() : 0);
      for (const GlbPart& part : tree.parts) {
        const std::string& name = tree.shown->name;
        add_mesh(part, part.group == nullptr ? name : name + " " + part.name());
      }
    }
    for (const ShownInstance& instance : instances) {
      add_instance(instance, trees[instance.tree], first_mesh[instance.tree]);
    }
  }

  // The instance's node holds the triangles, so that programs that only read meshes find the name
  // and pose of the instance.
  void add_instance(const ShownInstance& instance, const PlannedTree& tree, std::size_t mesh) {
    Pose pose = instance.pose;
    pose.translation() = map_of(pose).apply(tree.translation);
    const std::vector<Pose> matrices = node_matrices(pose);
    Json node = {{"name", instance.name}};
    set_matrix(node, matrices.back());
    for (const GlbPart& part : tree.parts) {
      if (part.group == nullptr) {
        node["mesh"] = mesh++;
      } else {
        node["children"].push_back(
            append("nodes", {{"name", instance.name + " " + part.name()}, {"mesh", mesh++}}));
      }
    }
    if (matrices.size() > 1) {
      Json outer = {{"name", instance.name}};
      set_matrix(outer, matrices.front());
      outer["children"].push_back(append("nodes", std::move(node)));
      node = std::move(outer);
    }
    add_root(std::move(node));
  }

  // Column-major, as in glTF. The identity is omitted.
  static void set_matrix(Json& node, const Pose& pose) {
    if (is_identity(pose)) return;
    Json numbers = Json::array();
    for (Eigen::Index i = 0; i < 16; ++i) numbers.push_back(pose.matrix()(i % 4, i / 4));
    node["matrix"] = std::move(numbers);
  }

  std::size_t add_mesh(const GlbPart& part, const std::string& name) {
    const std::size_t positions = append("bufferViews", {{"buffer", 0},
                                                         {"byteOffset", part.offset},
                                                         {"byteLength", part.position_bytes()},
                                                         {"target", kArrayBuffer}});
    const std::size_t indices =
        append("bufferViews", {{"buffer", 0},
                               {"byteOffset", part.offset + part.position_bytes()},
                               {"byteLength", part.index_bytes()},
                               {"target", kElementArrayBuffer}});
    const std::size_t position_accessor = append("accessors", {{"bufferView", positions},
                                                               {"componentType", kFloat},
                                                               {"count", part.vertex_count},
                                                               {"type", "VEC3"},
                                                               {"min", Json::array_of(part.low)},
                                                               {"max", Json::array_of(part.high)}});
    const std::size_t index_accessor = append(
        "accessors", {{"bufferView", indices},
                      {"componentType", part.has_short_indices() ? kUnsignedShort : kUnsignedInt},
                      {"count", part.index_count},
                      {"type", "SCALAR"}});
    Json primitive = {{"attributes", {{"POSITION", position_accessor}}},
                      {"indices", index_accessor},
                      {"material", material_of(part)},
                      {"mode", part.group != nullptr && !solid_ ? kModeLines : kModeTriangles}};
    return append("meshes", {{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
  }

  std::size_t material_of(const GlbPart& part) {
    const auto [place, is_new] = materials_.try_emplace(part.material(), 0);
    if (is_new) {
      place->second = append("materials", {{"name", part.name()},
                                           {"pbrMetallicRoughness",
                                            {{"baseColorFactor", colour(part.material())},
                                             {"metallicFactor", 0},
                                             {"roughnessFactor", 1}}},
                                           {"doubleSided", true}});
    }
    return place->second;
  }

  bool solid_;
  Json json_;
  std::map<int, std::size_t> materials_;
};

// The bytes of one part, positions first.
class PartBytes {
 public:
  PartBytes(const PlannedTree& tree, const GlbPart& part, bool solid, ByteSink& out)
      : tree_(tree), part_(part), solid_(solid), out_(out) {}

  void write() {
    if (part_.group == nullptr) {
      write_faces(*tree_.shown->faces);
    } else {
      write_boxes();
    }
    for (std::uint64_t i = part_.offset + part_.position_bytes() + part_.index_bytes();
         i < part_.end(); ++i) {
      out_.put(std::byte{0});
    }
  }

 private:
  void put_index(std::uint64_t index) {
    if (part_.has_short_indices()) {
      out_.put(static_cast<std::uint16_t>(index));
    } else {
      out_.put(static_cast<std::uint32_t>(index));
    }
  }

  void write_faces(const DecodedFaces& faces) {
    for (std::uint32_t v = 0; v < faces.vertex_count(); ++v) {
      out_.put(placed(faces.position(v), tree_.translation));
    }
    for (std::uint32_t f = 0; f < faces.face_count(); ++f) {
      const std::array<std::uint32_t, 4> corner = faces.face(f);
      const std::size_t corners = corner[3] == kMissingCorner ? 3 : 4;
      for (std::size_t i = 1; i + 1 < corners; ++i) {
        put_index(corner[0]);
        put_index(corner[i]);
        put_index(corner[i + 1]);
      }
    }
  }

  void write_boxes() {
    visit_group(tree_.shown->tree, *part_.group, [&](const Box<double>& box) {
      const PlacedBox bounds =
          placed(BoundTree::of(tree_.shown->tree).to_object(box), tree_.translation);
      for (unsigned corner = 0; corner < 8; ++corner) out_.put(bounds.corner(corner));
    });
    for (std::uint64_t first = 0; first < part_.vertex_count; first += 8) {
      if (solid_) {
        for (const auto& side : kBoxSides) {
          for (const std::size_t i : {0u, 1u, 2u, 0u, 2u, 3u}) put_index(first + side[i]);
        }
      } else {
        for (const auto& edge : kBoxEdges) {
          put_index(first + edge[0]);
          put_index(first + edge[1]);
        }
      }
    }
  }

  const PlannedTree& tree_;
  const GlbPart& part_;
  bool solid_;
  ByteSink& out_;
};

}  // namespace

Eigen::Vector3d glb_translation(const Tree& tree) {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  if (tree.empty() || has_f32_positions(tree)) return translation;
  const Eigen::AlignedBox3d bounds = BoundTree::of(tree).to_object(BoundTree::of(tree).root().box);
  const double extent = bounds.sizes().maxCoeff();
  if (!(extent > 0) || !std::isfinite(extent)) return translation;
  const double step = std::ldexp(1.0, std::ilogb(extent));
  for (Eigen::Index k = 0; k < 3; ++k) {
    const double middle = bounds.min()[k] / 2 + bounds.max()[k] / 2;
    const auto rounded = static_cast<float>(std::round(middle / step) * step);
    if (std::isfinite(rounded) && rounded != 0) translation[k] = rounded;  // never -0
  }
  return translation;
}

Status write_glb(const Shown& shown, bool solid_boxes, ByteSink& out) {
  std::uint64_t binary_bytes = 0;
  const Result<std::vector<PlannedTree>> planned = plan(shown.trees, solid_boxes, binary_bytes);
  if (!planned) return planned.error();
  std::string json = Document(shown, *planned, solid_boxes, binary_bytes).text();
  json.resize(chunk_bytes(json.size()), ' ');
  const std::uint64_t total = kGlbHeaderBytes + kChunkHeaderBytes + json.size() +
                              (binary_bytes > 0 ? kChunkHeaderBytes + binary_bytes : 0);
  if (total > std::numeric_limits<std::uint32_t>::max()) {
    return Error{Errc::kMeshTooLarge, "more than the 4 GiB that a GLB holds"};
  }
  out.put(std::array{kGlbMagic, kGlbVersion, static_cast<std::uint32_t>(total)});
  out.put(std::array{static_cast<std::uint32_t>(json.size()), kJsonChunk});
  out.write(std::as_bytes(std::span(json)));
  if (binary_bytes == 0) return {};
  out.put(std::array{static_cast<std::uint32_t>(binary_bytes), kBinaryChunk});
  for (const PlannedTree& tree : *planned) {
    for (const GlbPart& part : tree.parts) PartBytes(tree, part, solid_boxes, out).write();
  }
  return {};
}

}  // namespace boxtree::cooker
