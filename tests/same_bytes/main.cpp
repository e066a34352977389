// SPDX-License-Identifier: MIT
// Cooks generated meshes in every codec and geometry store, and prints a line each: mesh, codec,
// settings, size of the file and XXH3-64 of its bytes. And which encoding is chosen for each; and
// scenes of all of them.
//   boxtree_same_bytes [--jobs N] [--comma-locale] [--save FOLDER]
//   --jobs N         on so many threads [as many as there are processors]
//   --comma-locale   in the locale of the environment, whose decimal point must be a comma
//   --save FOLDER    also write each file, to see where two builds differ
#include <clocale>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <locale>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include "cooker/cook.h"
#include "runtime/file/checksum.h"
#include "tests/same_bytes/meshes.h"

namespace boxtree::same_bytes {
namespace {

using cooker::CookOptions;
using cooker::EncodedTree;
using cooker::Goal;
using cooker::SourceMesh;

struct Arguments {
  int jobs = tbb::task_arena::automatic;
  bool comma_locale = false;
  std::filesystem::path save;
};

struct Settings {
  std::string name;
  CookOptions options;
};

std::vector<Settings> all_settings() {
  std::vector<Settings> all = {{"exact", {}}, {"arrays", {}}};
  all.back().options.geometry = GeometryId::kArrays;
  for (const int bits : {12, 21, 30}) {
    all.push_back({fmt::format("grid-{}", bits), {}});
    all.back().options.geometry = GeometryId::kGrid;
    all.back().options.grid.bits = bits;
  }
  all.push_back({"external", {}});
  all.back().options.geometry = GeometryId::kExternal;
  all.push_back({"paper", {}});
  all.back().options.builder = cooker::Builder::kPaper;
  all.back().options.widths = cooker::FieldWidths::kEstimated;
  return all;
}

// What a setting would not change, or cannot be had, is left out.
bool applies(const Settings& settings, const SourceMesh& mesh, CodecId codec) {
  if (settings.options.geometry == GeometryId::kExternal) return mesh.face_ids.empty();
  // Codecs with one triangle per leaf have arrays in any case.
  if (settings.options.geometry == GeometryId::kArrays) return is_wide(codec);
  return settings.options.builder != cooker::Builder::kPaper || !is_wide(codec);
}

// Prints the lines. False as soon as a cook fails.
class Printer {
 public:
  explicit Printer(std::filesystem::path save) : save_(std::move(save)) {}

  bool print(const SourceMesh& mesh, std::string_view codec, const Settings& settings,
             const Result<EncodedTree>& tree) {
    if (!tree) {
      fmt::print(stderr, "{} {} {}: {}\n", mesh.name, codec, settings.name, tree.error().message());
      return false;
    }
    return print(mesh.name, codec, settings.name, cooker::serialize(std::span(&*tree, 1)));
  }

  bool print(std::string_view what, std::string_view codec, std::string_view settings,
             const std::vector<std::byte>& bytes) {
    fmt::print("{} {} {} {} {:016x}\n", what, codec, settings, bytes.size(), checksum(bytes));
    if (save_.empty()) return true;
    const std::string name = fmt::format("{}-{}-{}.bxt", what, codec, settings);
    std::ofstream file(save_ / name, std::ios::binary);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
    return file.good();
  }

 private:
  std::filesystem::path save_;
};

// What the choice goes by, of all candidates: bytes, and the work that was counted.
std::uint64_t hash_of(const cooker::Contest& contest) {
  std::vector<double> numbers;
  for (const cooker::Candidate& candidate : contest.candidates) {
    numbers.push_back(static_cast<double>(candidate.bytes()));
    for (const cooker::Work& work : candidate.work) {
      numbers.insert(numbers.end(), {work.nodes, work.leaves});
    }
  }
  return checksum(std::as_bytes(std::span(numbers)));
}

// Which encoding is the best for each goal. False when the cook fails.
bool print_choices(const SourceMesh& mesh) {
  CookOptions options;
  options.may_use_grid = true;
  options.may_use_arrays = true;
  options.try_all = true;
  Result<cooker::TriedTree> tried = try_encodings(mesh, options);
  if (!tried) return false;
  for (const Goal goal : {Goal::kMemory, Goal::kSpeed, Goal::kBalance}) {
    const auto best = choose(std::span(&tried->contest, 1), {goal, {}, {}});
    if (!best) return false;
    const cooker::Candidate& chosen = tried->contest.candidates[best->front()];
    fmt::print("{} best {} {} {} {:016x}\n", mesh.name, goal_name(goal), codec_name(chosen.codec),
               geometry_name(chosen.geometry), hash_of(tried->contest));
  }
  return true;
}

// Poses of whole numbers over powers of two: turned, stretched, mirrored, some far away, some of a
// precision that f32 does not have.
Pose pose_of(std::uint64_t number, bool is_fine) {
  std::uint64_t state = number * 0x9e3779b97f4a7c15u + 1;
  const auto next = [&state] {  // in [-1, 1), 11 bits
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(static_cast<std::int64_t>(state) >> 53) * 0x1p-10;
  };
  Pose pose = Pose::Identity();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 3; ++column) {
      const double diagonal = row == column ? (number % 3 == 0 ? -4 : 4) : 0;
      pose.linear()(row, column) = diagonal + next() + (is_fine ? next() * 0x1p-40 : 0);
    }
    pose.translation()[row] = next() * (number % 7 == 0 ? 0x1p20 : 0x1p7);
  }
  return pose;
}

