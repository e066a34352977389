// SPDX-License-Identifier: MIT
// The recursion around a split rule: frame, face boxes, preorder nodes, guards on depth.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>

#include <boxtree/cooker/build/build_tree.h>
#include <boxtree/cooker/build/splitter.h>
#include <boxtree/cooker/build/unit_sweep.h>
#include <boxtree/format/limits.h>

namespace boxtree::cooker {
namespace {

// Below this many faces a subtree is built by one thread: a task costs about a microsecond, a
// subtree of this size some hundred.
constexpr std::size_t kParallelFaces = 2048;

// The largest extent comes to lie in [2^14, 2^15): f16 cuts then reach down to 2^-39 of it.
constexpr int kExtentExponent = 14;

float round_down(double value) {
  const auto nearest = static_cast<float>(value);
  return double{nearest} <= value
             ? nearest
             : std::nextafter(nearest, -std::numeric_limits<float>::infinity());
}

float round_up(double value) {
  return -round_down(-value);
}

struct Bounds {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
};

Bounds bounds_of(const Positions& positions) {
  Bounds bounds;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const Eigen::Vector3d p = positions[i];
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  return bounds;
}

// f32 positions keep the origin at zero: they are then represented without any rounding. f64
// positions are shifted to the centre, so that f32 boxes resolve them.
void choose_frame(const Positions& positions, Origin origin, BuildTree& tree) {
  if (positions.size() == 0) return;
  Bounds bounds = bounds_of(positions);
  if (positions.precision == Precision::kF64 && origin == Origin::kByPrecision) {
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      tree.origin[k] = bounds.low[axis] / 2 + bounds.high[axis] / 2;
      bounds.low[axis] -= tree.origin[k];
      bounds.high[axis] -= tree.origin[k];
    }
  }
  double size = (bounds.high / 2 - bounds.low / 2).maxCoeff();  // halves, so that nothing overflows
  int halved = 1;
  if (size == 0) {  // a single point: its coordinates set the scale
    size = std::max(bounds.low.cwiseAbs().maxCoeff(), bounds.high.cwiseAbs().maxCoeff());
    halved = 0;
  }
  if (size == 0) return;
  tree.scale_exponent = std::clamp(std::ilogb(size) + halved - kExtentExponent, -kMaxScaleExponent,
                                   kMaxScaleExponent);
}

Box<float> face_box(const SourceMesh& mesh, const Frame& frame, std::size_t face) {
  const Box<double> bounds = face_bounds(mesh, frame, face);
  Box<float> box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = round_down(bounds.low[k]);
    box.high[k] = round_up(bounds.high[k]);
  }
  return box;
}

class Recursion {
 public:
  // Leaves hold `leaf_faces` faces, all but the last one exactly.
  Recursion(std::span<FaceBox> faces, std::span<BuildNode> nodes, SplitRule rule,
            std::size_t leaf_faces)
      : faces_(faces), nodes_(nodes), rule_(rule), leaf_faces_(leaf_faces) {}

  // Builds faces [first, last) into the nodes from `node` on: n leaves fill exactly 2n - 1 of them,
  // so that subtrees know their places in advance and threads never meet. Returns the bounds.
  Box<float> build(std::size_t first, std::size_t last, std::size_t node,
                   std::uint32_t depth_left) {
    BuildNode& here = nodes_[node];
    const std::size_t count = last - first;
    const std::span<FaceBox> faces = faces_.subspan(first, count);
    if (leaf_faces_ > 1 && count <= UnitSweep::kMaxFaces) {
      UnitSweep sweep(faces);
      return build_swept(sweep, first, {0, count}, node, depth_left);
    }
    Box<float> bounds = empty_box<float>();
    for (const FaceBox& face : faces) expand(bounds, face.box);
    if (count == 1) {
      here = {bounds, 0, faces[0].face};
      return bounds;
    }

    const Split split = choose_split(faces, bounds, depth_left);
    const std::size_t middle = first + split.left_count;
    const std::size_t left = node + 1;
    const std::size_t right = node + 2 * leaves_of(split.left_count, leaf_faces_);
    const auto build_left = [&] { build(first, middle, left, depth_left - 1); };
    const auto build_right = [&] { build(middle, last, right, depth_left - 1); };
    if (count >= kParallelFaces) {
      tbb::parallel_invoke(build_left, build_right);
    } else {
      build_left();
      build_right();
    }
    here = make_inner(bounds, left, right, split.axis);
    return bounds;
  }

 private:
  struct Part {  // of a sweep
    std::size_t first, last;
  };

