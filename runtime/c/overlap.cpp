// SPDX-License-Identifier: MIT
// What touches boxes, shapes and frustums, in C.
#include <array>
#include <boxtree_c.h>
#include <cstddef>

#include <boxtree/boxtree.h>

#include "runtime/c/batch.h"
#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/options.h"
#include "runtime/c/shape.h"

using namespace boxtree;
using namespace boxtree::c;

namespace {

Eigen::AlignedBox3d box_of(const bxt_vec3& min, const bxt_vec3& max) {
  return {to_cpp(min), to_cpp(max)};
}

// Calls `query(visit, limits...)`, the query of a tree or of a scene with what visits its faces.
template <class Handle, class Query>
bxt_status visit_faces(bxt_face_visitor visitor, void* context, const bxt_limits* limits,
                       bxt_error* error, Query query) {
  if (visitor == nullptr) return refuse_null(error, "visitor");
  return guarded(error, [&] {
    return with_limits<Handle>(limits, error, [&](auto... read) {
      const auto visit = [&](const auto& face) {
        const bxt_face shown = to_c(face);
        return visitor(context, &shown);
      };
      return finish(query(visit, read...), error);
    });
  });
}

template <class Handle>
bxt_status visit_in_box(const Handle* subject, const bxt_vec3* min, const bxt_vec3* max,
                        bxt_face_visitor visitor, void* context, const bxt_limits* limits,
                        bxt_error* error) {
  if (const char* name = first_null("tree or scene", subject, "min", min, "max", max))
    return refuse_null(error, name);
  return visit_faces<Handle>(visitor, context, limits, error, [&](auto visit, auto... read) {
    return overlap_box(subject->inside, box_of(*min, *max), visit, read...);
  });
}

// Calls overlap_all(tree or scene, shapes, results, visitor, limits...) with shapes some at a time.
template <class Handle, class ShapeAt, class OverlapAll>
bxt_status visit_batch(const Handle* subject, std::size_t count, const ShapeAt& shape_at,
                       bxt_batch_face_visitor visitor, void* context, const bxt_limits* limits,
                       bxt_status* statuses, bxt_error* error, const OverlapAll& overlap_all) {
  if (visitor == nullptr) return refuse_null(error, "visitor");
  return guarded(error, [&] {
    return with_limits<Handle>(limits, error, [&](auto... read) {
      BatchStatuses written(statuses, error);
      answer_in_chunks<VisitResult>(
          count, shape_at,
          [&](std::size_t begin, auto shapes, auto results) {
            const auto visit = [&](std::size_t i, const auto& face) {
              const bxt_face shown = to_c(face);
              return visitor(context, begin + i, &shown);
            };
            return overlap_all(subject->inside, shapes, results, visit, read...);
          },
          [&](std::size_t i, const VisitResult& end) { written.write(i, end); });
      return written.first_error();
    });
  });
}

template <class Handle>
bxt_status visit_in_boxes(const Handle* subject, const bxt_vec3* mins, const bxt_vec3* maxs,
                          std::size_t count, bxt_batch_face_visitor visitor, void* context,
                          const bxt_limits* limits, bxt_status* statuses, bxt_error* error) {
  if (subject == nullptr) return refuse_null(error, "tree or scene");
  if (const char* name = count == 0 ? nullptr : first_null("mins", mins, "maxs", maxs))
    return refuse_null(error, name);
  return visit_batch(
      subject, count, [&](std::size_t i) { return box_of(mins[i], maxs[i]); }, visitor, context,
      limits, statuses, error,
      [](const auto&... arguments) { return overlap_boxes(arguments...); });
}

template <class Handle>
bxt_status visit_in_spheres(const Handle* subject, const bxt_vec3* centers, const double* radii,
                            std::size_t count, bxt_batch_face_visitor visitor, void* context,
                            const bxt_limits* limits, bxt_status* statuses, bxt_error* error) {
  if (subject == nullptr) return refuse_null(error, "tree or scene");
  if (const char* name = count == 0 ? nullptr : first_null("centers", centers, "radii", radii))
    return refuse_null(error, name);
  return visit_batch(
      subject, count,
      [&](std::size_t i) {
        return Sphere{to_cpp(centers[i]), radii[i]};
      },
      visitor, context, limits, statuses, error,
      [](const auto&... arguments) { return overlap_spheres(arguments...); });
}

// The queries of all shapes under one name.
template <class Inside, class... Rest>
Result<Visit> overlap(const Inside& inside, const Sphere& sphere, Rest... rest) {
  return overlap_sphere(inside, sphere, rest...);
}
template <class Inside, class... Rest>
Result<Visit> overlap(const Inside& inside, const Capsule& capsule, Rest... rest) {
  return overlap_capsule(inside, capsule, rest...);
}
template <class Inside, class... Rest>
Result<Visit> overlap(const Inside& inside, const OrientedBox& box, Rest... rest) {
  return overlap_oriented_box(inside, box, rest...);
}
template <class Inside, class... Rest>
Result<Visit> overlap(const Inside& inside, const ConvexHull& hull, Rest... rest) {
  return overlap_convex_hull(inside, hull, rest...);
}

template <class Handle>
bxt_status visit_in_shape(const Handle* subject, const bxt_shape* shape, bxt_face_visitor visitor,
                          void* context, const bxt_limits* limits, bxt_error* error) {
  if (const char* name = first_null("tree or scene", subject, "shape", shape))
    return refuse_null(error, name);
  return with_shape(shape, error, [&](const auto& read_shape) {
    return visit_faces<Handle>(visitor, context, limits, error, [&](auto visit, auto... read) {
      return overlap(subject->inside, read_shape, visit, read...);
    });
  });
}

Frustum frustum_of(const bxt_plane planes[6]) {
  Frustum frustum;
  for (std::size_t i = 0; i < frustum.planes.size(); ++i) {
    const bxt_plane& plane = planes[i];
    frustum.planes[i] = {plane.normal.x, plane.normal.y, plane.normal.z, plane.offset};
  }
  return frustum;
}

void write_planes(const Frustum& frustum, bxt_plane planes[6]) {
  for (std::size_t i = 0; i < frustum.planes.size(); ++i) {
    const Frustum::Plane& plane = frustum.planes[i];
    planes[i] = {{plane.x(), plane.y(), plane.z()}, plane.w()};
  }
}

template <class Handle>
bxt_status visit_in_frustum(const Handle* subject, const bxt_plane planes[6],
                            bxt_face_visitor visitor, void* context, const bxt_limits* limits,
                            bxt_error* error) {
  if (const char* name = first_null("tree or scene", subject, "planes", planes))
    return refuse_null(error, name);
  return visit_faces<Handle>(visitor, context, limits, error, [&](auto visit, auto... read) {
    return overlap_frustum(subject->inside, frustum_of(planes), visit, read...);
  });
}

static_assert(BXT_OVERLAPPING == static_cast<int>(Overlap::kOverlapping) &&
              BXT_DISJOINT == static_cast<int>(Overlap::kDisjoint) &&
              BXT_UNDECIDED == static_cast<int>(Overlap::kUndecided) &&
              BXT_BUDGET_SPENT == static_cast<int>(Overlap::kBudgetSpent));

}  // namespace

