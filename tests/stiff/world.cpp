// SPDX-License-Identifier: MIT
// Contacts of the world's bodies, and the explicit steps.
#include "tests/stiff/world.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <span>

#include "runtime/file/checksum.h"
#include "tests/stiff/corner_contact.h"

namespace boxtree::stiff {

Pose Body::pose() const {
  Pose pose = Pose::Identity();
  pose.linear() = orientation.toRotationMatrix();
  pose.translation() = position;
  return pose;
}

Eigen::Vector3d Body::corner(unsigned number) const {
  const Eigen::Vector3d side((number & 1u) != 0 ? 1 : -1, (number & 2u) != 0 ? 1 : -1,
                             (number & 4u) != 0 ? 1 : -1);
  return pose() * Eigen::Vector3d(side.cwiseProduct(half_extents));
}

Eigen::Matrix3d Body::inertia_in_world() const {
  const Eigen::Matrix3d rotation = orientation.toRotationMatrix();
  return rotation * inertia.asDiagonal() * rotation.transpose();
}

Body make_body(const Shape& shape, const Eigen::Vector3d& half_extents, double mass) {
  Body body;
  body.shape = &shape;
  body.half_extents = half_extents;
  body.mass = mass;
  const Eigen::Vector3d squares = half_extents.cwiseAbs2();
  body.inertia = mass / 3 *
                 Eigen::Vector3d(squares.y() + squares.z(), squares.x() + squares.z(),
                                 squares.x() + squares.y());
  return body;
}

namespace {

// Corners of `body` below the triangles become contacts with `other`. A corner deeper than half the
// body's least thickness is on its other side.
void add_corners(const Body& body, std::uint32_t number, std::uint32_t other, double limit,
                 std::span<const WorldTriangle> triangles, std::vector<Contact>& out) {
  if (triangles.empty()) return;
  for (unsigned i = 0; i < 8; ++i) {
    const Eigen::Vector3d point = body.corner(i);
    const std::optional<Depth> depth = depth_of(point, triangles, limit);
    if (depth)
      out.push_back({number, other, i, point, depth->normal, depth->depth, depth->at_edge});
  }
}

}  // namespace

void World::find_level_contacts(std::uint32_t number) {
  Body& body = bodies[number];
  const Pose pose = body.pose();
  find_touching(*level_, Pose::Identity(), *body.shape, pose, touching_);
  std::vector<WorldTriangle> triangles;
  place(*level_, touching_.first, nullptr, triangles);
  add_corners(body, number, kLevel, body.half_extents.minCoeff(), triangles, contacts_);
}

void World::find_body_contacts(std::uint32_t first, std::uint32_t second) {
  const Body& a = bodies[first];
  const Body& b = bodies[second];
  const Pose pose_a = a.pose();
  const Pose pose_b = b.pose();
  find_touching(*a.shape, pose_a, *b.shape, pose_b, touching_);
  const double limit = std::min(a.half_extents.minCoeff(), b.half_extents.minCoeff());
  std::vector<WorldTriangle> triangles;
  place(*b.shape, touching_.second, &pose_b, triangles);
  add_corners(a, first, second, limit, triangles, contacts_);
  place(*a.shape, touching_.first, &pose_a, triangles);
  add_corners(b, second, first, limit, triangles, contacts_);
}

void World::find_contacts() {
  contacts_.clear();
  const auto count = static_cast<std::uint32_t>(bodies.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    find_level_contacts(i);
    // Bodies too far apart to touch are not worth a query: their circumscribed spheres.
    for (std::uint32_t j = i + 1; j < count; ++j) {
      const double radii = bodies[i].half_extents.norm() + bodies[j].half_extents.norm();
      const Eigen::Vector3d apart = bodies[i].position - bodies[j].position;
      if (apart.squaredNorm() <= radii * radii) find_body_contacts(i, j);
    }
  }
}

void World::count_toggles() {
  std::vector<std::uint32_t> now(bodies.size(), 0);
  for (const Contact& contact : contacts_) {
    edge_contacts_ += contact.at_edge ? 1u : 0u;
    now[contact.body] |= 1u << (contact.corner + (contact.other == kLevel ? 0 : 8));
  }
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    toggles_ += static_cast<std::uint64_t>(std::popcount(now[i] ^ bodies[i].touching));
    bodies[i].touching = now[i];
  }
}

