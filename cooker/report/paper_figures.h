// SPDX-License-Identifier: MIT
// Figures of the paper's tables for any mesh, with the paper's builder: sizes, and times of
// opening. Times of queries come from programs that run the original.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cooker/report/node_counts.h"
#include "cooker/report/rounding.h"
#include "format/blob.h"

namespace boxtree::cooker {

/// Bytes of one codec's nodes section.
struct CodecSizes {
  CodecId codec;
  double exact = 0;      // widths from the finished tree
  double estimated = 0;  // widths from the number of faces; the same for codecs without widths
};

/// One whole-file compression (table 3.1 as numbers).
struct BlobSizes {
  std::string name;
  double tree_bytes = 0;      // the nodes section alone, compressed
  double file_bytes = 0;      // on disk
  double resident_bytes = 0;  // once open
  double open_us = 0;         // from the closed file to the first answer
};

struct PaperFigures {
  std::string mesh;
  std::uint64_t triangles = 0;
  std::uint64_t faces = 0;
  std::uint64_t original_nodes = 0;  // inner nodes and leaves, as the original stores them
  std::uint64_t merged_nodes = 0;    // with leaves in their parents
  std::uint64_t shrink_nodes = 0;
  std::uint32_t depth = 0;
  std::array<std::uint32_t, kNodeKinds> kinds{};
  std::uint64_t cuts = 0;
  std::uint64_t unique_cuts = 0;
  std::vector<CodecSizes> codecs;
  std::vector<BlobSizes> blobs;
  double mapped_open_us = 0;  // plain-f32, mapped, for comparison with the blobs
  double mapped_file_bytes = 0;
  CountedSizes counted;
  RoundingFigures rounding;

  [[nodiscard]] const CodecSizes& codec(CodecId id) const;
  [[nodiscard]] double unique_share() const {
    return static_cast<double>(unique_cuts) / static_cast<double>(cuts);
  }
};

/// Builds a tree, encodes it with every codec, packed ones with both kinds of widths, and proves
/// each. Errors: as cook_mesh; kNoFaces if the mesh has fewer than two faces (its tree has no nodes
/// to count); those of a temporary file.
Result<PaperFigures> paper_figures(const SourceMesh& mesh);

}  // namespace boxtree::cooker
