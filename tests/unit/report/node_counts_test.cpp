// SPDX-License-Identifier: MIT
// Counted sizes against sizes that were really written, and against a tree small enough for a pen.
#include <gtest/gtest.h>

#include "cooker/report/paper_figures.h"
#include "format/codec_packed.h"
#include "format/codec_plain.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree::cooker {
namespace {

PaperFigures figures_of(const SourceMesh& mesh) {
  Result<PaperFigures> figures = paper_figures(mesh);
  if (!figures) throw std::runtime_error(figures.error().message());
  return std::move(*figures);
}

// Header, rounding of four arrays and padding are all that the count leaves out.
TEST(NodeCounts, PackedSizeIsTheOneWritten) {
  for (const SourceMesh& mesh : {test::sphere(24, 32), test::torus(40, 24)}) {
    const PaperFigures figures = figures_of(mesh);
    const double written = figures.codec(CodecId::kPackedF16).exact;
    const double counted = figures.counted.two_cut_shrink;
    EXPECT_GE(written, counted + static_cast<double>(sizeof(PackedHeader)));
    EXPECT_LE(written, counted + static_cast<double>(sizeof(PackedHeader) + kBitPadding + 4 * 8));
  }
}

// A tree of these nodes, as deep as there are nodes.
EncodedNodes chain_of(std::span<const PlainNodeF32> chain) {
  EncodedNodes nodes;
  nodes.codec = CodecId::kPlainF32;
  nodes.root = RootKind::kSubtree;
  nodes.node_count = nodes.depth = static_cast<std::uint32_t>(chain.size());
  const auto bytes = std::as_bytes(chain);
  nodes.bytes.assign(bytes.begin(), bytes.end());
  return nodes;
}

// Two faces side by side: one node with two leaves.
TEST(NodeCounts, OneNodeByHand) {
  const PlainNodeF32 node{plain_cutplane(0, PlainChild::kLeaf, PlainChild::kLeaf), {0, 1}, {1, 1}};
  const CountedSizes sizes = count_sizes(chain_of({&node, 1}), 2);
  EXPECT_EQ(sizes.implicit_slots, 1);    // 2^1 - 1
  EXPECT_EQ(sizes.implicit, 8);          // bytes a slot
  EXPECT_EQ(sizes.whole_bytes_f16, 7);   // axis 1, numbers 1 + 1, cuts 2 + 2
  EXPECT_EQ(sizes.whole_bytes_f32, 11);  // cuts 4 + 4
  EXPECT_EQ(sizes.own_sizes, 7);         // 2 + 32 + 2 * (5 + 1) = 46 bits, and the length
  EXPECT_EQ(sizes.branching4, 32);
  EXPECT_EQ(sizes.branching8, 64);
  EXPECT_EQ(sizes.two_cut_shrink, 5);  // 2 + 2 * 1 + 32 = 36 bits
  EXPECT_EQ(sizes.one_cut_shrink, 5);  // no shrink node, no subtree
}

// Three nodes in a row, the first one a shrink node: two levels leave two nodes, three leave one.
TEST(NodeCounts, ChainByHand) {
  const PlainNodeF32 chain[3] = {
      {plain_cutplane(0, PlainChild::kSubtree, PlainChild::kNone), {1, kPlainNoChild}, {1, 0}},
      {plain_cutplane(1, PlainChild::kLeaf, PlainChild::kSubtree), {0, 2}, {1, 1}},
      {plain_cutplane(2, PlainChild::kLeaf, PlainChild::kLeaf), {1, 2}, {1, 1}}};
  const CountedSizes sizes = count_sizes(chain_of(chain), 3);
  EXPECT_EQ(sizes.implicit_slots, 7);
  EXPECT_EQ(sizes.branching4, 2 * 32);
  EXPECT_EQ(sizes.branching8, 64);
  // Numbers of nodes take 1 bit (one of a kind), faces 2. Shrink: 34 + 2 * (2 + 1); left leaf:
  // 34 + 2 + 3; two leaves: 34 + 2 * 2. In all 117 bits.
  EXPECT_EQ(sizes.two_cut_shrink, 15);
  // Shrink: 2 + 3 + 1 + 16; left leaf: 34 + 2 + 4; two leaves: 38. In all 100 bits.
  EXPECT_EQ(sizes.one_cut_shrink, 13);
}

TEST(PaperFigures, CountsAgreeWithEachOther) {
  const SourceMesh mesh = test::torus(40, 24);
  const PaperFigures figures = figures_of(mesh);
  EXPECT_EQ(figures.original_nodes, figures.merged_nodes + mesh.faces.size());
  EXPECT_EQ(figures.codec(CodecId::kPlainF32).exact,
            20.0 * static_cast<double>(figures.merged_nodes));
  EXPECT_EQ(figures.codec(CodecId::kPlainF16).exact,
            16.0 * static_cast<double>(figures.merged_nodes));
  std::uint64_t kinds = 0;
  for (const std::uint32_t kind : figures.kinds) kinds += kind;
  EXPECT_EQ(kinds, figures.merged_nodes);
  EXPECT_LE(figures.unique_cuts, figures.cuts);
  for (const CodecSizes& codec : figures.codecs) EXPECT_GE(codec.estimated, codec.exact);
  for (const BlobSizes& blob : figures.blobs) {
    EXPECT_LT(blob.file_bytes, figures.mapped_file_bytes);
    EXPECT_GT(blob.open_us, 0);
  }
}

TEST(PaperFigures, OneFaceHasNoNodes) {
  SourceMesh mesh;
  mesh.positions.f32 = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  mesh.faces = {{{0, 1, 2, kNoCorner}}};
  EXPECT_EQ(paper_figures(mesh).code(), Errc::kNoFaces);
}

}  // namespace
}  // namespace boxtree::cooker
