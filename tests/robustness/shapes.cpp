// SPDX-License-Identifier: MIT
// Meshes that make deep trees, and counts that exceed 16, 21 and 24 bits.
#include <cmath>
#include <cstring>
#include <random>

#include "format/container.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/bound_tree.h"
#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"

namespace boxtree::robustness {
namespace {

// Triangles with the same centre, of sizes from 1 to 2^-40.
SourceMesh concentric(int count) {
  std::vector<Corners> triangles;
  std::mt19937_64 random(19);
  for (int i = 0; i < count; ++i) {
    Eigen::Vector3d a(static_cast<double>(random() % 64), static_cast<double>(random() % 64), 3);
    Eigen::Vector3d b(static_cast<double>(random() % 64), -40, static_cast<double>(random() % 64));
    a *= std::ldexp(1.0, -(i % 40));
    b *= std::ldexp(1.0, -(i % 40));
    triangles.push_back({a, b, -(a + b)});
  }
  return from_triangles("concentric", triangles);
}

// Each triangle has half the size and half the distance from the origin of the previous one: every
// split at a middle separates one triangle from all others.
SourceMesh chain(int links, int copies) {
  std::vector<Corners> triangles;
  for (int i = 0; i < links; ++i) {
    const double at = std::ldexp(1.0, -i);
    for (int c = 0; c < copies; ++c) {
      const Eigen::Vector3d p(at, at * (1 + c / 16.0), at / 2);
      triangles.push_back(
          {p, p + Eigen::Vector3d(at / 4, 0, at / 8), p + Eigen::Vector3d(0, at / 8, at / 4)});
    }
  }
  return from_triangles("chain of " + std::to_string(links), triangles);
}

void equal_centroids(Run& run) {
  std::vector<SourceMesh> meshes = {concentric(300), test::huge_among_tiny(300, 5),
                                    test::duplicates(200)};
  SourceMesh one_middle = concentric(200);
  for (std::size_t f = 0; f < one_middle.faces.size(); ++f) {
    if (f % 2 == 0) std::swap(one_middle.faces[f].corner[0], one_middle.faces[f].corner[1]);
  }
  meshes.push_back(one_middle);
  std::size_t hits = 0;
  for (const SourceMesh& mesh : meshes) {
    hits += check_answers(run, mesh, queries_for(mesh, 19));
  }
  run.premise(hits > 5000, "hardly any answer names a face");
  // A file must not state a depth beyond the stacks of its readers.
  for_each_subject(test::torus(12, 8), [&](const Subject& subject) {
    std::vector<std::byte> bytes = subject.cooked.bytes;
    const Bytes record = OpenFile::of(subject.cooked.file).section(SectionKind::kTrees);
    const auto at = static_cast<std::size_t>(record.data() - subject.cooked.bytes.data()) +
                    offsetof(TreeRecord, depth);
    for (const std::uint32_t depth :
         {is_wide(BoundTree::of(subject.tree()).codec()) ? kMaxWideDepth + 1 : kMaxDepth + 1, 1000u,
          0xffffffffu}) {
      std::memcpy(bytes.data() + at, &depth, sizeof(depth));
      test::repair_checksums(bytes);
      const auto file = File::open(bytes);
      run.check(!file.ok() || !Tree::bind(*file).ok(),
                [&] { return subject.name + ": depth " + std::to_string(depth); });
    }
  });
}

void deep_chains(Run& run) {
  std::size_t hits = 0;
  for (const SourceMesh& mesh : {chain(100, 1), chain(60, 12), chain(20, 64)}) {
    hits += check_answers(run, mesh, queries_for(mesh, 33));
    for_each_subject(mesh, [&](const Subject& subject) {
      const WalkFigures figures = walk_tree(subject.tree());
      const std::uint32_t most =
          is_wide(BoundTree::of(subject.tree()).codec()) ? kMaxWideDepth : kMaxDepth;
      run.check(figures.depth <= most && figures.missed == 0 && figures.escapes == 0,
                [&] { return subject.name; });
    });
  }
  run.premise(hits > 5000, "hardly any answer names a face");
}

// All faces are reached, and decoded triangles equal the input, corner by corner.
void check_counts(Run& run, const SourceMesh& mesh, CodecId codec, const Store& store) {
  const Subject subject = make_subject(mesh, codec, store);
  const auto name = [&] {
    return subject.name + ": " + std::to_string(mesh.faces.size()) + " faces";
  };
  const WalkFigures figures = walk_tree(subject.tree());
  run.check(figures.missed == 0 && figures.repeated == 0 && figures.escapes == 0, name);
  std::uint64_t wrong = 0;
  const std::vector<DecodedTriangle> triangles = decoded_triangles(subject.tree());
  run.check(triangles.size() == mesh.triangle_count(), name);
  const double tolerance = store.geometry == GeometryId::kExact
                               ? 0
                               : std::ldexp(1.0, BoundTree::of(subject.tree()).grid_exponent());
  for (const DecodedTriangle& t : triangles) {
    const Triangle source = source_triangle(mesh, t.face, t.half);
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d error =
          BoundTree::of(subject.tree()).frame().to_object(t.triangle.corner[c]) - source.corner[c];
      wrong += error.cwiseAbs().maxCoeff() <= tolerance ? 0u : 1u;
    }
  }
  run.check(wrong == 0, name);
}

// A strip of quads and triangles with exactly `count` vertices; the last vertex is also a fourth
// corner, because 0xffff marks a missing corner where corners take 16 bits.
SourceMesh with_vertices(std::uint32_t count) {
  SourceMesh mesh;
  mesh.name = std::to_string(count) + " vertices";
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto x = static_cast<float>(i / 2);
    mesh.positions.f32.insert(mesh.positions.f32.end(), {x, static_cast<float>(i % 2), 0});
  }
  for (std::uint32_t i = 0; i + 2 < count; i += 2) {
    mesh.faces.push_back({{i, i + 1, i + 2, cooker::kNoCorner}});
  }
  for (std::uint32_t i = count - 5; i + 3 < count; ++i) {  // the last of these ends at count - 1
    mesh.faces.push_back({{i, i + 1, i + 2, i + 3}});
  }
  mesh.faces.push_back({{count - 1, count - 3, count - 4, count - 2}});
  return mesh;
}

void counts(Run& run) {
  for (const Store& store : kStores) {
    for (const CodecInfo& codec : kCodecs) {
      check_counts(run, test::terrain(182, 1), codec.id, store);  // 66248 faces
      for (const std::uint32_t vertices : {65'534u, 65'535u, 65'536u, 65'537u}) {
        check_counts(run, with_vertices(vertices), codec.id, store);
      }
    }
  }
  if (!run.is_full()) return;
  for (const CodecInfo& codec : kCodecs) {  // 2 101 250 faces
    check_counts(run, test::terrain(1025, 1), codec.id, kExactStore);
  }
  check_counts(run, test::terrain(2897, 1), CodecId::kWide8, kStores[1]);  // 16 785 218 faces
  check_counts(run, test::terrain(2897, 1), CodecId::kPackedF16, kExactStore);
}

}  // namespace

std::vector<Case> shape_cases() {
  return {
      {"R19", "EqualCentroids", "equal centroids, one huge among tiny; depths that files claim",
       "wrong answers", 0, equal_centroids},
      {"R28", "Counts", "more than 2^16 faces (--full: 2^21, 2^24), 65534 to 65537 vertices",
       "wrong", 0, counts},
      {"E09", "DeepChains", "each triangle half as far and half as large as the one before",
       "wrong answers", 0, deep_chains},
  };
}

}  // namespace boxtree::robustness
