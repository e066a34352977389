// SPDX-License-Identifier: MIT
#include "cooker/farm/file_list.h"

#include <algorithm>
#include <system_error>

#include "cooker/farm/cooker_identity.h"
#include "cooker/farm/import_libraries.h"
#include "cooker/farm/json_text.h"
#include "cooker/farm/sha256.h"
#include "cooker/system/path.h"
#include "cooker/text/percent.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kSealDigits = 16;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(status_of(path, error));
}

Json names_of(const std::vector<fs::path>& paths) {
  Json names = Json::array();
  for (const fs::path& path : paths) names.push_back(percent_encoded(path.string()));
  return names;
}

std::optional<fs::path> path_in(const Json& name) {
  if (!name.is_string()) return std::nullopt;
  return named_path(percent_decoded(name.get<std::string>()));
}

std::optional<std::vector<fs::path>> paths_in(const Json& object, std::string_view key) {
  const Json* const names = object.find(key);
  if (names == nullptr || !names->is_array()) return std::nullopt;
  std::vector<fs::path> paths;
  for (const Json& name : *names) {
    std::optional<fs::path> path = path_in(name);
    if (!path) return std::nullopt;
    paths.push_back(std::move(*path));
  }
  return paths;
}

Json without_seal(const FileList& list) {
  Json opened = Json::array();
  for (const auto& [path, state] : list.opened) {
    opened.push_back({{"name", percent_encoded(path.string())}, {"state", to_json(state)}});
  }
  return {{"reads", names_of(list.files)}, {"opened", opened}, {"absent", names_of(list.absent)}};
}

std::string seal_of(const Json& list) {
  static const std::string cooker = cooker_identity() + "\n" + import_libraries() + "\n";
  return hex_of(sha256_of(cooker + list.dump())).substr(0, kSealDigits);
}

}  // namespace

bool FileList::is_current() const {
  return std::all_of(opened.begin(), opened.end(),
                     [](const auto& each) { return state_of(each.first) == each.second; }) &&
         std::none_of(absent.begin(), absent.end(), is_file);
}

std::optional<FileList> file_list(const fs::path& mesh, const SourceFileList& found,
                                  std::int64_t began_nanoseconds) {
  if (!found.is_all) return std::nullopt;
  FileList list{found.files, {}, found.absent};
  std::vector<fs::path> names = found.named;
  names.insert(names.begin(), mesh);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0 && names[i] == mesh) continue;
    const std::optional<FileState> state = state_of(names[i]);
    if (!state || !state->is_settled(began_nanoseconds)) return std::nullopt;
    list.opened.emplace_back(names[i], *state);
  }
  if (!list.is_current()) return std::nullopt;
  return list;
}

Json to_json(const FileList& list) {
  Json object = without_seal(list);
  object["seal"] = seal_of(object);
  return object;
}

std::optional<FileList> file_list_in(const Json& object) {
  std::optional<std::vector<fs::path>> files = paths_in(object, "reads");
  std::optional<std::vector<fs::path>> absent = paths_in(object, "absent");
  const Json* const opened = object.find("opened");
  if (!files || !absent || opened == nullptr) return std::nullopt;
  FileList list{std::move(*files), {}, std::move(*absent)};
  for (const Json& each : *opened) {
    const std::optional<FileState> state = state_in(each);
    const std::optional<fs::path> path =
        each.contains("name") ? path_in(each["name"]) : std::nullopt;
    if (!state || !path) return std::nullopt;
    list.opened.emplace_back(*path, *state);
  }
  if (list.opened.empty()) return std::nullopt;
  if (text_at(object, "seal") != seal_of(without_seal(list))) return std::nullopt;
  return list;
}

}  // namespace boxtree::cooker
