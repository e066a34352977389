// SPDX-License-Identifier: MIT
// Two bodies by the C interface: the answers of the C++ interface.
#include <boxtree_c.h>
#include <cmath>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/unit/c/options.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

using test::Answer;
using test::answer_of_c;
using test::Numbers;

Numbers numbers_of_pair(const FacePair& pair) {
  return Numbers() << pair.first << std::uint32_t{BXT_NO_INSTANCE} << pair.second
                   << std::uint32_t{BXT_NO_INSTANCE};
}
Numbers numbers_of_pair(const ScenePair& pair) {
  return Numbers() << pair.first.face << pair.first.instance << pair.second.face
                   << pair.second.instance;
}
bool keep_pair(void* context, const bxt_face* first, const bxt_face* second) {
  static_cast<std::vector<Numbers>*>(context)->push_back(Numbers() << *first << *second);
  return true;
}
bool keep_one_pair(void* context, const bxt_face* first, const bxt_face* second) {
  return !keep_pair(context, first, second);
}

Numbers numbers_of_contact(const PairContact& contact, std::uint32_t first = BXT_NO_INSTANCE,
                           std::uint32_t second = BXT_NO_INSTANCE) {
  return Numbers() << contact.faces.first << first << contact.faces.second << second
                   << contact.first_triangle << contact.second_triangle << contact.start
                   << contact.end << contact.point << contact.normal << contact.depth;
}
Numbers numbers_of_contact(const ScenePairContact& contact) {
  return numbers_of_contact(contact, contact.first_instance, contact.second_instance);
}
bool keep_contact(void* context, const bxt_pair_contact* contact) {
  EXPECT_EQ(contact->struct_size, sizeof *contact);
  EXPECT_EQ(contact->reserved, 0u);
  static_cast<std::vector<Numbers>*>(context)->push_back(
      Numbers() << contact->first << contact->second << contact->first_triangle
                << contact->second_triangle << contact->start << contact->end << contact->point
                << contact->normal << contact->depth);
  return true;
}

// What a query of C++ visits: `query(visit)`.
template <class Query>
Answer pairs(const Query& query) {
  Answer answer;
  note_error(query([&](const auto& pair) {
               answer.found.push_back(numbers_of_pair(pair));
               return true;
             }),
             answer);
  return answer;
}
template <class Query>
Answer contacts_by(const Query& query) {
  Answer answer;
  note_error(query([&](const auto& contact) {
               answer.found.push_back(numbers_of_contact(contact));
               return true;
             }),
             answer);
  return answer;
}
template <class Call>
Answer told(const Call& call) {
  return answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
    return call(static_cast<void*>(&found), error);
  });
}

Answer answer_of(bxt_status status, const bxt_overlap_answer& said, std::vector<Numbers>& found) {
  if (status == BXT_OK) {
    found.push_back(Numbers() << said.overlap << said.first << said.second << said.nodes_expanded);
  }
  return {};
}

class CPairs : public testing::Test {
 protected:
  // Calls `body` with trees of each kind and one that is smaller, at random poses.
  template <class Body>
  void for_each_pair(const Body& body) {
    const test::CookedTree other = test::cook_tree(test::torus(8, 6), CodecId::kWide8);
    const test::CFile c_file = test::open_c(other.bytes);
    const test::CTree c_other = test::bind_c(c_file);
    test::for_each_tree([&](const Tree& tree, const bxt_tree* c_tree) {
      test::Randoms randoms(tree);
      for (int i = 0; i < 12; ++i) {
        SCOPED_TRACE(i);
        Pose first = i % 3 == 0 ? Pose::Identity() : randoms.pose(), second = randoms.pose();
        second.linear() *= 0.3 * randoms.size();
        if (i == 7) second.linear().setZero();
        const bxt_pose c_first = test::pose_of(first), c_second = test::pose_of(second);
        body(tree, first, other.tree, second, c_tree, i % 3 == 0 ? nullptr : &c_first,
             c_other.get(), &c_second);
        if (HasFatalFailure()) return;
      }
    });
  }
};

