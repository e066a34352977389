// SPDX-License-Identifier: MIT
// Rays by the C interface: the answers of the C++ interface, of trees and scenes.
#include <array>
#include <boxtree_c.h>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/unit/c/options.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

using test::Answer;
using test::answer_of_c;
using test::Numbers;
using test::numbers_of;

template <class Handle>
struct Rays;
template <>
struct Rays<bxt_tree> {
  static constexpr auto closest_hit = bxt_tree_closest_hit, any_hit = bxt_tree_any_hit;
  static constexpr auto all_hits = bxt_tree_all_hits;
  static constexpr auto nearest_hits = bxt_tree_nearest_hits;
  static constexpr auto closest_hits = bxt_tree_closest_hits, any_hits = bxt_tree_any_hits;
};
template <>
struct Rays<bxt_scene> {
  static constexpr auto closest_hit = bxt_scene_closest_hit, any_hit = bxt_scene_any_hit;
  static constexpr auto all_hits = bxt_scene_all_hits;
  static constexpr auto nearest_hits = bxt_scene_nearest_hits;
  static constexpr auto closest_hits = bxt_scene_closest_hits, any_hits = bxt_scene_any_hits;
};

// Some that hit and miss, and some that are no rays.
std::vector<Ray> some_rays(test::Randoms& randoms, std::size_t count) {
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i) {
    Ray ray = randoms.ray();
    if (i % 5 == 1) ray.t_max = 0.9;
    if (i % 7 == 2) ray.t_min = 0.5;
    if (i % 11 == 3) ray.direction = Eigen::Vector3d::UnitZ();
    if (i % 17 == 4) ray.direction.setZero();
    if (i % 17 == 5) ray.origin.y() = NAN;
    if (i % 17 == 6) ray.t_max = -1;
    rays.push_back(ray);
  }
  return rays;
}

template <class Result>
Answer answer_of(const Result& result) {
  Answer answer;
  note_error(result, answer);
  if (result.ok()) answer.found.push_back(numbers_of(*result, result.has_value()));
  return answer;
}

// By a function that finds one hit.
template <class Function, class Handle>
Answer one_hit(Function function, const Handle* subject, const Ray& ray,
               const bxt_face_options* options) {
  return answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
    const bxt_ray c_ray = test::ray_of(ray);
    bxt_ray_hit hit = {};
    hit.struct_size = sizeof hit;
    hit.t = -5;
    const bxt_status status = function(subject, &c_ray, options, &hit, error);
    if (status == BXT_OK) {
      found.push_back(numbers_of(hit));
    } else {
      EXPECT_EQ(hit.t, -5) << "an error leaves the hit alone";
    }
    EXPECT_EQ(hit.struct_size, sizeof hit);
    return status;
  });
}

TEST(CRays, OneHitIsThatOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = Rays<std::remove_const_t<std::remove_pointer_t<decltype(c_subject)>>>;
    test::Randoms randoms(subject);
    const std::vector<Ray> rays = some_rays(randoms, 60);
    int hits = 0, refused = 0;
    test::for_each_face_options(subject, [&](const bxt_face_options* c, const auto& options) {
      for (const Ray& ray : rays) {
        const Answer closest = answer_of(closest_hit(subject, ray, options));
        hits += !closest.found.empty() && closest.found[0][0] != 0;
        refused += closest.status == BXT_INVALID_QUERY;
        ASSERT_EQ(one_hit(Functions::closest_hit, c_subject, ray, c), closest);
        ASSERT_EQ(one_hit(Functions::any_hit, c_subject, ray, c),
                  answer_of(any_hit(subject, ray, options)));
      }
    });
    EXPECT_GT(hits, 20);
    EXPECT_GT(refused, 20);
  });
}

double keep_all(void* context, const bxt_ray_hit* hit) {
  EXPECT_EQ(hit->struct_size, sizeof *hit);
  test::keep(context, hit);
  return INFINITY;
}
double keep_nearer(void* context, const bxt_ray_hit* hit) {
  test::keep(context, hit);
  return hit->t;
}
double keep_first(void* context, const bxt_ray_hit* hit) {
  test::keep(context, hit);
  return -1;
}

