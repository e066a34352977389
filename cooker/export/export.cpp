// SPDX-License-Identifier: MIT
// Selects and checks all parts to export, then writes them.
#include "cooker/export/export.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "cooker/export/glb_writer.h"
#include "cooker/export/obj_writer.h"
#include "cooker/export/placed_shape.h"
#include "cooker/import/text_tokens.h"
#include "cooker/write/byte_sink.h"

namespace boxtree::cooker {
namespace {

Status check_levels(std::span<const Tree> trees, const std::vector<LevelRange>& levels) {
  std::uint32_t deepest = 0;
  for (const Tree& tree : trees) deepest = std::max(deepest, BoundTree::of(tree).depth());
  for (const LevelRange& range : levels) {
    if (range.first > deepest) {
      return Error{Errc::kInvalidQuery,
                   fmt::format("no boxes on level {}: the deepest is {}", range.first, deepest)};
    }
    if (range.last < range.first) {
      return Error{Errc::kInvalidQuery,
                   fmt::format("levels {} to {} are none", range.first, range.last)};
    }
  }
  return {};
}

Result<ShownTree> choose_parts(const Tree& tree, std::size_t number, const ExportOptions& options) {
  ShownTree shown{tree, std::string(tree.name()), std::nullopt, {}};
  if (shown.name.empty()) shown.name = fmt::format("tree {}", number);
  if (options.triangles) {
    const ExportOrder order =
        options.order.value_or(tree.has_face_ids() ? ExportOrder::kSource : ExportOrder::kTree);
    Result<DecodedFaces> faces = DecodedFaces::decode(tree, order);
    if (!faces) return faces.error();
    shown.faces = std::move(*faces);
  }
  Result<std::vector<BoxGroup>> boxes = find_groups(tree, options.levels, options.leaves);
  if (!boxes) return boxes.error();
  shown.boxes = std::move(*boxes);
  return shown;
}

ExportedTree report_of(const ShownTree& shown, bool is_glb) {
  ExportedTree report;
  report.name = shown.name;
  if (shown.faces) {
    report.vertices = shown.faces->vertex_count();
    report.faces = shown.faces->face_count();
    report.triangles = shown.faces->triangle_count();
  }
  report.boxes = shown.boxes;
  if (is_glb) report.translation = glb_translation(shown.tree);
  return report;
}

ExportReport report_of(const Shown& shown, bool is_glb) {
  ExportReport report;
  for (const ShownTree& tree : shown.trees) report.trees.push_back(report_of(tree, is_glb));
  if (!shown.instances) return report;
  report.instances = shown.instances->size();
  for (const ShownInstance& instance : *shown.instances) {
    ExportedTree& tree = report.trees[instance.tree];
    ++tree.instances;
    report.placed_triangles += tree.triangles;
  }
  return report;
}

// `is_chosen(i)`: whether tree i is exported.
template <class IsChosen>
Result<std::vector<ShownTree>> choose_trees(std::span<const Tree> trees,
                                            const ExportOptions& options, IsChosen is_chosen) {
  if (Status status = check_levels(trees, options.levels); !status) return status.error();
  std::vector<ShownTree> shown;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    if (!is_chosen(i)) continue;
    Result<ShownTree> parts = choose_parts(trees[i], i, options);
    if (!parts) return parts.error();
    shown.push_back(std::move(*parts));
  }
  return shown;
}

// All instances by id, which is their order in the source; `tree` as the scene numbers them.
Result<std::vector<ShownInstance>> read_instances(const Scene& scene) {
  std::vector<std::pair<std::uint32_t, ShownInstance>> by_id;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Result<InstanceInfo> info = scene.info(i);
    if (!info) return info.error();
    const Result<Pose> pose = scene.pose(i);
    if (!pose) return pose.error();
    std::string name(info->name);
    if (name.empty()) name = fmt::format("instance {}", i);
    by_id.push_back({info->id, {std::move(name), info->tree, *pose}});
  }
  std::stable_sort(by_id.begin(), by_id.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<ShownInstance> instances;
  instances.reserve(by_id.size());
  for (auto& [id, instance] : by_id) instances.push_back(std::move(instance));
  return instances;
}

// The bounds of all exported parts of a tree.
Box<double> bounds_of(const ShownTree& shown) {
  Eigen::AlignedBox3d bounds(glb_translation(shown.tree));
  for (std::uint32_t v = 0; shown.faces && v < shown.faces->vertex_count(); ++v) {
    bounds.extend(shown.faces->position(v));
  }
  for (const BoxGroup& group : shown.boxes) {
    visit_group(shown.tree, group, [&](const Box<double>& box) {
      bounds.extend(BoundTree::of(shown.tree).to_object(box));
    });
  }
  return {{bounds.min()[0], bounds.min()[1], bounds.min()[2]},
          {bounds.max()[0], bounds.max()[1], bounds.max()[2]}};
}

// The hull of the bounds contains the results of apply() for all points within, rounding included.
Status check_poses(const Shown& shown) {
  std::vector<Box<double>> bounds;
  for (const ShownTree& tree : shown.trees) bounds.push_back(bounds_of(tree));
  for (const ShownInstance& instance : *shown.instances) {
    const Box<double> image = map_of(instance.pose).hull(bounds[instance.tree]);
    for (std::size_t k = 0; k < 3; ++k) {
      if (std::isfinite(image.low[k]) && std::isfinite(image.high[k])) continue;
      return Error{Errc::kRecordInvalid,
                   fmt::format("{}: its pose leads beyond the numbers of f64", instance.name)};
    }
  }
  return {};
}

Result<Shown> choose_scene(const Scene& scene, std::span<const Tree> trees,
                           const ExportOptions& options) {
  Result<std::vector<ShownInstance>> instances = read_instances(scene);
  if (!instances) return instances.error();
  std::vector<std::uint32_t> number(trees.size(), 0);  // index among the exported trees
  for (const ShownInstance& instance : *instances) number[instance.tree] = 1;
  Result<std::vector<ShownTree>> chosen =
      choose_trees(trees, options, [&](std::size_t i) { return number[i] != 0; });
  if (!chosen) return chosen.error();
  std::exclusive_scan(number.begin(), number.end(), number.begin(), 0u);
  for (ShownInstance& instance : *instances) instance.tree = number[instance.tree];
  Shown shown{std::move(*chosen), std::move(*instances)};
  if (Status status = check_poses(shown); !status) return status.error();
  return shown;
}

Result<ExportReport> write_file(const Shown& shown, const OutputTarget& output, bool is_glb,
                                bool solid_boxes) {
  Result<AtomicFile> file = AtomicFile::create(output);
  if (!file) return file.error();
  ByteSink sink(*file);
  if (is_glb) {
    if (Status status = write_glb(shown, solid_boxes, sink); !status) return status.error();
  } else {
    write_obj(shown, solid_boxes, sink);
  }
  if (Status status = sink.finish(); !status) return status.error();
  ExportReport report = report_of(shown, is_glb);
  report.bytes = sink.size();
  if (Status status = file->commit(); !status) return status.error();
  return report;
}

}  // namespace

Result<bool> is_glb_name(const std::filesystem::path& output) {
  if (has_extension(output, "glb")) return true;
  if (has_extension(output, "obj")) return false;
  return Error{Errc::kInvalidQuery, output.string() + ": expected a name in .obj or .glb"};
}

Result<ExportReport> export_trees(std::span<const Tree> trees, const OutputTarget& output,
                                  const ExportOptions& options) {
  const Result<bool> is_glb = is_glb_name(output.path);
  if (!is_glb) return is_glb.error();
  Result<std::vector<ShownTree>> chosen =
      choose_trees(trees, options, [](std::size_t) { return true; });
  if (!chosen) return chosen.error();
  return write_file({std::move(*chosen), std::nullopt}, output, *is_glb, options.solid_boxes);
}

Result<ExportReport> export_scene(const Scene& scene, std::span<const Tree> trees,
                                  const OutputTarget& output, const ExportOptions& options) {
  const Result<bool> is_glb = is_glb_name(output.path);
  if (!is_glb) return is_glb.error();
  const Result<Shown> shown = choose_scene(scene, trees, options);
  if (!shown) return shown.error();
  return write_file(*shown, output, *is_glb, options.solid_boxes);
}

}  // namespace boxtree::cooker
