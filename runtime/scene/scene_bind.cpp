// SPDX-License-Identifier: MIT
// Binding a scene: the checks that let queries trust counts and section sizes.
#include <algorithm>
#include <memory>
#include <utility>

#include "format/message.h"
#include "runtime/file/section.h"
#include "runtime/primitive/float_state.h"
#include "runtime/scene/bound_scene.h"

namespace boxtree {

BoundScene::Owner BoundScene::make(const Memory& memory) {
  void* const place = allocate(&memory, sizeof(BoundScene), alignof(BoundScene));
  return Owner(::new (place) BoundScene(memory));
}

Result<Scene> BoundScene::bind(const File& file, const SceneOptions& options) {
  const DefaultFloatState state;
  Owner scene = make(options.memory);
  if (Status status = scene->bind_sections(file); !status) return status.error();
  if (Status status = scene->bind_trees(file, options); !status) return status.error();
  if (Status status = scene->check_parts(options); !status) return status.error();
  Array<std::uint32_t> moving(options.moving.begin(), options.moving.end(), &scene->memory_);
  for (std::uint32_t i = scene->record().static_count; i < scene->instance_count(); ++i) {
    moving.push_back(i);
  }
  if (Status status = scene->bind_moving(std::move(moving)); !status) return status.error();
  return Scene(std::move(scene));
}

Status BoundScene::bind_sections(const File& opened) {
  const OpenFile& file = OpenFile::of(opened);
  const Bytes section = file.section(SectionKind::kScene);
  if (section.empty()) {
    return Error{Errc::kNoScene,
                 file.is_pack() ? "a pack has none; bind a member of it (File::member)" : ""};
  }
  const auto sized = [&](SectionKind kind, std::uint64_t count, std::uint64_t element) {
    return sized_section(file.section(kind), kind, count, element);
  };
  if (const auto found = sized(SectionKind::kScene, 1, sizeof(SceneRecord)); !found) {
    return found.error();
  }
  SceneRecord& record = top_.scene;
  record = load<SceneRecord>(section.data(), 0);
  if (Status status = check_scene_record(record); !status) return status;
  frame_ = Frame(record.origin, record.scale_exponent);
  const auto nodes = sized(SectionKind::kSceneNodes, record.node_count, sizeof(Wide8Node));
  const auto instances =
      sized(SectionKind::kInstances, record.instance_count, sizeof(InstanceRecord));
  const auto poses =
      sized(SectionKind::kPoses, record.instance_count, kNumbersOfPose * record.pose_bytes);
  const auto layers = sized(SectionKind::kLayers, record.layer_count, sizeof(LayerRecord));
  const auto materials =
      sized(SectionKind::kMaterials, record.material_count, sizeof(MaterialRecord));
  for (const auto* found : {&nodes, &instances, &poses, &layers, &materials}) {
    if (!*found) return found->error();
  }
  // A leaf of the top level is one instance: as many leaves as static instances.
  top_.codec = {*nodes, record.node_count, record.static_count * kLeafFaces};
  instances_ = *instances;
  poses_ = *poses;
  layers_ = *layers;
  names_ = file.section(SectionKind::kNames);
  materials_ = MaterialNames(file.section(SectionKind::kMaterials), names_);
  const Bytes edges = file.section(SectionKind::kInstanceEdges);
  if (!InstanceEdgesView::are_rows_inside(edges.size(), record.static_count)) {
    return error_with(Errc::kSectionSize, section_text(SectionKind::kInstanceEdges),
                      ": # bytes, expected 8 for each of # instances, and a multiple of 4",
                      {edges.size(), record.static_count});
  }
  edges_ = InstanceEdgesView(edges, record.static_count);
  left_out_ = file.section(SectionKind::kLeftOut);
  if (left_out_.size() % sizeof(LeftOutRecord) != 0) {
    return error_with(Errc::kSectionSize, section_text(SectionKind::kLeftOut), ": # bytes",
                      {left_out_.size()});
  }
  return {};
}

Status BoundScene::bind_trees(const File& file, const SceneOptions& options) {
  trees_.reserve(file.tree_count());
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    BindOptions bind{.require_active_edges = options.require_active_edges,
                     .require_user_data = options.require_user_data};
    for (const SceneMeshArrays& mesh : options.meshes) {
      if (mesh.tree == i) bind.mesh = mesh.arrays;
    }
    Result<Tree> tree = Tree::bind(file, i, bind);
    if (!tree) return tree.error();
    if (options.require_face_ids && !tree->has_face_ids() && !tree->empty()) {
      return left_out(Part::kFaceIds, i, "tree " + std::to_string(std::uint64_t{i}));
    }
    trees_.push_back(std::move(*tree));
  }
  return {};
}

