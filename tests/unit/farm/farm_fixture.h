// SPDX-License-Identifier: MIT
// Sources with everything that a cook can read, and jobs in the words of the command line.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cooker/choose/cost_file.h"
#include "cooker/cli/job_words.h"
#include "cooker/farm/cook_key.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::test {

namespace fs = std::filesystem;

/// Two materials, two groups, quads and triangles, a face out of range (--skip-bad), and corners
/// that every grid has to move.
inline constexpr const char* kObj =
    "mtllib m.mtl\n"
    "v 0 0 0\nv 1.1 0.3333333 0\nv 1.7182818 1.4142135 0\nv 0 1 0.1\nv 0.5 0.5 3.1415926\n"
    "g floor\nusemtl stone\nf 1 2 3 4\nf 4 3 2\n"
    "g roof\nusemtl glass\nf 1 2 5\nf 2 3 5\nf 3 4 5\nf 4 1 5\nf 1 3 5\nf 2 4 5\n";

/// A triangle of a buffer in a file.
inline constexpr const char* kGltf =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],
"nodes":[{"mesh":0,"name":"n"}],"meshes":[{"name":"m","primitives":[{"attributes":{"POSITION":0}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,1]}],
"bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"uri":"b.bin","byteLength":36}]})";

/// Nine floats.
inline std::string gltf_buffer(float last) {
  const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, last};
  return {reinterpret_cast<const char*>(corners), sizeof(corners)};
}

inline void write_sources(const TempFolder& folder) {
  folder.write("m.obj", kObj);
  folder.write("m.mtl", "newmtl stone\nnewmtl glass\n");
  folder.write("other.obj", "v 0 0 0\nv 2.2 0 0.7\nv 0 2.3 0\nf 1 2 3\n");
  folder.write("g.gltf", kGltf);
  folder.write("b.bin", gltf_buffer(0.5f));
  folder.write("zones.ply",
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double y\n"
               "property double z\nelement face 2\nproperty list uchar int vertex_indices\n"
               "property int zone\nend_header\n0 0 0\n1.23456789012345 0 0\n1 1 0\n0 1 0.5\n"
               "3 0 1 2 7\n3 0 2 3 -4\n");
  folder.write("part.ply",
               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
               "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
               "property int place\nend_header\n0 0 0\n1.5 0 0\n1 1 0\n0 1 0.5\n"
               "3 0 1 2 7\n3 0 2 3 2147483646\n");
  folder.write("scene.toml",
               "[scene]\nfor = \"speed\"\n[[mesh]]\nname = \"m\"\nfile = \"m.obj\"\n"
               "hidden_faces = \"hidden.txt\"\n[[instance]]\nmesh = \"m\"\n");
  folder.write("hidden.txt", "1\n");
  const auto costs = cooker::compiled_costs();
  folder.write("costs.json", cooker::costs_to_json({{costs.begin(), costs.end()}, 1.5}));
}

/// Names of files, after --profile and --costs too, are below the folder.
inline cooker::CookJob job_in(const fs::path& folder, const std::vector<std::string>& inputs,
                              const std::vector<std::string>& options) {
  cooker::CookJob job = require(cooker::job_of_words(options));
  for (const std::string& input : inputs) job.inputs.push_back(folder / input);
  for (fs::path* file : {&job.profile, &job.costs, &job.depfile, &job.reordered}) {
    if (!file->empty()) *file = folder / *file;
  }
  job.output = folder / "out.bxt";
  return job;
}

inline std::string bytes_of(const cooker::CookJob& job) {
  static_cast<void>(require(cooker::cook_job(job)));
  return read_text(job.output);
}

inline std::string key_hex(const cooker::CookJob& job) {
  return cooker::hex_of(require(cooker::key_of(job)).key);
}

}  // namespace boxtree::test
