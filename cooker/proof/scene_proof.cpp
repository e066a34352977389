// SPDX-License-Identifier: MIT
// Proves by walking the written top level.
#include "cooker/proof/scene_proof.h"

#include <set>
#include <string>
#include <tuple>
#include <vector>

#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/face_number_proof.h"
#include "cooker/proof/names.h"
#include "format/instance_edges.h"
#include "runtime/file/open_file.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree::cooker {
namespace {

class SceneWalk {
 public:
  SceneWalk(const File& file, const Scene& scene)
      : file_(file), scene_(scene), bound_(BoundScene::of(scene).record().node_count) {}

  Findings run() {
    const SceneRecord& record = BoundScene::of(scene_).record();
    reached_.assign(record.static_count, false);
    if (record.root == RootKind::kLeaf)
      visit_leaf(0, root_box<float>(BoundScene::of(scene_).top_level()));
    if (record.root == RootKind::kSubtree) {
      visit_node({0, 0}, root_box<float>(BoundScene::of(scene_).top_level()), 1);
    }
    for (std::uint32_t i = 0; i < record.static_count; ++i) {
      if (!reached_[i]) add(Errc::kFaceUnreachable, name(i) + "no leaf of the top level is it");
    }
    compare("nodes", nodes_, record.node_count);
    compare("depth", depth_, record.depth);
    for (std::uint32_t i = 0; i < record.instance_count; ++i) check_instance(i);
    check_layers();
    check_materials(file_, [this](const std::string& fault) { add(Errc::kRecordInvalid, fault); });
    check_left_out();
    check_edges();
    return std::move(findings_);
  }

 private:
  void add(Errc code, const std::string& what) {
    if (findings_.size() < kMaxFindings) findings_.push_back({code, "scene: " + what});
  }
  static std::string name(std::uint32_t instance) {
    return "instance " + std::to_string(instance) + ": ";
  }
  void compare(const char* what, std::uint32_t found, std::uint32_t stated) {
    if (found == stated) return;
    add(Errc::kRecordInvalid, "the record states " + std::to_string(stated) + " " + what +
                                  ", the top level has " + std::to_string(found));
  }

  // Returns the bounds of all instances below, in the scene's frame. Children have larger indices
  // than their parents, so numbers increase on every path; the depth is limited nevertheless.
  Box<double> visit_node(NodeRef node, const Box<float>& box, std::uint32_t depth) {
    Box<double> content = empty_box<double>();
    if (depth > kMaxWideDepth) {
      add(Errc::kDepthExceeded, "node " + std::to_string(node.first) + " is too deep");
      return content;
    }
    TopLevel::Codec::Children children;
    const NodeState state = BoundScene::of(scene_).top_level().codec.expand(node, box, children);
    if (const Errc error = bound_.count(state); error != Errc::kOk) {
      add(error, fault_of_node(node.first, state));
      return content;
    }
    ++nodes_;
    depth_ = std::max(depth_, depth);
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const Box<double> below =
          children.is_leaf(i)
              ? visit_leaf(BoundScene::of(scene_).top_level().instance(children.ref[i]),
                           children.box(i))
              : visit_node(children.ref[i], children.box(i), depth + 1);
      expand(content, below);
    }
    check_box("node " + std::to_string(node.first), content, box);
    return content;
  }

  Box<double> visit_leaf(std::uint32_t instance, const Box<float>& box) {
    if (reached_[instance]) add(Errc::kFaceRepeated, name(instance) + "is two leaves");
    reached_[instance] = true;
    const std::optional<BoundScene::Placed> placed = BoundScene::of(scene_).place(instance);
    const auto bounds = placed ? placed->bounds() : std::nullopt;
    if (!bounds) return empty_box<double>();  // check_instance reports the reason
    const Box<double> content = BoundScene::of(scene_).to_frame(bounds->world);
    check_box(name(instance) + "its leaf", content, box);
    return content;
  }

