// SPDX-License-Identifier: MIT
// Makes fixed queries of each kind of files that are the same everywhere, by the C interface, and prints
// a digest of the answers of each kind and, last, of all: the same on every platform.
//   digests COUNT FILE...      COUNT: queries of each kind and file
//   digests --damaged COUNT FILE...      COUNT damaged copies of each file: whatever is in them, queries end, with an
//                                        answer or an error, and read nothing beside them
// A file with several trees is queried tree by tree and each against the first; one with a scene as that.
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <boxtree_c.h>

#if FLT_EVAL_METHOD != 0
#error "doubles must be computed in doubles: on i386 compile with -msse2 -mfpmath=sse"
#endif

// ---- Numbers: exact in every step, so that all platforms ask the same ------------------------------

static uint64_t random_state;

static uint64_t random_bits(void) {  // splitmix64
  uint64_t z = (random_state += 0x9e3779b97f4a7c15u);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

// 0 to 1, a multiple of 2^-20, so that products with a few of them stay short.
static double unit(void) {
  return (double)(random_bits() >> 44) * 0x1p-20;
}

static double between(double low, double high) {
  return low + unit() * (high - low);
}

// ---- Digests -----------------------------------------------------------------------------------

enum {
  CLOSEST_HIT,
  ANY_HIT,
  ALL_HITS,
  NEAREST_HITS,
  RAY_BATCH,
  RAY_FILTERS,
  OVERLAP_BOX,
  OVERLAP_SHAPE,
  OVERLAP_FRUSTUM,
  OVERLAP_WITHIN,
  CLOSEST_POINT,
  CLOSEST_POINT_WITHIN,
  CAST_SPHERE,
  CAST_CAPSULE,
  CAST_BOX,
  CAST_HULL,
  CAST_ANY,
  CAST_ALL,
  COLLIDE,
  TRAVERSE,
  FACES,
  PAIRS,
  FIRST_CONTACT,
  PAIR_CONTACTS,
  DISTANCE,
  SCENE,
  KINDS
};

static const char* const kind_names[KINDS] = {
    "closest_hit",    "any_hit",         "all_hits",        "nearest_hits",  "ray_batch",
    "ray_filters",    "overlap_box",     "overlap_shape",   "overlap_frustum", "overlap_within",
    "closest_point",  "closest_point_within", "cast_sphere", "cast_capsule", "cast_box",
    "cast_hull",      "cast_any",        "cast_all",        "collide",       "traverse",
    "faces",          "pairs",           "first_contact",   "pair_contacts", "distance",
    "scene"};

static uint64_t digest[KINDS];
static int kind;  // of the query that is asked

static uint64_t mixed(uint64_t hash, uint64_t word) {
  hash ^= word;
  hash *= 0xff51afd7ed558ccdu;
  return hash ^ (hash >> 32);
}

// One answer: what it has, in order. Answers of one query may come in any order, so they are summed.
static uint64_t answer;

static void begin(void) {
  answer = 0x9ae16a3b2f90404fu;
}
static void add_word(uint64_t word) {
  answer = mixed(answer, word);
}
static void add_number(double number) {
  uint64_t bits;
  if (number == 0) number = 0;  // the sign of zero is no part of an answer
  memcpy(&bits, &number, sizeof bits);
  add_word(bits);
}
static void add_vector(bxt_vec3 v) {
  add_number(v.x);
  add_number(v.y);
  add_number(v.z);
}
static void add_face(bxt_face face) {
  add_word(face.id);
  add_word(face.index);
  add_word(face.instance);
}
static void end(void) {
  digest[kind] += answer;
}
// The number of a query, and how it ended.
static void ask(size_t number, bxt_status status) {
  digest[kind] = mixed(digest[kind], number);
  digest[kind] = mixed(digest[kind], (uint64_t)(int64_t)status);
}

// Of queries that answer with some of several things, whether there is one.
static void add_fact(bool is_so) {
  begin();
  add_word(is_so);
  end();
}

static void add_ray_hit(const bxt_ray_hit* hit) {
  begin();
  add_word(hit->is_hit);
  if (hit->is_hit) {
    add_number(hit->t);
    add_face(hit->face);
    add_word(hit->triangle);
    add_number(hit->u);
    add_number(hit->v);
    add_vector(hit->point);
    add_vector(hit->normal);
  }
  end();
}

static void add_cast_hit(const bxt_cast_hit* hit) {
  begin();
  add_word(hit->is_hit);
  if (hit->is_hit) {
    add_number(hit->t);
    add_number(hit->t_lower);
    add_face(hit->face);
    add_word(hit->triangle);
    add_vector(hit->point);
    add_vector(hit->normal);
    add_vector(hit->face_normal);
    add_word(hit->feature);
    add_word(hit->feature_index);
    add_word(hit->initially_touching);
    add_word(hit->is_active);
  }
  end();
}

static void add_point(const bxt_closest_point* point) {
  begin();
  add_word(point->is_found);
  if (point->is_found) {
    add_vector(point->point);
    add_number(point->distance);
    add_face(point->face);
    add_word(point->triangle);
  }
  end();
}

static void add_overlap(const bxt_overlap_answer* found) {
  begin();
  add_word(found->overlap);
  end();
}

// ---- Visitors ----------------------------------------------------------------------------------

static double visit_ray_hit(void* context, const bxt_ray_hit* hit) {
  add_ray_hit(hit);
  return *(const double*)context;
}
static double visit_cast_hit(void* context, const bxt_cast_hit* hit) {
  add_cast_hit(hit);
  return *(const double*)context;
}
static bool visit_face(void* context, const bxt_face* face) {
  (void)context;
  begin();
  add_face(*face);
  end();
  return true;
}
static bool visit_contact(void* context, const bxt_contact* contact) {
  (void)context;
  begin();
  add_face(contact->face);
  add_word(contact->triangle);
  add_vector(contact->point);
  add_vector(contact->normal);
  add_vector(contact->face_normal);
  add_number(contact->depth);
  add_word(contact->feature);
  add_word(contact->feature_index);
  add_word(contact->is_active);
  end();
  return true;
}
static bool visit_pair(void* context, const bxt_face* first, const bxt_face* second) {
  (void)context;
  begin();
  add_face(*first);
  add_face(*second);
  end();
  return true;
}
static bool visit_pair_contact(void* context, const bxt_pair_contact* contact) {
  (void)context;
  begin();
  add_face(contact->first);
  add_face(contact->second);
  add_word(contact->first_triangle);
  add_word(contact->second_triangle);
  add_vector(contact->start);
  add_vector(contact->end);
  add_vector(contact->point);
  add_vector(contact->normal);
  add_number(contact->depth);
  end();
  return true;
}
static bool visit_triangle(void* context, const bxt_triangle* triangle, const bxt_face* face, uint32_t half) {
  (void)context;
  begin();
  for (int c = 0; c < 3; ++c) add_vector(triangle->corner[c]);
  add_face(*face);
  add_word(half);
  end();
  return true;
}
static bool visit_instance(void* context, uint32_t instance) {
  (void)context;
  begin();
  add_word(instance);
  end();
  return true;
}
static bool has_even_index(void* context, const bxt_face* face) {
  (void)context;
  return face->index % 2 == 0;
}

// ---- Questions ---------------------------------------------------------------------------------

// Where questions are asked: a box, and its largest extent.
typedef struct region {
  bxt_vec3 min, max;
  double size;
} region;

static region region_of(bxt_vec3 min, bxt_vec3 max) {
  region r = {min, max, 0};
  const double x = max.x - min.x, y = max.y - min.y, z = max.z - min.z;
  r.size = x > y ? x : y;
  if (z > r.size) r.size = z;
  return r;
}

static bxt_vec3 point_in(const region* r) {
  // In and around it.
  const double margin = 0.25 * r->size;
  bxt_vec3 p;
  p.x = between(r->min.x - margin, r->max.x + margin);
  p.y = between(r->min.y - margin, r->max.y + margin);
  p.z = between(r->min.z - margin, r->max.z + margin);
  return p;
}

static bxt_vec3 minus(bxt_vec3 a, bxt_vec3 b) {
  const bxt_vec3 difference = {a.x - b.x, a.y - b.y, a.z - b.z};
  return difference;
}

static bxt_ray ray_in(const region* r) {
  bxt_ray ray;
  ray.origin = point_in(r);
  ray.direction = minus(point_in(r), ray.origin);
  if (ray.direction.x == 0 && ray.direction.y == 0 && ray.direction.z == 0) ray.direction.x = 1;
  ray.t_min = 0;
  ray.t_max = random_bits() % 4 == 0 ? 1 : INFINITY;
  return ray;
}

static bxt_quaternion rotation(void) {
  bxt_quaternion q = {between(-1, 1), between(-1, 1), between(-1, 1), 1};
  return q;
}

static bxt_vec3 hull_points[6];

static bxt_shape shape_in(const region* r, uint32_t shape_kind) {
  const double size = 0.05 * r->size;
  const bxt_vec3 center = point_in(r);
  switch (shape_kind) {
    case BXT_SPHERE:
      return bxt_sphere(center, size);
    case BXT_CAPSULE: {
      const bxt_vec3 other = {center.x + size * unit(), center.y + size, center.z};
      return bxt_capsule(center, other, 0.5 * size);
    }
    case BXT_BOX: {
      const bxt_vec3 half = {size, 0.5 * size, 0.25 * size};
      return bxt_box(center, half, rotation());
    }
    default: {
      for (int i = 0; i < 6; ++i) {
        const double far = i % 2 == 0 ? size : -size;
        hull_points[i].x = i / 2 == 0 ? far : 0;
        hull_points[i].y = i / 2 == 1 ? far : 0;
        hull_points[i].z = i / 2 == 2 ? far : 0;
      }
      return bxt_convex_hull(hull_points, 6, center, rotation());
    }
  }
}

static void frustum_in(const region* r, bxt_plane planes[6]) {
  bxt_vec3 corners[8];
  const bxt_vec3 eye = point_in(r);
  const double near = 0.02 * r->size, far = (0.1 + 0.3 * unit()) * r->size;
  for (int i = 0; i < 8; ++i) {
    const double depth = i < 4 ? near : far;
    const int corner = i % 4;
    corners[i].x = eye.x + (corner == 1 || corner == 2 ? 0.5 : -0.5) * depth;
    corners[i].y = eye.y + (corner >= 2 ? 0.5 : -0.5) * depth;
    corners[i].z = eye.z - depth;
  }
  bxt_frustum_of_corners(corners, planes);
}

// A pose that brings a tree near another one of the same region: a quarter turn about an axis, or a
// rational rotation by (3, 4, 5), and a translation.
static bxt_pose pose_in(const region* r) {
  bxt_pose pose = bxt_identity();
  switch (random_bits() % 3) {
    case 0:
      pose.x_axis.x = 0, pose.x_axis.y = 1, pose.y_axis.x = -1, pose.y_axis.y = 0;
      break;
    case 1:
      pose.y_axis.y = 0.6, pose.y_axis.z = 0.8, pose.z_axis.y = -0.8, pose.z_axis.z = 0.6;
      break;
    default:
      break;
  }
  pose.position.x = between(-0.75, 0.75) * r->size;
  pose.position.y = between(-0.75, 0.75) * r->size;
  pose.position.z = between(-0.75, 0.75) * r->size;
  return pose;
}

// ---- Trees -------------------------------------------------------------------------------------

static void ask_rays(const bxt_tree* tree, const region* r, size_t count) {
  enum { BATCH = 100 };
  static bxt_ray rays[BATCH];
  static bxt_ray_hit hits[BATCH];
  static bxt_status statuses[BATCH];
  bxt_face_options options = bxt_default_face_options();
  for (size_t i = 0; i < count; ++i) {
    const bxt_ray ray = ray_in(r);
    bxt_ray_hit hit = {.struct_size = sizeof hit};
    kind = CLOSEST_HIT;
    ask(i, bxt_tree_closest_hit(tree, &ray, NULL, &hit, NULL));
    add_ray_hit(&hit);
    kind = ANY_HIT;
    ask(i, bxt_tree_any_hit(tree, &ray, NULL, &hit, NULL));
    add_fact(hit.is_hit);
    double t_max = ray.t_max;
    kind = ALL_HITS;
    ask(i, bxt_tree_all_hits(tree, &ray, visit_ray_hit, &t_max, NULL, NULL));
    kind = NEAREST_HITS;
    bxt_ray_hit nearest[3] = {{.struct_size = sizeof hit}};
    size_t found = 0;
    ask(i, bxt_tree_nearest_hits(tree, &ray, nearest, 3, &found, NULL, NULL));
    for (size_t k = 0; k < found; ++k) add_ray_hit(&nearest[k]);
    kind = RAY_FILTERS;
    options.back_faces = i % 2 == 0 ? BXT_BACK_FACES_IGNORE : BXT_BACK_FACES_ONLY;
    options.filter = i % 4 < 2 ? has_even_index : NULL;
    ask(i, bxt_tree_closest_hit(tree, &ray, &options, &hit, NULL));
    add_ray_hit(&hit);
    kind = RAY_BATCH;
    rays[i % BATCH] = ray;
    if (i % BATCH == BATCH - 1) {
      hits[0].struct_size = sizeof hits[0];
      ask(i, bxt_tree_closest_hits(tree, rays, BATCH, hits, statuses, NULL, NULL));
      for (int k = 0; k < BATCH; ++k) add_ray_hit(&hits[k]);
      ask(i, bxt_tree_any_hits(tree, rays, BATCH, hits, statuses, NULL, NULL));
      for (int k = 0; k < BATCH; ++k) add_fact(hits[k].is_hit);
    }
  }
}

static bool test_box(void* context, const bxt_vec3* min, const bxt_vec3* max) {
  const bxt_vec3* box = context;
  return min->x <= box[1].x && max->x >= box[0].x && min->y <= box[1].y && max->y >= box[0].y &&
         min->z <= box[1].z && max->z >= box[0].z;
}

static void ask_overlaps(const bxt_tree* tree, const region* r, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    bxt_vec3 box[2];
    box[0] = point_in(r);
    const double edge = 0.05 * r->size;
    box[1].x = box[0].x + edge, box[1].y = box[0].y + edge, box[1].z = box[0].z + edge;
    kind = OVERLAP_BOX;
    ask(i, bxt_tree_overlap_box(tree, &box[0], &box[1], visit_face, NULL, NULL, NULL));
    kind = OVERLAP_WITHIN;
    bxt_overlap_answer found = {.struct_size = sizeof found};
    ask(i, bxt_tree_overlap_box_within(tree, &box[0], &box[1], 0, BXT_UNLIMITED, &found, NULL));
    add_overlap(&found);
    kind = OVERLAP_SHAPE;
    const bxt_shape shape = shape_in(r, (uint32_t)(1 + i % 4));
    ask(i, bxt_tree_overlap(tree, &shape, visit_face, NULL, NULL, NULL));
    kind = COLLIDE;
    ask(i, bxt_tree_collide(tree, &shape, visit_contact, NULL, NULL, NULL));
    kind = OVERLAP_FRUSTUM;
    bxt_plane planes[6];
    frustum_in(r, planes);
    ask(i, bxt_tree_overlap_frustum(tree, planes, visit_face, NULL, NULL, NULL));
    kind = TRAVERSE;
    // Which boxes there are differs between codecs, not which triangles are in one of them.
    ask(i, bxt_tree_traverse(tree, test_box, visit_triangle, box, NULL, NULL));
  }
}

