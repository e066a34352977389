// SPDX-License-Identifier: MIT
// Opening by path: what is refused and how it is named, and what a copy is immune to.
#include <filesystem>
#include <fstream>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/file/cooked_pages.h"

namespace boxtree {
namespace {

std::string cooked_text() {
  const std::vector<std::byte> bytes = test::cook_bytes(test::torus(8, 6), CodecId::kPlainF16);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

TEST(FileOpen, NamesThePathOfWhatItRefuses) {
  const test::TempFolder folder;
  struct Case {
    std::filesystem::path path;
    Errc expected;
  };
  const std::string whole = cooked_text();
  const Case cases[] = {
      {folder.path() / "missing.bxt", Errc::kFileNotFound},
      {folder.path(), Errc::kFileUnreadable},
      {folder.write("empty.bxt", ""), Errc::kTruncated},
      {folder.write("short.bxt", whole.substr(0, 63)), Errc::kTruncated},
      {folder.write("cut.bxt", whole.substr(0, whole.size() - 64)), Errc::kTruncated},
      {folder.write("text.bxt", std::string(200, 'x')), Errc::kBadMagic},
      {folder.write("magic.bxt", whole.substr(0, 5)), Errc::kTruncated},
      {folder.write("small.obj", "v 0 0 0\nv 1 0 0\n"), Errc::kBadMagic},
      {folder.write("byte.obj", "v"), Errc::kBadMagic},
      {folder.write("damaged.bxt", whole.substr(0, 4) + "x"), Errc::kBadMagic},
  };
  for (const Case& c : cases) {
    for (const bool copy : {false, true}) {
      OpenOptions options;
      options.copy = copy;
      const Result<File> file = File::open(c.path.string(), options);
      ASSERT_EQ(file.code(), c.expected) << c.path;
      EXPECT_NE(file.error().detail.find(c.path.string()), std::string::npos)
          << file.error().detail;
    }
  }
}

// The same name and words wherever a file is looked for, also where a file is in the place of a
// folder.
TEST(FileOpen, MissingFileHasOneMessage) {
  const test::TempFolder folder;
  const std::filesystem::path file = folder.write("file", "x");
  for (const std::filesystem::path& path : {folder.path() / "missing.bxt", file / "missing.bxt"}) {
    EXPECT_EQ(File::open(path.string()).error().message(),
              "file_not_found: " + path.string() + ": no such file; check the name");
  }
  EXPECT_EQ(File::open("missing.bxt").error().message(),
            "file_not_found: missing.bxt: no such file; check the name, which is relative to the "
            "current folder");
  EXPECT_EQ(File::open("").error().message(),
            "file_not_found: expected the name of a file, found an empty one");
  // Found by a newcomer: a string of what a file holds is taken for its name.
  EXPECT_EQ(File::open(cooked_text()).error().message(),
            "file_not_found: expected the name of a file, found the bytes of one: pass them as "
            "Bytes");
}

TEST(FileOpen, NamesAreUtf8) {
  const test::TempFolder folder;
  const std::string whole = cooked_text();
  for (const std::u8string name :
       {u8"gr\u00f6\u00dfe.bxt", u8"\u65e5\u672c.bxt", u8"\U0001f333.bxt"}) {
    std::ofstream(folder.path() / name, std::ios::binary) << whole;
    const std::string in_utf8 =
        folder.path().string() + "/" + std::string(name.begin(), name.end());
    EXPECT_TRUE(File::open(in_utf8).ok()) << in_utf8;
  }
}

TEST(FileOpen, MapAndCopyAndMemoryAgree) {
  const test::TempFolder folder;
  const std::string whole = cooked_text();
  const std::filesystem::path path = folder.write("torus.bxt", whole);
  // Records are read at any alignment: one byte off on purpose.
  const std::string shifted = "x" + whole;
  OpenOptions copy;
  copy.copy = true;
  copy.verify_checksums = true;
  for (const Result<File>& file : {File::open(path.string()), File::open(path.string(), copy),
                                   File::open(std::as_bytes(std::span(shifted)).subspan(1))}) {
    ASSERT_TRUE(file.ok()) << file.error().message();
    const Result<Tree> tree = Tree::bind(*file);
    ASSERT_TRUE(tree.ok());
    const auto hit = closest_hit(*tree, {{1, 0.01, 9}, {0, 0, -1}});
    ASSERT_TRUE(hit.ok() && hit.has_value());
  }
}

TEST(FileOpen, ACopyOutlivesItsFile) {
  const test::TempFolder folder;
  const std::filesystem::path path = folder.write("torus.bxt", cooked_text());
  OpenOptions options;
  options.copy = true;
  const Result<File> file = File::open(path.string(), options);
  ASSERT_TRUE(file.ok());
  std::filesystem::resize_file(path, 0);
  EXPECT_TRUE(verify_checksums(*file).ok());
}

constexpr Access kEveryAccess[] = {Access::kRandom, Access::kSequential, Access::kNormal,
                                   Access::kWillNeed, Access::kDontNeed};

// The system would take kDontNeed of a copy, too, and its bytes would be zeros afterwards.
TEST(FileAdvice, DoesNothingInMemory) {
  const test::TempFolder folder;
  const std::string whole = test::cooked_pages();
  OpenOptions copy;
  copy.copy = true;
  for (const Result<File>& opened : {File::open(folder.write("terrain.bxt", whole).string(), copy),
                                     File::open(std::as_bytes(std::span(whole)))}) {
    ASSERT_TRUE(opened.ok());
    for (const Access access : kEveryAccess) EXPECT_FALSE(opened->advise(access));
    EXPECT_TRUE(verify_checksums(*opened).ok());
  }
}

TEST(FileTrees, AreFoundByNumberAndName) {
  std::vector<cooker::EncodedTree> trees;
  for (const cooker::SourceMesh& mesh : {test::torus(8, 6), test::sphere(6, 8)}) {
    trees.push_back(std::move(cooker::cook_mesh(mesh, {})->tree));
  }
  const std::vector<std::byte> bytes = cooker::serialize(trees);
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok());
  ASSERT_EQ(file->tree_count(), 2u);
  EXPECT_EQ(file->tree_name(0), "torus");
  EXPECT_EQ(file->tree_name(1), "sphere");
  EXPECT_EQ(*file->find_tree("sphere"), 1u);
  EXPECT_EQ(file->find_tree("cube").code(), Errc::kTreeIndex);
  EXPECT_EQ(Tree::bind(*file, 2).error().message(),
            "tree_index: there is no tree 2; expected 0 or 1");
  EXPECT_EQ(BoundTree::of(*Tree::bind(*file, 1)).face_count(), trees[1].face_count);
}

}  // namespace
}  // namespace boxtree
