// SPDX-License-Identifier: MIT
// Whoever links the cooker can bind all that it cooks: an object that is linked whether or not
// somebody needs it.
#include <boxtree/paper.h>

namespace {

[[maybe_unused]] const bool all_codecs_can_be_bound = [] {
  boxtree::use_paper_codecs();
  return true;
}();

}  // namespace
