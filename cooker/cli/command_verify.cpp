// SPDX-License-Identifier: MIT
// `boxtree verify`: proves a file again, as the cooker did before it released it.
#include <algorithm>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include <boxtree/cooker/cli/output.h>
#include <boxtree/cooker/write/proof.h>
#include <boxtree/runtime/file/file.h>

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::filesystem::path file;
  bool json = false;
};

bool any_external(const File& file) {
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    if (file.tree_record(i).geometry == GeometryId::kExternal) return true;
  }
  return false;
}

void report(const Arguments& arguments, const Findings& findings, const std::string& summary) {
  if (arguments.json) {
    Json json = {{"file", arguments.file.string()}, {"ok", findings.empty()}};
    json["findings"] = Json::array();
    for (const Error& finding : findings) {
      json["findings"].push_back({{"code", static_cast<unsigned>(finding.code)},
                                  {"name", error_info(finding.code).name},
                                  {"detail", finding.detail}});
    }
    print(json);
    return;
  }
  for (const Error& finding : findings) {
    fmt::print("{:04} {}\n", static_cast<unsigned>(finding.code), finding.message());
  }
  if (findings.empty()) fmt::print("{}: {}\n", arguments.file.string(), summary);
}

int run(const Arguments& arguments) {
  const Result<File> file = File::open(arguments.file);
  if (!file) {
    const int status = fail(file.error());
    if (arguments.json) report(arguments, {file.error()}, {});
    return status;
  }
  const Findings findings = verify_file(*file);
  report(arguments, findings,
         any_external(*file)
             ? "structure holds; triangles are external and were not looked at"
             : fmt::format("holds: {} trees, every triangle inside every box above it",
                           file->tree_count()));
  return findings.empty() ? 0 : kExitBadInput;
}

}  // namespace

void add_verify_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *app.add_subcommand("verify", "Prove that a .bxt file holds what it promises");
  command.add_option("file", arguments->file, "A .bxt file")->required();
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
