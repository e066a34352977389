// SPDX-License-Identifier: MIT
// Which face of its source each face of a tree is, told by its corners alone.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/import/source_mesh.h"
#include "tests/support/require.h"

namespace boxtree::test {

/// Calls use(face, source) for each face of a tree: how an answer names it, and its number in the
/// mesh. Precondition: triangles, no two with equal corners, and bits of positions are kept.
template <class Use>
void for_each_source_face(const cooker::SourceMesh& mesh, const Tree& tree, const Use& use) {
  using Key = std::array<double, 9>;
  const auto key_of = [](std::array<Eigen::Vector3d, 3> corners) {
    std::sort(corners.begin(), corners.end(),
              [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
                return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
              });
    Key key;
    for (std::size_t i = 0; i < 9; ++i) key[i] = corners[i / 3][static_cast<Eigen::Index>(i % 3)];
    return key;
  };
  std::map<Key, std::uint32_t> faces;
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
    const auto corner = [&](std::size_t i) { return mesh.positions[mesh.faces[face].corner[i]]; };
    faces[key_of({corner(0), corner(1), corner(2)})] = face;
  }
  ASSERT_EQ(faces.size(), mesh.faces.size());
  std::uint32_t compared = 0;
  static_cast<void>(require(overlap_box(tree, tree.bounds(), [&](const FaceRef& face) {
    const Triangle triangle = require(tree.triangle(face));
    const auto known =
        faces.find(key_of({triangle.corner[0], triangle.corner[1], triangle.corner[2]}));
    if (known == faces.end()) {
      ADD_FAILURE() << "a face of no source";
      return false;
    }
    use(face, known->second);
    ++compared;
    return true;
  })));
  EXPECT_EQ(compared, tree.face_count());
}

}  // namespace boxtree::test
