// SPDX-License-Identifier: MIT
// Cooking in memory.
#include "tests/oracle/exact/subject.h"

#include <algorithm>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "cooker/cook.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/require.h"

namespace boxtree::oracle {
namespace {

using cooker::SourceMesh;

MeshArrays arrays_of(const SourceMesh& mesh) {
  MeshArrays arrays;
  arrays.positions_f64 = mesh.positions.precision == cooker::Precision::kF64;
  arrays.positions = arrays.positions_f64
                         ? reinterpret_cast<const std::byte*>(mesh.positions.f64.data())
                         : reinterpret_cast<const std::byte*>(mesh.positions.f32.data());
  arrays.position_stride = 3 * (arrays.positions_f64 ? sizeof(double) : sizeof(float));
  arrays.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  // Faces are their four corner numbers, one after the other.
  static_assert(sizeof(cooker::Face) == 4 * sizeof(std::uint32_t));
  arrays.corners = reinterpret_cast<const std::byte*>(mesh.faces.data());
  arrays.corner_bytes = 4;
  arrays.corners_per_face = 4;
  arrays.face_count = static_cast<std::uint32_t>(mesh.faces.size());
  return arrays;
}

std::unique_ptr<Cooked> cook(const SourceMesh& mesh, CodecId codec, GeometryId geometry) {
  cooker::CookOptions options;
  options.geometry = geometry;
  options.grid.bits = 24;
  const auto encoded = cooker::cook_as(mesh, codec, options);
  if (!encoded && geometry == GeometryId::kGrid && encoded.code() == Errc::kMeshUnsupported) {
    return nullptr;
  }
  if (!encoded) {
    throw CookFailed{mesh, std::string(codec_name(codec)) + " " +
                               std::string(geometry_name(geometry)) + ": " +
                               encoded.error().message()};
  }
  std::vector<std::byte> bytes = cooker::serialize(std::span(&*encoded, 1));
  File file = test::require(File::open(Bytes(bytes)));
  BindOptions bind;
  if (geometry == GeometryId::kExternal) bind.mesh = arrays_of(mesh);
  Tree tree = test::require(Tree::bind(file, 0, bind));
  return std::make_unique<Cooked>(
      Cooked{std::string(codec_name(codec)) + " " + std::string(geometry_name(geometry)), codec,
             std::move(bytes), std::move(file), std::move(tree)});
}

void finish(Group& group) {
  group.space = BoundTree::of(group.trees.front()->tree).frame();
  group.triangles = decoded_triangles_of(group.trees.front()->tree);
  for (const Decoded& t : group.triangles) group.largest = std::max(group.largest, t.largest);
}

}  // namespace

std::vector<Decoded> decoded_triangles_of(const Tree& tree) {
  std::vector<Decoded> all;
  TriangleBatch batch;
  for (std::uint32_t order = 0; order < tree.face_count(); ++order) {
    if (BoundTree::of(tree).leaves().read(order, 1, batch) != Errc::kOk) {
      throw std::runtime_error("a face cannot be read");
    }
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      Face t;
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 3; ++k) t[c][k] = batch.coordinate[c][k][i];
      }
      all.push_back(
          {BoundTree::of(tree).face_id(order), i, t, as<Dyadic>(t), bounds_of(t), largest(t)});
    }
  }
  std::sort(all.begin(), all.end(), [](const Decoded& a, const Decoded& b) {
    return std::tie(a.face, a.half) < std::tie(b.face, b.half);
  });
  return all;
}

std::unique_ptr<Subject> make_subject(SourceMesh mesh, bool grid) {
  auto subject = std::make_unique<Subject>();
  subject->mesh = std::move(mesh);
  Group exact;
  for (const CodecInfo& codec : kCodecs) {
    exact.trees.push_back(cook(subject->mesh, codec.id, GeometryId::kExact));
  }
  for (const GeometryId store : {GeometryId::kArrays, GeometryId::kExternal}) {
    exact.trees.push_back(cook(subject->mesh, CodecId::kPackedF32, store));
    exact.trees.push_back(cook(subject->mesh, CodecId::kWide8, store));
  }
  finish(exact);
  subject->groups.push_back(std::move(exact));
  if (!grid) return subject;
  Group gridded;
  for (const CodecInfo& codec : kCodecs) {
    auto cooked = cook(subject->mesh, codec.id, GeometryId::kGrid);
    if (!cooked) return subject;
    gridded.trees.push_back(std::move(cooked));
  }
  finish(gridded);
  subject->groups.push_back(std::move(gridded));
  return subject;
}

}  // namespace boxtree::oracle
