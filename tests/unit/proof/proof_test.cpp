// SPDX-License-Identifier: MIT
// What verify says of hostile trees, and that it ends: work and memory are bounded by the bytes.
#include "cooker/proof/proof.h"

#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "format/codec_plain.h"
#include "format/codec_wide.h"
#include "format/container.h"
#include "format/tree_record.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

using FileBytes = std::vector<std::byte>;

bool has(const cooker::Findings& findings, Errc code) {
  return std::any_of(findings.begin(), findings.end(),
                     [code](const Error& finding) { return finding.code == code; });
}

// Nodes that share their children are met 2^59 times if nobody counts.
TEST(Proof, SharedChildrenOfBinaryNodesEndIt) {
  FileBytes bytes = test::cook_bytes(test::soup(61, 1), CodecId::kPlainF32);
  test::edit_records<PlainNodeF32>(
      bytes, SectionKind::kNodes, [](PlainNodeF32& node, std::uint32_t i, std::uint32_t count) {
        if (i + 1 == count) return;
        node = {
            plain_cutplane(0, PlainChild::kSubtree, PlainChild::kSubtree), {i + 1, i + 1}, {0, 0}};
      });
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok());
  EXPECT_TRUE(has(cooker::verify_file(*file), Errc::kNodeCorrupt));
}

TEST(Proof, SharedChildrenOfWideNodesEndIt) {
  FileBytes bytes = test::cook_bytes(test::soup(20000, 1), CodecId::kWide8);
  test::edit_records<Wide8Node>(bytes, SectionKind::kNodes,
                                [](Wide8Node& node, std::uint32_t i, std::uint32_t count) {
                                  if (i + 8 >= count) return;
                                  node = {};
                                  node.first_node = i + 1;
                                  node.inner_mask = 0xff;
                                  node.child_count = 8;
                                });
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok());
  EXPECT_FALSE(cooker::verify_file(*file).empty());
}

// An extent far below that of another axis was told as [0.000000, 0.000000].
TEST(Proof, SmallNumbersAreTold) {
  cooker::SourceMesh mesh = test::soup(61, 1);
  for (std::size_t i = 2; i < mesh.positions.f32.size(); i += 3) mesh.positions.f32[i] *= 1e-20f;
  FileBytes bytes = test::cook_bytes(mesh, CodecId::kPlainF32);
  test::edit_records<TreeRecord>(
      bytes, SectionKind::kTrees,
      [](TreeRecord& tree, std::uint32_t /*i*/, std::uint32_t /*count*/) {
        tree.root_high[2] = tree.root_low[2];
      });
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok());
  const cooker::Findings findings = cooker::verify_file(*file);
  const auto escape = std::find_if(findings.begin(), findings.end(), [](const Error& finding) {
    return finding.code == Errc::kBoxEscape;
  });
  ASSERT_NE(escape, findings.end());
  EXPECT_NE(escape->detail.find("e-"), std::string::npos) << escape->detail;
  EXPECT_EQ(escape->detail.find("0.000000,"), std::string::npos) << escape->detail;
}

// 2^31 - 1 faces in a file of a few hundred bytes: nobody makes room for them.
TEST(Proof, FacesWithoutLeavesAreRefused) {
  for (const CodecId codec : test::all_codecs()) {
    for (const std::uint32_t source_faces : {1u, 30u}) {
      FileBytes bytes = test::cook_bytes(test::soup(source_faces, 1), codec);
      test::edit_records<TreeRecord>(bytes, SectionKind::kTrees,
                                     [](TreeRecord& record, std::uint32_t, std::uint32_t) {
                                       record.face_count = kMaxFaces;
                                       record.triangle_count = kMaxFaces;
                                     });
      const Result<File> file = File::open(Bytes(bytes));
      ASSERT_TRUE(file.ok());
      EXPECT_EQ(Tree::bind(*file).code(), Errc::kRecordInvalid);
      EXPECT_TRUE(has(cooker::verify_file(*file), Errc::kRecordInvalid));
    }
  }
}

}  // namespace
}  // namespace boxtree