static void ask_points(const bxt_tree* tree, const region* r, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const bxt_vec3 point = point_in(r);
    bxt_closest_point answer_of = {.struct_size = sizeof answer_of};
    kind = CLOSEST_POINT;
    ask(i, bxt_tree_closest_point(tree, &point, i % 4 == 0 ? 0.1 * r->size : INFINITY, NULL, &answer_of, NULL));
    add_point(&answer_of);
    kind = CLOSEST_POINT_WITHIN;
    bxt_approximation options = bxt_default_approximation();
    options.max_distance = i % 2 == 0 ? 0.25 * r->size : INFINITY;
    ask(i, bxt_tree_closest_point_within(tree, &point, &options, &answer_of, NULL));
    add_point(&answer_of);
    // What is allowed to be inexact is so in other ways in each build; true it is in all.
    const double truth = answer_of.distance;
    const bool is_found = answer_of.is_found;
    options.relative_error = 0.0625;
    options.node_budget = i % 3 == 0 ? 16 : BXT_UNLIMITED;
    ask(i, bxt_tree_closest_point_within(tree, &point, &options, &answer_of, NULL));
    add_fact(is_found ? answer_of.lower <= truth * (1 + 0x1p-40) && truth <= answer_of.upper * (1 + 0x1p-40) : !answer_of.is_found);
  }
}

