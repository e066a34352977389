// SPDX-License-Identifier: MIT
// Cooks and decodes subjects.
#include "tests/robustness/subjects.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>

#include "runtime/tree/bound_tree.h"

namespace boxtree::robustness {
namespace {

class Walk {
 public:
  explicit Walk(const Tree& tree) : tree_(tree), met_(tree.face_count(), false) {}

  WalkFigures run() {
    if (!tree_.empty()) visit(BoundTree::of(tree_).root());
    visit_duplicates();
    figures_.missed = static_cast<std::uint64_t>(std::count(met_.begin(), met_.end(), false));
    return figures_;
  }

 private:
  void visit(const Node& node) {
    path_.push_back(node.box);
    for (std::size_t k = 0; k < 3; ++k) {
      if (!std::isfinite(node.box.low[k]) || !std::isfinite(node.box.high[k])) {
        ++figures_.boxes_infinite;
      }
    }
    if (node.is_leaf) {
      visit_leaf(node);
    } else {
      figures_.depth = std::max(figures_.depth, static_cast<std::uint32_t>(path_.size()));
      NodeChildren children;
      if (BoundTree::of(tree_).expand(node, children) != NodeState::kValid)
        throw std::runtime_error("corrupt node");
      for (std::uint32_t i = 0; i < children.count; ++i) visit(children.child[i]);
    }
    path_.pop_back();
  }

  void visit_leaf(const Node& leaf) {
    ++figures_.leaves;
    TriangleBatch batch;
    if (BoundTree::of(tree_).leaf_triangles(leaf, batch) != Errc::kOk)
      throw std::runtime_error("corrupt leaf");
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      const bool is_second_half = i > 0 && batch.face[i] == batch.face[i - 1];
      figures_.repeated += !is_second_half && met_[batch.face[i]] ? 1u : 0u;
      met_[batch.face[i]] = true;
      const Triangle triangle = batch.triangle(i);
      for (const Box<double>& box : path_) figures_.escapes += is_inside(triangle, box) ? 0u : 1u;
    }
  }

  // Copies are in no leaf; they are found with their originals.
  void visit_duplicates() {
    for (std::uint32_t face = 0; face < BoundTree::of(tree_).face_count(); ++face) {
      if (!met_[face] || BoundTree::of(tree_).original_of(face) != face) continue;
      const FaceRange copies = BoundTree::of(tree_).duplicates_of(face);
      for (std::uint32_t copy = copies.first; copy < copies.last; ++copy) {
        figures_.repeated += met_[copy] ? 1u : 0u;
        met_[copy] = true;
      }
    }
  }

  static bool is_inside(const Triangle& triangle, const Box<double>& box) {
    for (const Eigen::Vector3d& corner : triangle.corner) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = corner[static_cast<Eigen::Index>(k)];
        if (!(box.low[k] <= x && x <= box.high[k])) return false;
      }
    }
    return true;
  }

  const Tree& tree_;
  std::vector<bool> met_;
  std::vector<Box<double>> path_;
  WalkFigures figures_;
};

}  // namespace

WalkFigures walk_tree(const Tree& tree) {
  return Walk(tree).run();
}

Subject make_subject(const SourceMesh& mesh, CodecId codec, const Store& store) {
  cooker::CookOptions options;
  options.geometry = store.geometry;
  options.grid.bits = store.grid_bits;
  return {test::cook_tree(mesh, codec, options), mesh.name + ", " + std::string(codec_name(codec)) +
                                                     ", " +
                                                     std::string(geometry_name(store.geometry))};
}

std::vector<DecodedTriangle> decoded_triangles(const Tree& tree) {
  std::vector<DecodedTriangle> all;
  TriangleBatch batch;
  for (std::uint32_t order = 0; order < tree.face_count(); ++order) {
    if (BoundTree::of(tree).leaves().read(order, 1, batch) != Errc::kOk) {
      throw std::runtime_error("face " + std::to_string(order) + " cannot be read");
    }
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      all.push_back({BoundTree::of(tree).face_id(order), i, batch.triangle(i)});
    }
  }
  std::sort(all.begin(), all.end(), [](const DecodedTriangle& a, const DecodedTriangle& b) {
    return std::tie(a.face, a.half) < std::tie(b.face, b.half);
  });
  return all;
}

}  // namespace boxtree::robustness
