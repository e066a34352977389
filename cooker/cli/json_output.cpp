// SPDX-License-Identifier: MIT
#include "cooker/cli/json_output.h"

#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace boxtree::cooker {

namespace {

// -0 is 0, and reads as if it were something else.
void drop_signs_of_zero(Json& value) {
  for (Json& each : value) drop_signs_of_zero(each);
  for (auto& [key, member] : value.items()) drop_signs_of_zero(member);
  if (value.is_number_float() && value.get<double>() == 0) value = 0.0;
}

}  // namespace

Json to_json(const Eigen::Vector3d& vector) {
  return {vector[0], vector[1], vector[2]};
}

Json grid_step_json(GeometryId geometry, int step_exponent) {
  return geometry == GeometryId::kGrid ? Json(std::ldexp(1.0, step_exponent)) : Json(nullptr);
}

std::string document_text(const Json& document) {
  Json whole = {{"schema", kJsonSchema}};
  whole.update(document);
  drop_signs_of_zero(whole);
  return whole.dump(2) + "\n";
}

void print(const Json& document) {
  fmt::print("{}", document_text(document));
}

void print_files(std::vector<Json> documents, bool are_several) {
  if (!are_several) return print(documents.front());
  print(Json{{"files", Json::array_of(std::move(documents))}});
}

std::string line_of(Json value) {
  drop_signs_of_zero(value);
  return value.dump();
}

}  // namespace boxtree::cooker
