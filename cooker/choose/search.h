// SPDX-License-Identifier: MIT
// Searches the encodings of one mesh: codec x geometry store. Each is encoded, proven and measured
// by counting. Encodings that cannot win are skipped and listed.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "cooker/build/active_edges.h"
#include "cooker/build/build_tree.h"
#include "cooker/choose/choose.h"
#include "cooker/encode/encoded_tree.h"
#include "cooker/encode/encoders.h"
#include "cooker/import/source_mesh.h"
#include "cooker/quantise/grid.h"

namespace boxtree::cooker {

struct SearchOptions {
  std::optional<CodecId> codec;  // empty: the best of all [default]
  Wishes wishes;
  Builder builder = Builder::kSah;
  FieldWidths widths = FieldWidths::kExact;
  GeometryId geometry = GeometryId::kExact;
  // With geometry exact, what else may be chosen: a grid, and arrays, which are larger but faster.
  // Codecs with one triangle per leaf have arrays in any case.
  bool may_use_grid = false;
  bool may_use_arrays = false;
  GridChoice grid;       // of geometry grid
  bool try_all = false;  // also encodings that cannot win
  /// Keep the bytes of every candidate. If false, those are freed that choose() cannot choose with
  /// `wishes`.
  bool keep_all = false;
  bool face_ids = true;
  /// Keep EncodedTree::face_order. [false]
  bool face_order = false;
  /// The mesh is a part of a larger one: where f32 positions are far from the origin, tree space is
  /// not moved to them, so that numbers of answers are those of the whole, bit for bit. [false]
  bool is_part = false;
  /// Store active edges: those at which the surface bends away by more than so many degrees [none].
  std::optional<double> active_edges;
  /// Those of the mesh, if they are known already, as in a scene [none: found in the mesh alone].
  const ActiveEdges* known_edges = nullptr;
  std::vector<CodecCost> costs;  // for the user's machine; empty: those compiled in [default]
  /// Binary codecs: the share of a box that must be empty to be cut off [kShrinkShare] [0.01 to 1;
  /// 1: never].
  double shrink_share = kShrinkShare;
};

/// Meshes with fewer faces than this are tried with all codecs, which takes no noticeable time. For
/// larger meshes, codecs with one triangle per leaf are skipped: they take more than ten times the
/// bytes of nodes, and on every mesh measured they took 1.6 to 25 times as long
/// (docs/MEASUREMENTS.md, "Our own codecs beside the others").
inline constexpr std::size_t kTryAllFaces = 4096;

/// Whether a grid may win: false if only time counts and there is no budget of bytes. Then a grid
/// is tried only with options.try_all.
[[nodiscard]] bool may_grid_win(const Wishes& wishes) noexcept;

/// The encodings of one mesh. Candidates with the same tree and order of faces share all parts
/// except nodes. Without SearchOptions::keep_all, the bytes of candidates that cannot be chosen are
/// empty.
struct TriedTree {
  struct Nodes {
    std::size_t family;
    EncodedNodes nodes;
  };
  Contest contest;
  std::vector<Nodes> nodes;              // of each candidate
  std::vector<EncodedTree> families;     // without nodes
  std::vector<std::uint32_t> collapsed;  // of each family: triangles without area on the grid

  [[nodiscard]] std::uint32_t collapsed_of(std::size_t candidate) const {
    return collapsed[nodes[candidate].family];
  }

  /// Moves the tree of a candidate out; the others are freed. Precondition: its bytes were kept.
  [[nodiscard]] EncodedTree take(std::size_t candidate);
};

/// Deterministic. Precondition: import's guarantees on meshes. `scene`: the grid shared with other
/// meshes; by default one for this mesh alone. Errors: kMeshTooLarge; kMeshUnsupported if faces of
/// an n-gon would have to stay external, or if only a grid is allowed and it cannot be as fine as
/// requested. Errors do not name the mesh.
Result<TriedTree> try_encodings(const SourceMesh& mesh, const SearchOptions& options,
                                const std::optional<Grid>& scene = {});

}  // namespace boxtree::cooker
