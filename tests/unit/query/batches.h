// SPDX-License-Identifier: MIT
// Batches over meshes of every kind in every encoding.
#pragma once

#include <bit>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree::test {

[[nodiscard]] inline bool same_bits(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}
[[nodiscard]] inline bool same_bits(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return same_bits(a[0], b[0]) && same_bits(a[1], b[1]) && same_bits(a[2], b[2]);
}

class BatchTest : public testing::TestWithParam<Encoding> {
 protected:
  /// A point somewhere in the middle `part` of the box, or so far around it.
  Eigen::Vector3d point_around(const Eigen::AlignedBox3d& box, double part) {
    Eigen::Vector3d p;
    for (Eigen::Index k = 0; k < 3; ++k) {
      p[k] = box.center()[k] + part * (box.sizes()[k] + 0.1) *
                                   std::uniform_real_distribution<double>(-0.5, 0.5)(random_);
    }
    return p;
  }

  /// `body(tree, bounds)`.
  template <class Body>
  void for_each_mesh(const Body& body) {
    for (const cooker::SourceMesh& mesh : all_kinds()) {
      SCOPED_TRACE(mesh.name);
      const CookedTree cooked = cook_tree(mesh, GetParam());
      body(cooked.tree, cooked.tree.bounds());
      if (HasFatalFailure()) return;
    }
  }

 private:
  std::mt19937_64 random_{41};
};

}  // namespace boxtree::test
