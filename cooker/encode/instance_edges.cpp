// SPDX-License-Identifier: MIT
// Faces at the boundaries of trees are brought into the world, those that lie in the box of another
// instance alone; find_active_edges() looks at their boundaries as edges of one mesh.
#include "cooker/encode/instance_edges.h"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "cooker/build/active_edges.h"
#include "format/instance_edges.h"
#include "runtime/primitive/normal.h"
#include "runtime/scene/placement.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

// A face of a tree that has edges alone.
struct BorderFace {
  std::uint32_t face;  // of the tree's order
  std::uint32_t count = 3;
  std::uint32_t open = 0;                 // bit i: the edge from corner i to the next one
  std::array<Eigen::Vector3d, 4> corner;  // tree space
};

void add_position(Positions& positions, const Eigen::Vector3d& p) {
  positions.f64.insert(positions.f64.end(), {p[0], p[1], p[2]});
}

void add_face(SourceMesh& mesh, std::span<const Eigen::Vector3d> corners) {
  Face face{{kNoCorner, kNoCorner, kNoCorner, kNoCorner}};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    face.corner[i] = static_cast<std::uint32_t>(mesh.positions.size());
    add_position(mesh.positions, corners[i]);
  }
  mesh.faces.push_back(face);
}

// Faces in leaves: copies are in the lists by their originals.
Result<std::vector<BorderFace>> border_of(const EncodedTree& encoded, const MeshArrays& arrays,
                                          double degrees) {
  BindOptions bind;
  bind.mesh = arrays;
  const Result<Tree> bound = bind_encoded(encoded, bind);
  if (!bound) return bound.error();
  const BoundTree& tree = BoundTree::of(*bound);
  const auto read = [&](std::uint32_t face, BorderFace& out) {
    TriangleBatch batch;
    const Errc error = tree.leaves().read(face, 1, batch);
    if (error != Errc::kOk) return error;
    const Triangle first = batch.triangle(0);
    std::copy(first.corner.begin(), first.corner.end(), out.corner.begin());
    out.face = face;
    out.count = batch.count == 2 ? 4 : 3;
    if (out.count == 4) out.corner[3] = batch.triangle(1).corner[2];
    return Errc::kOk;
  };
  SourceMesh mesh;
  mesh.positions.precision = Precision::kF64;
  for (std::uint32_t face = 0; face < tree.counts().faces_in_leaves; ++face) {
    BorderFace each{};
    if (const Errc error = read(face, each); error != Errc::kOk) return error;
    add_face(mesh, std::span(each.corner).first(each.count));
  }
  std::vector<BorderFace> border;
  for (const FaceEdge& open : find_active_edges(mesh, degrees).open) {
    if (open.face > kMaxListedFace) break;
    if (border.empty() || border.back().face != open.face) {
      border.emplace_back();
      if (const Errc error = read(open.face, border.back()); error != Errc::kOk) return error;
    }
    border.back().open |= 1u << open.edge;
  }
  return border;
}

// An instance at rest.
struct Resting {
  std::size_t instance;
  AffineMap to_world;
  Box<double> box;                  // world; holds what is placed, rounding included
  std::vector<std::size_t> nearby;  // others whose boxes overlap
};

bool holds(const Box<double>& box, const Eigen::Vector3d& p) {
  for (std::size_t k = 0; k < 3; ++k) {
    const double x = p[static_cast<Eigen::Index>(k)];
    if (!(box.low[k] <= x && x <= box.high[k])) return false;
  }
  return true;
}

class InstanceEdgesFinder {
 public:
  InstanceEdgesFinder(std::span<const EncodedTree> trees, std::span<const MeshArrays> arrays,
                      double degrees, SceneParts& parts)
      : trees_(trees), arrays_(arrays), degrees_(degrees), parts_(parts) {}

  Status run() {
    parts_.edge_lists.clear();
    for (PlacedTree& instance : parts_.instances) instance.edge_list.reset();
    place();
    find_nearby();
    borders_.resize(trees_.size());
    world_.positions.precision = Precision::kF64;
    for (const Resting& each : resting_) {
      if (each.nearby.empty()) continue;
      auto& border = borders_[parts_.instances[each.instance].tree];
      if (!border) {
        const std::size_t tree = parts_.instances[each.instance].tree;
        auto found =
            border_of(trees_[tree], arrays_.empty() ? MeshArrays() : arrays_[tree], degrees_);
        if (!found) return found.error();
        border = std::move(*found);
      }
      bring(each, *border);
    }
    list(find_active_edges(world_, degrees_, open_));
    return {};
  }

 private:
  // A face of the world: which one of which instance.
  struct Origin {
    std::size_t instance;
    std::uint32_t face;
    std::uint32_t count;
    bool is_mirror;
  };

