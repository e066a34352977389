// SPDX-License-Identifier: MIT
// Where every build starts: the frame of a tree and the boxes of its faces.
#pragma once

#include <vector>

#include "cooker/build/build_tree.h"

namespace boxtree::cooker {

/// Sets the frame. By precision, f32 positions keep the origin at zero, or are shifted along an
/// axis on which all of them are the same: they are then represented without any rounding; f64
/// positions are shifted to the centre, so that f32 boxes resolve them. With Origin::kZero f64 ones
/// are not shifted either: steps of a grid are counted from zero.
void choose_frame(const Positions& positions, Origin origin, BuildTree& tree);

/// The boxes of all faces but duplicates in tree space, in the order of the mesh.
[[nodiscard]] std::vector<FaceBox> face_boxes(const SourceMesh& mesh, const Frame& frame,
                                              const Duplicates& duplicates);

}  // namespace boxtree::cooker
