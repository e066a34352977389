// SPDX-License-Identifier: MIT
// A mesh as a simulation sees it: its triangles as decoded, and a tree to find them by, or none.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "runtime/primitive/triangle.h"

namespace boxtree::stiff {

using cooker::SourceMesh;

/// How vertices are stored. With no grid: exact.
struct Store {
  std::string name = "exact";
  std::optional<cooker::GridChoice> grid;
};
[[nodiscard]] Store exact_store();
[[nodiscard]] Store grid_store(int bits);
[[nodiscard]] Store tolerance_store(double tolerance);

/// Bound and ready to be queried. Movable; the tree points into `encoded`.
struct Shape {
  std::string name;  // of the codec, or of what stands in for one
  std::unique_ptr<const cooker::EncodedTree> encoded;
  std::optional<Tree> tree;  // nothing: every face is compared with every other
  // By face id: triangles of face i are [first[i], first[i + 1]), in object space.
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> first;
  std::vector<Eigen::AlignedBox3d> bounds;  // of each face
  Eigen::AlignedBox3d whole;
  double max_vertex_error = 0;

  [[nodiscard]] std::uint32_t face_count() const {
    return static_cast<std::uint32_t>(first.size() - 1);
  }
  [[nodiscard]] std::span<const Triangle> face(std::uint32_t id) const {
    return std::span(triangles).subspan(first[id], first[id + 1] - first[id]);
  }
};

[[nodiscard]] Shape make_shape(const SourceMesh& mesh, CodecId codec, const Store& store);

/// The same faces without a tree: what all codecs are held against.
[[nodiscard]] Shape make_scan(const SourceMesh& mesh, const Store& store);

/// The control: codec plain-f16 with cuts rounded to nearest, so that boxes may fall short of what
/// is in them. No cooker makes this.
[[nodiscard]] Shape make_nearest(const SourceMesh& mesh, const Store& store);

/// Height of the highest level face above or below `at`, as decoded. Precondition: there is one.
[[nodiscard]] double tread_height(const Shape& level, const Eigen::Vector3d& at);

/// IEEE round to nearest, ties to even. Precondition as half_toward_zero.
[[nodiscard]] std::uint16_t half_to_nearest(float value);

/// Faces of two shapes in the world that touch, by ascending id; each once. Of scans: at least
/// those.
struct Touching {
  std::vector<std::uint32_t> first;
  std::vector<std::uint32_t> second;
};
void find_touching(const Shape& first, const Pose& first_pose, const Shape& second,
                   const Pose& second_pose, Touching& out);

}  // namespace boxtree::stiff
