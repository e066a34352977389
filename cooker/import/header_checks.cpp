// SPDX-License-Identifier: MIT
// Headers of PLY files, JSON of glTF files.
#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <assimp/scene.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <boxtree/cooker/import/glb.h>
#include <boxtree/cooker/import/header_checks.h>
#include <boxtree/cooker/import/source_files.h>
#include <boxtree/cooker/import/text_tokens.h>
#include <boxtree/cooker/import/whole_file.h>

namespace boxtree::cooker {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kPlyHeaderBytes = std::size_t{1} << 16;  // longer headers are not looked at

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

// Vertices and faces that a primitive has according to the file.
using Counts = std::pair<std::uint64_t, std::uint64_t>;

Counts counts_of(const Json& primitive, const Json& accessors) {
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

std::set<Counts> stated_counts(const Json& document) {
  std::set<Counts> counts;
  for (const Json& mesh : array_at(document, "meshes")) {
    if (!mesh.is_object()) continue;
    for (const Json& primitive : array_at(mesh, "primitives")) {
      if (primitive.is_object()) {
        counts.insert(counts_of(primitive, array_at(document, "accessors")));
      }
    }
  }
  return counts;
}

}  // namespace

Status check_gltf_faces(const std::filesystem::path& path, const aiScene& scene) {
  const bool is_binary = has_extension(path, "glb");
  if (!is_binary && !has_extension(path, "gltf")) return {};
  const Result<std::string> file = read_whole_file(path, kAnyBytes);
  if (!file.ok()) return file.error();
  const std::string_view text = is_binary ? glb_json(*file) : std::string_view(*file);
  const Json document = Json::parse(text, nullptr, false);
  // glTF 1 has no arrays of meshes; assimp's reader for it leaves bad numbers to us.
  if (!document.is_object()) return {};
  const std::set<Counts> counts = stated_counts(document);
  if (counts.empty()) return {};
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    if ((mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) continue;
    if (counts.contains({mesh.mNumVertices, mesh.mNumFaces})) continue;
    return Error{Errc::kMeshIndexOutOfRange,
                 fmt::format("{}: mesh '{}': faces name vertices that are not there; {} faces with "
                             "{} vertices are good",
                             path.string(), mesh.mName.C_Str(), mesh.mNumFaces, mesh.mNumVertices)};
  }
  return {};
}

}  // namespace boxtree::cooker
