// SPDX-License-Identifier: MIT
// Records and sections of a scene.
#include "cooker/encode/encoded_scene.h"

#include <algorithm>
#include <cstring>
#include <limits>

#include <fmt/format.h>

#include "cooker/encode/append.h"
#include "cooker/text/pose_fault.h"
#include "format/container.h"
#include "format/instance_edges.h"
#include "runtime/primitive/float_state.h"
#include "runtime/scene/placement.h"

namespace boxtree::cooker {
namespace {

class SceneEncoder {
 public:
  SceneEncoder(std::span<const EncodedTree> trees, const SceneParts& parts, std::string& names)
      : trees_(trees), parts_(parts), names_(names) {}

  Result<EncodedScene> run() {
    if (parts_.instances.size() > kMaxInstances) {
      return Error{Errc::kMeshTooLarge,
                   fmt::format("{} instances, limit {}", parts_.instances.size(), kMaxInstances)};
    }
    if (Status status = order_instances(); !status) return status.error();
    write_instances();
    write_layers();
    write_materials();
    write_left_out();
    if (Status status = write_instance_edges(); !status) return status.error();
    write_record();
    if (!names_.fits()) {
      return Error{Errc::kMeshTooLarge, "names take more than 4 GiB"};
    }
    return std::move(out_);
  }

 private:
  // Static instances in the order of the top level's leaves, then moving ones.
  Status order_instances() {
    std::vector<std::uint32_t> resting;
    std::vector<Box<double>> boxes, moving_boxes;
    for (std::uint32_t i = 0; i < parts_.instances.size(); ++i) {
      const PlacedTree& instance = parts_.instances[i];
      const EncodedTree& tree = trees_[instance.tree];
      const Frame frame(tree.origin, tree.scale_exponent);
      const std::optional<Placement> placed = Placement::make(frame, instance.pose);
      const auto bounds = placed ? placed->bounds(tree.nodes.root_box) : std::nullopt;
      if (!bounds) {
        return Error{
            Errc::kInvalidPose,
            fmt::format("{}instance {} '{}': its transform {}",
                        instance.line == 0 ? std::string()
                                           : fmt::format("{}:{}: ", parts_.profile, instance.line),
                        instance.id, instance.name, pose_fault(instance.pose))};
      }
      if (instance.moves) {
        order_.push_back(i);
        moving_boxes.push_back(bounds->world);
      } else {
        resting.push_back(i);
        boxes.push_back(bounds->world);
        condition_ = std::max(condition_, bounds->condition);
      }
    }
    std::sort(order_.begin(), order_.end(), [this](std::uint32_t a, std::uint32_t b) {
      return parts_.instances[a].id < parts_.instances[b].id;
    });
    top_ = build_top_level(boxes, moving_boxes);
    std::vector<std::uint32_t> leaves;
    leaves.reserve(parts_.instances.size());
    for (const std::uint32_t leaf : top_.order) leaves.push_back(resting[leaf]);
    order_.insert(order_.begin(), leaves.begin(), leaves.end());
    return {};
  }

  void write_instances() {
    const auto fits_f32 = [](const PlacedTree& instance) {
      const auto numbers = instance.pose.matrix().topRows<3>();
      return (numbers.cast<float>().cast<double>().array() == numbers.array()).all();
    };
    has_f32_poses_ = std::all_of(parts_.instances.begin(), parts_.instances.end(), fits_f32);
    for (const std::uint32_t i : order_) {
      const PlacedTree& instance = parts_.instances[i];
      const NameTable::Name name =
          names_.add(instance.name, std::numeric_limits<std::uint16_t>::max());
      append(out_.instances, InstanceRecord{instance.tree, instance.id, name.offset,
                                            static_cast<std::uint16_t>(name.bytes),
                                            static_cast<std::uint8_t>(instance.layer),
                                            instance.moves ? kInstanceMoves : std::uint8_t{0}});
      for (Eigen::Index row = 0; row < 3; ++row) {
        for (Eigen::Index column = 0; column < 4; ++column) {
          const double number = instance.pose.matrix()(row, column);
          if (has_f32_poses_) {
            append(out_.poses, static_cast<float>(number));
          } else {
            append(out_.poses, number);
          }
        }
      }
    }
  }

  void write_layers() {
    for (const SceneLayer& layer : parts_.layers) {
      const NameTable::Name name = names_.add(layer.name);
      append(out_.layers, LayerRecord{layer.collides_with,
                                      static_cast<QueryKinds>(layer.queries & parts_.queries),
                                      name.offset, name.bytes});
    }
  }

  void write_materials() {
    out_.materials = encode_materials(parts_.materials, parts_.tree_materials, names_);
  }

  void write_left_out() {
    for (const LeftOutPart& part : parts_.left_out) {
      const NameTable::Name text = names_.add(part.text);
      append(out_.left_out,
             LeftOutRecord{part.part, 0, part.owner, part.line, text.offset, text.bytes, 0});
    }
  }

  Status write_instance_edges() {
    if (parts_.edge_lists.empty()) return {};
    std::vector<EdgeListRow> lists;
    std::uint64_t entries = 0;
    for (const std::vector<std::uint32_t>& list : parts_.edge_lists) {
      lists.push_back(
          {static_cast<std::uint32_t>(entries), static_cast<std::uint32_t>(list.size())});
      entries += list.size();
    }
    constexpr std::uint64_t kMost = std::numeric_limits<std::uint32_t>::max();
    if (entries > kMost) {
      return Error{Errc::kMeshTooLarge,
                   fmt::format("edges where instances meet: {} faces, limit {}", entries, kMost)};
    }
    for (const std::uint32_t leaf : std::span(order_).first(top_.order.size())) {
      const auto& list = parts_.instances[leaf].edge_list;
      append(out_.instance_edges, list ? lists[*list] : EdgeListRow{});
    }
    for (const std::vector<std::uint32_t>& list : parts_.edge_lists) {
      for (const std::uint32_t entry : list) append(out_.instance_edges, entry);
    }
    return {};
  }

  void write_record() {
    SceneRecord record{};
    record.instance_count = static_cast<std::uint32_t>(parts_.instances.size());
    record.static_count = static_cast<std::uint32_t>(top_.order.size());
    record.node_count = top_.nodes.node_count;
    record.root = top_.nodes.root;
    record.depth = top_.nodes.depth;
    record.pose_bytes = has_f32_poses_ ? sizeof(float) : sizeof(double);
    record.layer_count = static_cast<std::uint8_t>(parts_.layers.size());
    record.query_kinds = parts_.queries;
    record.scale_exponent = top_.scale_exponent;
    record.material_count = static_cast<std::uint32_t>(parts_.materials.size());
    record.origin = top_.origin;
    record.root_low = top_.nodes.root_box.low;
    record.root_high = top_.nodes.root_box.high;
    record.condition = condition_;
    append(out_.scene, record);
    out_.nodes = std::move(top_.nodes.bytes);
  }

  std::span<const EncodedTree> trees_;
  const SceneParts& parts_;
  NameTable names_;
  EncodedTopLevel top_;
  std::vector<std::uint32_t> order_;
  double condition_ = 0;
  bool has_f32_poses_ = true;
  EncodedScene out_;
};

}  // namespace

Result<EncodedScene> encode_scene(std::span<const EncodedTree> trees, const SceneParts& parts,
                                  std::string& names) {
  const DefaultFloatState state;
  return SceneEncoder(trees, parts, names).run();
}

}  // namespace boxtree::cooker
