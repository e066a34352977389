// SPDX-License-Identifier: MIT
// The frame of a tree and the boxes of its faces: the first step of every build.
#pragma once

#include <vector>

#include "cooker/build/build_tree.h"

namespace boxtree::cooker {

/// Chooses the frame. With Origin::kByPrecision, the origin of f32 positions is zero, except on an
/// axis on which they are eight extents or more away; all differences from it are floats. The
/// origin of f64 positions is their centre, so that f32 boxes resolve them.
/// With Origin::kZero, the origin is zero for both precisions, because steps of a grid are counted
/// from zero.
void choose_frame(const Positions& positions, Origin origin, BuildTree& tree);

/// The boxes of all faces except duplicates, in tree space, in the order of the mesh.
[[nodiscard]] std::vector<FaceBox> face_boxes(const MeshView& mesh, const Frame& frame,
                                              const Duplicates& duplicates);

}  // namespace boxtree::cooker
