// SPDX-License-Identifier: MIT
// What was left is found, and a folder that fills up is not read for each file.
#include "cooker/write/folder_sweep.h"

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "cooker/write/temporary_name.h"

namespace boxtree::cooker {
namespace {

FileName name_of(const std::string& text) {
  return std::filesystem::path(text).native();
}

FolderSweep::Belongs is_of(const std::string& target) {
  return [prefix = temporary_prefix(target)](const FileName& name) {
    return is_temporary_name(std::filesystem::path(name).string(), prefix);
  };
}

const FileName kLeft = name_of(".out.0123456789abcdef.cooking");
const FileName kOther = name_of(".other.0123456789abcdef.cooking");

// A folder with so many finished files, and unfinished ones.
struct Folder {
  std::size_t finished = 0;
  std::vector<FileName> unfinished = {};
  std::size_t names_read = 0;

  FolderNames read() {
    FolderNames names;
    for (std::size_t i = 0; i < finished; ++i) names.add(name_of(std::to_string(i) + ".bxt"));
    for (const FileName& name : unfinished) names.add(name);
    names_read += names.count;
    return names;
  }
  std::vector<FileName> take(FolderSweep& sweep, const std::string& target = "out") {
    return sweep.take("folder", is_of(target), [this] { return read(); });
  }
};

TEST(FolderSweep, ASmallFolderIsReadForEachFile) {
  FolderSweep sweep;
  Folder folder{10};
  EXPECT_TRUE(folder.take(sweep).empty());
  folder.unfinished = {kOther, kLeft, name_of("out.cooking"), name_of(".out.notes")};
  EXPECT_EQ(folder.take(sweep), std::vector{kLeft});
  EXPECT_EQ(folder.names_read, 10u + 14u);
}

TEST(FolderSweep, ALargeFolderRemembersWhatItWasLeftWith) {
  FolderSweep sweep;
  Folder folder{1000, {kOther, kLeft}};
  EXPECT_EQ(folder.take(sweep), std::vector{kLeft});
  EXPECT_TRUE(folder.take(sweep).empty()) << "given once";
  EXPECT_EQ(folder.take(sweep, "other"), std::vector{kOther});
  EXPECT_EQ(folder.names_read, 1002u);
  // What is left later is found once a file was made for each 64 names.
  folder.unfinished = {kLeft};
  std::size_t files = 3;
  while (folder.take(sweep).empty() && files < 1000) ++files;
  EXPECT_EQ(files, (1002 + FolderSweep::kNamesPerFile - 1) / FolderSweep::kNamesPerFile);
}

TEST(FolderSweep, ATargetTakesNothingOfOneWhoseNameGoesOn) {
  FolderSweep sweep;
  const FileName longer = name_of(".out.bxt.0123456789abcdef.cooking");
  Folder folder{1000, {longer}};
  EXPECT_TRUE(folder.take(sweep).empty());
  EXPECT_EQ(folder.take(sweep, "out.bxt"), std::vector{longer});
  EXPECT_EQ(folder.names_read, 1001u);
}

// Found by a newcomer: 20 000 outputs in one folder took 200 million names, most of the system's
// time of the cook.
TEST(FolderSweep, FillingAFolderReadsNamesInProportionToItsFiles) {
  FolderSweep sweep;
  Folder folder;
  for (; folder.finished < 20000; ++folder.finished) EXPECT_TRUE(folder.take(sweep).empty());
  EXPECT_LE(folder.names_read, 2 * FolderSweep::kNamesPerFile * folder.finished);
}

TEST(FolderSweep, FoldersAreKnownApart) {
  FolderSweep sweep;
  Folder large{1000, {kLeft}}, other{2000, {kLeft}};
  EXPECT_EQ(large.take(sweep), std::vector{kLeft});
  EXPECT_EQ(sweep.take("other", is_of("out"), [&] { return other.read(); }), std::vector{kLeft});
  EXPECT_EQ(other.names_read, 2001u);
}

}  // namespace
}  // namespace boxtree::cooker
