// SPDX-License-Identifier: MIT
// Two bodies: pairs of faces that touch, where they touch, how far apart they are; in C.
#include <boxtree_c.h>
#include <cstdint>

#include <boxtree/boxtree.h>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/options.h"

using namespace boxtree;
using namespace boxtree::c;

namespace {

bxt_face face_of(const FaceRef& face) {
  return to_c(face);
}
bxt_face face_of(const SceneFace& face) {
  return to_c(face);
}

// A visitor of pairs of faces, of trees as of scenes.
struct PairsTo {
  bxt_pair_visitor visitor;
  void* context;

  template <class Pair>
  bool operator()(const Pair& pair) const {
    const bxt_face first = face_of(pair.first);
    const bxt_face second = face_of(pair.second);
    return visitor(context, &first, &second);
  }
};

// The instances of both sides.
std::uint32_t first_instance(const PairContact&) {
  return BXT_NO_INSTANCE;
}
std::uint32_t second_instance(const PairContact&) {
  return BXT_NO_INSTANCE;
}
std::uint32_t first_instance(const ScenePairContact& contact) {
  return contact.first_instance;
}
std::uint32_t second_instance(const ScenePairContact& contact) {
  return contact.second_instance;
}

// The same of pairs of triangles.
struct ContactsTo {
  bxt_pair_contact_visitor visitor;
  void* context;

  template <class Found>
  bool operator()(const Found& contact) const {
    const bxt_pair_contact shown = {.struct_size = sizeof(bxt_pair_contact),
                                    .first_triangle = contact.first_triangle,
                                    .second_triangle = contact.second_triangle,
                                    .reserved = 0,
                                    .first = to_c(contact.faces.first, first_instance(contact)),
                                    .second = to_c(contact.faces.second, second_instance(contact)),
                                    .start = to_c(contact.start),
                                    .end = to_c(contact.end),
                                    .point = to_c(contact.point),
                                    .normal = to_c(contact.normal),
                                    .depth = contact.depth};
    return visitor(context, &shown);
  }
};

void write_answer(bxt_overlap_answer* answer, Overlap overlap, const FacePair& faces,
                  std::uint64_t nodes) {
  write_struct(answer, {.overlap = static_cast<std::uint32_t>(overlap),
                        .first = to_c(faces.first),
                        .second = to_c(faces.second),
                        .nodes_expanded = nodes});
}

// Two trees and what is done with their pairs: `query(limits)`.
template <class Query>
bxt_status with_trees(const bxt_tree* first, const bxt_tree* second, const bxt_limits* limits,
                      bxt_error* error, Query query) {
  if (const char* name = first_null("first", first, "second", second))
    return refuse_null(error, name);
  return guarded(error, [&] { return with_limits<bxt_tree>(limits, error, query); });
}

}  // namespace

bxt_status bxt_tree_overlap_pairs(const bxt_tree* first, const bxt_pose* first_pose,
                                  const bxt_tree* second, const bxt_pose* second_pose,
                                  bxt_pair_visitor visitor, void* context, const bxt_limits* limits,
                                  bxt_error* error) {
  if (visitor == nullptr) return refuse_null(error, "visitor");
  return with_trees(first, second, limits, error, [&](const QueryLimits& read) {
    const PairsTo visit{visitor, context};
    return finish(overlap_pairs(first->inside, to_cpp(first_pose), second->inside,
                                to_cpp(second_pose), visit, read),
                  error);
  });
}

bxt_status bxt_tree_first_contact(const bxt_tree* first, const bxt_pose* first_pose,
                                  const bxt_tree* second, const bxt_pose* second_pose,
                                  const bxt_limits* limits, bxt_overlap_answer* answer,
                                  bxt_error* error) {
  if (answer == nullptr) return refuse_null(error, "answer");
  if (!has_size(answer)) return refuse(error, "answer: struct_size");
  return with_trees(first, second, limits, error, [&](const QueryLimits& read) {
    const QueryResult<FacePair> found =
        first_contact(first->inside, to_cpp(first_pose), second->inside, to_cpp(second_pose), read);
    if (found.ok())
      write_answer(answer, found ? Overlap::kOverlapping : Overlap::kDisjoint, *found, 0);
    return finish(found, error);
  });
}

