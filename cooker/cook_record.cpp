// SPDX-License-Identifier: MIT
// Options and sources as JSON, in one order.
#include "cooker/cook_record.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cooker/version.h"

namespace boxtree::cooker {
namespace {

nlohmann::ordered_json grid_record(const CookOptions& options) {
  if (options.geometry != GeometryId::kGrid && !options.may_use_grid) return nullptr;
  if (options.grid.tolerance) return {{"tolerance", *options.grid.tolerance}};
  return {{"bits", options.grid.bits}};
}

nlohmann::ordered_json budget(const std::optional<double>& limit) {
  if (!limit) return nullptr;
  return *limit;
}

}  // namespace

std::string make_cook_record(const CookOptions& options, std::span<const RecordedSource> sources,
                             std::uint64_t profile) {
  nlohmann::ordered_json record;
  record["tool"] = fmt::format("boxtree {}", kVersion);
  record["options"] = {
      {"codec", options.codec ? std::string(codec_name(*options.codec)) : "auto"},
      {"for", goal_name(options.wishes.goal)},
      {"max_bytes_per_triangle", budget(options.wishes.max_bytes_per_triangle)},
      {"max_slowdown", budget(options.wishes.max_slowdown)},
      {"builder", options.builder == Builder::kPaper ? "paper" : "sah"},
      {"widths", options.widths == FieldWidths::kExact ? "exact" : "estimated"},
      {"geometry", options.may_use_grid ? "auto" : std::string(geometry_name(options.geometry))},
      {"grid", grid_record(options)},
      {"face_ids", options.face_ids},
      {"precision", options.import.precision == Precision::kF64 ? "f64" : "f32"},
      {"skip_bad", options.import.skip_bad}};
  // Named where they are not the usual ones: records of other files stay as they were.
  if (!options.costs.empty()) record["options"]["costs"] = "own";
  if (options.shrink_share != kShrinkShare) {
    record["options"]["shrink_share"] = options.shrink_share;
  }
  record["sources"] = nlohmann::ordered_json::array();
  for (const RecordedSource& source : sources) {
    record["sources"].push_back({{"name", source.name},
                                 {"xxh3", fmt::format("{:016x}", source.content_hash)},
                                 {"faces", source.faces}});
  }
  if (profile != 0) record["profile"] = {{"xxh3", fmt::format("{:016x}", profile)}};
  return record.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace boxtree::cooker
