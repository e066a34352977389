// SPDX-License-Identifier: MIT
// The stages in the order the data flows.
#include <algorithm>
#include <array>
#include <functional>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include <boxtree/cooker/build/face_boxes.h>
#include <boxtree/cooker/cook.h>
#include <boxtree/cooker/encode/encoders.h>
#include <boxtree/cooker/import/mesh_arrays.h>
#include <boxtree/cooker/version.h>
#include <boxtree/cooker/write/blob_writer.h>
#include <boxtree/format/limits.h>
#include <boxtree/runtime/primitive/triangle.h>

namespace boxtree::cooker {
namespace {

std::uint64_t hash_of(const SourceMesh& mesh) {
  const Result<std::uint64_t> hash = geometry_hash(arrays_of(mesh));
  return hash ? *hash : 0;  // import has checked every corner
}

std::uint32_t count_degenerate(const SourceMesh& mesh, const Frame& frame) {
  std::uint32_t count = 0;
  for (const Face& face : mesh.faces) {
    const std::size_t corners = face.is_quad() ? 4 : 3;
    const auto corner = [&](std::size_t i) {
      return frame.to_tree(mesh.positions[face.corner[i]]);
    };
    for (std::size_t i = 1; i + 1 < corners; ++i) {
      if (is_degenerate({{corner(0), corner(i), corner(i + 1)}})) ++count;
    }
  }
  return count;
}

Status check_limits(const SourceMesh& mesh, const CookOptions& options) {
  if (mesh.faces.size() > kMaxFaces || mesh.positions.size() > kMaxVertices) {
    return Error{Errc::kMeshTooLarge,
                 fmt::format("{}: {} faces, {} vertices, limit {}", mesh.name, mesh.faces.size(),
                             mesh.positions.size(), kMaxFaces)};
  }
  if (options.geometry != GeometryId::kExternal) return {};
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (mesh.face_id(i) == i) continue;
    return Error{Errc::kMeshUnsupported,
                 fmt::format("{}: geometry cannot stay external: face {} is split or follows a "
                             "split or skipped face, so the application's faces are not the tree's",
                             mesh.name, mesh.face_id(i))};
  }
  return {};
}

// packed-f64 holds digits that the boxes of an f32 mesh do not have: never smaller than packed-f32
// and never tighter, so that it is not tried unless asked for.
bool can_win(CodecId codec, const SourceMesh& mesh) {
  return codec != CodecId::kPackedF64 || mesh.positions.precision == Precision::kF64;
}

std::vector<CodecId> wanted_codecs(bool wide, const SourceMesh& mesh, const CookOptions& options) {
  std::vector<CodecId> wanted;
  for (const CodecInfo& codec : kCodecs) {
    if (is_wide(codec.id) != wide) continue;
    if (options.codec ? *options.codec == codec.id : can_win(codec.id, mesh)) {
      wanted.push_back(codec.id);
    }
  }
  return wanted;
}

// Proves a candidate and enters it into the list; returns whether it is the best so far.
bool enter(const EncodedTree& tree, const SourceMesh& mesh, const CookOptions& options,
           CookedTree& cooked) {
  cooked.candidates.push_back({tree.nodes.codec,
                               tree.nodes.bytes.size(),
                               tree.geometry.vertices.size() + tree.geometry.corners.size(),
                               tree.nodes.visits,
                               check_gates(tree, arrays_of(mesh)),
                               {}});
  return choose(cooked.candidates, options.goal) == cooked.candidates.size() - 1;
}

// A tree of nothing yet, with the frame that all builders choose.
BuildTree unbuilt_tree(const SourceMesh& mesh, Origin origin) {
  BuildTree tree;
  choose_frame(mesh.positions, origin, tree);
  return tree;
}

// What is cooked: a mesh, or what became of it on a grid.
struct Source {
  const SourceMesh& mesh;                        // as imported
  const std::optional<QuantisedMesh> quantised;  // or nothing
  EncodedTree known;                             // what every tree of it says, but for its bytes

  Source(const SourceMesh& imported, std::optional<QuantisedMesh> on_grid);

