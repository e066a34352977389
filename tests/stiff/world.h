// SPDX-License-Identifier: MIT
// Rigid boxes on springs: a penalty-contact simulator whose contacts come from pair queries. What
// it computes depends on the set of faces that touch, never on the order in which a tree reports
// them.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include <Eigen/Geometry>

#include "tests/stiff/shape.h"

namespace boxtree::stiff {

inline constexpr double kGravity = 9.81;  // m/s^2

/// A box of uniform density. `shape` must be the shape of box(half_extents).
struct Body {
  const Shape* shape = nullptr;
  Eigen::Vector3d half_extents;
  double mass = 1;          // kg
  Eigen::Vector3d inertia;  // about its axes, kg m^2
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d spin = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  // mean over the last step
  std::uint32_t touching = 0;  // corners on springs: bits 0..7 the level, 8..15 another body

  [[nodiscard]] Pose pose() const;
  [[nodiscard]] Eigen::Vector3d corner(unsigned number) const;
  [[nodiscard]] Eigen::Matrix3d inertia_in_world() const;
};
[[nodiscard]] Body make_body(const Shape& shape, const Eigen::Vector3d& half_extents, double mass);

inline constexpr std::uint32_t kLevel = std::numeric_limits<std::uint32_t>::max();

/// A corner of `body` below the surface of the level or of another body.
struct Contact {
  std::uint32_t body;
  std::uint32_t other;  // or kLevel
  unsigned corner;      // 0 to 7
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  // pushes `body` out
  double depth;
  bool at_edge;  // the nearest surface point lies on an edge: the normal is no face's
};

/// Of every contact: force along the normal = stiffness * depth - damping * speed apart, and never
/// a pull.
struct SpringLaw {
  double stiffness;  // N/m
  double damping;    // N s/m
};

class World {
 public:
  World(const Shape& level, const SpringLaw& law, const Eigen::Vector3d& gravity)
      : level_(&level), law_(law), gravity_(gravity) {}

  std::vector<Body> bodies;

  void set_level(const Shape& level) { level_ = &level; }
  void set_law(const SpringLaw& law) { law_ = law; }

  /// Velocities by the forces here, then positions by the new velocities: first order.
  void step_symplectic_euler(double seconds);
  /// Half a move, forces there, the other half: second order, symplectic too.
  void step_verlet(double seconds);
  /// Backward Euler in the springs as they stand, contacts that would pull let go: stable for every
  /// step.
  void step_implicit(double seconds);

  /// Contacts where the bodies are now, in an order that depends on them alone.
  void find_contacts();
  [[nodiscard]] const std::vector<Contact>& contacts() const { return contacts_; }

  /// Corners that came onto their spring or left it, over all steps.
  [[nodiscard]] std::uint64_t toggles() const { return toggles_; }
  /// Contacts at edges, over all steps.
  [[nodiscard]] std::uint64_t edge_contacts() const { return edge_contacts_; }
  /// Kinetic, of height and of springs. Precondition: find_contacts() where the bodies are now.
  [[nodiscard]] double energy() const;
  /// Of the exact bits of all bodies.
  [[nodiscard]] std::uint64_t state_hash() const;

 private:
  void find_level_contacts(std::uint32_t body);
  void find_body_contacts(std::uint32_t first, std::uint32_t second);
  void count_toggles();
  void kick(double seconds);
  void drift(double seconds);
  void solve_island(const std::vector<std::uint32_t>& members, double seconds);

  const Shape* level_;
  SpringLaw law_;
  Eigen::Vector3d gravity_;
  std::vector<Contact> contacts_;
  Touching touching_;
  std::uint64_t toggles_ = 0;
  std::uint64_t edge_contacts_ = 0;
};

}  // namespace boxtree::stiff
