// SPDX-License-Identifier: MIT
// The compressed BoxTree of the paper (chapter 3): packed-f32, packed-f16, packed-f64 and dedup.
#include "format/codec_packed.h"
#include "runtime/paper/paper_walks.h"

namespace boxtree {

#if BOXTREE_HAS_PACKED_F32
constinit const CodecFunctions kPackedF32Functions = functions_of<PackedCodec<PackedCut::kF32>>(
    CodecId::kPackedF32, &kWalksAs<PackedCodec<PackedCut::kF32>>);
#endif
#if BOXTREE_HAS_PACKED_F16
constinit const CodecFunctions kPackedF16Functions = functions_of<PackedCodec<PackedCut::kF16>>(
    CodecId::kPackedF16, &kWalksAs<PackedCodec<PackedCut::kF16>>);
#endif
#if BOXTREE_HAS_PACKED_F64
constinit const CodecFunctions kPackedF64Functions = functions_of<PackedCodec<PackedCut::kF64>>(
    CodecId::kPackedF64, &kWalksAs<PackedCodec<PackedCut::kF64>>);
#endif
#if BOXTREE_HAS_DEDUP
constinit const CodecFunctions kDedupFunctions = functions_of<PackedCodec<PackedCut::kTable>>(
    CodecId::kDedup, &kWalksAs<PackedCodec<PackedCut::kTable>>);
#endif

}  // namespace boxtree
