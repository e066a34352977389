// SPDX-License-Identifier: MIT
// Bytes without a file are imported like a file of those bytes, which has nothing beside it.
#include "cooker/import/source_file.h"

#include <algorithm>
#include <array>
#include <span>

#include "temp_files.h"

namespace boxtree::cooker {
namespace {

using SourceFileTest = ImportTest;

constexpr std::string_view kObj = "mtllib beside.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr std::string_view kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
constexpr std::string_view kGltf = R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
  "nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{
  "bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}],
  "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"three.bin"}]})";

ImportOptions with_bytes(std::string_view text, const char* file_name) {
  ImportOptions options;
  options.bytes = SourceBytes{"-", "standard input", file_name, std::as_bytes(std::span(text))};
  return options;
}

TEST_F(SourceFileTest, BytesAreImportedLikeAFile) {
  const Imported file = load("stdin.off", kOff);
  const Result<Imported> bytes = import_mesh("-", with_bytes(kOff, "stdin.off"));
  ASSERT_TRUE(bytes.ok()) << bytes.error().message();
  EXPECT_EQ(bytes->mesh.name, "stdin");
  EXPECT_EQ(bytes->mesh.positions.f32, file.mesh.positions.f32);
  EXPECT_EQ(bytes->report.content_hash, file.report.content_hash);
  EXPECT_TRUE(bytes->report.files_read.empty());
}

TEST_F(SourceFileTest, OtherInputsAreFilesAllTheSame) {
  const std::filesystem::path path =
      write("two.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
  const Result<Imported> file = import_mesh(path, with_bytes(kOff, "stdin.off"));
  ASSERT_TRUE(file.ok()) << file.error().message();
  EXPECT_EQ(file->mesh.faces.size(), 2u);
}

TEST_F(SourceFileTest, BytesHaveNothingBesideThem) {
  const auto before = std::filesystem::current_path();
  write("beside.mtl", "newmtl a\n");
  write("three.bin", std::string(36, '\0'));
  std::filesystem::current_path(folder_);
  const Result<Imported> obj = import_mesh("-", with_bytes(kObj, "stdin.obj"));
  std::array<Result<Imported>, 2> gltf{Errc::kOk, Errc::kOk};
  for (const bool try_first : {false, true}) {
    ImportOptions options = with_bytes(kGltf, "stdin.gltf");
    options.try_first = try_first;
    gltf.at(try_first ? 1 : 0) = import_mesh("-", options);
  }
  std::filesystem::current_path(before);
  ASSERT_TRUE(obj.ok()) << obj.error().message();
  EXPECT_EQ(obj->report.files_missing, std::vector<std::filesystem::path>{"beside.mtl"});
  for (const Result<Imported>& refused : gltf) {
    ASSERT_EQ(refused.code(), Errc::kImportFailed);
    EXPECT_TRUE(has(refused.error().detail, "standard input: it refers to three.bin"))
        << refused.error().detail;
  }
}

// Found by a newcomer: exporters write URIs, in which a space is %20.
TEST_F(SourceFileTest, BuffersHaveNamesWithEscapes) {
  std::string gltf(kGltf);
  gltf.replace(gltf.find("three.bin"), 9, "my%20three%2ebin");
  std::array<float, 9> corners = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  write("my three.bin", std::string(reinterpret_cast<const char*>(corners.data()), sizeof corners));
  const std::filesystem::path path = write("escaped.gltf", gltf);
  for (const bool try_first : {false, true}) {
    ImportOptions options;
    options.try_first = try_first;
    const Result<Imported> imported = import_mesh(path, options);
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    EXPECT_EQ(imported->mesh.faces.size(), 1u);
    EXPECT_EQ(std::count(imported->report.files_read.begin(), imported->report.files_read.end(),
                         folder_ / "my three.bin"),
              1);
  }
  // A file that has the name as it is comes first.
  write("my%20three%2ebin", std::string(36, '\0'));
  const Result<Imported> literal = import_mesh(path);
  ASSERT_TRUE(literal.ok());
  EXPECT_EQ(literal->report.files_read.back(), folder_ / "my%20three%2ebin");
}

// Found by a newcomer: it was an import that failed, by assimp's message.
TEST_F(SourceFileTest, ABufferThatIsNotThereIsAFileThatIsNotFound) {
  const std::filesystem::path path = write("bufferless.gltf", std::string(kGltf));
  const std::string buffer = (folder_ / "three.bin").string();
  for (const bool try_first : {false, true}) {
    ImportOptions options;
    options.try_first = try_first;
    std::filesystem::remove_all(buffer);
    const Result<Imported> missing = import_mesh(path, options);
    ASSERT_EQ(missing.code(), Errc::kFileNotFound);
    EXPECT_TRUE(has(missing.error().detail, path.string() + ": it refers to " + buffer +
                                                ": no such file; names in " + path.string() +
                                                " are relative to its folder"))
        << missing.error().detail;
    std::filesystem::create_directory(buffer);
    const Result<Imported> folder = import_mesh(path, options);
    ASSERT_EQ(folder.code(), Errc::kFileUnreadable);
    EXPECT_TRUE(has(folder.error().detail, buffer)) << folder.error().detail;
  }
  std::filesystem::remove_all(buffer);
}

// Found by a newcomer: "link/.." is not the folder of the link.
TEST_F(SourceFileTest, PathsBehindLinksAreWhatTheyAre) {
  std::filesystem::create_directories(folder_ / "far" / "deep");
  std::filesystem::create_directory_symlink(folder_ / "far" / "deep", folder_ / "link");
  write("far/there.gltf", std::string(kGltf));
  write("far/three.bin", std::string(36, '\0'));
  write("far/there.obj", "mtllib there.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  write("far/there.mtl", "newmtl a\n");
  for (const char* const name : {"there.gltf", "there.obj"}) {
    const Result<Imported> imported = import_mesh(folder_ / "link" / ".." / name);
    ASSERT_TRUE(imported.ok()) << imported.error().message();
    EXPECT_EQ(imported->report.files_read.size(), 2u);
    for (const std::filesystem::path& file : imported->report.files_read) {
      EXPECT_TRUE(std::filesystem::exists(file)) << file;
    }
  }
}

TEST_F(SourceFileTest, ErrorsNameTheInput) {
  const Result<Imported> empty = import_mesh("-", with_bytes({}, "stdin.obj"));
  EXPECT_EQ(empty.error().detail, "standard input: the file is empty");
  const Result<Imported> bad = import_mesh("-", with_bytes("v zero 0 0\n", "stdin.obj"));
  EXPECT_EQ(bad.error().detail, "standard input: line 1: 'zero' is no number");
}

}  // namespace
}  // namespace boxtree::cooker
