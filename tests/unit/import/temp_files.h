// SPDX-License-Identifier: MIT
// A folder of small mesh files that lives as long as one test.
#pragma once

#include <atomic>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unistd.h>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/import/import.h"

namespace boxtree::cooker {

class ImportTest : public ::testing::Test {
 protected:
  ImportTest() {
    static std::atomic<int> count = 0;
    folder_ = std::filesystem::temp_directory_path() /
              ("boxtree-import-" + std::to_string(getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(folder_);
  }
  ~ImportTest() override {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }

  std::filesystem::path write(const std::string& name, std::string_view bytes) const {
    const std::filesystem::path path = folder_ / name;
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary).write(bytes.data(), std::ssize(bytes));
    return path;
  }
  // Import that must succeed.
  Imported load(const std::string& name, std::string_view bytes,
                const ImportOptions& options = {}) const {
    Result<Imported> result = import_mesh(write(name, bytes), options);
    EXPECT_TRUE(result.ok()) << result.error().message();
    return result.ok() ? std::move(result).value() : Imported();
  }
  // Import that must fail.
  Error fail(const std::string& name, std::string_view bytes,
             const ImportOptions& options = {}) const {
    const std::filesystem::path path = write(name, bytes);
    const Result<Imported> result = import_mesh(path, options);
    EXPECT_FALSE(result.ok()) << name;
    if (result.ok()) return {};
    EXPECT_NE(result.error().detail.find(path.string()), std::string::npos)
        << "names the file: " << result.error().detail;
    return result.error();
  }

  std::filesystem::path folder_;
};

inline ::testing::AssertionResult has(const std::string& text, std::string_view part) {
  if (text.find(part) != std::string::npos) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "no '" << part << "' in: " << text;
}

inline void expect_invariants(const Imported& imported) {
  const SourceMesh& mesh = imported.mesh;
  const ImportReport& report = imported.report;
  ASSERT_FALSE(mesh.faces.empty());
  ASSERT_TRUE(mesh.face_ids.empty() || mesh.face_ids.size() == mesh.faces.size());
  ASSERT_TRUE(mesh.positions.f32.empty() || mesh.positions.f64.empty());
  std::vector<bool> used(mesh.positions.size(), false);
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const std::size_t corners = mesh.faces[i].is_quad() ? 4 : 3;
    for (std::size_t corner = 0; corner < corners; ++corner) {
      const std::uint32_t vertex = mesh.faces[i].corner[corner];
      ASSERT_LT(vertex, mesh.positions.size());
      used[vertex] = true;
    }
    ASSERT_LT(mesh.face_id(i), report.source_faces);
    if (i > 0) {
      ASSERT_LE(mesh.face_id(i - 1), mesh.face_id(i));
    }
  }
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    ASSERT_TRUE(used[i]) << "vertex " << i << " is used by no face";
    const Eigen::Vector3d position = mesh.positions[i];
    for (int axis = 0; axis < 3; ++axis) ASSERT_TRUE(std::isfinite(position[axis]));
  }
  // Every face of the source is there or reported.
  std::size_t ids = 1;
  for (std::size_t i = 1; i < mesh.faces.size(); ++i) {
    ids += mesh.face_id(i) != mesh.face_id(i - 1) ? 1u : 0u;
  }
  EXPECT_EQ(ids + report.skipped.size(), report.source_faces);
  EXPECT_EQ(report.source_vertices,
            mesh.positions.size() + report.vertices_welded + report.vertices_unused);
  EXPECT_FALSE(report.files_read.empty());
}

}  // namespace boxtree::cooker
