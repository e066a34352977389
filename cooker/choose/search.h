// SPDX-License-Identifier: MIT
// The search over encodings of one mesh: codec x geometry store. Each is encoded, proven and
// measured by counting; what cannot win is left out, and listed.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cooker/build/build_tree.h"
#include "cooker/choose/choose.h"
#include "cooker/encode/encoded_tree.h"
#include "cooker/encode/encoders.h"
#include "cooker/import/source_mesh.h"
#include "cooker/quantise/grid.h"

namespace boxtree::cooker {

struct SearchOptions {
  std::optional<CodecId> codec;  // nothing: the best of all [default]
  Wishes wishes;
  Builder builder = Builder::kSah;
  FieldWidths widths = FieldWidths::kExact;
  GeometryId geometry = GeometryId::kExact;
  bool may_use_grid = false;  // with geometry exact: a grid may be chosen as well
  GridChoice grid;            // of geometry grid
  bool try_all = false;       // also what cannot win
  bool face_ids = true;
  std::vector<CodecCost> costs;  // of the user's machine; empty: those compiled in [default]
  /// Of binary codecs: the share of a box that must be empty to be cut off [kShrinkShare] [0.01 to
  /// 1; 1: never].
  double shrink_share = kShrinkShare;
};

/// Below so many faces all codecs are tried: that takes no time. From there on, codecs with one
/// face a leaf are not: each node of theirs is larger than ten of ours, and on every mesh measured
/// they took 1.6 to 25 times as long (docs/MEASUREMENTS.md, "Our own codecs beside the others").
inline constexpr std::size_t kTryAllFaces = 4096;

/// Whether a grid may win: not where only time counts, and no budget of bytes. Otherwise it is
/// tried only if options.try_all says so.
[[nodiscard]] bool may_grid_win(const Wishes& wishes) noexcept;

/// The encodings of one mesh. Candidates that share a tree and an order of faces share all but
/// their nodes.
struct TriedTree {
  struct Nodes {
    std::size_t family;
    EncodedNodes nodes;
  };
  Contest contest;
  std::vector<Nodes> nodes;              // of each candidate
  std::vector<EncodedTree> families;     // without nodes
  std::vector<std::uint32_t> collapsed;  // of each family: triangles that lost their area on a grid

  [[nodiscard]] std::uint32_t collapsed_of(std::size_t candidate) const {
    return collapsed[nodes[candidate].family];
  }

  /// The tree of a candidate; the others are gone then.
  [[nodiscard]] EncodedTree take(std::size_t candidate);
};

/// Deterministic. Precondition: what import promises of a mesh. `scene`: the grid shared with other
/// meshes; by default one for this mesh alone. Errors: kMeshTooLarge; kMeshUnsupported when faces
/// of an n-gon would have to stay external, or the only geometry allowed is a grid that cannot be
/// as fine as requested.
Result<TriedTree> try_encodings(const SourceMesh& mesh, const SearchOptions& options,
                                const std::optional<Grid>& scene = {});

}  // namespace boxtree::cooker
