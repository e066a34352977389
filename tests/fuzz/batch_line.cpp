// SPDX-License-Identifier: MIT
// Any text as a line of a batch, answered by a small tree and by a small scene.
#include "cooker/cli/batch_line.h"

#include <string_view>

#include "cooker/cli/scene_query.h"
#include "tests/fuzz/target.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace boxtree::fuzz {
namespace {

void check(const Result<cooker::Json>& answer) {
  if (!answer && answer.code() == Errc::kInternal) finding("an answer is kInternal");
  if (answer && cooker::line_of(*answer).empty()) finding("an answer without words");
}

const test::CookedTree& small_tree() {
  static const test::CookedTree cooked = [] {
    cooker::CookOptions options;
    options.active_edges = 1;
    return test::cook_tree(test::city(2, 1), CodecId::kWide8, options);
  }();
  return cooked;
}

const test::CookedScene& small_scene() {
  static const test::CookedScene cooked =
      test::cook_scene({test::city(1, 1), test::soup(9, 1)}, test::random_parts(5, 2, 2, 2, 1));
  return cooked;
}

}  // namespace

void run(Bytes input) {
  const std::string_view text(reinterpret_cast<const char*>(input.data()), input.size());
  const auto line = cooker::parse_request(text, {"ray", {}, {}});
  if (!line) {
    if (line.code() != Errc::kInvalidQuery) finding("an error of another kind");
    return;
  }
  cooker::TreeCache others;
  check(cooker::answer(small_tree().tree, line->request, others));
  const File& file = small_scene().file;
  const Result<Scene> scene = cooker::move_scene(file, line->moves);
  if (scene) check(cooker::answer(file, *scene, kAllLayers, line->request, others));
}

}  // namespace boxtree::fuzz