Status BoundScene::check_parts(const SceneOptions& options) const {
  const auto is_needed = [&](QueryKinds kind) {
    return (options.queries & kind) != 0 && (record().query_kinds & kind) == 0;
  };
  const std::string scene = "the scene";
  if (is_needed(kRayQueries)) return left_out(Part::kRays, kNoOwner, scene);
  if (is_needed(kBoxQueries)) return left_out(Part::kBoxes, kNoOwner, scene);
  if (is_needed(kPointQueries)) return left_out(Part::kPoints, kNoOwner, scene);
  if (is_needed(kPairQueries)) return left_out(Part::kPairs, kNoOwner, scene);
  if (options.require_materials && material_count() == 0) {
    return left_out(Part::kMaterials, kNoOwner, scene);
  }
  if (options.require_names && !has_names()) return left_out(Part::kNames, kNoOwner, scene);
  return {};
}

namespace {

// Where a file records no reason: what a cook leaves such parts out by.
std::string unrecorded_reason(Part part) {
  const bool is_of_source = part == Part::kMaterials || part == Part::kNames;
  const char* const key = part == Part::kMaterials ? "materials = false"
                          : part == Part::kNames   ? "names = false"
                          : part == Part::kFaceIds ? "face_ids = false"
                                                   : "queries";
  return std::string(" when it was cooked, by ") + key + " of its profile" +
         (is_of_source ? ", or its source has none" : "");
}

}  // namespace

// The error for a part that was left out, with the reason if the file records one: for the tree,
// else for the whole scene, else for any tree.
Error BoundScene::left_out(Part part, std::uint32_t owner, const std::string& what) const {
  const std::size_t count = left_out_.size() / sizeof(LeftOutRecord);
  std::string_view reason;
  int best = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto record = load<LeftOutRecord>(left_out_.data(), i);
    if (record.part != part) continue;
    const int fit = record.owner == owner ? 3 : record.owner == kNoOwner ? 2 : 1;
    if (fit <= best) continue;
    best = fit;
    reason = text(record.text_offset, record.text_bytes);
  }
  return {Errc::kPartLeftOut,
          what + ": " + std::string(part_name(part)) + " were left out" +
              (reason.empty() ? unrecorded_reason(part) : " by " + std::string(reason))};
}

bool BoundScene::has_names() const noexcept {
  for (std::uint32_t i = 0; i < instance_count(); ++i) {
    if (instance(i).name_bytes != 0) return true;
  }
  return instance_count() == 0;
}

Status BoundScene::make_movable(std::uint32_t instance) {
  const DefaultFloatState state;
  const Moving* const known = find_moving(instance);
  if (known == nullptr) return bind_moving(Array<std::uint32_t>(1, instance, &memory_));
  moving_[static_cast<std::size_t>(known - moving_.data())].placed.at_rest = false;
  return {};
}

// Adds instances to those that move, all or none of them.
Status BoundScene::bind_moving(Array<std::uint32_t> numbers) {
  bool detaches = has_detached_;
  for (const std::uint32_t number : numbers) {
    if (number >= instance_count()) {
      return index_error(Errc::kInstanceIndex, "instance", number, instance_count());
    }
    detaches |= number < record().static_count;
  }
  for (const Moving& moving : moving_) numbers.push_back(moving.instance);
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  Array<Moving> moving(&memory_);
  for (const std::uint32_t number : numbers) {
    if (const Moving* const known = find_moving(number); known != nullptr) {
      moving.push_back(Moving(*known));  // moved as the others, so that vector grows in one way
      continue;
    }
    const auto corrupt = [number](const char* what) {
      return error_with(Errc::kRecordInvalid, {}, what, {number});
    };
    const std::optional<Placed> placed = place(number);
    if (!placed) return corrupt("instance #: its record");
    const auto bounds = placed->bounds();
    if (!bounds) return corrupt("instance #: its pose");
    moving.push_back({number, *placed, *bounds});
    moving.back().placed.inactive = {};  // it may leave those beside it
  }
  take_moving(moving);
  has_detached_ = detaches;
  return {};
}

void BoundScene::take_moving(Array<Moving>& moving) {
  Largest conditions(moving.size(), &memory_);
  for (std::size_t i = 0; i < moving.size(); ++i) conditions.set(i, moving[i].bounds.condition);
  build_over(moving);
  // Nothing from here on allocates.
  moving_.swap(moving);
  conditions_.swap(conditions);
}

}  // namespace boxtree
