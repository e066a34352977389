// SPDX-License-Identifier: MIT
// `boxtree split`: takes files out of a pack.
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <system_error>
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
#include "cooker/import/file_error.h"
#include "cooker/proof/pack_proof.h"
#include "cooker/system/path.h"
#include "cooker/text/counted.h"
#include "cooker/write/atomic_file.h"
#include "cooker/write/outputs.h"
#include "cooker/write/pack_members.h"
#include "format/pack.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

struct SplitArguments {
  std::filesystem::path file;
  std::filesystem::path folder;
  std::vector<std::string> trees;
  bool quiet = false;
  bool json = false;
};

// A member that is to be written.
struct Chosen {
  std::string name;
  std::vector<std::uint32_t> trees;  // numbers in the pack
  std::filesystem::path output;
};

// Of all members, or of those that are named by themselves or by a tree, in the order of the pack.
Result<std::vector<Chosen>> choose_members(const SplitArguments& arguments, const File& pack) {
  std::map<std::string, std::uint32_t, std::less<>> first_trees;  // of each member
  if (!arguments.trees.empty()) {
    for_each_member(pack, [&](std::string_view name, std::span<const std::uint32_t> trees) {
      first_trees.emplace(name, trees.front());
    });
  }
  std::vector<std::uint32_t> wanted;
  for (const std::string& tree : arguments.trees) {
    if (const auto member = first_trees.find(tree); member != first_trees.end()) {
      wanted.push_back(member->second);
      continue;
    }
    const Result<std::uint32_t> number = find_tree(pack, {tree});
    if (!number) return in_file(input_name(arguments.file), number.error());
    wanted.push_back(*number);
  }
  std::sort(wanted.begin(), wanted.end());
  std::vector<Chosen> chosen;
  for_each_member(pack, [&](std::string_view name, std::span<const std::uint32_t> trees) {
    const bool is_wanted =
        wanted.empty() || std::any_of(trees.begin(), trees.end(), [&](std::uint32_t tree) {
          return std::binary_search(wanted.begin(), wanted.end(), tree);
        });
    if (!is_wanted) return;
    chosen.push_back(
        {std::string(name), {trees.begin(), trees.end()}, arguments.folder / member_path(name)});
  });
  return chosen;
}

Status write_member(const File& pack, const Chosen& member) {
  if (const Findings findings = check_member(pack, member.name, member.trees); !findings.empty()) {
    return findings.front();
  }
  const Result<Member> file = pack.member(member.trees.front());
  if (!file) return file.error();
  if (Status status = verify_checksums(file->file); !status) {
    return Error{status.code(), "member " + member.name + ": " + status.error().detail};
  }
  std::error_code error;
  make_folders(folder_of(member.output), error);
  if (error) {
    return Error{Errc::kWriteFailed,
                 folder_of(member.output).string() + ": cannot be made: " + error.message()};
  }
  Result<AtomicFile> out = AtomicFile::create(member.output);
  if (!out) return out.error();
  if (Status status = out->write(file->file.bytes()); !status) return status;
  return out->commit();
}

int run(const SplitArguments& arguments) {
  const Result<OpenedFile> opened = open_file(arguments.file);
  if (!opened) return fail(opened.error());
  const File& pack = opened->file;
  const std::string name = input_name(arguments.file);
  if (!pack.is_pack()) {
    return usage(fmt::format(
        "split: {}: expected a pack, found {} that {} cooked as one file; "
        "cook each mesh to a file of its own, and pack these",
        name, counted(pack.tree_count(), "tree"), pack.tree_count() == 1 ? "was" : "were"));
  }
  int first_status = 0;
  const auto tell = [&](const Error& error) {
    const int status = fail(error);
    if (first_status == 0) first_status = status;
  };
  for (const Error& finding : check_pack_index(pack)) {
    // Bytes between members are of none; whatever else is wrong says of no member where it is.
    if (finding.code != Errc::kPaddingNotZero) return fail(in_file(name, finding));
    tell(in_file(name, finding));
  }
  const Result<std::vector<Chosen>> chosen = choose_members(arguments, pack);
  if (!chosen) return fail(chosen.error());
  for (const Chosen& member : *chosen) {
    Status status = check_outputs(std::array{Output{member.output}}, std::array{arguments.file});
    if (status) status = check_replaced(member.output, OutputKind::kCooked);
    if (!status) return usage("split: " + status.error().detail);
  }
  StepPrinter step(!arguments.quiet);
  Json files = Json::array();
  std::uint64_t bytes = 0;
  std::size_t written = 0;
  for (std::size_t i = 0; i < chosen->size(); ++i) {
    const Chosen& member = (*chosen)[i];
    step(fmt::format("split: file {} of {}", i + 1, chosen->size()));
    if (Status status = write_member(pack, member); !status) {
      step.clear();
      // Where one cannot be written, the others cannot either. Damage is of one alone.
      const bool is_damaged = status.code() != Errc::kWriteFailed;
      tell(is_damaged ? in_file(name, status.error()) : status.error());
      if (!is_damaged) return first_status;
      continue;
    }
    ++written;
    const std::uint64_t size = OpenFile::of(pack).pack_row(member.trees.front()).bytes;
    bytes += size;
    if (!arguments.json) continue;
    Json trees = Json::array();
    for (const std::uint32_t tree : member.trees) trees.push_back(pack.tree_name(tree));
    files.push_back({{"output", member.output.string()},
                     {"member", member.name},
                     {"bytes", size},
                     {"trees", std::move(trees)}});
  }
  step.clear();
  if (arguments.json) {
    print(Json{{"files", std::move(files)}});
  } else if (!arguments.quiet) {
    fmt::print("{}: {}, {} bytes\n", shown(arguments.folder.string()), counted(written, "file"),
               bytes);
  }
  return first_status;
}

}  // namespace

void add_split_command(Command& program, int& status) {
  const auto arguments = std::make_shared<SplitArguments>();
  Command& command = program.add_command(
      "split",
      "Take the files out of a pack, as they were put in\n"
      "A file is called after its name in the pack, with .bxt behind it; each / of the name makes "
      "a "
      "folder, and characters that no file may have on some system are written %XX. A file that is "
      "damaged is told and left out.");
  command.add_file("FILE", arguments->file, Values::kCookedFiles, "A pack; - is standard input")
      ->required();
  command.add_file("-o,--output", arguments->folder, Values::kFolders, "Where to write")
      ->type_name("FOLDER")
      ->required();
  command
      .add_option(
          "--tree", arguments->trees,
          "Only the file that is called so or has the tree: name or number; may be given again "
          "[all files]")
      ->type_name("TREE");
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors only");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.example("All of a pack", "boxtree split all.bxt -o taken");
  command.example("One tree", "boxtree split all.bxt --tree bunny -o taken");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
