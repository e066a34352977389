// SPDX-License-Identifier: MIT
// Names in UTF-8 become paths and names again, and name the files that they are names of.
#include "cooker/system/path.h"

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

#include "cooker/system/file_handle.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

// U+00E9; U+65E5 U+672C; U+1F333, of which UTF-16 makes two; U+0065 U+0301, which is not U+00E9.
constexpr const char* kNames[] = {"plain.bxt", "caf\xc3\xa9.bxt", "\xe6\x97\xa5\xe6\x9c\xac.bxt",
                                  "\xf0\x9f\x8c\xb3.bxt", "cafe\xcc\x81.bxt"};

TEST(NamedPath, KeepsNames) {
  for (const std::string name : kNames) {
    EXPECT_EQ(named_path(name).string(), name);
    EXPECT_EQ(named_path("folder/" + name).filename().string(), name);
    EXPECT_EQ(named_path(name).extension(), ".bxt");
  }
  EXPECT_TRUE(named_path("").empty());
}

// What the system has in a folder is what was written there.
TEST(NamedPath, NamesFiles) {
  const test::TempFolder folder;
  for (const std::string name : kNames) {
    const std::filesystem::path path = folder.path() / named_path(name);
    EXPECT_EQ(open_to_read(path), nullptr) << name;
    std::ofstream(path) << name;
    EXPECT_EQ(test::read_text(path), name);
    EXPECT_NE(open_to_read(path), nullptr) << name;
  }
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    EXPECT_EQ(entry.path().filename().string(), test::read_text(entry.path()));
    ++count;
  }
  EXPECT_EQ(count, std::size(kNames));
}

// Lone continuation bytes, an encoded surrogate, Latin-1.
TEST(NamedPath, OfWhatIsNoUtf8NamesNoFile) {
  const test::TempFolder folder;
  std::ofstream(folder.path() / named_path("caf\xc3\xa9")) << "x";
  for (const std::string name : {"caf\xe9", "\x80\x80", "\xed\xa0\xb4"}) {
    EXPECT_EQ(open_to_read(folder.path() / named_path(name)), nullptr);
  }
}

}  // namespace
}  // namespace boxtree::cooker
