// SPDX-License-Identifier: MIT
#include "cooker/import/ply_layout.h"

#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

Error failure(std::string_view why) {
  return {Errc::kImportFailed, "the header: " + std::string(why)};
}

// Sets `found` to the element with that name, if there is one.
Status find_element(const PlyHeader& header, std::string_view name, const PlyElement*& found) {
  for (const PlyElement& element : header.elements) {
    if (element.name != name) continue;
    if (found != nullptr) return failure(fmt::format("two elements '{}'", name));
    found = &element;
  }
  return {};
}

Status find_coordinates(PlyLayout& layout) {
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    for (const PlyProperty& property : layout.vertex->properties) {
      if (property.name != kNames[k]) continue;
      if (layout.xyz[k] != nullptr || property.length) {
        return failure(fmt::format("vertices have '{}' twice, or as a list", kNames[k]));
      }
      layout.xyz[k] = &property;
    }
    if (layout.xyz[k] == nullptr) return failure(fmt::format("vertices have no '{}'", kNames[k]));
  }
  return {};
}

// The list of vertex numbers of `element`, if there is such an element.
Status find_corners(const PlyElement* element, const PlyProperty*& found) {
  if (element == nullptr) return {};
  for (const PlyProperty& property : element->properties) {
    if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
    if (found != nullptr || !property.length || !is_integer(property.type)) {
      return failure(
          fmt::format("'{}' of '{}' is to be one list of integers", property.name, element->name));
    }
    found = &property;
  }
  return found != nullptr ? Status()
                          : failure(fmt::format("'{}' has no 'vertex_indices'", element->name));
}

// Sets `found` to the property `name` of faces; `what` it is, for messages.
Status find_face_integer(std::string_view what, const std::string& name, const PlyLayout& layout,
                         const PlyProperty*& found) {
  const auto refusal = [&](const std::string& why) {
    return Error{Errc::kMeshUnsupported, fmt::format("{} of faces '{}': {}", what, name, why)};
  };
  if (layout.tristrips != nullptr && layout.tristrips->count > 0) {
    return refusal("the file has 'tristrips', whose triangles have no properties of their own");
  }
  std::vector<std::string> names;  // of those that it could be
  for (const PlyProperty& property : layout.face->properties) {
    const bool is_meant = property.name == name;
    if (!property.length && is_integer(property.type)) {
      names.push_back(property.name);
      if (!is_meant) continue;
      if (found != nullptr) return refusal("faces have it twice");
      found = &property;
    } else if (is_meant) {
      return refusal(property.length ? "expected one integer a face, found a list"
                                     : "expected an integer, found a floating-point number");
    }
  }
  if (found != nullptr) return {};
  return refusal(fmt::format("faces have no such property; {}{}",
                             names.empty() ? "they have none that is an integer"
                                           : "integers of theirs are: " + listed(names),
                             suggestion(name, names)));
}

}  // namespace

Status find_user_data(const std::string& name, PlyLayout& layout) {
  return find_face_integer("user data", name, layout, layout.user_data);
}

Status find_face_ids(const std::string& name, PlyLayout& layout) {
  return find_face_integer("ids", name, layout, layout.face_ids);
}

Status find_ply_parts(PlyLayout& layout) {
  const PlyHeader& header = layout.header;
  for (const auto& [name, found] :
       {std::pair("vertex", &layout.vertex), std::pair("face", &layout.face),
        std::pair("tristrips", &layout.tristrips)}) {
    if (Status status = find_element(header, name, *found); !status.ok()) return status;
  }
  const auto has_any = [](const PlyElement* element) {
    return element != nullptr && element->count > 0;
  };
  if (!has_any(layout.face) && !has_any(layout.tristrips)) {
    const bool has_element = layout.face != nullptr || layout.tristrips != nullptr;
    return Error{Errc::kNoFaces,
                 has_element ? "no faces: the header counts 0"
                             : "no faces: the header states neither 'face' nor 'tristrips'"};
  }
  if (layout.vertex == nullptr) return failure("no element 'vertex'");
  for (const PlyElement* faces : {layout.face, layout.tristrips}) {
    // Both are in one array, in the order of the file.
    if (faces != nullptr && faces < layout.vertex) {
      return failure(fmt::format("'{}' comes before 'vertex'", faces->name));
    }
  }
  if (Status status = find_coordinates(layout); !status.ok()) return status;
  if (Status status = find_corners(layout.face, layout.corners); !status.ok()) return status;
  return find_corners(layout.tristrips, layout.strip);
}

}  // namespace boxtree::cooker
