// SPDX-License-Identifier: MIT
// Casts and contacts of shapes by the C interface: the answers of the C++ interface.
#include <boxtree_c.h>
#include <cmath>
#include <cstring>
#include <span>
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
using test::Numbers;

template <class Handle>
struct Casts;
template <>
struct Casts<bxt_tree> {
  static constexpr auto closest = bxt_tree_cast_closest, any = bxt_tree_cast_any;
  static constexpr auto all = bxt_tree_cast_all;
  static constexpr auto collide = bxt_tree_collide;
};
template <>
struct Casts<bxt_scene> {
  static constexpr auto closest = bxt_scene_cast_closest, any = bxt_scene_cast_any;
  static constexpr auto all = bxt_scene_cast_all;
  static constexpr auto collide = bxt_scene_collide;
};
template <class Pointer>
using CastsOf = Casts<std::remove_const_t<std::remove_pointer_t<Pointer>>>;

template <class Hit>
Numbers numbers_of_hit(const Hit& hit, bool is_hit = true) {
  return Numbers() << is_hit << hit.initially_touching << hit.is_active
                   << static_cast<std::uint32_t>(hit.feature) << hit.t << hit.t_lower << hit.face
                   << test::instance_of(hit) << hit.triangle << hit.point << hit.normal
                   << hit.face_normal << std::uint32_t{hit.feature_index};
}
Numbers numbers_of_hit(const bxt_cast_hit& hit) {
  EXPECT_EQ(hit.reserved, 0u);
  return Numbers() << hit.is_hit << hit.initially_touching << hit.is_active
                   << std::uint32_t{hit.feature} << hit.t << hit.t_lower << hit.face << hit.triangle
                   << hit.point << hit.normal << hit.face_normal << hit.feature_index;
}

template <class Found>
Numbers numbers_of_contact(const Found& found) {
  return Numbers() << found.is_active << static_cast<std::uint32_t>(found.feature)
                   << std::uint32_t{found.feature_index} << found.face << test::instance_of(found)
                   << found.triangle << found.point << found.normal << found.face_normal
                   << found.depth;
}
Numbers numbers_of_contact(const bxt_contact& found) {
  return Numbers() << found.is_active << std::uint32_t{found.feature}
                   << std::uint32_t{found.feature_index} << found.face << found.triangle
                   << found.point << found.normal << found.face_normal << found.depth;
}

// By a function that finds one touch.
template <class Function, class Handle>
Answer one_touch(Function function, const Handle* subject, const bxt_shape& shape,
                 const bxt_motion& motion, const bxt_face_options* options) {
  return answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
    bxt_cast_hit hit = {};
    hit.struct_size = sizeof hit;
    hit.t = -5;
    const bxt_status status = function(subject, &shape, &motion, options, &hit, error);
    if (status == BXT_OK) {
      found.push_back(numbers_of_hit(hit));
    } else {
      EXPECT_EQ(hit.t, -5);
    }
    return status;
  });
}

template <class Result>
Answer touch_of(const Result& result) {
  Answer answer;
  note_error(result, answer);
  if (result.ok()) answer.found.push_back(numbers_of_hit(*result, result.has_value()));
  return answer;
}

double keep_touch(void* context, const bxt_cast_hit* hit) {
  EXPECT_EQ(hit->struct_size, sizeof *hit);
  static_cast<std::vector<Numbers>*>(context)->push_back(numbers_of_hit(*hit));
  return INFINITY;
}

TEST(CCasts, AreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = CastsOf<decltype(c_subject)>;
    test::Randoms randoms(subject);
    std::size_t touches = 0;
    test::for_each_face_options(subject, [&](const bxt_face_options* c, const auto& options) {
      for (int i = 0; i < 3; ++i) {
        Motion motion{randoms.point() - randoms.point(), i == 0 ? INFINITY : 1.0};
        if (i == 2) motion.direction.setZero();
        bxt_motion c_motion = bxt_motion_along(test::vec3(motion.direction));
        EXPECT_EQ(c_motion.t_max, 1);
        c_motion.t_max = motion.t_max;
        test::for_each_shape(
            randoms, randoms.size(), [&](const bxt_shape& c_shape, const auto& shape) {
              ASSERT_EQ(one_touch(Functions::closest, c_subject, c_shape, c_motion, c),
                        touch_of(cast_closest(subject, shape, motion, options)));
              ASSERT_EQ(one_touch(Functions::any, c_subject, c_shape, c_motion, c),
                        touch_of(cast_any(subject, shape, motion, options)));
              Answer all;
              const auto visit = [&](const auto& hit) {
                all.found.push_back(numbers_of_hit(hit));
                return INFINITY;
              };
              note_error(cast_all(subject, shape, motion, visit, options), all);
              touches += all.found.size();
              ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                          return Functions::all(c_subject, &c_shape, &c_motion, keep_touch, &found,
                                                c, error);
                        }),
                        all);
            });
      }
    });
    EXPECT_GT(touches, 50u);
  });
}