// Instances of all meshes of a middling size in one scene: top level, poses, names, layers.
bool print_scene(Printer& printer, bool is_fine) {
  std::vector<EncodedTree> trees;
  for (const SourceMesh& mesh : meshes()) {
    Result<EncodedTree> tree = cook_as(mesh, CodecId::kWide8);
    if (!tree) return false;
    const bool is_middling = std::abs(tree->scale_exponent) < 40;
    if (tree->face_count > 0 && is_middling) trees.push_back(std::move(*tree));
  }
  cooker::SceneParts parts;
  parts.layers = {{"static", 0b11, kAllQueries}, {"moving", 0b11, kPairQueries}};
  parts.materials = {"first", "second"};
  parts.left_out = {{Part::kNames, 0xffffffffu, 3, "line 3"}};
  for (std::uint32_t i = 0; i < 500; ++i) {
    const bool moves = i % 50 == 0;
    parts.instances.push_back({i % static_cast<std::uint32_t>(trees.size()), i, moves ? 1u : 0u,
                               moves, fmt::format("instance {}", i % 40), pose_of(i, is_fine)});
  }
  const Result<std::vector<std::byte>> bytes = cooker::serialize({trees, {}, &parts});
  return bytes && printer.print("scene", "wide8", is_fine ? "f64-poses" : "f32-poses", *bytes);
}

bool print_all(Printer& printer) {
  for (const SourceMesh& mesh : meshes()) {
    for (const Settings& settings : all_settings()) {
      for (const CodecInfo& codec : kCodecs) {
        if (!applies(settings, mesh, codec.id)) continue;
        const Result<EncodedTree> tree = cook_as(mesh, codec.id, settings.options);
        if (!printer.print(mesh, codec.name, settings, tree)) return false;
      }
    }
    if (!print_choices(mesh)) return false;
  }
  return print_scene(printer, false) && print_scene(printer, true);
}

bool take_comma_locale() {
  if (std::setlocale(LC_ALL, "") == nullptr) return false;
  std::locale::global(std::locale(""));
  return std::string_view(std::localeconv()->decimal_point) == ",";
}

bool read(int count, char** words, Arguments& arguments) {
  for (int i = 1; i < count; ++i) {
    const std::string_view word = words[i];
    if (word == "--comma-locale") {
      arguments.comma_locale = true;
    } else if (word == "--jobs" && i + 1 < count) {
      arguments.jobs = std::atoi(words[++i]);
      if (arguments.jobs < 1) return false;
    } else if (word == "--save" && i + 1 < count) {
      arguments.save = words[++i];
    } else {
      return false;
    }
  }
  return true;
}

int run(int count, char** words) {
  Arguments arguments;
  if (!read(count, words, arguments)) {
    fmt::print(stderr, "usage: boxtree_same_bytes [--jobs N] [--comma-locale] [--save FOLDER]\n");
    return 1;
  }
  if (arguments.comma_locale && !take_comma_locale()) {
    fmt::print(stderr, "the locale of the environment has no decimal comma\n");
    return 1;
  }
  bool good = false;
  Printer printer(arguments.save);
  tbb::task_arena(arguments.jobs).execute([&] { good = print_all(printer); });
  return good ? 0 : 1;
}

}  // namespace
}  // namespace boxtree::same_bytes

int main(int count, char** words) {
  return boxtree::same_bytes::run(count, words);
}
