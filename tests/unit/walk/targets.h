// SPDX-License-Identifier: MIT
// Runs a test once for each instruction set.
#pragma once

#include <cstdint>
#include <string>

#ifdef BOXTREE_TEST_TARGETS
#include <boxtree/configuration.h>

#include "runtime/walk/targets.h"
// Its macros follow those of targets.h.
#include <hwy/targets.h>
#endif

namespace boxtree {

/// Calls body(name) once for each instruction set that the walks were compiled for and the machine
/// has, and once for walks by AVX2 whose leaves are decoded by AVX-512; the scalar build has one.
template <class Body>
void for_each_target(Body body) {
#ifdef BOXTREE_TEST_TARGETS
  const std::int64_t supported = hwy::SupportedTargets();
  const auto test = [&](std::int64_t targets, const std::string& name) {
    hwy::SetSupportedTargetsForTest(targets);
    body(name.c_str());
  };
  for (std::int64_t left = supported & HWY_TARGETS; left != 0; left &= left - 1) {
    const std::int64_t target = left & -left;
    test(target, hwy::TargetName(target));
    if (target == HWY_AVX2 && (supported & HWY_AVX3_DL) != 0) {
      test(HWY_AVX2 | HWY_AVX3_DL, "AVX2 with leaves by AVX3_DL");
    }
  }
  hwy::SetSupportedTargetsForTest(0);
#else
  body("scalar");
#endif
}

}  // namespace boxtree
