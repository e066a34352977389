// SPDX-License-Identifier: MIT
// Runs the same simulation with any shape of the level.
#include "samples/bullet_drop/drop.h"

#include <algorithm>
#include <btBulletDynamicsCommon.h>
#include <cmath>
#include <memory>

namespace bullet_drop {
namespace {

constexpr unsigned kSteps = 8;
constexpr float kTread = 1;
constexpr float kRise = 0.3f;
constexpr float kWidth = 8;
constexpr unsigned kCells = 8;  // along each edge of the hills
constexpr float kCell = 1;

std::uint32_t add_vertex(Level& level, float x, float y, float z) {
  level.positions.insert(level.positions.end(), {x, y, z});
  return static_cast<std::uint32_t>(level.positions.size() / 3 - 1);
}

void add_quad(Level& level, const std::array<std::array<float, 3>, 4>& corners) {
  std::array<std::uint32_t, 4> v{};
  for (std::size_t i = 0; i < 4; ++i) {
    v[i] = add_vertex(level, corners[i][0], corners[i][1], corners[i][2]);
  }
  level.triangles.push_back({v[0], v[1], v[2]});
  level.triangles.push_back({v[0], v[2], v[3]});
}

float hill(float x, float y) {
  return 0.2f * std::sin(0.9f * x) * std::cos(0.8f * y);
}

btVector3 hill_vertex(unsigned i, unsigned j) {
  const float x = 0.01f + kCell * static_cast<float>(i);
  const float y = kCell * static_cast<float>(j) - kWidth / 2;
  return {x, y, hill(x, y)};
}

void place_crates(std::vector<btTransform>& places) {
  for (unsigned i = 0; i < kSteps; ++i) {
    for (int j = 0; j < 2; ++j) {
      const btScalar x = -(btScalar(i) + btScalar(0.5)) * btScalar(kTread);
      const auto y = btScalar(-1.9 + 3.7 * j + 0.05 * i);
      const btQuaternion turn(btVector3(0, 0, 1), btScalar(0.05 * i));
      places.emplace_back(turn, btVector3(x, y,
                                          btScalar(kRise) * btScalar(i + 1) + kCrateHalf +
                                              btScalar(0.05 + 0.02 * i)));
    }
  }
  for (unsigned i = 0; i < kCells; i += 2) {
    for (unsigned j = 0; j < kCells; j += 2) {
      // Flat above the middle of a cell's lower triangle, so that the crate lands without tumbling.
      const btVector3 corners[] = {hill_vertex(i, j), hill_vertex(i + 1, j),
                                   hill_vertex(i + 1, j + 1)};
      const btVector3 normal =
          (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
      const btVector3 middle = (corners[0] + corners[1] + corners[2]) / 3;
      const btQuaternion turn(btVector3(0, 0, 1), btScalar(0.1) * btScalar(i + j));
      const btQuaternion tilt = shortestArcQuat(btVector3(0, 0, 1), normal);
      places.emplace_back(tilt * turn, middle + (kCrateHalf + btScalar(0.05)) * normal);
    }
  }
}

}  // namespace

Level make_level() {
  Level level;
  for (unsigned i = 0; i < kSteps; ++i) {
    const float near = -kTread * static_cast<float>(i);
    const float far = near - kTread;
    const float below = kRise * static_cast<float>(i);
    const float top = below + kRise;
    constexpr float kSide = kWidth / 2;
    add_quad(
        level,
        {{{near, -kSide, below}, {near, kSide, below}, {near, kSide, top}, {near, -kSide, top}}});
    add_quad(level,
             {{{near, -kSide, top}, {near, kSide, top}, {far, kSide, top}, {far, -kSide, top}}});
  }
  const auto first = static_cast<std::uint32_t>(level.positions.size() / 3);
  for (unsigned j = 0; j <= kCells; ++j) {
    for (unsigned i = 0; i <= kCells; ++i) {
      const btVector3 at = hill_vertex(i, j);
      static_cast<void>(add_vertex(level, at.x(), at.y(), at.z()));
    }
  }
  for (unsigned j = 0; j < kCells; ++j) {
    for (unsigned i = 0; i < kCells; ++i) {
      const std::uint32_t v = first + j * (kCells + 1) + i;
      const std::uint32_t above = v + kCells + 1;
      level.triangles.push_back({v, v + 1, above + 1});
      level.triangles.push_back({v, above + 1, above});
    }
  }
  return level;
}

std::vector<Crate> drop_crates(btConcaveShape& level) {
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher(&configuration);
  btDbvtBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world(&dispatcher, &broadphase, &solver, &configuration);
  world.setGravity(btVector3(0, 0, btScalar(-9.81)));

  constexpr auto kFriction = btScalar(0.8);
  btRigidBody ground(btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &level));
  ground.setFriction(kFriction);
  world.addRigidBody(&ground);

  btBoxShape box(btVector3(kCrateHalf, kCrateHalf, kCrateHalf));
  constexpr auto kMass = btScalar(20);
  btVector3 inertia;
  box.calculateLocalInertia(kMass, inertia);
  std::vector<btTransform> places;
  place_crates(places);
  std::vector<std::unique_ptr<btRigidBody>> bodies;
  for (const btTransform& place : places) {
    btRigidBody::btRigidBodyConstructionInfo info(kMass, nullptr, &box, inertia);
    info.m_startWorldTransform = place;
    info.m_friction = kFriction;
    // Bodies sleep only at rest: a hundredth of Bullet's own thresholds.
    info.m_linearSleepingThreshold = btScalar(0.05);
    info.m_angularSleepingThreshold = btScalar(0.1);
    bodies.push_back(std::make_unique<btRigidBody>(info));
    world.addRigidBody(bodies.back().get());
  }

  constexpr int kStepsPerSecond = 240;
  constexpr int kSeconds = 10;
  for (int i = 0; i < kStepsPerSecond * kSeconds; ++i) {
    world.stepSimulation(btScalar(1) / kStepsPerSecond, 1, btScalar(1) / kStepsPerSecond);
  }

  std::vector<Crate> crates;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const btTransform& pose = bodies[i]->getWorldTransform();
    const btVector3 up = pose.getBasis().getRow(2).absolute();
    const btScalar upright = std::min(btScalar(1), up[up.maxAxis()]);
    crates.push_back({places[i].getOrigin(), pose.getOrigin(), btDegrees(std::acos(upright)),
                      !bodies[i]->isActive()});
  }
  for (const auto& body : bodies) world.removeRigidBody(body.get());
  world.removeRigidBody(&ground);
  return crates;
}

bool has_fallen_through(const Crate& crate) {
  const btVector3& at = crate.position;
  if (std::abs(at.y()) > btScalar(kWidth / 2) || at.x() > btScalar(kCells * kCell)) return true;
  if (at.x() > 0) return at.z() < btScalar(hill(float(at.x()), float(at.y())));
  const auto step = static_cast<int>(-at.x() / btScalar(kTread));
  return step >= int(kSteps) || at.z() < btScalar(kRise) * btScalar(step + 1);
}

}  // namespace bullet_drop