TEST(CRays, EveryHitIsThatOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = Rays<std::remove_const_t<std::remove_pointer_t<decltype(c_subject)>>>;
    test::Randoms randoms(subject);
    const std::vector<Ray> rays = some_rays(randoms, 40);
    test::for_each_face_options(subject, [&](const bxt_face_options* c, const auto& options) {
      for (const Ray& ray : rays) {
        const bxt_ray c_ray = test::ray_of(ray);
        for (const bxt_ray_visitor visitor : {&keep_all, &keep_nearer, &keep_first}) {
          Answer expected;
          const auto visit = [&](const auto& hit) {
            expected.found.push_back(numbers_of(hit));
            return visitor == &keep_all ? INFINITY : visitor == &keep_nearer ? hit.t : -1.0;
          };
          note_error(all_hits(subject, ray, visit, options), expected);
          ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                      return Functions::all_hits(c_subject, &c_ray, visitor, &found, c, error);
                    }),
                    expected);
        }
      }
    });
  });
}

// An element of an array of a later version of the interface.
template <class T>
struct Longer {
  T known = {};
  std::uint64_t later[3] = {7, 8, 9};

  [[nodiscard]] bool is_whole() const { return later[0] == 7 && later[1] == 8 && later[2] == 9; }
};

// In arrays of `Element`, whose first one says how long it is.
template <class Element, class Functions, class Subject, class Handle, class Options>
void expect_same_nearest(const Subject& subject, const Handle* c_subject, const Ray& ray,
                         std::size_t room, const bxt_face_options* c, const Options& options) {
  using Hit = std::conditional_t<std::is_same_v<Subject, Tree>, RayHit, SceneRayHit>;
  std::vector<Hit> expected_hits(room);
  Answer expected;
  const Result<std::size_t> expected_count =
      nearest_hits(subject, ray, std::span<Hit>(expected_hits), options);
  note_error(expected_count, expected);
  for (std::size_t i = 0; expected_count.ok() && i < room; ++i) {
    const bool is_hit = i < *expected_count;
    expected.found.push_back(is_hit ? numbers_of(expected_hits[i]) : numbers_of(Hit(), false));
  }
  std::vector<Element> hits(room + 1);  // one that must stay as it is
  if (room > 0) reinterpret_cast<bxt_ray_hit*>(hits.data())->struct_size = sizeof(Element);
  const bxt_ray c_ray = test::ray_of(ray);
  ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
              std::size_t count = 77;
              const bxt_status status = Functions::nearest_hits(
                  c_subject, &c_ray, reinterpret_cast<bxt_ray_hit*>(hits.data()), room, &count, c,
                  error);
              EXPECT_EQ(count, status == BXT_OK ? *expected_count : 77);
              for (std::size_t i = 0; status == BXT_OK && i < room; ++i) {
                const auto& hit = reinterpret_cast<const bxt_ray_hit&>(hits[i]);
                EXPECT_EQ(hit.struct_size, sizeof(Element));
                found.push_back(numbers_of(hit));
              }
              return status;
            }),
            expected);
  if constexpr (!std::is_same_v<Element, bxt_ray_hit>) {
    for (const Element& hit : hits) EXPECT_TRUE(hit.is_whole());
  }
  EXPECT_EQ(reinterpret_cast<const bxt_ray_hit&>(hits[room]).struct_size, 0u);
}

TEST(CRays, NearestHitsAreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = Rays<std::remove_const_t<std::remove_pointer_t<decltype(c_subject)>>>;
    test::Randoms randoms(subject);
    const std::vector<Ray> rays = some_rays(randoms, 24);
    test::for_each_face_options(subject, [&](const bxt_face_options* c, const auto& options) {
      for (const Ray& ray : rays) {
        for (const std::size_t room : {0u, 1u, 3u, 40u}) {
          expect_same_nearest<bxt_ray_hit, Functions>(subject, c_subject, ray, room, c, options);
          expect_same_nearest<Longer<bxt_ray_hit>, Functions>(subject, c_subject, ray, room, c,
                                                              options);
        }
      }
    });
  });
}

// The batches of C++, whose scenes take no FaceOptions.
std::vector<RayResult> batch(const Tree& tree, const std::vector<Ray>& rays, bool any,
                             const FaceOptions& options) {
  std::vector<RayResult> results(rays.size());
  const Status status =
      any ? any_hits(tree, rays, results, options) : closest_hits(tree, rays, results, options);
  EXPECT_TRUE(status.ok());
  return results;
}
std::vector<SceneRayResult> batch(const Scene& scene, const std::vector<Ray>& rays, bool any,
                                  const SceneFaceOptions& options) {
  std::vector<SceneRayResult> results;
  for (const Ray& ray : rays) {
    results.push_back(any ? any_hit(scene, ray, options) : closest_hit(scene, ray, options));
  }
  return results;
}

