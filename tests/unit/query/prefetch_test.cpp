// SPDX-License-Identifier: MIT
// What Tree::prefetch reads of a cold file: the nodes of the first levels, as a reader of the bytes
// of nodes finds them, and nothing else.
#include <algorithm>
#include <iterator>
#include <set>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/report/pages.h"
#include "format/codec_packed.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree {
namespace {

using Pages = std::set<std::size_t>;

constexpr std::size_t kPage = 4096;
constexpr std::uint32_t kAllLevels = 1000;

// A number of `Number`'s size, at any byte.
template <class Number>
Number number_at(const std::byte* at) {
  Number number;
  std::memcpy(&number, at, sizeof(number));
  return number;
}

// The child nodes of a node as FORMAT.md, sections 5 and 7, describes its bytes.
std::vector<std::uint32_t> child_nodes(CodecId codec, const std::byte* node) {
  std::vector<std::uint32_t> children;
  if (codec == CodecId::kPlainF16 || codec == CodecId::kPlainF32) {
    const auto cutplane = number_at<std::uint32_t>(node);
    for (unsigned side = 0; side < 2; ++side) {
      if ((cutplane >> (2 + 2 * side) & 3u) != 2) continue;
      children.push_back(number_at<std::uint32_t>(node + 4 + std::size_t{4} * side));
    }
    return children;
  }
  std::uint32_t first = 0;
  std::uint32_t mask = 0;
  if (codec == CodecId::kWide8) {
    first = number_at<std::uint32_t>(node + 48);
    mask = number_at<std::uint8_t>(node + 56);
  } else {
    const auto links = number_at<std::uint64_t>(node + 24);
    first = static_cast<std::uint32_t>(links & ((1u << 26) - 1));
    mask = static_cast<std::uint32_t>(links >> 53 & 0xffu);
  }
  for (; mask != 0; mask &= mask - 1) children.push_back(first++);
  return children;
}

std::size_t bytes_of_node(CodecId codec) {
  switch (codec) {
    case CodecId::kPlainF32:
      return 20;
    case CodecId::kPlainF16:
      return 16;
    case CodecId::kWide8:
      return 64;
    case CodecId::kWide4:
      return 32;
    default:
      return 0;  // bits
  }
}

// A cooked file and the pages that are read of it.
class ColdFile {
 public:
  explicit ColdFile(CodecId codec)
      : bytes_(test::cook_bytes(test::terrain(160, 3), codec)),
        path_(folder_.write("cold.bxt",
                            {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()})) {}

  // Those that `work` on a tree reads, from opening on.
  template <class Work>
  [[nodiscard]] Pages pages(const Work& work) const {
    const auto read = test::require(cooker::pages_read(path_, [&](Bytes file) -> Status {
      const File opened = test::require(File::open(file));
      work(test::require(Tree::bind(opened)));
      return {};
    }));
    return {read.begin(), read.end()};
  }

  [[nodiscard]] SectionEntry nodes() const { return test::entry_of(bytes_, SectionKind::kNodes); }
  [[nodiscard]] const std::byte* node_bytes() const { return bytes_.data() + nodes().offset; }

  // Those that hold any byte of the nodes.
  [[nodiscard]] Pages pages_of_nodes() const { return pages_of(0, nodes().size); }
  // Those that hold `size` bytes of the section of nodes.
  [[nodiscard]] Pages pages_of(std::size_t from, std::size_t size) const {
    Pages pages;
    const std::size_t begin = nodes().offset + from;
    for (std::size_t page = begin / kPage; page <= (begin + size - 1) / kPage; ++page) {
      pages.insert(page);
    }
    return pages;
  }

