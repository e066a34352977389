// SPDX-License-Identifier: MIT
#include "cooker/cli/farm_arguments.h"

#include <string_view>

#include <fmt/format.h>

#include "cooker/cli/byte_size.h"
#include "cooker/text/number_of.h"

namespace boxtree::cooker {
namespace {

std::string shard_fault(const std::string& text) {
  if (shard_from(text)) return {};
  return fmt::format("expected I/N with I from 0 to N - 1, as 0/8, found \"{}\"", text);
}

}  // namespace

std::optional<Shard> shard_from(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return std::nullopt;
  const auto number = number_of<std::uint32_t>(std::string_view(text).substr(0, slash));
  const auto count = number_of<std::uint32_t>(std::string_view(text).substr(slash + 1));
  if (!number || !count || *number >= *count) return std::nullopt;
  return Shard{*number, *count};
}

void declare_manifest(Command& command, FarmArguments& arguments) {
  arguments.manifest_option = command.add_file(
      "--manifest", arguments.manifest, Values::kFiles,
      "Many jobs, one JSON object a line: {\"inputs\": [\"a.obj\"], \"output\": \"a.bxt\", "
      "\"options\": [\"--exact\"]}, or \"profile\" in place of inputs");
}

void declare_shard(Command& command, FarmArguments& arguments) {
  command
      .add_option(
          "--shard", arguments.shard,
          "Only the jobs of a manifest whose outputs fall to shard I of N, from 0: N such runs "
          "take each job once")
      ->type_name("I/N")
      ->check(shard_fault)
      ->needs(arguments.manifest_option);
}

void declare_farm_options(Command& command, FarmArguments& arguments) {
  Option* const manifest = arguments.manifest_option;
  declare_shard(command, arguments);
  command
      .add_option(
          "--memory", arguments.memory,
          "Start a job of a manifest only when it is expected to fit, as in 8G [half of the "
          "machine's]")
      ->type_name("BYTES")
      ->check(byte_size_fault)
      ->needs(manifest);
  Option* const fail_fast = command.add_flag(
      "--fail-fast", arguments.fail_fast, "Start no more jobs of a manifest once one has failed");
  fail_fast->needs(manifest);
  command
      .add_flag("--keep-going", arguments.keep_going,
                "Cook all other jobs of a manifest when one fails [default]")
      ->group(kRareOptions)
      ->needs(manifest)
      ->excludes(fail_fast);
  command
      .add_file("--journal", arguments.journal, Values::kFiles,
                "Where it is written down which jobs of a manifest are finished, so that the same "
                "command goes on after it was killed [beside the manifest, in .done]")
      ->group(kRareOptions)
      ->needs(manifest);
  command
      .add_flag("--reread", arguments.reread,
                "Read all inputs and outputs of a manifest, also those whose size, times and inode "
                "are those that the journal has")
      ->group(kRareOptions)
      ->needs(manifest);
  Option* const cache = arguments.cache_option = command.add_file(
      "--cache", arguments.cache, Values::kFolders,
      "Outputs by their keys, for any number of processes: what is there is not cooked again. A "
      "folder, or a server that speaks the HTTP protocol of Bazel's remote caches, http://HOST");
  cache->type_name("FOLDER|URL");
  Option* const cache_size = arguments.cache_size_option =
      command.add_option("--cache-size", arguments.cache_size,
                         "What was used longest ago is removed beyond this from the folder");
  cache_size->group(kRareOptions)
      ->type_name("BYTES")
      ->check(byte_size_fault)
      ->shows_default()
      ->needs(cache);
  command
      .add_option("--audit", arguments.audit,
                  "Cook this share of what the cache has again, by chance, and compare")
      ->group(kRareOptions)
      ->type_name("SHARE")
      ->number(
          "a share from 0 to 1", [](double share) { return share >= 0 && share <= 1; }, "0 to 1")
      ->needs(cache);
}

}  // namespace boxtree::cooker
