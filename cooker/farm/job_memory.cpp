// SPDX-License-Identifier: MIT
#include "cooker/farm/job_memory.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>
#include <vector>

#include "cooker/import/import.h"
#include "cooker/import/text_tokens.h"
#include "cooker/import/whole_file.h"
#include "cooker/scene/cook_input.h"
#include "cooker/scene/profile.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Bytes of memory for each byte of a file, by `/usr/bin/time -f %M boxtree cook MESH -o FILE.bxt
// --jobs 1` less 16 MB for the program, of 96 800 triangles: OBJ 2.6, OFF 2.7, binary PLY 4.8,
// binary STL 1.8; with room for files that say their meshes in fewer bytes.
struct Factor {
  const char* extension;
  std::uint64_t bytes;
};
constexpr std::array kFactors = {
    Factor{"obj", 4},
    Factor{"off", 4},
    Factor{"ply", 8},
    Factor{"stl", 4},
};
// Of formats that assimp reads: glTF 6.3, and others that assimp holds in more than one form.
constexpr std::uint64_t kOtherFactor = 16;
// As often that much if all candidates are tried and kept: 7 times, of the same meshes.
constexpr std::uint64_t kAllCandidates = 8;

std::uint64_t bytes_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(file, error);
  return error ? 0 : bytes;
}

// What a .gltf states of its buffers, which are in other files or in text.
std::uint64_t stated_buffer_bytes(const fs::path& file) {
  if (!has_extension(file, "gltf")) return 0;
  const Result<std::string> text = read_whole_file(file, kMaxResultsBytes);
  if (!text) return 0;
  const ParsedJson document = parse_json(*text);
  const Json* const buffers = document.value.find("buffers");
  if (buffers == nullptr) return 0;
  std::uint64_t sum = 0;
  for (const Json& buffer : *buffers) {
    const Json* const bytes = buffer.find("byteLength");
    if (bytes == nullptr || !bytes->is_number_unsigned()) continue;
    // Any number may be stated; more than a file can have counts as that.
    sum += std::min(bytes->get<std::uint64_t>(), std::uint64_t{1} << 40);
  }
  return sum;
}

std::uint64_t memory_of_mesh(const fs::path& file) {
  const Factor* const factor = find_extension(kFactors, file);
  const std::uint64_t bytes = bytes_of(file) + stated_buffer_bytes(file);
  return bytes * (factor != nullptr ? factor->bytes : kOtherFactor);
}

}  // namespace

std::uint64_t estimated_memory(const CookJob& job) {
  std::vector<fs::path> meshes = job.inputs;
  bool keeps_all = job.options.try_all;
  if (!job.profile.empty()) {
    const Result<Profile> profile = read_profile(job.profile);
    if (!profile) return 0;
    const Result<std::vector<fs::path>> files = scene_files(job.inputs, *profile);
    if (!files) return 0;
    meshes = *files;
    keeps_all = keeps_all || profile->budget.bytes.has_value();
  }
  std::uint64_t sum = 0;
  for (const fs::path& mesh : meshes) sum += memory_of_mesh(mesh);
  return keeps_all ? sum * kAllCandidates : sum;
}

}  // namespace boxtree::cooker
