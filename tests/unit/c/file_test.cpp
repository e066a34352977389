// SPDX-License-Identifier: MIT
// Files by the C interface, as by the C++ interface.
#include <array>
#include <boxtree_c.h>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "cooker/write/pack_writer.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

using test::Answer;
using test::answer_of_c;
using test::Numbers;

// Two trees with names, of letters that take two bytes.
std::vector<std::byte> two_trees() {
  std::vector<cooker::EncodedTree> trees;
  for (const char* name : {"boulder", "h\u00f6hle"}) {
    cooker::SourceMesh mesh = test::torus(6, 5);
    mesh.name = name;
    trees.push_back(test::require(cooker::cook_as(mesh, CodecId::kWide8, {})));
  }
  return cooker::serialize(trees);
}

void write(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
}

// As bxt_file_open() does, which must agree with File::open().
Answer opened(const std::string& path, const bxt_file_options* options) {
  return answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
    bxt_file* file = nullptr;
    const bxt_status status = bxt_file_open(path.c_str(), options, &file, error);
    EXPECT_EQ(file != nullptr, status == BXT_OK);
    if (file != nullptr) {
      found.push_back(Numbers() << bxt_file_tree_count(file) << bxt_file_has_scene(file));
      EXPECT_EQ(bxt_file_verify_checksums(file, nullptr), BXT_OK);
    }
    bxt_file_close(file);
    return status;
  });
}

TEST(CFiles, AreOpenedAsByCpp) {
  const test::TempFolder folder;
  const std::filesystem::path good = folder.path() / "gr\u00fcn.bxt";
  const std::filesystem::path damaged = folder.path() / "damaged.bxt";
  const std::filesystem::path cut = folder.path() / "cut.bxt";
  const std::filesystem::path scene = folder.path() / "scene.bxt";
  std::vector<std::byte> bytes = two_trees();
  write(good, bytes);
  bytes[bytes.size() / 2] ^= std::byte{1};
  write(damaged, bytes);
  bytes.resize(bytes.size() / 2);
  write(cut, bytes);
  write(scene, test::cook_scene({test::torus(6, 5)}, test::random_parts(5, 1, 2, 1, 1)).bytes);
  for (const std::filesystem::path& path :
       {good, damaged, cut, scene, folder.path() / "none.bxt", folder.path()}) {
    for (int way = 0; way < 4; ++way) {
      SCOPED_TRACE(path.string() + " " + std::to_string(way));
      OpenOptions options;
      bxt_file_options c = {};
      c.struct_size = sizeof c;
      c.copy = options.copy = way % 2 == 1;
      c.verify_checksums = options.verify_checksums = way == 3 || path == damaged;
      const Result<File> file = File::open(path.string(), options);
      Answer expected;
      note_error(file, expected);
      if (file) expected.found.push_back(Numbers() << file->tree_count() << file->has_scene());
      EXPECT_EQ(opened(path.string(), way == 0 && path != damaged ? nullptr : &c), expected);
    }
  }
}

TEST(CFiles, SayWhatTheyHold) {
  const std::vector<std::byte> bytes = two_trees();
  const test::CFile file = test::open_c(bytes);
  EXPECT_EQ(bxt_file_tree_count(file.get()), 2u);
  EXPECT_FALSE(bxt_file_has_scene(file.get()));
  char name[16];
  EXPECT_EQ(bxt_file_tree_name(file.get(), 0, name, sizeof name), 7u);
  EXPECT_STREQ(name, "boulder");
  EXPECT_EQ(bxt_file_tree_name(file.get(), 1, name, sizeof name), 6u);
  EXPECT_STREQ(name, "h\u00f6hle");
  EXPECT_EQ(bxt_file_tree_name(file.get(), 2, name, sizeof name), 0u);
  EXPECT_STREQ(name, "");
  // A character that does not fit whole is left out, and what lies behind the buffer is not
  // touched.
  name[2] = '#';
  EXPECT_EQ(bxt_file_tree_name(file.get(), 1, name, 3), 6u);
  EXPECT_STREQ(name, "h");
  EXPECT_EQ(name[2], '#');
  EXPECT_EQ(bxt_file_tree_name(file.get(), 1, name, 4), 6u);
  EXPECT_STREQ(name, "h\u00f6");
  std::uint32_t number = 9;
  EXPECT_EQ(bxt_file_find_tree(file.get(), "h\u00f6hle", &number, nullptr), BXT_OK);
  EXPECT_EQ(number, 1u);
  number = 9;
  Answer expected;
  note_error(test::require(File::open(Bytes(bytes))).find_tree("cave"), expected);
  EXPECT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>&) {
              return bxt_file_find_tree(file.get(), "cave", &number, error);
            }),
            expected);
  EXPECT_EQ(number, 9u);
  bxt_tree* tree = nullptr;
  EXPECT_EQ(bxt_tree_bind(file.get(), BXT_ONLY_TREE, nullptr, &tree, nullptr), BXT_TREE_INDEX);
}

