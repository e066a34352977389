// SPDX-License-Identifier: MIT
// Files of which assimp's readers leave out faces, or give them other vertices, are errors: what
// they say in their log is heard.
#include "cooker/import/reader_log.h"

#include <filesystem>
#include <string>
#include <thread>

#include <assimp/DefaultLogger.hpp>
#include <assimp/Logger.hpp>
#include <gtest/gtest.h>

#include "cooker/import/import.h"
#include "fbx_text.h"
#include "temp_files.h"

namespace boxtree::cooker {
namespace {

constexpr const char* kLoss = "AC3D: Invalid vertex reference";

void warn(const char* text) {
  Assimp::DefaultLogger::get()->warn(text);
}

TEST(ReaderLog, TheFirstLossIsKept) {
  const ReaderLog log;
  warn("AC3D: No material has been found");
  EXPECT_EQ(log.loss(), "");
  warn(kLoss);
  warn("3DS: Vertex index overflow)");
  EXPECT_EQ(log.loss(), kLoss);
}

TEST(ReaderLog, AnErrorRightBeforeIsTheCause) {
  constexpr const char* kLink = "FBX-DOM failed to read source object for incoming Model link";
  {
    const ReaderLog log;
    Assimp::DefaultLogger::get()->error("polygon vertex index out of range");
    warn(kLink);
    EXPECT_EQ(log.loss(), std::string("polygon vertex index out of range: ").append(kLink));
  }
  const ReaderLog log;
  Assimp::DefaultLogger::get()->error("ignoring additional tangent layer");
  warn("no GlobalSettings dictionary found");
  warn(kLink);
  EXPECT_EQ(log.loss(), kLink);
}

TEST(ReaderLog, OtherThreadsAreNotHeard) {
  const ReaderLog log;
  std::string of_other;
  std::thread([&of_other] {
    warn(kLoss);  // nobody listens
    const ReaderLog other;
    warn("MDC vertex index is out of range");
    of_other = other.loss();
  }).join();
  EXPECT_EQ(log.loss(), "");
  EXPECT_EQ(of_other, "MDC vertex index is out of range");
}

TEST(ReaderLog, WhatIsInsideHearsAlone) {
  const ReaderLog outer;
  {
    const ReaderLog inner;
    warn(kLoss);
    EXPECT_EQ(inner.loss(), kLoss);
  }
  EXPECT_EQ(outer.loss(), "");
  warn(kLoss);
  EXPECT_EQ(outer.loss(), kLoss);
}

class LostFaces : public ImportTest {
 protected:
  // In the process that only tries, and in the one that then reads, too.
  void expect_refused(const std::string& name, const std::string& text,
                      const std::string& why) const {
    const std::filesystem::path path = write(name, text);
    for (const bool try_first : {false, true}) {
      const Result<Imported> imported = import_mesh(path, {.try_first = try_first});
      ASSERT_EQ(imported.code(), Errc::kImportFailed) << name;
      const std::string& detail = imported.error().detail;
      EXPECT_NE(detail.find("leaves out or makes up a part of it, and says: "), std::string::npos)
          << detail;
      EXPECT_NE(detail.find(why), std::string::npos) << detail;
    }
  }
};

// All other meshes of the file would be read, and this one not be missed.
TEST_F(LostFaces, OfFbx) {
  EXPECT_TRUE(import_mesh(write("whole.fbx", fbx_text("0,1,-6,1,2,-7", 6, "1,1", 2))).ok());
  expect_refused("index.fbx", fbx_text("0,1,-9,1,2,-7", 6, "1,1", 2),
                 "polygon vertex index out of range");
  expect_refused("fraction.fbx", fbx_text("0,1.5,-6,1,2,-7", 6, "1,1", 2), "failed to parse ID");
}

std::string ac(const std::string& vertices, const std::string& surface) {
  return "AC3Db\nMATERIAL \"\" rgb 1 1 1 amb 1 1 1 emis 0 0 0 spec 0 0 0 shi 0 trans 0\n"
         "OBJECT world\nkids 1\nOBJECT poly\nnumvert 4\n" +
         vertices + "numsurf 1\n" + surface + "kids 0\n";
}

TEST_F(LostFaces, OfAc) {
  const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const std::string surface = "SURF 0x20\nmat 0\nrefs 4\n0 0 0\n1 0 0\n2 0 0\n";
  EXPECT_TRUE(import_mesh(write("whole.ac", ac(square, surface + "3 0 0\n"))).ok());
  expect_refused("index.ac", ac(square, surface + "4 0 0\n"), "Invalid vertex reference");
}

}  // namespace
}  // namespace boxtree::cooker
