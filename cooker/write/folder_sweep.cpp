// SPDX-License-Identifier: MIT
#include "cooker/write/folder_sweep.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "cooker/write/temporary_name.h"

namespace boxtree::cooker {
namespace {

// Takes out those that belong to the target.
std::vector<FileName> taken(std::vector<FileName>& names, const FolderSweep::Belongs& belongs) {
  const auto first = std::stable_partition(names.begin(), names.end(), std::not_fn(belongs));
  std::vector<FileName> out(std::make_move_iterator(first), std::make_move_iterator(names.end()));
  names.erase(first, names.end());
  return out;
}

}  // namespace

void FolderNames::add(FileNameView name) {
  static const FileName kEnding = std::filesystem::path(kTemporaryEnding).native();
  ++count;
  if (name.starts_with(FileName::value_type{'.'}) && name.ends_with(kEnding)) {
    unfinished.emplace_back(name);
  }
}

std::vector<FileName> FolderSweep::take(const std::filesystem::path& folder, const Belongs& belongs,
                                        const Read& read) {
  const std::lock_guard lock(mutex_);
  const auto known = folders_.find(folder.native());
  if (known != folders_.end() && known->second.files * kNamesPerFile < known->second.names.count) {
    ++known->second.files;
    return taken(known->second.names.unfinished, belongs);
  }
  FolderNames names = read();
  std::vector<FileName> out = taken(names.unfinished, belongs);
  if (names.count > kNamesPerFile) {
    folders_[folder.native()] = {std::move(names), 1};
  } else if (known != folders_.end()) {
    folders_.erase(known);
  }
  return out;
}

FolderSweep& folder_sweep() {
  static FolderSweep sweep;
  return sweep;
}

}  // namespace boxtree::cooker
