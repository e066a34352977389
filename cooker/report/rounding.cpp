// SPDX-License-Identifier: MIT
// Aligned contact on trees that differ only in the rounding of their cuts.
#include "cooker/report/rounding.h"

#include <array>
#include <bit>
#include <cstring>
#include <utility>

#include <boxtree/boxtree.h>

#include "cooker/build/build_tree.h"
#include "cooker/choose/measure.h"
#include "cooker/cook.h"
#include "cooker/import/mesh_arrays.h"
#include "format/codec_plain.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

// IEEE round to nearest, ties to even, of the two neighbours. Precondition: as half_toward_zero.
std::uint16_t half_to_nearest(float value) {
  const std::uint16_t below = half_toward_zero(value);
  const auto above = static_cast<std::uint16_t>(below + 1);
  const double down = double{value} - double{half_to_float(below)};
  const double up = double{half_to_float(above)} - double{value};
  return down < up || (down == up && below % 2 == 0) ? below : above;
}

EncodedTree with_nearest_cuts(const EncodedTree& f32) {
  EncodedTree tree = f32;
  tree.nodes.codec = CodecId::kPlainF16;
  tree.nodes.bytes.resize(f32.nodes.node_count * sizeof(PlainNodeF16));
  for (std::size_t i = 0; i < f32.nodes.node_count; ++i) {
    const auto from = load<PlainNodeF32>(f32.nodes.bytes.data(), i);
    PlainNodeF16 to{};
    to.cutplane = from.cutplane;
    for (std::size_t side = 0; side < 2; ++side) {
      to.child[side] = from.child[side];
      to.cut[side] = half_to_nearest(from.cut[side]);
    }
    std::memcpy(tree.nodes.bytes.data() + i * sizeof(to), &to, sizeof(to));
  }
  return tree;
}

// All rotations that map axes to axes: signed permutations with determinant 1.
std::vector<Eigen::Matrix3d> axis_rotations() {
  std::vector<Eigen::Matrix3d> rotations;
  constexpr std::array<std::array<Eigen::Index, 3>, 6> kOrders = {
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  for (const auto& order : kOrders) {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d rotation = Eigen::Matrix3d::Zero();
      for (Eigen::Index i = 0; i < 3; ++i) {
        rotation(i, order[static_cast<std::size_t>(i)]) = ((signs >> i) & 1u) != 0 ? -1 : 1;
      }
      if (rotation.determinant() > 0) rotations.push_back(rotation);
    }
  }
  return rotations;
}

// Poses in which a face of the copy's bounds is centred on a face of the mesh's, `depth` deep.
std::vector<Pose> aligned_poses(const Eigen::AlignedBox3d& bounds) {
  std::vector<Pose> poses;
  constexpr std::array kDepths = {0.0, 1e-6, 1e-4};
  const double longest = bounds.sizes().maxCoeff();
  for (const Eigen::Matrix3d& rotation : axis_rotations()) {
    const Eigen::Vector3d a = rotation * bounds.min();
    const Eigen::Vector3d b = rotation * bounds.max();
    const Eigen::AlignedBox3d copy(a.cwiseMin(b), a.cwiseMax(b));
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (const bool above : {false, true}) {
        for (const double depth : kDepths) {
          Pose pose = Pose::Identity();
          pose.linear() = rotation;
          Eigen::Vector3d move = bounds.center() - copy.center();
          move[axis] = above ? bounds.max()[axis] - copy.min()[axis] - depth * longest
                             : bounds.min()[axis] - copy.max()[axis] + depth * longest;
          pose.translation() = move;
          poses.push_back(pose);
        }
      }
    }
  }
  return poses;
}

Result<std::uint64_t> count_pairs(const Tree& first, const Tree& second, const Pose& pose) {
  std::uint64_t count = 0;
  const Result<Visit> visit =
      overlap_pairs(first, Pose::Identity(), second, pose, [&](const FacePair&) {
        ++count;
        return true;
      });
  if (!visit) return visit.error();
  return count;
}

void add_quad(SourceMesh& mesh, const std::array<std::array<float, 3>, 4>& corners) {
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (const auto& corner : corners) {
    mesh.positions.f32.insert(mesh.positions.f32.end(), corner.begin(), corner.end());
  }
  mesh.faces.push_back({{first, first + 1, first + 2, kNoCorner}});
  mesh.faces.push_back({{first, first + 2, first + 3, kNoCorner}});
}

constexpr std::size_t kStairSteps = 64;
constexpr float kTread = 0.125f;
constexpr float kRise = 0.17f;  // not representable in f16
constexpr float kStairWidth = 8;

