// SPDX-License-Identifier: MIT
// Generated meshes have the requested number of triangles and the same bits on every machine.
#include "tests/bench/generated_mesh.h"

#include <bit>
#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include "cooker/import/import.h"
#include "tests/bench/mesh_files.h"
#include "tests/support/temp_folder.h"

namespace boxtree::bench {
namespace {

using cooker::SourceMesh;

// FNV-1a over the bits of positions and corners.
std::uint64_t hash_of(const SourceMesh& mesh) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto add = [&hash](std::uint32_t bits) { hash = (hash ^ bits) * 0x100000001b3u; };
  for (const float coordinate : mesh.positions.f32) add(std::bit_cast<std::uint32_t>(coordinate));
  for (const cooker::Face& face : mesh.faces) {
    for (const std::uint32_t corner : face.corner) add(corner);
  }
  return hash;
}

TEST(GeneratedMesh, ExactlyAsManyTrianglesAsRequested) {
  for (const std::size_t count : {1u, 2u, 3u, 7u, 31u, 33u, 1000u, 10'001u, 123'457u}) {
    for (const SourceMesh& mesh : {make_terrain(count, 1), make_city(count, 1)}) {
      ASSERT_EQ(mesh.faces.size(), count) << mesh.name;
      for (const float coordinate : mesh.positions.f32) ASSERT_TRUE(std::isfinite(coordinate));
      for (const cooker::Face& face : mesh.faces) {
        ASSERT_FALSE(face.is_quad());
        for (std::size_t i = 0; i < 3; ++i) ASSERT_LT(face.corner[i], mesh.positions.size());
      }
    }
  }
}

// Pinned, so that figures measured on different machines are comparable.
TEST(GeneratedMesh, SameBitsOnEveryMachine) {
  EXPECT_EQ(hash_of(make_terrain(10'000, 1)), 8191482105794275195u);
  EXPECT_EQ(hash_of(make_city(10'000, 1)), 9566175541783242768u);
  EXPECT_NE(hash_of(make_terrain(10'000, 2)), hash_of(make_terrain(10'000, 1)));
  EXPECT_NE(hash_of(make_city(10'000, 2)), hash_of(make_city(10'000, 1)));
}

TEST(GeneratedMesh, FilesHoldTheMesh) {
  const test::TempFolder folder;
  for (const SourceMesh& mesh : {make_terrain(5'000, 3), make_city(5'000, 3)}) {
    for (const char* name : {"mesh.ply", "mesh.stl"}) {
      write_mesh(mesh, folder.path() / name);
      const auto got = cooker::import_mesh(folder.path() / name);
      ASSERT_TRUE(got.ok()) << got.error().message();
      ASSERT_EQ(got->mesh.faces.size(), mesh.faces.size());
      EXPECT_EQ(got->report.degenerate_faces, 0u) << mesh.name;
      for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
        for (std::size_t corner = 0; corner < 3; ++corner) {
          ASSERT_EQ(got->mesh.positions[got->mesh.faces[i].corner[corner]],
                    mesh.positions[mesh.faces[i].corner[corner]]);
        }
      }
    }
  }
  EXPECT_THROW(write_mesh(make_terrain(2, 1), folder.path() / "a.obj"), std::runtime_error);
  EXPECT_THROW(write_mesh(make_terrain(2, 1), folder.path() / "none" / "a.ply"),
               std::runtime_error);
}

}  // namespace
}  // namespace boxtree::bench
