// SPDX-License-Identifier: MIT
// The instruction sets that the walks of the wide codecs are compiled for, one of which is chosen
// when the program runs. Included before any header of Highway, in each file with such a walk.
//
// On x86-64: SSE4 and AVX2, unless the CMake option BOXTREE_INSTRUCTION_SETS is set, which may add
// AVX-512, too. Eight children are two SSE or one AVX register wide; AVX-512 gives masks and 32
// registers. Instruction sets between these gain nothing. A machine that has none of them uses the
// generic walks. Scalable vectors (SVE, RVV) have no fixed size: arm64 uses NEON.
#pragma once

#include <boxtree/configuration.h>

#define BOXTREE_NO_WALK_TARGETS \
  (HWY_SSSE3 | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | BOXTREE_LEFT_OUT_TARGETS)
#define HWY_DISABLED_TARGETS (HWY_AVX3_DL | BOXTREE_NO_WALK_TARGETS)
/// Those of walk/cluster_avx512.cpp, which walks by AVX2 or AVX-512 call.
#define BOXTREE_LEAF_DISABLED_TARGETS (HWY_SSE4 | HWY_AVX2 | HWY_AVX3 | BOXTREE_NO_WALK_TARGETS)

/// Whether walks in which few programs spend their time are compiled for this instruction set, too.
/// SSE4 takes the generic ones where a build has AVX2: few machines walk by it then.
#define BOXTREE_HAS_SPECIAL_WALKS \
  (HWY_TARGET != HWY_SCALAR &&    \
   (HWY_TARGET != HWY_SSE4 || (HWY_TARGETS & (HWY_AVX2 | HWY_AVX3)) == 0))
