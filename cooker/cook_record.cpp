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

std::uint64_t hash_of(const Profile& profile) {
  std::string text;
  for (const std::string& line : profile.lines) text += line + "\n";
  return checksum(std::as_bytes(std::span(text)));
}

Json options_record(const CookOptions& options) {
  Json record = {
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
  if (options.materials) record["materials"] = true;
  if (!options.import.user_data.empty()) {
    record["user_data"] = options.import.user_data;
  }
  if (!options.import.face_ids.empty()) record["ids"] = options.import.face_ids;
  if (options.active_edges) record["active_edges"] = *options.active_edges;
  if (options.number_by_tree) record["faces"] = "reordered";
  if (!options.costs.empty()) record["costs"] = "own";
  if (options.shrink_share != kShrinkShare) {
    record["shrink_share"] = options.shrink_share;
  }
  return record;
}

}  // namespace

std::string recorded_hash(std::uint64_t hash) {
  return fmt::format("{:016x}", hash);
}

std::string recorded_options(const CookOptions& options) {
  // As they are once they have been written and read.
  return parse_json(options_record(options).dump(-1, true)).value.dump();
}

std::optional<RecordedCook> recorded_cook(std::string_view record) {
  const ParsedJson parsed = parse_json(record);
  const Json* const options = parsed.value.find("options");
  const Json* const sources = parsed.value.find("sources");
  if (options == nullptr || sources == nullptr || parsed.value.contains("profile")) return {};
  RecordedCook cook{options->dump(), {}};
  for (const Json& source : *sources) {
    const Json* const hash = source.find("xxh3");
    if (hash == nullptr || !hash->is_string()) return {};
    cook.sources.push_back(hash->get<std::string>());
  }
  return cook;
}

std::string make_cook_record(const CookOptions& options, const CookInput& input,
                             const Profile& profile) {
  Json record;
  record["tool"] = fmt::format("boxtree {}", kVersion);
  record["options"] = options_record(options);
  record["sources"] = Json::array();
  for (std::size_t i = 0; i < input.imports.size(); ++i) {
    record["sources"].push_back({{"name", input.import_names[i]},
                                 {"xxh3", recorded_hash(input.imports[i].content_hash)},
                                 {"faces", input.imports[i].source_faces}});
  }
  if (!profile.path.empty()) record["profile"] = {{"xxh3", recorded_hash(hash_of(profile))}};
  return record.dump(-1, true) + "\n";
}

}  // namespace boxtree::cooker
