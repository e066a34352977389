// SPDX-License-Identifier: MIT
// Makes the views of meshes that a runtime's caller would bind.
#include "cooker/import/mesh_arrays.h"

#include <vector>

#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/geometry.h"

namespace boxtree::cooker {

MeshArrays arrays_of(const SourceMesh& mesh) {
  static_assert(sizeof(Face) == 4 * sizeof(std::uint32_t) && kNoCorner == kMissingCorner);
  const bool f64 = mesh.positions.precision == Precision::kF64;
  MeshArrays arrays;
  arrays.positions = f64 ? reinterpret_cast<const std::byte*>(mesh.positions.f64.data())
                         : reinterpret_cast<const std::byte*>(mesh.positions.f32.data());
  arrays.position_stride = 3 * (f64 ? sizeof(double) : sizeof(float));
  arrays.positions_f64 = f64;
  arrays.vertex_count = static_cast<std::uint32_t>(mesh.positions.size());
  arrays.corners = reinterpret_cast<const std::byte*>(mesh.faces.data());
  arrays.corner_bytes = 4;
  arrays.corners_per_face = 4;
  arrays.face_count = static_cast<std::uint32_t>(mesh.faces.size());
  return arrays;
}

std::uint64_t hash_of(const SourceMesh& mesh) {
  const Result<std::uint64_t> hash = geometry_hash(arrays_of(mesh));
  return hash ? *hash : 0;  // import has checked every corner
}

MeshArrays absent_arrays(const TreeRecord& record) {
  static constexpr std::byte kNowhere{0};
  MeshArrays absent;
  absent.face_count = record.face_count;
  absent.positions_f64 = (record.flags & kTreePositionsF64) != 0;
  absent.position_stride = 3 * sizeof(double);
  absent.positions = &kNowhere;
  absent.corners = &kNowhere;
  absent.corner_bytes = sizeof(std::uint32_t);
  return absent;
}

Result<Scene> bind_without_meshes(const File& file, SceneOptions options) {
  std::vector<SceneMeshArrays> absent;
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    absent.push_back({i, absent_arrays(OpenFile::of(file).tree_record(i))});
  }
  options.meshes = absent;
  return Scene::bind(file, options);
}

}  // namespace boxtree::cooker
