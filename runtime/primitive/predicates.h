// SPDX-License-Identifier: MIT
// The leaf predicates: what a query needs of one triangle. All sets are closed (touching counts),
// all functions are pure, never allocate, and accept degenerate triangles. Coordinates must be
// finite and of magnitude at most 2^200, so that no product overflows.
#pragma once

#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/orientation.h"
#include "runtime/primitive/triangle.h"
#include "runtime/primitive/triangle_box.h"
#include "runtime/primitive/triangle_distance.h"
#include "runtime/primitive/triangle_ray.h"
#include "runtime/primitive/triangle_triangle.h"
