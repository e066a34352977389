// SPDX-License-Identifier: MIT
// Trees and scenes that are open twice, by the C++ interface and by the C interface, and answers of
// both as numbers that can be compared to the bit.
#pragma once

#include <algorithm>
#include <bit>
#include <boxtree_c.h>
#include <cstdint>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

namespace boxtree::test {

/// Gives handles back.
struct Release {
  void operator()(bxt_file* file) const { bxt_file_close(file); }
  void operator()(bxt_tree* tree) const { bxt_tree_release(tree); }
  void operator()(bxt_scene* scene) const { bxt_scene_release(scene); }
};
using CFile = std::unique_ptr<bxt_file, Release>;
using CTree = std::unique_ptr<bxt_tree, Release>;
using CScene = std::unique_ptr<bxt_scene, Release>;

/// Opens bytes, binds; a failure throws.
[[nodiscard]] CFile open_c(const std::vector<std::byte>& bytes);
[[nodiscard]] CTree bind_c(const CFile& file, std::uint32_t number = BXT_ONLY_TREE,
                           const bxt_tree_options* options = nullptr);
[[nodiscard]] CScene bind_scene_c(const CFile& file);

/// Arrays of the application's, for C.
[[nodiscard]] bxt_mesh mesh_of(const MeshArrays& arrays);

/// The numbers of one answer.
class Numbers : public std::vector<std::uint64_t> {
 public:
  Numbers& operator<<(double number) { return *this << std::bit_cast<std::uint64_t>(number); }
  Numbers& operator<<(std::uint64_t number) {
    push_back(number);
    return *this;
  }
  Numbers& operator<<(std::uint32_t number) { return *this << std::uint64_t{number}; }
  Numbers& operator<<(bool flag) { return *this << std::uint64_t{flag}; }
  Numbers& operator<<(const Eigen::Vector3d& v) { return *this << v.x() << v.y() << v.z(); }
  Numbers& operator<<(const bxt_vec3& v) { return *this << v.x << v.y << v.z; }
  Numbers& operator<<(const FaceRef& face) { return *this << face.id << face.index; }
  Numbers& operator<<(const bxt_face& face) {
    return *this << face.id << face.index << face.instance;
  }
};

/// The instance of an answer of C++: none of a tree.
template <class Answer>
std::uint32_t instance_of(const Answer& answer) {
  if constexpr (requires { answer.instance; }) return answer.instance;
  return BXT_NO_INSTANCE;
}

/// The same numbers of an answer by either interface.
[[nodiscard]] inline Numbers numbers_of(const FaceRef& face) {
  return Numbers() << face << std::uint32_t{BXT_NO_INSTANCE};
}
[[nodiscard]] inline Numbers numbers_of(const SceneFace& face) {
  return Numbers() << face.face << face.instance;
}
[[nodiscard]] inline Numbers numbers_of(const bxt_face& face) {
  return Numbers() << face;
}
[[nodiscard]] inline Numbers numbers_of(const Triangle& triangle) {
  return Numbers() << triangle.corner[0] << triangle.corner[1] << triangle.corner[2];
}
[[nodiscard]] inline Numbers numbers_of(const bxt_triangle& triangle) {
  return Numbers() << triangle.corner[0] << triangle.corner[1] << triangle.corner[2];
}
template <class Hit>
requires std::is_base_of_v<RayHit, Hit>
[[nodiscard]] Numbers numbers_of(const Hit& hit, bool is_hit = true) {
  return Numbers() << is_hit << hit.t << hit.face << instance_of(hit) << hit.triangle << hit.u
                   << hit.v << hit.point << hit.normal;
}
[[nodiscard]] inline Numbers numbers_of(const bxt_ray_hit& hit) {
  return Numbers() << hit.is_hit << hit.t << hit.face << hit.triangle << hit.u << hit.v << hit.point
                   << hit.normal;
}

/// What a query answered: all that it found, its error, and the words of it.
struct Answer {
  std::vector<Numbers> found;
  std::int32_t status = 0;
  std::string message;

