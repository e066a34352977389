// SPDX-License-Identifier: MIT
// The output of encoders: the bytes of sections, and facts about them.
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

/// Expected number of nodes visited by the queries of a kind that reach the root box. It depends
/// only on decoded boxes, so it is the same on every machine.
///   ray   a uniformly distributed line: sum of areas over the root's area
///   box   a box with an edge of 5 % of the root's diagonal: sum of volumes, each box grown by it
///   pair  a body of half the root's size: the same
struct ExpectedVisits {
  double ray = 0;
  double box = 0;
  double pair = 0;
};

/// Facts about the nodes of one tree in one codec.
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
  // Packed codecs: number of nodes of each NodeKind, and of different cuts (dedup).
  std::array<std::uint32_t, kNodeKinds> kind_count{};
  std::size_t unique_cuts = 0;
};

/// The number that a leaf stores for a face: its index in tree order or in the source.
enum class FaceOrder : std::uint8_t { kTree, kSource };

/// How packed codecs choose the widths of their fields (paper sections 3.2 and 4.2).
enum class FieldWidths : std::uint8_t {
  kExact,      // from the finished tree
  kEstimated,  // from the number of faces, as a builder in one pass must
};

/// Vertices, corners, ids and duplicates, as bytes of their sections. The first two are empty for
/// external geometry; ids are empty if they are left out or those of the tree's own order.
struct EncodedGeometry {
  GeometryId geometry{};
  std::vector<std::byte> vertices;
  std::vector<std::byte> corners;
  std::vector<std::byte> face_ids;
  std::vector<std::byte> duplicates;
  std::vector<std::byte> active_edges;  // empty if they are left out
  std::uint8_t corner_bytes = 0;
  std::uint8_t corners_per_face = 0;
  std::uint8_t duplicate_bytes = 0;
  std::uint32_t duplicate_count = 0;
  std::uint64_t face_id_bytes = 0;  // that ids take, or would take if they were not left out
  int grid_exponent = 0;            // geometry grid: of its step in object space
  double max_vertex_error = 0;  // largest distance of a stored from a source vertex, object space
};

/// Source faces in the order of the leaves, from left to right, of a tree with one triangle per
/// leaf.
[[nodiscard]] std::vector<std::uint32_t> faces_in_tree_order(const BuildTree& tree);

/// Faces in `order`, vertices in order of first use, positions bit for bit.
[[nodiscard]] EncodedGeometry encode_array_geometry(const SourceMesh& mesh,
                                                    std::span<const std::uint32_t> order);

/// Whether the faces of a leaf may be reordered: kFixed for trees with one triangle per leaf.
enum class LeafOrder : std::uint8_t { kFixed, kFree };

/// Faces in `order`, as clusters (see format/cluster.h), positions on a grid or bit for bit. Faces
/// may be reordered within groups of kLeafFaces; on return, `order` is the order stored. `origin`:
/// of the tree, from which f32 positions count; see choose_frame().
[[nodiscard]] EncodedGeometry encode_exact_geometry(const SourceMesh& mesh,
                                                    const std::array<double, 3>& origin,
                                                    std::vector<std::uint32_t>& order,
                                                    LeafOrder leaf_order);
[[nodiscard]] EncodedGeometry encode_grid_geometry(std::span<const Face> faces,
                                                   const QuantisedPositions& quantised,
                                                   std::vector<std::uint32_t>& order,
                                                   LeafOrder leaf_order);

/// No geometry: the application has the arrays.
[[nodiscard]] EncodedGeometry encode_external_geometry();

/// The places of the originals of all duplicates, ascending, as their section.
void encode_duplicates(std::span<const std::uint32_t> originals, EncodedGeometry& out);

}  // namespace boxtree::cooker
