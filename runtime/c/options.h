// SPDX-License-Identifier: MIT
// What C callers say of a query besides its shape: limits, layers, sides, filters, errors allowed.
// Each function reads a struct, calls `query` with what it means, and refuses what means nothing.
#pragma once

#include <cstdint>
#include <type_traits>

#include "runtime/c/call.h"
#include "runtime/c/convert.h"
#include "runtime/c/handle.h"

namespace boxtree::c {

/// Calls `query(limits)` for a tree, `query(layers, limits)` for a scene.
template <class Handle, class Query>
bxt_status with_limits(const bxt_limits* given, bxt_error* error, Query query) {
  bxt_limits limits = bxt_default_limits();
  if (!read_struct(given, limits)) return refuse(error, "limits: struct_size");
  if constexpr (std::is_same_v<Handle, bxt_tree>) {
    return query(QueryLimits{limits.nodes});
#if BOXTREE_HAS_SCENE_QUERIES
  } else {
    return query(LayerMask{limits.layers}, QueryLimits{limits.nodes});
#endif
  }
}

/// Calls `query(limits)` for queries of a scene that are about all layers.
template <class Query>
bxt_status with_nodes(const bxt_limits* given, bxt_error* error, Query query) {
  bxt_limits limits = bxt_default_limits();
  if (!read_struct(given, limits)) return refuse(error, "limits: struct_size");
  if (limits.layers != BXT_ALL_LAYERS) {
    return refuse(error, "limits: layers, of which this query takes all");
  }
  return query(QueryLimits{limits.nodes});
}

/// Calls `query(options)` with the options of what is queried: FaceOptions, or SceneFaceOptions.
template <class Handle, class Query>
bxt_status with_face_options(const bxt_face_options* given, bxt_error* error, Query query) {
  bxt_face_options read = bxt_default_face_options();
  if (!read_struct(given, read)) return refuse(error, "options: struct_size");
  if (read.back_faces > BXT_BACK_FACES_ONLY) return refuse(error, "options: back_faces");
  if (read.reserved != 0) return refuse(error, "options: reserved");
  const auto back_faces = static_cast<BackFaces>(read.back_faces);
  const auto filter = [&read](const auto& face) {
    const bxt_face shown = to_c(face);
    return read.filter(read.filter_context, &shown);
  };
  if constexpr (std::is_same_v<Handle, bxt_tree>) {
    if (read.instance_filter != nullptr) {
      return refuse(error, "options: instance_filter, and a tree has no instances");
    }
    FaceOptions options{.back_faces = back_faces, .limits = {read.nodes}};
    if (read.filter != nullptr) options.filter = filter;
    return query(options);
#if BOXTREE_HAS_SCENE_QUERIES
  } else {
    const auto instance_filter = [&read](std::uint32_t instance) {
      return read.instance_filter(read.instance_filter_context, instance);
    };
    SceneFaceOptions options{
        .back_faces = back_faces, .layers = read.layers, .limits = {read.nodes}};
    if (read.filter != nullptr) options.filter = filter;
    if (read.instance_filter != nullptr) options.instance_filter = instance_filter;
    return query(options);
#endif
  }
}

/// Calls `query(approximation)`.
template <class Query>
bxt_status with_approximation(const bxt_approximation* given, bxt_error* error, Query query) {
  bxt_approximation read = bxt_default_approximation();
  if (!read_struct(given, read)) return refuse(error, "options: struct_size");
  if (read.reserved != 0) return refuse(error, "options: reserved");
  return query(
      Approximation{read.relative_error, read.absolute_error, read.max_distance, read.node_budget});
}

}  // namespace boxtree::c
