// SPDX-License-Identifier: MIT
// The codecs of the paper, as a set.
#include <boxtree/paper.h>

#include "runtime/paper/paper_walks.h"

namespace boxtree {

void use_paper_codecs() noexcept {
  static constexpr const CodecFunctions* kFunctions[] = {
#if BOXTREE_HAS_PLAIN_F32
    &kPlainF32Functions,
#endif
#if BOXTREE_HAS_PLAIN_F16
    &kPlainF16Functions,
#endif
#if BOXTREE_HAS_PACKED_F32
    &kPackedF32Functions,
#endif
#if BOXTREE_HAS_PACKED_F16
    &kPackedF16Functions,
#endif
#if BOXTREE_HAS_PACKED_F64
    &kPackedF64Functions,
#endif
#if BOXTREE_HAS_DEDUP
    &kDedupFunctions,
#endif
  };
  static constexpr CodecSet kSet(kFunctions);
  add_codecs(kSet);
}

}  // namespace boxtree
