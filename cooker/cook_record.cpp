// SPDX-License-Identifier: MIT
// Writes options and sources as JSON, in a fixed order.
#include "cooker/cook_record.h"

#include <cstdint>
#include <span>

#include <fmt/format.h>

#include "cooker/text/json.h"
#include "cooker/version.h"
#include "runtime/file/checksum.h"

namespace boxtree::cooker {
namespace {

Json grid_record(const CookOptions& options) {
  if (options.geometry != GeometryId::kGrid && !options.may_use_grid) return nullptr;
  if (options.grid.tolerance) return {{"tolerance", *options.grid.tolerance}};
  if (options.grid.step_exponent) return {{"step_exponent", *options.grid.step_exponent}};
  return {{"bits", options.grid.bits}};
}

Json budget(const std::optional<double>& limit) {
  if (!limit) return nullptr;
  return *limit;
}

std::string hash_text(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

std::uint64_t hash_of(const Profile& profile) {
  std::string text;
  for (const std::string& line : profile.lines) text += line + "\n";
  return checksum(std::as_bytes(std::span(text)));
}

}  // namespace

std::string make_cook_record(const CookOptions& options, const CookInput& input,
                             const Profile& profile) {
  Json record;
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
      {"precision", precision_name(options.import.precision)},
      {"skip_bad", options.import.skip_bad}};
  // Recorded only if not the default, so that records of other files stay the same.
  if (options.materials) record["options"]["materials"] = true;
  if (!options.import.user_data.empty()) {
    record["options"]["user_data"] = options.import.user_data;
  }
  if (!options.import.face_ids.empty()) record["options"]["ids"] = options.import.face_ids;
  if (options.active_edges) record["options"]["active_edges"] = *options.active_edges;
  if (options.number_by_tree) record["options"]["faces"] = "reordered";
  if (!options.costs.empty()) record["options"]["costs"] = "own";
  if (options.shrink_share != kShrinkShare) {
    record["options"]["shrink_share"] = options.shrink_share;
  }
  record["sources"] = Json::array();
  for (std::size_t i = 0; i < input.imports.size(); ++i) {
    record["sources"].push_back({{"name", input.import_names[i]},
                                 {"xxh3", hash_text(input.imports[i].content_hash)},
                                 {"faces", input.imports[i].source_faces}});
  }
  if (!profile.path.empty()) record["profile"] = {{"xxh3", hash_text(hash_of(profile))}};
  return record.dump(-1, true) + "\n";
}

}  // namespace boxtree::cooker