static void ask_casts(const bxt_tree* tree, const region* r, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    for (uint32_t s = BXT_SPHERE; s <= BXT_CONVEX_HULL; ++s) {
      const bxt_shape shape = shape_in(r, s);
      const bxt_motion motion = bxt_motion_along(minus(point_in(r), shape.position));
      bxt_cast_hit hit = {.struct_size = sizeof hit};
      kind = CAST_SPHERE + (int)(s - BXT_SPHERE);
      ask(i, bxt_tree_cast_closest(tree, &shape, &motion, NULL, &hit, NULL));
      add_cast_hit(&hit);
      if (i % 4 != s - BXT_SPHERE) continue;
      kind = CAST_ANY;
      ask(i, bxt_tree_cast_any(tree, &shape, &motion, NULL, &hit, NULL));
      add_fact(hit.is_hit);
      kind = CAST_ALL;
      double t_max = motion.t_max;
      ask(i, bxt_tree_cast_all(tree, &shape, &motion, visit_cast_hit, &t_max, NULL, NULL));
    }
  }
}

static void ask_faces(const bxt_tree* tree) {
  kind = FACES;
  for (uint32_t index = 0; index < bxt_tree_face_count(tree); ++index) {
    for (uint32_t half = 0; half < 2; ++half) {
      const bxt_face face = {BXT_NO_FACE, index, BXT_NO_INSTANCE};
      bxt_triangle triangle;
      const bxt_status status = bxt_tree_triangle(tree, &face, half, &triangle, NULL);
      ask(index, status);
      if (status != BXT_OK) continue;
      uint32_t edges = 0, data = 0;
      begin();
      for (int c = 0; c < 3; ++c) add_vector(triangle.corner[c]);
      add_word((uint64_t)bxt_tree_active_edges(tree, &face, half, &edges, NULL));
      add_word(edges);
      add_word(bxt_tree_material(tree, &face));
      add_word(bxt_tree_user_data(tree, &face, &data));
      add_word(data);
      end();
    }
  }
}

