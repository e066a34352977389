// SPDX-License-Identifier: MIT
// Any text as a line of a batch, answered by a small tree.
#include "cooker/cli/batch_line.h"

#include <string_view>

#include "tests/fuzz/target.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  static const test::CookedTree cooked = test::cook_tree(test::city(2, 1), CodecId::kWide8);
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto line = cooker::parse_request(text, {"ray", {}, {}});
  if (!line) {
    if (line.code() != Errc::kInvalidQuery) finding("an error of another kind");
    return;
  }
  cooker::TreeCache others;
  const auto answer = cooker::answer(cooked.tree, line->request, others);
  if (!answer && answer.code() == Errc::kInternal) finding("an answer is kInternal");
  if (answer && cooker::line_of(*answer).empty()) finding("an answer without words");
}

}  // namespace boxtree::fuzz