bxt_status bxt_tree_overlap_box(const bxt_tree* tree, const bxt_vec3* min, const bxt_vec3* max,
                                bxt_face_visitor visitor, void* context, const bxt_limits* limits,
                                bxt_error* error) {
  return visit_in_box(tree, min, max, visitor, context, limits, error);
}

bxt_status bxt_tree_overlap_boxes(const bxt_tree* tree, const bxt_vec3* mins, const bxt_vec3* maxs,
                                  size_t count, bxt_batch_face_visitor visitor, void* context,
                                  const bxt_limits* limits, bxt_status* statuses,
                                  bxt_error* error) {
  return visit_in_boxes(tree, mins, maxs, count, visitor, context, limits, statuses, error);
}

bxt_status bxt_tree_overlap_spheres(const bxt_tree* tree, const bxt_vec3* centers,
                                    const double* radii, size_t count,
                                    bxt_batch_face_visitor visitor, void* context,
                                    const bxt_limits* limits, bxt_status* statuses,
                                    bxt_error* error) {
  return visit_in_spheres(tree, centers, radii, count, visitor, context, limits, statuses, error);
}

bxt_status bxt_tree_overlap(const bxt_tree* tree, const bxt_shape* shape, bxt_face_visitor visitor,
                            void* context, const bxt_limits* limits, bxt_error* error) {
  return visit_in_shape(tree, shape, visitor, context, limits, error);
}

