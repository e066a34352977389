// SPDX-License-Identifier: MIT
// Choose and check all that is shown, then write it.
#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <boxtree/cooker/export/byte_sink.h>
#include <boxtree/cooker/export/export.h>
#include <boxtree/cooker/export/glb_writer.h>
#include <boxtree/cooker/export/obj_writer.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

Status check_levels(std::span<const Tree> trees, const std::vector<LevelRange>& levels) {
  std::uint32_t deepest = 0;
  for (const Tree& tree : trees) deepest = std::max(deepest, tree.record().depth);
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

}  // namespace

Result<ExportReport> export_trees(std::span<const Tree> trees, const std::filesystem::path& output,
                                  const ExportOptions& options) {
  const bool is_glb = has_extension(output, "glb");
  if (!is_glb && !has_extension(output, "obj")) {
    return Error{Errc::kInvalidQuery, output.string() + ": expected a name in .obj or .glb"};
  }
  if (Status status = check_levels(trees, options.levels); !status) return status.error();
  std::vector<ShownTree> shown;
  ExportReport report;
  for (const Tree& tree : trees) {
    Result<ShownTree> parts = choose_parts(tree, shown.size(), options);
    if (!parts) return parts.error();
    shown.push_back(std::move(*parts));
    report.trees.push_back(report_of(shown.back(), is_glb));
  }
  Result<AtomicFile> file = AtomicFile::create(output);
  if (!file) return file.error();
  ByteSink sink(*file);
  if (is_glb) {
    if (Status status = write_glb(shown, options.solid_boxes, sink); !status) return status.error();
  } else {
    write_obj(shown, options.solid_boxes, sink);
  }
  if (Status status = sink.finish(); !status) return status.error();
  report.bytes = sink.size();
  if (Status status = file->commit(); !status) return status.error();
  return report;
}

}  // namespace boxtree::cooker
