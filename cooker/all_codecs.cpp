// SPDX-License-Identifier: MIT
// Registers all codecs in programs that link the cooker. This object is always linked, even if
// nothing refers to it.
#include <boxtree/paper.h>

namespace {

[[maybe_unused]] const bool all_codecs_can_be_bound = [] {
  boxtree::use_paper_codecs();
  return true;
}();

}  // namespace
