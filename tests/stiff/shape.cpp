// SPDX-License-Identifier: MIT
// Cooking shapes, and finding the faces that touch through their trees.
#include "tests/stiff/shape.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include "format/codec_plain.h"
#include "format/half.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/require.h"

namespace boxtree::stiff {
namespace {

using test::require;

cooker::CookOptions options_of(const Store& store) {
  cooker::CookOptions options;
  if (store.grid) {
    options.geometry = GeometryId::kGrid;
    options.grid = *store.grid;
  }
  return options;
}

Eigen::AlignedBox3d bounds_in_world(std::span<const Triangle> triangles, const Pose& pose) {
  Eigen::AlignedBox3d bounds;
  for (const Triangle& triangle : triangles) {
    for (const Eigen::Vector3d& corner : triangle.corner) bounds.extend(pose * corner);
  }
  return bounds;
}

// Reads every face through the tree, as a contact solver of an application would.
void read_triangles(Shape& shape, const Tree& tree) {
  const std::uint32_t faces = tree.face_count();
  std::vector<std::vector<Triangle>> by_id(faces);
  TriangleBatch batch;
  for (std::uint32_t order = 0; order < faces; ++order) {
    if (const Errc error = BoundTree::of(tree).leaves().read(order, 1, batch); error != Errc::kOk) {
      throw std::runtime_error("a face cannot be read");
    }
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      Triangle triangle = batch.triangle(i);
      for (Eigen::Vector3d& corner : triangle.corner)
        corner = BoundTree::of(tree).frame().to_object(corner);
      by_id.at(BoundTree::of(tree).face_id(order)).push_back(triangle);
    }
  }
  shape.first = {0};
  for (const auto& triangles : by_id) {
    shape.triangles.insert(shape.triangles.end(), triangles.begin(), triangles.end());
    shape.first.push_back(static_cast<std::uint32_t>(shape.triangles.size()));
    shape.bounds.push_back(bounds_in_world(triangles, Pose::Identity()));
    shape.whole.extend(shape.bounds.back());
  }
}

Shape shape_of(std::string name, cooker::EncodedTree encoded) {
  Shape shape;
  shape.name = std::move(name);
  shape.max_vertex_error = encoded.geometry.max_vertex_error;
  shape.encoded = std::make_unique<const cooker::EncodedTree>(std::move(encoded));
  shape.tree = require(cooker::bind_encoded(*shape.encoded));
  read_triangles(shape, *shape.tree);
  return shape;
}

// A level does not move.
bool is_in_place(const Pose& pose) {
  return pose.matrix() == Pose::Identity().matrix();
}

Eigen::AlignedBox3d bounds_in_world(const Shape& shape, const Pose& pose) {
  return is_in_place(pose) ? shape.whole : bounds_in_world(shape.triangles, pose);
}

void add_faces_in(const Eigen::AlignedBox3d& box, const Shape& shape, const Pose& pose,
                  std::vector<std::uint32_t>& out) {
  const bool in_place = is_in_place(pose);
  for (std::uint32_t face = 0; face < shape.face_count(); ++face) {
    if (box.intersects(in_place ? shape.bounds[face] : bounds_in_world(shape.face(face), pose))) {
      out.push_back(face);
    }
  }
}

void sort_unique(std::vector<std::uint32_t>& ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
}

}  // namespace

Store exact_store() {
  return {};
}

Store grid_store(int bits) {
  return {"grid " + std::to_string(bits) + " bit", cooker::GridChoice{bits, {}}};
}

Store tolerance_store(double tolerance) {
  char name[32];
  static_cast<void>(std::snprintf(name, sizeof(name), "tolerance %.2g m", tolerance));
  cooker::GridChoice choice;
  choice.tolerance = tolerance;
  return {name, choice};
}

Shape make_shape(const SourceMesh& mesh, CodecId codec, const Store& store) {
  return shape_of(std::string(codec_name(codec)),
                  require(cooker::cook_as(mesh, codec, options_of(store))));
}

Shape make_scan(const SourceMesh& mesh, const Store& store) {
  Shape shape = make_shape(mesh, CodecId::kPlainF32, store);
  shape.name = "no tree";
  shape.tree.reset();
  return shape;
}

Shape make_nearest(const SourceMesh& mesh, const Store& store) {
  const cooker::EncodedTree f32 =
      require(cooker::cook_as(mesh, CodecId::kPlainF32, options_of(store)));
  cooker::EncodedTree wrong = f32;
  wrong.nodes.codec = CodecId::kPlainF16;
  wrong.nodes.bytes.resize(f32.nodes.node_count * sizeof(PlainNodeF16));
  for (std::size_t i = 0; i < f32.nodes.node_count; ++i) {
    const auto from = load<PlainNodeF32>(f32.nodes.bytes.data(), i);
    PlainNodeF16 to{from.cutplane, {from.child[0], from.child[1]}, {}};
    for (std::size_t side = 0; side < 2; ++side) to.cut[side] = half_to_nearest(from.cut[side]);
    std::memcpy(wrong.nodes.bytes.data() + i * sizeof(to), &to, sizeof(to));
  }
  return shape_of("f16 to nearest", std::move(wrong));
}

double tread_height(const Shape& level, const Eigen::Vector3d& at) {
  double height = -std::numeric_limits<double>::infinity();
  for (const Triangle& triangle : level.triangles) {
    Eigen::AlignedBox3d bounds;
    for (const Eigen::Vector3d& corner : triangle.corner) bounds.extend(corner);
    const bool is_level = bounds.sizes().z() == 0;
    const bool is_here = (bounds.min().array() <= at.array()).head<2>().all() &&
                         (at.array() <= bounds.max().array()).head<2>().all();
    if (is_level && is_here) height = std::max(height, bounds.min().z());
  }
  return height;
}

std::uint16_t half_to_nearest(float value) {
  const std::uint16_t below = half_toward_zero(value);
  const auto above = static_cast<std::uint16_t>(below + 1);
  const double down = double{value} - double{half_to_float(below)};
  const double up = double{half_to_float(above)} - double{value};
  return down < up || (down == up && below % 2 == 0) ? below : above;
}

void find_touching(const Shape& first, const Pose& first_pose, const Shape& second,
                   const Pose& second_pose, Touching& out) {
  out.first.clear();
  out.second.clear();
  if (first.tree && second.tree) {
    static_cast<void>(require(overlap_pairs(*first.tree, first_pose, *second.tree, second_pose,
                                            [&](const FacePair& pair) {
                                              out.first.push_back(pair.first.id);
                                              out.second.push_back(pair.second.id);
                                              return true;
                                            })));
    sort_unique(out.first);
    sort_unique(out.second);
    return;
  }
  add_faces_in(bounds_in_world(second, second_pose), first, first_pose, out.first);
  add_faces_in(bounds_in_world(first, first_pose), second, second_pose, out.second);
}

}  // namespace boxtree::stiff
