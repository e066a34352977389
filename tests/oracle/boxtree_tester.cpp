// SPDX-License-Identifier: MIT
// Ours: the predicate, and pair queries of two trees of one triangle each.
#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "runtime/primitive/predicates.h"
#include "runtime/tree/bound_tree.h"
#include "tests/oracle/pair_tester.h"
#include "tests/oracle/shape_tester.h"
#include "tests/support/require.h"

namespace boxtree::test {
namespace {

cooker::EncodedTree cook_one(const Triangle& triangle, CodecId codec) {
  cooker::SourceMesh mesh;
  for (const Eigen::Vector3d& corner : triangle.corner) {
    for (Eigen::Index k = 0; k < 3; ++k) {
      mesh.positions.f32.push_back(static_cast<float>(corner[k]));
    }
  }
  mesh.faces.push_back({{0, 1, 2, cooker::kNoCorner}});
  return require(cooker::cook_as(mesh, codec));
}

bool trees_intersect(const Triangle& p, const Triangle& q, CodecId codec) {
  const cooker::EncodedTree first = cook_one(p, codec), second = cook_one(q, codec);
  const Tree a = require(cooker::bind_encoded(first));
  const Tree b = require(cooker::bind_encoded(second));
  return require(first_contact(a, Pose::Identity(), b, Pose::Identity())).has_value();
}

bool tree_touches(const Triangle& triangle, const TestedShape& shape, CodecId codec) {
  const cooker::EncodedTree encoded = cook_one(triangle, codec);
  const Tree tree = require(cooker::bind_encoded(encoded));
  const std::vector<Eigen::Vector3d>& p = shape.points;
  bool touches = false;
  const auto note = [&](const FaceRef&) { return !(touches = true); };
  switch (shape.kind) {
    case 0:
      static_cast<void>(require(overlap_sphere(tree, p[0], shape.radius, note)));
      break;
    case 1:
      static_cast<void>(require(overlap_capsule(tree, {p[0], p[1], shape.radius}, note)));
      break;
    case 2: {
      OrientedBox box;
      box.center = (p[0] + p[7]) / 2;
      box.half_extents = (p[7] - p[0]) / 2;
      static_cast<void>(require(overlap_oriented_box(tree, box, note)));
      break;
    }
    default: {
      ConvexHull hull;
      hull.points = p;
      static_cast<void>(require(overlap_convex_hull(tree, hull, note)));
    }
  }
  return touches;
}

}  // namespace

void add_boxtree_testers(std::vector<ShapeTester>& testers) {
  testers.push_back({"boxtree", "trees",
                     [turn = std::size_t{0}](const Triangle& t, const TestedShape& s) mutable {
                       return tree_touches(t, s, kCodecs[turn++ % kCodecs.size()].id);
                     }});
}

void add_boxtree_testers(std::vector<PairTester>& testers) {
  testers.push_back({"boxtree", "predicate", triangles_intersect});
  constexpr unsigned kEvery = 100;  // cooking takes its time
  testers.push_back({"boxtree", "trees, 1 in 100",
                     [turn = std::size_t{0}](const Triangle& p, const Triangle& q) mutable {
                       return trees_intersect(p, q, kCodecs[turn++ % kCodecs.size()].id);
                     },
                     kEvery});
}

}  // namespace boxtree::test