TEST(CFiles, ChecksumsAreVerifiedAsByCpp) {
  std::vector<std::byte> bytes = two_trees();
  bytes[bytes.size() / 2] ^= std::byte{1};
  const File file = test::require(File::open(Bytes(bytes)));
  const test::CFile c_file = test::open_c(bytes);
  Answer expected;
  note_error(verify_checksums(file), expected);
  EXPECT_EQ(expected.status, BXT_CHECKSUM_MISMATCH);
  EXPECT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>&) {
              return bxt_file_verify_checksums(c_file.get(), error);
            }),
            expected);
}

TEST(CFiles, TakeAdviceWhereTheyAreMapped) {
  const test::TempFolder folder;
  const std::string path = (folder.path() / "file.bxt").string();
  const std::vector<std::byte> bytes = two_trees();
  write(path, bytes);
  bxt_file* opened = nullptr;
  ASSERT_EQ(bxt_file_open(path.c_str(), nullptr, &opened, nullptr), BXT_OK);
  const test::CFile mapped(opened), in_memory = test::open_c(bytes);
  const File file = test::require(File::open(path));
  for (std::uint32_t access = 0; access <= BXT_ACCESS_DONT_NEED; ++access) {
    EXPECT_EQ(bxt_file_advise(mapped.get(), access), file.advise(static_cast<Access>(access)));
    EXPECT_FALSE(bxt_file_advise(in_memory.get(), access));
  }
  EXPECT_FALSE(bxt_file_advise(mapped.get(), BXT_ACCESS_DONT_NEED + 1));
}

// Found by an audit: scenes in packs could not be bound.
TEST(CFiles, MembersOfAPackAreFiles) {
  const test::TempFolder folder;
  const test::CookedScene cooked =
      test::cook_scene({test::torus(8, 6)}, test::random_parts(12, 1, 3, 1, 1));
  write(folder.path() / "scene.bxt", cooked.bytes);
  write(folder.path() / "trees.bxt", two_trees());
  const cooker::OpenInput open = [](const std::filesystem::path& path) {
    return File::open(path.string());
  };
  std::vector<cooker::PackMember> members;
  for (const char* name : {"scene.bxt", "trees.bxt"}) {
    for (cooker::PackMember& member : test::require(
             cooker::list_members(folder.path() / name, cooker::PackNames::kTree, open))) {
      members.push_back(std::move(member));
    }
  }
  const std::filesystem::path written = folder.path() / "all.bxt";
  ASSERT_TRUE(cooker::write_pack(written, members, open).ok());
  const std::string path = written.string();
  const File file = test::require(File::open(path));
  bxt_file* pack = nullptr;
  ASSERT_EQ(bxt_file_open(path.c_str(), nullptr, &pack, nullptr), BXT_OK);
  EXPECT_TRUE(bxt_file_is_pack(pack));
  EXPECT_FALSE(bxt_file_has_scene(pack));
  ASSERT_EQ(bxt_file_tree_count(pack), file.tree_count());
  int scenes = 0;
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    const Member expected = test::require(file.member(i));
    bxt_file *member = nullptr, *again = nullptr;
    std::uint32_t number = 99;
    ASSERT_EQ(bxt_file_open_member(pack, i, &member, &number, nullptr), BXT_OK);
    EXPECT_EQ(number, expected.tree);
    EXPECT_FALSE(bxt_file_is_pack(member));
    EXPECT_EQ(bxt_file_tree_count(member), expected.file.tree_count());
    EXPECT_EQ(bxt_file_has_scene(member), expected.file.has_scene());
    if (expected.file.has_scene()) {
      ++scenes;
      bxt_scene* scene = nullptr;
      ASSERT_EQ(bxt_scene_bind(member, nullptr, &scene, nullptr), BXT_OK);
      EXPECT_EQ(bxt_scene_instance_count(scene), cooked.parts.instances.size());
      bxt_scene_release(scene);
    }
    EXPECT_EQ(bxt_file_open_member(member, number, &again, nullptr, nullptr), BXT_OK);
    EXPECT_EQ(bxt_file_tree_count(again), bxt_file_tree_count(member));
    bxt_file_close(again);
    bxt_file_close(member);
  }
  EXPECT_EQ(scenes, 1);
  bxt_file* none = nullptr;
  EXPECT_EQ(bxt_file_open_member(pack, file.tree_count(), &none, nullptr, nullptr), BXT_TREE_INDEX);
  EXPECT_EQ(bxt_file_open_member(nullptr, 0, &none, nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_file_open_member(pack, 0, nullptr, nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(none, nullptr);
  bxt_file_close(pack);
}

TEST(CFiles, InMemoryAreNotCopied) {
  const std::vector<std::byte> bytes = two_trees();
  bxt_file_options options = {};
  options.struct_size = sizeof options;
  options.copy = true;
  bxt_file* file = nullptr;
  EXPECT_EQ(bxt_file_open_memory(bytes.data(), bytes.size(), &options, &file, nullptr),
            BXT_INVALID_QUERY);
  EXPECT_EQ(file, nullptr);
  EXPECT_EQ(bxt_file_open_memory(bytes.data(), 20, nullptr, &file, nullptr), BXT_TRUNCATED);
}

}  // namespace
}  // namespace boxtree
