// SPDX-License-Identifier: MIT
// A cooked tree as a static shape of Bullet: its triangles come straight from the mapped file.
#pragma once

#include <BulletCollision/CollisionShapes/btConcaveShape.h>
#include <vector>

#include <boxtree/boxtree.h>

namespace bullet_drop {

/// Static level geometry. The tree, and the file that it is bound to, must outlive the shape.
class MappedShape : public btConcaveShape {
 public:
  explicit MappedShape(const boxtree::Tree& tree);

  /// Hands over every triangle that touches the box, by ascending face number: what Bullet does
  /// with contacts depends on their order, so it is the same for every codec.
  void processAllTriangles(btTriangleCallback* callback, const btVector3& low,
                           const btVector3& high) const override;

  void getAabb(const btTransform& pose, btVector3& low, btVector3& high) const override;
  void setLocalScaling(const btVector3& scaling) override { scaling_ = scaling; }
  [[nodiscard]] const btVector3& getLocalScaling() const override { return scaling_; }
  /// Of static shapes: none.
  void calculateLocalInertia(btScalar mass, btVector3& inertia) const override;
  [[nodiscard]] const char* getName() const override { return "boxtree"; }

 private:
  const boxtree::Tree& tree_;
  btVector3 scaling_{1, 1, 1};
};

}  // namespace bullet_drop
