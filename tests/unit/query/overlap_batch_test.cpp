// SPDX-License-Identifier: MIT
// Batches of boxes and spheres visit for each shape what its own query visits, in the same order.
#include <array>
#include <cstddef>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "format/codec_wide.h"
#include "tests/support/cooked.h"
#include "tests/support/infinity.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/unit/query/batches.h"
#include "tests/unit/walk/targets.h"

namespace boxtree {
namespace {

using Boxes = std::vector<Eigen::AlignedBox3d>;
using Spheres = std::vector<Sphere>;

using test::kInfinity;
using test::kNan;
constexpr std::size_t kAllFaces = std::numeric_limits<std::size_t>::max();

// What a visit found, and how it ended.
struct Found {
  std::vector<std::uint32_t> ids, indices;
  VisitResult end{Errc::kInternal, "not written"};  // every result must be written

  bool operator==(const Found& other) const {
    return ids == other.ids && indices == other.indices && end.code() == other.end.code() &&
           end.error().detail == other.end.error().detail &&
           end.has_value() == other.end.has_value() && *end == *other.end;
  }
  // Stops after `most` faces.
  bool add(const FaceRef& face, std::size_t most) {
    ids.push_back(face.id);
    indices.push_back(face.index);
    return ids.size() < most;
  }
};

Found found(const VisitResult& end, const Found& faces) {
  return {faces.ids, faces.indices, end};
}

template <class Query>
Found alone(const Query& query, std::size_t most) {
  Found faces;
  const Result<Visit> visit = query([&](const FaceRef& face) { return faces.add(face, most); });
  if (visit) return found(*visit, faces);
  // Messages are compared, too, and live longer than this.
  static constexpr std::array kDetails = {"", "box", "center", "radius"};
  for (const char* detail : kDetails) {
    if (visit.error().detail == detail) return found({visit.error().code, detail}, faces);
  }
  ADD_FAILURE() << visit.error().message();
  return faces;
}
Found visit_alone(const Tree& tree, const Eigen::AlignedBox3d& box, std::size_t most,
                  const QueryLimits& limits) {
  return alone([&](FaceVisitor visitor) { return overlap_box(tree, box, visitor, limits); }, most);
}
Found visit_alone(const Tree& tree, const Sphere& sphere, std::size_t most,
                  const QueryLimits& limits) {
  return alone([&](FaceVisitor visitor) { return overlap_sphere(tree, sphere, visitor, limits); },
               most);
}
Status visit_all(const Tree& tree, const Boxes& boxes, std::span<VisitResult> results,
                 BatchFaceVisitor visitor, const QueryLimits& limits) {
  return overlap_boxes(tree, boxes, results, visitor, limits);
}
Status visit_all(const Tree& tree, const Spheres& spheres, std::span<VisitResult> results,
                 BatchFaceVisitor visitor, const QueryLimits& limits) {
  return overlap_spheres(tree, spheres, results, visitor, limits);
}

// By every instruction set. `most(i)`: the faces after which the visitor stops shape i.
template <class Shape, class Most>
void expect_visits_as_alone(const Tree& tree, const std::vector<Shape>& shapes, const Most& most,
                            const QueryLimits& limits = {}) {
  for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    std::vector<Found> faces(shapes.size());
    std::vector<VisitResult> results(shapes.size(), Found().end);
    const auto visitor = [&](std::size_t i, const FaceRef& face) {
      return faces[i].add(face, most(i));
    };
    ASSERT_TRUE(visit_all(tree, shapes, results, visitor, limits).ok());
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      SCOPED_TRACE(i);
      ASSERT_EQ(found(results[i], faces[i]), visit_alone(tree, shapes[i], most(i), limits));
    }
  });
}
template <class Shape>
void expect_visits_as_alone(const Tree& tree, const std::vector<Shape>& shapes) {
  expect_visits_as_alone(tree, shapes, [](std::size_t) { return kAllFaces; });
}

