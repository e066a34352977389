// SPDX-License-Identifier: MIT
// Whatever it is called: what is read is not written over.
#include "cooker/write/outputs.h"

#include <array>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "cooker/report/page.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// The library of mingw-w64 (g++ 12) makes none.
#ifdef _WIN32
constexpr bool kHasLinks = false;
#else
constexpr bool kHasLinks = true;
#endif

TEST(Outputs, AreFilesOfTheirOwn) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("m.obj", "v 0 0 0\n");
  fs::create_hard_link(mesh, folder.path() / "hard");
  fs::create_directory(folder.path() / "sub");
  if (kHasLinks) {
    fs::create_symlink(mesh, folder.path() / "soft");
    fs::create_symlink("new", folder.path() / "dangling");
  }
  const auto code = [&](const fs::path& output, const fs::path& other) {
    return check_outputs(std::array{Output{folder.path() / output}, Output{other}},
                         std::array{mesh})
        .code();
  };
  for (const char* same : {"m.obj", "./m.obj", "sub/../m.obj", "hard"}) {
    EXPECT_EQ(code(same, ""), Errc::kWriteFailed) << same;
  }
  EXPECT_EQ(code("out", ""), Errc::kOk);
  EXPECT_EQ(code("out", folder.path() / "out"), Errc::kWriteFailed);
  if (kHasLinks) {
    EXPECT_EQ(code("soft", ""), Errc::kWriteFailed);
    EXPECT_EQ(code("new", folder.path() / "dangling"), Errc::kWriteFailed);
  }
  EXPECT_EQ(code("out", folder.path() / "new"), Errc::kOk);
}

// Found by a newcomer: "y.bxt: is the same file as the output y.bxt" of --depfile y.bxt.
TEST(Outputs, AreToldByTheirOptions) {
  const auto said = [](const Output& more, const fs::path& input) {
    return check_outputs(std::array{Output{"y.bxt"}, more}, std::array{input}).error().detail;
  };
  constexpr const char* kRest = "; it would be written over: name another output";
  EXPECT_EQ(said({"./y.bxt", "--depfile"}, "m.obj"),
            std::string("--depfile ./y.bxt: is the same file as the output y.bxt") + kRest);
  EXPECT_EQ(said({"./m.obj", "--depfile"}, "m.obj"),
            std::string("--depfile ./m.obj: is the same file as the input m.obj") + kRest);
  EXPECT_EQ(said({"y.d", "--depfile"}, "y.bxt"),
            std::string("y.bxt: is the same file as the input y.bxt") + kRest);
}

// An export over the mesh of the cook, a cook over a profile.
TEST(Outputs, TakeThePlaceOfTheirKindAlone) {
  const test::TempFolder folder;
  const std::string cooked =
      "\x89"
      "BXT\r\n\x1a\n and more";
  const std::string obj = "# boxtree 0.1.0\no m\n";
  const std::string glb =
      std::string("glTF\2\0\0\0", 8) + R"(JSON{"asset":{"generator":"boxtree 0.1.0"}})";
  const std::string page = to_html({"Which encoding?", "", {}});
  const std::string csv = "mesh,triangles,codec,geometry,grid_bits\n";
  const std::string json =
      "{\n  \"schema\": 1,\n  \"command\": \"boxtree report --quick m.obj\",\n";
  const std::string depfile = "m.bxt: \\\n  m.obj \\\n  a\\ b.mtl\nm.obj:\na\\ b.mtl:\n";
  const std::string other = "v 0 0 0\n# boxtree 0.1.0\n";
  for (const auto& [kind, content] :
       std::initializer_list<std::pair<OutputKind, std::string>>{{OutputKind::kCooked, cooked},
                                                                 {OutputKind::kShownObj, obj},
                                                                 {OutputKind::kShownGlb, glb},
                                                                 {OutputKind::kReportPage, page},
                                                                 {OutputKind::kReportCsv, csv},
                                                                 {OutputKind::kReportJson, json},
                                                                 {OutputKind::kDepfile, depfile}}) {
    for (const std::string& found :
         {cooked, obj, glb, page, csv, json, depfile, other, std::string("\x89"), std::string()}) {
      const fs::path output = folder.write("out", found);
      const bool is_fine = found.empty() || found == content;
      EXPECT_EQ(check_replaced(output, kind).code(), is_fine ? Errc::kOk : Errc::kWriteFailed)
          << found;
    }
    EXPECT_TRUE(check_replaced(folder.path() / "new", kind).ok());
    EXPECT_TRUE(check_replaced("/dev/null", kind).ok());
  }
}

// Found by a newcomer: a report and a depfile took the place of whatever was there.
TEST(Outputs, OfEarlierVersionsAreReplaced) {
  const test::TempFolder folder;
  const auto code = [&](OutputKind kind, const std::string& found) {
    return check_replaced(folder.write("out", found), kind).code();
  };
  const std::string head =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n<title>";
  EXPECT_EQ(code(OutputKind::kReportPage, head + "Which encoding for m?</title>"), Errc::kOk);
  EXPECT_EQ(code(OutputKind::kReportPage,
                 head + "Compression of the BoxTree data structure: its tables, redrawn</title>"),
            Errc::kOk);
  EXPECT_EQ(code(OutputKind::kReportPage, head + "My holidays</title>"), Errc::kWriteFailed);
  EXPECT_EQ(code(OutputKind::kDepfile, "m.bxt: \\\n  m.obj\n"), Errc::kOk);
}

// Found by a newcomer: lines of a journal were added to a mesh.
TEST(Outputs, OfAJournalAreAddedToJournalsAlone) {
  const test::TempFolder folder;
  const auto code = [&](const std::string& found) {
    return check_replaced(folder.write("out", found), OutputKind::kJournal).code();
  };
  const std::string line = R"({"output":"a.bxt","key":"")";
  for (std::size_t end = 0; end <= line.size(); ++end) {
    EXPECT_EQ(code(line.substr(0, end)), Errc::kOk) << end;  // also where it was cut short
  }
  EXPECT_EQ(code("{\"file\":\"a.obj\",\"state\":[]}\n"), Errc::kOk);
  for (const char* found : {"v 0 0 0\n", "{\"inputs\":[\"a.obj\"]}\n", "{}", "\n"}) {
    EXPECT_EQ(code(found), Errc::kWriteFailed) << found;
  }
}

TEST(Outputs, AreDepfilesAsAWhole) {
  const test::TempFolder folder;
  for (const char* found :
       {"all: m.bxt\n", "all: \\\n  m.bxt\n\tboxtree cook m.obj\n", "m.o: m.cpp \\\n m.h\n",
        "m.bxt: \\\n  m.obj\nm.obj: m.blend\n", "m.bxt: \\\n  m.obj \\\n", "m.bxt: \\\n  m.obj",
        "my notes\n", "\n", "m.obj:\n"}) {
    EXPECT_EQ(check_replaced(folder.write("out", found), OutputKind::kDepfile).code(),
              Errc::kWriteFailed)
        << found;
  }
}

}  // namespace
}  // namespace boxtree::cooker