SourceMesh stairs() {
  SourceMesh mesh;
  mesh.name = "stairs";
  for (std::size_t i = 0; i < kStairSteps; ++i) {
    const float front = kTread * static_cast<float>(i);
    const float back = kTread * static_cast<float>(i + 1);
    const float below = kRise * static_cast<float>(i);
    const float top = kRise * static_cast<float>(i + 1);
    add_quad(mesh, {{{front, 0, below},
                     {front, kStairWidth, below},
                     {front, kStairWidth, top},
                     {front, 0, top}}});
    add_quad(
        mesh,
        {{{front, 0, top}, {front, kStairWidth, top}, {back, kStairWidth, top}, {back, 0, top}}});
  }
  return mesh;
}

// A box whose bottom is at height 0.
SourceMesh crate() {
  SourceMesh mesh;
  mesh.name = "crate";
  constexpr float kHalf = 0.05f;
  constexpr float kTop = 0.1f;
  const auto corner = [](unsigned i) -> std::array<float, 3> {
    return {(i & 1u) != 0 ? kHalf : -kHalf, (i & 2u) != 0 ? kHalf : -kHalf,
            (i & 4u) != 0 ? kTop : 0};
  };
  constexpr std::array<std::array<unsigned, 4>, 6> kSides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& side : kSides) {
    add_quad(mesh, {corner(side[0]), corner(side[1]), corner(side[2]), corner(side[3])});
  }
  return mesh;
}

}  // namespace

Result<RoundingFigures> aligned_contact(const SourceMesh& mesh, const EncodedTree& f32,
                                        const EncodedTree& outward) {
  const EncodedTree nearest = with_nearest_cuts(f32);
  RoundingFigures figures;
  figures.gates_nearest = check_gates(nearest, arrays_of(mesh));
  figures.gates_outward = check_gates(outward, arrays_of(mesh));
  const auto count = [&](const EncodedTree& encoded, std::uint64_t& total) -> Status {
    const Result<Tree> tree = bind_encoded(encoded);
    if (!tree) return tree.error();
    const std::vector<Pose> poses = aligned_poses(bounds_in_object_space(*tree));
    figures.queries = poses.size();
    for (const Pose& pose : poses) {
      const Result<std::uint64_t> pairs = count_pairs(*tree, *tree, pose);
      if (!pairs) return pairs.error();
      total += *pairs;
    }
    return {};
  };
  if (Status status = count(f32, figures.pairs_f32); !status) return status.error();
  if (Status status = count(nearest, figures.pairs_nearest); !status) return status.error();
  if (Status status = count(outward, figures.pairs_outward); !status) return status.error();
  return figures;
}

Result<std::vector<StairFigures>> stair_contact() {
  CookOptions options;
  options.builder = Builder::kPaper;
  const Result<EncodedTree> f32 = cook_as(stairs(), CodecId::kPlainF32, options);
  if (!f32) return f32.error();
  const Result<EncodedTree> outward = cook_as(stairs(), CodecId::kPlainF16, options);
  if (!outward) return outward.error();
  const Result<EncodedTree> box = cook_as(crate(), CodecId::kPlainF32, options);
  if (!box) return box.error();
  const EncodedTree nearest = with_nearest_cuts(*f32);
  const Result<Tree> resting = bind_encoded(*box);
  if (!resting) return resting.error();

  std::vector<StairFigures> rows;
  for (const double depth : {1e-3, 1e-4, 1e-5, 1e-6}) {
    StairFigures row;
    row.depth = depth;
    row.steps = kStairSteps;
    const auto count_missed = [&](const EncodedTree& encoded, std::uint64_t& missed) -> Status {
      const Result<Tree> tree = bind_encoded(encoded);
      if (!tree) return tree.error();
      for (std::size_t i = 0; i < kStairSteps; ++i) {
        Pose pose = Pose::Identity();
        const float top = kRise * static_cast<float>(i + 1);
        pose.translation() = Eigen::Vector3d(kTread * (static_cast<double>(i) + 0.5),
                                             kStairWidth / 2, double{top} - depth);
        const Result<std::uint64_t> pairs = count_pairs(*tree, *resting, pose);
        if (!pairs) return pairs.error();
        missed += *pairs == 0 ? 1u : 0u;
      }
      return {};
    };
    if (Status status = count_missed(*f32, row.missed_f32); !status) return status.error();
    if (Status status = count_missed(nearest, row.missed_nearest); !status) return status.error();
    if (Status status = count_missed(*outward, row.missed_outward); !status) return status.error();
    rows.push_back(row);
  }
  return rows;
}

}  // namespace boxtree::cooker
