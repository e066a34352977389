// SPDX-License-Identifier: MIT
// Adds polygons as faces to a SourceMesh: the last step of all readers.
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

/// "vertex 7". Numbers too large for any mesh are printed as negative: they were read as unsigned.
[[nodiscard]] std::string vertex_text(std::uint32_t vertex);

/// The faults of a corner without a vertex, and of a vertex that is not finite.
[[nodiscard]] FaceFault vertex_out_of_range(std::size_t corner, const std::string& vertex,
                                            std::uint64_t vertex_count);
[[nodiscard]] FaceFault vertex_not_finite(const std::string& vertex,
                                          const std::array<double, 3>& position);

/// The error of a bad face. `command`: see ImportOptions.
[[nodiscard]] Error error_of_face(const std::string& file, std::uint64_t face,
                                  const FaceFault& fault, const char* command);

/// Reports a bad face: an error with file and face, or with skip_bad an entry of the report.
Status report_fault(FaceFault fault, std::uint32_t face_id, const std::string& file,
                    const ImportOptions& options, ImportReport& report);

/// Counts a polygon with fewer than three corners, which is not a face.
void count_no_face(std::size_t corners, ImportReport& report);

/// kMeshTooLarge if `faces`, as stated or counted before splitting, exceeds kMaxFaces.
Status check_face_count(std::uint64_t faces, const std::string& file);

/// The same for faces counted after splitting.
Status check_split_count(std::uint64_t faces, const std::string& file);

/// kNoFaces if no faces were imported; the message comes from `report`.
Status check_any_taken(const std::string& file, std::size_t faces, const ImportReport& report);

/// Checks a mesh after its last face: it has faces, and not too many.
Status check_taken(const std::string& file, const Imported& imported);

/// A unit in the last place of `value`, or of the smallest normal number if `value` is smaller: an
/// upper bound. One rounding errs by half of that. Assimp's reader of decimal numbers rounds twice
/// (the integer part, then its sum with the fraction), and a file may have been rounded when
/// written.
template <class T>
[[nodiscard]] double rounding_of(double value);

/// Adds polygons to `out.mesh` in the order of their ids and counts them in `out.report`. T is the
/// type of the positions. Corners refer to `positions`: those of the mesh, or the same positions
/// with other numbers, which are translated later.
template <class T>
class FaceIntake {
 public:
  FaceIntake(const std::vector<T>& positions, const ImportOptions& options, Imported& out)
      : positions_(positions), options_(options), mesh_(out.mesh), report_(out.report) {}

  void add_triangle(std::uint32_t face_id, const std::array<std::uint32_t, 3>& corners);
  /// Keeps a quad if `rounded`, the corners in the winding of the source, is planar and convex.
  void add_quad(std::uint32_t face_id, const std::array<std::uint32_t, 4>& corners,
                const std::array<RoundedCorner, 4>& rounded);
  /// Five corners or more.
  void add_polygon(std::uint32_t face_id, std::span<const std::uint32_t> corners);

  [[nodiscard]] Eigen::Vector3d position(std::uint32_t vertex) const {
    const T* p = &positions_[std::size_t{3} * vertex];
    return {double{p[0]}, double{p[1]}, double{p[2]}};
  }

 private:
  void add_face(const std::array<std::uint32_t, 4>& corners,
                const std::array<std::uint32_t, 4>& of_polygon);
  void split(std::span<const std::uint32_t> corners);
  void end_polygon(std::uint32_t face_id, std::size_t first);
  [[nodiscard]] bool has_no_area(const Face& face) const;

  const std::vector<T>& positions_;
  const ImportOptions& options_;
  SourceMesh& mesh_;
  ImportReport& report_;
  PolygonSplitter splitter_;
  std::vector<Eigen::Vector3d> points_;  // of the current polygon, for the splitter
};

extern template class FaceIntake<float>;
extern template class FaceIntake<double>;
extern template double rounding_of<float>(double value);
extern template double rounding_of<double>(double value);

}  // namespace boxtree::cooker
