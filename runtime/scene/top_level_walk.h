// SPDX-License-Identifier: MIT
// Which static instances of a scene may matter: walks of its top level, by vectors where there are
// any.
#pragma once

#include <cstdint>

#include <boxtree/format/error.h>
#include <boxtree/runtime/query/ray_slab.h>
#include <boxtree/runtime/query/types.h>
#include <boxtree/runtime/scene/top_level.h>

namespace boxtree {

/// Called with the number of an instance: whether to go on.
using InstanceVisitor = FunctionRef<bool(std::uint32_t)>;

/// A ray in the scene's frame, origin + s * direction; the largest component of the direction is in
/// [1/2, 1).
struct TopLevelRay {
  Eigen::Vector3d origin;
  Eigen::Vector3d direction;
  double reach;  // on every axis, that `slab` was made with
  RaySlab slab;
  double s_min;
};

/// Each visits all instances whose boxes meet what is asked for, and maybe some that only nearly
/// do. From near to far for points and rays: `bound`, a squared distance or a parameter, is read
/// again after each visit, which may lower it; instances beyond it are left out, those at it are
/// not. Boxes, points and rays are of the scene's frame.
/// Errors: kNodeCorrupt, kDepthExceeded for corrupt nodes.
Errc walk_top_level(const TopLevel& top, const Box<double>& box, InstanceVisitor visit);
Errc walk_top_level(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                    InstanceVisitor visit);
Errc walk_top_level(const TopLevel& top, const TopLevelRay& ray, const double& bound,
                    InstanceVisitor visit);

/// The same without vectors.
Errc walk_top_level_plainly(const TopLevel& top, const Box<double>& box, InstanceVisitor visit);
Errc walk_top_level_plainly(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
                            InstanceVisitor visit);
Errc walk_top_level_plainly(const TopLevel& top, const TopLevelRay& ray, const double& bound,
                            InstanceVisitor visit);

/// The same by vectors, where that is possible.
Errc walk_wide(const TopLevel& top, const Box<double>& box, InstanceVisitor visit);
Errc walk_wide(const TopLevel& top, const Eigen::Vector3d& point, const double& bound,
               InstanceVisitor visit);
Errc walk_wide(const TopLevel& top, const TopLevelRay& ray, const double& bound,
               InstanceVisitor visit);

}  // namespace boxtree
