// SPDX-License-Identifier: MIT
// Rays and segments against the tree of any file: the closest hit, any, all, the nearest, and those
// of batches.
#include <array>

#include "tests/fuzz/answers.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {
namespace {

void hit_all(const Tree& tree, const Ray& ray, const QueryInput& query, const Check& check) {
  const Filters filters(query);
  const FaceOptions options = face_options(query, filters);
  const auto closest = closest_hit(tree, ray, options);
  const auto any = any_hit(tree, ray, options);
  std::uint32_t hits = 0;
  const auto visit = all_hits(
      tree, ray,
      [&](const RayHit& hit) {
        check_hit(hit, check);
        ++hits;
        return ray.t_max;
      },
      options);
  std::array<RayHit, 4> nearest;
  const auto count =
      nearest_hits(tree, ray, std::span(nearest).first(1 + query.option(2) % 4u), options);
  check(closest);
  check(any);
  check(visit);
  check(count);
  if (!closest.ok() || !any.ok() || !visit.ok() || !count.ok()) return;
  if (closest.has_value() != any.has_value() || closest.has_value() != (hits > 0) ||
      closest.has_value() != (*count > 0)) {
    finding("closest_hit, any_hit, all_hits and nearest_hits differ");
  }
  if (*count > 0 && nearest[0].t != closest->t) finding("the nearest hit is not the closest");
}

// The ray among others that go the same way.
// `options`: QueryLimits or FaceOptions.
template <class Options>
void hit_many(const Tree& tree, const Ray& ray, const QueryInput& query, const Options& options,
              const Check& check) {
  std::array<Ray, 20> rays;
  rays.fill(ray);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    rays[i].origin[static_cast<Eigen::Index>(i % 3)] +=
        static_cast<double>(i / 3) * query.number(8);
  }
  std::array<RayResult, 20> results;
  const auto first = std::span(rays).first(1 + query.option(3) % rays.size());
  const auto some = std::span(results).first(first.size());
  for (const bool any : {false, true}) {
    const Status cast =
        any ? any_hits(tree, first, some, options) : closest_hits(tree, first, some, options);
    if (!cast.ok()) finding("a batch with as many results as rays was refused");
    for (std::size_t i = 0; i < some.size(); ++i) {
      check(some[i]);
      if (some[i]) check_hit(*some[i], check);
      const RayResult alone =
          any ? any_hit(tree, rays[i], options) : closest_hit(tree, rays[i], options);
      check.holds(alone.code() == some[i].code() && alone.has_value() == some[i].has_value() &&
                      alone->t == some[i]->t && alone->face.index == some[i]->face.index &&
                      alone->triangle == some[i]->triangle,
                  "a ray of a batch is answered unlike the same ray alone");
    }
  }
}

}  // namespace

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    Ray ray{query.vector(0), query.vector(3)};
    if (query.option(1) % 2 == 1) ray.t_min = query.number(6);
    if (query.option(1) % 4 >= 2) ray.t_max = query.number(7);
    if (query.option(1) % 8 >= 4) return hit_all(tree, ray, query, check);
    if (query.option(1) % 16 >= 8) {
      const Filters filters(query);
      query.option(4) % 2 == 0 ? hit_many(tree, ray, query, query.limits(), check)
                               : hit_many(tree, ray, query, face_options(query, filters), check);
    }
    const auto closest = closest_hit(tree, ray, query.limits());
    const auto any = any_hit(tree, ray, query.limits());
    check(closest);
    check(any);
    if (closest.ok() && closest.has_value()) {
      check_hit(*closest, check);
      read_face(tree, closest->face, closest->triangle, check);
    }
    // Nothing is missed: both know whether there is a hit.
    if (closest.ok() && any.ok() && closest.has_value() != any.has_value()) {
      finding("closest_hit and any_hit differ");
    }
  });
}

}  // namespace boxtree::fuzz
