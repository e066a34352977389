// SPDX-License-Identifier: MIT
// Frame from the bounds of positions; boxes rounded outward.
#include "cooker/build/face_boxes.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

namespace boxtree::cooker {
namespace {

// The largest extent is in [2^14, 2^15): f16 cuts then resolve 2^-39 of it.
constexpr int kExtentExponent = 14;
// From so many extents away on, f32 positions are moved to their centre: floats of tree space, by
// which queries decide nearly everything, would lose as many binary digits as this is a power of
// two. No position is then more than twice another or the centre, so that differences are floats
// (Sterbenz). Nearer positions stay what they are.
constexpr double kFarExtents = 8;
// A single point has coordinates of 2^-300 or more in tree space, so that differences of a unit in
// their last place are above kShortestDirection (runtime/primitive/separation.h).
constexpr int kPlaceExponent = 300;

float round_down(double value) {
  const auto nearest = static_cast<float>(value);
  return double{nearest} <= value
             ? nearest
             : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

// Never -0, see Bounds.
float round_up(double value) {
  return 0 - round_down(-value);
}

// Zeros are +0 here, whatever their sign was: whether a minimum of -0 and +0 returns -0 depends on
// the machine's instruction, and the bounds go into the file.
struct Bounds {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  void include(const Eigen::Vector3d& point) {
    const Eigen::Vector3d plus_zero = point.array() + 0.0;
    low = low.cwiseMin(plus_zero);
    high = high.cwiseMax(plus_zero);
  }
};

Bounds bounds_with_plus_zeros(const Positions& positions) {
  Bounds bounds;
  for (std::size_t i = 0; i < positions.size(); ++i) bounds.include(positions[i]);
  return bounds;
}

Box<float> face_box(const MeshView& mesh, const Frame& frame, std::size_t face) {
  const Box<double> bounds = face_bounds(mesh, frame, face);
  Box<float> box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = round_down(bounds.low[k]);
    box.high[k] = round_up(bounds.high[k]);
  }
  return box;
}

}  // namespace

void choose_frame(const Positions& positions, Origin origin, BuildTree& tree) {
  if (positions.size() == 0) return;
  const Bounds in_object_space = bounds_with_plus_zeros(positions);
  Bounds bounds = in_object_space;
  const bool is_centred = positions.precision == Precision::kF64 && origin == Origin::kByPrecision;
  if (is_centred) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      tree.origin[k] = bounds.low[axis] / 2 + bounds.high[axis] / 2;
      bounds.low[axis] -= tree.origin[k];
      bounds.high[axis] -= tree.origin[k];
    }
  }
  double size = (bounds.high / 2 - bounds.low / 2).maxCoeff();  // halves, so that nothing overflows
  int halved = 1;
  if (size == 0) {  // a single point: its coordinates set the scale, wherever it was moved
    size = std::max(in_object_space.low.cwiseAbs().maxCoeff(),
                    in_object_space.high.cwiseAbs().maxCoeff());
    // Numbers around a point that was moved to zero are small, however large its coordinates were,
    // but not below a unit in their last place.
    if (is_centred) {
      size = std::min(std::ldexp(size, kPlaceExponent), 1.0) * std::ldexp(1.0, kExtentExponent);
    }
    halved = 0;
  }
  if (size == 0) return;
  if (positions.precision == Precision::kF32 && origin == Origin::kByPrecision && halved == 1) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double centre = bounds.low[axis] / 2 + bounds.high[axis] / 2;
      if (std::abs(centre) > kFarExtents * 2 * size) {
        tree.origin[k] = static_cast<double>(static_cast<float>(centre));
      }
    }
  }
  tree.scale_exponent = std::clamp(std::ilogb(size) + halved - kExtentExponent, -kMaxScaleExponent,
                                   kMaxScaleExponent);
}

Box<double> face_bounds(const MeshView& mesh, const Frame& frame, std::size_t face) {
  const Face& corners = mesh.faces[face];
  const std::size_t count = corners.is_quad() ? 4 : 3;
  Bounds bounds;
  for (std::size_t i = 0; i < count; ++i) {
    bounds.include(frame.to_tree(mesh.positions[corners.corner[i]]));
  }
  return {{bounds.low[0], bounds.low[1], bounds.low[2]},
          {bounds.high[0], bounds.high[1], bounds.high[2]}};
}

std::vector<FaceBox> face_boxes(const MeshView& mesh, const Frame& frame,
                                const Duplicates& duplicates) {
  std::vector<FaceBox> faces(mesh.faces.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        faces[i] = {face_box(mesh, frame, i), static_cast<std::uint32_t>(i)};
                      }
                    });
  if (duplicates.count > 0) {
    std::erase_if(faces, [&](const FaceBox& f) { return !duplicates.is_original(f.face); });
  }
  return faces;
}

}  // namespace boxtree::cooker