// Of a box each: the box, and the spheres around it and in it.
Spheres spheres_of(const Boxes& boxes) {
  Spheres spheres;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    const double diameter = i % 2 == 0 ? boxes[i].sizes().norm() : boxes[i].sizes().minCoeff();
    spheres.push_back({boxes[i].center(), diameter / 2});
  }
  return spheres;
}

Eigen::AlignedBox3d box_at(const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
  return {center - half, center + half};
}

class OverlapBatches : public test::BatchTest {
 protected:
  // From within a leaf to all of the mesh.
  Boxes boxes_around(const Eigen::AlignedBox3d& bounds, std::size_t count, double part) {
    Boxes boxes;
    const double size = bounds.sizes().norm() + 0.1;
    for (std::size_t i = 0; i < count; ++i) {
      const double half = size * std::array{0.01, 0.05, 0.2, 0.7, 0.0}[i % 5];
      boxes.push_back(box_at(point_around(bounds, part), half * Eigen::Vector3d(1, 0.5, 0.8)));
    }
    return boxes;
  }
};

TEST_P(OverlapBatches, OfALatticeAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& bounds) {
    const double size = bounds.sizes().norm() + 0.1;
    for (const double half : {0.02, 0.15, 0.6}) {
      Boxes boxes;
      for (int i = 0; i < 6 * 6 * 5; ++i) {
        const Eigen::Vector3d at(i % 6 - 2.5, i / 6 % 6 - 2.5, i / 36 - 2);
        boxes.push_back(
            box_at(bounds.center() + size / 6 * at, Eigen::Vector3d::Constant(half * size)));
      }
      expect_visits_as_alone(tree, boxes);
      expect_visits_as_alone(tree, spheres_of(boxes));
    }
  });
}

TEST_P(OverlapBatches, OfShapesThatHaveNothingInCommonAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& bounds) {
    const Boxes boxes = boxes_around(bounds, 300, 2);
    expect_visits_as_alone(tree, boxes);
    expect_visits_as_alone(tree, spheres_of(boxes));
  });
}

// A shape that has seen enough leaves those beside it alone.
TEST_P(OverlapBatches, ThatStopAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& bounds) {
    const Boxes boxes = boxes_around(bounds, 120, 1);
    const auto most = [](std::size_t i) {
      return std::array<std::size_t, 4>{1, 3, 10, kAllFaces}[i % 4];
    };
    expect_visits_as_alone(tree, boxes, most);
    expect_visits_as_alone(tree, spheres_of(boxes), most);
  });
}

TEST_P(OverlapBatches, OnCornersAndEdgesAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& /*bounds*/) {
    Boxes boxes;
    for (std::uint32_t f = 0; f < std::min(tree.face_count(), 60u); ++f) {
      const Result<Triangle> triangle = tree.triangle({kNoFaceId, f}, 0);
      if (!triangle) continue;
      const auto& [a, b, c] = triangle->corner;
      boxes.emplace_back(a, a);
      boxes.emplace_back(a.cwiseMin(b), a.cwiseMax(b));
      boxes.push_back(Eigen::AlignedBox3d(a).extend(b).extend(c));
    }
    expect_visits_as_alone(tree, boxes);
    expect_visits_as_alone(tree, spheres_of(boxes));
  });
}

TEST_P(OverlapBatches, WithShapesThatAreRefusedOrExtremeAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& bounds) {
    Boxes boxes = boxes_around(bounds, 120, 2);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i / 10 % 3);
      switch (i % 10) {
        case 1:
          boxes[i].min()[k] = kNan;
          break;
        case 2:
          boxes[i].max()[k] = kInfinity;
          break;
        case 3:
          boxes[i].setEmpty();
          break;
        case 4:
          boxes[i].translate(0x1p9 * Eigen::Vector3d::Unit(k));
          break;
        case 5:
          boxes[i] = Eigen::AlignedBox3d(boxes[i].min() * 0x1p400, boxes[i].min() * 0x1p400);
          break;
        case 6:
          boxes[i].max()[k] = 0x1p1000;
          break;
        case 7:
          boxes[i].max()[k] = boxes[i].min()[k] + 0x1p-1040;
          break;
        default:
          break;
      }
    }
    expect_visits_as_alone(tree, boxes);
    Spheres spheres = spheres_of(boxes);
    for (std::size_t i = 0; i < spheres.size(); ++i) {
      if (i % 10 == 8) spheres[i].radius = std::array{kNan, -1.0, kInfinity}[i / 10 % 3];
      if (i % 10 == 9) spheres[i].radius = std::array{0.0, 0x1p1000, 0x1p-1060}[i / 10 % 3];
    }
    expect_visits_as_alone(tree, spheres);
  });
}

