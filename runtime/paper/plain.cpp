// SPDX-License-Identifier: MIT
// The optimised BoxTree of the paper (chapter 2): plain-f32 and plain-f16.
#include "format/codec_plain.h"
#include "runtime/paper/paper_walks.h"

namespace boxtree {

#if BOXTREE_HAS_PLAIN_F32
constinit const CodecFunctions kPlainF32Functions =
    functions_of<PlainCodec<float>>(CodecId::kPlainF32, &kWalksAs<PlainCodec<float>>);
#endif
#if BOXTREE_HAS_PLAIN_F16
constinit const CodecFunctions kPlainF16Functions = functions_of<PlainCodec<std::uint16_t>>(
    CodecId::kPlainF16, &kWalksAs<PlainCodec<std::uint16_t>>);
#endif

}  // namespace boxtree
