// SPDX-License-Identifier: MIT
// Bullet: the triangle test of GImpact, without margins.
#include <BulletCollision/Gimpact/btGImpactShape.h>

#include "tests/oracle/pair_tester.h"

namespace boxtree::test {
namespace {

btPrimitiveTriangle to_bullet(const Triangle& triangle) {
  btPrimitiveTriangle out;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d& corner = triangle.corner[static_cast<std::size_t>(i)];
    out.m_vertices[i] =
        btVector3(static_cast<btScalar>(corner[0]), static_cast<btScalar>(corner[1]),
                  static_cast<btScalar>(corner[2]));
  }
  out.m_margin = 0;
  out.buildTriPlane();
  return out;
}

bool intersect(const Triangle& p, const Triangle& q) {
  btPrimitiveTriangle a = to_bullet(p), b = to_bullet(q);
  GIM_TRIANGLE_CONTACT contact;
  return a.overlap_test_conservative(b) && a.find_triangle_collision_clip_method(b, contact);
}

}  // namespace

void add_bullet_testers(std::vector<PairTester>& testers) {
  testers.push_back({"bullet", "gimpact", intersect});
}

}  // namespace boxtree::test