  void check_box(const std::string& what, const Box<double>& content, const Box<float>& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (content.low[k] >= box.low[k] && content.high[k] <= box.high[k]) continue;
      if (content.low[k] > content.high[k]) return;  // nothing below, already reported
      add(Errc::kBoxEscape, what + " does not hold what is below it on axis " + std::to_string(k));
      return;
    }
  }

  void check_instance(std::uint32_t instance) {
    const auto record =
        load<InstanceRecord>(OpenFile::of(file_).section(SectionKind::kInstances).data(), instance);
    const bool is_static = instance < BoundScene::of(scene_).record().static_count;
    if (is_static == ((record.flags & kInstanceMoves) != 0) ||
        (record.flags & ~kInstanceKnownFlags) != 0) {
      add(Errc::kRecordInvalid, name(instance) + "flags " + std::to_string(record.flags));
    }
    check_text(name(instance) + "its name", record.name_offset, record.name_bytes);
    const std::optional<BoundScene::Placed> placed = BoundScene::of(scene_).place(instance);
    const auto bounds = placed ? placed->bounds() : std::nullopt;
    if (!bounds) {
      add(Errc::kRecordInvalid, name(instance) + "its tree, layer or pose");
    } else if (is_static && bounds->condition > BoundScene::of(scene_).record().condition) {
      add(Errc::kRecordInvalid, name(instance) + "its condition is above the scene's");
    }
  }

  void check_text(const std::string& what, std::uint32_t offset, std::uint32_t bytes) {
    const Bytes names = OpenFile::of(file_).section(SectionKind::kNames);
    const Status status = cooker::check_text(names, offset, bytes, what);
    if (!status.ok()) add(status.error().code, status.error().detail);
  }

  void check_layers() {
    const std::uint32_t count = scene_.layer_count();
    for (std::uint32_t i = 0; i < count; ++i) {
      const LayerRecord layer = BoundScene::of(scene_).layer(i);
      const std::string what = "layer " + std::to_string(i) + ": ";
      check_text(what + "its name", layer.name_offset, layer.name_bytes);
      if ((layer.query_kinds & ~std::uint32_t{scene_.query_kinds()}) != 0) {
        add(Errc::kRecordInvalid, what + "answers queries that the scene does not");
      }
      for (std::uint32_t j = 0; j < i; ++j) {
        if (((layer.collides_with >> j) & 1u) ==
            ((BoundScene::of(scene_).layer(j).collides_with >> i) & 1u))
          continue;
        add(Errc::kRecordInvalid,
            what + "collides with layer " + std::to_string(j) + " one way only");
      }
    }
  }

  void check_left_out() {
    const Bytes bytes = OpenFile::of(file_).section(SectionKind::kLeftOut);
    for (std::size_t i = 0; i < bytes.size() / sizeof(LeftOutRecord); ++i) {
      const auto record = load<LeftOutRecord>(bytes.data(), i);
      const std::string what = "left out " + std::to_string(i) + ": ";
      check_text(what + "its reason", record.text_offset, record.text_bytes);
      if (record.reserved0 != 0 || record.reserved1 != 0 ||
          (record.owner != kNoOwner && record.owner >= file_.tree_count())) {
        add(Errc::kRecordInvalid, what + "its record");
      }
    }
  }

  // Lists may be shared: each is looked at once for each tree.
  void check_edges() {
    const BoundScene& scene = BoundScene::of(scene_);
    if (OpenFile::of(file_).section(SectionKind::kInstanceEdges).empty()) return;
    std::set<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>> checked;
    for (std::uint32_t i = 0; i < scene.record().static_count; ++i) {
      const EdgeListRow row = scene.edges().row(i);
      const std::string what = name(i) + "edges: ";
      if (!in_range(row.first, row.count, scene.edges().entry_count())) {
        add(Errc::kRecordInvalid, what + std::to_string(row.count) + " entries from " +
                                      std::to_string(row.first) + ", the section has " +
                                      std::to_string(scene.edges().entry_count()));
        continue;
      }
      const std::optional<InstanceRecord> record = scene.record_of(i);
      if (!record || !checked.insert({record->tree, row.first, row.count}).second) continue;
      check_edges_of(what, BoundTree::of(scene.trees()[record->tree]),
                     scene.edges().of_instance(i));
    }
  }

  void check_edges_of(const std::string& what, const BoundTree& tree, const InactiveEdges& edges) {
    for (std::uint32_t i = 0; i < edges.size(); ++i) {
      const ListedEdges listed = edges[i];
      const std::string entry = what + "entry " + std::to_string(i) + ": ";
      if (i > 0 && edges[i - 1].face >= listed.face) {
        add(Errc::kRecordInvalid,
            entry + "face " + std::to_string(listed.face) + " does not come after the one before");
      }
      if (listed.face >= tree.counts().faces_in_leaves) {
        add(Errc::kFaceOutOfRange, entry + "face " + std::to_string(listed.face) + ", limit " +
                                       std::to_string(tree.counts().faces_in_leaves));
      }
      if (listed.edges == 0) add(Errc::kRecordInvalid, entry + "no edge");
    }
  }

  const File& file_;
  const Scene& scene_;
  std::vector<bool> reached_;
  WalkBound bound_;
  std::uint32_t nodes_ = 0;
  std::uint32_t depth_ = 0;
  Findings findings_;
};

}  // namespace

Findings prove_scene(const File& file) {
  if (!file.has_scene()) return {};
  const Result<Scene> scene = bind_without_meshes(file);
  if (!scene) return {{scene.code(), "scene: " + scene.error().detail}};
  return SceneWalk(file, *scene).run();
}

}  // namespace boxtree::cooker
