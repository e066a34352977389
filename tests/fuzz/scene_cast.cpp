// SPDX-License-Identifier: MIT
// Casts and contacts of spheres, capsules, boxes and hulls in the scene of any file, and all hits
// of rays.
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

template <class Shape, class Check>
void cast(const Scene& scene, const Shape& shape, const QueryInput& query, const Check& check) {
  SceneFaceOptions options;
  options.limits = query.limits();
  if (query.option(1) != 0) options.layers = query.option(1);
  options.back_faces = static_cast<BackFaces>(query.option(5) % 3);
  const std::uint32_t most = query.option(3) == 0 ? ~0u : query.option(3);
  std::uint32_t touches = 0;
  if (query.option(6) % 3 == 0) {
    const auto visit = collide(
        scene, shape, [&](const SceneContact&) { return ++touches < most; }, options.layers,
        query.limits());
    return check(visit);
  }
  const auto count = [&](const auto&) { return ++touches < most ? 0x1p1000 : -1.0; };
  if (query.option(6) % 3 == 1) {
    const Ray ray{query.vector(0), query.vector(3)};
    const auto closest = closest_hit(scene, ray, options);
    const auto any = any_hit(scene, ray, options);
    const auto visit = all_hits(scene, ray, count, options);
    check(closest);
    check(any);
    check(visit);
    return compare(closest, any, visit, touches);
  }
  const Motion motion{query.vector(3)};
  const auto closest = cast_closest(scene, shape, motion, options);
  const auto any = cast_any(scene, shape, motion, options);
  const auto visit = cast_all(scene, shape, motion, count, options);
  check(closest);
  check(any);
  check(visit);
  compare(closest, any, visit, touches);
}

}  // namespace

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const QueryInput& query, const auto& check) {
    with_shape(query, [&](const auto& shape) { cast(scene, shape, query, check); });
  });
}

}  // namespace boxtree::fuzz