  [[nodiscard]] const SourceMesh& built() const { return quantised ? quantised->mesh : mesh; }
  [[nodiscard]] Origin origin() const { return quantised ? Origin::kZero : Origin::kByPrecision; }
};

Source::Source(const SourceMesh& imported, std::optional<QuantisedMesh> on_grid)
    : mesh(imported), quantised(std::move(on_grid)) {
  const BuildTree unbuilt = unbuilt_tree(built(), origin());
  known.name = mesh.name;
  known.origin = quantised ? quantised->origin : unbuilt.origin;
  known.scale_exponent = unbuilt.scale_exponent + (quantised ? quantised->step_exponent : 0);
  known.face_count = static_cast<std::uint32_t>(mesh.faces.size());
  known.triangle_count = static_cast<std::uint32_t>(mesh.triangle_count());
  known.degenerate_count = count_degenerate(built(), unbuilt.frame());
  known.geometry_hash = hash_of(mesh);
  known.positions_f64 = mesh.positions.precision == Precision::kF64;
}

EncodedGeometry encode_geometry(const Source& source, const CookOptions& options,
                                std::vector<std::uint32_t> order, LeafOrder leaf_order) {
  if (source.quantised) {
    return encode_grid_geometry(*source.quantised, std::move(order), leaf_order, options.face_ids);
  }
  return encode_exact_geometry(source.mesh, order, options.face_ids);
}

// Codecs that share a build tree and its order of faces, so that only nodes differ. The build tree
// itself is gone: memory, not time, is what candidates cost.
struct Family {
  EncodedTree tree;  // all but the nodes
  std::function<EncodedNodes(CodecId)> nodes_of;
};

// Codecs with one face a leaf.
Family binary_family(const Source& source, const CookOptions& options,
                     const std::vector<CodecId>& codecs) {
  const BuildTree build = build_tree(source.built(), options.builder, source.origin());
  const bool external = options.geometry == GeometryId::kExternal;
  Family family{source.known, {}};
  family.tree.faces_in_source_order = external;
  family.tree.geometry =
      external ? encode_external_geometry(source.mesh, {})
               : encode_geometry(source, options, faces_in_tree_order(build), LeafOrder::kFixed);
  const FaceOrder order = external ? FaceOrder::kSource : FaceOrder::kTree;
  std::array<EncodedNodes, 3> plain;  // by PlainCut
  const auto walk_for = [&](std::size_t i) {
    const auto cut = static_cast<PlainCut>(i);
    const bool is_wanted = std::any_of(codecs.begin(), codecs.end(),
                                       [&](CodecId codec) { return plain_cut_of(codec) == cut; });
    if (is_wanted) plain[i] = encode_plain(build, source.built(), cut, order);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, plain.size(), 1),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) walk_for(i);
                    });
  family.nodes_of = [plain = std::move(plain), widths = options.widths](CodecId codec) {
    return pack_nodes(plain[static_cast<std::size_t>(plain_cut_of(codec))], codec, widths);
  };
  return family;
}

// Codecs with full leaves, whose layout orders the faces.
Family wide_family(const Source& source, const CookOptions& options) {
  Family family{source.known, {}};
  WideLayout layout = lay_out_wide(build_full_leaves(source.built(), source.origin()));
  family.tree.geometry =
      options.geometry == GeometryId::kExternal
          ? encode_external_geometry(source.mesh, layout.face_order)
          : encode_geometry(source, options, std::move(layout.face_order), LeafOrder::kFree);
  layout.face_order = {};
  family.nodes_of = [layout = std::move(layout)](CodecId codec) {
    return encode_wide(layout, codec);
  };
  return family;
}

// Only the best candidate so far stays, of this family or of one before.
void try_family(Family family, const std::vector<CodecId>& codecs, const SourceMesh& mesh,
                const CookOptions& options, CookedTree& cooked) {
  EncodedTree& tree = family.tree;
  bool leads = false;
  for (const CodecId codec : codecs) {
    EncodedNodes best = std::exchange(tree.nodes, family.nodes_of(codec));
    if (enter(tree, mesh, options, cooked)) {
      leads = true;
      cooked.tree = {};
    } else {
      tree.nodes = std::move(best);
    }
  }
  if (leads) cooked.tree = std::move(tree);
}

nlohmann::ordered_json grid_record(const CookOptions& options) {
  if (options.geometry != GeometryId::kGrid) return nullptr;
  if (options.grid.tolerance) return {{"tolerance", *options.grid.tolerance}};
  return {{"bits", options.grid.bits}};
}

std::string cook_record(const CookOptions& options, const std::vector<CookedTree>& trees,
                        const std::vector<ImportReport>& imports) {
  nlohmann::ordered_json record;
  record["tool"] = fmt::format("boxtree {}", kVersion);
  record["options"] = {{"codec", options.codec ? std::string(codec_name(*options.codec)) : "auto"},
                       {"for", options.goal == Goal::kMemory  ? "memory"
                               : options.goal == Goal::kSpeed ? "speed"
                                                              : "balance"},
                       {"builder", options.builder == Builder::kPaper ? "paper" : "sah"},
                       {"widths", options.widths == FieldWidths::kExact ? "exact" : "estimated"},
                       {"geometry", geometry_name(options.geometry)},
                       {"grid", grid_record(options)},
                       {"face_ids", options.face_ids},
                       {"precision", options.import.precision == Precision::kF64 ? "f64" : "f32"},
                       {"skip_bad", options.import.skip_bad}};
  record["sources"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < imports.size(); ++i) {
    record["sources"].push_back({{"name", trees[i].tree.name},
                                 {"xxh3", fmt::format("{:016x}", imports[i].content_hash)},
                                 {"faces", imports[i].source_faces}});
  }
  return record.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

// One grid for all inputs, so that what touches still does. Each is imported for its bounds, and
// later again: memory, not time, is what inputs cost.
Result<Grid> scene_grid(const std::vector<std::filesystem::path>& inputs,
                        const CookOptions& options) {
  Eigen::AlignedBox3d bounds;
  for (const std::filesystem::path& input : inputs) {
    const Result<Imported> imported = import_mesh(input, options.import);
    if (!imported) return imported.error();
    bounds.extend(bounds_of(imported->mesh));
  }
  return choose_grid(bounds, options.grid);
}

// Keeps what the report tells of a tree and gives its bytes back.
void release(CookedTree& cooked) {
  cooked.tree.nodes.bytes = {};
  cooked.tree.geometry.vertices = {};
  cooked.tree.geometry.corners = {};
  cooked.tree.geometry.face_ids = {};
}

}  // namespace

