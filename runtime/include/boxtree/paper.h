// SPDX-License-Identifier: MIT
// boxtree::paper, a library of its own: the codecs of the paper, plain-f32 to dedup, which the wide
// ones have overtaken in size and in time (docs/MEASUREMENTS.md).
#pragma once

namespace boxtree {

/// From now on trees of these codecs can be bound, in all of the program. Costs nothing; once is
/// enough. Thread-safe.
void use_paper_codecs() noexcept;

}  // namespace boxtree
