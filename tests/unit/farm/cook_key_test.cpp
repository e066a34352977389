// SPDX-License-Identifier: MIT
// A key changes exactly when a byte of the output may: every option that `cook` declares and every
// file that it reads is changed, one by one, and really cooked. A stale hit of a cache would be a
// wrong file in somebody's program.
//
//   cook_key_test --sets=N      as many random sets of options [300]
#include "cooker/farm/cook_key.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <map>
#include <random>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/farm/import_libraries.h"
#include "tests/unit/farm/farm_fixture.h"

namespace boxtree::cooker {
namespace {

using test::bytes_of;
using test::job_in;
using test::key_hex;
using test::require;
namespace fs = std::filesystem;

std::size_t random_sets = 300;

using Words = std::vector<std::string>;

enum class Effect {
  kNone,     // the bytes and the key stay
  kBytes,    // the key changes, and these values change bytes
  kMayBytes  // the key changes; on this mesh no byte does
};

// Ways of giving an option, and what it is compared with.
struct Variation {
  const char* option;
  Effect effect;
  Words words;
  Words inputs = {"m.obj"};
  Words base = {};
};

const std::vector<Variation>& variations() {
  static const std::vector<Variation> kAll = {
      {"--codec", Effect::kBytes, {"--codec", "wide4"}},
      {"--codec", Effect::kBytes, {"--codec", "plain-f32"}},
      {"--codec", Effect::kBytes, {"--codec", "blob-zstd"}},
      {"--codec", Effect::kBytes, {"--codec", "blob-lzma"}, {"m.obj"}, {"--codec", "blob-zstd"}},
      {"--codec", Effect::kNone, {"--codec", "auto"}},
      {"--for", Effect::kBytes, {"--for", "memory"}},
      {"--for", Effect::kBytes, {"--for", "speed"}},
      {"--for", Effect::kNone, {"--for", "balance"}},
      {"--exact", Effect::kBytes, {"--exact"}},
      {"--f64", Effect::kBytes, {"--f64"}},
      {"--tolerance", Effect::kBytes, {"--tolerance", "0.1"}},
      {"--tolerance", Effect::kBytes, {"--tolerance", "0.1"}, {"m.obj"}, {"--tolerance", "0.001"}},
      {"--grid-bits", Effect::kBytes, {"--grid-bits", "9"}, {"m.obj"}, {"--grid-bits", "20"}},
      {"--grid-step", Effect::kBytes, {"--grid-step", "2^-5"}, {"m.obj"}, {"--grid-step", "2^-9"}},
      {"--grid-step", Effect::kNone, {"--grid-step", "0.125"}, {"m.obj"}, {"--grid-step", "2^-3"}},
      {"--max-bytes-per-triangle", Effect::kBytes, {"--max-bytes-per-triangle", "1000"}},
      {"--max-slowdown", Effect::kBytes, {"--max-slowdown", "9"}},
      {"--no-face-ids", Effect::kBytes, {"--no-face-ids"}},
      {"--materials", Effect::kBytes, {"--materials"}},
      {"--user-data", Effect::kBytes, {"--user-data", "groups"}},
      {"--user-data", Effect::kBytes, {"--user-data", "zone"}, {"zones.ply"}},
      {"--face-ids", Effect::kBytes, {"--face-ids", "place"}, {"part.ply"}},
      {"--active-edges", Effect::kBytes, {"--active-edges", "20"}},
      {"--active-edges",
       Effect::kBytes,
       {"--active-edges", "1"},
       {"m.obj"},
       {"--active-edges", "2"}},
      {"--skip-bad", Effect::kBytes, {"--skip-bad"}},
      {"--builder", Effect::kBytes, {"--builder", "paper"}},
      {"--widths", Effect::kBytes, {"--widths", "estimated"}},
      {"--shrink-share", Effect::kBytes, {"--shrink-share", "0.5"}},
      {"--shrink-share",
       Effect::kNone,
       {"--shrink-share", "1"},
       {"m.obj"},
       {"--shrink-share", "1.0"}},
      {"--costs", Effect::kBytes, {"--costs", "costs.json"}},
      {"--external", Effect::kBytes, {"--external"}, {"other.obj"}},
      {"--strip", Effect::kBytes, {"--strip"}},
      {"--require-files", Effect::kMayBytes, {"--require-files"}},
      {"--trusted", Effect::kNone, {"--trusted"}, {"g.gltf"}},
      {"--try-all", Effect::kMayBytes, {"--try-all"}},
      {"--scene", Effect::kBytes, {"--scene"}},
      {"--flatten", Effect::kMayBytes, {"--flatten"}},
      {"--flatten", Effect::kNone, {"--flatten"}, {"m.obj", "other.obj"}},
      {"--profile", Effect::kBytes, {"--profile", "scene.toml"}, {}, {"--profile", "same.toml"}},
      {"--write-reordered", Effect::kBytes, {"--write-reordered", "ordered.obj"}},
      {"--depfile", Effect::kNone, {"--depfile", "out.d"}},
  };
  return kAll;
}

// What a command line says of a run and not of a job, or by which it gets its input: no word of a
// manifest changes with them. tests/cli/farm_test.sh compares their bytes.
const std::vector<std::string>& options_of_runs() {
  static const std::vector<std::string> kAll = {
      "--output",     "--format",    "--manifest",   "--shard",      "--memory",
      "--journal",    "--fail-fast", "--keep-going", "--reread",     "--cache",
      "--cache-size", "--audit",     "--why",        "--candidates", "--jobs",
      "--json",       "--quiet",     "--help",       "--help-all"};
  return kAll;
}

TEST(CookKey, EveryOptionOfCookIsVaried) {
  Command program("boxtree", "", "");
  int status = 0;
  add_cook_command(program, status);
  for (const OptionText& option : options_of(*program.find("cook"))) {
    const std::string& name = option.names.back();
    const bool is_of_run = std::count(options_of_runs().begin(), options_of_runs().end(), name) > 0;
    const bool is_varied = std::any_of(variations().begin(), variations().end(),
                                       [&](const Variation& each) { return each.option == name; });
    EXPECT_NE(is_of_run, is_varied)
        << name << ": a new option is either of the run, or has a variation here and, if it can "
        << "change bytes, a place in cook_key.cpp";
  }
}

TEST(CookKey, ChangesExactlyWhenAnOptionCanChangeBytes) {
  const test::TempFolder folder;
  test::write_sources(folder);
  folder.write("same.toml", test::read_text(folder.path() / "scene.toml") + "# longer\n");
  for (const auto& [option, effect, words, inputs, base] : variations()) {
    const CookJob before = job_in(folder.path(), inputs, base);
    const CookJob after = job_in(folder.path(), inputs, words);
    SCOPED_TRACE(testing::PrintToString(words));
    EXPECT_EQ(key_hex(before) == key_hex(after), effect == Effect::kNone);
    EXPECT_EQ(bytes_of(before) == bytes_of(after), effect != Effect::kBytes);
  }
}

struct Change {
  const char* what;
  const char* file;
  const char* bytes;
  Words inputs = {"m.obj"};
  Words options = {};
};

TEST(CookKey, ChangesWithEachFileThatIsRead) {
  const std::string other_buffer = test::gltf_buffer(0.25f);
  const Change changes[] = {
      {"a comment", "m.obj",
       "# of no effect on the mesh\nmtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"},
      {"a material library", "m.mtl", "newmtl stone\n"},
      {"a second input",
       "other.obj",
       "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n",
       {"m.obj", "other.obj"}},
      {"a profile",
       "scene.toml",
       "[scene]\nfor = \"memory\"\n[[mesh]]\nname = \"m\"\nfile = \"m.obj\"\nhidden_faces = "
       "\"hidden.txt\"\n[[instance]]\nmesh = \"m\"\n",
       {},
       {"--profile", "scene.toml"}},
      {"hidden faces", "hidden.txt", "2\n3\n", {}, {"--profile", "scene.toml"}},
      {"a mesh of a profile",
       "m.obj",
       "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n",
       {},
       {"--profile", "scene.toml"}},
  };
  for (const Change& change : changes) {
    SCOPED_TRACE(change.what);
    const test::TempFolder folder;
    test::write_sources(folder);
    const CookJob job = job_in(folder.path(), change.inputs, change.options);
    const std::string key = key_hex(job), bytes = bytes_of(job);
    const fs::path file = folder.path() / change.file;
    const std::string old = test::read_text(file);
    folder.write(change.file, change.bytes);
    EXPECT_NE(key_hex(job), key);
    EXPECT_NE(bytes_of(job), bytes);
    folder.write(change.file, old);
    EXPECT_EQ(key_hex(job), key);
    EXPECT_EQ(bytes_of(job), bytes);
  }
}

// Its bytes are in no other file, and costs decide only through what they are.
TEST(CookKey, ChangesWithABufferAndWithCosts) {
  const test::TempFolder folder;
  test::write_sources(folder);
  const CookJob mesh = job_in(folder.path(), {"g.gltf"}, {});
  const std::string key = key_hex(mesh), bytes = bytes_of(mesh);
  folder.write("b.bin", test::gltf_buffer(0.25f));
  EXPECT_NE(key_hex(mesh), key);
  EXPECT_NE(bytes_of(mesh), bytes);
  const CookJob by_costs = job_in(folder.path(), {"m.obj"}, {"--costs", "costs.json"});
  const std::string costs_key = key_hex(by_costs);
  folder.write("costs.json", test::read_text(folder.path() / "costs.json") + "\n");
  EXPECT_NE(key_hex(by_costs), costs_key);
}

// A library that comes is found, without that the mesh changes.
TEST(CookKey, ChangesWhenAFileComesThatWasMissing) {
  const test::TempFolder folder;
  test::write_sources(folder);
  const std::string library = test::read_text(folder.path() / "m.mtl");
  fs::remove(folder.path() / "m.mtl");
  const CookJob job = job_in(folder.path(), {"m.obj"}, {});
  const std::string key = key_hex(job), bytes = bytes_of(job);
  folder.write("m.mtl", library);
  EXPECT_NE(key_hex(job), key);
  EXPECT_NE(bytes_of(job), bytes);
}

TEST(CookKey, DoesNotChangeWithFoldersTimesAndOutputs) {
  const test::TempFolder folder, other;
  for (const test::TempFolder* each : {&folder, &other}) test::write_sources(*each);
  for (const auto& [inputs, options] : {std::pair(Words{"m.obj", "zones.ply"}, Words{"--strip"}),
                                        std::pair(Words{"g.gltf"}, Words{}),
                                        std::pair(Words{}, Words{"--profile", "scene.toml"})}) {
    const CookJob job = job_in(folder.path(), inputs, options);
    const std::string key = key_hex(job), bytes = bytes_of(job);
    CookJob elsewhere = job_in(other.path(), inputs, options);
    elsewhere.output = other.path() / "elsewhere.bxt";
    for (const auto& entry : fs::directory_iterator(other.path())) {
      fs::last_write_time(entry.path(), fs::file_time_type::clock::now() + std::chrono::hours(1));
    }
    EXPECT_EQ(key_hex(elsewhere), key);
    EXPECT_EQ(bytes_of(elsewhere), bytes);
  }
}

// Trees are called after their files, and their order is that of the inputs.
TEST(CookKey, ChangesWithNamesAndTheOrderOfInputs) {
  const test::TempFolder folder;
  test::write_sources(folder);
  const CookJob job = job_in(folder.path(), {"m.obj", "other.obj"}, {"--strip"});
  const std::string key = key_hex(job), bytes = bytes_of(job);
  fs::copy(folder.path() / "m.obj", folder.path() / "renamed.obj");
  for (const Words& inputs : {Words{"renamed.obj", "other.obj"}, Words{"other.obj", "m.obj"}}) {
    const CookJob changed = job_in(folder.path(), inputs, {"--strip"});
    EXPECT_NE(key_hex(changed), key);
    EXPECT_NE(bytes_of(changed), bytes);
  }
}

TEST(CookKey, BytesCountAsTheFileTheyStandFor) {
  const test::TempFolder folder;
  test::write_sources(folder);
  const std::string text = test::read_text(folder.path() / "other.obj");
  const auto job_with = [&](const std::string& bytes, const Words& inputs) {
    CookJob job;
    job.inputs.assign(inputs.begin(), inputs.end());
    for (fs::path& input : job.inputs) {
      if (input != "-") input = folder.path() / input;
    }
    job.options.import.bytes =
        SourceBytes{"-", "standard input", "stdin.obj", std::as_bytes(std::span(bytes))};
    return key_hex(job);
  };
  const std::string key = job_with(text, {"-", "m.obj"});
  EXPECT_EQ(job_with(std::string(text), {"-", "m.obj"}), key);
  const std::string longer = text + "#\n";
  EXPECT_NE(job_with(longer, {"-", "m.obj"}), key);
  EXPECT_NE(job_with(text, {"m.obj", "-"}), key);
}

// What a cook read is what its key was made of; else an edit of the rest would be a stale hit.
TEST(CookKey, ListsAllFilesThatACookReads) {
  const test::TempFolder folder;
  test::write_sources(folder);
  std::vector<CookJob> jobs;
  for (const Words& inputs :
       {Words{"m.obj"}, Words{"g.gltf"}, Words{"zones.ply", "m.obj", "g.gltf"}}) {
    jobs.push_back(job_in(folder.path(), inputs, {"--costs", "costs.json"}));
  }
  jobs.push_back(job_in(folder.path(), {}, {"--profile", "scene.toml"}));
  // Meshes that assimp reads, of packages; those that are not there are left out.
  const fs::path models = "/usr/share/assimp/models";
  for (const char* model :
       {"Collada/duck.dae", "3DS/fels.3ds", "glTF2/BoxTextured-glTF/BoxTextured.gltf",
        "MD5/SimpleCube.md5mesh", "X/test_cube_text.x", "Ogre/TheThing/Mesh.mesh.xml"}) {
    if (!fs::exists(models / model)) continue;
    CookJob job = job_in(folder.path(), {}, {});
    job.inputs = {models / model};
    jobs.push_back(std::move(job));
  }
  for (const CookJob& job : jobs) {
    SCOPED_TRACE(testing::PrintToString(job.inputs));
    const Summary summary = require(cook_job(job));
    std::vector<fs::path> keyed;
    for (const JobFile& file : require(list_job_files(job))) keyed.push_back(file.path);
    EXPECT_EQ(keyed, summary.files_read);
  }
}

TEST(CookKey, SaysWhatCannotBeRead) {
  const test::TempFolder folder;
  test::write_sources(folder);
  const auto error_of = [&](const Words& inputs, const Words& options) {
    return key_of(job_in(folder.path(), inputs, options)).error();
  };
  EXPECT_EQ(error_of({"absent.obj"}, {}).code, Errc::kFileNotFound);
  EXPECT_EQ(error_of({}, {"--profile", "absent.toml"}).code, Errc::kFileNotFound);
  EXPECT_EQ(error_of({"m.obj"}, {"--costs", "absent.json"}).code, Errc::kFileNotFound);
  EXPECT_EQ(error_of({"m.obj"}, {"--profile", "scene.toml"}).code, Errc::kProfileInvalid);
  fs::remove(folder.path() / "b.bin");
  const Error error = error_of({"g.gltf"}, {});
  EXPECT_EQ(error.code, Errc::kFileNotFound);
  EXPECT_NE(error.detail.find("b.bin"), std::string::npos) << error.detail;
}

// The order of words, defaults that are stated and other spellings must not make other keys, or no
// set would meet an equal one here.
Words random_words(std::mt19937& random) {
  const std::vector<std::vector<Words>> kChoices = {
      {{},
       {"--codec", "auto"},
       {"--codec", "wide4"},
       {"--codec", "wide8"},
       {"--codec", "blob-zstd"}},
      {{}, {"--for", "balance"}, {"--for", "memory"}, {"--for", "speed"}},
      {{},
       {},
       {"--exact"},
       {"--tolerance", "0.1"},
       {"--tolerance", "1e-1"},
       {"--grid-step", "2^-3"},
       {"--grid-step", "0.125"},
       {"--grid-bits", "12"}},
      {{}, {}, {"--no-face-ids"}},
      {{}, {}, {"--materials"}},
      {{}, {}, {"--strip"}},
      {{}, {"--trusted"}},
      {{}, {}, {}, {"--require-files"}},
      {{}, {}, {}, {"--try-all"}},
      {{}, {}, {"--scene"}, {"--flatten"}},
      {{}, {}, {}, {"--active-edges", "30"}, {"--active-edges", "30.0"}},
      {{}, {}, {}, {"--user-data", "groups"}},
      {{}, {}, {}, {"--builder", "paper"}, {"--builder", "sah"}},
  };
  std::vector<Words> chosen;
  for (const std::vector<Words>& choice : kChoices)
    chosen.push_back(choice[random() % choice.size()]);
  std::shuffle(chosen.begin(), chosen.end(), random);
  Words words;
  for (const Words& each : chosen) words.insert(words.end(), each.begin(), each.end());
  return words;
}

// Found by an audit: draco decodes positions for assimp, and no key said which.
TEST(CookKey, HasTheLibrariesOfAssimpWhereItReads) {
  const test::TempFolder folder;
  test::write_sources(folder);
  const auto text = [&](const char* input) {
    const CookJob job = job_in(folder.path(), {input}, {});
    return key_text(job, require(key_of(job)).files);
  };
  const std::string line = "\nlibraries " + import_libraries() + "\n";
  EXPECT_EQ(text("m.obj").find("\nlibraries "), std::string::npos);
  EXPECT_EQ(text("g.gltf").find(line) != std::string::npos, !import_libraries().empty());
  if (import_libraries().empty()) GTEST_SKIP() << "assimp is a part of the program";
  EXPECT_TRUE(import_libraries().starts_with("libassimp"));
  EXPECT_EQ(import_libraries().find("libc.so"), std::string::npos);
  EXPECT_EQ(import_libraries().find("unknown"), std::string::npos);
}

TEST(CookKey, EqualKeysGiveEqualBytes) {
  const test::TempFolder folder;
  test::write_sources(folder);
  std::mt19937 random(25);
  std::map<std::string, std::string> output_of_key;
  std::size_t cooked = 0, met = 0;
  while (cooked < random_sets) {
    const Words words = random_words(random);
    if (!job_of_words(words)) continue;  // options that exclude each other
    const CookJob job = job_in(folder.path(), {"m.obj"}, words);
    const Result<Summary> summary = cook_job(job);
    // An error is an output, too: what an option makes impossible.
    const std::string output = summary ? hex_of(sha256_of(test::read_text(job.output)))
                                       : std::string(error_info(summary.code()).name);
    const auto [known, is_new] = output_of_key.emplace(key_hex(job), output);
    EXPECT_EQ(known->second, output) << testing::PrintToString(words);
    ++cooked;
    if (!is_new) ++met;
  }
  EXPECT_GT(met, 0u);
}

}  // namespace
}  // namespace boxtree::cooker

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word.starts_with("--sets=")) boxtree::cooker::random_sets = std::stoul(word.substr(7));
  }
  return RUN_ALL_TESTS();
}
