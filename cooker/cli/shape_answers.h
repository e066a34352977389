// SPDX-License-Identifier: MIT
// The JSON of answers to rays, casts and contacts of shapes: those of a tree and those of a scene
// differ in what names a face.
#pragma once

#include <array>
#include <compare>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "cooker/cli/query_request.h"

namespace boxtree::cooker {

[[nodiscard]] inline const char* name_of(Feature feature) {
  switch (feature) {
    case Feature::kFace:
      return "face";
    case Feature::kEdge:
      return "edge";
    case Feature::kVertex:
      return "vertex";
  }
  return "";
}

/// Where a hit stands in a list: by the number, then by what was hit.
struct HitPlace {
  double number;
  std::array<std::uint32_t, 4> what;
  std::size_t index;  // in the list that is not in order yet

  auto operator<=>(const HitPlace&) const = default;
};
void sort_places(std::vector<HitPlace>& places);

/// Of a Kinds::Body, a Tree or a Scene, which answers by OfRay, OfCast and OfShape and takes
/// Options. Kinds::add_face(body, hit, json) adds what was hit, Kinds::tree_of(body, hit) is the
/// tree that it is of; Kinds::rank(body, hit) orders hits at the same place, and
/// Kinds::collide(body, shape, visitor, options) finds the contacts of a shape.
template <class Kinds>
class ShapeAnswers {
 public:
  /// `options`: what a request does not say.
  explicit ShapeAnswers(const typename Kinds::Body& body,
                        const typename Kinds::Options& options = {})
      : body_(body), options_(options) {}

  Result<Json> answer(const RayRequest& request) const {
    const auto options = options_of(request);
    const auto add = [&](const OfRay& hit, Json& json) { Kinds::add_face(body_, hit, json); };
    if (!request.all) {
      return answer_hit(request.any ? any_hit(body_, request.ray, options)
                                    : closest_hit(body_, request.ray, options),
                        add);
    }
    std::vector<OfRay> hits;
    const auto keep = [&](const OfRay& hit) {
      hits.push_back(hit);
      return request.ray.t_max;
    };
    const Result<Visit> visit = all_hits(body_, request.ray, keep, options);
    if (!visit) return visit.error();
    return list(
        "hits", hits, [](const OfRay& hit) { return hit.t; },
        [&](Json& json, const OfRay& hit) { add_hit(json, hit, add); });
  }

  Result<Json> answer(const CastRequest& request) const {
    return with_shape(request.shape, request.at,
                      [&](const auto& shape) { return answer_cast(shape, request); });
  }

  Result<Json> answer(const CollideRequest& request) const {
    if (request.merges && !(request.merge >= 0)) return Error{Errc::kInvalidQuery, "merge"};
    return with_shape(request.shape, request.at,
                      [&](const auto& shape) { return answer_contacts(shape, request); });
  }

 private:
  using OfRay = typename Kinds::OfRay;
  using OfCast = typename Kinds::OfCast;
  using OfShape = typename Kinds::OfShape;

  template <class Request>
  typename Kinds::Options options_of(const Request& request) const {
    typename Kinds::Options options = options_;
    options.back_faces = request.back_faces;
    return options;
  }

  // Calls answer(shape) with the shape that is given, where it is.
  template <class Answer>
  static Result<Json> with_shape(const CastShape& shape, const Eigen::Vector3d& at,
                                 const Answer& answer) {
    const auto& [sphere, capsule, box, hull, rotation] = shape;
    if (sphere) return answer(Sphere{at, *sphere});
    if (capsule) {
      const auto& [x, y, z, radius] = *capsule;
      return answer(Capsule{at, at + Eigen::Vector3d(x, y, z), radius});
    }
    if (hull) {
      const Result<std::vector<Eigen::Vector3d>> points = hull_points(*hull);
      if (!points) return points.error();
      ConvexHull of_mesh;
      of_mesh.points = *points;
      of_mesh.position = at;
      if (rotation) of_mesh.rotation.coeffs() = Eigen::Map<const Eigen::Vector4d>(rotation->data());
      return answer(of_mesh);
    }
    OrientedBox placed;
    placed.center = at;
    placed.half_extents = Eigen::Vector3d(box->data());
    if (rotation) placed.rotation.coeffs() = Eigen::Map<const Eigen::Vector4d>(rotation->data());
    return answer(placed);
  }

