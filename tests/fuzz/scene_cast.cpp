// SPDX-License-Identifier: MIT
// Casts and contacts of spheres, capsules, boxes and hulls in the scene of any file, and all hits
// of rays.
#include <array>

#include "tests/fuzz/answers.h"
#include "tests/fuzz/shape_input.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {
namespace {

// Nothing is missed: all know whether there is a touch.
template <class Closest, class Any>
void compare(const Closest& closest, const Any& any, const Result<Visit>& visit,
             std::uint32_t touches) {
  if (!closest.ok() || !any.ok() || !visit.ok()) return;
  if (closest.has_value() != any.has_value() || closest.has_value() != (touches > 0)) {
    finding("the closest, any and all differ");
  }
}

template <class Shape>
void touch(const Scene& scene, const Shape& shape, const SceneFaceOptions& options,
           const QueryInput& query, const Check& check) {
  const std::uint32_t most = query.option(3) == 0 ? ~0u : query.option(3);
  std::uint32_t touches = 0;
  const auto visit = collide(
      scene, shape,
      [&](const SceneContact& contact) {
        check_contact(contact, query, check);
        if (++touches == 1) {
          read_face(scene, {contact.instance, contact.face}, contact.triangle, check);
        }
        return touches < most;
      },
      options.layers, options.limits);
  check(visit);
  std::uint32_t faces = 0;
  const auto count = [&](const SceneFace&) { return ++faces < most; };
  const auto overlapped = overlap(scene, shape, count, options.layers, options.limits);
  check(overlapped);
  // The same predicates decide, but for spheres.
  if (visit.ok() && overlapped.ok() && !std::is_same_v<Shape, Sphere> &&
      (touches > 0) != (faces > 0)) {
    finding("collide and overlap differ");
  }
}

void hit(const Scene& scene, const Ray& ray, const SceneFaceOptions& options,
         const QueryInput& query, const Check& check) {
  const std::uint32_t most = query.option(3) == 0 ? ~0u : query.option(3);
  std::uint32_t hits = 0;
  const auto count = [&](const SceneRayHit& hit) {
    check_hit(hit, check);
    return ++hits < most ? 0x1p1000 : -1.0;
  };
  const auto closest = closest_hit(scene, ray, options);
  const auto any = any_hit(scene, ray, options);
  const auto visit = all_hits(scene, ray, count, options);
  std::array<SceneRayHit, 3> nearest;
  const auto nearest_count = nearest_hits(scene, ray, nearest, options);
  check(closest);
  check(any);
  check(visit);
  check(nearest_count);
  if (closest.has_value()) {
    read_face(scene, {closest->instance, closest->face}, closest->triangle, check);
  }
  compare(closest, any, visit, hits);
  if (closest.ok() && nearest_count.ok() && closest.has_value() != (*nearest_count > 0)) {
    finding("closest_hit and nearest_hits differ");
  }
}

template <class Shape>
void cast(const Scene& scene, const Shape& shape, const SceneFaceOptions& options,
          const QueryInput& query, const Check& check) {
  const std::uint32_t most = query.option(3) == 0 ? ~0u : query.option(3);
  std::uint32_t touches = 0;
  const auto count = [&](const SceneCastHit& hit) {
    check_hit(hit, query, check);
    return ++touches < most ? 0x1p1000 : -1.0;
  };
  const Motion motion{query.vector(3)};
  const auto closest = cast_closest(scene, shape, motion, options);
  const auto any = cast_any(scene, shape, motion, options);
  const auto visit = cast_all(scene, shape, motion, count, options);
  check(closest);
  check(any);
  check(visit);
  if (closest.has_value()) {
    check_hit(*closest, query, check);
    read_face(scene, {closest->instance, closest->face}, closest->triangle, check);
  }
  compare(closest, any, visit, touches);
}

}  // namespace

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const QueryInput& query, const auto& check) {
    read_any_face(scene, SceneFace{query.option(10), any_face(query)}, query, check);
    const Filters filters(query);
    const SceneFaceOptions options = scene_face_options(query, filters);
    const unsigned kind = query.option(8) % 3;
    if (kind == 1) return hit(scene, {query.vector(0), query.vector(3)}, options, query, check);
    with_shape(query, [&](const auto& shape) {
      kind == 0 ? touch(scene, shape, options, query, check)
                : cast(scene, shape, options, query, check);
    });
  });
}

}  // namespace boxtree::fuzz
