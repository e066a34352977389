// SPDX-License-Identifier: MIT
// Casts and what shapes touch where they are, in C.
#include <boxtree_c.h>
#include <cstddef>
#include <cstdint>
#include <limits>

#include <boxtree/boxtree.h>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/options.h"
#include "runtime/c/shape.h"
#include "runtime/query/collide_query.h"

using namespace boxtree;
using namespace boxtree::c;

namespace {

static_assert(BXT_FEATURE_FACE == static_cast<int>(Feature::kFace) &&
              BXT_FEATURE_EDGE == static_cast<int>(Feature::kEdge) &&
              BXT_FEATURE_VERTEX == static_cast<int>(Feature::kVertex));

bxt_cast_hit hit_of(const CastHit& hit, bool is_hit, std::uint32_t instance) {
  return {.is_hit = is_hit,
          .initially_touching = hit.initially_touching,
          .is_active = hit.is_active,
          .feature = static_cast<std::uint8_t>(hit.feature),
          .t = hit.t,
          .t_lower = hit.t_lower,
          .face = to_c(hit.face, instance),
          .triangle = hit.triangle,
          .point = to_c(hit.point),
          .normal = to_c(hit.normal),
          .face_normal = to_c(hit.face_normal),
          .feature_index = hit.feature_index};
}

bxt_contact contact_of(const Contact& contact, std::uint32_t instance) {
  return {.is_active = contact.is_active,
          .feature = static_cast<std::uint8_t>(contact.feature),
          .feature_index = contact.feature_index,
          .face = to_c(contact.face, instance),
          .triangle = contact.triangle,
          .point = to_c(contact.point),
          .normal = to_c(contact.normal),
          .face_normal = to_c(contact.face_normal),
          .depth = contact.depth};
}

// Calls `query(shape, motion, options)`.
template <class Handle, class Query>
bxt_status with_cast(const Handle* subject, const bxt_shape* shape, const bxt_motion* given,
                     const bxt_face_options* options, bxt_error* error, Query query) {
  if (const char* name = first_null("tree or scene", subject, "shape", shape, "motion", given)) {
    return refuse_null(error, name);
  }
  bxt_motion motion = {};
  if (!read_struct(given, motion)) return refuse(error, "motion: struct_size");
  if (motion.reserved != 0) return refuse(error, "motion: reserved");
  return guarded(error, [&] {
    return with_shape(shape, error, [&](const auto& read_shape) {
      return with_face_options<Handle>(options, error, [&](const auto& read) {
        return query(read_shape, Motion{to_cpp(motion.direction), motion.t_max}, read);
      });
    });
  });
}

template <class Handle, class One>
bxt_status one_touch(const Handle* subject, const bxt_shape* shape, const bxt_motion* motion,
                     const bxt_face_options* options, bxt_cast_hit* hit, bxt_error* error,
                     One one) {
  if (hit == nullptr) return refuse_null(error, "hit");
  if (!has_size(hit)) return refuse(error, "hit: struct_size");
  return with_cast(subject, shape, motion, options, error, [&](const auto&... read) {
    const auto result = one(subject->inside, read...);
    if (result.ok()) write_struct(hit, hit_of(*result, result.has_value(), instance_of(*result)));
    return finish(result, error);
  });
}

template <class Handle>
bxt_status every_touch(const Handle* subject, const bxt_shape* shape, const bxt_motion* motion,
                       bxt_cast_visitor visitor, void* context, const bxt_face_options* options,
                       bxt_error* error) {
  if (visitor == nullptr) return refuse_null(error, "visitor");
  return with_cast(
      subject, shape, motion, options, error,
      [&](const auto& read_shape, const Motion& read_motion, const auto& read_options) {
        const auto visit = [&](const auto& hit) {
          bxt_cast_hit shown = hit_of(hit, true, instance_of(hit));
          shown.struct_size = sizeof shown;
          return visitor(context, &shown);
        };
        return finish(cast_all(subject->inside, read_shape, read_motion, visit, read_options),
                      error);
      });
}

template <class Handle>
bxt_status every_contact(const Handle* subject, const bxt_shape* shape, bxt_contact_visitor visitor,
                         void* context, const bxt_limits* limits, bxt_error* error) {
  if (const char* name = first_null("tree or scene", subject, "shape", shape, "visitor", visitor)) {
    return refuse_null(error, name);
  }
  return guarded(error, [&] {
    return with_shape(shape, error, [&](const auto& read_shape) {
      return with_limits<Handle>(limits, error, [&](auto... read) {
        const auto visit = [&](const auto& contact) {
          bxt_contact shown = contact_of(contact, instance_of(contact));
          shown.struct_size = sizeof shown;
          return visitor(context, &shown);
        };
        return finish(collide(subject->inside, read_shape, visit, read...), error);
      });
    });
  });
}

// The overloads of a query as one object.
constexpr auto kCastClosest = [](const auto&... arguments) { return cast_closest(arguments...); };
constexpr auto kCastAny = [](const auto&... arguments) { return cast_any(arguments...); };

// What resolved_normal() looks at, of a touch or a contact.
template <class Touch, class Given>
bxt_vec3 resolve(const Given& given, const bxt_vec3& velocity) {
  Touch touch;
  touch.normal = to_cpp(given.normal);
  touch.face_normal = to_cpp(given.face_normal);
  touch.is_active = given.is_active;
  return to_c(resolved_normal(touch, to_cpp(velocity)));
}

}  // namespace

