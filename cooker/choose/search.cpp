// SPDX-License-Identifier: MIT
// Tries codecs by families; each family has its own tree.
#include "cooker/choose/search.h"

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "cooker/build/face_boxes.h"
#include "cooker/encode/active_edges.h"
#include "cooker/encode/face_ids.h"
#include "cooker/import/mesh_arrays.h"
#include "format/limits.h"
#include "runtime/primitive/float_state.h"
#include "runtime/primitive/triangle.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

std::uint32_t count_degenerate(const MeshView& mesh, const Frame& frame) {
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

Status check_limits(const SourceMesh& mesh, const SearchOptions& options) {
  if (mesh.faces.size() > kMaxFaces || mesh.positions.size() > kMaxVertices) {
    return Error{Errc::kMeshTooLarge,
                 fmt::format("{} faces, {} vertices, limit {}", mesh.faces.size(),
                             mesh.positions.size(), kMaxFaces)};
  }
  if (options.geometry != GeometryId::kExternal) return {};
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    if (mesh.face_id(i) == i) continue;
    return Error{
        Errc::kMeshUnsupported,
        fmt::format("geometry cannot stay external: face {} is split or follows a split or "
                    "skipped face, so the application's faces are not the tree's",
                    mesh.face_id(i))};
  }
  return {};
}

// A tree without nodes, with the frame that all builders choose.
BuildTree unbuilt_tree(const MeshView& mesh, Origin origin) {
  BuildTree tree;
  choose_frame(mesh.positions, origin, tree);
  return tree;
}

// The mesh to cook, and its positions on a grid if geometry is on one.
struct Source {
  const SourceMesh& mesh;                             // as imported
  const std::optional<QuantisedPositions> quantised;  // or nothing
  const bool is_part;                                 // SearchOptions::is_part, of f32
  EncodedTree known;                                  // shared by all its trees
  Duplicates duplicates;                              // of the mesh that is built

  Source(const SourceMesh& imported, std::optional<QuantisedPositions> on_grid, bool is_part);

  [[nodiscard]] MeshView built() const {
    return quantised ? MeshView(mesh, quantised->positions) : MeshView(mesh);
  }
  [[nodiscard]] Origin origin() const {
    return quantised || is_part ? Origin::kZero : Origin::kByPrecision;
  }
};

Source::Source(const SourceMesh& imported, std::optional<QuantisedPositions> on_grid, bool of_part)
    : mesh(imported),
      quantised(std::move(on_grid)),
      is_part(of_part && imported.positions.precision == Precision::kF32) {
  const BuildTree unbuilt = unbuilt_tree(built(), origin());
  known.name = mesh.name;
  known.origin = quantised ? quantised->origin : unbuilt.origin;
  known.scale_exponent = unbuilt.scale_exponent + (quantised ? quantised->step_exponent : 0);
  known.face_count = static_cast<std::uint32_t>(mesh.faces.size());
  known.triangle_count = static_cast<std::uint32_t>(mesh.triangle_count());
  known.degenerate_count = count_degenerate(built(), unbuilt.frame());
  known.geometry_hash = hash_of(mesh);
  known.positions_f64 = mesh.positions.precision == Precision::kF64;
  duplicates = find_duplicates(built());
}

// Adds the ids of the faces in `order`. A tree in the order of its source needs none; nor does one
// without faces.
void add_face_ids(const Source& source, const SearchOptions& options,
                  std::span<const std::uint32_t> order, EncodedTree& tree) {
  const bool external = options.geometry == GeometryId::kExternal;
  const bool are_wanted = options.face_ids || external;  // through them, leaves have faces
  if (is_in_source_order(source.mesh, order)) {
    tree.faces_in_source_order = are_wanted;
    return;
  }
  std::vector<std::byte> ids = encode_face_ids(source.mesh, order);
  tree.geometry.face_id_bytes = ids.size();
  if (are_wanted) tree.geometry.face_ids = std::move(ids);
}

