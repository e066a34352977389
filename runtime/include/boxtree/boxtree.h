// SPDX-License-Identifier: MIT
// Everything an application needs: open a file, bind a tree or a scene, query it.
#pragma once

#include <boxtree/configuration.h>
#include <boxtree/error.h>
#include <boxtree/file.h>
#if BOXTREE_HAS_RAY_QUERIES
#include <boxtree/ray.h>
#include <boxtree/ray_batch.h>
#endif
#if BOXTREE_HAS_CAST_QUERIES
#include <boxtree/cast.h>
#endif
#if BOXTREE_HAS_COLLIDE_QUERIES
#include <boxtree/collide.h>
#endif
#if BOXTREE_HAS_BOX_QUERIES || BOXTREE_HAS_SPHERE_QUERIES || BOXTREE_HAS_FRUSTUM_QUERIES || \
    BOXTREE_HAS_WITHIN_QUERIES
#include <boxtree/overlap.h>
#include <boxtree/overlap_batch.h>
#endif
#if BOXTREE_HAS_POINT_QUERIES
#include <boxtree/closest.h>
#include <boxtree/closest_batch.h>
#endif
#if BOXTREE_HAS_PAIR_QUERIES
#include <boxtree/contact.h>
#endif
#if BOXTREE_HAS_DISTANCE_QUERIES
#include <boxtree/distance.h>
#endif
#include <boxtree/traverse.h>
#include <boxtree/tree.h>
#if BOXTREE_HAS_SCENE_QUERIES
#include <boxtree/scene.h>
#include <boxtree/scene_closest_batch.h>
#include <boxtree/scene_overlap_batch.h>
#include <boxtree/scene_ray_batch.h>
#if BOXTREE_HAS_CAST_QUERIES
#include <boxtree/scene_cast.h>
#endif
#if BOXTREE_HAS_COLLIDE_QUERIES
#include <boxtree/scene_collide.h>
#endif
#if BOXTREE_HAS_DISTANCE_QUERIES
#include <boxtree/scene_distance.h>
#endif
#if BOXTREE_HAS_FRUSTUM_QUERIES
#include <boxtree/scene_frustum.h>
#endif
#endif