bxt_status bxt_tree_overlap_frustum(const bxt_tree* tree, const bxt_plane planes[6],
                                    bxt_face_visitor visitor, void* context,
                                    const bxt_limits* limits, bxt_error* error) {
  return visit_in_frustum(tree, planes, visitor, context, limits, error);
}

bxt_status bxt_tree_overlap_box_within(const bxt_tree* tree, const bxt_vec3* min,
                                       const bxt_vec3* max, double distance, uint64_t node_budget,
                                       bxt_overlap_answer* answer, bxt_error* error) {
  if (const char* name = first_null("tree", tree, "min", min, "max", max, "answer", answer)) {
    return refuse_null(error, name);
  }
  if (!has_size(answer)) return refuse(error, "answer: struct_size");
  return guarded(error, [&] {
    const Result<BoxOverlap> found =
        overlap_box_within(tree->inside, box_of(*min, *max), distance, node_budget);
    if (found) {
      write_struct(answer, {.overlap = static_cast<std::uint32_t>(found->overlap),
                            .first = to_c(found->face.value_or(FaceRef{})),
                            .second = to_c(FaceRef{}),
                            .nodes_expanded = found->nodes_expanded});
    }
    return finish(found, error);
  });
}

bool bxt_frustum_of_matrix(const double rows[16], uint32_t clip_depth, bxt_plane planes[6]) {
  if (clip_depth > BXT_CLIP_MINUS_ONE_TO_ONE) return false;
  Frustum::ViewProjection matrix;
  for (Eigen::Index row = 0; row < 4; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column)
      matrix(row, column) = rows[4 * row + column];
  }
  write_planes(Frustum::of(matrix, static_cast<ClipDepth>(clip_depth)), planes);
  return true;
}

void bxt_frustum_of_corners(const bxt_vec3 corners[8], bxt_plane planes[6]) {
  std::array<Eigen::Vector3d, 8> points;
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = to_cpp(corners[i]);
  write_planes(Frustum::of(points), planes);
}

bxt_status bxt_scene_overlap_box(const bxt_scene* scene, const bxt_vec3* min, const bxt_vec3* max,
                                 bxt_face_visitor visitor, void* context, const bxt_limits* limits,
                                 bxt_error* error) {
  return visit_in_box(scene, min, max, visitor, context, limits, error);
}

bxt_status bxt_scene_overlap_boxes(const bxt_scene* scene, const bxt_vec3* mins,
                                   const bxt_vec3* maxs, size_t count,
                                   bxt_batch_face_visitor visitor, void* context,
                                   const bxt_limits* limits, bxt_status* statuses,
                                   bxt_error* error) {
  return visit_in_boxes(scene, mins, maxs, count, visitor, context, limits, statuses, error);
}

bxt_status bxt_scene_overlap_spheres(const bxt_scene* scene, const bxt_vec3* centers,
                                     const double* radii, size_t count,
                                     bxt_batch_face_visitor visitor, void* context,
                                     const bxt_limits* limits, bxt_status* statuses,
                                     bxt_error* error) {
  return visit_in_spheres(scene, centers, radii, count, visitor, context, limits, statuses, error);
}

bxt_status bxt_scene_overlap(const bxt_scene* scene, const bxt_shape* shape,
                             bxt_face_visitor visitor, void* context, const bxt_limits* limits,
                             bxt_error* error) {
  return visit_in_shape(scene, shape, visitor, context, limits, error);
}

bxt_status bxt_scene_overlap_frustum(const bxt_scene* scene, const bxt_plane planes[6],
                                     bxt_face_visitor visitor, void* context,
                                     const bxt_limits* limits, bxt_error* error) {
  return visit_in_frustum(scene, planes, visitor, context, limits, error);
}

bxt_status bxt_scene_instances_in_frustum(const bxt_scene* scene, const bxt_plane planes[6],
                                          bxt_instance_visitor visitor, void* context,
                                          const bxt_limits* limits, bxt_error* error) {
  if (const char* name = first_null("scene", scene, "planes", planes, "visitor", visitor))
    return refuse_null(error, name);
  return guarded(error, [&] {
    return with_limits<bxt_scene>(limits, error, [&](auto... read) {
      const auto visit = [&](std::uint32_t instance) { return visitor(context, instance); };
      return finish(instances_in_frustum(scene->inside, frustum_of(planes), visit, read...), error);
    });
  });
}
