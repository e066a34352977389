// SPDX-License-Identifier: MIT
// One function for each kind of object, in the order in which they refer to each other.
#include "cooker/import/gltf_values.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/gltf_accessor.h"
#include "cooker/import/gltf_document.h"
#include "cooker/import/gltf_extensions.h"
#include "cooker/import/gltf_numbers.h"
#include "cooker/import/gltf_primitives.h"
#include "cooker/import/transform_values.h"

namespace boxtree::cooker {
namespace {

// A value for a message.
std::string shown(const Json& value) {
  constexpr std::size_t kMost = 40;
  if (value.is_object()) return "an object";
  if (value.is_array()) return fmt::format("a list of {}", value.size());
  std::string text = value.dump(-1, true);
  return text.size() <= kMost ? text : text.substr(0, kMost) + "...";
}

// Holds the first fault. Methods return whether there is none yet.
class ValueChecker {
 public:
  explicit ValueChecker(const Json& document)
      : document_(document), are_checked_(array_at(document, "accessors").size()) {}

  Status check() {
    static_cast<void>(check_scenes() && check_nodes() && check_meshes() && check_skins());
    if (fault_.empty()) return {};
    return Error{Errc::kImportFailed, std::move(fault_)};
  }

 private:
  bool check_scenes() {
    const Json& scenes = array_at(document_, "scenes");
    place_ = "the document";
    if (!scenes.empty() && !index(document_, "scene", "scenes")) return false;
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      place_ = fmt::format("scene {}", i);
      if (!is_object(scenes[i]) || !each_once(scenes[i], "nodes")) return false;
    }
    return true;
  }

  // What has a parent would be placed twice.
  bool check_roots() {
    const Json& nodes = array_at(document_, "nodes");
    std::vector<std::size_t> parent(nodes.size(), nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (const Json& child : array_at(nodes[i], "children")) {
        parent[child.get<std::size_t>()] = i;
      }
    }
    const Json& scenes = array_at(document_, "scenes");
    for (std::size_t i = 0; i < scenes.size(); ++i) {
      for (const Json& root : array_at(scenes[i], "nodes")) {
        const std::size_t above = parent[root.get<std::size_t>()];
        if (above == nodes.size()) continue;
        place_ = fmt::format("scene {}", i);
        return fail("nodes", "nodes without a parent",
                    fmt::format("{}, a child of {}", root.get<std::size_t>(), above));
      }
    }
    return true;
  }

  bool check_nodes() {
    const Json& nodes = array_at(document_, "nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Json& node = nodes[i];
      place_ = fmt::format("node {}", i);
      if (!(is_object(node) && each_once(node, "children") && index(node, "mesh", "meshes") &&
            numbers(node, "translation", 3) && numbers(node, "scale", 3) && rotation(node) &&
            matrix(node))) {
        return false;
      }
    }
    return check_roots();
  }

  bool rotation(const Json& node) {
    if (!numbers(node, "rotation", 4)) return false;
    const Json* const rotation = node.find("rotation");
    if (rotation == nullptr) return true;
    double squared = 0;
    for (const Json& each : *rotation) squared += each.get<double>() * each.get<double>();
    const double length = std::sqrt(squared);
    return is_unit_length(length) ||
           fail("rotation", "a quaternion of length 1", fmt::format("length {:.6g}", length));
  }

  // Columns, of which each ends with the number of the last row.
  bool matrix(const Json& node) {
    if (!numbers(node, "matrix", 16)) return false;
    const Json* const matrix = node.find("matrix");
    if (matrix == nullptr) return true;
    for (const char* part : {"translation", "rotation", "scale"}) {
      if (node.contains(part))
        return fail("matrix", "a matrix alone", fmt::format("a {}, too", part));
    }
    for (std::size_t column = 0; column < 4; ++column) {
      const double last = (*matrix)[4 * column + 3].get<double>();
      if (!is_in_last_row(last, column)) {
        return fail("matrix", "0, 0, 0, 1 as its last row",
                    fmt::format("{:.6g} in column {}", last, column));
      }
    }
    return true;
  }

  bool check_meshes() {
    const Json& meshes = array_at(document_, "meshes");
    for (std::size_t m = 0; m < meshes.size(); ++m) {
      place_ = fmt::format("mesh {}", m);
      if (!is_object(meshes[m]) || !is_list(meshes[m], "primitives")) return false;
      const Json& primitives = array_at(meshes[m], "primitives");
      for (std::size_t p = 0; p < primitives.size(); ++p) {
        place_ = fmt::format("mesh '{}', primitive {}", name_of_mesh(meshes[m], m), p);
        if (!check_primitive(primitives[p])) return false;
      }
    }
    return true;
  }

