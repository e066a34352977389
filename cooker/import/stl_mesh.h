// SPDX-License-Identifier: MIT
// Adds triangles of a text or binary STL file to a mesh. Each triangle has its own corners, which
// are welded as they are added.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/face_intake.h"
#include "cooker/import/weld.h"

namespace boxtree::cooker {

/// T is the type of the positions.
template <class T>
class StlMesh {
 public:
  using Corner = std::array<T, 3>;

  StlMesh(std::string file, const ImportOptions& options, std::vector<T>& positions, Imported& out)
      : file_(std::move(file)),
        options_(options),
        welder_(positions),
        intake_(positions, options, out),
        out_(out) {}

  /// Reserves memory for `count` triangles, which bytes of the file must back. Error:
  /// kMeshTooLarge.
  Status begin(std::uint64_t count) {
    if (Status status = check_face_count(count, file_); !status.ok()) return status;
    out_.mesh.faces.reserve(count);
    welder_.reserve(count / 2 + count / 32);  // a closed surface has half a vertex a triangle
    return {};
  }

  /// Prefetches the data that adding this corner reads first.
  void prefetch(const Corner& corner) const { welder_.prefetch(corner); }

  /// Adds the next triangle.
  Status add(const std::array<Corner, 3>& corners) {
    const auto face_id = static_cast<std::uint32_t>(out_.report.source_faces++);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& [x, y, z] = corners[i];
      if (std::isfinite(x) && std::isfinite(y) && std::isfinite(z)) continue;
      const std::string name = fmt::format("vertex {}", std::uint64_t{3} * face_id + i);
      return report_fault(vertex_not_finite(name, {x, y, z}), face_id, file_, options_,
                          out_.report);
    }
    const std::uint32_t a = welder_.add(corners[0]);
    const std::uint32_t b = welder_.add(corners[1]);
    const std::uint32_t c = welder_.add(corners[2]);
    intake_.add_triangle(face_id, {a, b, c});
    return {};
  }

  /// Fills in the report; fails if no triangle was added.
  Status finish() {
    ImportReport& report = out_.report;
    report.source_vertices = 3 * report.source_faces;
    report.vertices_unused = 3 * report.skipped.size();
    report.vertices_welded = report.source_vertices - report.vertices_unused - welder_.size();
    return check_taken(file_, out_);
  }

 private:
  const std::string file_;
  const ImportOptions& options_;
  Welder<T> welder_;
  FaceIntake<T> intake_;
  Imported& out_;
};

}  // namespace boxtree::cooker
