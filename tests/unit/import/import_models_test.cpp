// SPDX-License-Identifier: MIT
// Whole folders of real and of broken files: each is imported or refused, none crashes or hangs.
#include <algorithm>
#include <cstdlib>
#include <map>

#include "temp_files.h"

// Assimp leaks when it refuses a file; that is not for our leak check to find.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libassimp";
}

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Not found: a buffer, as that of glTF2/MissingBin.
constexpr Errc kAllowed[] = {Errc::kImportFailed,   Errc::kNoFaces,
                             Errc::kMeshNotFinite,  Errc::kMeshIndexOutOfRange,
                             Errc::kFileUnreadable, Errc::kFileNotFound};

std::vector<fs::path> files_below(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.is_regular_file()) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

// Returns how many files were imported.
std::size_t import_all(const fs::path& folder, const ImportOptions& options) {
  std::size_t imported = 0;
  for (const fs::path& file : files_below(folder)) {
    SCOPED_TRACE(file);
    const Result<Imported> result = import_mesh(file, options);
    if (result.ok()) {
      ++imported;
      expect_invariants(*result);
      continue;
    }
    EXPECT_NE(std::find(std::begin(kAllowed), std::end(kAllowed), result.code()),
              std::end(kAllowed))
        << result.error().message();
    EXPECT_NE(result.error().detail.find(file.string()), std::string::npos)
        << result.error().detail;
  }
  return imported;
}

class ModelsTest : public ::testing::TestWithParam<ImportOptions> {};

TEST_P(ModelsTest, Assimp) {
  const fs::path folder = ASSIMP_MODELS;
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there (package assimp-testmodels)";
  EXPECT_GT(import_all(folder, GetParam()), 300u);
}

TEST_P(ModelsTest, Glmark2) {
  const fs::path folder = GLMARK2_MODELS;
  if (!fs::exists(folder)) GTEST_SKIP() << folder << " is not there (package glmark2-data)";
  EXPECT_GE(import_all(folder, GetParam()), 6u);
}

TEST_P(ModelsTest, OwnFolder) {
  const char* folder = std::getenv("BOXTREE_TEST_MODELS");
  if (folder == nullptr) GTEST_SKIP() << "BOXTREE_TEST_MODELS names no folder of meshes";
  EXPECT_GT(import_all(folder, GetParam()), 0u);
}

INSTANTIATE_TEST_SUITE_P(
    All, ModelsTest,
    ::testing::Values(ImportOptions{},
                      ImportOptions{.skip_bad = true, .precision = Precision::kF64}),
    [](const auto& test) { return test.param.skip_bad ? "SkipBadF64" : "PlainF32"; });

}  // namespace
}  // namespace boxtree::cooker
