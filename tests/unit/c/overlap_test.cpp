// SPDX-License-Identifier: MIT
// What touches boxes, shapes and frustums by the C interface: the answers of the C++ interface.
#include <array>
#include <boxtree_c.h>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/unit/c/options.h"
#include "tests/unit/c/shapes.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

using test::Answer;
using test::answer_of_c;
using test::keep;
using test::keep_three;
using test::Numbers;
using test::numbers_of;

template <class Handle>
struct Overlaps;
template <>
struct Overlaps<bxt_tree> {
  static constexpr auto box = bxt_tree_overlap_box;
  static constexpr auto boxes = bxt_tree_overlap_boxes;
  static constexpr auto spheres = bxt_tree_overlap_spheres;
  static constexpr auto shape = bxt_tree_overlap;
  static constexpr auto frustum = bxt_tree_overlap_frustum;
};
template <>
struct Overlaps<bxt_scene> {
  static constexpr auto box = bxt_scene_overlap_box;
  static constexpr auto boxes = bxt_scene_overlap_boxes;
  static constexpr auto spheres = bxt_scene_overlap_spheres;
  static constexpr auto shape = bxt_scene_overlap;
  static constexpr auto frustum = bxt_scene_overlap_frustum;
};
template <class Pointer>
using OverlapsOf = Overlaps<std::remove_const_t<std::remove_pointer_t<Pointer>>>;

// What a query of C++ visits, all of it or three: `query(visit)`.
template <class Query>
Answer visited(bool all, const Query& query) {
  Answer answer;
  note_error(query([&](const auto& face) {
               answer.found.push_back(numbers_of(face));
               return all || answer.found.size() < 3;
             }),
             answer);
  return answer;
}

// And what one of C visits: `query(visitor, context, error)`.
template <class Told = bxt_face, class Query>
Answer visited_c(bool all, const Query& query) {
  return answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
    return query(all ? &keep<Told> : &keep_three<Told>, &found, error);
  });
}

TEST(COverlaps, OfNothingWantAVisitor) {
  test::for_each_subject([](const auto&, const auto* c_subject) {
    using Functions = OverlapsOf<decltype(c_subject)>;
    const auto visitor = [](void*, std::size_t, const bxt_face*) { return true; };
    EXPECT_EQ(Functions::boxes(c_subject, nullptr, nullptr, 0, visitor, nullptr, nullptr, nullptr,
                               nullptr),
              BXT_OK);
    EXPECT_EQ(Functions::boxes(c_subject, nullptr, nullptr, 0, nullptr, nullptr, nullptr, nullptr,
                               nullptr),
              BXT_INVALID_QUERY);
    EXPECT_EQ(Functions::spheres(c_subject, nullptr, nullptr, 0, visitor, nullptr, nullptr, nullptr,
                                 nullptr),
              BXT_OK);
    EXPECT_EQ(Functions::spheres(c_subject, nullptr, nullptr, 0, nullptr, nullptr, nullptr, nullptr,
                                 nullptr),
              BXT_INVALID_QUERY);
  });
}

TEST(COverlaps, OfBoxesAreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = OverlapsOf<decltype(c_subject)>;
    test::Randoms randoms(subject);
    std::size_t found = 0;
    test::for_each_limits(subject, [&](const bxt_limits* c, const auto&... limits) {
      for (int i = 0; i < 20; ++i) {
        const Eigen::Vector3d a = randoms.point(1.2), b = randoms.point(1.2);
        Eigen::AlignedBox3d box(a.cwiseMin(b), a.cwiseMax(b));
        if (i == 7) box.min().x() = NAN;
        if (i == 8) box = {box.max(), box.min()};
        const bxt_vec3 min = test::vec3(box.min()), max = test::vec3(box.max());
        for (const bool all : {true, false}) {
          const Answer expected = visited(
              all, [&](const auto& visit) { return overlap_box(subject, box, visit, limits...); });
          found += expected.found.size();
          ASSERT_EQ(visited_c(all,
                              [&](auto visitor, void* context, bxt_error* error) {
                                return Functions::box(c_subject, &min, &max, visitor, context, c,
                                                      error);
                              }),
                    expected);
        }
      }
    });
    EXPECT_GT(found, 50u);
  });
}

// What a batch of C visits: of each shape, and how it ended.
struct BatchOfC {
  explicit BatchOfC(std::size_t count) : found(count), statuses(count + 1, -3) {
    error.struct_size = sizeof error;
  }

  // Of shapes with odd numbers all faces, of the others three.
  static bool keep(void* context, std::size_t number, const bxt_face* face) {
    std::vector<Numbers>& faces = static_cast<BatchOfC*>(context)->found[number];
    faces.push_back(numbers_of(*face));
    return number % 2 == 1 || faces.size() < 3;
  }

  std::vector<std::vector<Numbers>> found;
  std::vector<bxt_status> statuses;
  bxt_error error = {};
};

