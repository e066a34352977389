// SPDX-License-Identifier: MIT
#include "cooker/import/gltf_positions.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <assimp/scene.h>
#include <fmt/format.h>

#include "cooker/import/gltf_accessor.h"
#include "cooker/import/gltf_document.h"
#include "cooker/import/gltf_primitives.h"

namespace boxtree::cooker {
namespace {

// How the positions of a primitive are stored: its componentType, and this where it is normalized.
constexpr std::uint32_t kNormalized = 0x10000;

// Of a primitive without positions, that of f32, which are left alone.
std::uint32_t storage_of(const Json& document, const Json& primitive) {
  const Json& accessor = positions_of(document, primitive);
  const GltfComponent* const component = component_of(accessor);
  if (component == nullptr || component->type == GltfComponent::kFloat)
    return GltfComponent::kFloat;
  const Json* const normalized = accessor.find("normalized");
  const bool is_normalized =
      normalized != nullptr && normalized->is_boolean() && normalized->get<bool>();
  return component->type | (is_normalized ? kNormalized : 0);
}

// "VEC2 of SHORT", as the file has it.
std::string type_of(const Json& accessor) {
  const Json* const type = accessor.find("type");
  const GltfComponent* const component = component_of(accessor);
  return fmt::format(
      "{} of {}", type != nullptr && type->is_string() ? type->get<std::string>() : "no type",
      component != nullptr
          ? component->name
          : fmt::format("component type {}", number_at(accessor, "componentType", 0)).c_str());
}

// Why positions cannot be read; empty if they can.
std::string fault_of_positions(const Json& document, const Json& accessor) {
  if (!accessor.is_object()) return {};
  const GltfComponent* const component = component_of(accessor);
  if (!has_type(accessor, "VEC3") || component == nullptr ||
      component->type == GltfComponent::kUnsignedInt) {
    return fmt::format(
        "positions are {}; expected VEC3 of FLOAT, or of 8 or 16 bits by KHR_mesh_quantization",
        type_of(accessor));
  }
  if (!accessor.contains("sparse")) return {};
  const Json& views = array_at(document, "bufferViews");
  const Json& view = element_at(views, number_at(accessor, "bufferView", views.size()));
  const std::uint64_t packed = 3 * component->bytes;
  if (!view.is_object() || number_at(view, "byteStride", packed) == packed) return {};
  return "positions are sparse among other data of a bufferView, which is not read; export them "
         "without sparse accessors";
}

std::string fault_of_vertex_numbers(const Json& accessor) {
  if (!accessor.is_object()) return {};
  const GltfComponent* const component = component_of(accessor);
  if (component != nullptr && component->is_unsigned() && has_type(accessor, "SCALAR")) return {};
  return fmt::format(
      "vertex numbers are {}; expected SCALAR of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT",
      type_of(accessor));
}

// Integers as the specification (3.11) and KHR_mesh_quantization define them. T is their type.
template <class T>
float value_of(T stored, bool is_normalized) {
  if (!is_normalized) return static_cast<float>(stored);
  const double part = static_cast<double>(stored) / double{std::numeric_limits<T>::max()};
  return static_cast<float>(std::max(part, -1.0));
}

// Assimp copies the bytes of each element to the begin of a vertex.
template <class T>
void read_vertices(aiMesh& mesh, bool is_normalized) {
  for (unsigned vertex = 0; vertex < mesh.mNumVertices; ++vertex) {
    std::array<T, 3> stored;
    static_assert(sizeof(stored) <= sizeof(aiVector3D));
    aiVector3D& position = mesh.mVertices[vertex];
    std::memcpy(stored.data(), &position, sizeof(stored));
    position = {value_of(stored[0], is_normalized), value_of(stored[1], is_normalized),
                value_of(stored[2], is_normalized)};
  }
}

void read_vertices(aiMesh& mesh, std::uint32_t storage) {
  const bool is_normalized = (storage & kNormalized) != 0;
  if (mesh.mVertices == nullptr) return;
  switch (storage & ~kNormalized) {
    case GltfComponent::kByte:
      return read_vertices<std::int8_t>(mesh, is_normalized);
    case GltfComponent::kUnsignedByte:
      return read_vertices<std::uint8_t>(mesh, is_normalized);
    case GltfComponent::kShort:
      return read_vertices<std::int16_t>(mesh, is_normalized);
    case GltfComponent::kUnsignedShort:
      return read_vertices<std::uint16_t>(mesh, is_normalized);
    default:
      return;
  }
}

}  // namespace

Status check_types(const Json& document) {
  std::string fault;
  visit_primitives(
      document, [&](const Json& mesh, std::size_t m, const Json& primitive, std::size_t p) {
        if (!fault.empty()) return;
        fault = fault_of_positions(document, positions_of(document, primitive));
        if (fault.empty())
          fault = fault_of_vertex_numbers(accessor_at(document, primitive, "indices"));
        if (!fault.empty())
          fault = fmt::format("mesh '{}', primitive {}: {}", name_of_mesh(mesh, m), p, fault);
      });
  if (fault.empty()) return {};
  return Error{Errc::kImportFailed, std::move(fault)};
}

bool has_quantized_positions(const Json& document) {
  bool is_any = false;
  visit_primitives(document, [&](const Json&, std::size_t, const Json& primitive, std::size_t) {
    is_any |= storage_of(document, primitive) != GltfComponent::kFloat;
  });
  return is_any;
}

Status read_quantized_positions(const Json& document, aiScene& scene) {
  PrimitiveNumbers storage(array_at(document, "meshes").size());
  visit_primitives(document, [&](const Json&, std::size_t m, const Json& primitive, std::size_t) {
    storage[m].push_back(storage_of(document, primitive));
  });
  const Result<std::vector<std::uint32_t>> of_meshes =
      numbers_of_meshes(document, storage, scene, "quantized positions");
  if (!of_meshes.ok()) return of_meshes.error();
  for (unsigned mesh = 0; mesh < scene.mNumMeshes; ++mesh) {
    read_vertices(*scene.mMeshes[mesh], (*of_meshes)[mesh]);
  }
  return {};
}

}  // namespace boxtree::cooker