bxt_status bxt_tree_cast_closest(const bxt_tree* tree, const bxt_shape* shape,
                                 const bxt_motion* motion, const bxt_face_options* options,
                                 bxt_cast_hit* hit, bxt_error* error) {
  return one_touch(tree, shape, motion, options, hit, error, kCastClosest);
}

bxt_status bxt_tree_cast_any(const bxt_tree* tree, const bxt_shape* shape, const bxt_motion* motion,
                             const bxt_face_options* options, bxt_cast_hit* hit, bxt_error* error) {
  return one_touch(tree, shape, motion, options, hit, error, kCastAny);
}

bxt_status bxt_tree_cast_all(const bxt_tree* tree, const bxt_shape* shape, const bxt_motion* motion,
                             bxt_cast_visitor visitor, void* context,
                             const bxt_face_options* options, bxt_error* error) {
  return every_touch(tree, shape, motion, visitor, context, options, error);
}

bxt_status bxt_tree_collide(const bxt_tree* tree, const bxt_shape* shape,
                            bxt_contact_visitor visitor, void* context, const bxt_limits* limits,
                            bxt_error* error) {
  return every_contact(tree, shape, visitor, context, limits, error);
}

bxt_vec3 bxt_cast_hit_resolved_normal(const bxt_cast_hit* hit, const bxt_vec3* velocity) {
  return resolve<CastHit>(*hit, *velocity);
}

bxt_vec3 bxt_contact_resolved_normal(const bxt_contact* contact, const bxt_vec3* velocity) {
  return resolve<Contact>(*contact, *velocity);
}

bxt_status bxt_merge_contacts(bxt_contact* contacts, size_t count, double distance, double cosine,
                              size_t* kept, bxt_error* error) {
  if (kept == nullptr) return refuse_null(error, "kept");
  if (count > 0 && contacts == nullptr) return refuse_null(error, "contacts");
  if (count > 0 && !has_size(contacts)) return refuse(error, "contacts: struct_size");
  if (count == 0) {
    *kept = 0;
    return BXT_OK;
  }
  const Elements<bxt_contact> elements(contacts);
  *kept = merge(
      count, distance, cosine,
      [&](std::size_t i) {
        const bxt_contact& contact = elements[i];
        return MergedContact{to_cpp(contact.point), to_cpp(contact.normal), contact.depth};
      },
      [&](std::size_t i) { elements[i].depth = std::numeric_limits<double>::quiet_NaN(); },
      [&](std::size_t from, std::size_t to) { elements.move(from, to); });
  return BXT_OK;
}

bxt_status bxt_scene_cast_closest(const bxt_scene* scene, const bxt_shape* shape,
                                  const bxt_motion* motion, const bxt_face_options* options,
                                  bxt_cast_hit* hit, bxt_error* error) {
  return one_touch(scene, shape, motion, options, hit, error, kCastClosest);
}

bxt_status bxt_scene_cast_any(const bxt_scene* scene, const bxt_shape* shape,
                              const bxt_motion* motion, const bxt_face_options* options,
                              bxt_cast_hit* hit, bxt_error* error) {
  return one_touch(scene, shape, motion, options, hit, error, kCastAny);
}

bxt_status bxt_scene_cast_all(const bxt_scene* scene, const bxt_shape* shape,
                              const bxt_motion* motion, bxt_cast_visitor visitor, void* context,
                              const bxt_face_options* options, bxt_error* error) {
  return every_touch(scene, shape, motion, visitor, context, options, error);
}

bxt_status bxt_scene_collide(const bxt_scene* scene, const bxt_shape* shape,
                             bxt_contact_visitor visitor, void* context, const bxt_limits* limits,
                             bxt_error* error) {
  return every_contact(scene, shape, visitor, context, limits, error);
}