  bool operator==(const Answer&) const = default;
};
void PrintTo(const Answer& answer, std::ostream* stream);

/// The error of the C++ interface, if there is one.
template <class Outcome>
void note_error(const Outcome& outcome, Answer& answer) {
  answer.status = static_cast<std::int32_t>(outcome.code());
  if (outcome.code() != Errc::kOk) answer.message = outcome.error().message();
}

/// What `call(error, found)` answers, a function of the C interface.
template <class Call>
[[nodiscard]] Answer answer_of_c(const Call& call) {
  bxt_error error = {};
  error.struct_size = sizeof error;
  error.status = -1;
  Answer answer;
  answer.status = call(&error, answer.found);
  if (answer.status == BXT_OK) {
    EXPECT_EQ(error.status, -1) << "what succeeds leaves the error alone";
    return answer;
  }
  EXPECT_EQ(error.status, answer.status);
  answer.message = error.message;
  EXPECT_EQ(error.message_length, answer.message.size());
  Answer without_error;
  EXPECT_EQ(call(nullptr, without_error.found), answer.status);
  EXPECT_EQ(without_error.found, answer.found);
  return answer;
}

/// A visitor of the C interface that keeps what it is told in a std::vector<Numbers>.
template <class Told>
bool keep(void* context, const Told* told) {
  static_cast<std::vector<Numbers>*>(context)->push_back(numbers_of(*told));
  return true;
}
/// The same, that stops after three.
template <class Told>
bool keep_three(void* context, const Told* told) {
  keep(context, told);
  return static_cast<std::vector<Numbers>*>(context)->size() < 3;
}

/// Calls `body(Tree, const bxt_tree*)` for trees of triangles and quads in each encoding that the C
/// library binds, with and without materials, user data, active edges, in arrays of the
/// application's, and without copies of faces.
void for_each_tree(const std::function<void(const Tree&, const bxt_tree*)>& body);

/// Calls `body(Scene, const bxt_scene*)` for scenes of a file and of several, in which instances
/// have moved and are disabled.
void for_each_scene(const std::function<void(const Scene&, const bxt_scene*)>& body);

/// Both, for generic lambdas.
template <class Body>
void for_each_subject(const Body& body) {
  for_each_tree([&](const Tree& tree, const bxt_tree* c) { body(tree, c); });
  for_each_scene([&](const Scene& scene, const bxt_scene* c) { body(scene, c); });
}

/// Random points and directions in and around a subject.
class Randoms {
 public:
  explicit Randoms(const Tree& tree) : box_(tree.bounds()) {}
  explicit Randoms(const Scene&) : box_(Eigen::Vector3d(-5, -5, -5), Eigen::Vector3d(5, 5, 5)) {}

  [[nodiscard]] double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  [[nodiscard]] Eigen::Vector3d point(double part = 1) {
    const Eigen::Vector3d way{unit(), unit(), unit()};
    return box_.center() + part * way.cwiseProduct(box_.sizes() / 2);
  }
  [[nodiscard]] double size() const { return box_.sizes().norm(); }
  [[nodiscard]] Ray ray() {
    const Eigen::Vector3d from = point(1.5);
    return {from, point(0.8) - from};
  }
  [[nodiscard]] Pose pose() {
    Pose pose = Pose::Identity();
    const Eigen::Quaterniond turn{1 + unit() / 2, unit(), unit(), unit()};
    pose.linear() = turn.normalized().toRotationMatrix() * (1 + unit() / 2);
    pose.translation() = 0.5 * (point() - box_.center());
    return pose;
  }

 private:
  Eigen::AlignedBox3d box_;
  std::mt19937_64 random_{7};
};

[[nodiscard]] inline bxt_vec3 vec3(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
[[nodiscard]] inline bxt_ray ray_of(const Ray& ray) {
  return {vec3(ray.origin), vec3(ray.direction), ray.t_min, ray.t_max};
}
[[nodiscard]] inline bxt_pose pose_of(const Pose& pose) {
  return {vec3(pose.linear().col(0)), vec3(pose.linear().col(1)), vec3(pose.linear().col(2)),
          vec3(pose.translation())};
}

}  // namespace boxtree::test
