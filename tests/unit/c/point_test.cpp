// SPDX-License-Identifier: MIT
// Closest points by the C interface: the answers of the C++ interface.
#include <boxtree_c.h>
#include <cmath>
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

template <class Point>
Numbers numbers_of_point(const Point& point, bool is_found, bool converged, double lower,
                         double upper, std::uint64_t nodes) {
  return Numbers() << is_found << converged << point.point << point.distance << point.face
                   << test::instance_of(point) << point.triangle << lower << upper << nodes;
}
Numbers numbers_of_point(const bxt_closest_point& point) {
  return Numbers() << point.is_found << point.converged << point.point << point.distance
                   << point.face << point.triangle << point.lower << point.upper
                   << point.nodes_expanded;
}

// `call(answer, error)`.
template <class Call>
Answer answer_of_call(const Call& call) {
  return answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
    bxt_closest_point answer = {};
    answer.struct_size = sizeof answer;
    answer.distance = -5;
    const bxt_status status = call(&answer, error);
    if (status == BXT_OK) {
      found.push_back(numbers_of_point(answer));
    } else {
      EXPECT_EQ(answer.distance, -5);
    }
    return status;
  });
}

template <class Handle>
constexpr auto kClosestPoint = bxt_tree_closest_point;
template <>
constexpr auto kClosestPoint<const bxt_scene*> = bxt_scene_closest_point;

TEST(CPoints, AreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    test::Randoms randoms(subject);
    test::for_each_limits(subject, [&](const bxt_limits* c, const auto&... limits) {
      for (int i = 0; i < 40; ++i) {
        Eigen::Vector3d point = randoms.point(1.5);
        if (i == 3) point.y() = NAN;
        const double largest = i % 3 == 0 ? INFINITY : i == 7 ? -1 : 0.1 * randoms.size();
        const bxt_vec3 c_point = test::vec3(point);
        const auto found = closest_point(subject, point, largest, limits...);
        Answer expected;
        note_error(found, expected);
        if (found.ok()) {
          expected.found.push_back(numbers_of_point(*found, found.has_value(), true,
                                                    found->distance, found->distance, 0));
        }
        ASSERT_EQ(answer_of_call([&](bxt_closest_point* answer, bxt_error* error) {
                    return kClosestPoint<decltype(c_subject)>(c_subject, &c_point, largest, c,
                                                              answer, error);
                  }),
                  expected);
      }
    });
  });
}

template <class Handle>
constexpr auto kClosestPoints = bxt_tree_closest_points;
template <>
constexpr auto kClosestPoints<const bxt_scene*> = bxt_scene_closest_points;

// Each answer and status is that of the point alone, the message that of the first error.
TEST(CPoints, OfABatchAreThoseOfPointsAlone) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    test::Randoms randoms(subject);
    for (const std::size_t count : {0u, 1u, 70u, 200u}) {
      std::vector<bxt_vec3> points;
      for (std::size_t i = 0; i < count; ++i) {
        Eigen::Vector3d point = randoms.point(1.5);
        if (i % 50 == 37) point.y() = NAN;
        points.push_back(test::vec3(point));
      }
      for (const double largest : {static_cast<double>(INFINITY), 0.1 * randoms.size(), -1.0}) {
        std::vector<bxt_closest_point> answers(count + 1);
        for (bxt_closest_point& answer : answers) answer.struct_size = sizeof answer;
        std::vector<bxt_status> statuses(count + 1, -3);
        bxt_error error = {}, first = {};
        error.struct_size = first.struct_size = sizeof error;
        const bxt_status status =
            kClosestPoints<decltype(c_subject)>(c_subject, points.data(), count, largest, nullptr,
                                                answers.data(), statuses.data(), &error);
        bxt_status first_status = BXT_OK;
        for (std::size_t i = 0; i < count; ++i) {
          SCOPED_TRACE(i);
          bxt_closest_point alone = {};
          alone.struct_size = sizeof alone;
          alone.distance = alone.lower = alone.upper = INFINITY;
          alone.converged = true;
          alone.face = answers[i].face;  // an error says nothing of one
          const bxt_status expected =
              kClosestPoint<decltype(c_subject)>(c_subject, &points[i], largest, nullptr, &alone,
                                                 first_status == BXT_OK ? &first : nullptr);
          if (first_status == BXT_OK) first_status = expected;
          ASSERT_EQ(statuses[i], expected);
          ASSERT_EQ(numbers_of_point(answers[i]), numbers_of_point(alone));
        }
        ASSERT_EQ(status, first_status);
        if (status != BXT_OK) {
          EXPECT_STREQ(error.message, first.message);
        }
        EXPECT_EQ(statuses[count], -3);
        EXPECT_EQ(answers[count].distance, 0) << "written behind the last one";
      }
    }
  });
}

TEST(CPoints, WithinBoundsAreThoseOfCpp) {
  test::for_each_tree([](const Tree& tree, const bxt_tree* c_tree) {
    test::Randoms randoms(tree);
    for (int i = 0; i < 60; ++i) {
      const Eigen::Vector3d point = randoms.point(1.5);
      const bxt_vec3 c_point = test::vec3(point);
      PointOptions options;
      if (i % 2 == 1) options.relative_error = 0.1;
      if (i % 4 == 1) options.absolute_error = 0.1 * randoms.size();
      if (i % 5 == 1) options.max_distance = 0.1 * randoms.size();
      if (i % 3 == 1) options.node_budget = static_cast<std::uint64_t>(i % 4);
      if (i == 9) options.relative_error = -1;
      bxt_approximation c = bxt_default_approximation();
      c.relative_error = options.relative_error;
      c.absolute_error = options.absolute_error;
      c.max_distance = options.max_distance;
      c.node_budget = options.node_budget;
      const Result<ApproximatePoint> found = closest_point(tree, point, options);
      Answer expected;
      note_error(found, expected);
      if (found) {
        expected.found.push_back(
            numbers_of_point(found->witness.value_or(ClosestPoint()), found->witness.has_value(),
                             found->converged, found->lower, found->upper, found->nodes_expanded));
      }
      const auto call = [&](bxt_closest_point* answer, bxt_error* error) {
        return bxt_tree_closest_point_within(c_tree, &c_point, i == 0 ? nullptr : &c, answer,
                                             error);
      };
      ASSERT_EQ(answer_of_call(call), expected);
    }
  });
}

}  // namespace
}  // namespace boxtree
