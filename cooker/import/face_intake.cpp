// SPDX-License-Identifier: MIT
// Decides which quads stay, splits the rest into triangles, and stores face ids if needed.
#include "cooker/import/face_intake.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "format/limits.h"

namespace boxtree::cooker {

using Eigen::Vector3d;

std::string vertex_text(std::uint32_t vertex) {
  const bool is_negative = vertex > kMaxVertices;
  return is_negative ? fmt::format("vertex {}", static_cast<std::int32_t>(vertex))
                     : fmt::format("vertex {}", vertex);
}

FaceFault vertex_out_of_range(std::size_t corner, const std::string& vertex,
                              std::uint64_t vertex_count) {
  return {Errc::kMeshIndexOutOfRange, fmt::format("corner {} names {}, but there are {} vertices",
                                                  corner, vertex, vertex_count)};
}

FaceFault vertex_not_finite(const std::string& vertex, const std::array<double, 3>& position) {
  return {Errc::kMeshNotFinite, fmt::format("{} is not finite: ({}, {}, {})", vertex, position[0],
                                            position[1], position[2])};
}

Error error_of_face(const std::string& file, std::uint64_t face, const FaceFault& fault,
                    const char* command) {
  const std::string remedy =
      command == nullptr ? "" : fmt::format(" ({} --skip-bad drops such faces)", command);
  return {fault.code, fmt::format("{}: face {}: {}{}", file, face, fault.reason, remedy)};
}

Status report_fault(FaceFault fault, std::uint32_t face_id, const std::string& file,
                    const ImportOptions& options, ImportReport& report) {
  if (!options.skip_bad) {
    return error_of_face(file, face_id, fault, options.command);
  }
  report.skipped.push_back({face_id, std::move(fault.reason)});
  return {};
}

void count_no_face(std::size_t corners, ImportReport& report) {
  if (corners == 0) ++report.empty_skipped;
  if (corners == 1) ++report.points_skipped;
  if (corners == 2) ++report.lines_skipped;
}

Status check_face_count(std::uint64_t faces, const std::string& file) {
  if (faces <= kMaxFaces) return {};
  return Error{Errc::kMeshTooLarge,
               fmt::format("{}: {} faces, more than {}", file, faces, kMaxFaces)};
}

Status check_split_count(std::uint64_t faces, const std::string& file) {
  if (faces <= kMaxFaces) return {};
  return Error{Errc::kMeshTooLarge,
               fmt::format("{}: {} faces after splitting, more than {}", file, faces, kMaxFaces)};
}

Status check_taken(const std::string& file, const Imported& imported) {
  const std::size_t faces = imported.mesh.faces.size();
  if (Status status = check_split_count(faces, file); !status.ok()) return status;
  return check_any_taken(file, faces, imported.report);
}

Status check_any_taken(const std::string& file, std::size_t faces, const ImportReport& report) {
  if (faces > 0) return {};
  std::string why = "no faces";
  if (!report.skipped.empty()) {
    why = report.source_faces == 1 ? "its only face is bad"
                                   : fmt::format("all {} faces are bad", report.source_faces);
  }
  std::string also;
  const auto add = [&also](std::size_t count, const char* one, const char* several) {
    if (count == 0) return;
    also += fmt::format("{}{} {}", also.empty() ? " (" : ", ", count, count == 1 ? one : several);
  };
  add(report.points_skipped, "point", "points");
  add(report.lines_skipped, "line", "lines");
  add(report.empty_skipped, "face without corners", "faces without corners");
  if (report.source_faces == 0) {
    add(report.vertices_unused, "vertex that no face uses", "vertices that no face uses");
  }
  if (!also.empty()) also += ")";
  return Error{Errc::kNoFaces, fmt::format("{}: {}{}", file, why, also)};
}

template <class T>
double rounding_of(double value) {
  return std::max(std::abs(value), double{std::numeric_limits<T>::min()}) *
         double{std::numeric_limits<T>::epsilon()};
}

template <class T>
void FaceIntake<T>::add_face(const std::array<std::uint32_t, 4>& corners,
                             const std::array<std::uint32_t, 4>& of_polygon) {
  mesh_.faces.push_back({corners});
  if (options_.keep_polygon_corners) mesh_.polygon_corners.push_back(of_polygon);
}

template <class T>
void FaceIntake<T>::add_triangle(std::uint32_t face_id,
                                 const std::array<std::uint32_t, 3>& corners) {
  add_face({corners[0], corners[1], corners[2], kNoCorner}, {0, 1, 2, kNoCorner});
  end_polygon(face_id, mesh_.faces.size() - 1);
}

template <class T>
void FaceIntake<T>::add_quad(std::uint32_t face_id, const std::array<std::uint32_t, 4>& corners,
                             const std::array<RoundedCorner, 4>& rounded) {
  const std::size_t first = mesh_.faces.size();
  if (is_planar_convex_quad(rounded)) {
    ++report_.quads_kept;
    add_face(corners, {0, 1, 2, 3});
  } else {
    ++report_.quads_split;
    split(corners);
  }
  end_polygon(face_id, first);
}

template <class T>
void FaceIntake<T>::add_polygon(std::uint32_t face_id, std::span<const std::uint32_t> corners) {
  const std::size_t first = mesh_.faces.size();
  ++report_.ngons_split;
  split(corners);
  end_polygon(face_id, first);
}

template <class T>
void FaceIntake<T>::split(std::span<const std::uint32_t> corners) {
  points_.clear();
  for (const std::uint32_t corner : corners) points_.push_back(position(corner));
  for (const PolygonSplitter::Triangle& triangle : splitter_.split(points_)) {
    add_face({corners[triangle[0]], corners[triangle[1]], corners[triangle[2]], kNoCorner},
             {triangle[0], triangle[1], triangle[2], kNoCorner});
  }
}

template <class T>
void FaceIntake<T>::end_polygon(std::uint32_t face_id, std::size_t first) {
  const std::size_t last = mesh_.faces.size();
  const auto begin = mesh_.faces.begin() + static_cast<std::ptrdiff_t>(first);
  if (std::all_of(begin, mesh_.faces.end(), [this](const Face& face) { return has_no_area(face); }))
    ++report_.degenerate_faces;
  // Ids are stored only if they differ from the indices of the faces.
  if (mesh_.face_ids.empty() && face_id == first && last == first + 1) return;
  if (mesh_.face_ids.empty()) {
    mesh_.face_ids.reserve(mesh_.faces.capacity());
    mesh_.face_ids.resize(first);
    std::iota(mesh_.face_ids.begin(), mesh_.face_ids.end(), 0u);
  }
  mesh_.face_ids.resize(last, face_id);
}

template <class T>
bool FaceIntake<T>::has_no_area(const Face& face) const {
  const auto flat = [this](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    return a == b || b == c || c == a || is_collinear(position(a), position(b), position(c));
  };
  const auto& [a, b, c, d] = face.corner;
  return flat(a, b, c) && (!face.is_quad() || flat(a, c, d));
}

template class FaceIntake<float>;
template class FaceIntake<double>;
template double rounding_of<float>(double value);
template double rounding_of<double>(double value);

}  // namespace boxtree::cooker
