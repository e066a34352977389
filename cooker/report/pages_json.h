// SPDX-License-Identifier: MIT
// Pages of a cold file as JSON, for `bench --pages` and for reports.
#pragma once

#include "cooker/report/pages.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {

[[nodiscard]] inline Json to_json(const PageCount& count) {
  return {{"queries", count.queries}, {"median", count.median}, {"worst", count.worst}};
}

[[nodiscard]] inline Json to_json(const PageFigures& pages) {
  return {{"file", pages.file_pages},
          {"open", pages.open},
          {"ray", to_json(pages.ray)},
          {"box", to_json(pages.box)},
          {"point", to_json(pages.point)}};
}

[[nodiscard]] inline Json to_json(const FirstRays& first) {
  return {{"levels", first.levels},
          {"nodes", first.nodes},
          {"pages_before", first.pages_before},
          {"pages_more", first.pages_more}};
}

}  // namespace boxtree::cooker