static void add_distance(const bxt_distance* distance) {
  begin();
  add_number(distance->lower);
  add_number(distance->upper);
  add_word(distance->converged);
  add_word(distance->is_found);
  add_face(distance->first);
  add_face(distance->second);
  add_vector(distance->first_point);
  add_vector(distance->second_point);
  end();
}

static void ask_pairs(const bxt_tree* first, const bxt_tree* second, const region* r, size_t count) {
  for (size_t i = 0; i < count; ++i) {
    const bxt_pose pose = pose_in(r);
    bxt_overlap_answer found = {.struct_size = sizeof found};
    kind = FIRST_CONTACT;
    ask(i, bxt_tree_first_contact(first, NULL, second, &pose, NULL, &found, NULL));
    add_overlap(&found);
    kind = DISTANCE;
    bxt_distance distance = {.struct_size = sizeof distance};
    bxt_approximation options = bxt_default_approximation();
    options.relative_error = 0.0625;
    ask(i, bxt_tree_distance(first, NULL, second, &pose, &options, &distance, NULL));
    add_distance(&distance);
    if (i % 8 != 0) continue;
    kind = PAIRS;
    ask(i, bxt_tree_overlap_pairs(first, NULL, second, &pose, visit_pair, NULL, NULL, NULL));
    kind = PAIR_CONTACTS;
    ask(i, bxt_tree_pair_contacts(first, NULL, second, &pose, visit_pair_contact, NULL, NULL, NULL));
    kind = OVERLAP_WITHIN;
    ask(i, bxt_tree_overlap_within(first, NULL, second, &pose, 0, BXT_UNLIMITED, &found, NULL));
    add_overlap(&found);
  }
}

