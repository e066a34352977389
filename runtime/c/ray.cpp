// SPDX-License-Identifier: MIT
// Rays through trees and scenes, in C.
#include <algorithm>
#include <array>
#include <boxtree_c.h>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>

#include <boxtree/boxtree.h>

#include "runtime/c/batch.h"
#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/options.h"
#include "runtime/query/nearest_hits.h"
#if BOXTREE_HAS_SCENE_QUERIES
#include "runtime/scene/nearest_scene_hits.h"
#endif

using namespace boxtree;
using namespace boxtree::c;

namespace {

bxt_ray_hit hit_of(const RayHit& hit, bool is_hit, std::uint32_t instance) {
  return {sizeof(bxt_ray_hit), is_hit, hit.t, to_c(hit.face, instance),
          hit.triangle,        hit.u,  hit.v, to_c(hit.point),
          to_c(hit.normal)};
}

// The hits of what is queried.
template <class Handle>
struct HitOf;
template <>
struct HitOf<bxt_tree> {
  using Type = RayHit;
};
#if BOXTREE_HAS_SCENE_QUERIES
template <>
struct HitOf<bxt_scene> {
  using Type = SceneRayHit;
};
#endif

template <class Hit>
bxt_ray_hit hit_of(const QueryResult<Hit>& result) {
  return hit_of(*result, result.has_value(), instance_of(*result));
}

template <class Handle, class Query>
bxt_status one_hit(const Handle* subject, const bxt_ray* ray, const bxt_face_options* options,
                   bxt_ray_hit* hit, bxt_error* error, Query query) {
  if (const char* name = first_null("tree or scene", subject, "ray", ray, "hit", hit))
    return refuse_null(error, name);
  if (!has_size(hit)) return refuse(error, "hit: struct_size");
  return guarded(error, [&] {
    return with_face_options<Handle>(options, error, [&](const auto& read) {
      const auto result = query(subject->inside, to_cpp(*ray), read);
      if (result.ok()) write_struct(hit, hit_of(result));
      return finish(result, error);
    });
  });
}

template <class Handle>
bxt_status every_hit(const Handle* subject, const bxt_ray* ray, bxt_ray_visitor visitor,
                     void* context, const bxt_face_options* options, bxt_error* error) {
  if (const char* name = first_null("tree or scene", subject, "ray", ray, "visitor", visitor)) {
    return refuse_null(error, name);
  }
  return guarded(error, [&] {
    return with_face_options<Handle>(options, error, [&](const auto& read) {
      const auto visit = [&](const auto& hit) {
        const bxt_ray_hit shown = hit_of(hit, true, instance_of(hit));
        return visitor(context, &shown);
      };
      return finish(all_hits(subject->inside, to_cpp(*ray), visit, read), error);
    });
  });
}

// Room for hits in a caller's array, as HitRoom; read() answers what decides their order.
template <class Hit>
class ArrayRoom {
 public:
  ArrayRoom(bxt_ray_hit* hits, std::size_t size) noexcept : size_(size) {
    if (size > 0) hits_.emplace(hits);
  }

  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] Hit read(std::size_t i) const noexcept {
    const bxt_ray_hit& stored = (*hits_)[i];
    Hit hit;
    hit.t = stored.t;
    hit.face = face_ref(stored.face);
    hit.triangle = stored.triangle;
    if constexpr (requires { hit.instance; }) hit.instance = stored.face.instance;
    return hit;
  }
  void write(std::size_t i, const Hit& hit) const noexcept {
    hits_->write(i, hit_of(hit, true, instance_of(hit)));
  }
  void move(std::size_t from, std::size_t to) const noexcept { hits_->write(to, (*hits_)[from]); }

  /// Says of what no hit came for that it is none.
  void clear_from(std::size_t begin) const noexcept {
    for (std::size_t i = begin; i < size_; ++i) {
      const Hit none;
      hits_->write(i, hit_of(none, false, instance_of(none)));
    }
  }

 private:
  std::optional<Elements<bxt_ray_hit>> hits_;
  std::size_t size_;
};

template <class Handle>
bxt_status nearest(const Handle* subject, const bxt_ray* ray, bxt_ray_hit* hits,
                   std::size_t capacity, std::size_t* count, const bxt_face_options* options,
                   bxt_error* error) {
  using Hit = typename HitOf<Handle>::Type;
  if (const char* name = first_null("tree or scene", subject, "ray", ray, "count", count))
    return refuse_null(error, name);
  if (capacity > 0 && hits == nullptr) return refuse_null(error, "hits");
  if (capacity > 0 && !has_size(hits)) return refuse(error, "hits: struct_size");
  return guarded(error, [&] {
    return with_face_options<Handle>(options, error, [&](const auto& read) {
      const ArrayRoom<Hit> room(hits, capacity);
      const Result<std::size_t> found = first_hits(subject->inside, to_cpp(*ray), room, read);
      if (found) *count = *found;
      if (found) room.clear_from(*found);
      return finish(found, error);
    });
  });
}

