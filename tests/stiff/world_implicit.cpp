// SPDX-License-Identifier: MIT
// The implicit step: velocities v' with M (v' - v) = dt (external + sum J^T f(v')), where a
// contact's force f = k (depth - dt J v') - c J v' is linear in v' as long as it pushes.
#include <algorithm>

#include <Eigen/Cholesky>

#include "tests/stiff/world.h"

namespace boxtree::stiff {
namespace {

struct ImplicitContact {
  Eigen::VectorXd jacobian;  // speed apart over the velocities of the island
  double depth;
  bool pushes = true;
};

}  // namespace

void World::solve_island(const std::vector<std::uint32_t>& members, double seconds) {
  const auto size = static_cast<Eigen::Index>(6 * members.size());
  const auto place_of = [&](std::uint32_t body) {
    const auto at = std::lower_bound(members.begin(), members.end(), body);
    return at != members.end() && *at == body ? 6 * Eigen::Index(at - members.begin())
                                              : Eigen::Index(-1);
  };

  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd momentum(size);
  for (const std::uint32_t member : members) {
    const Body& body = bodies[member];
    const Eigen::Index at = place_of(member);
    const Eigen::Matrix3d inertia = body.inertia_in_world();
    mass.block<3, 3>(at, at) = body.mass * Eigen::Matrix3d::Identity();
    mass.block<3, 3>(at + 3, at + 3) = inertia;
    momentum.segment<3>(at) = body.mass * (body.velocity + seconds * gravity_);
    momentum.segment<3>(at + 3) =
        inertia * body.spin - seconds * body.spin.cross(inertia * body.spin);
  }

  std::vector<ImplicitContact> contacts;
  for (const Contact& contact : contacts_) {
    if (place_of(contact.body) < 0) continue;
    ImplicitContact implicit{Eigen::VectorXd::Zero(size), contact.depth};
    const auto add = [&](std::uint32_t body, const Eigen::Vector3d& direction) {
      const Eigen::Index at = place_of(body);
      const Eigen::Vector3d arm = contact.point - bodies[body].position;
      implicit.jacobian.segment<3>(at) += direction;
      implicit.jacobian.segment<3>(at + 3) += arm.cross(direction);
    };
    add(contact.body, contact.normal);
    if (contact.other != kLevel) add(contact.other, -contact.normal);
    contacts.push_back(std::move(implicit));
  }

  // Contacts that would pull let go, and none comes back: ends after as many rounds as contacts.
  const double stiffness = law_.stiffness;
  const double effective = seconds * (seconds * stiffness + law_.damping);
  Eigen::VectorXd velocity;
  for (bool settled = false; !settled;) {
    Eigen::MatrixXd matrix = mass;
    Eigen::VectorXd right = momentum;
    for (const ImplicitContact& contact : contacts) {
      if (!contact.pushes) continue;
      matrix += effective * contact.jacobian * contact.jacobian.transpose();
      right += seconds * stiffness * contact.depth * contact.jacobian;
    }
    velocity = matrix.ldlt().solve(right);
    settled = true;
    for (ImplicitContact& contact : contacts) {
      const double apart = contact.jacobian.dot(velocity);
      const double force = stiffness * (contact.depth - seconds * apart) - law_.damping * apart;
      if (!contact.pushes || force >= 0) continue;
      contact.pushes = false;
      settled = false;
    }
  }
  for (const std::uint32_t member : members) {
    Body& body = bodies[member];
    const Eigen::Index at = place_of(member);
    const Eigen::Vector3d moved = velocity.segment<3>(at);
    body.acceleration = (moved - body.velocity) / seconds;
    body.velocity = moved;
    body.spin = velocity.segment<3>(at + 3);
  }
}

}  // namespace boxtree::stiff
