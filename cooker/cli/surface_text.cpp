// SPDX-License-Identifier: MIT
#include "cooker/cli/surface_text.h"

#include <cstdint>
#include <utility>
#include <vector>

#include <fmt/format.h>

namespace boxtree::cooker {

std::string surface_text(const SurfaceEdges& edges) {
  if (edges.is_closed()) return "closed";
  if (edges.is_empty) return "no edges";
  std::vector<std::string> kinds;
  std::uint64_t last = 0;
  for (const auto& [count, kind] :
       {std::pair(edges.open, "open"), std::pair(edges.non_manifold, "non-manifold"),
        std::pair(edges.inconsistent, "inconsistently oriented")}) {
    if (count == 0) continue;
    kinds.push_back(fmt::format("{} {}", count, kind));
    last = count;
  }
  std::string text = kinds.front();
  for (std::size_t i = 1; i < kinds.size(); ++i) {
    text += (i + 1 == kinds.size() ? " and " : ", ") + kinds[i];
  }
  return text + (kinds.size() == 1 && last == 1 ? " edge" : " edges");
}

Json surface_json(const SurfaceEdges& edges) {
  return {{"closed", edges.is_closed()},
          {"open_edges", edges.open},
          {"non_manifold_edges", edges.non_manifold},
          {"inconsistent_edges", edges.inconsistent}};
}

SurfaceEdges surface_of(const Json& json) {
  SurfaceEdges edges{json["open_edges"].get<std::uint64_t>(),
                     json["non_manifold_edges"].get<std::uint64_t>(),
                     json["inconsistent_edges"].get<std::uint64_t>()};
  edges.is_empty = edges.is_closed() && !json["closed"].get<bool>();
  return edges;
}

}  // namespace boxtree::cooker
