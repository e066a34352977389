// SPDX-License-Identifier: MIT
// Reads extras.
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

#include <fmt/format.h>

#include "cooker/import/gltf_document.h"
#include "cooker/import/gltf_primitives.h"
#include "cooker/import/import.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

Error refusal(std::string_view wanted, const std::string& why) {
  return {Errc::kMeshUnsupported, fmt::format("user data of faces '{}': {}", wanted, why)};
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
  const Json* const found = object.find("extras");
  return found != nullptr && found->is_object() ? *found : kNone;
}

// The nearest first.
std::array<Owner, 3> owners_of(const Json& document, const Json& mesh, const Json& primitive) {
  const Json& materials = array_at(document, "materials");
  const Json& material = element_at(materials, number_at(primitive, "material", materials.size()));
  return {Owner{extras_of(primitive), "it"}, Owner{extras_of(material), "its material"},
          Owner{extras_of(mesh), "its mesh"}};
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
      const Json* const value = owner.extras.find(wanted);
      if (value == nullptr) continue;
      has_any = true;
      const std::optional<std::uint32_t> integer = integer_of(*value);
      if (!integer && fault.empty()) {
        fault = fmt::format(
            "primitive {} of mesh '{}': user data of faces '{}': expected an "
            "integer of 32 bits, found {} in the extras of {}",
            p, name_of_mesh(mesh, m), wanted, value->dump(), owner.what);
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
  const Json* const meshes = document.find("meshes");
  if (meshes != nullptr && meshes->is_object()) {
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
    const std::string name = name_of_mesh(mesh, m);
    const bool is_one = array_at(mesh, "primitives").size() == 1;
    names.push_back(is_one ? name : fmt::format("{}-{}", name, p));
  });
  return names;
}

}  // namespace boxtree::cooker
