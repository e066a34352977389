// SPDX-License-Identifier: MIT
#include "cooker/import/gltf_document.h"

#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include "cooker/import/file_error.h"
#include "cooker/import/glb.h"
#include "cooker/import/gltf_nesting.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {

Result<Json> read_gltf(const SourceFile& source) {
  if (!is_gltf(source.path())) return Json();
  const Result<std::string> file = source.read();
  if (!file.ok()) return file.error();
  const bool is_binary = has_extension(source.path(), "glb");
  Result<Json> document = parse_gltf(is_binary ? glb_json(*file) : std::string_view(*file));
  if (!document.ok()) return in_file(source.title(), document.error());
  return document;
}

std::uint64_t number_at(const Json& object, const char* key, std::uint64_t otherwise) {
  const Json* const found = object.find(key);
  return found != nullptr && found->is_number_unsigned() ? found->get<std::uint64_t>() : otherwise;
}

const Json& array_at(const Json& object, const char* key) {
  static const Json kEmpty = Json::array();
  const Json* const found = object.find(key);
  return found != nullptr && found->is_array() ? *found : kEmpty;
}

const Json& element_at(const Json& list, std::uint64_t index) {
  static const Json kNone;
  return index < list.size() ? list[index] : kNone;
}

std::string gltf_fault(const SourceFile& source) {
  if (!is_gltf(source.path())) return {};
  const bool is_binary = has_extension(source.path(), "glb");
  const Result<std::string> file = source.read();
  if (!file.ok()) return {};
  if (!is_binary) {
    const std::size_t first = file->find_first_not_of(" \t\r\n\xef\xbb\xbf");
    return first < file->size() && (*file)[first] == '{' ? json_fault(*file) : std::string();
  }
  if (!file->starts_with("glTF")) return {};
  const std::optional<std::uint32_t> stated = glb_size(*file);
  if (!stated) return fmt::format("its header ends after {} bytes{}", file->size(), kAsIfCut);
  if (*stated > file->size()) {
    return fmt::format("it has {} bytes, but its header states {}{}", file->size(), *stated,
                       kAsIfCut);
  }
  return json_fault(glb_json(*file));
}

}  // namespace boxtree::cooker
