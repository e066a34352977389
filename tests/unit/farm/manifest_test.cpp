// SPDX-License-Identifier: MIT
// Lines of a manifest, and what is wrong with lines that are none.
#include "cooker/farm/manifest.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

using test::require;
namespace fs = std::filesystem;

TEST(Manifest, HasAJobInEachLine) {
  const auto lines =
      require(parse_manifest("{\"inputs\":[\"a.obj\",\"b.ply\"],\"output\":\"out/"
                             "a.bxt\",\"options\":[\"--for\",\"memory\"]}\n"
                             "\n  \r\n"
                             "{ \"output\": \"s.bxt\", \"profile\": \"scene.toml\" }",
                             "m"));
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0].line, 1u);
  EXPECT_EQ(lines[0].inputs, (std::vector<std::filesystem::path>{"a.obj", "b.ply"}));
  EXPECT_EQ(lines[0].output, "out/a.bxt");
  EXPECT_EQ(lines[0].options, (std::vector<std::string>{"--for", "memory"}));
  EXPECT_EQ(lines[1].line, 4u);
  EXPECT_EQ(lines[1].profile, "scene.toml");
  EXPECT_TRUE(require(parse_manifest("", "m")).empty());
}

std::string refusal(const std::string& text) {
  const auto lines = parse_manifest(text, "jobs.jsonl");
  if (lines) return "accepted";
  EXPECT_EQ(lines.code(), Errc::kDocumentInvalid);
  return lines.error().detail;
}