  bool check_primitive(const Json& primitive) {
    if (!is_object(primitive)) return false;
    const Json* const mode = primitive.find("mode");
    if (mode != nullptr &&
        !(mode->is_number_unsigned() && mode->get<std::uint64_t>() <= kModeTriangleFan)) {
      return fail("mode", "0 to 6", shown(*mode));
    }
    const Json* const attributes = primitive.find("attributes");
    if (attributes == nullptr || !attributes->is_object()) {
      return fail("attributes", "an object with POSITION",
                  attributes == nullptr ? "none" : shown(*attributes));
    }
    if (!attributes->contains("POSITION")) return fail("attributes", "POSITION", "none");
    return index(*attributes, "POSITION", "accessors") &&
           index(primitive, "indices", "accessors") && has_corners(primitive) &&
           (is_compressed(primitive) || (check_accessor(*attributes, "POSITION", 3) &&
                                         check_accessor(primitive, "indices", 1)));
  }

  // Of strips and fans assimp subtracts two; what is left of triangles it drops.
  bool has_corners(const Json& primitive) {
    const std::uint64_t mode = number_at(primitive, "mode", kModeTriangles);
    if (mode < kModeTriangles) return true;
    const Json& accessor = primitive.contains("indices")
                               ? accessor_at(document_, primitive, "indices")
                               : positions_of(document_, primitive);
    const std::uint64_t corners = number_at(accessor, "count", 0);
    if (mode == kModeTriangles) {
      return corners % 3 == 0 || fail("", "a multiple of 3 corners", std::to_string(corners));
    }
    return corners >= 3 || fail("", "3 or more corners of a strip or fan", std::to_string(corners));
  }

  // Its accessors then have no bufferView, or one that is not read. Others without one are of
  // zeros, as many as they say.
  static bool is_compressed(const Json& primitive) {
    const Json* const extensions = primitive.find("extensions");
    return extensions != nullptr && extensions->contains(kDraco);
  }

  // Optional in the format.
  bool check_skins() {
    const Json& skins = array_at(document_, "skins");
    for (std::size_t i = 0; i < skins.size(); ++i) {
      place_ = fmt::format("skin {}", i);
      if (!is_object(skins[i]) || !index(skins[i], "inverseBindMatrices", "accessors"))
        return false;
      if (!skins[i].contains("inverseBindMatrices")) {
        return fail("inverseBindMatrices", "an accessor, without which assimp's reader crashes",
                    "none; export the meshes without skins");
      }
    }
    return true;
  }

  // Once each. `components`: of an element.
  bool check_accessor(const Json& object, const char* key, std::uint64_t components) {
    const Json& accessors = array_at(document_, "accessors");
    const std::uint64_t number = number_at(object, key, accessors.size());
    if (number >= accessors.size() || are_checked_[number]) return true;
    are_checked_[number] = true;
    const Json& accessor = accessors[number];
    place_ = fmt::format("accessor {}", number);
    if (!(is_object(accessor) && count(accessor, "count", 1, true))) return false;
    if (!accessor.contains("bufferView")) {
      return fail("bufferView", "one, without which all are zeros", "none");
    }
    const GltfComponent* const component = component_of(accessor);
    if (component == nullptr) return true;  // see check_types
    const std::uint64_t size = components * component->bytes;
    const std::uint64_t elements = number_at(accessor, "count", 0);
    if (!check_range(accessor, elements, size)) return false;
    const Json* const sparse = accessor.find("sparse");
    return sparse == nullptr || check_sparse(*sparse, elements, size);
  }

  bool check_sparse(const Json& sparse, std::uint64_t elements, std::uint64_t size) {
    place_ += ", sparse";
    if (!(is_object(sparse) && count(sparse, "count", 1, true))) return false;
    const std::uint64_t replaced = number_at(sparse, "count", 0);
    if (replaced > elements) {
      return fail("count", fmt::format("at most {}, as many as it replaces of", elements),
                  std::to_string(replaced));
    }
    const Json* const indices = sparse.find("indices");
    const Json* const values = sparse.find("values");
    if (indices == nullptr || !indices->is_object()) return fail("indices", "an object", "none");
    if (values == nullptr || !values->is_object()) return fail("values", "an object", "none");
    const GltfComponent* const component = component_of(*indices);
    if (component == nullptr || !component->is_unsigned()) {
      return fail("componentType of indices", "UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT",
                  component == nullptr ? "none of glTF" : component->name);
    }
    return check_range(*indices, replaced, component->bytes) &&
           check_range(*values, replaced, size);
  }

