// SPDX-License-Identifier: MIT
// Crates rest on a mapped tree as on Bullet's own triangle mesh, for every codec at the same places
// to the last bit.
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <LinearMath/btAabbUtil2.h>
#include <algorithm>
#include <set>

#include <gtest/gtest.h>

#include "samples/bullet_drop/drop.h"
#include "samples/bullet_drop/level_file.h"
#include "samples/bullet_drop/mapped_shape.h"
#include "tests/support/cooked.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace bullet_drop {
namespace {

using boxtree::test::require;

// Half of Bullet's own collision margin. Its mesh is up to 11 mm apart from itself on this level
// when its triangles come in another order.
constexpr double kApartMetres = 0.02;

std::vector<Crate> drop_on_file(const boxtree::cooker::CookOptions& options) {
  const boxtree::test::TempFolder folder;
  const auto path = folder.path() / "level.bxt";
  const boxtree::Status written = cook_level(make_level(), path, options);
  EXPECT_TRUE(written) << written.error().message();
  const boxtree::File file = require(boxtree::File::open(path));
  const boxtree::Tree tree = require(boxtree::Tree::bind(file));
  MappedShape shape(tree);
  return drop_crates(shape);
}

const std::vector<Crate>& on_bullets_mesh() {
  static const std::vector<Crate> kCrates = [] {
    Level level = make_level();
    btTriangleIndexVertexArray arrays = arrays_of(level);
    btBvhTriangleMeshShape shape(&arrays, true);
    return drop_crates(shape);
  }();
  return kCrates;
}

void expect_at_rest_like_bullets(const std::vector<Crate>& crates) {
  ASSERT_EQ(crates.size(), on_bullets_mesh().size());
  for (std::size_t i = 0; i < crates.size(); ++i) {
    EXPECT_TRUE(crates[i].at_rest) << "crate " << i;
    EXPECT_FALSE(has_fallen_through(crates[i])) << "crate " << i;
    const btVector3 apart = crates[i].position - on_bullets_mesh()[i].position;
    EXPECT_LE(double(apart.length()), kApartMetres) << "crate " << i;
    EXPECT_GT(double((crates[i].position - crates[i].start).length()), kApartMetres)
        << "crate " << i << " has not fallen";
  }
}

TEST(BulletDrop, EveryCodecRestsWhereBulletsMeshDoes) {
  std::vector<std::vector<Crate>> all;
  for (const boxtree::CodecId codec : boxtree::test::all_codecs()) {
    SCOPED_TRACE(boxtree::codec_name(codec));
    boxtree::cooker::CookOptions options;
    options.codec = codec;
    all.push_back(drop_on_file(options));
    expect_at_rest_like_bullets(all.back());
    for (std::size_t i = 0; i < all.back().size(); ++i) {
      const btVector3& here = all.back()[i].position;
      const btVector3& first = all.front()[i].position;
      EXPECT_TRUE(here.x() == first.x() && here.y() == first.y() && here.z() == first.z()) << i;
    }
  }
}

TEST(BulletDrop, GridGeometryRestsThereToo) {
  boxtree::cooker::CookOptions options;
  options.geometry = boxtree::GeometryId::kGrid;
  options.grid.tolerance = 5e-4;
  expect_at_rest_like_bullets(drop_on_file(options));
}

struct Collected : btTriangleCallback {
  std::set<int> faces;
  void processTriangle(btVector3*, int, int face) override { faces.insert(face); }
};

TEST(BulletDrop, HandsOverWhatTouchesTheBox) {
  const Level level = make_level();
  const boxtree::test::TempFolder folder;
  const auto path = folder.path() / "level.bxt";
  ASSERT_TRUE(cook_level(level, path));
  const boxtree::File file = require(boxtree::File::open(path));
  const boxtree::Tree tree = require(boxtree::Tree::bind(file));
  MappedShape shape(tree);
  shape.setLocalScaling(btVector3(-2, 1, 1));  // mirrored and stretched
  for (int i = 0; i < 40; ++i) {
    const btVector3 low(btScalar(-15 + 0.7 * i), btScalar(-3 + 0.1 * i), btScalar(-1));
    const btVector3 high = low + btVector3(2, 1, 4);
    Collected collected;
    shape.processAllTriangles(&collected, low, high);
    // Boxes of triangles that do not meet it cannot be there; corners inside it must be.
    for (std::size_t t = 0; t < level.triangles.size(); ++t) {
      btVector3 corners[3];
      bool corner_inside = false;
      for (std::size_t k = 0; k < 3; ++k) {
        const float* const at = &level.positions[3 * level.triangles[t][k]];
        corners[k] = btVector3(-2 * at[0], at[1], at[2]);
        corner_inside |= TestPointAgainstAabb2(low, high, corners[k]);
      }
      const bool found = collected.faces.contains(static_cast<int>(t));
      if (corner_inside) {
        EXPECT_TRUE(found) << t;
      }
      if (!TestTriangleAgainstAabb2(corners, low, high)) {
        EXPECT_FALSE(found) << t;
      }
    }
  }
}

// A level that is not there: the control of the test above.
class Nothing : public MappedShape {
 public:
  using MappedShape::MappedShape;
  void processAllTriangles(btTriangleCallback*, const btVector3&, const btVector3&) const override {
  }
};

TEST(BulletDrop, CratesThatFallThroughAreSeen) {
  const boxtree::test::TempFolder folder;
  const auto path = folder.path() / "level.bxt";
  ASSERT_TRUE(cook_level(make_level(), path));
  const boxtree::File file = require(boxtree::File::open(path));
  const boxtree::Tree tree = require(boxtree::Tree::bind(file));
  Nothing nothing(tree);
  for (const Crate& crate : drop_crates(nothing)) EXPECT_TRUE(has_fallen_through(crate));
}

}  // namespace
}  // namespace bullet_drop