// Each shape visits what it visits alone, the message is that of the first error: `alone(i,
// visitor, context, error)`.
template <class Alone>
void expect_as_alone(const BatchOfC& batch, bxt_status status, const Alone& alone) {
  bxt_status first_status = BXT_OK;
  bxt_error first = {};
  first.struct_size = sizeof first;
  for (std::size_t i = 0; i < batch.found.size(); ++i) {
    SCOPED_TRACE(i);
    std::vector<Numbers> found;
    const bxt_status expected = alone(i, i % 2 == 1 ? &keep<bxt_face> : &keep_three<bxt_face>,
                                      &found, first_status == BXT_OK ? &first : nullptr);
    if (first_status == BXT_OK) first_status = expected;
    ASSERT_EQ(batch.statuses[i], expected);
    ASSERT_EQ(batch.found[i], found);
  }
  ASSERT_EQ(status, first_status);
  if (status != BXT_OK) {
    EXPECT_STREQ(batch.error.message, first.message);
  }
  EXPECT_EQ(batch.statuses.back(), -3) << "written behind the last one";
}

TEST(COverlaps, OfABatchAreThoseOfShapesAlone) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = OverlapsOf<decltype(c_subject)>;
    test::Randoms randoms(subject);
    for (const std::size_t count : {0u, 1u, 70u, 200u}) {
      std::vector<bxt_vec3> mins, maxs;
      std::vector<double> radii;
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3d a = randoms.point(1.2), b = randoms.point(1.2);
        mins.push_back(test::vec3(a.cwiseMin(b)));
        maxs.push_back(test::vec3(a.cwiseMax(b)));
        radii.push_back(i % 50 == 41 ? -1 : 0.25 * (a - b).norm());
        if (i % 50 == 37) mins.back().y = NAN;
      }
      test::for_each_limits(subject, [&](const bxt_limits* c, const auto&...) {
        BatchOfC boxes(count);
        const bxt_status of_boxes =
            Functions::boxes(c_subject, mins.data(), maxs.data(), count, &BatchOfC::keep, &boxes, c,
                             boxes.statuses.data(), &boxes.error);
        expect_as_alone(
            boxes, of_boxes, [&](std::size_t i, auto visitor, void* context, bxt_error* error) {
              return Functions::box(c_subject, &mins[i], &maxs[i], visitor, context, c, error);
            });
        BatchOfC spheres(count);
        const bxt_status of_spheres =
            Functions::spheres(c_subject, mins.data(), radii.data(), count, &BatchOfC::keep,
                               &spheres, c, spheres.statuses.data(), &spheres.error);
        expect_as_alone(spheres, of_spheres,
                        [&](std::size_t i, auto visitor, void* context, bxt_error* error) {
                          const bxt_shape sphere = bxt_sphere(mins[i], radii[i]);
                          return Functions::shape(c_subject, &sphere, visitor, context, c, error);
                        });
      });
    }
  });
}

// The queries of all shapes by one name.
template <class Subject, class... Rest>
Result<Visit> overlap(const Subject& subject, const Sphere& shape, const Rest&... rest) {
  return overlap_sphere(subject, shape, rest...);
}
template <class Subject, class... Rest>
Result<Visit> overlap(const Subject& subject, const Capsule& shape, const Rest&... rest) {
  return overlap_capsule(subject, shape, rest...);
}
template <class Subject, class... Rest>
Result<Visit> overlap(const Subject& subject, const OrientedBox& shape, const Rest&... rest) {
  return overlap_oriented_box(subject, shape, rest...);
}
template <class Subject, class... Rest>
Result<Visit> overlap(const Subject& subject, const ConvexHull& shape, const Rest&... rest) {
  return overlap_convex_hull(subject, shape, rest...);
}

TEST(COverlaps, OfShapesAreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = OverlapsOf<decltype(c_subject)>;
    test::Randoms randoms(subject);
    std::size_t found = 0;
    test::for_each_limits(subject, [&](const bxt_limits* c, const auto&... limits) {
      for (const bool all : {true, false}) {
        test::for_each_shape(
            randoms, randoms.size(), [&](const bxt_shape& c_shape, const auto& shape) {
              const Answer expected = visited(all, [&](const auto& visit) {
                return overlap(subject, shape, visit, limits...);
              });
              found += expected.found.size();
              ASSERT_EQ(visited_c(all,
                                  [&](auto visitor, void* context, bxt_error* error) {
                                    return Functions::shape(c_subject, &c_shape, visitor, context,
                                                            c, error);
                                  }),
                        expected);
            });
      }
    });
    EXPECT_GT(found, 20u);
  });
}

