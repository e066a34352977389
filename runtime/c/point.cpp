// SPDX-License-Identifier: MIT
// Closest points, in C.
#include <boxtree_c.h>
#include <type_traits>

#include <boxtree/boxtree.h>

#include "runtime/c/batch.h"
#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/options.h"

using namespace boxtree;
using namespace boxtree::c;

namespace {

bxt_closest_point answer_of(const ClosestPoint& point, bool is_found, std::uint32_t instance) {
  return {.is_found = is_found,
          .converged = true,
          .point = to_c(point.point),
          .distance = point.distance,
          .face = to_c(point.face, instance),
          .triangle = point.triangle,
          .lower = point.distance,
          .upper = point.distance};
}

template <class Handle>
bxt_status nearest_point(const Handle* subject, const bxt_vec3* point, double max_distance,
                         const bxt_limits* limits, bxt_closest_point* answer, bxt_error* error) {
  if (const char* name = first_null("tree or scene", subject, "point", point, "answer", answer)) {
    return refuse_null(error, name);
  }
  if (!has_size(answer)) return refuse(error, "answer: struct_size");
  return guarded(error, [&] {
    return with_limits<Handle>(limits, error, [&](auto... read) {
      const auto found = closest_point(subject->inside, to_cpp(*point), max_distance, read...);
      if (found.ok())
        write_struct(answer, answer_of(*found, found.has_value(), instance_of(*found)));
      return finish(found, error);
    });
  });
}

template <class Handle>
bxt_status nearest_points(const Handle* subject, const bxt_vec3* points, std::size_t count,
                          double max_distance, const bxt_limits* limits, bxt_closest_point* answers,
                          bxt_status* statuses, bxt_error* error) {
  if (subject == nullptr) return refuse_null(error, "tree or scene");
  if (count == 0) return BXT_OK;
  if (const char* name = first_null("points", points, "answers", answers)) {
    return refuse_null(error, name);
  }
  if (!has_size(answers)) return refuse(error, "answers: struct_size");
  return guarded(error, [&] {
    return with_limits<Handle>(limits, error, [&](auto... read) {
      BatchAnswers<bxt_closest_point> written(answers, statuses, error);
      const auto write = [&](std::size_t i, const auto& found) {
        written.write(i, answer_of(*found, found.has_value(), instance_of(*found)), found);
      };
      if constexpr (std::is_same_v<Handle, bxt_tree>) {
        answer_in_chunks<PointResult>(
            count, [&](std::size_t i) { return to_cpp(points[i]); },
            [&](std::size_t, auto chunk, auto results) {
              return closest_points(subject->inside, chunk, results, max_distance, read...);
            },
            write);
      } else {
        // A scene answers points one by one, be there a batch or not.
        for (std::size_t i = 0; i < count; ++i)
          write(i, closest_point(subject->inside, to_cpp(points[i]), max_distance, read...));
      }
      return written.first_error();
    });
  });
}

}  // namespace

bxt_status bxt_tree_closest_point(const bxt_tree* tree, const bxt_vec3* point, double max_distance,
                                  const bxt_limits* limits, bxt_closest_point* answer,
                                  bxt_error* error) {
  return nearest_point(tree, point, max_distance, limits, answer, error);
}

bxt_status bxt_tree_closest_points(const bxt_tree* tree, const bxt_vec3* points, size_t count,
                                   double max_distance, const bxt_limits* limits,
                                   bxt_closest_point* answers, bxt_status* statuses,
                                   bxt_error* error) {
  return nearest_points(tree, points, count, max_distance, limits, answers, statuses, error);
}

bxt_status bxt_tree_closest_point_within(const bxt_tree* tree, const bxt_vec3* point,
                                         const bxt_approximation* options,
                                         bxt_closest_point* answer, bxt_error* error) {
  if (const char* name = first_null("tree", tree, "point", point, "answer", answer))
    return refuse_null(error, name);
  if (!has_size(answer)) return refuse(error, "answer: struct_size");
  return guarded(error, [&] {
    return with_approximation(options, error, [&](const PointOptions& read) {
      const Result<ApproximatePoint> found = closest_point(tree->inside, to_cpp(*point), read);
      if (found) {
        bxt_closest_point said = answer_of(found->witness.value_or(ClosestPoint{}),
                                           found->witness.has_value(), BXT_NO_INSTANCE);
        said.converged = found->converged;
        said.lower = found->lower;
        said.upper = found->upper;
        said.nodes_expanded = found->nodes_expanded;
        write_struct(answer, said);
      }
      return finish(found, error);
    });
  });
}

bxt_status bxt_scene_closest_point(const bxt_scene* scene, const bxt_vec3* point,
                                   double max_distance, const bxt_limits* limits,
                                   bxt_closest_point* answer, bxt_error* error) {
  return nearest_point(scene, point, max_distance, limits, answer, error);
}

bxt_status bxt_scene_closest_points(const bxt_scene* scene, const bxt_vec3* points, size_t count,
                                    double max_distance, const bxt_limits* limits,
                                    bxt_closest_point* answers, bxt_status* statuses,
                                    bxt_error* error) {
  return nearest_points(scene, points, count, max_distance, limits, answers, statuses, error);
}