TEST_P(OverlapBatches, OfAnyNumberAreAsAlone) {
  const test::CookedTree cooked = test::cook_tree(test::torus(20, 12), GetParam());
  for (std::size_t count = 0; count < 40; ++count) {
    const Boxes boxes = boxes_around(cooked.tree.bounds(), count, 1.5);
    expect_visits_as_alone(cooked.tree, boxes);
    expect_visits_as_alone(cooked.tree, spheres_of(boxes));
  }
}

TEST_P(OverlapBatches, GiveEachShapeItsOwnLimit) {
  const test::CookedTree cooked = test::cook_tree(test::torus(60, 40), GetParam());
  const Boxes boxes = boxes_around(cooked.tree.bounds(), 50, 1.5);
  const auto most = [](std::size_t) { return kAllFaces; };
  for (const std::uint64_t nodes : {0u, 1u, 3u, 1000u}) {
    expect_visits_as_alone(cooked.tree, boxes, most, QueryLimits{nodes});
    expect_visits_as_alone(cooked.tree, spheres_of(boxes), most, QueryLimits{nodes});
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, OverlapBatches, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

TEST(OverlapBatch, RefusesResultsOfAnotherNumber) {
  const test::CookedTree cooked = test::cook_tree(test::torus(20, 12), CodecId::kWide8);
  const std::array<Sphere, 3> spheres;
  const std::array<Eigen::AlignedBox3d, 3> boxes;
  std::array<VisitResult, 2> results = {Found().end, Found().end};
  const auto visitor = [](std::size_t, const FaceRef&) { return true; };
  for (const Status& refused : {overlap_boxes(cooked.tree, boxes, results, visitor),
                                overlap_spheres(cooked.tree, spheres, results, visitor)}) {
    EXPECT_EQ(refused.error().code, Errc::kInvalidQuery);
    EXPECT_EQ(refused.error().detail, "results.size()");
    EXPECT_EQ(results[0].code(), Errc::kInternal) << "nothing was written";
  }
}

// A shape that comes upon a corrupt node gets the error, those beside it what touches them.
TEST(OverlapBatch, GivesErrorsToTheShapesThatComeUponThem) {
  test::CookedTree cooked = test::cook_tree(test::torus(80, 48), CodecId::kWide8);
  const auto nodes = test::section_of(cooked.bytes, SectionKind::kNodes);
  const std::size_t node_count = nodes.size() / sizeof(Wide8Node);
  Boxes boxes;
  for (int i = 0; i < 64; ++i) {
    boxes.push_back(box_at({0.1 * i - 3.2, 0.3, 0.2}, Eigen::Vector3d::Constant(0.15)));
  }
  std::size_t failed = 0, answered = 0;
  for (std::size_t node = 0; node < node_count; node += 1 + node_count / 40) {
    std::vector<std::byte> bytes = cooked.bytes;
    test::section_of(
        bytes, SectionKind::kNodes)[node * sizeof(Wide8Node) + offsetof(Wide8Node, child_count)] =
        std::byte{200};
    const File file = test::require(File::open(bytes));
    const Tree tree = test::require(Tree::bind(file));
    expect_visits_as_alone(tree, boxes);
    expect_visits_as_alone(tree, spheres_of(boxes));
    for (const Eigen::AlignedBox3d& box : boxes) {
      ++(visit_alone(tree, box, kAllFaces, {}).end.ok() ? answered : failed);
    }
  }
  EXPECT_GT(failed, 64u);
  EXPECT_GT(answered, 64u);
}

}  // namespace
}  // namespace boxtree
