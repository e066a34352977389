// SPDX-License-Identifier: MIT
// Uses stored arrays directly; decodes a grid leaf by leaf and welds its vertices.
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

// The order of stored faces; empty if they are stored in the requested order.
Result<std::vector<std::uint32_t>> stored_order(const Tree& tree, ExportOrder order) {
  const std::uint32_t count = tree.face_count();
  if (order == ExportOrder::kSource && !tree.has_face_ids() && !tree.empty()) {
    return Error{Errc::kPartLeftOut,
                 fmt::format("{}: face ids were left out when it was cooked, so that the order of "
                             "its source is not known",
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
  if (BoundTree::of(tree).leaves().is_grid()) {
    if (Status status = faces.decode_grid(tree); !status) return status.error();
  } else {
    faces.arrays_ = BoundTree::of(tree).leaves().mesh();
  }
  if (Status status = faces.check(); !status) {
    return Error{status.code(), fmt::format("{}: {}", tree.name(), status.error().detail)};
  }
  return faces;
}

Status DecodedFaces::decode_grid(const Tree& tree) {
  const std::uint32_t count = tree.face_count();
  decoded_.positions.precision = Precision::kF64;
  decoded_.faces.reserve(count);
  Welder<double> welder(decoded_.positions.f64, count / 2);  // as many as a closed surface has
  const auto number_of = [&](const TriangleBatch& batch, std::uint32_t triangle,
                             std::size_t corner) {
    const Eigen::Vector3d p =
        BoundTree::of(tree).frame().to_object(batch.triangle(triangle).corner[corner]);
    return welder.add({p[0], p[1], p[2]});
  };
  TriangleBatch batch;
  for (std::uint32_t first = 0; first < count; first += kLeafFaces) {
    const std::uint32_t faces = std::min(kLeafFaces, count - first);
    if (const Errc error = BoundTree::of(tree).leaves().read(first, faces, batch);
        error != Errc::kOk) {
      return Error{error, fmt::format("{}: faces from {} on cannot be read", tree.name(), first)};
    }
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      if (i > 0 && batch.face[i] == batch.face[i - 1]) {
        decoded_.faces.back().corner[3] = number_of(batch, i, 2);
        continue;
      }
      decoded_.faces.push_back(
          {{number_of(batch, i, 0), number_of(batch, i, 1), number_of(batch, i, 2), kNoCorner}});
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