// ---- Scenes ------------------------------------------------------------------------------------

// The box around all instances.
static region region_of_scene(const bxt_scene* scene) {
  bxt_vec3 min = {INFINITY, INFINITY, INFINITY}, max = {-INFINITY, -INFINITY, -INFINITY};
  for (uint32_t i = 0; i < bxt_scene_instance_count(scene); ++i) {
    bxt_instance instance = {.struct_size = sizeof instance};
    bxt_pose pose;
    if (bxt_scene_instance(scene, i, &instance, NULL) != BXT_OK) continue;
    if (bxt_scene_pose(scene, i, &pose, NULL) != BXT_OK) continue;
    const bxt_vec3 p = pose.position;
    min.x = fmin(min.x, p.x - 1), min.y = fmin(min.y, p.y - 1), min.z = fmin(min.z, p.z - 1);
    max.x = fmax(max.x, p.x + 1), max.y = fmax(max.y, p.y + 1), max.z = fmax(max.z, p.z + 1);
  }
  return region_of(min, max);
}

static void ask_scene(bxt_scene* scene, size_t count) {
  const region r = region_of_scene(scene);
  kind = SCENE;
  for (size_t i = 0; i < count; ++i) {
    // Moving instances move, and doors open and close.
    const uint32_t number = (uint32_t)(random_bits() % bxt_scene_instance_count(scene));
    const bxt_pose pose = pose_in(&r);
    if (i % 16 == 0) ask(i, bxt_scene_make_movable(scene, number, NULL));
    ask(i, bxt_scene_update(scene, number, &pose, NULL));
    ask(i, bxt_scene_set_enabled(scene, number, i % 3 != 0, NULL));

    const bxt_ray ray = ray_in(&r);
    bxt_ray_hit hit = {.struct_size = sizeof hit};
    double t_max = ray.t_max;
    ask(i, bxt_scene_closest_hit(scene, &ray, NULL, &hit, NULL));
    add_ray_hit(&hit);
    ask(i, bxt_scene_any_hit(scene, &ray, NULL, &hit, NULL));
    add_fact(hit.is_hit);
    ask(i, bxt_scene_all_hits(scene, &ray, visit_ray_hit, &t_max, NULL, NULL));

    const bxt_vec3 min = point_in(&r);
    const bxt_vec3 max = {min.x + 0.1 * r.size, min.y + 0.1 * r.size, min.z + 0.1 * r.size};
    ask(i, bxt_scene_overlap_box(scene, &min, &max, visit_face, NULL, NULL, NULL));
    bxt_closest_point point = {.struct_size = sizeof point};
    ask(i, bxt_scene_closest_point(scene, &min, INFINITY, NULL, &point, NULL));
    add_point(&point);

    const bxt_shape shape = shape_in(&r, (uint32_t)(1 + i % 4));
    const bxt_motion motion = bxt_motion_along(minus(point_in(&r), shape.position));
    bxt_cast_hit touch = {.struct_size = sizeof touch};
    ask(i, bxt_scene_overlap(scene, &shape, visit_face, NULL, NULL, NULL));
    ask(i, bxt_scene_cast_closest(scene, &shape, &motion, NULL, &touch, NULL));
    add_cast_hit(&touch);
    ask(i, bxt_scene_collide(scene, &shape, visit_contact, NULL, NULL, NULL));

    bxt_plane planes[6];
    frustum_in(&r, planes);
    ask(i, bxt_scene_overlap_frustum(scene, planes, visit_face, NULL, NULL, NULL));
    ask(i, bxt_scene_instances_in_frustum(scene, planes, visit_instance, NULL, NULL, NULL));
    if (i % 64 == 0) ask(i, bxt_scene_contacts(scene, visit_pair, NULL, NULL, NULL));
    if (i % 64 == 1) ask(i, bxt_scene_pair_contacts_of(scene, number, visit_pair_contact, NULL, NULL, NULL));
    if (i % 16 != 2) continue;
    bxt_distance distance = {.struct_size = sizeof distance};
    ask(i, bxt_scene_distance_of(scene, number, NULL, &distance, NULL));
    add_distance(&distance);
  }
}

