// SPDX-License-Identifier: MIT
// Pages of a cold file as JSON, for `bench --pages` and for reports.
#pragma once

#include <nlohmann/json.hpp>

#include "cooker/report/pages.h"

namespace boxtree::cooker {

[[nodiscard]] inline nlohmann::ordered_json to_json(const PageCount& count) {
  return {{"queries", count.queries}, {"median", count.median}, {"worst", count.worst}};
}

[[nodiscard]] inline nlohmann::ordered_json to_json(const PageFigures& pages) {
  return {{"file", pages.file_pages},
          {"open", pages.open},
          {"ray", to_json(pages.ray)},
          {"box", to_json(pages.box)},
          {"point", to_json(pages.point)}};
}

}  // namespace boxtree::cooker
