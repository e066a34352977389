// SPDX-License-Identifier: MIT
// Uses stored arrays directly; decodes clusters leaf by leaf and welds their vertices.
#include "cooker/export/decoded_faces.h"

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cooker/import/mesh_arrays.h"
#include "cooker/import/weld.h"
#include "format/limits.h"

namespace boxtree::cooker {
namespace {

bool is_external(const Tree& tree) {
  return BoundTree::of(tree).geometry() == GeometryId::kExternal;
}

std::vector<std::uint32_t> face_ids_of(const Tree& tree) {
  std::vector<std::uint32_t> ids(tree.face_count());
  for (std::uint32_t f = 0; f < ids.size(); ++f) ids[f] = BoundTree::of(tree).face_id(f);
  return ids;
}

// A position of a cluster. Sums are exact but on a grid, whose points may have more digits.
Eigen::Vector3d in_object_space(const LeafReader& leaves, const std::array<double, 3>& stored) {
  Eigen::Vector3d p(stored[0], stored[1], stored[2]);
  if (!leaves.is_from_origin()) return p;
  if (leaves.is_grid()) p *= leaves.grid_step() * leaves.frame().scale;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (leaves.frame().origin[k] != 0) p[k] += leaves.frame().origin[k];  // 0 would take -0 away
  }
  return p;
}

// The order of stored faces; empty if they are stored in the requested order.
Result<std::vector<std::uint32_t>> stored_order(const Tree& tree, ExportOrder order) {
  const std::uint32_t count = tree.face_count();
  if (order == ExportOrder::kSource && !tree.has_face_ids() && !tree.empty()) {
    return Error{Errc::kPartLeftOut,
                 fmt::format("{}: face ids were left out when it was cooked, so that the order of "
                             "its source is not known: use --order tree, or cook without "
                             "--no-face-ids",
                             tree.name())};
  }
  const bool stored_as_source = is_external(tree) || BoundTree::of(tree).is_in_source_order();
  const bool stored_as_tree = BoundTree::of(tree).leaves().is_in_tree_order();
  if (order == ExportOrder::kSource ? stored_as_source : stored_as_tree) {
    return std::vector<std::uint32_t>();
  }
  std::vector<std::uint32_t> ids = face_ids_of(tree);
  if (order == ExportOrder::kTree) {  // external arrays: ids are indices into them
    for (const std::uint32_t id : ids) {
      if (id < count) continue;
      return Error{Errc::kFaceOutOfRange, fmt::format("{}: face {} of {}", tree.name(), id, count)};
    }
    return ids;
  }
  std::vector<std::uint32_t> sorted(count);
  std::iota(sorted.begin(), sorted.end(), 0u);
  std::stable_sort(sorted.begin(), sorted.end(),
                   [&ids](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
  return sorted;
}

}  // namespace

bool has_f32_positions(const Tree& tree) {
  return BoundTree::of(tree).geometry() != GeometryId::kGrid &&
         !BoundTree::of(tree).has_f64_positions();
}

Result<DecodedFaces> DecodedFaces::decode(const Tree& tree, ExportOrder order) {
  DecodedFaces faces;
  if (tree.empty()) return faces;
  Result<std::vector<std::uint32_t>> stored = stored_order(tree, order);
  if (!stored) return stored.error();
  faces.order_ = std::move(*stored);
  if (BoundTree::of(tree).leaves().has_clusters()) {
    if (Status status = faces.decode_clusters(tree); !status) return status.error();
  } else {
    faces.arrays_ = BoundTree::of(tree).leaves().mesh();
  }
  if (Status status = faces.check(); !status) {
    return Error{status.code(), fmt::format("{}: {}", tree.name(), status.error().detail)};
  }
  return faces;
}

Status DecodedFaces::decode_clusters(const Tree& tree) {
  const LeafReader& leaves = BoundTree::of(tree).leaves();
  if (leaves.clusters().numbers == ClusterNumbers::kF32) {
    decoded_.positions.precision = Precision::kF32;
    return weld_clusters(tree, decoded_.positions.f32);
  }
  decoded_.positions.precision = Precision::kF64;
  return weld_clusters(tree, decoded_.positions.f64);
}

template <class Scalar>
Status DecodedFaces::weld_clusters(const Tree& tree, std::vector<Scalar>& positions) {
  const LeafReader& leaves = BoundTree::of(tree).leaves();
  const std::uint32_t count = tree.face_count();
  decoded_.faces.reserve(count);
  Welder<Scalar> welder(positions, count / 2);  // as many as a closed surface has
  FoundCluster found;
  ClusterLeaf leaf;
  for (std::uint32_t i = 0; i < leaves_of(count); ++i) {
    if (!decode_cluster_leaf(leaves.clusters(), i, found, leaf)) {
      return Error{Errc::kVertexOutOfRange,
                   fmt::format("{}: leaf {} of its clusters cannot be read", tree.name(), i)};
    }
    // Numbered in the order of faces and of their corners.
    std::array<std::uint32_t, kMostLeafReferences> number;
    number.fill(kNoCorner);
    const auto vertex = [&](std::uint8_t v) {
      if (number[v] != kNoCorner) return number[v];
      const Eigen::Vector3d p = in_object_space(leaves, leaf.position[v]);
      return number[v] = welder.add(
                 {static_cast<Scalar>(p[0]), static_cast<Scalar>(p[1]), static_cast<Scalar>(p[2])});
    };
    for (std::uint32_t f = 0; f < leaf.face_count; ++f) {
      Face face{{kNoCorner, kNoCorner, kNoCorner, kNoCorner}};
      for (std::size_t c = 0; c < 4; ++c) {
        const std::uint8_t corner = leaf.corner[f][c];
        if (corner != ClusterLeaf::kNoCorner) face.corner[c] = vertex(corner);
      }
      decoded_.faces.push_back(face);
    }
  }
  arrays_ = arrays_of(decoded_);
  return {};
}

Status DecodedFaces::check() {
  for (std::uint32_t v = 0; v < vertex_count(); ++v) {
    if (!position(v).allFinite()) {
      return Error{Errc::kVertexNotFinite, fmt::format("vertex {} is not finite", v)};
    }
  }
  for (std::uint32_t f = 0; f < face_count(); ++f) {
    const std::array<std::uint32_t, 4> corner = face_of(arrays_, f);
    const std::size_t corners = corner[3] == kMissingCorner ? 3 : 4;
    for (std::size_t i = 0; i < corners; ++i) {
      if (corner[i] < vertex_count()) continue;
      return Error{Errc::kVertexOutOfRange,
                   fmt::format("face {} names vertex {} of {}", f, corner[i], vertex_count())};
    }
    triangle_count_ += corners - 2;
  }
  return {};
}

}  // namespace boxtree::cooker
