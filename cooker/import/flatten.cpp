// SPDX-License-Identifier: MIT
// Flattening: applies transforms in double, welds, counts.
#include "cooker/import/flatten.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <type_traits>

#include <assimp/scene.h>
#include <fmt/format.h>

#include "cooker/import/f32_digits.h"
#include "cooker/import/face_runs.h"
#include "cooker/import/weld.h"
#include "runtime/primitive/rounding.h"

namespace boxtree::cooker {
namespace {

using Eigen::Vector3d;

// State in remap_ of a vertex without a number.
constexpr std::uint32_t kUnused = 0xffffffffu;
constexpr std::uint32_t kNotFinite = 0xfffffffeu;
constexpr std::uint32_t kUsed = 0xfffffffdu;

Vector3d position_of(const aiVector3D& read) {
  return {read.x, read.y, read.z};
}

// Normals, colours and the like can be larger than all data that is kept.
void free_attributes(aiMesh& mesh) {
  const auto drop = [](auto*& array) {
    delete[] array;
    array = nullptr;
  };
  drop(mesh.mNormals);
  drop(mesh.mTangents);
  drop(mesh.mBitangents);
  for (auto*& colors : mesh.mColors) drop(colors);
  for (auto*& coordinates : mesh.mTextureCoords) drop(coordinates);
}

// Adds one instance after another. T is the type of the positions.
template <class T>
class Flattener {
 public:
  Flattener(const SourceContext& context, std::vector<T>& positions, Imported& out)
      : options_(context.options),
        loss_in_text_(context.loss_in_text),
        file_(context.file),
        positions_(positions),
        report_(out.report),
        welder_(positions),
        intake_(positions, context.options, out) {}

  Status add(const aiMesh& mesh, const Transform& transform);

  /// Number of the next face: the faces of three corners or more added so far.
  [[nodiscard]] std::uint32_t next_face_id() const { return next_face_id_; }
  /// How far rounding to T moved a vertex from its place in double, at most.
  [[nodiscard]] double moved() const { return moved_; }
  /// How far from its place by the digits of a text its reader moved a vertex, at most.
  [[nodiscard]] double moved_by_reader() const { return moved_by_reader_; }

 private:
  [[nodiscard]] Vector3d place_in_double(unsigned vertex) const;
  [[nodiscard]] double moved_by_reader(unsigned vertex) const;
  std::array<T, 3> place(unsigned vertex) const;
  void check_vertices();
  Status mark_used();
  void weld_used();
  void add_face(const aiFace& face);
  [[nodiscard]] std::optional<FaceFault> fault_of(const aiFace& face) const;
  [[nodiscard]] std::string name_of_vertex(unsigned vertex) const;
  [[nodiscard]] RoundedCorner rounded_corner(unsigned vertex) const;

  const ImportOptions& options_;
  const double loss_in_text_;
  const std::string& file_;
  std::vector<T>& positions_;
  ImportReport& report_;
  Welder<T> welder_;
  FaceIntake<T> intake_;
  std::vector<std::uint32_t> remap_;    // for each vertex of the instance: state or number
  std::vector<std::uint32_t> corners_;  // of the current face, as indices into positions_
  std::uint32_t next_face_id_ = 0;
  double moved_ = 0, moved_by_reader_ = 0;

  // The current instance.
  const aiMesh* source_ = nullptr;
  Transform transform_;
  bool is_identity_ = true;
  bool mirrors_ = false;
};

template <class T>
Status Flattener<T>::add(const aiMesh& mesh, const Transform& transform) {
  source_ = &mesh;
  transform_ = transform;
  is_identity_ = transform.is_identity();
  mirrors_ = transform.mirrors();
  ++report_.meshes;
  report_.source_vertices += mesh.mNumVertices;
  if (mesh.mNumFaces == 0) report_.points_skipped += mesh.mNumVertices;
  check_vertices();
  const std::uint32_t first_face_id = next_face_id_;
  if (Status status = mark_used(); !status.ok()) return status;
  weld_used();
  next_face_id_ = first_face_id;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    if (mesh.mFaces[i].mNumIndices >= 3) add_face(mesh.mFaces[i]);
  }
  return {};
}

template <class T>
Vector3d Flattener<T>::place_in_double(unsigned vertex) const {
  const Vector3d source = position_of(source_->mVertices[vertex]);
  return is_identity_ ? source : transform_ * source;
}

// A coordinate lost half a unit in its last place to f32, or half of the smallest number, but no
// more than any number of the text.
template <class T>
double Flattener<T>::moved_by_reader(unsigned vertex) const {
  const Vector3d source = position_of(source_->mVertices[vertex]);
  double squares = 0;
  for (const std::array<double, 4>& row : transform_.row) {
    double moved = 0;
    for (std::size_t from = 0; from < 3; ++from) {
      const double lost =
          std::max(kRoundoffF32 * std::abs(source[static_cast<int>(from)]), kUnderflowF32);
      moved += std::abs(row[from]) * std::min(lost, loss_in_text_);
    }
    squares += moved * moved;
  }
  return std::sqrt(squares);
}

template <class T>
std::array<T, 3> Flattener<T>::place(unsigned vertex) const {
  const Vector3d placed = place_in_double(vertex);
  return {static_cast<T>(placed[0]), static_cast<T>(placed[1]), static_cast<T>(placed[2])};
}

template <class T>
void Flattener<T>::check_vertices() {
  remap_.assign(source_->mNumVertices, kUnused);
  for (unsigned vertex = 0; vertex < source_->mNumVertices; ++vertex) {
    const std::array<T, 3> placed = place(vertex);
    if (!std::isfinite(placed[0]) || !std::isfinite(placed[1]) || !std::isfinite(placed[2])) {
      remap_[vertex] = kNotFinite;
    }
  }
}

// Numbers the faces, counts skipped ones, and marks the vertices of the others.
template <class T>
Status Flattener<T>::mark_used() {
  for (unsigned i = 0; i < source_->mNumFaces; ++i) {
    const aiFace& face = source_->mFaces[i];
    if (face.mNumIndices < 3) {
      count_no_face(face.mNumIndices, report_);
      continue;
    }
    const std::uint32_t face_id = next_face_id_++;
    ++report_.source_faces;
    if (std::optional<FaceFault> fault = fault_of(face)) {
      Status status = report_fault(std::move(*fault), face_id, file_, options_, report_);
      if (!status.ok()) return status;
      continue;
    }
    for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
      remap_[face.mIndices[corner]] = kUsed;
    }
  }
  return {};
}