  void place() {
    for (std::size_t i = 0; i < parts_.instances.size(); ++i) {
      const PlacedTree& instance = parts_.instances[i];
      if (instance.moves) continue;
      const EncodedTree& tree = trees_[instance.tree];
      const auto placed = Placement::make(Frame(tree.origin, tree.scale_exponent), instance.pose);
      const auto bounds = placed ? placed->bounds(tree.nodes.root_box) : std::nullopt;
      if (!bounds) continue;  // encode_scene() reports it
      resting_.push_back({i, placed->to_world(), bounds->world, {}});
    }
  }

  void find_nearby() {
    std::sort(resting_.begin(), resting_.end(), [](const Resting& a, const Resting& b) {
      return a.box.low[0] != b.box.low[0] ? a.box.low[0] < b.box.low[0] : a.instance < b.instance;
    });
    for (std::size_t i = 0; i < resting_.size(); ++i) {
      for (std::size_t j = i + 1; j < resting_.size(); ++j) {
        if (resting_[j].box.low[0] > resting_[i].box.high[0]) break;
        if (!boxes_overlap(resting_[i].box, resting_[j].box)) continue;
        resting_[i].nearby.push_back(j);
        resting_[j].nearby.push_back(i);
      }
    }
  }

  // Adds faces with edges that another instance may have, too. A mirror turns corners over, so that
  // the front stays the front.
  void bring(const Resting& each, const std::vector<BorderFace>& border) {
    const bool mirrored = is_mirror(each.to_world.linear);
    for (const BorderFace& face : border) {
      std::array<Eigen::Vector3d, 4> corner;
      for (std::uint32_t i = 0; i < face.count; ++i) {
        corner[i] = each.to_world.apply(face.corner[i]);
      }
      std::uint32_t open = 0;
      for (std::uint32_t i = 0; i < face.count; ++i) {
        if ((face.open >> i & 1u) == 0) continue;
        const bool is_near =
            std::any_of(each.nearby.begin(), each.nearby.end(), [&](std::size_t other) {
              const Box<double>& box = resting_[other].box;
              return holds(box, corner[i]) && holds(box, corner[(i + 1) % face.count]);
            });
        if (is_near) open |= 1u << edge_of(i, face.count, mirrored);
      }
      if (open == 0) continue;
      if (mirrored) std::reverse(corner.begin() + 1, corner.begin() + face.count);
      add_face(world_, std::span(corner).first(face.count));
      open_.push_back(static_cast<std::uint8_t>(open));
      origins_.push_back({each.instance, face.face, face.count, mirrored});
    }
  }

  // The number of an edge after corners 1 and later have changed places, and back.
  static std::uint32_t edge_of(std::uint32_t edge, std::uint32_t count, bool mirrored) {
    return mirrored ? count - 1 - edge : edge;
  }

  // Faces of an instance come together, ascending.
  void list(const ActiveEdges& found) {
    std::map<std::vector<std::uint32_t>, std::uint32_t> known;
    for (std::size_t first = 0; first < origins_.size();) {
      const std::size_t instance = origins_[first].instance;
      std::vector<std::uint32_t> entries;
      for (; first < origins_.size() && origins_[first].instance == instance; ++first) {
        const Origin& origin = origins_[first];
        const std::uint32_t inactive = open_[first] & ~std::uint32_t{found.of_face[first]};
        std::uint32_t edges = 0;
        for (std::uint32_t i = 0; i < origin.count; ++i) {
          if ((inactive >> edge_of(i, origin.count, origin.is_mirror) & 1u) != 0) edges |= 1u << i;
        }
        if (edges != 0) entries.push_back(ListedEdges{origin.face, edges}.entry());
      }
      if (entries.empty()) continue;
      const auto next = static_cast<std::uint32_t>(known.size());
      parts_.instances[instance].edge_list =
          known.try_emplace(std::move(entries), next).first->second;
    }
    parts_.edge_lists.resize(known.size());
    for (const auto& [entries, number] : known) parts_.edge_lists[number] = entries;
  }

  std::span<const EncodedTree> trees_;
  std::span<const MeshArrays> arrays_;
  double degrees_;
  SceneParts& parts_;
  std::vector<Resting> resting_;                                 // by the low ends of their boxes
  std::vector<std::optional<std::vector<BorderFace>>> borders_;  // of trees
  SourceMesh world_;
  std::vector<std::uint8_t> open_;  // of each face of it
  std::vector<Origin> origins_;     // likewise
};

}  // namespace

Status find_instance_edges(std::span<const EncodedTree> trees, std::span<const MeshArrays> arrays,
                           double degrees, SceneParts& parts) {
  return InstanceEdgesFinder(trees, arrays, degrees, parts).run();
}

}  // namespace boxtree::cooker
