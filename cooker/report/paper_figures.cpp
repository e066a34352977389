// SPDX-License-Identifier: MIT
// Encodes one mesh with every variant of the paper.
#include "cooker/report/paper_figures.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <boxtree/blob.h>
#include <boxtree/boxtree.h>

#include "cooker/choose/measure.h"
#include "cooker/cook.h"
#include "cooker/report/scratch_file.h"

namespace boxtree::cooker {
namespace {

constexpr std::size_t kOpenRuns = 5;

Result<BlobSizes> measure_blob(const EncodedTree& tree, BlobMethod method) {
  BlobSizes sizes;
  sizes.name = method == BlobMethod::kLzma ? "blob-lzma" : "blob-zstd";
  const Result<std::uint64_t> nodes = compressed_size(tree.nodes.bytes, method);
  if (!nodes) return nodes.error();
  sizes.tree_bytes = static_cast<double>(*nodes);
  const std::vector<std::byte> file = serialize(std::span(&tree, 1));
  const Result<std::vector<std::byte>> blob = make_blob(file, method);
  if (!blob) return blob.error();
  sizes.file_bytes = static_cast<double>(blob->size());
  sizes.resident_bytes = static_cast<double>(file.size());
  const Result<ScratchFile> scratch = ScratchFile::create(*blob);
  if (!scratch) return scratch.error();
  Status status;
  sizes.open_us = 1e6 * median_seconds(kOpenRuns, [&] {
                    const Result<File> opened = open_blob(scratch->path().string());
                    const Result<Tree> bound =
                        opened ? Tree::bind(*opened) : Result<Tree>(opened.error());
                    const Status answered = bound ? first_query(*bound) : bound.error();
                    if (!answered) status = answered;
                  });
  if (!status) return status.error();
  return sizes;
}

Status measure_mapped(const EncodedTree& tree, PaperFigures& figures) {
  const std::vector<std::byte> file = serialize(std::span(&tree, 1));
  const Result<ScratchFile> scratch = ScratchFile::create(file);
  if (!scratch) return scratch.error();
  const Result<OpenFigures> open = measure_open(scratch->path(), 0, 20 * kOpenRuns);
  if (!open) return open.error();
  figures.mapped_open_us = open->first_answer_us;
  figures.mapped_file_bytes = static_cast<double>(file.size());
  return {};
}

}  // namespace

const CodecSizes& PaperFigures::codec(CodecId id) const {
  return *std::find_if(codecs.begin(), codecs.end(),
                       [id](const CodecSizes& sizes) { return sizes.codec == id; });
}

Result<PaperFigures> paper_figures(const SourceMesh& mesh) {
  PaperFigures figures;
  figures.mesh = mesh.name;
  figures.triangles = mesh.triangle_count();
  figures.faces = mesh.faces.size();
  if (mesh.faces.size() < 2) {
    return Error{Errc::kNoFaces, mesh.name + ": a tree of nodes needs two faces"};
  }
  std::optional<EncodedTree> f32;
  std::optional<EncodedTree> f16;
  CookOptions options;
  options.builder = Builder::kPaper;
  options.face_ids = false;
  CookOptions with_estimate = options;
  with_estimate.widths = FieldWidths::kEstimated;
  for (const CodecInfo& codec : kCodecs) {
    CodecSizes sizes{codec.id};
    Result<EncodedTree> exact = cook_as(mesh, codec.id, options);
    if (!exact) return exact.error();
    sizes.exact = static_cast<double>(exact->nodes.bytes.size());
    sizes.estimated = sizes.exact;
    if (is_packed(codec.id)) {
      const Result<EncodedTree> estimated = cook_as(mesh, codec.id, with_estimate);
      if (!estimated) return estimated.error();
      sizes.estimated = static_cast<double>(estimated->nodes.bytes.size());
    }
    figures.codecs.push_back(sizes);
    if (codec.id == CodecId::kPackedF32) figures.kinds = exact->nodes.kind_count;
    if (codec.id == CodecId::kDedup) figures.unique_cuts = exact->nodes.unique_cuts;
    if (codec.id == CodecId::kPlainF32) f32 = std::move(*exact);
    if (codec.id == CodecId::kPlainF16) f16 = std::move(*exact);
  }
  figures.merged_nodes = f32->nodes.node_count;
  figures.original_nodes = figures.merged_nodes + figures.faces;
  figures.shrink_nodes = f32->nodes.shrink_count;
  figures.depth = f32->nodes.depth;
  figures.cuts = 2 * figures.merged_nodes;
  figures.counted = count_sizes(f32->nodes, static_cast<std::uint32_t>(figures.faces));
  for (const BlobMethod method : {BlobMethod::kLzma, BlobMethod::kZstd}) {
    Result<BlobSizes> blob = measure_blob(*f32, method);
    if (!blob) return blob.error();
    figures.blobs.push_back(std::move(*blob));
  }
  if (Status status = measure_mapped(*f32, figures); !status) return status.error();
  const Result<RoundingFigures> rounding = aligned_contact(mesh, *f32, *f16);
  if (!rounding) return rounding.error();
  figures.rounding = *rounding;
  return figures;
}

}  // namespace boxtree::cooker
