// SPDX-License-Identifier: MIT
// Scenes of a few trees, at any scale that poses may have.
#include "tests/oracle/exact/scene_subject.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include <Eigen/LU>

#include "runtime/tree/bound_tree.h"
#include "tests/oracle/exact/poses.h"
#include "tests/support/require.h"

namespace boxtree::oracle {
namespace {

double largest_of(const cooker::SourceMesh& mesh) {
  double largest = 0;
  for (const float x : mesh.positions.f32) largest = std::max(largest, std::abs(double{x}));
  return largest == 0 ? 1 : largest;
}

Pose draw_pose(Draw& d, const SceneSubject& subject, std::uint32_t tree) {
  const double size = subject.world_size;
  const double scale = size / largest_of(subject.meshes[tree]) * d.power(-2, 1);
  Pose pose = Pose::Identity();
  if (d.one_in(3)) {  // nothing is rounded, so that features intersect exactly
    const double whole = std::ldexp(1.0, std::ilogb(scale));
    pose.linear() = draw_exact_linear(d, 0, 0) * whole;
    for (Eigen::Index k = 0; k < 3; ++k) pose.translation()[k] = d.between(-4, 4) * size / 4;
    return pose;
  }
  pose.linear() = draw_linear(d) * (scale * (0.5 + d.part()));
  for (Eigen::Index k = 0; k < 3; ++k) pose.translation()[k] = d.unit() * size * 2;
  if (d.one_in(10)) pose.translation() *= d.power(0, 30);
  if (d.one_in(20)) pose.translation().setZero();
  return pose;
}

// Ordinary ones; any; and those at which determinants of poses are about to leave the doubles.
double draw_world_size(Draw& d, double mesh) {
  switch (d.below(4)) {
    case 0:
      return d.power(-900, 180);
    case 1:
      return mesh * (d.one_in(4) ? d.power(330, 345) : d.power(-362, -335));
    default:
      return d.power(-10, 10);
  }
}

SceneVariant make_variant(const SceneSubject& subject, const cooker::SceneParts& parts,
                          const std::vector<CodecId>& codecs) {
  std::string name;
  for (const CodecId codec : codecs) name += std::string(codec_name(codec)) + " ";
  test::CookedScene cooked = test::cook_scene(subject.meshes, parts, codecs);
  SceneOptions options;
  options.queries = kAllQueries;
  Scene scene = test::require(Scene::bind(cooked.file, options));
  SceneVariant variant{name, std::move(cooked), std::move(scene), {}, {}};
  variant.number_of_id.resize(variant.scene.instance_count());
  for (std::uint32_t n = 0; n < variant.scene.instance_count(); ++n) {
    const std::uint32_t id = test::require(variant.scene.info(n)).id;
    variant.number_of_id[id] = n;
    variant.id_of_number.push_back(id);
  }
  return variant;
}

// A corner in the world: seen from the origin of its tree, which is moved there first.
Point placed_corner(const Pose& pose, const Eigen::Vector3d& corner,
                    const Eigen::Vector3d& origin) {
  const Eigen::Vector3d p = corner - origin;
  Point world;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto i = static_cast<Eigen::Index>(k);
    const auto m = [&](Eigen::Index column) { return pose.linear()(i, column); };
    const double moved =
        ((m(0) * origin[0] + m(1) * origin[1]) + m(2) * origin[2]) + pose.translation()[i];
    world[k] = ((moved + m(0) * p[0]) + m(1) * p[1]) + m(2) * p[2];
  }
  return world;
}

// By how much the largest coordinates may differ from the static instances, and what they may be
// (docs/GUARANTEES.md), each less a factor for what bounds of instances lose to rounding.
constexpr double kMostExtents = 0x1p184;
constexpr double kLargestCoordinate = 0x1p199;

// Corners of the bounds of a tree's mesh, in the world.
std::array<Eigen::Vector3d, 8> placed_bounds(const cooker::SourceMesh& mesh, const Pose& pose) {
  Eigen::AlignedBox3d bounds;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const auto p = mesh.positions[static_cast<std::uint32_t>(v)];
    bounds.extend(Eigen::Vector3d(p[0], p[1], p[2]));
  }
  std::array<Eigen::Vector3d, 8> corners;
  for (int i = 0; i < 8; ++i) {
    corners[static_cast<std::size_t>(i)] =
        pose * bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i));
  }
  return corners;
}

// The extent of the static instances, or of all where none is static.
double static_extent(const SceneSubject& subject) {
  const bool has_static =
      std::find(subject.moves.begin(), subject.moves.end(), false) != subject.moves.end();
  Eigen::AlignedBox3d bounds;
  for (std::size_t id = 0; id < subject.poses.size(); ++id) {
    if (has_static && subject.moves[id]) continue;
    for (const auto& corner :
         placed_bounds(subject.meshes[subject.tree_of_id[id]], subject.poses[id])) {
      bounds.extend(corner);
    }
  }
  return bounds.sizes().maxCoeff();
}

