// SPDX-License-Identifier: MIT
// Which codecs can be bound, and that one without walks of its own answers alike.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>
#include <boxtree/paper.h>

#include "format/codec_packed.h"
#include "format/codec_plain.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

constexpr CodecFunctions kPlain = functions_of<PlainCodec<float>>(CodecId::kPlainF32);
constexpr CodecFunctions kPacked = functions_of<PackedCodec<PackedCut::kF64>>(CodecId::kPackedF64);
constexpr const CodecFunctions* kWithoutWalks[] = {&kPlain, &kPacked};
constexpr CodecSet kWithoutWalksSet(kWithoutWalks);

std::vector<std::uint32_t> sorted(std::vector<std::uint32_t> faces) {
  std::sort(faces.begin(), faces.end());
  return faces;
}

// Every kind of query, as numbers that are compared to the last bit.
std::vector<double> answers_by_kind(const Tree& tree) {
  std::vector<double> out;
  std::mt19937_64 random(7);
  const auto unit = [&] { return static_cast<double>(random() >> 11) * 0x1p-52 - 1; };
  const auto point = [&] { return Eigen::Vector3d(2 * unit(), 2 * unit(), 2 * unit()); };
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d from = point();
    const auto hit = closest_hit(tree, {from, point() - from});
    out.insert(out.end(), {hit ? hit->t : -1, hit ? static_cast<double>(hit->face.id) : -1});
    const auto touch = cast_closest(tree, Sphere{from, 0.1}, Motion{point() - from});
    out.insert(out.end(),
               {touch ? touch->t : -1, touch ? static_cast<double>(touch->face.id) : -1});
    const auto near = closest_point(tree, from);
    out.insert(out.end(), {near->distance, static_cast<double>(near->face.id)});
    std::vector<std::uint32_t> box, sphere;
    const auto keep = [](std::vector<std::uint32_t>& faces) {
      return [&faces](const FaceRef& face) {
        faces.push_back(face.id);
        return true;
      };
    };
    const Eigen::Vector3d half(0.4, 0.4, 0.4);
    EXPECT_TRUE(overlap_box(tree, {from - half, from + half}, keep(box)).ok());
    EXPECT_TRUE(overlap_sphere(tree, from, 0.5, keep(sphere)).ok());
    for (const auto* faces : {&box, &sphere}) {
      for (const std::uint32_t face : sorted(*faces)) out.push_back(face);
    }
  }
  std::vector<std::uint32_t> touching;
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0.3, 0.2, 0.1);
  EXPECT_TRUE(overlap_pairs(tree, Pose::Identity(), tree, pose, [&](const FacePair& pair) {
                return touching.push_back(pair.first.id * 100000 + pair.second.id), true;
              }).ok());
  for (const std::uint32_t pair : sorted(touching)) out.push_back(pair);
  return out;
}

TEST(CodecRegistry, ACodecWithoutWalksOfItsOwnIsWalkedByItsFunctions) {
  for (const CodecId codec : {CodecId::kPlainF32, CodecId::kPackedF64}) {
    const test::CookedTree cooked = test::cook_tree(test::torus(24, 16), codec);
    use_paper_codecs();
    const Result<Tree> with = Tree::bind(cooked.file);
    add_codecs(kWithoutWalksSet);
    const Result<Tree> without = Tree::bind(cooked.file);
    use_paper_codecs();
    ASSERT_TRUE(with.ok() && without.ok());
    ASSERT_NE(BoundTree::of(*with).codec_functions().walks, nullptr);
    ASSERT_EQ(BoundTree::of(*without).codec_functions().walks, nullptr);
    const std::vector<double> expected = answers_by_kind(*with);
    EXPECT_GT(expected.size(), 500u);
    EXPECT_EQ(answers_by_kind(*without), expected) << codec_name(codec);
  }
}

TEST(CodecRegistry, ACodecOfAnUnusedLibraryNamesIt) {
  const test::CookedTree cooked = test::cook_tree(test::torus(24, 16), CodecId::kDedup);
  add_codecs(kWithoutWalksSet);
  const Result<Tree> tree = Tree::bind(cooked.file);
  use_paper_codecs();
  ASSERT_EQ(tree.code(), Errc::kCodecUnsupported);
  EXPECT_NE(tree.error().detail.find("dedup is a codec of boxtree::paper: link it and call "
                                     "use_paper_codecs()"),
            std::string::npos)
      << tree.error().detail;
  EXPECT_TRUE(Tree::bind(cooked.file).ok());
}

TEST(CodecRegistry, ATreeWithoutNodesIsOfNoCodec) {
  const test::CookedTree cooked = test::cook_tree(test::soup(4, 1), CodecId::kWide8);
  const BoundTree& tree = BoundTree::of(cooked.tree);
  EXPECT_EQ(tree.codec(), CodecId::kWide8);
  ASSERT_FALSE(tree.has_nodes());
  EXPECT_EQ(&tree.codec_functions(), &kNoCodec);
  AnyChildren children;
  EXPECT_EQ(kNoCodec.expand({}, {0, 0}, {}, children), NodeState::kCorrupt);
}

}  // namespace
}  // namespace boxtree
