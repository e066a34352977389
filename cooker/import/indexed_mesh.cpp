// SPDX-License-Identifier: MIT
#include "cooker/import/indexed_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "cooker/import/face_runs.h"
#include "cooker/import/weld.h"
#include "format/limits.h"

namespace boxtree::cooker {

namespace {

Status check_vertex_count(std::uint64_t count, const std::string& file) {
  if (count <= kMaxVertices) return {};
  return Error{Errc::kMeshTooLarge,
               fmt::format("{}: {} vertices, more than {}", file, count, kMaxVertices)};
}

}  // namespace

template <class T>
Status IndexedMesh<T>::begin_vertices(std::uint64_t count) {
  if (Status status = check_vertex_count(count, file_); !status.ok()) return status;
  positions_.reserve(3 * count);
  return {};
}

template <class T>
Status IndexedMesh<T>::add_vertex(const Eigen::Vector3d& position, std::size_t line) {
  const std::size_t number = vertices();
  if (Status status = check_vertex_count(number + 1, file_); !status.ok()) return status;
  for (const double x : position) add_coordinate(x);
  if (!is_finite(number)) bad_lines_.emplace_back(static_cast<std::uint32_t>(number), line);
  return {};
}

template <class T>
void IndexedMesh<T>::end_vertices() {
  out_.report.source_vertices = vertices();
  numbers_.assign(vertices(), kWeldUnused);
}

template <class T>
Status IndexedMesh<T>::reserve_faces(std::uint64_t count) {
  if (Status status = check_face_count(count, file_); !status.ok()) return status;
  out_.mesh.faces.reserve(count);
  return {};
}

template <class T>
Status IndexedMesh<T>::number_next_face(std::int64_t id) {
  const bool may_repeat = next_face_id_ > 0 && options_.user_data.empty();
  const std::int64_t least = std::int64_t{next_face_id_} - (may_repeat ? 1 : 0);
  if (id < least) {
    return Error{
        Errc::kMeshUnsupported,
        fmt::format("{}: ids of faces '{}': expected none that descends{}, found {} where "
                    "{} is the least",
                    file_, options_.face_ids,
                    options_.user_data.empty() ? "" : ", nor one twice with user data", id, least)};
  }
  if (id >= kMaxFaces) {
    return Error{Errc::kMeshTooLarge,
                 fmt::format("{}: ids of faces '{}': found {}, the largest is {}", file_,
                             options_.face_ids, id, kMaxFaces - 1)};
  }
  next_face_id_ = static_cast<std::uint32_t>(id);
  return {};
}

template <class T>
Status IndexedMesh<T>::add_face(std::span<const std::uint32_t> corners,
                                std::optional<std::uint32_t> user_data) {
  if (corners.size() < 3) {
    count_no_face(corners.size(), out_.report);
    return {};
  }
  if (user_data) add_face_to(out_.user_data, next_face_id_, *user_data);
  if (std::optional<FaceFault> fault = fault_of(corners)) return add_bad_face(std::move(*fault));
  const std::uint32_t face_id = next_face_id_++;
  ++out_.report.source_faces;
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
Status IndexedMesh<T>::add_bad_face(FaceFault fault) {
  ++out_.report.source_faces;
  return report_fault(std::move(fault), next_face_id_++, file_, options_, out_.report);
}

template <class T>
Status IndexedMesh<T>::add_strips(std::span<const std::uint32_t> vertices) {
  constexpr std::uint32_t kEndOfStrip = 0xffffffffu;
  if (Status status = check_face_count(next_face_id_ + std::uint64_t{vertices.size()}, file_);
      !status.ok()) {
    return status;
  }
  while (!vertices.empty()) {
    const auto end = std::find(vertices.begin(), vertices.end(), kEndOfStrip);
    const auto length = static_cast<std::size_t>(end - vertices.begin());
    if (Status status = add_strip(vertices.first(length)); !status.ok()) return status;
    vertices = vertices.subspan(std::min(length + 1, vertices.size()));
  }
  return {};
}

template <class T>
Status IndexedMesh<T>::add_strip(std::span<const std::uint32_t> vertices) {
  if (vertices.empty()) return {};  // two ends of strips in a row
  if (vertices.size() < 3) return add_face(vertices);
  for (std::size_t i = 0; i + 2 < vertices.size(); ++i) {
    const bool is_turned = i % 2 != 0;
    const std::array<std::uint32_t, 3> corners = {vertices[is_turned ? i + 1 : i],
                                                  vertices[is_turned ? i : i + 1], vertices[i + 2]};
    if (Status status = add_face(corners); !status.ok()) return status;
  }
  return {};
}

template <class T>
std::optional<FaceFault> IndexedMesh<T>::fault_of(std::span<const std::uint32_t> corners) const {
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const std::uint32_t vertex = corners[i];
    if (vertex >= numbers_.size()) {
      return vertex_out_of_range(i, vertex_text(vertex), numbers_.size());
    }
    if (all_finite_ || is_finite(vertex)) continue;
    const T* p = &positions_[std::size_t{3} * vertex];
    FaceFault fault = vertex_not_finite(name_of(vertex), {p[0], p[1], p[2]});
    const bool is_too_large = std::isinf(p[0]) || std::isinf(p[1]) || std::isinf(p[2]);
    if (std::is_same_v<T, float> && is_too_large) {
      fault.reason += "; f32 ends at 3.4e38, --f64 at 1.8e308";
    }
    return fault;
  }
  return std::nullopt;
}

template <class T>
bool IndexedMesh<T>::is_finite(std::size_t vertex) const {
  const T* p = &positions_[3 * vertex];
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// Precondition: the vertex is not finite.
template <class T>
std::string IndexedMesh<T>::name_of(std::uint32_t vertex) const {
  const auto at =
      std::lower_bound(bad_lines_.begin(), bad_lines_.end(), std::pair(vertex, std::size_t{0}));
  std::string name = fmt::format("vertex {}", vertex);
  if (at != bad_lines_.end() && at->first == vertex) name += fmt::format(" (line {})", at->second);
  return name;
}

// The error of one rounding, when the file was written or now.
template <class T>
RoundedCorner IndexedMesh<T>::rounded(std::uint32_t vertex) const {
  const Eigen::Vector3d at = intake_.position(vertex);
  return {at, {rounding_of<T>(at[0]), rounding_of<T>(at[1]), rounding_of<T>(at[2])}};
}

// Not refused, as a binary STL file of another size is: there the size alone tells a binary file
// from a text, and readers of OFF and PLY pass over what follows, so that files with comments or a
// block of their writer's there are in use.
template <class T>
void IndexedMesh<T>::add_left_over(std::string_view what, std::uint64_t count, std::size_t line) {
  if (count == 0) return;
  out_.report.unread.push_back(
      {fmt::format("{}s after the last element", what), count, line,
       "the header counts elements: if these are some, correct its numbers"});
}

template <class T>
Status IndexedMesh<T>::finish() {
  ImportReport& report = out_.report;
  const auto used =
      static_cast<std::size_t>(std::count(numbers_.begin(), numbers_.end(), kWeldUsed));
  report.vertices_unused = numbers_.size() - used;
  // Files without shared vertices store three per face; a closed surface has half a vertex per
  // face.
  weld_in_place(positions_, std::span(numbers_), std::min(used, out_.mesh.faces.size()));
  report.vertices_welded = used - positions_.size() / 3;
  for (Face& face : out_.mesh.faces) {
    for (std::uint32_t& corner : face.corner) {
      if (corner != kNoCorner) corner = numbers_[corner];
    }
  }
  return check_taken(file_, out_);
}

template class IndexedMesh<float>;
template class IndexedMesh<double>;

}  // namespace boxtree::cooker
