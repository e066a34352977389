// SPDX-License-Identifier: MIT
// boxtree::paper, a library of its own: the codecs of the paper, plain-f32 to dedup, which the wide
// ones have overtaken in size and in time (docs/MEASUREMENTS.md).
#pragma once

#include <boxtree/configuration.h>
#include <boxtree/export.h>

static_assert(BOXTREE_HAS_PLAIN_F32 || BOXTREE_HAS_PLAIN_F16 || BOXTREE_HAS_PACKED_F32 ||
                  BOXTREE_HAS_PACKED_F16 || BOXTREE_HAS_PACKED_F64 || BOXTREE_HAS_DEDUP,
              "boxtree was built without the codecs of the paper: see BOXTREE_CODECS");

namespace boxtree {

/// From now on trees of these codecs can be bound, in all of the program. Costs nothing; once is
/// enough. Thread-safe.
BOXTREE_API void use_paper_codecs() noexcept;

}  // namespace boxtree