// ---- Files -------------------------------------------------------------------------------------

static void fail(const char* path, const bxt_error* error) {
  fprintf(stderr, "digests: %s: %s\n", path, error->message);
  exit(1);
}

// Makes queries of what is open, and closes it. Stops at a tree or scene that cannot be bound: the error.
static bxt_status ask_opened(bxt_file* file, size_t count, bxt_error* error) {
  bxt_status status = BXT_OK;
  bxt_tree* first = NULL;
  for (uint32_t number = 0; status == BXT_OK && number < bxt_file_tree_count(file); ++number) {
    bxt_tree* tree = NULL;
    status = bxt_tree_bind(file, number, NULL, &tree, error);
    if (status != BXT_OK) break;
    bxt_vec3 min = {0, 0, 0}, max = {1, 1, 1};
    bxt_tree_bounds(tree, &min, &max);
    const region r = region_of(min, max);
    ask_rays(tree, &r, count);
    ask_overlaps(tree, &r, count);
    ask_points(tree, &r, count);
    ask_casts(tree, &r, count);
    ask_faces(tree);
    ask_pairs(first != NULL ? first : tree, tree, &r, count);
    if (first == NULL) {
      first = tree;
    } else {
      bxt_tree_release(tree);
    }
  }
  bxt_tree_release(first);
  if (status == BXT_OK && bxt_file_has_scene(file)) {
    bxt_scene* scene = NULL;
    status = bxt_scene_bind(file, NULL, &scene, error);
    if (status == BXT_OK && bxt_scene_instance_count(scene) > 0) ask_scene(scene, count);
    bxt_scene_release(scene);
  }
  bxt_file_close(file);
  return status;
}