bxt_status bxt_tree_overlap_within(const bxt_tree* first, const bxt_pose* first_pose,
                                   const bxt_tree* second, const bxt_pose* second_pose,
                                   double distance, uint64_t node_budget,
                                   bxt_overlap_answer* answer, bxt_error* error) {
  if (const char* name = first_null("first", first, "second", second, "answer", answer))
    return refuse_null(error, name);
  if (!has_size(answer)) return refuse(error, "answer: struct_size");
  return guarded(error, [&] {
    const Result<PairOverlap> found =
        overlap_within(first->inside, to_cpp(first_pose), second->inside, to_cpp(second_pose),
                       distance, node_budget);
    if (found)
      write_answer(answer, found->overlap, found->contact.value_or(FacePair{}),
                   found->nodes_expanded);
    return finish(found, error);
  });
}

bxt_status bxt_tree_pair_contacts(const bxt_tree* first, const bxt_pose* first_pose,
                                  const bxt_tree* second, const bxt_pose* second_pose,
                                  bxt_pair_contact_visitor visitor, void* context,
                                  const bxt_limits* limits, bxt_error* error) {
  if (visitor == nullptr) return refuse_null(error, "visitor");
  return with_trees(first, second, limits, error, [&](const QueryLimits& read) {
    const ContactsTo visit{visitor, context};
    return finish(pair_contacts(first->inside, to_cpp(first_pose), second->inside,
                                to_cpp(second_pose), visit, read),
                  error);
  });
}

namespace {

// `query(options)` is a Distance or a SceneDistance.
template <class Query>
bxt_status find_distance(const bxt_approximation* options, bxt_distance* distance, bxt_error* error,
                         Query query) {
  if (!has_size(distance)) return refuse(error, "distance: struct_size");
  return guarded(error, [&] {
    return with_approximation(options, error, [&](const DistanceOptions& read) {
      const auto found = query(read);
      if (!found) return finish(found, error);
      bxt_distance shown = {.struct_size = 0,
                            .converged = found->converged,
                            .is_found = found->witness.has_value(),
                            .lower = found->lower,
                            .upper = found->upper,
                            .first = to_c(FaceRef{}),
                            .second = to_c(FaceRef{}),
                            .first_point = {},
                            .second_point = {},
                            .nodes_expanded = found->nodes_expanded};
      if (found->witness) {
        shown.first = face_of(found->witness->faces.first);
        shown.second = face_of(found->witness->faces.second);
        shown.first_point = to_c(found->witness->first);
        shown.second_point = to_c(found->witness->second);
      }
      write_struct(distance, shown);
      return finish(found, error);
    });
  });
}

}  // namespace

bxt_status bxt_tree_distance(const bxt_tree* first, const bxt_pose* first_pose,
                             const bxt_tree* second, const bxt_pose* second_pose,
                             const bxt_approximation* options, bxt_distance* distance,
                             bxt_error* error) {
  if (const char* name = first_null("first", first, "second", second, "distance", distance)) {
    return refuse_null(error, name);
  }
  return find_distance(options, distance, error, [&](const DistanceOptions& read) {
    return boxtree::distance(first->inside, to_cpp(first_pose), second->inside, to_cpp(second_pose),
                             read);
  });
}

bxt_status bxt_scene_distance(const bxt_scene* scene, const bxt_tree* tree, const bxt_pose* pose,
                              uint32_t layers, const bxt_approximation* options,
                              bxt_distance* distance, bxt_error* error) {
  if (const char* name = first_null("scene", scene, "tree", tree, "distance", distance)) {
    return refuse_null(error, name);
  }
  return find_distance(options, distance, error, [&](const DistanceOptions& read) {
    return boxtree::distance(scene->inside, tree->inside, to_cpp(pose), layers, read);
  });
}

