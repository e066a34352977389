// SPDX-License-Identifier: MIT
// boxtree_rolling: bodies slide and roll over a flat floor of random triangles, pushed by the
// contacts of boxtree and in a world of Bullet, with and without its utility for internal edges.
// Prints how fast each was thrown up and how much of its speed it lost; the floor is flat, so both
// should be 0.
#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>
#include <algorithm>
#include <btBulletDynamicsCommon.h>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/support/cooked.h"
#include "tests/support/program_options.h"
#include "tests/support/rolling.h"

namespace boxtree::rolling {
namespace {

btVector3 to_bullet(const Vector3d& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

enum class InternalEdges { kAsTheyAre, kAdjusted };

// The floor as a static body.
class BulletFloor {
 public:
  BulletFloor(const SourceMesh& mesh, InternalEdges edges) {
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Vector3d p = mesh.positions[v];
      for (const double x : p) vertices_.push_back(static_cast<btScalar>(x));
    }
    for (const cooker::Face& face : mesh.faces) {
      for (std::size_t c = 0; c < 3; ++c) corners_.push_back(static_cast<int>(face.corner[c]));
      if (face.corner[3] == cooker::kNoCorner) continue;
      for (const std::size_t c : {0u, 2u, 3u}) corners_.push_back(static_cast<int>(face.corner[c]));
    }
    arrays_ = std::make_unique<btTriangleIndexVertexArray>(
        static_cast<int>(corners_.size() / 3), corners_.data(), static_cast<int>(3 * sizeof(int)),
        static_cast<int>(mesh.positions.size()), vertices_.data(),
        static_cast<int>(3 * sizeof(btScalar)));
    shape_ = std::make_unique<btBvhTriangleMeshShape>(arrays_.get(), true);
    body_ = std::make_unique<btRigidBody>(0, nullptr, shape_.get());
    body_->setFriction(1);
    if (edges == InternalEdges::kAsTheyAre) return;
    btGenerateInternalEdgeInfo(shape_.get(), &edges_);
    body_->setCollisionFlags(body_->getCollisionFlags() |
                             btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  }
  [[nodiscard]] btRigidBody* body() { return body_.get(); }

 private:
  std::vector<btScalar> vertices_;
  std::vector<int> corners_;
  std::unique_ptr<btTriangleIndexVertexArray> arrays_;
  std::unique_ptr<btBvhTriangleMeshShape> shape_;
  std::unique_ptr<btRigidBody> body_;
  btTriangleInfoMap edges_;
};

// The floor's triangle is the first or the second.
bool adjust_contact(btManifoldPoint& point, const btCollisionObjectWrapper* first, int first_part,
                    int first_index, const btCollisionObjectWrapper* second, int second_part,
                    int second_index) {
  if (first->getCollisionShape()->getShapeType() == TRIANGLE_SHAPE_PROXYTYPE) {
    btAdjustInternalEdgeContacts(point, first, second, first_part, first_index);
  } else {
    btAdjustInternalEdgeContacts(point, second, first, second_part, second_index);
  }
  return false;
}

std::unique_ptr<btConvexShape> bullet_shape(const NamedBody& body) {
  return std::visit(
      []<class S>(const S& shape) -> std::unique_ptr<btConvexShape> {
        if constexpr (std::is_same_v<S, Sphere>) {
          return std::make_unique<btSphereShape>(static_cast<btScalar>(shape.radius));
        } else if constexpr (std::is_same_v<S, Capsule>) {
          const auto radius = static_cast<btScalar>(shape.radius);
          const auto height = static_cast<btScalar>((shape.end - shape.start).norm());
          if (shape.start.x() == shape.end.x()) {
            return std::make_unique<btCapsuleShapeZ>(radius, height);
          }
          return std::make_unique<btCapsuleShapeX>(radius, height);
        } else {
          return std::make_unique<btBoxShape>(to_bullet(shape.half_extents));
        }
      },
      body.shape);
}

btTransform bullet_pose(const NamedBody& body, const Vector3d& start) {
  btTransform pose = btTransform::getIdentity();
  std::visit(
      [&]<class S>(const S& shape) {
        if constexpr (std::is_same_v<S, Capsule>) {
          pose.setOrigin(to_bullet(start + (shape.start + shape.end) / 2));
        } else {
          pose.setOrigin(to_bullet(start + shape.center));
        }
        if constexpr (std::is_same_v<S, OrientedBox>) {
          const auto q = shape.rotation.coeffs();
          pose.setRotation({static_cast<btScalar>(q[0]), static_cast<btScalar>(q[1]),
                            static_cast<btScalar>(q[2]), static_cast<btScalar>(q[3])});
        }
      },
      body.shape);
  return pose;
}

// As ride() of tests/support/rolling.h, with Bullet's solver at its defaults.
Ride bullet_ride(BulletFloor& floor, const NamedBody& body, const Vector3d& start,
                 const Vector3d& direction) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity({0, 0, static_cast<btScalar>(-kGravity)});
  world.addRigidBody(floor.body());
  const std::unique_ptr<btConvexShape> shape = bullet_shape(body);
  btVector3 inertia(0, 0, 0);
  if (body.inertia > 0) shape->calculateLocalInertia(1, inertia);
  btRigidBody moving(1, nullptr, shape.get(), inertia);
  moving.setWorldTransform(bullet_pose(body, start - kSunk * Vector3d::UnitZ()));
  moving.setFriction(static_cast<btScalar>(body.inertia > 0 ? kFriction : 0));
  moving.setActivationState(DISABLE_DEACTIVATION);
  const Vector3d velocity = kSpeed * direction;
  moving.setLinearVelocity(to_bullet(velocity));
  if (body.inertia > 0) {
    const double radius = std::get<Sphere>(body.shape).radius;
    moving.setAngularVelocity(to_bullet(Vector3d::UnitZ().cross(velocity) / radius));
  }
  world.addRigidBody(&moving);
  Ride found;
  for (int step = 0; step < kSteps; ++step) {
    world.stepSimulation(static_cast<btScalar>(kStep), 0);
    const btVector3 v = moving.getLinearVelocity();
    found.up = std::max(found.up, double{v.z()});
    found.down = std::min(found.down, double{v.z()});
    found.least_speed = std::min(found.least_speed, std::hypot(double{v.x()}, double{v.y()}));
  }
  const btVector3 end = moving.getWorldTransform().getOrigin();
  found.end = Vector3d(double{end.x()}, double{end.y()}, double{end.z()});
  world.removeRigidBody(&moving);
  world.removeRigidBody(floor.body());
  return found;
}

template <class RideOne>
void print_row(const char* name, RideOne ride_one) {
  fmt::print("| {} |", name);
  for (const NamedBody& body : bodies()) {
    double up = 0, slowest = kSpeed;
    for (const Vector3d& direction : directions()) {
      const Ride found = ride_one(body, start_of(direction), direction);
      up = std::max(up, found.up);
      slowest = std::min(slowest, found.least_speed);
    }
    fmt::print(" {:.2g} / {:.2g} |", up, kSpeed - slowest);
  }
  fmt::print("\n");
}

void print_floor(const SourceMesh& mesh) {
  fmt::print("{} triangles: fastest up / speed lost, m/s, of {}\n\n|  |",
             mesh.faces.size() * (mesh.faces[0].corner[3] == cooker::kNoCorner ? 1 : 2), kSpeed);
  for (const NamedBody& body : bodies()) fmt::print(" {} |", body.name);
  fmt::print("\n|---|");
  for (std::size_t i = 0; i < bodies().size(); ++i) fmt::print("---|");
  fmt::print("\n");
  cooker::CookOptions options;
  options.active_edges = 5;
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8, options);
  for (const auto& [name, normals] : {std::pair("boxtree, resolved normals", Normals::kResolved),
                                      {"boxtree, normals of contacts", Normals::kOfContacts}}) {
    print_row(name, [&, normals = normals](const NamedBody& body, const Vector3d& start,
                                           const Vector3d& direction) {
      return ride(cooked.tree, body, start, direction, normals);
    });
  }
  for (const auto& [name, edges] :
       {std::pair("bullet, internal edges adjusted", InternalEdges::kAdjusted),
        {"bullet", InternalEdges::kAsTheyAre}}) {
    BulletFloor floor(mesh, edges);
    print_row(name, [&](const NamedBody& body, const Vector3d& start, const Vector3d& direction) {
      return bullet_ride(floor, body, start, direction);
    });
  }
  fmt::print("\n");
}

}  // namespace
}  // namespace boxtree::rolling

int main(int argc, char** argv) {
  boxtree::test::ProgramOptions program(
      "Bodies on a flat floor of random triangles, by boxtree and by Bullet.");
  unsigned cells = 71;
  program.add("--cells", cells, "Of the floor, along each side, two triangles each")
      .between(2u, 2000u)
      .shows_default();
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  gContactAddedCallback = boxtree::rolling::adjust_contact;
  boxtree::cooker::SourceMesh quad = boxtree::rolling::floor_of(1, boxtree::rolling::flat);
  quad.faces = {{{0, 1, 3, 2}}};
  boxtree::rolling::print_floor(quad);
  boxtree::rolling::print_floor(boxtree::rolling::floor_of(cells, boxtree::rolling::flat));
}
