// SPDX-License-Identifier: MIT
// Many rays at a time.
#pragma once

#include <span>

#include <boxtree/ray.h>

namespace boxtree {

/// The closest hit of each of `rays`, to the bit what closest_hit() answers it: in less time, the
/// more so the nearer consecutive rays are to each other, as those of a camera are. `results` has
/// as many elements; an error of a ray is its own result. Returns kInvalidQuery if their numbers
/// differ, else kOk. Uses the calling thread alone and less than 96 KB of its stack. Never
/// allocates.
BOXTREE_API Status closest_hits(const Tree& tree, std::span<const Ray> rays,
                                std::span<RayResult> results, const QueryLimits& limits = {});

/// The same for any_hit(): in as much time as one by one, or a little less.
BOXTREE_API Status any_hits(const Tree& tree, std::span<const Ray> rays,
                            std::span<RayResult> results, const QueryLimits& limits = {});

/// The same among the faces that `options` let be hit. A filter is called in no promised order, and
/// for other candidates than single rays have.
BOXTREE_API Status closest_hits(const Tree& tree, std::span<const Ray> rays,
                                std::span<RayResult> results, const FaceOptions& options);
/// Some hit of those, or nothing, for each ray.
BOXTREE_API Status any_hits(const Tree& tree, std::span<const Ray> rays,
                            std::span<RayResult> results, const FaceOptions& options);

}  // namespace boxtree