TEST_F(CPairs, OfTwoTreesAreThoseOfCpp) {
  std::size_t count = 0;
  for_each_pair([&](const Tree& a, const Pose& pa, const Tree& b, const Pose& pb,
                    const bxt_tree* ca, const bxt_pose* cpa, const bxt_tree* cb,
                    const bxt_pose* cpb) {
    test::for_each_limits(a, [&](const bxt_limits* c, const QueryLimits& limits) {
      const Answer expected =
          pairs([&](const auto& visit) { return overlap_pairs(a, pa, b, pb, visit, limits); });
      count += expected.found.size();
      ASSERT_EQ(told([&](void* context, bxt_error* error) {
                  return bxt_tree_overlap_pairs(ca, cpa, cb, cpb, keep_pair, context, c, error);
                }),
                expected);
      ASSERT_EQ(told([&](void* context, bxt_error* error) {
                  return bxt_tree_pair_contacts(ca, cpa, cb, cpb, keep_contact, context, c, error);
                }),
                contacts_by(
                    [&](const auto& visit) { return pair_contacts(a, pa, b, pb, visit, limits); }));

      const QueryResult<FacePair> first = first_contact(a, pa, b, pb, limits);
      Answer some;
      note_error(first, some);
      if (first.ok()) {
        const Overlap overlap = first ? Overlap::kOverlapping : Overlap::kDisjoint;
        some.found.push_back(Numbers() << static_cast<std::uint32_t>(overlap));
        const Numbers faces = numbers_of_pair(*first);
        some.found.back().insert(some.found.back().end(), faces.begin(), faces.end());
        some.found.back() << std::uint64_t{0};
      }
      ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                  bxt_overlap_answer answer = {};
                  answer.struct_size = sizeof answer;
                  const bxt_status status =
                      bxt_tree_first_contact(ca, cpa, cb, cpb, c, &answer, error);
                  answer_of(status, answer, found);
                  return status;
                }),
                some);
    });
    std::vector<Numbers> one;
    const bxt_status stopped =
        bxt_tree_overlap_pairs(ca, cpa, cb, cpb, keep_one_pair, &one, nullptr, nullptr);
    EXPECT_LE(one.size(), stopped == BXT_OK ? 1u : 0u);
  });
  EXPECT_GT(count, 100u);
}

TEST_F(CPairs, OverlapsWithinADistanceAreThoseOfCpp) {
  for_each_pair([&](const Tree& a, const Pose& pa, const Tree& b, const Pose& pb,
                    const bxt_tree* ca, const bxt_pose* cpa, const bxt_tree* cb,
                    const bxt_pose* cpb) {
    for (const double distance : {0.0, 0.1, -1.0}) {
      for (const std::uint64_t budget : {std::uint64_t{1}, std::uint64_t{BXT_UNLIMITED}}) {
        const Result<PairOverlap> found = overlap_within(a, pa, b, pb, distance, budget);
        Answer expected;
        note_error(found, expected);
        if (found) {
          expected.found.push_back(Numbers() << static_cast<std::uint32_t>(found->overlap));
          const Numbers faces = numbers_of_pair(found->contact.value_or(FacePair()));
          expected.found[0].insert(expected.found[0].end(), faces.begin(), faces.end());
          expected.found[0] << found->nodes_expanded;
        }
        ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& told) {
                    bxt_overlap_answer answer = {};
                    answer.struct_size = sizeof answer;
                    const bxt_status status =
                        bxt_tree_overlap_within(ca, cpa, cb, cpb, distance, budget, &answer, error);
                    answer_of(status, answer, told);
                    return status;
                  }),
                  expected);
      }
    }
  });
}

// Compares distances with options that end them in several ways: `of_cpp(options)` and
// `of_c(options, answer, error)`.
template <class OfCpp, class OfC>
void expect_same_distances(const OfCpp& of_cpp, const OfC& of_c) {
  for (const int kind : {0, 1, 2, 3}) {
    DistanceOptions options;
    if (kind == 1) options.relative_error = 0.1;
    if (kind == 2) options.node_budget = 2;
    if (kind == 3) options.max_distance = 0;
    bxt_approximation c = bxt_default_approximation();
    c.relative_error = options.relative_error;
    c.node_budget = options.node_budget;
    c.max_distance = options.max_distance;
    const auto found = of_cpp(options);
    Answer expected;
    note_error(found, expected);
    if (found) {
      const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
      using Witness = std::decay_t<decltype(*found->witness)>;
      const Witness witness = found->witness.value_or(Witness{{}, zero, zero});
      Numbers numbers = Numbers() << found->converged << found->witness.has_value() << found->lower
                                  << found->upper;
      const Numbers faces = numbers_of_pair(witness.faces);
      numbers.insert(numbers.end(), faces.begin(), faces.end());
      expected.found.push_back(numbers << witness.first << witness.second << found->nodes_expanded);
    }
    ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& told) {
                bxt_distance answer = {};
                answer.struct_size = sizeof answer;
                answer.lower = -5;
                const bxt_status status = of_c(kind == 0 ? nullptr : &c, &answer, error);
                if (status != BXT_OK) {
                  EXPECT_EQ(answer.lower, -5);
                  return status;
                }
                told.push_back(Numbers() << answer.converged << answer.is_found << answer.lower
                                         << answer.upper << answer.first << answer.second
                                         << answer.first_point << answer.second_point
                                         << answer.nodes_expanded);
                return status;
              }),
              expected);
  }
}

TEST_F(CPairs, DistancesAreThoseOfCpp) {
  for_each_pair([&](const Tree& a, const Pose& pa, const Tree& b, const Pose& pb,
                    const bxt_tree* ca, const bxt_pose* cpa, const bxt_tree* cb,
                    const bxt_pose* cpb) {
    expect_same_distances(
        [&](const DistanceOptions& options) { return distance(a, pa, b, pb, options); },
        [&](auto... rest) { return bxt_tree_distance(ca, cpa, cb, cpb, rest...); });
  });
}