  // The same for a part of a small set, whose faces stand from `base` on. Within a leaf they follow
  // their numbers.
  Box<float> build_swept(UnitSweep& sweep, std::size_t base, Part part, std::size_t node,
                         std::uint32_t depth_left) {
    BuildNode& here = nodes_[node];
    const std::size_t count = part.last - part.first;
    const Box<float> bounds = sweep.bounds(part.first, part.last);
    if (count <= leaf_faces_) {
      here = {bounds, 0, static_cast<std::uint32_t>(base + part.first)};
      sweep.copy_to(part.first, faces_.subspan(base + part.first, count));
      return bounds;
    }
    const std::size_t unit = count > kNodeFaces ? kNodeFaces : leaf_faces_;
    const Split split = halvings(count) < depth_left ? sweep.best_split(part.first, part.last, unit)
                                                     : median_of(count, bounds, leaf_faces_);
    sweep.divide(part.first, part.last, split);
    const std::size_t middle = part.first + split.left_count;
    const std::size_t left = node + 1;
    const std::size_t right = node + 2 * leaves_of(split.left_count, leaf_faces_);
    build_swept(sweep, base, {part.first, middle}, left, depth_left - 1);
    build_swept(sweep, base, {middle, part.last}, right, depth_left - 1);
    here = make_inner(bounds, left, right, split.axis);
    return bounds;
  }

  [[nodiscard]] BuildNode make_inner(const Box<float>& bounds, std::size_t left, std::size_t right,
                                     std::uint32_t axis) const {
    const std::uint32_t height = 1 + std::max(nodes_[left].height(), nodes_[right].height());
    return {bounds, static_cast<std::uint32_t>(right), axis | height << 8};
  }

  // Even halving needs ceil(log2 n) levels; once no more than that are left, nothing else fits.
  [[nodiscard]] std::uint32_t halvings(std::size_t faces) const {
    return static_cast<std::uint32_t>(std::bit_width(leaves_of(faces, leaf_faces_) - 1));
  }

  Split choose_split(std::span<FaceBox> faces, const Box<float>& bounds,
                     std::uint32_t depth_left) const {
    if (halvings(faces.size()) < depth_left) {
      if (const std::optional<Split> split = rule_(faces, bounds)) return *split;
    }
    return split_median(faces, bounds, leaf_faces_);
  }

  std::span<FaceBox> faces_;
  std::span<BuildNode> nodes_;
  SplitRule rule_;
  std::size_t leaf_faces_;
};

std::vector<FaceBox> face_boxes(const SourceMesh& mesh, const Frame& frame) {
  std::vector<FaceBox> faces(mesh.faces.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, faces.size(), 4096),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        faces[i] = {face_box(mesh, frame, i), static_cast<std::uint32_t>(i)};
                      }
                    });
  return faces;
}

}  // namespace

Box<double> face_bounds(const SourceMesh& mesh, const Frame& frame, std::size_t face) {
  const Face& corners = mesh.faces[face];
  const std::size_t count = corners.is_quad() ? 4 : 3;
  Bounds bounds;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p = frame.to_tree(mesh.positions[corners.corner[i]]);
    bounds.low = bounds.low.cwiseMin(p);
    bounds.high = bounds.high.cwiseMax(p);
  }
  return {{bounds.low[0], bounds.low[1], bounds.low[2]},
          {bounds.high[0], bounds.high[1], bounds.high[2]}};
}

BuildTree build_tree(const SourceMesh& mesh, Builder builder, Origin origin) {
  BuildTree tree;
  choose_frame(mesh.positions, origin, tree);
  if (mesh.faces.empty()) return tree;
  std::vector<FaceBox> faces = face_boxes(mesh, tree.frame());
  tree.nodes.resize(2 * faces.size() - 1);
  const SplitRule rule = builder == Builder::kSah ? split_sah : split_paper;
  Recursion(faces, tree.nodes, rule, 1).build(0, faces.size(), 0, kMaxSplitDepth);
  return tree;
}

BuildTree build_full_leaves(const SourceMesh& mesh, Origin origin) {
  BuildTree tree;
  choose_frame(mesh.positions, origin, tree);
  if (mesh.faces.empty()) return tree;
  std::vector<FaceBox> faces = face_boxes(mesh, tree.frame());
  tree.nodes.resize(2 * leaves_of(faces.size()) - 1);
  Recursion(faces, tree.nodes, split_sah_full_leaves, kLeafFaces)
      .build(0, faces.size(), 0, kMaxSplitDepth);
  tree.order.reserve(faces.size());
  for (const FaceBox& face : faces) tree.order.push_back(face.face);
  return tree;
}

}  // namespace boxtree::cooker
