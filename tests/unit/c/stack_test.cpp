// SPDX-License-Identifier: MIT
// What the queries of the C interface take of the stack is at most what the header states.
#include "tests/support/stack.h"

#include <boxtree_c.h>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/unit/c/queries.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

TEST(CStack, OfQueriesIsAsDocumented) {
  if (test::is_instrumented()) GTEST_SKIP() << "frames of sanitizers and of -Og are larger";
  const test::CookedScene cooked =
      test::cook_scene({test::torus(12, 8), test::city(4, 1)}, test::random_parts(40, 2, 6, 1, 1));
  const test::CFile scene_file = test::open_c(cooked.bytes);
  const test::CScene scene = test::bind_scene_c(scene_file);
  const std::size_t idle = test::bytes_used([] {});
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
    const std::vector<std::byte> bytes = test::cook_bytes(test::terrain(120, 3), codec);
    const test::CFile file = test::open_c(bytes);
    const test::CTree tree = test::bind_c(file);
    bxt_vec3 min, max;
    ASSERT_TRUE(bxt_tree_bounds(tree.get(), &min, &max));
    const bxt_vec3 center = {(min.x + max.x) / 2, (min.y + max.y) / 2, (min.z + max.z) / 2};
    for (const test::CQuery& query : test::c_queries(tree.get(), scene.get(), center, 50)) {
      const std::size_t used =
          test::bytes_used([&] { EXPECT_EQ(query.run(), BXT_OK) << query.name; }) - idle;
      EXPECT_LE(used, query.stack_kilobytes << 10) << query.name;
      RecordProperty(query.name, static_cast<int>(used));
    }
  }
}

}  // namespace
}  // namespace boxtree