Result<CookedTree> cook_mesh(const SourceMesh& mesh, const CookOptions& options,
                             const std::optional<Grid>& scene) {
  if (Status status = check_limits(mesh, options); !status) return status.error();
  std::optional<QuantisedMesh> quantised;
  if (options.geometry == GeometryId::kGrid) {
    const Result<Grid> grid = scene ? *scene : choose_grid(bounds_of(mesh), options.grid);
    if (!grid) return grid.error();
    quantised = quantise(mesh, *grid);
    const double tolerance = options.grid.tolerance.value_or(quantised->max_vertex_error);
    if (quantised->max_vertex_error > tolerance) {
      return Error{Errc::kMeshUnsupported,
                   fmt::format("{}: double precision so far from zero moves a vertex by {}",
                               mesh.name, quantised->max_vertex_error)};
    }
  }
  const Source source(mesh, std::move(quantised));
  CookedTree cooked;
  if (const auto codecs = wanted_codecs(false, source.built(), options); !codecs.empty()) {
    try_family(binary_family(source, options, codecs), codecs, mesh, options, cooked);
  }
  if (const auto codecs = wanted_codecs(true, source.built(), options); !codecs.empty()) {
    try_family(wide_family(source, options), codecs, mesh, options, cooked);
  }
  if (!choose(cooked.candidates, options.goal)) {
    return Error{Errc::kInternal, mesh.name + ": no encoding passes its gates"};
  }
  if (source.quantised) {
    // In a frame of its own: that of the grid may be far too coarse to tell triangles from points.
    const Frame frame = unbuilt_tree(mesh, Origin::kByPrecision).frame();
    const std::uint32_t before = count_degenerate(mesh, frame);
    cooked.collapsed =
        cooked.tree.degenerate_count - std::min(before, cooked.tree.degenerate_count);
  }
  if (!options.face_ids) {
    cooked.left_out.push_back(
        {"face_ids", std::uint64_t{cooked.tree.face_count} * 4, "--no-face-ids"});
  }
  return cooked;
}

Result<EncodedTree> cook_as(const SourceMesh& mesh, CodecId codec, CookOptions options) {
  options.codec = codec;
  Result<CookedTree> cooked = cook_mesh(mesh, options);
  if (!cooked) return cooked.error();
  return std::move(cooked->tree);
}

Result<CookReport> cook(const std::vector<std::filesystem::path>& inputs,
                        const std::filesystem::path& output, const CookOptions& options,
                        const Progress& progress) {
  const auto step = [&](const std::string& what) {
    if (progress) progress(what);
  };
  const bool is_scene = options.geometry == GeometryId::kGrid && inputs.size() > 1;
  std::optional<Grid> scene;
  if (is_scene) {
    step("measure the scene");
    Result<Grid> grid = scene_grid(inputs, options);
    if (!grid) return grid.error();
    scene = *grid;
  }
  CookReport report;
  std::vector<EncodedTree> trees;
  for (const std::filesystem::path& input : inputs) {
    const std::string name = input.filename().string();
    step("import " + name);
    Result<Imported> imported = import_mesh(input, options.import);
    if (!imported) return imported.error();
    imported->mesh.name = input.stem().string();
    step("build " + name);
    Result<CookedTree> cooked = cook_mesh(imported->mesh, options, scene);
    if (!cooked) return cooked.error();
    imported->mesh = {};
    trees.push_back(std::move(cooked->tree));
    cooked->tree.name = trees.back().name;
    report.trees.push_back(std::move(*cooked));
    report.imports.push_back(std::move(imported->report));
  }
  step("write " + output.filename().string());
  const std::string record =
      options.cook_record ? cook_record(options, report.trees, report.imports) : std::string();
  const Status written = options.blob ? write_blob(output, trees, record, *options.blob)
                                      : write_file(output, trees, record);
  if (!written) return written.error();
  for (std::size_t i = 0; i < trees.size(); ++i) {
    report.trees[i].tree = std::move(trees[i]);
    release(report.trees[i]);
  }
  return report;
}

}  // namespace boxtree::cooker
