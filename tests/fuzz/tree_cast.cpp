// SPDX-License-Identifier: MIT
// Casts of spheres, capsules, boxes and hulls against the tree of any file.
#include "tests/fuzz/answers.h"
#include "tests/fuzz/shape_input.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {
namespace {

template <class Shape>
void cast(const Tree& tree, const Shape& shape, const QueryInput& query, const Check& check) {
  Motion motion{query.vector(3)};
  if (query.option(1) % 2 == 1) motion.t_max = query.number(6);
  const Filters filters(query);
  const FaceOptions options = face_options(query, filters);
  const auto closest = cast_closest(tree, shape, motion, options);
  const auto any = cast_any(tree, shape, motion, options);
  check(closest);
  check(any);
  const std::uint32_t most = query.option(3) == 0 ? ~0u : query.option(3);
  std::uint32_t touches = 0;
  const auto visit = cast_all(
      tree, shape, motion,
      [&](const CastHit& hit) {
        check_hit(hit, query, check);
        return ++touches < most ? motion.t_max : -1;
      },
      options);
  check(visit);
  for (const auto& hit : {closest, any}) {
    if (!hit.has_value()) continue;
    check_hit(*hit, query, check);
    read_face(tree, hit->face, hit->triangle, check);
  }
  // Nothing is missed: all know whether there is a touch.
  if (!closest.ok() || !any.ok() || !visit.ok()) return;
  if (closest.has_value() != any.has_value() || closest.has_value() != (touches > 0)) {
    finding("cast_closest, cast_any and cast_all differ");
  }
}

}  // namespace

void run(Bytes input) {
  query_tree(input, [](const Tree& tree, const QueryInput& query, const auto& check) {
    read_any_face(tree, any_face(query), query, check);
    static_cast<void>(tree.user_data(any_face(query)));
    with_shape(query, [&](const auto& shape) { cast(tree, shape, query, check); });
  });
}

}  // namespace boxtree::fuzz