template <class Element, class Handle, class Results>
void expect_same_batch(const Handle* c_subject, const std::vector<Ray>& rays, bool any,
                       const bxt_face_options* c, const Results& expected) {
  using Functions = Rays<Handle>;
  const auto function = any ? Functions::any_hits : Functions::closest_hits;
  std::vector<bxt_ray> c_rays;
  for (const Ray& ray : rays) c_rays.push_back(test::ray_of(ray));
  std::vector<Element> hits(rays.size() + 1);
  if (!rays.empty()) reinterpret_cast<bxt_ray_hit*>(hits.data())->struct_size = sizeof(Element);
  std::vector<bxt_status> statuses(rays.size() + 1, -3);
  bxt_error error = {};
  error.struct_size = sizeof error;
  const bxt_status status =
      function(c_subject, c_rays.data(), rays.size(), reinterpret_cast<bxt_ray_hit*>(hits.data()),
               statuses.data(), c, &error);
  bool is_first_error = true;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SCOPED_TRACE(i);
    const auto& hit = reinterpret_cast<const bxt_ray_hit&>(hits[i]);
    ASSERT_EQ(hit.struct_size, sizeof(Element));
    ASSERT_EQ(numbers_of(hit), numbers_of(*expected[i], expected[i].has_value()));
    ASSERT_EQ(statuses[i], static_cast<bxt_status>(expected[i].code()));
    if (statuses[i] == BXT_OK || !is_first_error) continue;
    is_first_error = false;
    EXPECT_EQ(status, statuses[i]);
    EXPECT_EQ(error.message, expected[i].error().message());
  }
  if (is_first_error) {
    EXPECT_EQ(status, BXT_OK);
  }
  EXPECT_EQ(statuses[rays.size()], -3);
  EXPECT_EQ(reinterpret_cast<const bxt_ray_hit&>(hits[rays.size()]).struct_size, 0u);
  if constexpr (!std::is_same_v<Element, bxt_ray_hit>) {
    for (const Element& hit : hits) EXPECT_TRUE(hit.is_whole());
  }
  EXPECT_EQ(function(c_subject, c_rays.data(), rays.size(),
                     reinterpret_cast<bxt_ray_hit*>(hits.data()), nullptr, c, nullptr),
            status);
}

TEST(CRays, BatchesAreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    test::Randoms randoms(subject);
    for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 1000u}) {
      SCOPED_TRACE(count);
      const std::vector<Ray> rays = some_rays(randoms, count);
      // A filter is called for hits alone: of a thousand rays there are some.
      if (count == 1000) {
        test::for_each_face_options(subject, [&](const bxt_face_options* c, const auto& options) {
          expect_same_batch<bxt_ray_hit>(c_subject, rays, false, c,
                                         batch(subject, rays, false, options));
        });
      }
      for (const bool any : {false, true}) {
        const auto expected = batch(subject, rays, any, {});
        expect_same_batch<bxt_ray_hit>(c_subject, rays, any, nullptr, expected);
        expect_same_batch<Longer<bxt_ray_hit>>(c_subject, rays, any, nullptr, expected);
      }
    }
  });
}

TEST(CRays, BatchesWithAnArgumentThatIsNotValidWriteNothing) {
  test::for_each_subject([](const auto&, const auto* c_subject) {
    using Functions = Rays<std::remove_const_t<std::remove_pointer_t<decltype(c_subject)>>>;
    const std::vector<bxt_ray> rays(3);
    std::vector<bxt_ray_hit> hits(3);
    hits[0].struct_size = sizeof hits[0];
    std::vector<bxt_status> statuses(3, -3);
    bxt_face_options options = bxt_default_face_options();
    options.back_faces = 3;
    for (const auto function : {Functions::closest_hits, Functions::any_hits}) {
      EXPECT_EQ(
          function(c_subject, rays.data(), 3, hits.data(), statuses.data(), &options, nullptr),
          BXT_INVALID_QUERY);
    }
    EXPECT_EQ(statuses, std::vector<bxt_status>(3, -3));
    EXPECT_EQ(hits[1].struct_size, 0u);
  });
}

TEST(CRays, BatchesOfScenesAreThoseOfCpp) {
  test::for_each_scene([](const Scene& scene, const bxt_scene* c_scene) {
    test::Randoms randoms(scene);
    const std::vector<Ray> rays = some_rays(randoms, 100);
    std::vector<SceneRayResult> expected(rays.size());
    bxt_face_options c = bxt_default_face_options();
    c.layers = 2;
    ASSERT_TRUE(closest_hits(scene, rays, expected, 2).ok());
    expect_same_batch<bxt_ray_hit>(c_scene, rays, false, &c, expected);
    ASSERT_TRUE(any_hits(scene, rays, expected, 2).ok());
    expect_same_batch<bxt_ray_hit>(c_scene, rays, true, &c, expected);
  });
}

}  // namespace
}  // namespace boxtree