// The fault of a face, if it has one. The result is the same before and after weld_used, which does
// not change kNotFinite.
template <class T>
std::optional<FaceFault> Flattener<T>::fault_of(const aiFace& face) const {
  for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
    const unsigned vertex = face.mIndices[corner];
    if (vertex >= source_->mNumVertices) {
      return vertex_out_of_range(corner, name_of_vertex(vertex), source_->mNumVertices);
    }
    if (remap_[vertex] != kNotFinite) continue;
    const std::array<T, 3> placed = place(vertex);
    return vertex_not_finite(name_of_vertex(vertex), {placed[0], placed[1], placed[2]});
  }
  return std::nullopt;
}

template <class T>
std::string Flattener<T>::name_of_vertex(unsigned vertex) const {
  std::string name = vertex_text(vertex);
  if (source_->mName.length > 0) name += fmt::format(" of mesh '{}'", source_->mName.C_Str());
  return name;
}

template <class T>
void Flattener<T>::weld_used() {
  const auto used = static_cast<std::size_t>(std::count(remap_.begin(), remap_.end(), kUsed));
  report_.vertices_unused += remap_.size() - used;
  // Formats without shared vertices store three per face; a closed surface has half a vertex per
  // face.
  welder_.reserve(std::min<std::size_t>(used, source_->mNumFaces));
  const std::size_t before = positions_.size() / 3;
  for (unsigned vertex = 0; vertex < source_->mNumVertices; ++vertex) {
    if (remap_[vertex] != kUsed) continue;
    remap_[vertex] = welder_.add(place(vertex));
    if (std::is_same_v<T, float> && !is_identity_) {
      moved_ = std::max(moved_, moved_by_f32(place_in_double(vertex)));
    }
    if (loss_in_text_ > 0) {
      moved_by_reader_ = std::max(moved_by_reader_, moved_by_reader(vertex));
    }
  }
  report_.vertices_welded += used - (positions_.size() / 3 - before);
}

template <class T>
void Flattener<T>::add_face(const aiFace& face) {
  const std::uint32_t face_id = next_face_id_++;
  for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
    const unsigned vertex = face.mIndices[corner];
    if (vertex >= source_->mNumVertices || remap_[vertex] == kNotFinite) return;
  }
  corners_.clear();
  for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
    // Mirroring reverses the winding, so it is reversed again, from the same corner.
    const unsigned from = mirrors_ && corner != 0 ? face.mNumIndices - corner : corner;
    corners_.push_back(remap_[face.mIndices[from]]);
  }
  if (corners_.size() == 3) {
    intake_.add_triangle(face_id, {corners_[0], corners_[1], corners_[2]});
  } else if (corners_.size() == 4) {
    intake_.add_quad(face_id, {corners_[0], corners_[1], corners_[2], corners_[3]},
                     {rounded_corner(face.mIndices[0]), rounded_corner(face.mIndices[1]),
                      rounded_corner(face.mIndices[2]), rounded_corner(face.mIndices[3])});
  } else {
    intake_.add_polygon(face_id, corners_);
  }
}

