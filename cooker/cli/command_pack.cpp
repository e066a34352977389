// SPDX-License-Identifier: MIT
// `boxtree pack`: many cooked files in one, with an index by name.
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/step_printer.h"
#include "cooker/text/counted.h"
#include "cooker/write/outputs.h"
#include "cooker/write/pack_writer.h"

namespace boxtree::cooker {
namespace {

struct PackArguments {
  std::vector<std::filesystem::path> files;
  std::filesystem::path output;
  std::string names = "tree";
  bool quiet = false;
  bool json = false;
};

// A blob is refused: trees of a pack are queried where they are mapped.
Result<File> open_input(const std::filesystem::path& path) {
  Result<OpenedFile> opened = open_file(path);
  if (!opened) return opened.error();
  if (opened->blob_bytes == 0) return std::move(opened->file);
  return Error{Errc::kFeatureUnsupported,
               input_name(path) +
                   ": expected a file that can be mapped, found a compressed one; "
                   "cook it with another codec"};
}

Status check_output(const PackArguments& arguments, const OutputTarget& output) {
  if (output.stream) return {};
  if (const std::string fault = mesh_name_fault(output.path, ".bxt"); !fault.empty()) {
    return Error{Errc::kWriteFailed, fault};
  }
  if (Status status = check_outputs(std::array{Output{output.path}}, arguments.files); !status) {
    return status;
  }
  return check_replaced(output.path, OutputKind::kCooked);
}

int run(const PackArguments& arguments) {
  if (is_standard_stream(arguments.output) && arguments.json) {
    return usage("pack: --json and -o - cannot share standard output");
  }
  const Result<OutputTarget> output = output_target(arguments.output, "bxt");
  if (!output) return usage("pack: " + output.error().detail);
  if (Status status = check_output(arguments, *output); !status) {
    return usage("pack: " + status.error().detail);
  }
  StepPrinter step(!arguments.quiet);
  const PackNames names = arguments.names == "path" ? PackNames::kPath : PackNames::kTree;
  std::vector<PackMember> members;
  for (std::size_t i = 0; i < arguments.files.size(); ++i) {
    step(fmt::format("pack: file {} of {}", i + 1, arguments.files.size()));
    Result<std::vector<PackMember>> of_input = list_members(arguments.files[i], names, open_input);
    if (!of_input) return fail(of_input.error());
    for (PackMember& member : *of_input) members.push_back(std::move(member));
  }
  step("pack: writing");
  const Result<PackReport> report = write_pack(*output, std::move(members), open_input);
  step.clear();
  if (report.code() == Errc::kInvalidQuery) return usage("pack: " + report.error().detail);
  if (!report) return fail(report.error());
  if (arguments.json) {
    print(Json{{"output", output->title()},
               {"bytes", report->bytes},
               {"members", report->members},
               {"trees", report->trees}});
  } else if (!arguments.quiet) {
    tell(*output, fmt::format("{}: {} of {}, {} bytes\n", shown(output->title()),
                              counted(report->trees, "tree"), counted(report->members, "file"),
                              report->bytes));
  }
  return 0;
}

}  // namespace

void add_pack_command(Command& program, int& status) {
  const auto arguments = std::make_shared<PackArguments>();
  Command& command =
      program.add_command("pack",
                          "Put many cooked files into one, without cooking\n"
                          "The output is a .bxt file that has the trees of all, and opens in no "
                          "time however many these "
                          "are. Files go in unchanged, and packs with all that is in them. The "
                          "same files give the same "
                          "bytes in whatever order they are named. split takes them out again.");
  command
      .add_file("FILE", arguments->files, Values::kCookedFiles,
                "Cooked files, and packs; @LIST: those that the lines of LIST name")
      ->required();
  command
      .add_file("-o,--output", arguments->output, Values::kFiles,
                "What to write, or - for standard output")
      ->required();
  command
      .add_option("--names", arguments->names,
                  "What trees are found by. tree: the tree's name, or FILE/TREE where a file has "
                  "several. path: the file's path")
      ->one_of({"tree", "path"})
      ->shows_default();
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors only");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.example("All trees in one file", "boxtree pack bunny.bxt level.bxt -o all.bxt");
  command.example("A tree of it",
                  "boxtree query all.bxt --tree bunny ray --origin 0,0,9 --direction 0,0,-1");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
