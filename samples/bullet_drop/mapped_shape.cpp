// SPDX-License-Identifier: MIT
// Gives Bullet the triangles near each moving body, found by a box query.
#include "mapped_shape.h"

#include <LinearMath/btAabbUtil2.h>
#include <algorithm>

namespace bullet_drop {
namespace {

btVector3 to_bullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

Eigen::Vector3d from_bullet(const btVector3& v) {
  return {v.x(), v.y(), v.z()};
}

}  // namespace

MappedShape::MappedShape(const boxtree::Tree& tree) : tree_(tree) {
  // Not CUSTOM_CONCAVE_SHAPE_TYPE: Bullet 3 takes that for its own signed distance fields.
  m_shapeType = FAST_CONCAVE_MESH_PROXYTYPE;
}

void MappedShape::processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                                      const btVector3& high) const {
  // Negative scales swap the corners of the box.
  const Eigen::Vector3d scale = from_bullet(scaling_);
  const Eigen::Vector3d a = from_bullet(low).cwiseQuotient(scale);
  const Eigen::Vector3d b = from_bullet(high).cwiseQuotient(scale);
  std::vector<boxtree::FaceRef> faces;
  const auto visit = boxtree::overlap_box(tree_, {a.cwiseMin(b), a.cwiseMax(b)},
                                          [&faces](const boxtree::FaceRef& face) {
                                            faces.push_back(face);
                                            return true;
                                          });
  // A damaged file gives no contact instead of a wrong one. An engine would report visit.error().
  if (!visit) return;
  std::sort(faces.begin(), faces.end(), [](const auto& x, const auto& y) { return x.id < y.id; });
  for (const boxtree::FaceRef& face : faces) {
    // A quad has two triangles.
    for (std::uint32_t half = 0; half < 2; ++half) {
      const auto triangle = tree_.triangle(face, half);
      if (!triangle) break;
      btVector3 corners[3];
      for (std::size_t k = 0; k < 3; ++k) corners[k] = to_bullet(triangle->corner[k]) * scaling_;
      callback->processTriangle(corners, 0, static_cast<int>(face.id));
    }
  }
}

void MappedShape::getAabb(const btTransform& pose, btVector3& low, btVector3& high) const {
  const Eigen::AlignedBox3d bounds = tree_.bounds();
  btVector3 local_low = to_bullet(bounds.min()) * scaling_;
  btVector3 local_high = to_bullet(bounds.max()) * scaling_;
  const btVector3 other = local_low;
  local_low.setMin(local_high);
  local_high.setMax(other);
  btTransformAabb(local_low, local_high, getMargin(), pose, low, high);
}

void MappedShape::calculateLocalInertia(btScalar /*mass*/, btVector3& inertia) const {
  inertia.setZero();
}

}  // namespace bullet_drop
