// SPDX-License-Identifier: MIT
// One mesh through the stages in the order the data flows: build -> encode -> choose.
#include "cooker/cook.h"

#include <cstdint>
#include <span>
#include <utility>

namespace boxtree::cooker {

CookedTree cooked_of(TriedTree tried, std::size_t chosen, const CookOptions& options) {
  CookedTree cooked;
  cooked.collapsed = tried.collapsed[tried.nodes[chosen].family];
  cooked.tree = tried.take(chosen);
  cooked.contest = std::move(tried.contest);
  if (!options.face_ids) {
    cooked.left_out.push_back(
        {"face_ids", std::uint64_t{cooked.tree.face_count} * 4, "--no-face-ids"});
  }
  return cooked;
}

Result<CookedTree> cook_mesh(const SourceMesh& mesh, const CookOptions& options,
                             const std::optional<Grid>& scene) {
  Result<TriedTree> tried = try_encodings(mesh, options, scene);
  if (!tried) return tried.error();
  const auto chosen = choose(std::span(&tried->contest, 1), options.wishes);
  if (!chosen) return Error{chosen.code(), mesh.name + ": " + chosen.error().detail};
  return cooked_of(std::move(*tried), chosen->front(), options);
}

Result<EncodedTree> cook_as(const SourceMesh& mesh, CodecId codec, CookOptions options) {
  options.codec = codec;
  Result<CookedTree> cooked = cook_mesh(mesh, options);
  if (!cooked) return cooked.error();
  return std::move(cooked->tree);
}

}  // namespace boxtree::cooker
