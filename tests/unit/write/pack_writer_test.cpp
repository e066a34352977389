// SPDX-License-Identifier: MIT
// Packs: members come back as they were, names are found, and whatever is not as specified is told.
#include "cooker/write/pack_writer.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <new>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/proof/pack_proof.h"
#include "cooker/write/file_writer.h"
#include "format/pack.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using FileBytes = std::vector<std::byte>;
using test::require;

// Inputs in memory, by the paths that they are given by.
using Inputs = std::map<std::filesystem::path, FileBytes>;

OpenInput opener(const Inputs& inputs) {
  return [&inputs](const std::filesystem::path& path) -> Result<File> {
    const auto input = inputs.find(path);
    if (input == inputs.end()) return Error{Errc::kFileNotFound, path.string() + ": no such file"};
    return File::open(Bytes(input->second));
  };
}

FileBytes cook_trees(const std::vector<std::string>& names, unsigned seed) {
  std::vector<EncodedTree> trees;
  for (const std::string& name : names) {
    SourceMesh mesh = test::soup(20, seed++);
    mesh.name = name;
    trees.push_back(require(cook_as(mesh, CodecId::kWide8)));
  }
  return serialize(trees, R"({"seed":)" + std::to_string(seed) + "}");
}

Inputs three_files() {
  return {{"in/rock.bxt", cook_trees({"rock"}, 1)},
          {"in/level.bxt", cook_trees({"crate", "wall", "crate", ""}, 2)},
          {"more/no name.bxt", cook_trees({""}, 6)}};
}

FileBytes bytes_of(const std::filesystem::path& path) {
  const std::string text = test::read_text(path);
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

Result<FileBytes> pack(const std::vector<std::filesystem::path>& paths, const OpenInput& open,
                       PackNames names = PackNames::kTree) {
  std::vector<PackMember> members;
  for (const std::filesystem::path& path : paths) {
    Result<std::vector<PackMember>> listed = list_members(path, names, open);
    if (!listed) return listed.error();
    members.insert(members.end(), listed->begin(), listed->end());
  }
  const test::TempFolder folder;
  const Result<PackReport> report = write_pack(folder.path() / "all.bxt", members, open);
  if (!report) return report.error();
  FileBytes bytes = bytes_of(folder.path() / "all.bxt");
  EXPECT_EQ(report->bytes, bytes.size());
  return bytes;
}

FileBytes pack_three() {
  const Inputs inputs = three_files();
  return require(pack({"in/rock.bxt", "in/level.bxt", "more/no name.bxt"}, opener(inputs)));
}

std::vector<std::string> names_of(const File& file) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) names.emplace_back(file.tree_name(i));
  return names;
}

bool is_equal(Bytes a, const FileBytes& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

TEST(Pack, HoldsItsFilesAsTheyWere) {
  const Inputs inputs = three_files();
  const FileBytes bytes = pack_three();
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_TRUE(file->is_pack());
  EXPECT_FALSE(file->has_scene());
  EXPECT_EQ(names_of(*file), (std::vector<std::string>{"level/3", "level/crate", "level/crate#2",
                                                       "level/wall", "no name", "rock"}));
  EXPECT_TRUE(verify_file(*file).empty());
  const std::vector<std::pair<std::filesystem::path, std::uint32_t>> places = {
      {"in/level.bxt", 3}, {"in/level.bxt", 0},     {"in/level.bxt", 2},
      {"in/level.bxt", 1}, {"more/no name.bxt", 0}, {"in/rock.bxt", 0}};
  for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
    const Result<Member> member = file->member(i);
    ASSERT_TRUE(member.ok()) << member.error().message();
    EXPECT_TRUE(is_equal(member->file.bytes(), inputs.at(places[i].first))) << i;
    EXPECT_EQ(member->tree, places[i].second);
  }
  EXPECT_EQ(file->member(6).code(), Errc::kTreeIndex);
}

TEST(Pack, MembersTakeTheMemoryOfTheirFile) {
  const FileBytes bytes = pack_three();
  int living = 0;
  const Memory memory = {&living,
                         [](void* count, std::size_t size, std::size_t alignment) {
                           ++*static_cast<int*>(count);
                           return ::operator new(size, std::align_val_t(alignment));
                         },
                         [](void* count, void* place, std::size_t, std::size_t alignment) {
                           --*static_cast<int*>(count);
                           ::operator delete(place, std::align_val_t(alignment));
                         }};
  {
    const File packed = require(File::open(Bytes(bytes), {.memory = memory}));
    EXPECT_EQ(living, 2);  // its inside, its section table
    const Member member = require(packed.member(0));
    EXPECT_EQ(living, 4);
    const Member again = require(member.file.member(member.tree));
    EXPECT_EQ(living, 6);
  }
  EXPECT_EQ(living, 0);
}

