// SPDX-License-Identifier: MIT
#include <string_view>

#include <boxtree/cooker/import/ply_layout.h>

namespace boxtree::cooker {
namespace {

bool find_coordinates(PlyLayout& layout) {
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  for (const PlyProperty& property : layout.vertex->properties) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (property.name != kNames[k]) continue;
      if (layout.xyz[k] != nullptr || property.length) return false;
      layout.xyz[k] = &property;
    }
  }
  return layout.xyz[0] != nullptr && layout.xyz[1] != nullptr && layout.xyz[2] != nullptr;
}

bool find_corners(PlyLayout& layout) {
  for (const PlyProperty& property : layout.face->properties) {
    if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
    if (layout.corners != nullptr || !property.length || !is_integer(property.type)) return false;
    layout.corners = &property;
  }
  return layout.corners != nullptr;
}

}  // namespace

bool find_ply_parts(PlyLayout& layout) {
  if (!layout.header.is_plain) return false;
  for (const PlyElement& element : layout.header.elements) {
    if (!element.is_understood || element.name == "tristrips") return false;
    for (const PlyProperty& property : element.properties) {
      if (property.length && !is_integer(*property.length)) return false;
    }
    if (element.name == "vertex") {
      if (layout.vertex != nullptr) return false;
      layout.vertex = &element;
    } else if (element.name == "face") {
      if (layout.face != nullptr || layout.vertex == nullptr) return false;
      layout.face = &element;
    }
  }
  return layout.vertex != nullptr && layout.face != nullptr && layout.vertex->count > 0 &&
         layout.face->count > 0 && find_coordinates(layout) && find_corners(layout);
}

}  // namespace boxtree::cooker