// The geometry of the faces in `order`, followed by their duplicates.
void encode_geometry(const Source& source, const SearchOptions& options,
                     std::vector<std::uint32_t> order, LeafOrder leaf_order, EncodedTree& tree) {
  const bool has_duplicates = source.duplicates.count > 0;
  const auto encode_clusters = [&](LeafOrder faces) {
    return source.quantised
               ? encode_grid_geometry(source.mesh.faces, *source.quantised, order, faces)
               : encode_exact_geometry(source.mesh, source.known.origin, order, faces);
  };
  if (has_clusters(options.geometry) && has_duplicates && leaf_order == LeafOrder::kFree) {
    // The order of the originals decides the order of their duplicates, so clusters come first.
    static_cast<void>(encode_clusters(leaf_order));
    leaf_order = LeafOrder::kFixed;
  }
  const std::vector<std::uint32_t> originals =
      append_duplicates(source.built(), source.duplicates, order);
  if (options.geometry == GeometryId::kExternal) {
    tree.geometry = encode_external_geometry();
  } else if (options.geometry == GeometryId::kArrays) {
    tree.geometry = encode_array_geometry(source.mesh, order);
  } else {
    tree.geometry = encode_clusters(leaf_order);
  }
  encode_duplicates(originals, tree.geometry);
  add_face_ids(source, options, order, tree);
  if (options.active_edges || options.face_order) tree.face_order = std::move(order);
}

// Codecs that share a build tree and its order of faces; only their nodes differ. The build tree is
// freed: candidates cost memory rather than time.
struct Family {
  EncodedTree tree;  // all except the nodes
  std::function<EncodedNodes(CodecId)> nodes_of;
};

