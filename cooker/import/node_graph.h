// SPDX-License-Identifier: MIT
// Assimp's node graph: the nodes that hold meshes and their transforms.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <assimp/matrix4x4.h>

struct aiScene;

namespace boxtree::cooker {

/// An affine map in double (assimp's matrices are rows of floats).
struct Transform {
  std::array<std::array<double, 4>, 3> row = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  static Transform from(const aiMatrix4x4& m) {
    return {{{{m.a1, m.a2, m.a3, m.a4}, {m.b1, m.b2, m.b3, m.b4}, {m.c1, m.c2, m.c3, m.c4}}}};
  }
  [[nodiscard]] Transform operator*(const Transform& inner) const {
    Transform product;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 4; ++j) {
        product.row[i][j] = row[i][0] * inner.row[0][j] + row[i][1] * inner.row[1][j] +
                            row[i][2] * inner.row[2][j] + (j == 3 ? row[i][3] : 0.0);
      }
    }
    return product;
  }
  [[nodiscard]] Eigen::Vector3d operator*(const Eigen::Vector3d& v) const {
    const auto along = [&v](const std::array<double, 4>& r) {
      return r[0] * v[0] + r[1] * v[1] + r[2] * v[2] + r[3];
    };
    return {along(row[0]), along(row[1]), along(row[2])};
  }
  [[nodiscard]] bool is_identity() const { return row == Transform().row; }
  [[nodiscard]] bool mirrors() const {
    const auto& [x, y, z] = row;
    return x[0] * (y[1] * z[2] - y[2] * z[1]) - x[1] * (y[0] * z[2] - y[2] * z[0]) +
               x[2] * (y[0] * z[1] - y[1] * z[0]) <
           0;
  }
};

/// A node that holds meshes, or a mesh that no node places.
struct Placement {
  std::string name;              // of the node, or of a mesh without a node; may be empty
  std::vector<unsigned> meshes;  // indices into aiScene::mMeshes; all are valid
  Transform transform;           // from the root down
};

struct Placements {
  std::vector<Placement> all;  // in node order, depth first; then meshes without a node
  std::size_t unplaced = 0;    // number of meshes without a node in `all`
};

/// All placements of `scene`. Meshes without a node come last, with the identity: some of assimp's
/// readers (RAW with several groups) lose the nodes of meshes that are in the file.
Placements find_placements(const aiScene& scene);

/// Whether at least two placements have a face of three corners or more.
bool places_several(const aiScene& scene, const Placements& placements);

}  // namespace boxtree::cooker
