// SPDX-License-Identifier: MIT
// boxtree_import: imports files and prints each as one line of JSON, for the comparison with the
// second reader (import_oracle_test.py).
//   boxtree_import [--f64] [--skip-bad] [FILE...]    without files: one a line on standard input
#include <bit>
#include <cinttypes>
#include <cstdio>
#include <iostream>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cooker/import/import.h"
#include "cooker/import/source_scene.h"

namespace boxtree::cooker {
namespace {

using Json = nlohmann::ordered_json;

// Names may be any bytes, JSON is UTF-8.
std::string hex_of(std::string_view bytes) {
  std::string hex;
  for (const char byte : bytes) hex += fmt::format("{:02x}", static_cast<unsigned char>(byte));
  return hex;
}

// The bits of all coordinates, 8 or 16 digits each, without a gap.
std::string hex_of(const Positions& positions) {
  std::string hex;
  for (const float x : positions.f32) hex += fmt::format("{:08x}", std::bit_cast<std::uint32_t>(x));
  for (const double x : positions.f64) {
    hex += fmt::format("{:016x}", std::bit_cast<std::uint64_t>(x));
  }
  return hex;
}

Json counts_of(const ImportReport& report) {
  return {{"meshes", report.meshes},
          {"source_faces", report.source_faces},
          {"source_vertices", report.source_vertices},
          {"points_skipped", report.points_skipped},
          {"lines_skipped", report.lines_skipped},
          {"empty_skipped", report.empty_skipped},
          {"quads_kept", report.quads_kept},
          {"quads_split", report.quads_split},
          {"ngons_split", report.ngons_split},
          {"vertices_unused", report.vertices_unused},
          {"vertices_welded", report.vertices_welded},
          {"degenerate_faces", report.degenerate_faces},
          {"has_open_end", report.has_open_end}};
}

// Face id and corners of each face.
Json faces_of(const SourceMesh& mesh) {
  Json faces = Json::array();
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const auto& corner = mesh.faces[i].corner;
    Json face = {mesh.face_id(i), corner[0], corner[1], corner[2]};
    if (mesh.faces[i].is_quad()) face.push_back(corner[3]);
    faces.push_back(std::move(face));
  }
  return faces;
}

// First face id and name of each run of one material.
Json materials_of(const SourceScene& scene) {
  Json runs = Json::array();
  for (const FaceRun& run : scene.meshes.at(0).materials) {
    runs.push_back({run.first_face, hex_of(scene.materials.at(run.number))});
  }
  return runs;
}

// What import_scene promises of a file without a node graph: one instance of import_mesh's mesh.
bool is_same(const SourceScene& scene, const Imported& imported) {
  if (scene.meshes.size() != 1 || scene.instances.size() != 1) return false;
  const SceneMesh alone{
      imported.mesh, static_cast<std::uint32_t>(imported.report.source_faces), {}};
  return has_same_shape(scene.meshes[0], alone) &&
         scene.meshes[0].source_faces == alone.source_faces;
}

Json import(const std::string& path, const ImportOptions& options) {
  Json line = {{"path", hex_of(path)}};
  const Result<Imported> imported = import_mesh(path, options);
  const Result<SourceScene> scene = import_scene(path, options);
  line["scene_agrees"] =
      scene.code() == imported.code() && (!imported.ok() || is_same(*scene, *imported));
  if (!imported.ok()) {
    line["error"] = error_info(imported.code()).name;
    line["detail"] = hex_of(imported.error().detail);
    return line;
  }
  line["counts"] = counts_of(imported->report);
  line["positions"] = hex_of(imported->mesh.positions);
  line["faces"] = faces_of(imported->mesh);
  if (scene.ok() && !scene->meshes.empty()) line["materials"] = materials_of(*scene);
  line["skipped"] = Json::array();
  for (const SkippedFace& face : imported->report.skipped) line["skipped"].push_back(face.face_id);
  return line;
}

}  // namespace
}  // namespace boxtree::cooker

int main(int argc, char** argv) {
  using namespace boxtree::cooker;
  ImportOptions options;
  std::vector<std::string> paths;
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--f64") {
      options.precision = Precision::kF64;
    } else if (argument == "--skip-bad") {
      options.skip_bad = true;
    } else {
      paths.emplace_back(argument);
    }
  }
  const auto print = [&](const std::string& path) {
    fmt::print("{}\n", import(path, options).dump());
    std::fflush(stdout);  // so that the file at which a crash happens is known
  };
  for (const std::string& path : paths) print(path);
  if (paths.empty()) {
    for (std::string path; std::getline(std::cin, path);) print(path);
  }
  return 0;
}
