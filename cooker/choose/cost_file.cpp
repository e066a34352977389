// SPDX-License-Identifier: MIT
// Reads and writes constants as JSON; every number that is read is checked.
#include "cooker/choose/cost_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include "cooker/import/whole_file.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {
namespace {

constexpr std::array kStores = {GeometryId::kArrays, GeometryId::kExact, GeometryId::kGrid};
constexpr std::array kSteps = {"query_ns", "node_ns", "leaf_ns"};
constexpr std::array kPrecisions = {Precision::kF32, Precision::kF64};

Error fault(std::string what) {
  return {Errc::kDocumentInvalid, "costs: " + std::move(what)};
}

std::string text_member(const Json& row, const char* key) {
  const Json* const found = row.find(key);
  return found != nullptr && found->is_string() ? found->get<std::string>() : std::string();
}

Result<StepCost> parse_steps(const Json& row, const std::string& place, const char* kind) {
  const Json* const found = row.find(kind);
  if (found == nullptr || !found->is_object()) {
    return fault(fmt::format("{}: expected an object \"{}\"", place, kind));
  }
  std::array<double, kSteps.size()> steps{};
  for (std::size_t i = 0; i < kSteps.size(); ++i) {
    const Json* const step = found->find(kSteps[i]);
    const bool is_number = step != nullptr && step->is_number();
    steps[i] = is_number ? step->get<double>() : -1;
    if (!(steps[i] >= 0) || !std::isfinite(steps[i])) {
      return fault(fmt::format("{}, {}: expected \"{}\", nanoseconds, 0 or more, found {}", place,
                               kind, kSteps[i], step == nullptr ? "nothing" : step->dump()));
    }
  }
  if (std::all_of(steps.begin(), steps.end(), [](double step) { return step == 0; })) {
    return fault(fmt::format("{}, {}: all steps are 0, but no query is free", place, kind));
  }
  return StepCost{steps[0], steps[1], steps[2]};
}

// A number of at least `least`, 1 if there is none.
Result<double> parse_measure(const Json& document, const char* key, double least) {
  const Json* const found = document.find(key);
  if (found == nullptr) return 1.0;
  const double value = found->is_number() ? found->get<double>() : -1;
  if (value >= least && std::isfinite(value)) return value;
  return fault(fmt::format("expected \"{}\", {} or more, found {}", key, least, found->dump()));
}

Result<CodecCost> parse_row(const Json& row, std::size_t number) {
  if (!row.is_object()) return fault(fmt::format("row {}: expected an object", number));
  const std::string codec = text_member(row, "codec");
  const std::string geometry = text_member(row, "geometry");
  const std::optional<CodecId> id = find_codec(codec);
  if (!id) return fault(fmt::format("row {}: unknown codec \"{}\"", number, codec));
  const auto store = std::find_if(kStores.begin(), kStores.end(),
                                  [&](GeometryId s) { return geometry_name(s) == geometry; });
  if (store == kStores.end()) {
    return fault(
        fmt::format("row {}: geometry \"{}\": expected arrays, exact or grid", number, geometry));
  }
  const std::string positions = text_member(row, "positions");
  const auto precision = std::find_if(kPrecisions.begin(), kPrecisions.end(),
                                      [&](Precision p) { return precision_name(p) == positions; });
  if (precision == kPrecisions.end()) {
    return fault(fmt::format("row {}: positions \"{}\": expected f32 or f64", number, positions));
  }
  CodecCost cost{*id, *store, {}, *precision};
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    const Result<StepCost> steps =
        parse_steps(row, fmt::format("{}, {}", codec, geometry), kQueryNames[kind]);
    if (!steps) return steps.error();
    cost.of_kind[kind] = *steps;
  }
  return cost;
}

}  // namespace

std::string costs_to_json(const Calibration& calibration) {
  Json costs = Json::array();
  for (const CodecCost& cost : calibration.costs) {
    Json row = {{"codec", codec_name(cost.codec)},
                {"geometry", geometry_name(cost.geometry)},
                {"positions", precision_name(cost.precision)}};
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      const StepCost& step = cost.of_kind[kind];
      row[kQueryNames[kind]] = {
          {kSteps[0], step.query}, {kSteps[1], step.node}, {kSteps[2], step.leaf}};
    }
    costs.push_back(std::move(row));
  }
  return Json{{"worst_ratio", calibration.worst_ratio},
              {"processor_share", calibration.timed_work.processor_share()},
              {"speed_ratio", calibration.timed_work.speed_ratio()},
              {"costs", costs}}
      .dump(2);
}

std::string disturbed_constants(const Calibration& calibration) {
  return calibration.timed_work.warning("constants may be wrong, and what is chosen by them");
}

Result<Calibration> parse_costs(std::string_view text) {
  const ParsedJson parsed = parse_json(text);
  if (parsed.fault != ParsedJson::Fault::kNone)
    return fault("expected JSON, as `bench --calibrate --json` prints it");
  const Json* const schema = parsed.value.find("schema");
  if (schema != nullptr && (!schema->is_number() || schema->get<double>() != kJsonSchema)) {
    return fault(fmt::format("expected \"schema\": {}, found {}: as another version prints it",
                             kJsonSchema, schema->dump()));
  }
  const Json* const rows = parsed.value.find("costs");
  if (rows == nullptr || !rows->is_array()) {
    return fault(
        "expected an object with an array \"costs\", as `bench --calibrate --json` prints it");
  }
  Calibration calibration;
  const Result<double> worst_ratio = parse_measure(parsed.value, "worst_ratio", 1);
  if (!worst_ratio) return worst_ratio.error();
  calibration.worst_ratio = *worst_ratio;
  const Result<double> processor_share = parse_measure(parsed.value, "processor_share", 0);
  if (!processor_share) return processor_share.error();
  const Result<double> speed_ratio = parse_measure(parsed.value, "speed_ratio", 1);
  if (!speed_ratio) return speed_ratio.error();
  calibration.timed_work = TimedWork(*processor_share, 1, *speed_ratio);
  std::vector<CodecCost>& costs = calibration.costs;
  for (std::size_t i = 0; i < rows->size(); ++i) {
    const Result<CodecCost> cost = parse_row((*rows)[i], i);
    if (!cost) return cost.error();
    costs.push_back(*cost);
  }
  for (const CodecInfo& codec : kCodecs) {
    for (const GeometryId store : kStores) {
      for (const Precision precision : kPrecisions) {
        if (!has_cost(codec.id, store, precision)) continue;
        const auto count = std::count_if(costs.begin(), costs.end(), [&](const CodecCost& cost) {
          return cost.codec == codec.id && cost.geometry == store && cost.precision == precision;
        });
        if (count == 1) continue;
        return fault(fmt::format("{}, {}, {}: expected one row, found {}", codec.name,
                                 geometry_name(store), precision_name(precision), count));
      }
    }
  }
  return calibration;
}

Result<Calibration> read_costs(const std::filesystem::path& path) {
  const Result<std::string> text = read_whole_file(path, kMaxCostsBytes);
  if (!text) return text.error();
  Result<Calibration> calibration = parse_costs(*text);
  if (!calibration)
    return Error{calibration.code(), path.string() + ": " + calibration.error().detail};
  return calibration;
}

}  // namespace boxtree::cooker
