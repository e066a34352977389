// SPDX-License-Identifier: MIT
#include "cooker/cli/farm_report.h"

#include <exception>
#include <new>
#include <span>
#include <utility>

#include "cooker/cli/cook_report.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/output.h"

namespace boxtree::cooker {
namespace {

Json job_json(const std::string& output, const std::optional<Digest>& key, double seconds) {
  Json json = {{"output", output}};
  json["key"] = key ? Json(hex_of(*key)) : Json(nullptr);
  json["seconds"] = seconds;
  return json;
}

}  // namespace

std::string keyed_report(const Summary& summary) {
  const std::vector<std::string> warnings = warnings_of(summary);
  return Json::array_of(std::span<const std::string>(warnings)).dump();
}

Json warnings_in(const std::string& report) {
  ParsedJson parsed = parse_json(report);
  Json warnings = Json::array();
  for (Json& warning : parsed.value) {
    if (warning.is_string()) warnings.push_back(std::move(warning));
  }
  return warnings;
}

void warn_all(const std::string& report, const std::string& place) {
  for (const Json& warning : warnings_in(report)) {
    warn((place.empty() ? place : place + ": ") + warning.get<std::string>());
  }
}

std::vector<std::string> warn_of_cache(const CookCache* cache) {
  if (cache == nullptr) return {};
  std::vector<std::string> warnings = cache->take_warnings();
  for (std::string& warning : warnings) {
    warning = "--cache: " + warning;
    warn(warning);
  }
  return warnings;
}

void add_warnings(const std::vector<std::string>& of_cache, Json& document) {
  if (of_cache.empty()) return;
  Json warnings = Json::array_of(std::span<const std::string>(of_cache));
  if (const Json* const of_cook = document.find("warnings")) {
    for (const Json& warning : *of_cook) warnings.push_back(warning);
  }
  document["warnings"] = std::move(warnings);
}

int fail_by(const Error& difference) {
  complain("difference: " + difference.detail);
  return kExitDifference;
}

Error error_of_job() {
  try {
    throw;
  } catch (const std::bad_alloc&) {
    return {Errc::kOutOfMemory, "there is too little memory"};
  } catch (const std::exception& error) {
    return {Errc::kInternal, error.what()};
  }
}

Json outcome_json(const std::string& output, const std::optional<Digest>& key,
                  const KeyedOutcome& outcome, double seconds) {
  Json json = job_json(output, key, seconds);
  json["bytes"] = outcome.bytes;
  json["cached"] = outcome.how == KeyedOutcome::How::kFromCache;
  json["there"] = outcome.how == KeyedOutcome::How::kThere;
  json["warnings"] = warnings_in(outcome.report);
  return json;
}

Json error_json(const std::string& output, const std::optional<Digest>& key, const Error& error,
                int status, double seconds) {
  const ErrcInfo& info = error_info(error.code);
  Json json = job_json(output, key, seconds);
  json["error"] = {{"code", static_cast<unsigned>(error.code)},
                   {"name", info.name},
                   {"status", status},
                   {"may_pass", may_pass(error)},
                   {"detail", error.detail}};
  return json;
}

}  // namespace boxtree::cooker
