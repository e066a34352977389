// SPDX-License-Identifier: MIT
// Bullet: its quantised triangle mesh tree for rays, casts, contacts and boxes, GImpact for pairs.
#include <BulletCollision/BroadphaseCollision/btDbvtBroadphase.h>
#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObject.h>
#include <BulletCollision/CollisionDispatch/btCollisionWorld.h>
#include <BulletCollision/CollisionDispatch/btDefaultCollisionConfiguration.h>
#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <BulletCollision/NarrowPhaseCollision/btRaycastCallback.h>
#include <limits>

#include "runtime/primitive/predicates.h"
#include "tests/bench/subject.h"

namespace boxtree::bench {
namespace {

btVector3 to_bullet(const Eigen::Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

btTransform to_bullet(const Pose& pose) {
  btTransform out;
  for (int i = 0; i < 3; ++i) {
    out.getBasis()[i] = to_bullet(Eigen::Vector3d(pose.linear().row(i)));
  }
  out.setOrigin(to_bullet(Eigen::Vector3d(pose.translation())));
  return out;
}

struct ClosestRay : btTriangleRaycastCallback {
  using btTriangleRaycastCallback::btTriangleRaycastCallback;
  bool hit = false;
  btScalar reportHit(const btVector3&, btScalar fraction, int, int) override {
    hit = true;
    return fraction;
  }
};

struct CountInBox : btTriangleCallback {
  const Eigen::AlignedBox3d* box = nullptr;
  double count = 0;
  void processTriangle(btVector3* corners, int, int) override {
    const auto corner = [&](int i) {
      return Eigen::Vector3d(corners[i].x(), corners[i].y(), corners[i].z());
    };
    const Triangle triangle{{corner(0), corner(1), corner(2)}};
    count += triangle_intersects_box(triangle, box->min(), box->max()) ? 1 : 0;
  }
};

// Points that touch; those that are merely near are reported, too.
struct CountContacts : btCollisionWorld::ContactResultCallback {
  double count = 0;
  btScalar addSingleResult(btManifoldPoint& point, const btCollisionObjectWrapper*, int, int,
                           const btCollisionObjectWrapper*, int, int) override {
    count += point.getDistance() <= 0 ? 1 : 0;
    return 0;
  }
};

struct MovingShape {
  MovingShape(double size, ShapeKind kind) {
    const auto radius = static_cast<btScalar>(size);
    if (kind == ShapeKind::kSphere) {
      shape = std::make_unique<btSphereShape>(radius);
    } else if (kind == ShapeKind::kCapsule) {
      shape = std::make_unique<btCapsuleShapeZ>(radius, 2 * radius);
    } else {
      shape = std::make_unique<btBoxShape>(btVector3(radius, radius, radius));
      const Eigen::Quaternion<btScalar> q = kCubeRotation.cast<btScalar>();
      rotation = btMatrix3x3(btQuaternion(q.x(), q.y(), q.z(), q.w()));
    }
  }
  std::unique_ptr<btConvexShape> shape;
  btMatrix3x3 rotation = btMatrix3x3::getIdentity();
};

// The mesh in the forms that both shapes refer to.
struct BulletMesh {
  explicit BulletMesh(const TriangleMesh& mesh) {
    for (const auto& t : mesh.triangles) {
      for (const std::uint32_t corner : t) indices.push_back(static_cast<int>(corner));
    }
    for (const Eigen::Vector3f& p : mesh.positions) {
      vertices.insert(vertices.end(), {p.x(), p.y(), p.z()});
    }
    arrays = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(mesh.triangles.size()), indices.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.positions.size()), vertices.data(),
        static_cast<int>(3 * sizeof(btScalar)));
  }
  [[nodiscard]] double bytes() const {
    return static_cast<double>(vertices.size() * sizeof(btScalar) + indices.size() * sizeof(int));
  }

  std::vector<int> indices;
  std::vector<btScalar> vertices;
  std::unique_ptr<btTriangleIndexVertexArray> arrays;
};

class BulletSubject : public Subject {
 public:
  explicit BulletSubject(const TriangleMesh& mesh) : mesh_(mesh), bullet_(mesh) {
    shape_ = std::make_unique<btBvhTriangleMeshShape>(bullet_.arrays.get(), true);
    shape_->setMargin(0);  // casts would stop short of the surface by it
    object_.setCollisionShape(shape_.get());
  }