TEST(COverlaps, OfFrustumsAreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = OverlapsOf<decltype(c_subject)>;
    test::Randoms randoms(subject);
    std::size_t found = 0;
    test::for_each_limits(subject, [&](const bxt_limits* c, const auto&... limits) {
      for (int i = 0; i < 12; ++i) {
        std::array<Eigen::Vector3d, 8> corners;
        std::array<bxt_vec3, 8> c_corners;
        const Eigen::Vector3d eye = randoms.point(1.2);
        for (std::size_t k = 0; k < 8; ++k) {
          const Eigen::Vector3d side(k % 4 == 1 || k % 4 == 2 ? 1 : -1, k % 4 > 1 ? 1 : -1, 2);
          corners[k] = eye + (k < 4 ? 0.01 : 0.4) * randoms.size() * side;
          c_corners[k] = test::vec3(corners[k]);
        }
        Frustum frustum = Frustum::of(corners);
        bxt_plane planes[6];
        bxt_frustum_of_corners(c_corners.data(), planes);
        for (std::size_t k = 0; k < 6; ++k) {
          const Frustum::Plane& plane = frustum.planes[k];
          ASSERT_EQ(Numbers() << planes[k].normal << planes[k].offset,
                    Numbers() << Eigen::Vector3d(plane.head<3>()) << plane.w());
        }
        if (i == 5) planes[2].offset = frustum.planes[2].w() = NAN;
        for (const bool all : {true, false}) {
          const Answer expected = visited(all, [&](const auto& visit) {
            return overlap_frustum(subject, frustum, visit, limits...);
          });
          found += expected.found.size();
          ASSERT_EQ(visited_c(all,
                              [&](auto visitor, void* context, bxt_error* error) {
                                return Functions::frustum(c_subject, planes, visitor, context, c,
                                                          error);
                              }),
                    expected);
        }
        if constexpr (std::is_same_v<std::decay_t<decltype(subject)>, Scene>) {
          Answer expected;
          const auto visit = [&](std::uint32_t instance) {
            expected.found.push_back(Numbers() << instance);
            return true;
          };
          note_error(instances_in_frustum(subject, frustum, visit, limits...), expected);
          const bxt_instance_visitor keep_instance = [](void* context, std::uint32_t instance) {
            static_cast<std::vector<Numbers>*>(context)->push_back(Numbers() << instance);
            return true;
          };
          ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& told) {
                      return bxt_scene_instances_in_frustum(c_subject, planes, keep_instance, &told,
                                                            c, error);
                    }),
                    expected);
        }
      }
    });
    EXPECT_GT(found, 20u);
  });
}

TEST(COverlaps, FrustumsOfMatricesAreThoseOfCpp) {
  Frustum::ViewProjection matrix;
  double rows[16];
  for (Eigen::Index i = 0; i < 16; ++i) {
    rows[i] = std::sin(static_cast<double>(7 * i + 1));
    matrix(i / 4, i % 4) = rows[i];
  }
  for (const ClipDepth depth : {ClipDepth::kZeroToOne, ClipDepth::kMinusOneToOne}) {
    const Frustum frustum = Frustum::of(matrix, depth);
    bxt_plane planes[6];
    ASSERT_TRUE(bxt_frustum_of_matrix(rows, static_cast<std::uint32_t>(depth), planes));
    for (std::size_t k = 0; k < 6; ++k) {
      const Frustum::Plane& plane = frustum.planes[k];
      EXPECT_EQ(Numbers() << planes[k].normal << planes[k].offset,
                Numbers() << Eigen::Vector3d(plane.head<3>()) << plane.w());
    }
  }
  bxt_plane planes[6] = {{{1, 2, 3}, 4}};
  EXPECT_FALSE(bxt_frustum_of_matrix(rows, 2, planes));
  EXPECT_EQ(planes[0].offset, 4);
}

TEST(COverlaps, WithinADistanceAreThoseOfCpp) {
  test::for_each_tree([](const Tree& tree, const bxt_tree* c_tree) {
    test::Randoms randoms(tree);
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d a = randoms.point(1.5), b = a + 0.1 * (randoms.point() - a);
      Eigen::AlignedBox3d box(a.cwiseMin(b), a.cwiseMax(b));
      const double distance = i == 8 ? -1 : i % 3 == 0 ? 0.0 : 0.1 * randoms.size();
      const std::uint64_t budget = i % 5 == 0 ? 2 : BXT_UNLIMITED;
      const bxt_vec3 min = test::vec3(box.min()), max = test::vec3(box.max());
      Answer expected;
      const Result<BoxOverlap> found = overlap_box_within(tree, box, distance, budget);
      note_error(found, expected);
      if (found) {
        expected.found.push_back((Numbers()
                                  << static_cast<std::uint32_t>(found->overlap)
                                  << found->face.value_or(FaceRef())
                                  << std::uint32_t{BXT_NO_INSTANCE} << found->nodes_expanded));
      }
      ASSERT_EQ(
          answer_of_c([&](bxt_error* error, std::vector<Numbers>& told) {
            bxt_overlap_answer answer = {};
            answer.struct_size = sizeof answer;
            const bxt_status status =
                bxt_tree_overlap_box_within(c_tree, &min, &max, distance, budget, &answer, error);
            if (status != BXT_OK) return status;
            told.push_back(Numbers() << answer.overlap << answer.first << answer.nodes_expanded);
            EXPECT_EQ(answer.second.id, BXT_NO_FACE);
            return status;
          }),
          expected);
    }
  });
}

}  // namespace
}  // namespace boxtree
