// SPDX-License-Identifier: MIT
// Which fault is active: included before every source of a mutated copy of the tree (mutate.py).
#pragma once

#include <cstdlib>

namespace boxtree_mutant {

inline const int active = [] {
  const char* const number = std::getenv("BOXTREE_MUTANT");
  return number == nullptr ? 0 : std::atoi(number);
}();

}  // namespace boxtree_mutant

#define BOXTREE_MUTANT(number, mutated, original) \
  (::boxtree_mutant::active == (number) ? (mutated) : (original))
