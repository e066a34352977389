// SPDX-License-Identifier: MIT
// Any text as the costs of a machine.
#include <cmath>
#include <string_view>

#include "cooker/choose/cost_file.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto parsed = cooker::parse_costs(text);
  if (!parsed && parsed.code() != Errc::kDocumentInvalid) finding("an error of another kind");
  if (parsed && parsed->costs.empty()) finding("costs of nothing");
}

}  // namespace boxtree::fuzz
