// SPDX-License-Identifier: MIT
#include "runtime/scene/near_point_walk.h"

namespace boxtree {

Errc NearPointWalk::run() {
  const Errc walked = visit_nearest_instances(admission.scene, *this);
  return walked != Errc::kOk ? walked : error;
}

}  // namespace boxtree