TEST(Manifest, SaysWhatIsWrongWithALine) {
  const std::string good = "{\"inputs\":[\"a.obj\"],\"output\":\"a.bxt\"}\n";
  EXPECT_EQ(refusal(good + "{\"inputs\":[\"b.obj\"],\"output\":\"b"),
            "jobs.jsonl:2: expected one JSON object in this line, found none at byte 32");
  EXPECT_EQ(refusal(good + "7"), "jobs.jsonl:2: expected a JSON object, found number");
  EXPECT_EQ(refusal("{\"input\":[\"a.obj\"],\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: expected inputs, output, options or profile, found \"input\"; did you "
            "mean 'inputs'?");
  EXPECT_EQ(
      refusal("{\"inputs\":\"a.obj\",\"output\":\"a.bxt\"}"),
      "jobs.jsonl:1: inputs: expected an array of texts, as \"inputs\": [\"...\"], found string");
  EXPECT_EQ(refusal(" [" + good),
            "jobs.jsonl:1: expected a JSON object in each line, found [; no list stands around "
            "them");
  EXPECT_EQ(refusal("{\"inputs\":[7],\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: inputs: expected a text, found number");
  EXPECT_EQ(refusal("{\"inputs\":[[\"a\"]],\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: expected arrays of texts, found arrays or objects in them");
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\"]}"),
            "jobs.jsonl:1: output: expected the name of a file, found none");
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\"],\"output\":\"\"}"),
            "jobs.jsonl:1: output: found an empty text");
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\"],\"output\":\"-\"}"),
            "jobs.jsonl:1: output: expected a file, found -");
  EXPECT_EQ(refusal("{\"inputs\":[\"-\"],\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: inputs: expected a file, found -");
  EXPECT_EQ(refusal("{\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: inputs: expected names of meshes, or \"profile\" with a source; found "
            "neither");
}

// Each would overwrite the other's, or what the other reads, in an order that nobody states.
TEST(Manifest, RefusesOutputsThatMeetOthers) {
  const std::string first = "{\"inputs\":[\"a.obj\"],\"output\":\"out/a.bxt\"}\n\n";
  EXPECT_EQ(refusal(first + "{\"inputs\":[\"b.obj\"],\"output\":\"out/../out/./a.bxt\"}"),
            "jobs.jsonl:3: output: out/../out/./a.bxt is that of line 1, too");
  EXPECT_EQ(refusal(first + "{\"inputs\":[\"out/a.bxt\"],\"output\":\"b.bxt\"}"),
            "jobs.jsonl:3: inputs: out/a.bxt is the output of line 1");
  EXPECT_EQ(refusal(first + "{\"profile\":\"out/a.bxt\",\"output\":\"b.bxt\"}"),
            "jobs.jsonl:3: inputs: out/a.bxt is the output of line 1");
}

// Found by an audit: a link of a folder, or of a file, hid that two lines write one file.
TEST(Manifest, RefusesOutputsThatMeetOthersBehindLinks) {
  const test::TempFolder folder;
  fs::create_directory(folder.path() / "real");
  fs::create_directory_symlink("real", folder.path() / "link");
  fs::create_symlink("real/a.bxt", folder.path() / "a.bxt");
  const auto line = [&](const std::string& input, const std::string& output) {
    return fmt::format(R"({{"inputs":["{0}/{1}"],"output":"{0}/{2}"}})", folder.path().string(),
                       input, output) +
           "\n";
  };
  const std::string first = line("a.obj", "real/a.bxt");
  const std::string at = folder.path().string() + "/";
  EXPECT_EQ(refusal(first + line("b.obj", "link/a.bxt")),
            "jobs.jsonl:2: output: " + at + "link/a.bxt is that of line 1, too");
  EXPECT_EQ(refusal(first + line("b.obj", "link/../real/new/../a.bxt")),
            "jobs.jsonl:2: output: " + at + "link/../real/new/../a.bxt is that of line 1, too");
  EXPECT_EQ(refusal(first + line("b.obj", "a.bxt")),
            "jobs.jsonl:2: output: " + at + "a.bxt is that of line 1, too");
  EXPECT_EQ(refusal(first + line("link/a.bxt", "b.bxt")),
            "jobs.jsonl:2: inputs: " + at + "link/a.bxt is the output of line 1");
  // Also where the folders of the outputs are not there yet.
  EXPECT_EQ(refusal(line("a.obj", "real/new/a.bxt") + line("b.obj", "link/new/a.bxt")),
            "jobs.jsonl:2: output: " + at + "link/new/a.bxt is that of line 1, too");
  EXPECT_EQ(refusal(first + line("b.obj", "link/b.bxt")), "accepted");
  // Not by the text: what ".." leads to behind a link.
  fs::create_directories(folder.path() / "far/away");
  fs::create_directory_symlink("far/away", folder.path() / "there");
  EXPECT_EQ(refusal(line("a.obj", "b.bxt") + line("b.obj", "there/../b.bxt")), "accepted");
}

// Found by an audit: the text behind a NUL was cut off, so that another file was read or written.
TEST(Manifest, RefusesTextsWithANul) {
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\"],\"output\":\"a\\u0000b.bxt\"}"),
            "jobs.jsonl:1: output: expected a text without NUL characters, found one at byte 2");
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\\u0000\"],\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: inputs: expected a text without NUL characters, found one at byte 6");
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\"],\"output\":\"a.bxt\",\"options\":[\"\\u0000\"]}"),
            "jobs.jsonl:1: options: expected a text without NUL characters, found one at byte 1");
  EXPECT_EQ(refusal("{\"profile\":\"a\\u0000.toml\",\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: profile: expected a text without NUL characters, found one at byte 2");
}

// Found by an audit: the last of several members of one name counted, and no job had the others.
TEST(Manifest, RefusesMembersThatComeTwice) {
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\"],\"inputs\":[\"b.obj\"],\"output\":\"a.bxt\"}"),
            "jobs.jsonl:1: inputs: expected once, found twice");
  EXPECT_EQ(refusal("{\"inputs\":[\"a.obj\"],\"output\":\"a.bxt\",\"output\":\"b.bxt\"}"),
            "jobs.jsonl:1: output: expected once, found twice");
}

}  // namespace
}  // namespace boxtree::cooker
