// SPDX-License-Identifier: MIT
// Cooks one mesh without writing a file: for tests, reports and programs that keep trees in memory.
#include <span>
#include <utility>

#include "cooker/cook.h"
#include "cooker/import/mesh_arrays.h"

namespace boxtree::cooker {

Result<CookedTree> cook_mesh(const SourceMesh& mesh, const CookOptions& options,
                             const std::optional<Grid>& scene) {
  Result<TriedTree> tried = try_encodings(mesh, options, scene);
  if (!tried) return tried.error();
  const auto chosen = choose(std::span(&tried->contest, 1), options.wishes);
  if (!chosen) return Error{chosen.code(), mesh.name + ": " + chosen.error().detail};
  CookedTree cooked;
  cooked.edges = count_surface_edges(arrays_of(mesh));
  cooked.collapsed = tried->collapsed_of(chosen->front());
  cooked.tree = tried->take(chosen->front());
  cooked.contest = std::move(tried->contest);
  return cooked;
}

Result<EncodedTree> cook_as(const SourceMesh& mesh, CodecId codec, CookOptions options) {
  options.codec = codec;
  Result<CookedTree> cooked = cook_mesh(mesh, options);
  if (!cooked) return cooked.error();
  return std::move(cooked->tree);
}

}  // namespace boxtree::cooker
