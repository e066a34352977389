// SPDX-License-Identifier: MIT
// Every query of the C interface once, for tests of what each may cost.
#pragma once

#include <array>
#include <boxtree_c.h>
#include <cmath>
#include <cstddef>
#include <functional>
#include <vector>

namespace boxtree::test {

struct CQuery {
  const char* name;
  std::size_t stack_kilobytes;  // the most that the header states
  std::function<bxt_status()> run;
};

/// Every query of a tree, also with itself moved by `near`, and of a scene, by a ray, shapes and
/// frustums around `center`.
[[nodiscard]] inline std::vector<CQuery> c_queries(const bxt_tree* tree, const bxt_scene* scene,
                                                   bxt_vec3 center, double size) {
  const bxt_ray ray = {
      {center.x + 0.1, center.y + 0.2, center.z + size}, {0.001, 0.002, -1}, 0, INFINITY};
  const bxt_vec3 min = {center.x - size, center.y - size, center.z - size};
  const bxt_vec3 max = {center.x + size, center.y + size, center.z + size};
  static constexpr std::array<bxt_vec3, 5> kPoints = {
      {{-1, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
  const bxt_quaternion turn = {0.5, 0.25, 0.125, 1};
  const bxt_shape ball = bxt_sphere(center, size), small = bxt_sphere(ray.origin, 0.25);
  const bxt_shape box = bxt_box(ray.origin, {0.25, 0.5, 0.75}, turn);
  const bxt_shape hull = bxt_convex_hull(kPoints.data(), kPoints.size(), center, turn);
  const bxt_motion motion = bxt_motion_along({0, 0, -2 * size});
  const bxt_pose near = bxt_translation(0.3, 0.2, 0.05), far = bxt_translation(0, 0, 2 * size);
  std::array<bxt_plane, 6> planes;
  for (bxt_plane& plane : planes) plane = {{0, 0, 0}, 1};
  static constexpr bxt_face_filter kAnyFace = [](void*, const bxt_face*) { return true; };
  static constexpr bxt_instance_filter kAny = [](void*, std::uint32_t) { return true; };
  static constexpr bxt_face_visitor kFaces = [](void*, const bxt_face*) { return true; };
  static constexpr bxt_ray_visitor kHits = [](void*, const bxt_ray_hit*) { return 1e9; };
  static constexpr bxt_cast_visitor kTouches = [](void*, const bxt_cast_hit*) { return 1e9; };
  static constexpr bxt_contact_visitor kContacts = [](void*, const bxt_contact*) { return true; };
  static constexpr bxt_pair_visitor kPairs = [](void*, const bxt_face*, const bxt_face*) {
    return true;
  };
  static constexpr bxt_pair_contact_visitor kPairContacts = [](void*, const bxt_pair_contact*) {
    return true;
  };
  static constexpr bxt_box_test kEveryBox = [](void*, const bxt_vec3*, const bxt_vec3*) {
    return true;
  };
  static constexpr bxt_triangle_visitor kTriangles = [](void*, const bxt_triangle*, const bxt_face*,
                                                        std::uint32_t) { return true; };
  bxt_face_options options = bxt_default_face_options();
  options.filter = kAnyFace;
  bxt_face_options of_scene = options;
  of_scene.instance_filter = kAny;
  // What answers are written to: as long as any of them.
  const auto answer = [](auto fill) {
    return [fill] {
      std::array<bxt_ray_hit, 8> hits = {};
      hits[0].struct_size = sizeof hits[0];
      return fill(hits);
    };
  };
  const auto one = [](auto query) {
    return [query] {
      bxt_ray_hit hit = {};
      hit.struct_size = sizeof hit;
      return query(&hit);
    };
  };
  const auto touch = [](auto query) {
    return [query] {
      bxt_cast_hit hit = {};
      hit.struct_size = sizeof hit;
      return query(&hit);
    };
  };
  const auto closest = [](auto query) {
    return [query] {
      bxt_closest_point point = {};
      point.struct_size = sizeof point;
      return query(&point);
    };
  };
  const auto overlap = [](auto query) {
    return [query] {
      bxt_overlap_answer told = {};
      told.struct_size = sizeof told;
      return query(&told);
    };
  };
  static constexpr bxt_batch_face_visitor kNumbered = [](void*, std::size_t, const bxt_face*) {
    return true;
  };
  // Less their own arrays of 100 shapes: 4 KB and more.
  const auto many_boxes = [=](auto function, auto* subject) {
    return [=] {
      std::array<bxt_vec3, 100> mins, maxs;
      for (std::size_t i = 0; i < mins.size(); ++i) {
        const double way = 0.01 * static_cast<double>(i);
        mins[i] = {min.x + way, min.y, min.z};
        maxs[i] = {max.x + way, max.y, max.z};
      }
      return function(subject, mins.data(), maxs.data(), mins.size(), kNumbered, nullptr, nullptr,
                      nullptr, nullptr);
    };
  };
  const auto many_spheres = [=](auto function, auto* subject) {
    return [=] {
      std::array<bxt_vec3, 100> centers;
      std::array<double, 100> radii;
      radii.fill(size);
      for (std::size_t i = 0; i < centers.size(); ++i)
        centers[i] = {center.x + 0.01 * static_cast<double>(i), center.y, center.z};
      return function(subject, centers.data(), radii.data(), centers.size(), kNumbered, nullptr,
                      nullptr, nullptr, nullptr);
    };
  };
  const auto batch = [=](auto function, auto* subject, const bxt_face_options& given) {
    return [=] {
      std::array<bxt_ray, 100> rays;
      for (std::size_t i = 0; i < rays.size(); ++i) {
        rays[i] = ray;
        rays[i].origin.x += 0.01 * static_cast<double>(i);
      }
      std::array<bxt_ray_hit, 100> hits = {};
      hits[0].struct_size = sizeof hits[0];
      std::array<bxt_status, 100> statuses;
      return function(subject, rays.data(), rays.size(), hits.data(), statuses.data(), &given,
                      nullptr);
    };
  };
  return {
      {"tree closest_hit", 64,
       one([=](auto* hit) { return bxt_tree_closest_hit(tree, &ray, &options, hit, nullptr); })},
      {"tree any_hit", 64,
       one([=](auto* hit) { return bxt_tree_any_hit(tree, &ray, nullptr, hit, nullptr); })},
      {"tree all_hits", 64,
       [=] { return bxt_tree_all_hits(tree, &ray, kHits, nullptr, &options, nullptr); }},
      {"tree nearest_hits", 64, answer([=](auto& hits) {
         std::size_t count;
         return bxt_tree_nearest_hits(tree, &ray, hits.data(), hits.size(), &count, nullptr,
                                      nullptr);
       })},
      // Less their own arrays of 100 rays, hits and statuses: 26 KB.
      {"tree closest_hits", 160 + 26,
       batch(bxt_tree_closest_hits, tree, bxt_default_face_options())},
      {"tree any_hits", 160 + 26, batch(bxt_tree_any_hits, tree, options)},
      {"tree overlap_box", 64,
       [=] { return bxt_tree_overlap_box(tree, &min, &max, kFaces, nullptr, nullptr, nullptr); }},
      {"tree overlap_boxes", 160 + 5, many_boxes(bxt_tree_overlap_boxes, tree)},
      {"tree overlap_spheres", 160 + 4, many_spheres(bxt_tree_overlap_spheres, tree)},
      {"tree overlap", 64,
       [=] { return bxt_tree_overlap(tree, &ball, kFaces, nullptr, nullptr, nullptr); }},
      {"tree overlap of a hull", 200,
       [=] { return bxt_tree_overlap(tree, &hull, kFaces, nullptr, nullptr, nullptr); }},
      {"tree overlap_frustum", 64,
       [=] {
         return bxt_tree_overlap_frustum(tree, planes.data(), kFaces, nullptr, nullptr, nullptr);
       }},
      {"tree overlap_box_within", 64, overlap([=](auto* told) {
         return bxt_tree_overlap_box_within(tree, &min, &max, 0, BXT_UNLIMITED, told, nullptr);
       })},
      {"tree closest_point", 64, closest([=](auto* point) {
         return bxt_tree_closest_point(tree, &center, INFINITY, nullptr, point, nullptr);
       })},
      // Less their own arrays of 100 points, answers and statuses: 16 KB.
      {"tree closest_points", 160 + 16,
       [=] {
         std::array<bxt_vec3, 100> points;
         for (std::size_t i = 0; i < points.size(); ++i) {
           points[i] = {center.x + 0.01 * static_cast<double>(i), center.y, center.z};
         }
         std::array<bxt_closest_point, 100> answers = {};
         answers[0].struct_size = sizeof answers[0];
         std::array<bxt_status, 100> statuses;
         return bxt_tree_closest_points(tree, points.data(), points.size(), INFINITY, nullptr,
                                        answers.data(), statuses.data(), nullptr);
       }},
      {"tree closest_point_within", 160, closest([=](auto* point) {
         return bxt_tree_closest_point_within(tree, &center, nullptr, point, nullptr);
       })},
      {"tree cast_closest", 64, touch([=](auto* hit) {
         return bxt_tree_cast_closest(tree, &box, &motion, &options, hit, nullptr);
       })},
      {"tree cast_closest of a hull", 200, touch([=](auto* hit) {
         return bxt_tree_cast_closest(tree, &hull, &motion, nullptr, hit, nullptr);
       })},
      {"tree cast_any", 64, touch([=](auto* hit) {
         return bxt_tree_cast_any(tree, &small, &motion, nullptr, hit, nullptr);
       })},
      {"tree cast_all", 64,
       [=] {
         return bxt_tree_cast_all(tree, &small, &motion, kTouches, nullptr, nullptr, nullptr);
       }},
      {"tree collide", 64,
       [=] { return bxt_tree_collide(tree, &ball, kContacts, nullptr, nullptr, nullptr); }},
      {"tree collide of a hull", 200,
       [=] { return bxt_tree_collide(tree, &hull, kContacts, nullptr, nullptr, nullptr); }},
      {"tree overlap_pairs", 320,
       [=] {
         return bxt_tree_overlap_pairs(tree, nullptr, tree, &near, kPairs, nullptr, nullptr,
                                       nullptr);
       }},
      {"tree pair_contacts", 320,
       [=] {
         return bxt_tree_pair_contacts(tree, nullptr, tree, &near, kPairContacts, nullptr, nullptr,
                                       nullptr);
       }},
      {"tree first_contact", 320, overlap([=](auto* told) {
         return bxt_tree_first_contact(tree, nullptr, tree, &near, nullptr, told, nullptr);
       })},
      {"tree overlap_within", 192, overlap([=](auto* told) {
         return bxt_tree_overlap_within(tree, nullptr, tree, &near, 0, BXT_UNLIMITED, told,
                                        nullptr);
       })},
      {"tree distance", 512,
       [=] {
         bxt_distance told = {};
         told.struct_size = sizeof told;
         return bxt_tree_distance(tree, nullptr, tree, &far, nullptr, &told, nullptr);
       }},
      {"tree traverse", 64,
       [=] { return bxt_tree_traverse(tree, kEveryBox, kTriangles, nullptr, nullptr, nullptr); }},
      {"tree prefetch", 64,
       [=] { return bxt_tree_prefetch(tree, 100) > 0 ? BXT_OK : BXT_INTERNAL; }},

      {"scene closest_hit", 64,
       one([=](auto* hit) { return bxt_scene_closest_hit(scene, &ray, &of_scene, hit, nullptr); })},
      {"scene any_hit", 64,
       one([=](auto* hit) { return bxt_scene_any_hit(scene, &ray, nullptr, hit, nullptr); })},
      {"scene all_hits", 64,
       [=] { return bxt_scene_all_hits(scene, &ray, kHits, nullptr, &of_scene, nullptr); }},
      {"scene nearest_hits", 64, answer([=](auto& hits) {
         std::size_t count;
         return bxt_scene_nearest_hits(scene, &ray, hits.data(), hits.size(), &count, nullptr,
                                       nullptr);
       })},
      {"scene closest_hits", 64 + 26,
       batch(bxt_scene_closest_hits, scene, bxt_default_face_options())},
      {"scene any_hits", 64 + 26, batch(bxt_scene_any_hits, scene, of_scene)},
      {"scene overlap_box", 64,
       [=] { return bxt_scene_overlap_box(scene, &min, &max, kFaces, nullptr, nullptr, nullptr); }},
      // Less chunks of 64 shapes and results.
      {"scene overlap_boxes", 64 + 10, many_boxes(bxt_scene_overlap_boxes, scene)},
      {"scene overlap_spheres", 64 + 10, many_spheres(bxt_scene_overlap_spheres, scene)},
      {"scene overlap", 64,
       [=] { return bxt_scene_overlap(scene, &ball, kFaces, nullptr, nullptr, nullptr); }},
      {"scene overlap of a hull", 200,
       [=] { return bxt_scene_overlap(scene, &hull, kFaces, nullptr, nullptr, nullptr); }},
      {"scene overlap_frustum", 64,
       [=] {
         return bxt_scene_overlap_frustum(scene, planes.data(), kFaces, nullptr, nullptr, nullptr);
       }},
      {"scene instances_in_frustum", 64,
       [=] {
         return bxt_scene_instances_in_frustum(scene, planes.data(), kAny, nullptr, nullptr,
                                               nullptr);
       }},
      {"scene closest_point", 64, closest([=](auto* point) {
         return bxt_scene_closest_point(scene, &center, INFINITY, nullptr, point, nullptr);
       })},
      {"scene cast_closest", 64, touch([=](auto* hit) {
         return bxt_scene_cast_closest(scene, &box, &motion, &of_scene, hit, nullptr);
       })},
      {"scene cast_closest of a hull", 200, touch([=](auto* hit) {
         return bxt_scene_cast_closest(scene, &hull, &motion, nullptr, hit, nullptr);
       })},
      {"scene cast_any", 64, touch([=](auto* hit) {
         return bxt_scene_cast_any(scene, &small, &motion, nullptr, hit, nullptr);
       })},
      {"scene cast_all", 64,
       [=] {
         return bxt_scene_cast_all(scene, &small, &motion, kTouches, nullptr, nullptr, nullptr);
       }},
      {"scene collide", 64,
       [=] { return bxt_scene_collide(scene, &ball, kContacts, nullptr, nullptr, nullptr); }},
      {"scene collide of a hull", 200,
       [=] { return bxt_scene_collide(scene, &hull, kContacts, nullptr, nullptr, nullptr); }},
      {"scene contacts", 352,
       [=] { return bxt_scene_contacts(scene, kPairs, nullptr, nullptr, nullptr); }},
      {"scene contacts_of", 352,
       [=] { return bxt_scene_contacts_of(scene, 0, kPairs, nullptr, nullptr, nullptr); }},
      {"scene overlap_pairs", 352,
       [=] {
         return bxt_scene_overlap_pairs(scene, tree, &near, kPairs, nullptr, nullptr, nullptr);
       }},
      {"scene pair_contacts", 352,
       [=] { return bxt_scene_pair_contacts(scene, kPairContacts, nullptr, nullptr, nullptr); }},
      {"scene pair_contacts_of", 352,
       [=] {
         return bxt_scene_pair_contacts_of(scene, 0, kPairContacts, nullptr, nullptr, nullptr);
       }},
      {"scene pair_contacts_with", 352,
       [=] {
         return bxt_scene_pair_contacts_with(scene, tree, &near, kPairContacts, nullptr, nullptr,
                                             nullptr);
       }},
      {"scene distance", 528,
       [=] {
         bxt_distance told = {};
         told.struct_size = sizeof told;
         return bxt_scene_distance(scene, tree, &far, BXT_ALL_LAYERS, nullptr, &told, nullptr);
       }},
      {"scene distance_of", 528,
       [=] {
         bxt_distance told = {};
         told.struct_size = sizeof told;
         return bxt_scene_distance_of(scene, 0, nullptr, &told, nullptr);
       }},
  };
}

}  // namespace boxtree::test
