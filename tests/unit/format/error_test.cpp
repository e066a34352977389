// SPDX-License-Identifier: MIT
// The pinned error table, as literals: a change here is a change of the interface.
#include <gtest/gtest.h>

#include <boxtree/error.h>

namespace boxtree {
namespace {

struct Row {
  unsigned code;
  const char* name;
  int exit_status;
};

constexpr Row kPinned[] = {
    {0, "ok", 0},
    {10, "bad_magic", 3},
    {11, "truncated", 3},
    {12, "version_unsupported", 5},
    {13, "feature_unsupported", 5},
    {14, "header_corrupt", 3},
    {15, "too_many_sections", 3},
    {18, "section_order", 3},
    {20, "section_missing", 3},
    {21, "section_size", 3},
    {22, "section_unknown", 5},
    {23, "padding_not_zero", 3},
    {24, "checksum_mismatch", 3},
    {25, "blob_limit", 3},
    {26, "blob_corrupt", 3},
    {30, "codec_unsupported", 5},
    {31, "geometry_unsupported", 5},
    {32, "record_invalid", 3},
    {33, "node_corrupt", 3},
    {34, "depth_exceeded", 3},
    {35, "face_out_of_range", 3},
    {36, "vertex_out_of_range", 3},
    {38, "box_escape", 3},
    {39, "face_unreachable", 3},
    {40, "face_repeated", 3},
    {41, "vertex_not_finite", 3},
    {42, "duplicate_differs", 3},
    {50, "invalid_query", 1},
    {51, "invalid_pose", 1},
    {52, "part_left_out", 5},
    {53, "external_mesh_needed", 1},
    {54, "external_mesh_mismatch", 3},
    {55, "tree_index", 1},
    {56, "no_scene", 1},
    {57, "instance_index", 1},
    {58, "instance_static", 1},
    {59, "work_limit", 1},
    {60, "file_not_found", 2},
    {61, "file_unreadable", 2},
    {62, "map_failed", 2},
    {63, "write_failed", 2},
    {64, "out_of_memory", 4},
    {70, "import_failed", 3},
    {71, "no_faces", 3},
    {72, "mesh_not_finite", 3},
    {73, "mesh_index_out_of_range", 3},
    {74, "mesh_too_large", 5},
    {75, "mesh_unsupported", 5},
    {76, "budget_unreachable", 1},
    {77, "profile_invalid", 3},
    {78, "document_invalid", 3},
    {90, "internal", 4},
};

TEST(ErrorTable, IsPinned) {
  ASSERT_EQ(error_table().size(), std::size(kPinned));
  for (std::size_t i = 0; i < std::size(kPinned); ++i) {
    const ErrcInfo& row = error_table()[i];
    EXPECT_EQ(static_cast<unsigned>(row.code), kPinned[i].code);
    EXPECT_EQ(row.name, kPinned[i].name);
    EXPECT_EQ(row.exit_status, kPinned[i].exit_status) << row.name;
    EXPECT_FALSE(row.meaning.empty()) << row.name;
    EXPECT_EQ(error_info(row.code).code, row.code);
  }
}

TEST(ErrorTable, UnknownNumbersAreInternal) {
  EXPECT_EQ(error_info(static_cast<Errc>(1234)).code, Errc::kInternal);
}

TEST(ErrorMessage, OfAnInvalidQuerySaysWhatIsExpected) {
  EXPECT_EQ(Error(Errc::kInvalidQuery, "radius").message(),
            "invalid_query: radius: expected finite and 0 or more");
  EXPECT_EQ(
      Error(Errc::kInvalidQuery, "hit: struct_size").message(),
      "invalid_query: hit: struct_size: expected sizeof the struct, and zeros in newer members");
  EXPECT_EQ(Error(Errc::kInvalidQuery, "results.size()").message(),
            "invalid_query: results.size()");
  EXPECT_EQ(Error(Errc::kInvalidPose, "radius").message(), "invalid_pose: radius");
}

}  // namespace
}  // namespace boxtree