// Whether a pose is well within what the guarantees allow, so that nobody may refuse it. Maps that
// are nearly singular may be refused.
bool is_surely_allowed(const SceneSubject& subject, std::uint32_t tree, const Pose& pose,
                       double extent) {
  const double size = pose.linear().cwiseAbs().maxCoeff();
  if (!(size > 0x1p-880 && size < 0x1p880)) return false;
  const Eigen::Matrix3d moderate = pose.linear() * std::ldexp(1.0, -std::ilogb(size));
  if (!(std::abs(moderate.determinant()) > 0x1p-40)) return false;
  double largest = 0;
  for (const auto& corner : placed_bounds(subject.meshes[tree], pose)) {
    largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  }
  return largest <= kLargestCoordinate && largest <= kMostExtents * extent;
}

}  // namespace

std::unique_ptr<SceneSubject> draw_scene(Draw& d) {
  auto subject = std::make_unique<SceneSubject>();
  const std::uint32_t trees = 1 + d.below(4);
  for (std::uint32_t i = 0; i < trees; ++i) {
    subject->meshes.push_back(draw_mesh(d, {false, d.one_in(4), 10}));
  }
  subject->world_size = draw_world_size(d, largest_of(subject->meshes[0]));
  cooker::SceneParts parts;
  parts.layers.push_back({"all"});
  const std::uint32_t instances = 2 + d.below(12);
  for (std::uint32_t id = 0; id < instances; ++id) {
    cooker::PlacedTree placed;
    placed.tree = d.below(trees);
    placed.id = id;
    placed.moves = d.one_in(2);
    placed.pose = draw_pose(d, *subject, placed.tree);
    subject->tree_of_id.push_back(placed.tree);
    subject->moves.push_back(placed.moves);
    subject->poses.push_back(placed.pose);
    parts.instances.push_back(placed);
  }
  const std::vector<CodecId> mixed{kCodecs[d.below(kCodecs.size())].id,
                                   kCodecs[d.below(kCodecs.size())].id};
  try {
    for (const auto& codecs : {std::vector{CodecId::kPlainF32}, std::vector{CodecId::kWide8},
                               std::vector{CodecId::kWide4}, mixed}) {
      subject->variants.push_back(make_variant(*subject, parts, codecs));
    }
  } catch (const std::runtime_error&) {
    if (!subject->variants.empty()) throw;  // not refused by all
    const double extent = static_extent(*subject);
    bool are_allowed = true;
    for (std::size_t id = 0; id < subject->poses.size(); ++id) {
      are_allowed &=
          is_surely_allowed(*subject, subject->tree_of_id[id], subject->poses[id], extent);
    }
    if (are_allowed) throw;
    return nullptr;
  }
  for (const Tree& tree : subject->variants[0].scene.trees()) {
    Group group;
    group.space = BoundTree::of(tree).frame();
    group.triangles = decoded_triangles_of(tree);
    subject->trees.push_back(std::move(group));
  }
  return subject;
}

std::uint32_t update_some(Draw& d, SceneSubject& subject, int count) {
  std::uint32_t refused = 0;
  const double extent = static_extent(subject);
  for (int i = 0; i < count; ++i) {
    const std::uint32_t id = d.below(static_cast<std::uint32_t>(subject.poses.size()));
    if (!subject.moves[id]) continue;
    const Pose pose = draw_pose(d, subject, subject.tree_of_id[id]);
    const bool first =
        subject.variants[0].scene.update(subject.variants[0].number_of_id[id], pose).ok();
    for (std::size_t v = 1; v < subject.variants.size(); ++v) {
      SceneVariant& variant = subject.variants[v];
      if (variant.scene.update(variant.number_of_id[id], pose).ok() != first) {
        throw std::runtime_error("an update that some codecs refuse");
      }
    }
    if (!first && is_surely_allowed(subject, subject.tree_of_id[id], pose, extent)) {
      throw std::runtime_error("an update that the guarantees allow is refused");
    }
    refused += first ? 0 : 1;
    if (first) subject.poses[id] = pose;
  }
  if (d.one_in(3)) {
    for (SceneVariant& variant : subject.variants) variant.scene.rebuild();
  }
  return refused;
}

World world_of(const SceneSubject& subject) {
  World world;
  for (std::uint32_t id = 0; id < subject.poses.size(); ++id) {
    const std::uint32_t tree = subject.tree_of_id[id];
    const cooker::SourceMesh& mesh = subject.meshes[tree];
    const Eigen::Vector3d origin =
        BoundTree::of(subject.variants[0].scene.trees()[tree]).frame().origin;
    for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
      const cooker::Face& face = mesh.faces[f];
      for (std::uint32_t half = 0; half < (face.is_quad() ? 2u : 1u); ++half) {
        Face t;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t corner = half == 1 && c > 0 ? c + 1 : c;
          t[c] = placed_corner(subject.poses[id], mesh.positions[face.corner[corner]], origin);
        }
        const auto index = static_cast<std::uint32_t>(world.placed.size());
        world.placed.push_back({id, f, half});
        world.group.triangles.push_back({index, 0, t, as<Dyadic>(t), bounds_of(t), largest(t)});
        world.group.largest = std::max(world.group.largest, largest(t));
      }
    }
  }
  return world;
}

}  // namespace boxtree::oracle
