// SPDX-License-Identifier: MIT
// Values of the C interface to those of the C++ one and back. Structs that carry a size are read
// before; what comes here has all members.
#pragma once

#include <boxtree_c.h>

#include <boxtree/boxtree.h>

namespace boxtree::c {

inline Eigen::Vector3d to_cpp(const bxt_vec3& v) {
  return {v.x, v.y, v.z};
}
inline bxt_vec3 to_c(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

inline Eigen::Quaternion<double, Eigen::DontAlign> to_cpp(const bxt_quaternion& q) {
  return {q.w, q.x, q.y, q.z};
}

/// nullptr: the identity.
inline Pose to_cpp(const bxt_pose* given) {
  Pose pose = Pose::Identity();
  if (given == nullptr) return pose;
  pose.linear().col(0) = to_cpp(given->x_axis);
  pose.linear().col(1) = to_cpp(given->y_axis);
  pose.linear().col(2) = to_cpp(given->z_axis);
  pose.translation() = to_cpp(given->position);
  return pose;
}
inline bxt_pose to_c(const Pose& pose) {
  return {to_c(pose.linear().col(0)), to_c(pose.linear().col(1)), to_c(pose.linear().col(2)),
          to_c(pose.translation())};
}

inline Ray to_cpp(const bxt_ray& ray) {
  return {to_cpp(ray.origin), to_cpp(ray.direction), ray.t_min, ray.t_max};
}

inline bxt_triangle to_c(const Triangle& triangle) {
  return {{to_c(triangle.corner[0]), to_c(triangle.corner[1]), to_c(triangle.corner[2])}};
}

inline bxt_face to_c(const FaceRef& face, std::uint32_t instance = BXT_NO_INSTANCE) {
  return {face.id, face.index, instance};
}
inline FaceRef face_ref(const bxt_face& face) {
  return {face.id, face.index};
}

#if BOXTREE_HAS_SCENE_QUERIES
inline bxt_face to_c(const SceneFace& face) {
  return to_c(face.face, face.instance);
}
inline SceneFace scene_face(const bxt_face& face) {
  return {face.instance, face_ref(face)};
}
#endif

/// The instance of an answer: that of scenes has one.
template <class Answer>
std::uint32_t instance_of(const Answer& answer) {
  if constexpr (requires { answer.instance; }) {
    return answer.instance;
  } else {
    return BXT_NO_INSTANCE;
  }
}

}  // namespace boxtree::c
