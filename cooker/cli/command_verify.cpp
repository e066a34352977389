// SPDX-License-Identifier: MIT
// `boxtree verify`: proves a file again, as the cooker did before it released it.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <boxtree/file.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/worker_threads.h"
#include "cooker/import/file_error.h"
#include "cooker/import/import.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/proof.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

struct VerifyArguments {
  std::vector<std::filesystem::path> files;
  std::filesystem::path mesh;
  bool quiet = false;
  int jobs = kAllThreads;
  bool json = false;
};

template <class Property>
bool any_tree(const File& file, Property property) {
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    if (property(record_of(file, i))) return true;
  }
  return false;
}
bool any_external(const File& file) {
  return any_tree(file, [](const TreeRecord& r) { return r.geometry == GeometryId::kExternal; });
}
bool any_f64(const File& file) {
  return any_tree(file, [](const TreeRecord& r) { return (r.flags & kTreePositionsF64) != 0; });
}

// What was found in one file.
struct Verification {
  int status = 0;
  bool is_reported = false;  // the only finding was printed as an error
  Findings findings;         // each begins with the file that it is of
  std::string summary;       // of a file without findings
};

// What a newer program wrote is no damage: its own status, where nothing else was found.
int status_of(const Findings& findings) {
  if (findings.empty()) return 0;
  const auto status = [](const Error& finding) { return error_info(finding.code).exit_status; };
  const bool is_damaged = std::any_of(findings.begin(), findings.end(), [&](const Error& finding) {
    return status(finding) == kExitBadInput;
  });
  return is_damaged ? kExitBadInput : status(findings.front());
}

// A file or a mesh that cannot be read at all.
Verification refusal(const Error& error) {
  return {fail(error), true, {error}, {}};
}

Verification verify_one(const std::filesystem::path& path, const std::filesystem::path& mesh) {
  const Result<OpenedFile> opened = open_file(path);
  if (!opened) return refusal(opened.error());
  const File* const file = &opened->file;
  std::optional<MeshArrays> arrays;
  Imported imported;
  if (!mesh.empty()) {
    ImportOptions options = careful_import();
    if (any_f64(*file)) options.precision = Precision::kF64;
    Result<Imported> result = import_mesh(mesh, options);
    if (!result) return refusal(result.error());
    imported = std::move(*result);
    arrays = arrays_of(imported.mesh);
  }
  Verification verification;
  for (const Error& finding : verify_file(*file, arrays)) {
    verification.findings.push_back(in_file(input_name(path), naming_mesh(mesh, finding)));
  }
  verification.status = status_of(verification.findings);
  verification.summary =
      any_external(*file) && !arrays
          ? "structure is valid; triangles are external and were not looked at"
          : fmt::format("valid: {} {}{}, every triangle inside every box above it",
                        file->tree_count(), file->tree_count() == 1 ? "tree" : "trees",
                        file->has_scene() ? " and a scene" : "");
  return verification;
}

Json verification_json(const std::filesystem::path& file, const Verification& verification) {
  Json json = {{"file", file.string()}, {"ok", verification.findings.empty()}};
  json["findings"] = Json::array();
  for (const Error& finding : verification.findings) {
    json["findings"].push_back({{"number", json["findings"].size() + 1},
                                {"code", static_cast<unsigned>(finding.code)},
                                {"name", error_info(finding.code).name},
                                {"detail", finding.detail}});
  }
  return json;
}

void print_verification(const std::filesystem::path& file, const Verification& verification,
                        bool quiet) {
  if (verification.is_reported) return;
  const std::string name = input_name(file);
  const std::size_t count = verification.findings.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string number = count == 1 ? "" : fmt::format(" (finding {} of {})", i + 1, count);
    complain(verification.findings[i].message() + number);
  }
  if (verification.findings.empty() && !quiet) {
    fmt::print("{}: {}\n", shown(name), verification.summary);
  }
}

int run(const VerifyArguments& arguments) {
  if (!arguments.mesh.empty() && arguments.files.size() > 1) {
    return usage("verify: --mesh goes with one file");
  }
  int status = 0;
  std::vector<Json> documents;
  run_on_threads(arguments.jobs, [&] {
    for (const std::filesystem::path& file : arguments.files) {
      const Verification verification = verify_one(file, arguments.mesh);
      if (arguments.json) {
        documents.push_back(verification_json(file, verification));
      } else {
        print_verification(file, verification, arguments.quiet);
      }
      if (status == 0) status = verification.status;
    }
  });
  if (arguments.json) print_files(std::move(documents), arguments.files.size() > 1);
  return status;
}

}  // namespace

void add_verify_command(Command& program, int& status) {
  const auto arguments = std::make_shared<VerifyArguments>();
  Command& command = program.add_command(
      "verify",
      "Prove that a .bxt file holds what it promises\n"
      "Decodes every node and every face, as cook does before it writes a file.");
  command
      .add_file("FILE", arguments->files, Values::kCookedFiles,
                "Files to verify; - is standard input")
      ->required();
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors only");
  command.add_option("-j,--jobs", arguments->jobs, "Threads [all]")
      ->type_name("N")
      ->between(1, 1024);
  command
      .add_file("--mesh", arguments->mesh, Values::kMeshes,
                "The source mesh of a tree cooked with --external")
      ->group(kRareOptions);
  command.example("Several files", "boxtree verify bunny.bxt level.bxt");
  command.example("By its exit status alone", "boxtree verify -q bunny.bxt && echo valid");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