bxt_status bxt_scene_distance_of(const bxt_scene* scene, uint32_t instance,
                                 const bxt_approximation* options, bxt_distance* distance,
                                 bxt_error* error) {
  if (const char* name = first_null("scene", scene, "distance", distance)) {
    return refuse_null(error, name);
  }
  return find_distance(options, distance, error, [&](const DistanceOptions& read) {
    return boxtree::distance_of(scene->inside, instance, read);
  });
}

namespace {

// What visits pairs of a scene: `query(visit, limits)`.
template <class Visit, class Function, class Query>
bxt_status visit_pairs(const bxt_scene* scene, Function visitor, void* context,
                       const bxt_limits* limits, bxt_error* error, Query query) {
  if (const char* name = first_null("scene", scene, "visitor", visitor))
    return refuse_null(error, name);
  return guarded(error, [&] {
    return with_nodes(limits, error, [&](const QueryLimits& read) {
      const Visit visit{visitor, context};
      return finish(query(visit, read), error);
    });
  });
}

// The same of a scene and a tree: `query(visit, layers, limits)`.
template <class Visit, class Function, class Query>
bxt_status visit_pairs_with(const bxt_scene* scene, const bxt_tree* tree, Function visitor,
                            void* context, const bxt_limits* limits, bxt_error* error,
                            Query query) {
  if (const char* name = first_null("scene", scene, "tree", tree, "visitor", visitor))
    return refuse_null(error, name);
  return guarded(error, [&] {
    return with_limits<bxt_scene>(limits, error, [&](auto... read) {
      const Visit visit{visitor, context};
      return finish(query(visit, read...), error);
    });
  });
}

}  // namespace

bxt_status bxt_scene_contacts(const bxt_scene* scene, bxt_pair_visitor visitor, void* context,
                              const bxt_limits* limits, bxt_error* error) {
  return visit_pairs<PairsTo>(scene, visitor, context, limits, error, [&](const auto&... read) {
    return contacts(scene->inside, read...);
  });
}

bxt_status bxt_scene_contacts_of(const bxt_scene* scene, uint32_t instance,
                                 bxt_pair_visitor visitor, void* context, const bxt_limits* limits,
                                 bxt_error* error) {
  return visit_pairs<PairsTo>(scene, visitor, context, limits, error, [&](const auto&... read) {
    return contacts_of(scene->inside, instance, read...);
  });
}

bxt_status bxt_scene_overlap_pairs(const bxt_scene* scene, const bxt_tree* tree,
                                   const bxt_pose* pose, bxt_pair_visitor visitor, void* context,
                                   const bxt_limits* limits, bxt_error* error) {
  return visit_pairs_with<PairsTo>(
      scene, tree, visitor, context, limits, error, [&](const auto&... read) {
        return overlap_pairs(scene->inside, tree->inside, to_cpp(pose), read...);
      });
}

bxt_status bxt_scene_pair_contacts(const bxt_scene* scene, bxt_pair_contact_visitor visitor,
                                   void* context, const bxt_limits* limits, bxt_error* error) {
  return visit_pairs<ContactsTo>(scene, visitor, context, limits, error, [&](const auto&... read) {
    return pair_contacts(scene->inside, read...);
  });
}

bxt_status bxt_scene_pair_contacts_of(const bxt_scene* scene, uint32_t instance,
                                      bxt_pair_contact_visitor visitor, void* context,
                                      const bxt_limits* limits, bxt_error* error) {
  return visit_pairs<ContactsTo>(scene, visitor, context, limits, error, [&](const auto&... read) {
    return pair_contacts_of(scene->inside, instance, read...);
  });
}

bxt_status bxt_scene_pair_contacts_with(const bxt_scene* scene, const bxt_tree* tree,
                                        const bxt_pose* pose, bxt_pair_contact_visitor visitor,
                                        void* context, const bxt_limits* limits, bxt_error* error) {
  return visit_pairs_with<ContactsTo>(
      scene, tree, visitor, context, limits, error, [&](const auto&... read) {
        return pair_contacts(scene->inside, tree->inside, to_cpp(pose), read...);
      });
}