  // Of `elements` of `size` bytes in a bufferView, which has to be in its buffer.
  bool check_range(const Json& object, std::uint64_t elements, std::uint64_t size) {
    if (object.find("bufferView") == nullptr) return fail("bufferView", "one", "none");
    if (!(index(object, "bufferView", "bufferViews") && count(object, "byteOffset", 0, false)))
      return false;
    const std::string of_object = place_;
    const std::uint64_t number = number_at(object, "bufferView", 0);
    const Json& view = array_at(document_, "bufferViews")[number];
    place_ = fmt::format("bufferView {}", number);
    if (!check_view(view, size)) return false;
    place_ = of_object;
    const std::uint64_t bytes = number_at(view, "byteLength", 0);
    const std::uint64_t offset = number_at(object, "byteOffset", 0);
    const std::uint64_t stride = number_at(view, "byteStride", size);
    const bool fits = size <= bytes && offset <= bytes - size &&
                      (elements - 1) <= (bytes - size - offset) / stride;
    return fits ||
           fail("count",
                fmt::format("no more than the {} bytes of bufferView {} hold from byte {} on",
                            bytes, number, offset),
                std::to_string(elements));
  }

  // `size`: bytes of an element.
  bool check_view(const Json& view, std::uint64_t size) {
    if (!(is_object(view) && index(view, "buffer", "buffers") &&
          count(view, "byteLength", 1, true) && count(view, "byteOffset", 0, false) &&
          count(view, "byteStride", size, false))) {
      return false;
    }
    const Json& buffers = array_at(document_, "buffers");
    const std::uint64_t number = number_at(view, "buffer", buffers.size());
    if (number >= buffers.size()) return fail("buffer", "one", "none");
    const std::uint64_t bytes = number_at(buffers[number], "byteLength", 0);
    const std::uint64_t length = number_at(view, "byteLength", 0);
    const std::uint64_t offset = number_at(view, "byteOffset", 0);
    return (length <= bytes && offset <= bytes - length) ||
           fail("byteLength", fmt::format("to end within the {} bytes of buffer {}", bytes, number),
                fmt::format("{} from byte {} on", length, offset));
  }

  bool is_object(const Json& value) {
    return value.is_object() || fail("", "an object", shown(value));
  }
  bool is_list(const Json& object, const char* key) {
    const Json* const list = object.find(key);
    return list == nullptr || list->is_array() || fail(key, "a list", shown(*list));
  }

  // A member that names an element of `list`, if it is there.
  bool index(const Json& object, const char* key, const char* list) {
    const Json* const number = object.find(key);
    return number == nullptr || is_index(key, *number, list);
  }
  // A list of nodes, none of them twice.
  bool each_once(const Json& object, const char* key) {
    if (!is_list(object, key)) return false;
    std::vector<std::uint64_t> listed;
    for (const Json& each : array_at(object, key)) {
      if (!is_index(key, each, "nodes")) return false;
      listed.push_back(each.get<std::uint64_t>());
    }
    std::sort(listed.begin(), listed.end());
    const auto twice = std::adjacent_find(listed.begin(), listed.end());
    return twice == listed.end() || fail(key, "each node once", fmt::format("{} twice", *twice));
  }
  bool is_index(const char* key, const Json& number, const char* list) {
    const std::size_t size = array_at(document_, list).size();
    return (number.is_number_unsigned() && number.get<std::uint64_t>() < size) ||
           fail(key, fmt::format("an index of the {} {}", size, list), shown(number));
  }
  bool numbers(const Json& object, const char* key, std::size_t size) {
    const Json* const list = object.find(key);
    if (list == nullptr) return true;
    const std::string expected = fmt::format("{} numbers", size);
    if (!list->is_array() || list->size() != size) return fail(key, expected, shown(*list));
    for (const Json& each : *list) {
      if (!each.is_number()) return fail(key, expected, shown(each));
    }
    return true;
  }
  // A whole number of `least` or more, if it is there.
  bool count(const Json& object, const char* key, std::uint64_t least, bool is_required) {
    const Json* const number = object.find(key);
    if (number == nullptr && !is_required) return true;
    return (number != nullptr && number->is_number_unsigned() &&
            number->get<std::uint64_t>() >= least) ||
           fail(key, fmt::format("a whole number of {} or more", least),
                number == nullptr ? "none" : shown(*number));
  }

  bool fail(std::string_view key, std::string_view expected, std::string_view found) {
    fault_ = fmt::format("{}{}{}: expected {}, found {}", place_, key.empty() ? "" : ": ", key,
                         expected, found);
    return false;
  }

  const Json& document_;
  std::vector<bool> are_checked_;  // accessors
  std::string place_, fault_;
};

}  // namespace

Status check_values(const Json& document) {
  return ValueChecker(document).check();
}

}  // namespace boxtree::cooker