  [[nodiscard]] SubjectBytes bytes() const override {
    const double tree = shape_->getOptimizedBvh()->calculateSerializeBufferSize();
    return {tree, tree + bullet_.bytes()};
  }
  bool rays(std::span<const Ray> rays, std::span<double> out) override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const auto [from, to, t] = segment_of(rays[i]);
      ClosestRay callback(from, to);
      shape_->performRaycast(&callback, from, to);
      out[i] = callback.hit ? double{callback.m_hitFraction} * t
                            : std::numeric_limits<double>::infinity();
    }
    return true;
  }
  // The sweep of its collision world against one object, without a broad phase.
  bool casts(std::span<const ShapeCast> casts, std::span<double> out) override {
    for (std::size_t i = 0; i < casts.size(); ++i) {
      const MovingShape moving(casts[i].radius, casts[i].kind);
      const auto [from, to, t] = segment_of(casts[i].ray);
      btCollisionWorld::ClosestConvexResultCallback callback(from, to);
      btCollisionWorld::objectQuerySingle(moving.shape.get(), btTransform(moving.rotation, from),
                                          btTransform(moving.rotation, to), &object_, shape_.get(),
                                          btTransform::getIdentity(), callback, 0);
      out[i] = callback.hasHit() ? double{callback.m_closestHitFraction} * t
                                 : std::numeric_limits<double>::infinity();
    }
    return true;
  }
  // Between two objects, likewise without a broad phase.
  bool contacts(std::span<const PlacedShape> shapes, std::span<double> out) override {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const MovingShape moving(shapes[i].radius, shapes[i].kind);
      btCollisionObject body;
      body.setCollisionShape(moving.shape.get());
      body.setWorldTransform(btTransform(moving.rotation, to_bullet(shapes[i].center)));
      CountContacts callback;
      world_.contactPairTest(&body, &object_, callback);
      out[i] = callback.count;
    }
    return true;
  }
  bool boxes(std::span<const Eigen::AlignedBox3d> boxes, std::span<double> out) override {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      CountInBox callback;
      callback.box = &boxes[i];
      shape_->processAllTriangles(&callback, to_bullet(boxes[i].min()), to_bullet(boxes[i].max()));
      out[i] = callback.count;
    }
    return true;
  }

 private:
  // Bullet uses segments; this length passes the mesh from any origin of the workload. `t`: where
  // it ends on the ray.
  struct Segment {
    btVector3 from, to;
    double t;
  };
  [[nodiscard]] Segment segment_of(const Ray& ray) const {
    const double t = 4 * mesh_.bounds.diagonal().norm() / ray.direction.norm();
    return {to_bullet(ray.origin), to_bullet(Eigen::Vector3d(ray.origin + t * ray.direction)), t};
  }

  const TriangleMesh& mesh_;
  BulletMesh bullet_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  btCollisionObject object_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
};

// GImpact finds pairs of boxes and decides them by its own, inexact triangle test.
class GimpactSubject : public Subject {
 public:
  explicit GimpactSubject(const TriangleMesh& mesh) : bullet_(mesh) {
    shape_ = std::make_unique<btGImpactMeshShape>(bullet_.arrays.get());
    shape_->setMargin(0);
    shape_->updateBound();
    part_ = shape_->getMeshPart(0);
  }

  [[nodiscard]] SubjectBytes bytes() const override {
    const double tree =
        static_cast<double>(part_->getBoxSet()->getNodeCount()) * sizeof(BT_QUANTIZED_BVH_NODE);
    return {tree, tree + bullet_.bytes()};
  }
  bool first_contacts(std::span<const Pose> poses, std::span<double> out) override {
    return collide(poses, out, true);
  }
  bool all_pairs(std::span<const Pose> poses, std::span<double> out) override {
    return collide(poses, out, false);
  }

 private:
  bool collide(std::span<const Pose> poses, std::span<double> out, bool first_only) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const btTransform here = btTransform::getIdentity();
      const btTransform there = to_bullet(poses[i]);
      btPairSet pairs;
      btGImpactBoxSet::find_collision(part_->getBoxSet(), here, part_->getBoxSet(), there, pairs);
      out[i] = 0;
      part_->lockChildShapes();
      for (int p = 0; p < pairs.size() && !(first_only && out[i] > 0); ++p) {
        btPrimitiveTriangle a;
        btPrimitiveTriangle b;
        part_->getPrimitiveTriangle(pairs[p].m_index1, a);
        part_->getPrimitiveTriangle(pairs[p].m_index2, b);
        a.applyTransform(here);
        b.applyTransform(there);
        a.buildTriPlane();
        b.buildTriPlane();
        GIM_TRIANGLE_CONTACT contact;
        if (a.overlap_test_conservative(b) && a.find_triangle_collision_clip_method(b, contact)) {
          ++out[i];
        }
      }
      part_->unlockChildShapes();
    }
    return true;
  }

  BulletMesh bullet_;
  std::unique_ptr<btGImpactMeshShape> shape_;
  btGImpactMeshShapePart* part_ = nullptr;
};

}  // namespace

void add_bullet(std::vector<Library>& libraries) {
  libraries.push_back({"bullet", "quantised", [](const TriangleMesh& mesh) {
                         return std::make_unique<BulletSubject>(mesh);
                       }});
  libraries.push_back({"bullet", "gimpact", [](const TriangleMesh& mesh) {
                         return std::make_unique<GimpactSubject>(mesh);
                       }});
}

}  // namespace boxtree::bench