TEST(CSceneDistances, AreThoseOfCpp) {
  const test::CookedTree body = test::cook_tree(test::torus(8, 6), CodecId::kWide8);
  const test::CFile c_file = test::open_c(body.bytes);
  const test::CTree c_body = test::bind_c(c_file);
  test::for_each_scene([&](const Scene& scene, const bxt_scene* c_scene) {
    for (const double shift : {0.0, 3.0, 40.0}) {
      Pose pose = Pose::Identity();
      pose.translation().x() = shift;
      const bxt_pose c_pose = test::pose_of(pose);
      for (const LayerMask layers : {kAllLayers, LayerMask{1}, LayerMask{0}}) {
        expect_same_distances(
            [&](const DistanceOptions& options) {
              return distance(scene, body.tree, pose, layers, options);
            },
            [&](auto... rest) {
              return bxt_scene_distance(c_scene, c_body.get(), &c_pose, layers, rest...);
            });
      }
    }
    Pose flat = Pose::Identity();
    flat.linear().setZero();
    const bxt_pose c_flat = test::pose_of(flat);
    expect_same_distances(
        [&](const DistanceOptions& options) {
          return distance(scene, body.tree, flat, kAllLayers, options);
        },
        [&](auto... rest) {
          return bxt_scene_distance(c_scene, c_body.get(), &c_flat, BXT_ALL_LAYERS, rest...);
        });
    for (const std::uint32_t instance : {0u, 3u, 1000u}) {
      expect_same_distances(
          [&](const DistanceOptions& options) { return distance_of(scene, instance, options); },
          [&](auto... rest) { return bxt_scene_distance_of(c_scene, instance, rest...); });
    }
  });
}

TEST(CScenePairs, AreThoseOfCpp) {
  const test::CookedTree body = test::cook_tree(test::torus(8, 6), CodecId::kWide8);
  const test::CFile c_file = test::open_c(body.bytes);
  const test::CTree c_body = test::bind_c(c_file);
  std::size_t count = 0;
  test::for_each_scene([&](const Scene& scene, const bxt_scene* c_scene) {
    for (const std::uint64_t nodes : {std::uint64_t{5}, std::uint64_t{BXT_UNLIMITED}}) {
      bxt_limits c = bxt_default_limits();
      c.nodes = nodes;
      const QueryLimits limits{nodes};
      const Answer all = pairs([&](const auto& visit) { return contacts(scene, visit, limits); });
      count += all.found.size();
      ASSERT_EQ(told([&](void* context, bxt_error* error) {
                  return bxt_scene_contacts(c_scene, keep_pair, context, &c, error);
                }),
                all);
      ASSERT_EQ(
          told([&](void* context, bxt_error* error) {
            return bxt_scene_pair_contacts(c_scene, keep_contact, context, &c, error);
          }),
          contacts_by([&](const auto& visit) { return pair_contacts(scene, visit, limits); }));
      for (const std::uint32_t instance : {0u, 3u, 1000u}) {
        ASSERT_EQ(
            told([&](void* context, bxt_error* error) {
              return bxt_scene_contacts_of(c_scene, instance, keep_pair, context, &c, error);
            }),
            pairs([&](const auto& visit) { return contacts_of(scene, instance, visit, limits); }));
        ASSERT_EQ(told([&](void* context, bxt_error* error) {
                    return bxt_scene_pair_contacts_of(c_scene, instance, keep_contact, context, &c,
                                                      error);
                  }),
                  contacts_by([&](const auto& visit) {
                    return pair_contacts_of(scene, instance, visit, limits);
                  }));
      }
    }
    test::for_each_limits(scene, [&](const bxt_limits* c, const auto&... limits) {
      Pose pose = Pose::Identity();
      pose.linear() *= 3;
      const bxt_pose c_pose = test::pose_of(pose);
      ASSERT_EQ(told([&](void* context, bxt_error* error) {
                  return bxt_scene_overlap_pairs(c_scene, c_body.get(), &c_pose, keep_pair, context,
                                                 c, error);
                }),
                pairs([&](const auto& visit) {
                  return overlap_pairs(scene, body.tree, pose, visit, limits...);
                }));
      ASSERT_EQ(told([&](void* context, bxt_error* error) {
                  return bxt_scene_pair_contacts_with(c_scene, c_body.get(), &c_pose, keep_contact,
                                                      context, c, error);
                }),
                contacts_by([&](const auto& visit) {
                  return pair_contacts(scene, body.tree, pose, visit, limits...);
                }));
    });
    // These are about all layers.
    bxt_limits of_layer = bxt_default_limits();
    of_layer.layers = 1;
    bxt_error error = {};
    error.struct_size = sizeof error;
    std::vector<Numbers> found;
    EXPECT_EQ(bxt_scene_contacts(c_scene, keep_pair, &found, &of_layer, &error), BXT_INVALID_QUERY);
    EXPECT_STREQ(error.message, "invalid_query: limits: layers, of which this query takes all");
    EXPECT_EQ(bxt_scene_pair_contacts_of(c_scene, 0, keep_contact, &found, &of_layer, nullptr),
              BXT_INVALID_QUERY);
  });
  EXPECT_GT(count, 50u);
}

}  // namespace
}  // namespace boxtree
