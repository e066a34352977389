/* SPDX-License-Identifier: MIT
   How high is the ground at (2.5, 0)?
     first_ray level.bxt */
#include <boxtree_c.h>
#include <stdio.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) return fprintf(stderr, "usage: first_ray LEVEL.bxt\n"), 2;

  bxt_file* file;
  bxt_tree* tree;
  bxt_error error = {.struct_size = sizeof error};
  bxt_ray_hit hit = {.struct_size = sizeof hit};
  const bxt_ray down = {{2.5, 0, 10}, {0, 0, -1}, 0, INFINITY};
  if (bxt_file_open(arguments[1], NULL, &file, &error) ||
      bxt_tree_bind(file, BXT_ONLY_TREE, NULL, &tree, &error) ||
      bxt_tree_closest_hit(tree, &down, NULL, &hit, &error))
    return fprintf(stderr, "%s\n", error.message), 1;
  if (hit.is_hit) printf("ground at height %g, face %u\n", hit.point.z, hit.face.id);

  bxt_tree_release(tree);
  bxt_file_close(file);
  return 0;
}
