/* SPDX-License-Identifier: MIT
   What the C interface can do: errors, memory of your own, rays, filters, batches, casts, contacts, closest
   points, and a scene in which a crate moves.
     tour level.bxt crate.bxt */
#include <boxtree_c.h>
#include <stdio.h>
#include <stdlib.h>

/* Ends the program if a function failed, with what it says of it. */
static bxt_error error = {.struct_size = sizeof error};
static void check(bxt_status status) {
  if (status == BXT_OK) return;
  fprintf(stderr, "%s (code %d)\n", error.message, (int)error.status);
  exit(1);
}

/* An allocator that knows how many pieces are in use. malloc() aligns as all but copies of files
 * need. */
static void* allocate(void* context, size_t size, size_t alignment) {
  (void)alignment;
  ++*(int*)context;
  return malloc(size);
}
static void give_back(void* context, void* memory, size_t size, size_t alignment) {
  (void)size;
  (void)alignment;
  --*(int*)context;
  free(memory);
}

/* Callbacks: a context of yours comes first. */
static bool is_other_face(void* context, const bxt_face* face) {
  return face->id != *(const uint32_t*)context;
}
static bool count_face(void* context, const bxt_face* face) {
  (void)face;
  ++*(int*)context;
  return true; /* go on */
}
typedef struct contacts {
  bxt_contact list[16];
  size_t count;
} contacts;
static bool keep_contact(void* context, const bxt_contact* contact) {
  contacts* found = context;
  found->list[found->count++] = *contact;
  return found->count < 16;
}
static bool print_pair(void* context, const bxt_face* first, const bxt_face* second) {
  char name[32];
  bxt_scene_instance_name(context, second->instance, name, sizeof name);
  printf("the crate touches face %u of %s\n", second->id, name);
  return first->instance == 0 && false; /* one is enough */
}

static bxt_tree* open_tree(const char* path, const bxt_allocator* allocator, bxt_file** file) {
  bxt_file_options file_options = {.struct_size = sizeof file_options};
  bxt_tree_options tree_options = {.struct_size = sizeof tree_options};
  bxt_tree* tree;
  file_options.allocator = allocator;
  tree_options.allocator = allocator;
  check(bxt_file_open(path, &file_options, file, &error));
  check(bxt_tree_bind(*file, BXT_ONLY_TREE, &tree_options, &tree, &error));
  return tree;
}

static void query_tree(const bxt_tree* level) {
  const bxt_vec3 above = {2.5, 0, 2}, down = {0, 0, -2}, inside = {2.5, 0, 0.625};
  const bxt_shape ball = bxt_sphere(above, 0.25), sunk = bxt_sphere(inside, 0.25);
  const bxt_motion fall = bxt_motion_along(down);
  bxt_face_options options = bxt_default_face_options();
  bxt_ray rays[5];
  bxt_ray_hit hits[5] = {{.struct_size = sizeof hits[0]}}; /* the first one's size is that of all */
  bxt_cast_hit touch = {.struct_size = sizeof touch};
  bxt_closest_point closest = {.struct_size = sizeof closest};
  contacts found = {{{0}}, 0};
  uint32_t plate = 2;
  size_t kept;
  int i, faces = 0;

  for (i = 0; i < 5; ++i) {
    const bxt_ray ray = {{i - 0.5, 0.25, 9}, {0, 0, -1}, 0, INFINITY};
    rays[i] = ray;
  }
  check(bxt_tree_closest_hits(level, rays, 5, hits, NULL, NULL, &error));
  printf("heights:");
  for (i = 0; i < 5; ++i) printf(" %g", hits[i].point.z);
  options.filter = is_other_face;
  options.filter_context = &plate;
  check(bxt_tree_closest_hit(level, &rays[3], &options, hits, &error));
  printf("\nbelow the upper plate: %g\n", hits[0].point.z);

  check(bxt_tree_cast_closest(level, &ball, &fall, NULL, &touch, &error));
  printf("the ball falls %g to face %u\n", touch.t_lower * 2, touch.face.id);
  check(bxt_tree_overlap(level, &sunk, count_face, &faces, NULL, &error));
  check(bxt_tree_collide(level, &sunk, keep_contact, &found, NULL, &error));
  check(bxt_merge_contacts(found.list, found.count, 1e-6, 0.999, &kept, &error));
  printf("%d faces, %u contact, %g deep\n", faces, (unsigned)kept, found.list[0].depth);
  check(bxt_tree_closest_point(level, &above, INFINITY, NULL, &closest, &error));
  printf("the nearest point is %g away\n", closest.distance);

  /* An error is no end: it has a code, a name, a meaning, and a message that says more. */
  rays[0].direction.z = 0;
  if (bxt_tree_closest_hit(level, rays, NULL, hits, &error) == BXT_INVALID_QUERY) {
    printf("%s (%s)\n", error.message, bxt_error_meaning(error.status));
  }
}

static void move_crate(const bxt_tree* level, const bxt_tree* crate, const bxt_allocator* own) {
  const bxt_tree* const trees[2] = {level, crate};
  bxt_placed_tree placed[2] = {{.struct_size = sizeof placed[0]}};
  bxt_scene* scene;
  int step;
  placed[0].tree = 1;
  placed[0].pose = bxt_translation(2.5, 0, 2);
  placed[0].moves = true;
  placed[0].name = "Crate";
  placed[1].pose = bxt_identity();
  placed[1].name = "Level";
  check(bxt_scene_assemble(trees, 2, placed, 2, NULL, 0, own, &scene, &error));
  for (step = 0; step < 3; ++step) {
    const bxt_pose pose = bxt_translation(2.5, 0, 1.5 - 0.5 * step);
    check(bxt_scene_update(scene, 0, &pose, &error));
    printf("at height %g\n", pose.position.z);
    check(bxt_scene_contacts(scene, print_pair, scene, NULL, &error));
  }
  bxt_scene_release(scene);
}

int main(int argument_count, char** arguments) {
  int in_use = 0;
  const bxt_allocator own = {sizeof own, &in_use, allocate, give_back};
  bxt_file *level_file, *crate_file;
  bxt_tree *level, *crate;
  if (argument_count != 3) return fprintf(stderr, "usage: tour LEVEL.bxt CRATE.bxt\n"), 2;
  level = open_tree(arguments[1], &own, &level_file);
  crate = open_tree(arguments[2], &own, &crate_file);
  query_tree(level);
  move_crate(level, crate, &own);
  bxt_tree_release(crate);
  bxt_tree_release(level);
  bxt_file_close(crate_file);
  bxt_file_close(level_file);
  printf("pieces of memory in use: %d\n", in_use);
  return 0;
}
