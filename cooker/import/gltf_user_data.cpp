// SPDX-License-Identifier: MIT
// Reads extras, and walks the nodes of the document and of assimp side by side.
#include "cooker/import/gltf_user_data.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include <assimp/scene.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cooker/import/gltf_faces.h"
#include "cooker/import/import.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

using Json = nlohmann::json;

Error refusal(std::string_view wanted, const std::string& why) {
  return {Errc::kMeshUnsupported, fmt::format("user data of faces '{}': {}", wanted, why)};
}

// The text of a key; empty if there is none.
std::string text_at(const Json& object, const char* key) {
  const auto found = object.find(key);
  return found != object.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// The element of a list, or null.
const Json& element_at(const Json& list, std::uint64_t index) {
  static const Json kNone;
  return index < list.size() ? list[index] : kNone;
}

// JSON has one type of numbers: 7.0 is an integer. Those below zero are the same 32 bits.
std::optional<std::uint32_t> integer_of(const Json& value) {
  constexpr double kLeast = std::numeric_limits<std::int32_t>::min();
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  if (!value.is_number()) return std::nullopt;
  const auto number = value.get<double>();  // exact for all integers of 32 bits
  if (!(number >= kLeast && number <= kMost) || number != std::floor(number)) return std::nullopt;
  return static_cast<std::uint32_t>(static_cast<std::int64_t>(number));
}

// What may have extras for a primitive.
struct Owner {
  const Json& extras;
  const char* what;
};

const Json& extras_of(const Json& object) {
  static const Json kNone = Json::object();
  const auto found = object.find("extras");
  return found != object.end() && found->is_object() ? *found : kNone;
}

// The nearest first.
std::array<Owner, 3> owners_of(const Json& document, const Json& mesh, const Json& primitive) {
  const Json& materials = array_at(document, "materials");
  const Json& material = element_at(materials, number_at(primitive, "material", materials.size()));
  return {Owner{extras_of(primitive), "it"}, Owner{extras_of(material), "its material"},
          Owner{extras_of(mesh), "its mesh"}};
}

// Calls visit(mesh, number of the mesh, primitive, its number in the mesh) for each primitive.
template <class Visit>
void visit_primitives(const Json& document, const Visit& visit) {
  const Json& meshes = array_at(document, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Json& primitives = array_at(meshes[m], "primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) visit(meshes[m], m, primitives[p], p);
  }
}

std::string name_of(const Json& mesh, std::size_t number) {
  std::string name = text_at(mesh, "name");
  return name.empty() ? fmt::format("mesh {}", number) : name;
}

// Names of integers in extras, for the message about one that is not there.
std::vector<std::string> names_in_extras(const Json& document) {
  std::set<std::string> names;
  visit_primitives(document,
                   [&](const Json& mesh, std::size_t, const Json& primitive, std::size_t) {
                     for (const Owner& owner : owners_of(document, mesh, primitive)) {
                       for (const auto& [name, value] : owner.extras.items()) {
                         if (integer_of(value)) names.insert(name);
                       }
                     }
                   });
  return {names.begin(), names.end()};
}

Error no_such(const Json& document, const std::string& wanted) {
  const std::vector<std::string> names = names_in_extras(document);
  std::vector<std::string> meant = names;
  meant.emplace_back(kPrimitives);
  return refusal(wanted, fmt::format("no primitive has it in its extras, nor has its material or "
                                     "mesh; {}, and '{}' numbers them{}",
                                     names.empty() ? "they have no integers"
                                                   : "integers of theirs are: " + listed(names),
                                     kPrimitives, suggestion(wanted, meant)));
}

// Numbers by the extras of that name.
Result<PrimitiveNumbers> numbers_in_extras(const Json& document, const std::string& wanted) {
  PrimitiveNumbers numbers(array_at(document, "meshes").size());
  bool has_any = false;
  std::string fault;
  const auto read = [&](const Json& mesh, std::size_t m, const Json& primitive, std::size_t p) {
    std::uint32_t number = 0;
    for (const Owner& owner : owners_of(document, mesh, primitive)) {
      const auto value = owner.extras.find(wanted);
      if (value == owner.extras.end()) continue;
      has_any = true;
      const std::optional<std::uint32_t> integer = integer_of(*value);
      if (!integer && fault.empty()) {
        fault = fmt::format(
            "primitive {} of mesh '{}': user data of faces '{}': expected an "
            "integer of 32 bits, found {} in the extras of {}",
            p, name_of(mesh, m), wanted, value->dump(), owner.what);
      }
      number = integer.value_or(0);
      break;
    }
    numbers[m].push_back(number);
  };
  visit_primitives(document, read);
  if (!fault.empty()) return Error{Errc::kImportFailed, std::move(fault)};
  if (!has_any && !numbers.empty()) return no_such(document, wanted);
  return numbers;
}

}  // namespace

Result<PrimitiveNumbers> numbers_of_primitives(const Json& document, const std::string& wanted) {
  const auto meshes = document.find("meshes");
  if (meshes != document.end() && meshes->is_object()) {
    return refusal(wanted, "expected glTF 2, found glTF 1");
  }
  if (wanted != kPrimitives) return numbers_in_extras(document, wanted);
  PrimitiveNumbers numbers(array_at(document, "meshes").size());
  std::uint32_t next = 0;
  const auto count = [&](const Json&, std::size_t m, const Json&, std::size_t) {
    numbers[m].push_back(next++);
  };
  visit_primitives(document, count);
  return numbers;
}

std::vector<std::string> names_of_primitives(const Json& document) {
  std::vector<std::string> names;
  visit_primitives(document, [&](const Json& mesh, std::size_t m, const Json&, std::size_t p) {
    const std::string name = name_of(mesh, m);
    const bool is_one = array_at(mesh, "primitives").size() == 1;
    names.push_back(is_one ? name : fmt::format("{}-{}", name, p));
  });
  return names;
}

Result<std::vector<std::uint32_t>> numbers_of_meshes(const Json& document,
                                                     const PrimitiveNumbers& numbers,
                                                     const aiScene& scene) {
  const Error other_nodes{Errc::kImportFailed,
                          "user data of faces: assimp has read other nodes than the file has"};
  const Json& nodes = array_at(document, "nodes");
  const Json& scenes = array_at(document, "scenes");
  const Json& roots = array_at(element_at(scenes, number_at(document, "scene", 0)), "nodes");
  std::vector<std::optional<std::uint32_t>> found(scene.mNumMeshes);
  std::vector<std::pair<const Json*, const aiNode*>> stack;
  const auto push = [&](const Json& listed, const aiNode& parent) {
    if (listed.size() != parent.mNumChildren) return false;
    for (std::size_t i = 0; i < listed.size(); ++i) {
      if (!listed[i].is_number_unsigned()) return false;
      stack.emplace_back(&element_at(nodes, listed[i].get<std::uint64_t>()), parent.mChildren[i]);
    }
    return true;
  };
  // Of several roots assimp makes one.
  if (roots.size() == 1 && roots[0].is_number_unsigned()) {
    stack.emplace_back(&element_at(nodes, roots[0].get<std::uint64_t>()), scene.mRootNode);
  } else if (!push(roots, *scene.mRootNode)) {
    return other_nodes;
  }
  while (!stack.empty()) {
    const auto [node, read] = stack.back();
    stack.pop_back();
    const std::uint64_t mesh = number_at(*node, "mesh", numbers.size());
    const std::size_t primitives = mesh < numbers.size() ? numbers[mesh].size() : 0;
    if (read->mNumMeshes != primitives) return other_nodes;
    for (std::size_t p = 0; p < primitives; ++p) {
      if (read->mMeshes[p] >= found.size()) return other_nodes;
      found[read->mMeshes[p]] = numbers[mesh][p];
    }
    if (!push(array_at(*node, "children"), *read)) return other_nodes;
  }
  std::vector<std::uint32_t> of_meshes;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (!found[m] && mesh.mNumFaces > 0) {
      return Error{Errc::kMeshUnsupported,
                   fmt::format("user data of faces: no node of the scene has mesh '{}', so that "
                               "it is not known which one it is",
                               mesh.mName.C_Str())};
    }
    of_meshes.push_back(found[m].value_or(0));
  }
  return of_meshes;
}

}  // namespace boxtree::cooker
