// SPDX-License-Identifier: MIT
#include "cooker/cli/json_output.h"

#include <utility>

#include <fmt/format.h>

namespace boxtree::cooker {

Json to_json(const Eigen::Vector3d& vector) {
  return {vector[0], vector[1], vector[2]};
}

std::string document_text(const Json& document) {
  constexpr int kSchema = 1;
  Json whole = {{"schema", kSchema}};
  whole.update(document);
  return whole.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

void print(const Json& document) {
  fmt::print("{}", document_text(document));
}

void print_files(std::vector<Json> documents, bool are_several) {
  if (!are_several) return print(documents.front());
  print(Json{{"files", std::move(documents)}});
}

std::string line_of(const Json& value) {
  return value.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace boxtree::cooker