TEST(Pack, TreesAnswerAsThoseOfTheirFiles) {
  const Inputs inputs = three_files();
  const FileBytes bytes = pack_three();
  const File packed = require(File::open(Bytes(bytes)));
  for (std::uint32_t i = 0; i < packed.tree_count(); ++i) {
    const Tree tree = require(Tree::bind(packed, i));
    EXPECT_EQ(tree.name(), packed.tree_name(i));
    const Member member = require(packed.member(i));
    const Tree own = require(Tree::bind(member.file, member.tree));
    std::mt19937 random(i);
    std::uniform_real_distribution<double> at(-1, 1);
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector3d point(at(random), at(random), at(random));
      const auto found = closest_point(tree, point);
      const auto expected = closest_point(own, point);
      ASSERT_TRUE(found.ok() && found.has_value() && expected.has_value());
      EXPECT_EQ(found->distance, expected->distance);
      EXPECT_EQ(found->face.id, expected->face.id);
    }
  }
  EXPECT_EQ(Tree::bind(packed, 6).code(), Errc::kTreeIndex);
  EXPECT_EQ(Scene::bind(packed).code(), Errc::kNoScene);
}

TEST(Pack, FindsEachNameAndNoOther) {
  const FileBytes bytes = pack_three();
  const File file = require(File::open(Bytes(bytes)));
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    EXPECT_EQ(require(file.find_tree(file.tree_name(i))), i);
  }
  for (const char* name : {"", "a", "level", "level/", "level/crate#", "rocks", "roc", "\xff"}) {
    EXPECT_EQ(file.find_tree(name).code(), Errc::kTreeIndex) << name;
  }
}

// char may be signed: names beyond ASCII come last in any case.
TEST(Pack, NamesAscendAsUnsignedBytes) {
  const Inputs inputs = {{"a.bxt", cook_trees({"\xc3\xa9t\xc3\xa9"}, 1)},
                         {"b.bxt", cook_trees({"zoo"}, 2)},
                         {"c.bxt", cook_trees({"A"}, 3)}};
  const FileBytes bytes = require(pack({"a.bxt", "b.bxt", "c.bxt"}, opener(inputs)));
  const File file = require(File::open(Bytes(bytes)));
  EXPECT_EQ(names_of(file), (std::vector<std::string>{"A", "zoo", "\xc3\xa9t\xc3\xa9"}));
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(require(file.find_tree(file.tree_name(i))), i);
}

TEST(Pack, OrderOfInputsChangesNoByte) {
  const Inputs inputs = three_files();
  const FileBytes bytes = pack_three();
  EXPECT_EQ(require(pack({"more/no name.bxt", "in/level.bxt", "in/rock.bxt"}, opener(inputs))),
            bytes);
}

TEST(Pack, OfPacksIsThePackOfTheirFiles) {
  Inputs inputs = three_files();
  const OpenInput open = opener(inputs);
  inputs["one.bxt"] = require(pack({"in/rock.bxt"}, open));
  inputs["two.bxt"] = require(pack({"in/level.bxt", "more/no name.bxt"}, open));
  EXPECT_EQ(require(pack({"two.bxt", "one.bxt"}, open)), pack_three());
  EXPECT_EQ(require(pack({"two.bxt", "in/rock.bxt"}, open)), pack_three());
  const FileBytes by_path = require(pack({"two.bxt", "in/rock.bxt"}, open, PackNames::kPath));
  EXPECT_EQ(names_of(require(File::open(Bytes(by_path)))),
            (std::vector<std::string>{"in/rock", "two/level/3", "two/level/crate",
                                      "two/level/crate#2", "two/level/wall", "two/no name"}));
}

TEST(Pack, NamesOfPathsAreWithoutRootsAndFoldersAbove) {
  Inputs inputs;
  for (const char* path : {"/a/b.bxt", "../c.bxt", "./d/../e.bxt", "f/g.h.bxt"}) {
    inputs[path] = cook_trees({"rock"}, 1);
  }
  const FileBytes bytes = require(pack({"/a/b.bxt", "../c.bxt", "./d/../e.bxt", "f/g.h.bxt"},
                                       opener(inputs), PackNames::kPath));
  EXPECT_EQ(names_of(require(File::open(Bytes(bytes)))),
            (std::vector<std::string>{"a/b", "c", "e", "f/g.h"}));
}

