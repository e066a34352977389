// SPDX-License-Identifier: MIT
// Everything an application needs: open a file, bind a tree, ask.
#pragma once

#include <boxtree/runtime/file/file.h>
#include <boxtree/runtime/query/box.h>
#include <boxtree/runtime/query/distance.h>
#include <boxtree/runtime/query/overlap_within.h>
#include <boxtree/runtime/query/pair.h>
#include <boxtree/runtime/query/point.h>
#include <boxtree/runtime/query/ray.h>
#include <boxtree/runtime/query/sphere.h>
#include <boxtree/runtime/tree/tree.h>
