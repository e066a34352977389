// SPDX-License-Identifier: MIT
// What must hold of every answer about a shape or a ray, whatever the file and the query are, and
// what can be read of the face that it names.
#pragma once

#include <cmath>

#include <boxtree/boxtree.h>

#include "tests/fuzz/query_input.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

/// Every n-th face and instance may be hit, n of 1 to 4; back faces as the query says.
struct Filters {
  explicit Filters(const QueryInput& query) : every(1 + query.option(6) % 4u) {}
  bool operator()(const FaceRef& face) const { return face.index % every == 0; }
  bool operator()(const SceneFace& face) const { return face.face.index % every == 0; }
  bool operator()(std::uint32_t instance) const { return instance % every == 0; }

  std::uint32_t every;
};

/// Options of a query on a tree. `filters` outlives them.
inline FaceOptions face_options(const QueryInput& query, const Filters& filters) {
  FaceOptions options;
  options.back_faces = static_cast<BackFaces>(query.option(5) % 3);
  if (filters.every > 1) options.filter = filters;
  options.limits = query.limits();
  return options;
}

/// The same on a scene.
inline SceneFaceOptions scene_face_options(const QueryInput& query, const Filters& filters) {
  SceneFaceOptions options;
  options.back_faces = static_cast<BackFaces>(query.option(5) % 3);
  if (filters.every == 2 || filters.every == 4) options.filter = filters;
  if (filters.every > 2) options.instance_filter = filters;
  if (query.option(1) != 0) options.layers = query.option(1);
  options.limits = query.limits();
  return options;
}

/// Reads all that a tree knows of a face.
inline void read_face(const Tree& tree, const FaceRef& face, std::uint32_t half,
                      const Check& check) {
  const Result<Triangle> triangle = tree.triangle(face, half);
  if (triangle.code() == Errc::kInvalidQuery) finding("an answer names no triangle");
  check(triangle);
  check(active_edges(tree, face, half));
  static_cast<void>(tree.material_name(tree.material(face)));
  static_cast<void>(tree.user_data(face));
}

/// The same of a scene.
inline void read_face(const Scene& scene, const SceneFace& face, std::uint32_t half,
                      const Check& check) {
  const Result<InstanceInfo> info = scene.info(face.instance);
  check(info);
  if (!info) {
    if (info.code() == Errc::kInstanceIndex) finding("an answer names no instance");
    return;
  }
  check(scene.triangle(face, half));
  check(active_edges(scene, face, half));
  static_cast<void>(scene.material_name(scene.material(face)));
  static_cast<void>(scene.user_data(face.instance));
  read_face(scene.trees()[info->tree], face.face, half, check);
}

/// Reads the same of a face that an application makes up.
template <class Where, class Face>
void read_any_face(const Where& where, const Face& face, const QueryInput& query,
                   const Check& check) {
  const std::uint32_t half = query.option(8) % 4u;
  check(where.triangle(face, half));
  check(active_edges(where, face, half));
  static_cast<void>(where.material_name(where.material(face)));
}

/// A face by its index: one of the first, or of none.
inline FaceRef any_face(const QueryInput& query) {
  const std::uint32_t index = query.option(9);
  return {query.option(10), index < 250 ? index : ~0u - (255 - index)};
}

/// Of normals: zero where there is none.
inline bool is_unit_or_zero(const Eigen::Vector3d& vector) {
  return vector.isZero(0) || std::abs(vector.norm() - 1) < 1e-9;
}

/// What casts, and shapes where they are, promise of a touch.
template <class Touch>
void check_feature(const Touch& touch, const QueryInput& query, const Check& check) {
  check.holds(touch.point.allFinite(), "a touch at a point that is not finite");
  check.holds(touch.feature_index <= 2 && touch.triangle <= 1, "a touch of no feature");
  check.holds(is_unit_or_zero(touch.normal), "the normal of a touch is no unit vector");
  check.holds(is_unit_or_zero(touch.face_normal), "the face normal of a touch is no unit vector");
  check.holds(is_unit_or_zero(resolved_normal(touch, query.vector(3))),
              "a resolved normal is no unit vector");
}

inline void check_hit(const CastHit& hit, const QueryInput& query, const Check& check) {
  check.holds(0 <= hit.t_lower && hit.t_lower <= hit.t, "t_lower is not before t");
  check_feature(hit, query, check);
}

inline void check_contact(const Contact& contact, const QueryInput& query, const Check& check) {
  check.holds(contact.depth >= 0, "a contact with a negative depth");
  check_feature(contact, query, check);
}

inline void check_contact(const PairContact& contact, const Check& check) {
  check.holds(contact.depth >= 0, "a pair contact with a negative depth");
  check.holds(contact.point.allFinite() && contact.start.allFinite() && contact.end.allFinite(),
              "a pair contact at a point that is not finite");
  check.holds(contact.first_triangle <= 1 && contact.second_triangle <= 1, "a contact of no half");
  check.holds(is_unit_or_zero(contact.normal), "the normal of a pair contact is no unit vector");
}

inline void check_hit(const RayHit& hit, const Check& check) {
  check.holds(hit.t >= 0, "a hit before the ray");
  check.holds(hit.point.allFinite(), "a hit at a point that is not finite");
  check.holds(is_unit_or_zero(hit.normal), "the normal of a hit is no unit vector");
}

}  // namespace boxtree::fuzz
