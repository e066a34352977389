// SPDX-License-Identifier: MIT
#include "cooker/farm/real_names.h"

#include <system_error>

#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

fs::path real_path(const fs::path& path) {
  std::error_code error;
  const fs::path absolute = fs::absolute(path, error);
  if (error) return path;
  fs::path real = fs::weakly_canonical(absolute, error);
  return error ? absolute.lexically_normal() : real;
}

// Not what leads elsewhere by itself.
bool is_plain(const fs::path& name) {
  return !name.empty() && name != "." && name != "..";
}

}  // namespace

std::string RealNames::of(const fs::path& file) {
  const fs::path name = file.filename();
  if (!is_plain(name)) return real_path(file).string();
  const Folder& in = folder(file.parent_path());
  if (!in.links.contains(name.string())) return (in.real / name).string();
  // As an output is written: to what a link leads to, though it may not be there yet.
  const Result<fs::path> target = follow_links(file);
  return real_path(target ? *target : file).string();
}

const RealNames::Folder& RealNames::folder(const fs::path& path) {
  const auto [place, is_new] = folders_.try_emplace(path.string());
  Folder& folder = place->second;
  if (!is_new) return folder;
  if (is_plain(path.filename())) {
    const fs::path name = path.filename();
    const Folder& in = this->folder(path.parent_path());
    folder.real = in.links.contains(name.string()) ? real_path(path) : in.real / name;
    folder.is_there = in.is_there;
  } else {
    folder.real = real_path(path.empty() ? fs::path(".") : path);
  }
  if (!folder.is_there) return folder;
  // Listing a folder tells what all of it is.
  std::error_code error;
  fs::directory_iterator each(folder.real, error), end;
  folder.is_there = !error;
  for (; !error && each != end; each.increment(error)) {
    std::error_code unknown;
    if (each->is_symlink(unknown)) folder.links.insert(each->path().filename().string());
  }
  return folder;
}

}  // namespace boxtree::cooker