TEST(Pack, RefusesWhatHasOneName) {
  const Inputs inputs = {{"a/rock.bxt", cook_trees({"rock"}, 1)},
                         {"b/rock.bxt", cook_trees({"rock"}, 2)},
                         {"rock.bxt", cook_trees({"x", "y"}, 3)},
                         {"x.bxt", cook_trees({"rock/x"}, 5)}};
  const OpenInput open = opener(inputs);
  const auto message = [&](const std::vector<std::filesystem::path>& paths) {
    return pack(paths, open).error().message();
  };
  EXPECT_EQ(message({"a/rock.bxt", "b/rock.bxt"}),
            "invalid_query: two files are named \"rock\", of a/rock.bxt and b/rock.bxt; name them "
            "after the paths of their files: --names path");
  EXPECT_EQ(message({"a/rock.bxt", "a/rock.bxt"}),
            "invalid_query: a/rock.bxt: it is given twice; expected each input once");
  EXPECT_EQ(pack({"a/rock.bxt", "rock.bxt"}, open).code(), Errc::kInvalidQuery);
  EXPECT_EQ(message({"rock.bxt", "x.bxt"}),
            "invalid_query: two trees are named \"rock/x\", of rock.bxt and x.bxt; name them after "
            "the paths of their files: --names path");
  EXPECT_EQ(message({}), "invalid_query: expected files to pack, found none");
  EXPECT_TRUE(pack({"a/rock.bxt", "b/rock.bxt"}, open, PackNames::kPath).ok());
}

TEST(Pack, RefusesInputsThatAreDamagedOrOfAnotherKind) {
  Inputs inputs = three_files();
  FileBytes& rock = inputs["in/rock.bxt"];
  inputs["short.bxt"] = {rock.begin(), rock.end() - 8};
  inputs["newer.bxt"] = rock;
  inputs["newer.bxt"][8] = std::byte{2};
  inputs["damaged.bxt"] = rock;
  inputs["damaged.bxt"][test::entry_of(rock, SectionKind::kVertices).offset] ^= std::byte{1};
  inputs["empty.bxt"] = serialize(std::span<const EncodedTree>());
  const OpenInput open = opener(inputs);
  EXPECT_EQ(pack({"missing.bxt"}, open).code(), Errc::kFileNotFound);
  EXPECT_EQ(pack({"short.bxt"}, open).code(), Errc::kTruncated);
  EXPECT_EQ(pack({"newer.bxt"}, open).code(), Errc::kVersionUnsupported);
  EXPECT_EQ(pack({"damaged.bxt"}, open).code(), Errc::kChecksumMismatch);
  EXPECT_EQ(pack({"empty.bxt"}, open).code(), Errc::kSectionMissing);
}

// An input may change between the passes over it: the output then is the old one.
TEST(Pack, AnInputThatChangesMeanwhileIsTold) {
  const test::TempFolder folder;
  const std::filesystem::path output = folder.write("all.bxt", "old");
  const FileBytes before = cook_trees({"rock"}, 1);
  FileBytes after = before;
  after[test::entry_of(after, SectionKind::kVertices).offset] ^= std::byte{1};
  int opened = 0;
  const OpenInput open = [&](const std::filesystem::path&) {
    return File::open(Bytes(++opened < 3 ? before : after));
  };
  const Result<PackReport> report =
      write_pack(output, require(list_members("rock.bxt", PackNames::kTree, open)), open);
  EXPECT_EQ(report.code(), Errc::kFileUnreadable);
  EXPECT_EQ(test::read_text(output), "old");
}

TEST(Pack, MembersHaveFilesOfTheirOwnInsideTheFolder) {
  EXPECT_EQ(member_path("rock"), "rock.bxt");
  EXPECT_EQ(member_path("props/rock 1"), "props/rock 1.bxt");
  EXPECT_EQ(member_path("../../etc/passwd"), ".%2E/.%2E/etc/passwd.bxt");
  EXPECT_EQ(member_path("/etc/passwd"), "%/etc/passwd.bxt");
  EXPECT_EQ(member_path("a//b"), "a/%/b.bxt");
  EXPECT_EQ(member_path("a/"), "a/%.bxt");
  EXPECT_EQ(member_path("."), "%2E.bxt");
  EXPECT_EQ(member_path("c:\\d*?\"<>|%"), "c%3A%5Cd%2A%3F%22%3C%3E%7C%25.bxt");
  EXPECT_EQ(member_path("tab\there "), "tab%09here%20.bxt");
}

