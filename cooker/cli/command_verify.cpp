// SPDX-License-Identifier: MIT
// `boxtree verify`: proves a file again, as the cooker did before it released it.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <boxtree/file.h>

#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/import/import.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/proof.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::filesystem::path file;
  std::filesystem::path mesh;
  bool json = false;
};

template <class Property>
bool any_tree(const File& file, Property property) {
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    if (property(OpenFile::of(file).tree_record(i))) return true;
  }
  return false;
}
bool any_external(const File& file) {
  return any_tree(file, [](const TreeRecord& r) { return r.geometry == GeometryId::kExternal; });
}
bool any_f64(const File& file) {
  return any_tree(file, [](const TreeRecord& r) { return (r.flags & kTreePositionsF64) != 0; });
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
    fmt::print("{:04} {}\n", static_cast<unsigned>(finding.code), shown(finding.message()));
  }
  if (findings.empty()) fmt::print("{}: {}\n", shown(arguments.file.string()), summary);
}

int run(const Arguments& arguments) {
  const Result<OpenedFile> opened = open_file(arguments.file);
  if (!opened) {
    const int status = fail(opened.error());
    if (arguments.json) report(arguments, {opened.error()}, {});
    return status;
  }
  const File* const file = &opened->file;
  std::optional<MeshArrays> arrays;
  Imported imported;
  if (!arguments.mesh.empty()) {
    ImportOptions options = careful_import();
    if (any_f64(*file)) options.precision = Precision::kF64;
    Result<Imported> result = import_mesh(arguments.mesh, options);
    if (!result) return fail(result.error());
    imported = std::move(*result);
    arrays = arrays_of(imported.mesh);
  }
  const Findings findings = verify_file(*file, arrays);
  report(arguments, findings,
         any_external(*file) && !arrays
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
  command.add_option("--mesh", arguments->mesh, "The source mesh of a tree cooked with --external")
      ->group(kRareOptions);
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
