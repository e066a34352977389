// SPDX-License-Identifier: MIT
// boxtree_generate: large meshes for benchmarks, the same on every machine.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/bench/generated_mesh.h"
#include "tests/bench/mesh_files.h"
#include "tests/support/program_options.h"

int main(int argc, char** argv) {
  std::string kind;
  std::size_t triangles = 0;
  std::uint64_t seed = 1;
  std::filesystem::path path;
  boxtree::test::ProgramOptions program("Writes a generated mesh as binary PLY or STL.");
  program.add("kind", kind, "terrain or city").required().one_of({"terrain", "city"});
  program.add("triangles", triangles, "How many, exactly")
      .required()
      .between(std::size_t{1}, std::size_t{100'000'000});
  program.add("output", path, "OUT.ply or OUT.stl").required();
  program.add("--seed", seed, "Another mesh of the same kind").shows_default();
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  try {
    using namespace boxtree::bench;
    write_mesh(kind == "city" ? make_city(triangles, seed) : make_terrain(triangles, seed), path);
  } catch (const std::exception& error) {
    static_cast<void>(std::fprintf(stderr, "boxtree_generate: %s\n", error.what()));
    return 2;
  }
  return 0;
}