template <class Handle, class One, class Many>
bxt_status many_hits(const Handle* subject, const bxt_ray* rays, std::size_t count,
                     bxt_ray_hit* hits, bxt_status* statuses, const bxt_face_options* options,
                     bxt_error* error, One one, Many many) {
  if (subject == nullptr) return refuse_null(error, "tree or scene");
  if (count == 0) return BXT_OK;
  if (const char* name = first_null("rays", rays, "hits", hits)) return refuse_null(error, name);
  if (!has_size(hits)) return refuse(error, "hits: struct_size");
  return guarded(error, [&] {
    return with_face_options<Handle>(options, error, [&](const auto& read) {
      BatchAnswers<bxt_ray_hit> answers(hits, statuses, error);
      const auto write = [&](std::size_t i, const auto& result) {
        answers.write(i, hit_of(result), result);
      };
      if constexpr (std::is_same_v<Handle, bxt_tree>) {
        answer_in_chunks<RayResult>(
            count, [&](std::size_t i) { return to_cpp(rays[i]); },
            [&](std::size_t, auto chunk, auto results) {
              return many(subject->inside, chunk, results, read);
            },
            write);
      } else {
        // A scene answers rays one by one, be there a batch or not.
        for (std::size_t i = 0; i < count; ++i)
          write(i, one(subject->inside, to_cpp(rays[i]), read));
      }
      return answers.first_error();
    });
  });
}

// The overloads of a query as one object.
constexpr auto kClosestHit = [](const auto& inside, const Ray& ray, const auto& options) {
  return closest_hit(inside, ray, options);
};
constexpr auto kAnyHit = [](const auto& inside, const Ray& ray, const auto& options) {
  return any_hit(inside, ray, options);
};
constexpr auto kClosestHits = [](const Tree& tree, auto rays, auto results, const auto& options) {
  return closest_hits(tree, rays, results, options);
};
constexpr auto kAnyHits = [](const Tree& tree, auto rays, auto results, const auto& options) {
  return any_hits(tree, rays, results, options);
};

}  // namespace

bxt_status bxt_tree_closest_hit(const bxt_tree* tree, const bxt_ray* ray,
                                const bxt_face_options* options, bxt_ray_hit* hit,
                                bxt_error* error) {
  return one_hit(tree, ray, options, hit, error, kClosestHit);
}

bxt_status bxt_tree_any_hit(const bxt_tree* tree, const bxt_ray* ray,
                            const bxt_face_options* options, bxt_ray_hit* hit, bxt_error* error) {
  return one_hit(tree, ray, options, hit, error, kAnyHit);
}

bxt_status bxt_tree_all_hits(const bxt_tree* tree, const bxt_ray* ray, bxt_ray_visitor visitor,
                             void* context, const bxt_face_options* options, bxt_error* error) {
  return every_hit(tree, ray, visitor, context, options, error);
}

bxt_status bxt_tree_nearest_hits(const bxt_tree* tree, const bxt_ray* ray, bxt_ray_hit* hits,
                                 size_t capacity, size_t* count, const bxt_face_options* options,
                                 bxt_error* error) {
  return nearest(tree, ray, hits, capacity, count, options, error);
}

bxt_status bxt_tree_closest_hits(const bxt_tree* tree, const bxt_ray* rays, size_t count,
                                 bxt_ray_hit* hits, bxt_status* statuses,
                                 const bxt_face_options* options, bxt_error* error) {
  return many_hits(tree, rays, count, hits, statuses, options, error, kClosestHit, kClosestHits);
}

bxt_status bxt_tree_any_hits(const bxt_tree* tree, const bxt_ray* rays, size_t count,
                             bxt_ray_hit* hits, bxt_status* statuses,
                             const bxt_face_options* options, bxt_error* error) {
  return many_hits(tree, rays, count, hits, statuses, options, error, kAnyHit, kAnyHits);
}

#if BOXTREE_HAS_SCENE_QUERIES
bxt_status bxt_scene_closest_hit(const bxt_scene* scene, const bxt_ray* ray,
                                 const bxt_face_options* options, bxt_ray_hit* hit,
                                 bxt_error* error) {
  return one_hit(scene, ray, options, hit, error, kClosestHit);
}

bxt_status bxt_scene_any_hit(const bxt_scene* scene, const bxt_ray* ray,
                             const bxt_face_options* options, bxt_ray_hit* hit, bxt_error* error) {
  return one_hit(scene, ray, options, hit, error, kAnyHit);
}

bxt_status bxt_scene_all_hits(const bxt_scene* scene, const bxt_ray* ray, bxt_ray_visitor visitor,
                              void* context, const bxt_face_options* options, bxt_error* error) {
  return every_hit(scene, ray, visitor, context, options, error);
}

bxt_status bxt_scene_nearest_hits(const bxt_scene* scene, const bxt_ray* ray, bxt_ray_hit* hits,
                                  size_t capacity, size_t* count, const bxt_face_options* options,
                                  bxt_error* error) {
  return nearest(scene, ray, hits, capacity, count, options, error);
}

bxt_status bxt_scene_closest_hits(const bxt_scene* scene, const bxt_ray* rays, size_t count,
                                  bxt_ray_hit* hits, bxt_status* statuses,
                                  const bxt_face_options* options, bxt_error* error) {
  return many_hits(scene, rays, count, hits, statuses, options, error, kClosestHit, kClosestHits);
}

bxt_status bxt_scene_any_hits(const bxt_scene* scene, const bxt_ray* rays, size_t count,
                              bxt_ray_hit* hits, bxt_status* statuses,
                              const bxt_face_options* options, bxt_error* error) {
  return many_hits(scene, rays, count, hits, statuses, options, error, kAnyHit, kAnyHits);
}
#endif