// Codecs with one triangle per leaf.
Family binary_family(const Source& source, const SearchOptions& options,
                     const std::vector<CodecId>& codecs) {
  const BuildTree build =
      build_tree(source.built(), options.builder, source.origin(), source.duplicates);
  Family family{source.known, {}};
  // Nodes may hold the source's face numbers. Duplicates follow all other faces, which is not the
  // order of the source.
  const bool hold_source_numbers =
      options.geometry == GeometryId::kExternal && source.duplicates.count == 0;
  if (hold_source_numbers) {
    family.tree.faces_in_source_order = true;
    family.tree.geometry = encode_external_geometry();
    if (options.active_edges || options.face_order) {
      family.tree.face_order.resize(source.mesh.faces.size());
      std::iota(family.tree.face_order.begin(), family.tree.face_order.end(), 0u);
    }
  } else {
    encode_geometry(source, options, faces_in_tree_order(build), LeafOrder::kFixed, family.tree);
  }
  const FaceOrder order = hold_source_numbers ? FaceOrder::kSource : FaceOrder::kTree;
  std::array<EncodedNodes, 3> plain;  // by PlainCut
  const auto walk_for = [&](std::size_t i) {
    const auto cut = static_cast<PlainCut>(i);
    const bool is_wanted = std::any_of(codecs.begin(), codecs.end(),
                                       [&](CodecId codec) { return plain_cut_of(codec) == cut; });
    if (is_wanted) {
      plain[i] = encode_plain(build, source.built(), cut, order, options.shrink_share);
    }
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

// Codecs with full leaves; their layout orders the faces.
Family wide_family(const Source& source, const SearchOptions& options,
                   const std::shared_ptr<const WideLayout>& layout) {
  Family family{source.known, {}};
  encode_geometry(source, options, layout->face_order, LeafOrder::kFree, family.tree);
  family.nodes_of = [layout](CodecId codec) { return encode_wide(*layout, codec); };
  return family;
}

std::shared_ptr<const WideLayout> lay_out(const Source& source) {
  return std::make_shared<const WideLayout>(
      lay_out_wide(build_full_leaves(source.built(), source.origin(), source.duplicates)));
}

// Proves a candidate and counts its work.
Result<Candidate> examine(const EncodedTree& tree, const SourceMesh& mesh, const Workload& queries,
                          std::span<const CodecCost> costs) {
  Candidate candidate{tree.nodes.codec,
                      tree.geometry.geometry,
                      tree.nodes.bytes.size() + tree.geometry.duplicates.size(),
                      tree.geometry.vertices.size() + tree.geometry.corners.size(),
                      tree.geometry.max_vertex_error,
                      {},
                      {},
                      check_gates(tree, arrays_of(mesh)),
                      {}};
  if (!candidate.gates.pass()) return candidate;
  BindOptions bind;
  bind.mesh = arrays_of(mesh);
  const Result<Tree> bound = bind_encoded(tree, bind);
  if (!bound) return bound.error();
  const Result<WorkOfKinds> work = count_work(*bound, queries);
  if (!work) return work.error();
  candidate.work = *work;
  candidate.cost =
      cost_of(*work, candidate.codec, candidate.geometry, mesh.positions.precision, costs);
  return candidate;
}

// One search: see try_encodings.
class Search {
 public:
  Search(const SourceMesh& mesh, const SearchOptions& options, const std::optional<Grid>& scene)
      : mesh_(mesh),
        options_(options),
        scene_(scene),
        costs_(options.costs.empty() ? compiled_costs()
                                     : std::span<const CodecCost>(options.costs)),
        queries_(choice_queries(bounds_of(mesh))) {
    out_.contest.triangles = static_cast<std::uint32_t>(mesh.triangle_count());
    out_.contest.queries = options.wishes.queries;
    out_.contest.mesh = mesh.name;
  }

  Result<TriedTree> run() {
    if (Status status = try_stores(); !status) return status.error();
    if (Status status = enter_baseline(); !status) return status.error();
    return std::move(out_);
  }

 private:
  Status try_stores() {
    if (options_.geometry != GeometryId::kExact) return try_and_drop(options_.geometry);
    for (const GeometryId store : {GeometryId::kExact, GeometryId::kArrays, GeometryId::kGrid}) {
      if (store == GeometryId::kGrid && !options_.may_use_grid) continue;
      const std::string why = options_.try_all ? "" : why_not(store);
      if (!why.empty()) {
        leave_out(store, why);
        continue;
      }
      const Status status = try_and_drop(store);
      if (status) continue;
      if (store != GeometryId::kGrid) return status.error();
      leave_out(store, status.error().detail);  // the scene has no grid that fine
    }
    return {};
  }

  // Tries a store and frees the bytes of what lost by it.
  Status try_and_drop(GeometryId store) {
    if (Status status = try_store(store); !status) return status;
    if (out_.contest.candidates.empty()) return {};
    if (Status status = enter_baseline(); !status) return status;
    if (!options_.keep_all) drop_losers();
    return {};
  }

  // What slowdowns are relative to. The store does not change the work of a tree, so that any wide8
  // tree tells it, best one over positions that are not rounded, which are tried first.
  Status enter_baseline() {
    if (has_baseline_) return {};
    const auto found = std::find_if(
        out_.contest.candidates.begin(), out_.contest.candidates.end(),
        [](const Candidate& each) { return each.codec == CodecId::kWide8 && each.gates.pass(); });
    WorkOfKinds work{};
    if (found != out_.contest.candidates.end()) {
      work = found->work;
    } else {
      const Result<WorkOfKinds> counted = count_wide8();
      if (!counted) return counted.error();
      work = *counted;
    }
    const Precision precision =
        options_.geometry == GeometryId::kGrid ? Precision::kF32 : mesh_.positions.precision;
    out_.contest.baseline = cost_of(work, CodecId::kWide8, GeometryId::kArrays, precision, costs_);
    has_baseline_ = true;
    return {};
  }

  // Frees the bytes of candidates that lose to another one, whatever is tried after them.
  void drop_losers() {
    const std::vector<bool> may_win = may_still_win(out_.contest, options_.wishes);
    std::vector<bool> is_needed(out_.families.size(), false);
    for (std::size_t i = 0; i < may_win.size(); ++i) {
      if (may_win[i]) {
        is_needed[out_.nodes[i].family] = true;
      } else {
        out_.nodes[i].nodes.bytes = {};
      }
    }
    for (std::size_t i = 0; i < is_needed.size(); ++i) {
      if (!is_needed[i]) out_.families[i].geometry = {};
    }
  }

  // The work of wide8 where only other codecs were requested.
  [[nodiscard]] Result<WorkOfKinds> count_wide8() const {
    const Source source(mesh_, {}, options_.is_part);
    SearchOptions options = options_;
    options.geometry = GeometryId::kArrays;
    std::shared_ptr<const WideLayout> layout = unrounded_ ? unrounded_->layout : nullptr;
    if (layout == nullptr) layout = lay_out(source);
    Family family = wide_family(source, options, layout);
    family.tree.nodes = family.nodes_of(CodecId::kWide8);
    const Result<Tree> bound = bind_encoded(family.tree);
    if (!bound) return bound.error();
    return count_work(*bound, queries_);
  }

  void leave_out(GeometryId store, const std::string& why) {
    if (store == GeometryId::kArrays && !options_.may_use_arrays) return;
    for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
      if (options_.codec.value_or(codec) == codec) {
        out_.contest.not_tried.push_back({codec, store, why});
      }
    }
  }

  // Whether the codecs that are wanted have full leaves, some of them at least.
  [[nodiscard]] bool is_wanted_wide() const { return !options_.codec || is_wide(*options_.codec); }

  // Why candidates with this geometry store cannot win; empty when they can.
  [[nodiscard]] std::string why_not(GeometryId store) const {
    const Wishes& wishes = options_.wishes;
    const bool counts_time_alone =
        wishes.goal == Goal::kSpeed && !wishes.max_bytes_per_triangle.has_value();
    const bool has_faster = store == GeometryId::kGrid || options_.may_use_arrays;
    if (counts_time_alone && store != GeometryId::kArrays && is_wanted_wide() && has_faster) {
      return "the same tree, but leaves take longer to read";
    }
    const bool counts_bytes_alone = wishes.goal == Goal::kMemory && !wishes.max_slowdown;
    if (store != GeometryId::kArrays || !counts_bytes_alone || !is_wanted_wide()) return "";
    std::uint64_t least = ~std::uint64_t{0};
    for (const Candidate& candidate : out_.contest.candidates) {
      if (candidate.gates.pass()) least = std::min(least, candidate.bytes());
    }
    const std::uint64_t arrays = array_bytes();
    return arrays < least
               ? ""
               : fmt::format("arrays alone take {} bytes, {} in all are enough", arrays, least);
  }

  // Bytes of geometry in arrays, which do not depend on the order of faces.
  [[nodiscard]] std::uint64_t array_bytes() const {
    std::vector<bool> used(mesh_.positions.size());
    std::uint64_t vertices = 0;
    bool may_have_quads = false;
    for (const Face& face : mesh_.faces) {
      may_have_quads |= face.is_quad();
      for (std::size_t i = 0; i < (face.is_quad() ? 4u : 3u); ++i) {
        vertices += used[face.corner[i]] ? 0u : 1u;
        used[face.corner[i]] = true;
      }
    }
    const std::uint64_t position = mesh_.positions.precision == Precision::kF64 ? 24 : 12;
    const std::uint64_t corner = mesh_.positions.size() <= 0xffff ? 2 : 4;
    return vertices * position + mesh_.faces.size() * (may_have_quads ? 4 : 3) * corner;
  }

  // A mesh that is not rounded is built once for all its stores.
  struct Built {
    Source source;
    std::shared_ptr<const WideLayout> layout;  // if a codec with full leaves is wanted
  };

  Status try_store(GeometryId store) {
    const std::vector<CodecId> wide = wanted_codecs(true, store);
    const std::vector<CodecId> binary = wanted_codecs(false, store);
    if (wide.empty() && binary.empty()) return {};
    std::optional<Built> on_grid;
    if (store == GeometryId::kGrid) {
      Result<QuantisedPositions> quantised = quantise_mesh();
      if (!quantised) return quantised.error();
      unrounded_.reset();  // a grid is tried last
      on_grid.emplace(Built{Source(mesh_, std::move(*quantised), options_.is_part), nullptr});
    } else if (!unrounded_) {
      unrounded_.emplace(Built{Source(mesh_, {}, options_.is_part), nullptr});
    }
    Built& built = store == GeometryId::kGrid ? *on_grid : *unrounded_;
    const Source& source = built.source;
    SearchOptions options = options_;
    options.geometry = store;
    if (!wide.empty()) {
      if (built.layout == nullptr) {
        built.layout = lay_out(source);
      }
      if (Status status = try_family(wide_family(source, options, built.layout), source, wide);
          !status) {
        return status;
      }
    }
    if (binary.empty()) return {};
    return try_family(binary_family(source, options, binary), source, binary);
  }

  Result<QuantisedPositions> quantise_mesh() const {
    const std::array meshes{&mesh_};
    const Result<Grid> grid = scene_ ? *scene_ : choose_grid(meshes, options_.grid);
    if (!grid) return grid.error();
    QuantisedPositions quantised = quantise(mesh_, *grid);
    const double tolerance = options_.grid.tolerance.value_or(quantised.max_vertex_error);
    if (quantised.max_vertex_error > tolerance) {
      return Error{Errc::kMeshUnsupported,
                   fmt::format("double precision so far from zero moves a vertex by {}",
                               quantised.max_vertex_error)};
    }
    return quantised;
  }

  // Whether a codec is tried with a store that was requested, or with one of those for exact
  // positions. Codecs with one triangle per leaf have arrays, as in the paper: a cluster would
  // decode eight triangles for one.
  [[nodiscard]] bool has_store(CodecId codec, GeometryId store) const {
    if (options_.geometry != GeometryId::kExact) return true;
    if (store == GeometryId::kArrays) return !is_wide(codec) || options_.may_use_arrays;
    return store != GeometryId::kExact || is_wide(codec);
  }

  std::vector<CodecId> wanted_codecs(bool wide, GeometryId store) {
    std::vector<CodecId> wanted;
    for (const CodecInfo& codec : kCodecs) {
      if (is_wide(codec.id) != wide || options_.codec.value_or(codec.id) != codec.id) continue;
      if (!has_store(codec.id, store)) continue;
      const std::string why = options_.codec || options_.try_all ? "" : why_not(codec.id);
      if (why.empty()) {
        wanted.push_back(codec.id);
      } else {
        out_.contest.not_tried.push_back({codec.id, store, why});
      }
    }
    return wanted;
  }

  // The same for a codec.
  [[nodiscard]] std::string why_not(CodecId codec) const {
    if (is_wide(codec)) return "";
    if (codec == CodecId::kPackedF64 && mesh_.positions.precision != Precision::kF64) {
      return "skipped: the mesh is f32";
    }
    if (mesh_.faces.size() < kTryAllFaces) return "";
    return "one triangle per leaf: more than ten times the bytes of nodes, and slower on every "
           "mesh "
           "measured";
  }

  // Once for all codecs of a family, whose faces are the same.
  Status add_active_edges(EncodedTree& tree) {
    if (!options_.active_edges || tree.face_count == 0 || !tree.geometry.active_edges.empty()) {
      return {};
    }
    if (options_.known_edges == nullptr && !edges_) {
      edges_ = find_active_edges(mesh_, *options_.active_edges);
    }
    BindOptions bind;
    bind.mesh = arrays_of(mesh_);
    const Result<Tree> bound = bind_encoded(tree, bind);
    if (!bound) return bound.error();
    auto section = encode_active_edges(
        *bound, tree.face_order, options_.known_edges != nullptr ? *options_.known_edges : *edges_);
    if (!section) return section.error();
    tree.geometry.active_edges = std::move(*section);
    tree.edge_degrees = *options_.active_edges;
    return {};
  }

  Status try_family(Family family, const Source& source, const std::vector<CodecId>& codecs) {
    EncodedTree& tree = family.tree;
    for (const CodecId codec : codecs) {
      tree.nodes = family.nodes_of(codec);
      if (Status status = add_active_edges(tree); !status) return status;
      Result<Candidate> candidate = examine(tree, mesh_, queries_, costs_);
      if (!candidate) return candidate.error();
      out_.contest.candidates.push_back(std::move(*candidate));
      out_.nodes.push_back({out_.families.size(), std::exchange(tree.nodes, {})});
    }
    std::uint32_t collapsed = 0;
    if (source.quantised) {
      // Uses a frame chosen for the source: the grid's frame may be far too coarse to distinguish
      // triangles from points.
      const Frame frame = unbuilt_tree(mesh_, Origin::kByPrecision).frame();
      const std::uint32_t before = count_degenerate(mesh_, frame);
      collapsed = tree.degenerate_count - std::min(before, tree.degenerate_count);
    }
    out_.collapsed.push_back(collapsed);
    out_.families.push_back(std::move(tree));
    return {};
  }

  const SourceMesh& mesh_;
  const SearchOptions& options_;
  const std::optional<Grid>& scene_;
  const std::span<const CodecCost> costs_;
  const Workload queries_;
  std::optional<Built> unrounded_;
  bool has_baseline_ = false;
  std::optional<ActiveEdges> edges_;
  TriedTree out_;
};

}  // namespace

EncodedTree TriedTree::take(std::size_t candidate) {
  EncodedTree tree = std::move(families[nodes[candidate].family]);
  tree.nodes = std::move(nodes[candidate].nodes);
  nodes.clear();
  families.clear();
  return tree;
}

bool may_grid_win(const Wishes& wishes) noexcept {
  return wishes.goal != Goal::kSpeed || wishes.max_bytes_per_triangle.has_value();
}

Result<TriedTree> try_encodings(const SourceMesh& mesh, const SearchOptions& options,
                                const std::optional<Grid>& scene) {
  const DefaultFloatState state;
  if (Status status = check_limits(mesh, options); !status) return status.error();
  return Search(mesh, options, scene).run();
}

}  // namespace boxtree::cooker
