// SPDX-License-Identifier: MIT
// What encoders produce: the bytes of sections, and what is known of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "cooker/build/build_tree.h"
#include "cooker/quantise/grid.h"
#include "format/binary_node.h"
#include "format/children.h"
#include "format/codec.h"

namespace boxtree::cooker {

/// Nodes visited, expected over all queries of a kind that reach the root box, by the decoded
/// boxes alone: the same on every machine.
///   ray   a uniformly distributed line: sum of areas over the root's area
///   box   a box with an edge of 5 % of the root's diagonal: sum of volumes, each box grown by it
///   pair  a body of half the root's size: likewise
struct ExpectedVisits {
  double ray = 0;
  double box = 0;
  double pair = 0;
};

/// What is known of the nodes of one tree in one codec, beside their bytes.
struct NodeFacts {
  CodecId codec{};
  RootKind root = RootKind::kEmpty;
  Box<double> root_box{};  // tree space
  std::uint32_t node_count = 0;
  std::uint32_t leaf_count = 0;
  std::uint32_t shrink_count = 0;
  std::uint32_t depth = 0;
  ExpectedVisits visits;
};

struct EncodedNodes : NodeFacts {
  std::vector<std::byte> bytes;
  // Of packed codecs: nodes of each NodeKind, and different cuts (dedup).
  std::array<std::uint32_t, kNodeKinds> kind_count{};
  std::size_t unique_cuts = 0;
};

/// Number that a leaf stores for a face: its position in tree order, or in the source.
enum class FaceOrder : std::uint8_t { kTree, kSource };

/// How packed codecs find the widths of their fields (paper sections 3.2 and 4.2).
enum class FieldWidths : std::uint8_t {
  kExact,      // from the finished tree
  kEstimated,  // from the number of faces alone, as a builder in one pass must
};

/// Vertices, corners, ids and duplicates in the form of their sections. The first two are empty for
/// geometry left external.
struct EncodedGeometry {
  GeometryId geometry = GeometryId::kExact;
  std::vector<std::byte> vertices;
  std::vector<std::byte> corners;
  std::vector<std::byte> face_ids;
  std::vector<std::byte> duplicates;
  std::uint32_t vertex_count = 0;
  std::uint8_t corner_bytes = 0;
  std::uint8_t corners_per_face = 0;
  std::uint8_t face_id_bytes = 0;
  std::uint8_t duplicate_bytes = 0;
  std::uint32_t duplicate_count = 0;
  int grid_exponent = 0;        // geometry grid: of its step in object space
  double max_vertex_error = 0;  // largest distance of a stored from a source vertex, object space
};

/// Source faces in the order of the leaves of a tree with one triangle per leaf, from left to
/// right.
[[nodiscard]] std::vector<std::uint32_t> faces_in_tree_order(const BuildTree& tree);

/// Faces in `order`, vertices in order of first use by them, positions bit for bit.
[[nodiscard]] EncodedGeometry encode_exact_geometry(const SourceMesh& mesh,
                                                    std::span<const std::uint32_t> order,
                                                    bool face_ids);

/// Whether the faces of a leaf may change places: not when each is a leaf of its own.
enum class LeafOrder : std::uint8_t { kFixed, kFree };

/// Faces in `order`, but for their places within groups of kLeafFaces, as clusters on a grid (see
/// format/grid.h). On return `order` is that of the clusters.
[[nodiscard]] EncodedGeometry encode_grid_geometry(const QuantisedMesh& quantised,
                                                   std::vector<std::uint32_t>& order,
                                                   LeafOrder leaf_order, bool face_ids);

/// Nothing but, unless `order` is empty, the face ids through which a reader finds the
/// application's faces.
[[nodiscard]] EncodedGeometry encode_external_geometry(const SourceMesh& mesh,
                                                       std::span<const std::uint32_t> order);

/// The places of the originals of all duplicates, ascending, as their section.
void encode_duplicates(std::span<const std::uint32_t> originals, EncodedGeometry& out);

}  // namespace boxtree::cooker
