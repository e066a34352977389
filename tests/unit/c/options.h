// SPDX-License-Identifier: MIT
// What a query may hit and cost, said to both interfaces.
#pragma once

#include <boxtree_c.h>
#include <type_traits>

#include <boxtree/boxtree.h>

namespace boxtree::test {

inline bool even_face(void* context, const bxt_face* face) {
  ++*static_cast<int*>(context);
  return face->index % 2 == 0;
}
inline bool odd_instance(void* context, std::uint32_t instance) {
  ++*static_cast<int*>(context);
  return instance % 2 == 1;
}

/// Calls `body(const bxt_face_options*, options of C++)` with each kind of options.
template <class Subject, class Body>
void for_each_face_options(const Subject&, const Body& body) {
  constexpr bool kIsTree = std::is_same_v<Subject, Tree>;
  using Options = std::conditional_t<kIsTree, FaceOptions, SceneFaceOptions>;
  body(nullptr, Options());
  bxt_face_options c = bxt_default_face_options();
  for (const BackFaces back : {BackFaces::kIgnore, BackFaces::kOnly}) {
    Options options;
    options.back_faces = back;
    c.back_faces = static_cast<std::uint32_t>(back);
    body(&c, options);
  }
  for (const std::uint64_t nodes : {std::uint64_t{0}, std::uint64_t{2}, std::uint64_t{1000}}) {
    Options options;
    options.limits.nodes = nodes;
    c = bxt_default_face_options();
    c.nodes = nodes;
    body(&c, options);
  }
  const auto even = [](const auto& face) {
    if constexpr (kIsTree) {
      return face.index % 2 == 0;
    } else {
      return face.face.index % 2 == 0;
    }
  };
  int calls = 0;
  c = bxt_default_face_options();
  c.filter = even_face;
  c.filter_context = &calls;
  Options filtered;
  filtered.filter = even;
  body(&c, filtered);
  EXPECT_GT(calls, 0);
  if constexpr (!kIsTree) {
    const auto odd = [](std::uint32_t instance) { return instance % 2 == 1; };
    calls = 0;
    c = bxt_default_face_options();
    c.instance_filter = odd_instance;
    c.instance_filter_context = &calls;
    Options of_instances;
    of_instances.instance_filter = odd;
    body(&c, of_instances);
    EXPECT_GT(calls, 0);
    c = bxt_default_face_options();
    c.layers = 1;
    Options of_layer;
    of_layer.layers = 1;
    body(&c, of_layer);
  }
}

/// Calls `body(const bxt_limits*, limits...)`: QueryLimits of a tree, LayerMask and QueryLimits of
/// a scene.
template <class Subject, class Body>
void for_each_limits(const Subject&, const Body& body) {
  const auto call = [&](const bxt_limits* c, LayerMask layers, const QueryLimits& limits) {
    if constexpr (std::is_same_v<Subject, Tree>) {
      body(c, limits);
    } else {
      body(c, layers, limits);
    }
  };
  call(nullptr, kAllLayers, {});
  bxt_limits c = bxt_default_limits();
  for (const std::uint64_t nodes : {std::uint64_t{0}, std::uint64_t{3}, std::uint64_t{1000}}) {
    c.nodes = nodes;
    call(&c, kAllLayers, {nodes});
  }
  c = bxt_default_limits();
  c.layers = 2;
  call(&c, 2, {});
}

}  // namespace boxtree::test
