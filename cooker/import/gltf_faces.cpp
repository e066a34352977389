// SPDX-License-Identifier: MIT
// Reads counts from the JSON of glTF files.
#include "cooker/import/gltf_faces.h"

#include <cstdint>
#include <string>
#include <string_view>

#include <assimp/scene.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cooker/import/file_error.h"
#include "cooker/import/glb.h"
#include "cooker/import/gltf_nesting.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

using Json = nlohmann::json;

StatedFaces::value_type counts_of(const Json& primitive, const Json& accessors) {
  const auto count_at = [&accessors](const Json& object, const char* key) -> std::uint64_t {
    const std::uint64_t accessor = number_at(object, key, accessors.size());
    return accessor < accessors.size() ? number_at(accessors[accessor], "count", 0) : 0;
  };
  const auto attributes = primitive.find("attributes");
  const std::uint64_t vertices =
      attributes == primitive.end() ? 0 : count_at(*attributes, "POSITION");
  const std::uint64_t corners =
      primitive.contains("indices") ? count_at(primitive, "indices") : vertices;
  switch (number_at(primitive, "mode", 4)) {
    case 4:
      return {vertices, corners / 3};
    case 5:
    case 6:
      return {vertices, corners < 3 ? 0 : corners - 2};
    default:
      return {vertices, 0};
  }
}

}  // namespace

Result<Json> read_gltf(const SourceFile& source) {
  if (!is_gltf(source.path())) return Json();
  const Result<std::string> file = source.read();
  if (!file.ok()) return file.error();
  const bool is_binary = has_extension(source.path(), "glb");
  Result<Json> document = parse_gltf(is_binary ? glb_json(*file) : std::string_view(*file));
  if (!document.ok()) return in_file(source.title(), document.error());
  return document;
}

std::uint64_t number_at(const Json& object, const char* key, std::uint64_t otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::uint64_t>()
                                                              : otherwise;
}

const Json& array_at(const Json& object, const char* key) {
  static const Json kEmpty = Json::array();
  const auto found = object.find(key);
  return found != object.end() && found->is_array() ? *found : kEmpty;
}

StatedFaces stated_faces(const Json& document) {
  StatedFaces stated;
  for (const Json& mesh : array_at(document, "meshes")) {
    if (!mesh.is_object()) continue;
    for (const Json& primitive : array_at(mesh, "primitives")) {
      if (primitive.is_object()) {
        stated.insert(counts_of(primitive, array_at(document, "accessors")));
      }
    }
  }
  return stated;
}

std::string gltf_fault(const SourceFile& source) {
  if (!is_gltf(source.path())) return {};
  const bool is_binary = has_extension(source.path(), "glb");
  const Result<std::string> file = source.read();
  if (!file.ok()) return {};
  if (!is_binary) {
    const std::size_t first = file->find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first < file->size() && (*file)[first] == '{' ? json_fault(*file) : std::string();
  }
  if (!file->starts_with("glTF")) return {};
  const std::optional<std::uint32_t> stated = glb_size(*file);
  if (!stated) return fmt::format("its header ends after {} bytes{}", file->size(), kAsIfCut);
  if (*stated > file->size()) {
    return fmt::format("it has {} bytes, but its header states {}{}", file->size(), *stated,
                       kAsIfCut);
  }
  return json_fault(glb_json(*file));
}

Status check_stated_faces(const StatedFaces& stated, const aiScene& scene) {
  if (stated.empty()) return {};
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    if ((mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) continue;
    if (stated.contains({mesh.mNumVertices, mesh.mNumFaces})) continue;
    return Error{Errc::kMeshIndexOutOfRange,
                 fmt::format("mesh '{}': faces name vertices that are not there; {} faces with {} "
                             "vertices are good",
                             mesh.mName.C_Str(), mesh.mNumFaces, mesh.mNumVertices)};
  }
  return {};
}

}  // namespace boxtree::cooker