bool keep_contact(void* context, const bxt_contact* contact) {
  EXPECT_EQ(contact->struct_size, sizeof *contact);
  static_cast<std::vector<bxt_contact>*>(context)->push_back(*contact);
  return true;
}

TEST(CContacts, AreThoseOfCpp) {
  test::for_each_subject([](const auto& subject, const auto* c_subject) {
    using Functions = CastsOf<decltype(c_subject)>;
    using Found = std::conditional_t<std::is_same_v<std::decay_t<decltype(subject)>, Tree>, Contact,
                                     SceneContact>;
    test::Randoms randoms(subject);
    std::size_t count = 0, merged = 0;
    test::for_each_limits(subject, [&](const bxt_limits* c, const auto&... limits) {
      for (int i = 0; i < 3; ++i) {
        test::for_each_shape(
            randoms, randoms.size(), [&](const bxt_shape& c_shape, const auto& shape) {
              std::vector<Found> contacts;
              Answer expected;
              const auto visit = [&](const Found& contact) {
                contacts.push_back(contact);
                return true;
              };
              note_error(collide(subject, shape, visit, limits...), expected);
              std::vector<bxt_contact> c_contacts;
              ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>&) {
                          c_contacts.clear();
                          return Functions::collide(c_subject, &c_shape, keep_contact, &c_contacts,
                                                    c, error);
                        }),
                        expected);
              ASSERT_EQ(c_contacts.size(), contacts.size());
              const bxt_vec3 c_velocity = {1, -0.5, 0.25};
              for (std::size_t k = 0; k < contacts.size(); ++k) {
                ASSERT_EQ(numbers_of_contact(c_contacts[k]), numbers_of_contact(contacts[k]));
                ASSERT_EQ(Numbers() << bxt_contact_resolved_normal(&c_contacts[k], &c_velocity),
                          Numbers() << resolved_normal(contacts[k], {1, -0.5, 0.25}));
              }
              count += contacts.size();
              const double distance = 0.05 * randoms.size();
              const std::size_t kept = merge_contacts(std::span(contacts), distance, 0.9);
              std::size_t c_kept = 77;
              ASSERT_EQ(bxt_merge_contacts(c_contacts.data(), c_contacts.size(), distance, 0.9,
                                           &c_kept, nullptr),
                        BXT_OK);
              ASSERT_EQ(c_kept, kept);
              merged += contacts.size() - kept;
              for (std::size_t k = 0; k < kept; ++k) {
                ASSERT_EQ(numbers_of_contact(c_contacts[k]), numbers_of_contact(contacts[k]));
                ASSERT_EQ(c_contacts[k].struct_size, sizeof(bxt_contact));
              }
            });
      }
    });
    EXPECT_GT(count, 20u);
    EXPECT_GT(merged, 3u);
  });
}

// The first of two that are the same is shallower, and a third is another one.
TEST(CContacts, ThatAreMergedMoveWithWhatLiesBehindTheirMembers) {
  struct Longer {
    bxt_contact known = {};
    std::uint64_t later = 0;
  };
  std::vector<Longer> contacts(3);
  contacts[0].known.struct_size = sizeof(Longer);
  for (std::size_t i = 0; i < 3; ++i) {
    contacts[i].known.normal.z = 1;
    contacts[i].known.depth = static_cast<double>(i);
    contacts[i].later = i;
  }
  contacts[2].known.point.x = 1;
  std::size_t kept = 0;
  ASSERT_EQ(bxt_merge_contacts(&contacts[0].known, 3, 0.5, 0.999, &kept, nullptr), BXT_OK);
  ASSERT_EQ(kept, 2u);
  EXPECT_EQ(contacts[0].later, 1u);
  EXPECT_EQ(contacts[1].later, 2u);
  EXPECT_EQ(contacts[0].known.struct_size, sizeof(Longer));
  ASSERT_EQ(bxt_merge_contacts(nullptr, 0, 0.5, 0.999, &kept, nullptr), BXT_OK);
  EXPECT_EQ(kept, 0u);
}

TEST(CCasts, ResolvedNormalsAreThoseOfCpp) {
  const Eigen::Vector3d normal(0.6, 0, 0.8), face_normal(0, 0, 1), along(1, 0, 0);
  for (const bool is_active : {true, false}) {
    for (const Eigen::Vector3d& own : {normal, along}) {
      CastHit hit;
      hit.normal = own;
      hit.face_normal = face_normal;
      hit.is_active = is_active;
      bxt_cast_hit c_hit = {};
      c_hit.normal = test::vec3(own);
      c_hit.face_normal = test::vec3(face_normal);
      c_hit.is_active = is_active;
      for (const Eigen::Vector3d& velocity :
           {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, -1), Eigen::Vector3d(0, 0, 0)}) {
        const bxt_vec3 c_velocity = test::vec3(velocity);
        EXPECT_EQ(Numbers() << bxt_cast_hit_resolved_normal(&c_hit, &c_velocity),
                  Numbers() << resolved_normal(hit, velocity));
      }
    }
  }
}

}  // namespace
}  // namespace boxtree