// A coordinate is rounded to f32 when the file is written or read, and to T after the transform.
// The arithmetic of the transform adds four roundings.
template <class T>
RoundedCorner Flattener<T>::rounded_corner(unsigned vertex) const {
  const Vector3d source = position_of(source_->mVertices[vertex]);
  const Vector3d before(rounding_of<float>(source[0]), rounding_of<float>(source[1]),
                        rounding_of<float>(source[2]));
  const Vector3d after = intake_.position(remap_[vertex]);
  if (is_identity_) return {after, before};
  Vector3d rounding;
  for (int axis = 0; axis < 3; ++axis) {
    const std::array<double, 4>& row = transform_.row[static_cast<std::size_t>(axis)];
    double carried = 0, terms = std::abs(row[3]);
    for (int from = 0; from < 3; ++from) {
      const double factor = std::abs(row[static_cast<std::size_t>(from)]);
      carried += factor * before[from];
      terms += factor * std::abs(source[from]);
    }
    rounding[axis] = carried + rounding_of<T>(after[axis]) + 4 * rounding_of<double>(terms);
  }
  return {after, rounding};
}

// Number of faces of the instances, or more than kMaxFaces.
std::uint64_t count_faces(const aiScene& scene, std::span<const MeshInstance> instances) {
  std::uint64_t triangles = 0;
  for (const MeshInstance& instance : instances) {
    triangles += scene.mMeshes[instance.mesh]->mNumFaces;
  }
  return triangles;
}

template <class T>
Status flatten(aiScene& scene, std::span<const MeshInstance> instances, MeshUses& uses,
               const SourceContext& context, Flattener<T>& flattener,
               std::vector<FaceRun>& materials, std::vector<FaceRun>& user_data) {
  for (const MeshInstance& instance : instances) {
    aiMesh*& mesh = scene.mMeshes[instance.mesh];
    const std::uint32_t first_face = flattener.next_face_id();
    if (Status status = flattener.add(*mesh, instance.transform); !status.ok()) return status;
    const bool has_faces = flattener.next_face_id() > first_face;
    if (has_faces && !context.materials.empty()) {
      for (const FaceRun& run : context.materials[instance.mesh]) {
        materials.push_back({first_face + run.first_face, run.number});
      }
    } else if (has_faces) {
      materials.push_back({first_face, mesh->mMaterialIndex});
    }
    if (has_faces && !context.user_data.empty()) {
      add_face_to(user_data, first_face, context.user_data[instance.mesh]);
    }
    if (--uses[instance.mesh] > 0) continue;
    delete mesh;
    mesh = nullptr;
  }
  return {};
}

// What is too little to be told is told of neither.
template <class T>
void state_moves(const Flattener<T>& flattener, bool count_all, Imported& out) {
  const double unnoticed = unnoticed_move(out.mesh.positions);
  const double moved = flattener.moved() + flattener.moved_by_reader();
  const bool is_told = moved > unnoticed;
  if (!is_told && !count_all) return;
  const bool is_of_reader = flattener.moved_by_reader() > (is_told ? unnoticed : moved / 2);
  out.mesh.f32_loss = is_of_reader ? F32Loss::kReader : F32Loss::kNodes;
  out.mesh.moved_by_f32 = moved;
  if (!is_told) return;
  out.report.f32_loss = out.mesh.f32_loss;
  out.report.moved_by_f32 = std::max(out.report.moved_by_f32, moved);
}

}  // namespace

void free_attributes(aiScene& scene) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    if (scene.mMeshes[i] != nullptr) free_attributes(*scene.mMeshes[i]);
  }
}

Status flatten_instances(aiScene& scene, std::span<const MeshInstance> instances, MeshUses& uses,
                         const SourceContext& context, Imported& out,
                         std::vector<FaceRun>& materials) {
  const std::uint64_t faces = count_faces(scene, instances);
  if (Status status = check_face_count(faces, context.file); !status.ok()) return status;
  Positions& positions = out.mesh.positions;
  out.mesh.faces.reserve(faces);
  positions.precision = context.options.precision;
  Status status;
  if (positions.precision == Precision::kF32) {
    Flattener<float> flattener(context, positions.f32, out);
    status = flatten(scene, instances, uses, context, flattener, materials, out.user_data);
    state_moves(flattener, context.options.count_moves, out);
  } else {
    Flattener<double> flattener(context, positions.f64, out);
    status = flatten(scene, instances, uses, context, flattener, materials, out.user_data);
    state_moves(flattener, context.options.count_moves, out);
  }
  if (!status.ok()) return status;
  return check_split_count(out.mesh.faces.size(), context.file);
}

Status flatten_scene(aiScene& scene, const Placements& placements, const SourceContext& context,
                     Imported& out, std::vector<FaceRun>& materials) {
  free_attributes(scene);
  out.report.meshes_unplaced = placements.unplaced;
  std::vector<MeshInstance> instances;
  MeshUses uses(scene.mNumMeshes, 0);
  for (const Placement& placement : placements.all) {
    for (const unsigned mesh : placement.meshes) {
      instances.push_back({mesh, placement.transform});
      ++uses[mesh];
    }
  }
  Status status = flatten_instances(scene, instances, uses, context, out, materials);
  if (!status.ok()) return status;
  return check_any_taken(context.file, out.mesh.faces.size(), out.report);
}

}  // namespace boxtree::cooker