  template <class Shape>
  Result<Json> answer_cast(const Shape& shape, const CastRequest& request) const {
    const auto options = options_of(request);
    if (request.all) {
      std::vector<OfCast> hits;
      const auto keep = [&](const OfCast& hit) {
        hits.push_back(hit);
        return request.motion.t_max;
      };
      const Result<Visit> visit = cast_all(body_, shape, request.motion, keep, options);
      if (!visit) return visit.error();
      return list(
          "hits", hits, [](const OfCast& hit) { return hit.t_lower; },
          [&](Json& json, const OfCast& hit) { add_touch(json, hit); });
    }
    const auto hit = request.any ? cast_any(body_, shape, request.motion, options)
                                 : cast_closest(body_, shape, request.motion, options);
    if (!hit.ok()) return hit.error();
    Json json = {{"hit", hit.has_value()}};
    if (hit) add_touch(json, *hit);
    return json;
  }

  template <class Shape>
  Result<Json> answer_contacts(const Shape& shape, const CollideRequest& request) const {
    std::vector<OfShape> contacts;
    const auto keep = [&](const OfShape& contact) {
      contacts.push_back(contact);
      return true;
    };
    const Result<Visit> visit = Kinds::collide(body_, shape, keep, options_);
    if (!visit) return visit.error();
    sort(contacts, [](const OfShape&) { return 0.0; });
    if (request.merges) contacts.resize(merge_contacts(contacts, request.merge));
    Json json = Json::array();
    for (const OfShape& contact : contacts) {
      Json& item = json.emplace_back();
      Kinds::add_face(body_, contact, item);
      item["triangle"] = contact.triangle;
      item["point"] = to_json(contact.point);
      item["normal"] = to_json(contact.normal);
      item["depth"] = contact.depth;
      add_feature(item, contact);
    }
    return Json{{"count", json.size()}, {"contacts", json}};
  }

  void add_touch(Json& json, const OfCast& hit) const {
    json["t"] = hit.t;
    json["t_lower"] = hit.t_lower;
    Kinds::add_face(body_, hit, json);
    json["triangle"] = hit.triangle;
    json["point"] = to_json(hit.point);
    json["normal"] = to_json(hit.normal);
    add_feature(json, hit);
    json["initially_touching"] = hit.initially_touching;
  }

  // And, where the cook has kept which edges are active, what resolved_normal() takes.
  template <class Hit>
  void add_feature(Json& json, const Hit& hit) const {
    json["feature"] = name_of(hit.feature);
    if (!Kinds::tree_of(body_, hit).has_active_edges()) return;
    json["is_active"] = hit.is_active;
    json["face_normal"] = to_json(hit.face_normal);
  }

  // By first(hit), then by what was hit.
  template <class Hit, class First>
  void sort(std::vector<Hit>& hits, const First& first) const {
    std::vector<HitPlace> places;
    for (const Hit& hit : hits) {
      places.push_back({first(hit), Kinds::rank(body_, hit), places.size()});
    }
    sort_places(places);
    std::vector<Hit> sorted;
    for (const HitPlace& place : places) sorted.push_back(hits[place.index]);
    hits = std::move(sorted);
  }

  template <class Hit, class First, class Add>
  Result<Json> list(const char* key, std::vector<Hit>& hits, const First& first,
                    const Add& add) const {
    sort(hits, first);
    Json json = Json::array();
    for (const Hit& hit : hits) add(json.emplace_back(), hit);
    return Json{{"count", json.size()}, {key, json}};
  }

  const typename Kinds::Body& body_;
  const typename Kinds::Options options_;
};

}  // namespace boxtree::cooker
