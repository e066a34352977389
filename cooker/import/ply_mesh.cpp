// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <boxtree/cooker/import/ply_mesh.h>
#include <boxtree/cooker/import/weld.h>

namespace boxtree::cooker {

template <class T>
Status PlyMesh<T>::begin_vertices(std::uint64_t count) {
  constexpr std::uint64_t kMaxVertices = 0xfffffffeu;  // corners are 32 bits, one is special
  if (count > kMaxVertices) {
    return Error{Errc::kMeshTooLarge,
                 fmt::format("{}: {} vertices, more than {}", file_, count, kMaxVertices)};
  }
  positions_.resize(3 * count);
  numbers_.assign(count, kWeldUnused);
  out_.report.source_vertices = count;
  return {};
}

template <class T>
Status PlyMesh<T>::begin_faces(std::uint64_t count) {
  if (Status status = check_face_count(count, file_); !status.ok()) return status;
  out_.mesh.faces.reserve(count);
  return {};
}

template <class T>
Status PlyMesh<T>::add_face(std::span<const std::uint32_t> corners) {
  if (corners.size() < 3) {
    count_no_face(corners.size(), out_.report);
    return {};
  }
  const std::uint32_t face_id = next_face_id_++;
  ++out_.report.source_faces;
  if (std::optional<FaceFault> fault = fault_of(corners)) {
    return report_fault(std::move(*fault), face_id, file_, options_, out_.report);
  }
  for (const std::uint32_t corner : corners) numbers_[corner] = kWeldUsed;
  if (corners.size() == 3) {
    intake_.add_triangle(face_id, {corners[0], corners[1], corners[2]});
  } else if (corners.size() == 4) {
    intake_.add_quad(
        face_id, {corners[0], corners[1], corners[2], corners[3]},
        {rounded(corners[0]), rounded(corners[1]), rounded(corners[2]), rounded(corners[3])});
  } else {
    intake_.add_polygon(face_id, corners);
  }
  return {};
}

template <class T>
std::optional<FaceFault> PlyMesh<T>::fault_of(std::span<const std::uint32_t> corners) const {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t vertex = corners[i];
    if (vertex >= numbers_.size()) {
      return vertex_out_of_range(i, vertex_text(vertex), numbers_.size());
    }
    if (all_finite_ || is_finite(vertex)) continue;
    const T* p = &positions_[std::size_t{3} * vertex];
    return vertex_not_finite(vertex_text(vertex), {p[0], p[1], p[2]});
  }
  return std::nullopt;
}

template <class T>
bool PlyMesh<T>::is_finite(std::size_t vertex) const {
  const T* p = &positions_[3 * vertex];
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// Rounded when the file was written, or now.
template <class T>
RoundedCorner PlyMesh<T>::rounded(std::uint32_t vertex) const {
  const Eigen::Vector3d at = intake_.position(vertex);
  return {at, {rounding_of<T>(at[0]), rounding_of<T>(at[1]), rounding_of<T>(at[2])}};
}

template <class T>
Status PlyMesh<T>::finish() {
  ImportReport& report = out_.report;
  const auto used =
      static_cast<std::size_t>(std::count(numbers_.begin(), numbers_.end(), kWeldUsed));
  report.vertices_unused = numbers_.size() - used;
  // Files without shared vertices hold three a face; a closed surface needs half of one.
  weld_in_place(positions_, std::span(numbers_), std::min(used, out_.mesh.faces.size()));
  report.vertices_welded = used - positions_.size() / 3;
  for (Face& face : out_.mesh.faces) {
    for (std::uint32_t& corner : face.corner) {
      if (corner != kNoCorner) corner = numbers_[corner];
    }
  }
  return check_taken(file_, out_);
}

template class PlyMesh<float>;
template class PlyMesh<double>;

}  // namespace boxtree::cooker