static void ask_file(const char* path, size_t count) {
  bxt_error error = {.struct_size = sizeof error};
  bxt_file* file = NULL;
  bxt_file_options copied = {.struct_size = sizeof copied};
  copied.copy = true;
  if (bxt_file_open(path, &copied, &file, &error) != BXT_OK) fail(path, &error);
  if (ask_opened(file, count, &error) != BXT_OK) fail(path, &error);
}

// Bytes of a file in memory of just their size, so that tools that look for it see what is read beside them.
static unsigned char* read_bytes(const char* path, size_t* size) {
  FILE* const file = fopen(path, "rb");
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) exit(1);
  *size = (size_t)ftell(file);
  unsigned char* const bytes = malloc(*size);
  rewind(file);
  if (bytes == NULL || fread(bytes, 1, *size, file) != *size) exit(1);
  fclose(file);
  return bytes;
}

// Behind the section table, whose checksum refuses all else at once.
static void damage(unsigned char* bytes, size_t size) {
  uint32_t sections;
  memcpy(&sections, bytes + 12, sizeof sections);
  const size_t start = 32 + 16 * (size_t)sections;
  const size_t changes = 1 + random_bits() % 4;
  for (size_t i = 0; i < changes && start < size; ++i) {
    const size_t at = start + random_bits() % (size - start);
    const size_t rest = size - at, length = 1 + random_bits() % (rest < 8 ? rest : 8);
    switch (random_bits() % 3) {
      case 0:
        bytes[at] ^= (unsigned char)(1u << random_bits() % 8);
        break;
      case 1:
        memset(bytes + at, random_bits() % 2 != 0 ? 0xff : 0, length);
        break;
      default:
        memmove(bytes + at, bytes + start + random_bits() % (size - start - length + 1), length);
    }
  }
}

// Returns how many of the copies could be opened and bound.
static size_t ask_damaged(const char* path, size_t copies) {
  size_t size, opened = 0;
  unsigned char* const bytes = read_bytes(path, &size);
  for (size_t i = 0; i < copies; ++i) {
    unsigned char* const copy = malloc(size);
    if (copy == NULL) exit(1);
    memcpy(copy, bytes, size);
    damage(copy, size);
    bxt_error error = {.struct_size = sizeof error};
    bxt_file* file = NULL;
    if (bxt_file_open_memory(copy, size, NULL, &file, &error) == BXT_OK && ask_opened(file, 2, &error) == BXT_OK) ++opened;
    free(copy);
  }
  free(bytes);
  return opened;
}

int main(int argc, char** argv) {
  const bool is_damaged = argc > 1 && strcmp(argv[1], "--damaged") == 0;
  if (is_damaged) ++argv, --argc;
  if (argc < 3) {
    fprintf(stderr, "usage: digests [--damaged] COUNT FILE...\n");
    return 1;
  }
  const size_t count = (size_t)strtoul(argv[1], NULL, 10);
  if (is_damaged) {
    size_t opened = 0;
    for (int i = 2; i < argc; ++i) opened += ask_damaged(argv[i], count);
    printf("%llu of %llu damaged copies were queried\n", (unsigned long long)opened,
           (unsigned long long)count * (unsigned long long)(argc - 2));
    return opened > 0 ? 0 : 1;
  }
  for (int i = 2; i < argc; ++i) ask_file(argv[i], count);
  uint64_t all = 0;
  for (int k = 0; k < KINDS; ++k) {
    printf("%-20s %016llx\n", kind_names[k], (unsigned long long)digest[k]);
    all = mixed(all, digest[k]);
  }
  printf("%-20s %016llx\n", "all", (unsigned long long)all);
  return 0;
}
