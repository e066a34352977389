// SPDX-License-Identifier: MIT
#include "cooker/import/gltf_extensions.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cooker/import/gltf_document.h"

namespace boxtree::cooker {
namespace {

// Extensions of these kinds, whoever defines them, are of what covers faces or lights them.
constexpr std::array<std::string_view, 3> kKindsWithoutGeometry = {"materials_", "texture_",
                                                                   "lights_"};

constexpr std::array<std::string_view, 9> kWithoutGeometry = {
    "KHR_animation_pointer",    // animations, of which none is read
    "KHR_techniques_webgl",     // shaders of materials
    "KHR_xmp",                  // metadata, as the next five
    "KHR_xmp_json_ld",          //
    "EXT_structural_metadata",  //
    "EXT_feature_metadata",     //
    "EXT_mesh_features",        //
    "EXT_instance_features",    //
    "KHR_binary_glTF",          // glTF 1: where the buffer is, which assimp reads
};

// Those that change geometry and are read.
constexpr std::array<std::string_view, 2> kRead = {
    "KHR_mesh_quantization",  // gltf_positions.h
    kDraco,                   // by assimp, which refuses it where it was built without Draco
};

struct Remedy {
  std::string_view extension;
  const char* text;
};
constexpr std::array kRemedies = {
    Remedy{"EXT_meshopt_compression", "write it uncompressed (gltfpack: without -c and -cc)"},
    Remedy{"KHR_meshopt_compression", "write it uncompressed (gltfpack: without -c and -cc)"},
    Remedy{kInstancing, kInstancingRemedy},
};

template <std::size_t kCount>
bool has(const std::array<std::string_view, kCount>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool cannot_change_geometry(std::string_view extension) {
  const std::size_t vendor = extension.find('_');
  const std::string_view kind =
      vendor == std::string_view::npos ? std::string_view() : extension.substr(vendor + 1);
  const auto is_of = [kind](std::string_view known) { return kind.starts_with(known); };
  return std::any_of(kKindsWithoutGeometry.begin(), kKindsWithoutGeometry.end(), is_of) ||
         has(kWithoutGeometry, extension);
}

}  // namespace

Status check_required_extensions(const Json& document) {
  for (const Json& listed : array_at(document, "extensionsRequired")) {
    if (!listed.is_string()) continue;
    const std::string extension = listed.get<std::string>();
    if (has(kRead, extension) || cannot_change_geometry(extension)) continue;
    const auto known = std::find_if(kRemedies.begin(), kRemedies.end(), [&](const Remedy& remedy) {
      return remedy.extension == extension;
    });
    return Error{
        Errc::kImportFailed,
        fmt::format("it requires the extension {} of glTF, which is not read and can "
                    "change its geometry; {}",
                    extension, known != kRemedies.end() ? known->text : "export it without that")};
  }
  return {};
}

}  // namespace boxtree::cooker
