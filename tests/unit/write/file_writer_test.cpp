// SPDX-License-Identifier: MIT
// What files hold besides trees: few bytes, so that many small ones cost no more than one.
#include "cooker/write/file_writer.h"

#include <gtest/gtest.h>

#include "format/container.h"
#include "format/limits.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

// Header, section table, record, name and padding: what is not nodes, geometry or face ids.
std::uint64_t bytes_of_container(const SourceMesh& mesh, GeometryId geometry) {
  CookOptions options;
  options.geometry = geometry;
  options.grid.bits = 16;
  const std::vector<std::byte> file = test::cook_bytes(mesh, CodecId::kWide8, options);
  std::uint64_t bytes = file.size();
  for (const SectionEntry& entry : test::sections_of(file)) {
    if (entry.kind != SectionKind::kTrees && entry.kind != SectionKind::kNames) bytes -= entry.size;
  }
  return bytes;
}

TEST(FileWriter, ContainersOfSmallFilesTakeAtMost256Bytes) {
  for (const GeometryId geometry : {GeometryId::kExact, GeometryId::kGrid, GeometryId::kArrays}) {
    for (const SourceMesh& mesh :
         {test::soup(12, 1), test::torus(25, 10), test::sphere(16, 16), test::city(2, 1)}) {
      EXPECT_LE(bytes_of_container(mesh, geometry), geometry == GeometryId::kArrays ? 272u : 256u)
          << mesh.faces.size() << " faces, geometry " << geometry_name(geometry);
    }
  }
}

// One more than files could hold once, and as many as rows of the section table can tell apart.
TEST(FileWriter, FilesHoldAsManyTreesAsTheSectionTableTellsApart) {
  const EncodedTree tree = test::require(cook_as(test::soup(2, 1), CodecId::kWide8));
  for (const std::uint32_t count : {4097u, kMaxTrees}) {
    const std::vector<std::byte> bytes = serialize(std::vector<EncodedTree>(count, tree));
    const File file = test::require(File::open(Bytes(bytes)));
    ASSERT_EQ(file.tree_count(), count);
    const Tree last = test::require(Tree::bind(file, count - 1));
    EXPECT_EQ(last.face_count(), 2u);
  }
  const test::TempFolder folder;
  const std::vector<EncodedTree> more(kMaxTrees + 1, tree);
  EXPECT_EQ(write_file(folder.path() / "more.bxt", {more, {}}).code(), Errc::kMeshTooLarge);
}

}  // namespace
}  // namespace boxtree::cooker