 private:
  test::TempFolder folder_;
  std::vector<std::byte> bytes_;
  std::filesystem::path path_;
};

Pages united(Pages a, const Pages& b) {
  a.insert(b.begin(), b.end());
  return a;
}

bool has_all(const Pages& pages, const Pages& some) {
  return std::includes(pages.begin(), pages.end(), some.begin(), some.end());
}

class PrefetchOf : public testing::TestWithParam<CodecId> {};

TEST_P(PrefetchOf, ReadsNodesOnly) {
  const ColdFile file(GetParam());
  const Pages opening = file.pages([](const Tree&) {});
  EXPECT_EQ(file.pages([](const Tree& tree) { EXPECT_EQ(tree.prefetch(0), 0u); }), opening);
  const Pages allowed = united(opening, file.pages_of_nodes());
  EXPECT_GT(allowed.size(), opening.size() + 3) << "too small to tell pages apart";
  std::size_t before = 0;
  for (std::uint32_t levels = 1; levels < 12; ++levels) {
    const Pages pages = file.pages([&](const Tree& tree) { tree.prefetch(levels); });
    EXPECT_TRUE(has_all(allowed, pages)) << levels;
    EXPECT_GE(pages.size(), before) << levels;
    before = pages.size();
  }
}

TEST_P(PrefetchOf, AllLevelsLeaveNoNodeToRead) {
  const ColdFile file(GetParam());
  const Pages ahead = file.pages([](const Tree& tree) {
    EXPECT_EQ(tree.prefetch(kAllLevels), BoundTree::of(tree).node_count());
  });
  const Pages nodes = file.pages_of_nodes();
  const Pages all = file.pages([](const Tree& tree) {
    const auto every = [](const auto&) { return true; };
    EXPECT_TRUE(traverse(tree, every, every).ok());
  });
  Pages walked;  // of the nodes, by a walk of the whole tree
  std::set_intersection(all.begin(), all.end(), nodes.begin(), nodes.end(),
                        std::inserter(walked, walked.begin()));
  // The last page of the nodes may be the first of the next section.
  if (!has_all(ahead, {*nodes.rbegin()})) walked.erase(*nodes.rbegin());
  EXPECT_TRUE(has_all(ahead, walked));
}

TEST_P(PrefetchOf, AnswersStayTheSame) {
  const test::CookedTree cooked = test::cook_tree(test::torus(24, 16), GetParam());
  const Ray ray{{1, 0.01, 9}, {0, 0, -1}};
  const auto before = test::require(closest_hit(cooked.tree, ray));
  EXPECT_EQ(cooked.tree.prefetch(kAllLevels), BoundTree::of(cooked.tree).node_count());
  const auto after = test::require(closest_hit(cooked.tree, ray));
  ASSERT_TRUE(before && after);
  EXPECT_EQ(before->t, after->t);
  EXPECT_EQ(before->face.id, after->face.id);
}

INSTANTIATE_TEST_SUITE_P(Codecs, PrefetchOf, testing::ValuesIn(test::all_codecs()),
                         test::test_name);

class PrefetchByBytes : public testing::TestWithParam<CodecId> {};

TEST_P(PrefetchByBytes, ReadsTheLevels) {
  const ColdFile file(GetParam());
  const std::size_t size = bytes_of_node(GetParam());
  Pages expected = file.pages([](const Tree&) {});
  std::vector<std::uint32_t> level = {0};
  std::uint32_t nodes = 0;
  std::uint32_t levels = 0;
  while (!level.empty()) {
    ++levels;
    nodes += static_cast<std::uint32_t>(level.size());
    std::vector<std::uint32_t> next;
    for (const std::uint32_t node : level) {
      expected = united(expected, file.pages_of(node * size, size));
      const auto children = child_nodes(GetParam(), file.node_bytes() + node * size);
      next.insert(next.end(), children.begin(), children.end());
    }
    const Pages pages =
        file.pages([&](const Tree& tree) { EXPECT_EQ(tree.prefetch(levels), nodes) << levels; });
    EXPECT_EQ(pages, expected) << levels;
    level = std::move(next);
  }
  EXPECT_GT(levels, 3u);
}

INSTANTIATE_TEST_SUITE_P(Codecs, PrefetchByBytes,
                         testing::Values(CodecId::kPlainF32, CodecId::kPlainF16, CodecId::kWide8,
                                         CodecId::kWide4),
                         test::test_name);

TEST(Prefetch, TreesWithoutNodesHaveNothingToRead) {
  const test::CookedTree leaf = test::cook_tree(test::soup(3, 1), CodecId::kWide8);
  EXPECT_FALSE(BoundTree::of(leaf.tree).has_nodes());
  EXPECT_EQ(leaf.tree.prefetch(kAllLevels), 0u);
  const test::CookedTree empty = test::cook_tree(cooker::SourceMesh{}, CodecId::kWide8);
  EXPECT_TRUE(empty.tree.empty());
  EXPECT_EQ(empty.tree.prefetch(kAllLevels), 0u);
}

TEST(Prefetch, EndsAtACorruptNode) {
  std::vector<std::byte> bytes = test::cook_bytes(test::torus(24, 16), CodecId::kWide8);
  const SectionEntry nodes = test::entry_of(bytes, SectionKind::kNodes);
  bytes[nodes.offset + 57] = std::byte{9};  // children of the root
  test::repair_checksums(bytes);
  const File file = test::require(File::open(Bytes(bytes)));
  const Tree tree = test::require(Tree::bind(file));
  EXPECT_EQ(tree.prefetch(kAllLevels), 0u);
}

// A node of a packed codec that is its own children: nothing of it alone is wrong.
TEST(Prefetch, NodesInACircleEnd) {
  std::vector<std::byte> bytes = test::cook_bytes(test::torus(24, 16), CodecId::kPackedF16);
  const SectionEntry nodes = test::entry_of(bytes, SectionKind::kNodes);
  const auto header = load<PackedHeader>(bytes.data() + nodes.offset);
  constexpr auto kInner = static_cast<std::uint8_t>(NodeKind::kNoLeaves);
  ASSERT_EQ(header.root_kind, kInner);
  std::byte* const root = bytes.data() + nodes.offset + PackedPlaces(header).array_at[kInner];
  const PackedLayout layout(NodeKind::kNoLeaves, header);
  std::fill_n(root, (layout.number_at[1] + layout.number_bits[1]) / 8, std::byte{0});
  *root = std::byte{kInner << 2 | kInner << 4};  // axis 0, both children inner nodes, both number 0
  test::repair_checksums(bytes);
  const File file = test::require(File::open(Bytes(bytes)));
  const Tree tree = test::require(Tree::bind(file));
  EXPECT_LE(tree.prefetch(kAllLevels), BoundTree::of(tree).node_count());
}

}  // namespace
}  // namespace boxtree