void World::kick(double seconds) {
  const std::size_t count = bodies.size();
  std::vector<Eigen::Vector3d> force(count);
  std::vector<Eigen::Vector3d> torque(count, Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < count; ++i) force[i] = bodies[i].mass * gravity_;
  const auto velocity_at = [&](std::uint32_t body, const Eigen::Vector3d& point) {
    const Body& b = bodies[body];
    return Eigen::Vector3d(b.velocity + b.spin.cross(point - b.position));
  };
  const auto push = [&](std::uint32_t body, const Eigen::Vector3d& point,
                        const Eigen::Vector3d& by) {
    force[body] += by;
    torque[body] += (point - bodies[body].position).cross(by);
  };
  for (const Contact& contact : contacts_) {
    Eigen::Vector3d apart = velocity_at(contact.body, contact.point);
    if (contact.other != kLevel) apart -= velocity_at(contact.other, contact.point);
    const double size =
        std::max(0.0, law_.stiffness * contact.depth - law_.damping * apart.dot(contact.normal));
    push(contact.body, contact.point, size * contact.normal);
    if (contact.other != kLevel) push(contact.other, contact.point, -size * contact.normal);
  }
  for (std::size_t i = 0; i < count; ++i) {
    Body& body = bodies[i];
    body.acceleration = force[i] / body.mass;
    body.velocity += seconds * body.acceleration;
    const Eigen::Matrix3d inertia = body.inertia_in_world();
    const Eigen::Vector3d gyroscopic = body.spin.cross(inertia * body.spin);
    const Eigen::Matrix3d rotation = body.orientation.toRotationMatrix();
    body.spin += seconds * (rotation * body.inertia.cwiseInverse().asDiagonal() *
                            rotation.transpose() * (torque[i] - gyroscopic));
  }
}

void World::drift(double seconds) {
  for (Body& body : bodies) {
    body.position += seconds * body.velocity;
    const double angle = seconds * body.spin.norm();
    if (angle == 0) continue;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, body.spin.normalized()));
    body.orientation = (turn * body.orientation).normalized();
  }
}

void World::step_symplectic_euler(double seconds) {
  find_contacts();
  count_toggles();
  kick(seconds);
  drift(seconds);
}

void World::step_verlet(double seconds) {
  drift(seconds / 2);
  find_contacts();
  count_toggles();
  kick(seconds);
  drift(seconds / 2);
}

void World::step_implicit(double seconds) {
  find_contacts();
  count_toggles();
  // Bodies that push each other, however indirectly, are solved together: the island of each body
  // is named after its first member.
  std::vector<std::uint32_t> island(bodies.size());
  for (std::uint32_t i = 0; i < island.size(); ++i) island[i] = i;
  for (const Contact& contact : contacts_) {
    if (contact.other == kLevel) continue;
    const std::uint32_t from = std::max(island[contact.body], island[contact.other]);
    const std::uint32_t to = std::min(island[contact.body], island[contact.other]);
    for (std::uint32_t& name : island) name = name == from ? to : name;
  }
  for (std::uint32_t name = 0; name < island.size(); ++name) {
    std::vector<std::uint32_t> members;
    for (std::uint32_t i = 0; i < island.size(); ++i) {
      if (island[i] == name) members.push_back(i);
    }
    if (!members.empty()) solve_island(members, seconds);
  }
  drift(seconds);
}

double World::energy() const {
  double energy = 0;
  for (const Body& body : bodies) {
    energy += body.mass * (body.velocity.squaredNorm() / 2 - gravity_.dot(body.position));
    energy += body.spin.dot(body.inertia_in_world() * body.spin) / 2;
  }
  for (const Contact& contact : contacts_) {
    energy += law_.stiffness * contact.depth * contact.depth / 2;
  }
  return energy;
}

std::uint64_t World::state_hash() const {
  std::vector<double> state;
  for (const Body& body : bodies) {
    state.insert(state.end(), body.position.begin(), body.position.end());
    const Eigen::Vector4d& turn = body.orientation.coeffs();
    state.insert(state.end(), turn.begin(), turn.end());
    state.insert(state.end(), body.velocity.begin(), body.velocity.end());
    state.insert(state.end(), body.spin.begin(), body.spin.end());
  }
  return checksum(std::as_bytes(std::span(state)));
}

}  // namespace boxtree::stiff
