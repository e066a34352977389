// SPDX-License-Identifier: MIT
// Options by which cooks are kept, found again and dealt out.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "cooker/cli/command.h"
#include "cooker/farm/shard.h"

namespace boxtree::cooker {

struct FarmArguments {
  std::filesystem::path manifest;
  std::filesystem::path journal;
  std::string cache;  // a folder or a URL
  std::string shard = "0/1";
  std::string memory;
  std::string cache_size = "10G";
  double audit = 0;
  bool keep_going = false;
  bool reread = false;
  bool fail_fast = false;

  Option* manifest_option = nullptr;
  Option* cache_option = nullptr;
  Option* cache_size_option = nullptr;
};

/// Adds --manifest.
void declare_manifest(Command& command, FarmArguments& arguments);
/// Adds --shard, of that manifest.
void declare_shard(Command& command, FarmArguments& arguments);
/// Adds the options of cooks by their keys, --shard among them.
void declare_farm_options(Command& command, FarmArguments& arguments);

/// "1/8"; nothing if the text is none.
[[nodiscard]] std::optional<Shard> shard_from(const std::string& text);

}  // namespace boxtree::cooker
