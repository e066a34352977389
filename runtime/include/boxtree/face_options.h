// SPDX-License-Identifier: MIT
// Which faces a ray or a cast may hit.
#pragma once

#include <cstdint>
#include <optional>

#include <boxtree/query.h>

namespace boxtree {

/// What becomes of faces that are met from behind: from where their corners are seen clockwise.
enum class BackFaces : std::uint8_t {
  kHit,     ///< They are hit like others.
  kIgnore,  ///< They are passed through.
  kOnly,    ///< They alone are hit.
};

/// Whether a face may be hit; called with each candidate, named as in answers. It must answer alike
/// whenever it is called. Borrowed, like all callables: a lambda that is stored
/// in FaceOptions needs a name of its own, and one without does not compile.
using FaceFilter = NamedFunctionRef<bool(const FaceRef&)>;

/// Which faces a ray or a cast may hit, and what it may cost.
struct FaceOptions {
  BackFaces back_faces = BackFaces::kHit;  ///< [kHit]
  std::optional<FaceFilter> filter = {};   ///< [every face]
  QueryLimits limits = {};                 ///< [none]
};

}  // namespace boxtree
