// SPDX-License-Identifier: MIT
// Traversals of the caller's own, in C.
#include <boxtree_c.h>

#include <boxtree/traverse.h>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"
#include "runtime/c/options.h"

using namespace boxtree;
using namespace boxtree::c;

bxt_status bxt_tree_traverse(const bxt_tree* tree, bxt_box_test test, bxt_triangle_visitor visitor,
                             void* context, const bxt_limits* limits, bxt_error* error) {
  if (const char* name = first_null("tree", tree, "test", test, "visitor", visitor))
    return refuse_null(error, name);
  return guarded(error, [&] {
    return with_limits<bxt_tree>(limits, error, [&](const QueryLimits& read) {
      const auto intersect = [&](const Eigen::AlignedBox3d& box) {
        const bxt_vec3 min = to_c(box.min());
        const bxt_vec3 max = to_c(box.max());
        return test(context, &min, &max);
      };
      const auto visit = [&](const LeafTriangle& found) {
        const bxt_triangle triangle = to_c(found.triangle);
        const bxt_face face = to_c(found.face);
        return visitor(context, &triangle, &face, found.half);
      };
      return finish(traverse(tree->inside, intersect, visit, read), error);
    });
  });
}
