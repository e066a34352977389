// SPDX-License-Identifier: MIT
// Casts and contacts against distances in extended precision, over all triangles and all of the
// way. Shares nothing with the runtime.
#pragma once

#include <string>
#include <vector>

#include "tests/robustness/moving_shapes.h"
#include "tests/robustness/run.h"
#include "tests/robustness/subjects.h"
#include "tests/support/shape_reference.h"

namespace boxtree::robustness {

class CastReference {
 public:
  /// The triangles that the tree decodes to.
  explicit CastReference(const Tree& tree);
  /// The triangles of the source, which exact stores keep.
  explicit CastReference(const SourceMesh& mesh);

  /// Checks cast_closest, cast_any and cast_all: nothing is missed, nothing is touched before
  /// t_lower, something is by t, the face that is named is. Returns whether it touches.
  bool check_cast(Run& run, const Tree& tree, const Cast& cast, const std::string& name) const;

  /// Checks collide() where the shape starts: the set of triangles, the points and the depths.
  /// Returns how many it touches.
  std::size_t check_contacts(Run& run, const Tree& tree, const Shape& shape,
                             const std::string& name) const;

 private:
  struct Item {
    std::uint32_t face;
    std::uint32_t half;
    test::BoundedTriangle triangle;
  };
  [[nodiscard]] const Item* find(std::uint32_t face, std::uint32_t half) const;
  void add(std::uint32_t face, std::uint32_t half, const test::LongTriangle& triangle);

  std::vector<Item> items_;  // by face and half
  long double largest_ = 0;  // coordinate
};

}  // namespace boxtree::robustness