struct RowLie {
  const char* name;
  void (*change)(PackRow& row, std::uint32_t i, std::uint32_t count);
};

class PackLies : public testing::TestWithParam<RowLie> {};

// What verify says of a row that lies, and that using it is safe.
TEST_P(PackLies, AreTold) {
  FileBytes bytes = pack_three();
  test::edit_records<PackRow>(bytes, SectionKind::kPack, GetParam().change);
  const Result<File> file = File::open(Bytes(bytes));
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_FALSE(check_pack(*file).empty());
  EXPECT_FALSE(verify_file(*file).empty());
  for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
    const Result<Tree> tree = Tree::bind(*file, i);
    if (tree.ok()) {
      EXPECT_TRUE(closest_point(*tree, {0, 0, 0}).ok());
    }
    static_cast<void>(file->find_tree(file->tree_name(i)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Rows, PackLies,
    testing::Values(
        RowLie{"offset_behind_the_section",
               [](PackRow& row, std::uint32_t, std::uint32_t) { row.offset = ~std::uint64_t{63}; }},
        RowLie{"size_beyond_the_section",
               [](PackRow& row, std::uint32_t, std::uint32_t) { row.bytes = ~std::uint64_t{0}; }},
        RowLie{"shorter_member",
               [](PackRow& row, std::uint32_t, std::uint32_t) { row.bytes -= 8; }},
        RowLie{"no_bytes", [](PackRow& row, std::uint32_t, std::uint32_t) { row.bytes = 0; }},
        RowLie{"no_such_tree", [](PackRow& row, std::uint32_t i,
                                  std::uint32_t) { row.tree = i == 5 ? 1 : row.tree; }},
        RowLie{"one_tree_twice", [](PackRow& row, std::uint32_t i,
                                    std::uint32_t) { row.tree = i == 1 ? 3 : row.tree; }},
        RowLie{"name_outside",
               [](PackRow& row, std::uint32_t i, std::uint32_t) {
                 row.name_offset = i == 2 ? 0xffffffffu : row.name_offset;
               }},
        RowLie{"no_name",
               [](PackRow& row, std::uint32_t i, std::uint32_t) {
                 if (i == 0) row.name_bytes = row.member_name_bytes = 0;
               }},
        RowLie{"names_in_disorder",
               [](PackRow& row, std::uint32_t i, std::uint32_t count) {
                 if (i + 1 == count) row.name_offset = 0;  // "leve" behind "no name"
               }},
        RowLie{"no_member_name",
               [](PackRow& row, std::uint32_t, std::uint32_t) { row.member_name_bytes = 0; }},
        RowLie{"longer_member_name",
               [](PackRow& row, std::uint32_t, std::uint32_t) { ++row.member_name_bytes; }},
        RowLie{"one_member_for_all",
               [](PackRow& row, std::uint32_t, std::uint32_t) { row.offset = 0; }}),
    [](const auto& lie) { return std::string(lie.param.name); });

// A pack or a blob in a pack is refused where its trees are used: files do not nest.
TEST(Pack, HoldsNoPacksAndNoBlobs) {
  Inputs inputs = three_files();
  const OpenInput open = opener(inputs);
  const FileBytes inner = pack_three();
  std::vector<PackMember> members{{"inner.bxt", 0, inner.size(), "inner", {"inner"}}};
  inputs["inner.bxt"] = inner;
  const test::TempFolder folder;
  EXPECT_EQ(write_pack(folder.path() / "all.bxt", members, open).code(), Errc::kFeatureUnsupported);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "all.bxt"));
}

TEST(Pack, EveryTruncationAndEveryFlippedBitIsFound) {
  const Inputs inputs = three_files();
  const FileBytes whole = require(pack({"in/rock.bxt", "more/no name.bxt"}, opener(inputs)));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    ASSERT_FALSE(File::open(Bytes(whole).first(size)).ok()) << size;
  }
  FileBytes bytes = whole;
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    const auto flip = static_cast<std::byte>(1u << bit % 8);
    bytes[bit / 8] ^= flip;
    const Result<File> file = File::open(Bytes(bytes));
    ASSERT_TRUE(!file.ok() || !verify_file(*file).empty()) << "bit " << bit;
    bytes[bit / 8] ^= flip;
  }
}

