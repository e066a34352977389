// SPDX-License-Identifier: MIT
// Polygons in, faces of a SourceMesh out: the end of the way that all readers share.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cooker/import/import.h"
#include "cooker/import/polygon_split.h"

namespace boxtree::cooker {

/// Something wrong with one face.
struct FaceFault {
  Errc code;
  std::string reason;
};

/// "vertex 7". Numbers that no mesh can have are those below zero, which were read as unsigned
/// ones.
[[nodiscard]] std::string vertex_text(std::uint32_t vertex);

/// How a corner that names no vertex, and a vertex that is not finite, are put.
[[nodiscard]] FaceFault vertex_out_of_range(std::size_t corner, const std::string& vertex,
                                            std::uint64_t vertex_count);
[[nodiscard]] FaceFault vertex_not_finite(const std::string& vertex,
                                          const std::array<double, 3>& position);

/// A face is bad: an error that names file and face, or with skip_bad an entry of the report.
Status report_fault(FaceFault fault, std::uint32_t face_id, const std::string& file,
                    const ImportOptions& options, ImportReport& report);

/// Counts a polygon of less than three corners, which is no face.
void count_no_face(std::size_t corners, ImportReport& report);

/// kMeshTooLarge when `faces`, as stated or counted before splitting, are more than kMaxFaces.
Status check_face_count(std::uint64_t faces, const std::string& file);

/// The same for faces counted after splitting.
Status check_split_count(std::uint64_t faces, const std::string& file);

/// kNoFaces when no faces were taken over; `report` says why.
Status check_any_taken(const std::string& file, std::size_t faces, const ImportReport& report);

/// What holds of a mesh only after the last face: there are some, and not too many of them.
Status check_taken(const std::string& file, const Imported& imported);

/// At most a unit in the last place of `value`, or of the smallest normal number below that. One
/// rounding makes half of that; assimp's reader of decimal numbers makes two (the integer part,
/// then its sum with the fraction), and a file may have been rounded when written.
template <class T>
[[nodiscard]] double rounding_of(double value);

/// Puts polygons into `out.mesh` in the order of their ids and counts them in `out.report`. T is
/// the type of the positions, `positions` the array that corners refer to: of the mesh, or one
/// that holds the same positions under other numbers, which are put right later.
template <class T>
class FaceIntake {
 public:
  FaceIntake(const std::vector<T>& positions, Imported& out)
      : positions_(positions), mesh_(out.mesh), report_(out.report) {}

  void add_triangle(std::uint32_t face_id, const std::array<std::uint32_t, 3>& corners);
  /// Stays a quad if `rounded`, the corners in the winding of the source, are planar and convex.
  void add_quad(std::uint32_t face_id, const std::array<std::uint32_t, 4>& corners,
                const std::array<RoundedCorner, 4>& rounded);
  /// Five corners or more.
  void add_polygon(std::uint32_t face_id, std::span<const std::uint32_t> corners);

  [[nodiscard]] Eigen::Vector3d position(std::uint32_t vertex) const {
    const T* p = &positions_[std::size_t{3} * vertex];
    return {double{p[0]}, double{p[1]}, double{p[2]}};
  }

 private:
  void split(std::span<const std::uint32_t> corners);
  void end_polygon(std::uint32_t face_id, std::size_t first);
  [[nodiscard]] bool has_no_area(const Face& face) const;

  const std::vector<T>& positions_;
  SourceMesh& mesh_;
  ImportReport& report_;
  PolygonSplitter splitter_;
  std::vector<Eigen::Vector3d> points_;  // of the polygon at hand, for the splitter
};

extern template class FaceIntake<float>;
extern template class FaceIntake<double>;
extern template double rounding_of<float>(double value);
extern template double rounding_of<double>(double value);

}  // namespace boxtree::cooker