// Changes in the index and in members, with checksums made right again: an error or an answer.
TEST(Pack, DamageIsSafe) {
  const FileBytes whole = pack_three();
  std::mt19937 random(1);
  int accepted = 0;
  for (int k = 0; k < 20000; ++k) {
    FileBytes bytes = whole;
    const std::vector<SectionEntry> sections = test::sections_of(bytes);
    const SectionEntry& section = sections[random() % sections.size()];
    const std::uint64_t at = section.offset + random() % section.size;
    bytes[at] ^= static_cast<std::byte>(1u << random() % 8);
    test::repair_checksums(bytes);
    const Result<File> file = File::open(Bytes(bytes));
    ASSERT_TRUE(file.ok());
    const bool is_valid = check_pack(*file).empty();
    accepted += is_valid ? 1 : 0;
    for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
      const Result<Tree> tree = Tree::bind(*file, i);
      if (tree.ok()) static_cast<void>(closest_point(*tree, {0, 0, 0}));
      if (is_valid) {
        EXPECT_EQ(require(file->find_tree(file->tree_name(i))), i);
      }
    }
  }
  EXPECT_GT(accepted, 0);
}

// Number `number` of a name that is as long for each.
std::string tree_name(unsigned number) {
  std::string digits = std::to_string(number);
  return "tree-" + std::string(6 - digits.size(), '0') + digits;
}

// How many kilobytes of a mapped file have been touched; 0 on Windows, which does not tell.
#ifdef _WIN32
std::size_t resident_kilobytes(const File&) {
  return 0;
}
#else
std::size_t resident_kilobytes(const File& file) {
  std::ostringstream first;
  first << std::hex << reinterpret_cast<std::uintptr_t>(file.bytes().data()) << '-';
  std::ifstream maps("/proc/self/smaps");
  bool is_found = false;
  for (std::string line; std::getline(maps, line);) {
    is_found |= line.starts_with(first.str());
    if (is_found && line.starts_with("Rss:")) return std::stoul(line.substr(4));
  }
  ADD_FAILURE() << "no mapping at " << first.str();
  return 0;
}
#endif

// 100 000 trees: each is found, and to open the file and query a tree touches few pages of it.
TEST(Pack, OfManyTreesIsOpenedAndSearchedInPlace) {
  constexpr unsigned kTrees = 100000;
  FileBytes member = cook_trees({tree_name(0)}, 1);
  const OpenInput open = [&](const std::filesystem::path& path) {
    const std::string name = path.stem().string();
    const std::span<std::byte> names = test::section_of(member, SectionKind::kNames);
    std::copy(name.begin(), name.end(), reinterpret_cast<char*>(names.data()));
    test::repair_checksums(member);
    return File::open(Bytes(member));
  };
  std::vector<PackMember> members;
  for (unsigned i = kTrees; i-- > 0;) {
    for (PackMember& each : require(list_members(tree_name(i) + ".bxt", PackNames::kTree, open))) {
      members.push_back(std::move(each));
    }
  }
  const test::TempFolder folder;
  const std::filesystem::path path = folder.path() / "all.bxt";
  const PackReport report = require(write_pack(path, std::move(members), open));
  EXPECT_EQ(report.trees, kTrees);

  const File file = require(File::open(path.string()));
  EXPECT_EQ(file.tree_count(), kTrees);
  // The system maps what is around each page that is touched, some 64 KB: of 35 places that a
  // search reads at most.
  const std::size_t all = file.bytes().size() / 1024;
  EXPECT_LE(resident_kilobytes(file), all / 256);
  const Tree tree = require(Tree::bind(file, require(file.find_tree(tree_name(77777)))));
  EXPECT_EQ(tree.name(), tree_name(77777));
  EXPECT_TRUE(closest_point(tree, {0, 0, 0}).ok());
  EXPECT_LE(resident_kilobytes(file), all / 16);
  for (unsigned i = 0; i < kTrees; i += 9) {
    ASSERT_EQ(require(file.find_tree(tree_name(i))), i);
  }
  EXPECT_TRUE(check_pack(file).empty());
}

}  // namespace
}  // namespace boxtree::cooker
