// SPDX-License-Identifier: MIT
// Runs the stages, each a member of Cook, in the order of the data.
#include "cooker/cook.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include "cooker/account.h"
#include "cooker/cook_record.h"
#include "cooker/encode/instance_edges.h"
#include "cooker/import/f32_digits.h"
#include "cooker/import/file_error.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/scene/hidden_faces.h"
#include "cooker/scene/plan.h"
#include "cooker/scene/precision.h"
#include "cooker/scene/scene_grid.h"
#include "format/container.h"
#include "format/face_ids.h"
#include "format/face_numbers.h"
#include "format/numbers.h"
#include "format/scene_record.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

// Without a profile, the options apply to every mesh.
void apply_options(const CookOptions& options, ScenePlan& plan) {
  for (PlannedMesh& mesh : plan.meshes) {
    mesh.codec = options.codec;
    mesh.goal = options.wishes.goal;
    mesh.face_ids = options.face_ids;
    mesh.external = options.geometry == GeometryId::kExternal;
    mesh.exact = options.geometry == GeometryId::kExact && !options.may_use_grid;
    if (!options.grid.tolerance) continue;
    mesh.default_precision = false;
    mesh.tolerance = mesh.largest_scale > 0
                         ? divided_below(*options.grid.tolerance, mesh.largest_scale)
                         : *options.grid.tolerance;
  }
}

// Digits of f64 are requested explicitly: only a tolerance gives them up.
void keep_digits(ScenePlan& plan) {
  for (PlannedMesh& mesh : plan.meshes) mesh.exact |= mesh.default_precision;
}

void drop_hidden_faces(SourceMesh& mesh, const std::vector<FaceRange>& ranges) {
  if (ranges.empty()) return;
  SourceMesh kept;
  for (std::size_t i = 0; i < mesh.faces.size(); ++i) {
    const std::uint32_t id = mesh.face_id(i);
    if (is_hidden(ranges, id)) continue;
    kept.faces.push_back(mesh.faces[i]);
    kept.face_ids.push_back(id);
  }
  mesh.faces = std::move(kept.faces);
  mesh.face_ids = std::move(kept.face_ids);
}

class Cook {
 public:
  Cook(CookInput input, const Profile& profile, const CookOptions& options,
       const Progress& progress)
      : input_(std::move(input)), profile_(profile), options_(options), progress_(progress) {}

  Result<CookedFile> run() {
    if (Status status = plan(); !status) return status.error();
    if (Status status = try_meshes(); !status) return status.error();
    if (Status status = choose_encodings(); !status) return status.error();
    if (Status status = assemble(); !status) return status.error();
    if (options_.number_by_tree) number_by_tree(file_.trees.front());
    if (!input_.has_top_level) keep_materials();
    keep_user_data();
    if (Status status = keep_to_bytes(); !status) return status.error();
    if (Status status = summarise(); !status) return status.error();
    return std::move(file_);
  }

 private:
  Status plan() {
    if (options_.number_by_tree && (input_.has_top_level || input_.scene.meshes.size() != 1)) {
      return Error{Errc::kMeshUnsupported,
                   input_.scene.name +
                       ": faces are written in the order of one tree, and this is " +
                       (input_.has_top_level ? "a scene; --flatten makes one tree of a file"
                                             : "several meshes")};
    }
    if (!input_.has_top_level) {  // nothing is placed: the options decide
      plan_.meshes.resize(input_.scene.meshes.size());
      for (std::size_t i = 0; i < input_.imports.size(); ++i) {
        const Status status = check_digits(input_.scene.meshes[i].mesh, input_.imports[i]);
        if (!status) return status;
      }
      return {};
    }
    Result<ScenePlan> plan = plan_scene(input_.scene, profile_);
    if (!plan) return plan.error();
    plan_ = std::move(*plan);
    if (profile_.path.empty()) {
      apply_options(options_, plan_);
      return check_digits_of_scene();
    }
    if (options_.import.precision == Precision::kF64) {
      keep_digits(plan_);
    }
    return {};
  }

  // A tolerance of the options; plan_scene checks those of a profile.
  [[nodiscard]] Status check_digits(const SourceMesh& mesh, const ImportReport& report) const {
    if (!options_.grid.tolerance) return {};
    return check_moved_by_f32(mesh, source_of(report).string(), *options_.grid.tolerance);
  }

  [[nodiscard]] Status check_digits_of_scene() const {
    for (std::size_t i = 0; i < plan_.meshes.size(); ++i) {
      if (!plan_.meshes[i].tolerance || plan_.meshes[i].external) continue;
      const SourceMesh& mesh = input_.scene.meshes[i].mesh;
      const std::string what = input_.imports.size() == 1
                                   ? source_of(input_.imports.front()).string()
                                   : "mesh \"" + mesh.name + '"';
      const Status status = check_moved_by_f32(mesh, what, *plan_.meshes[i].tolerance);
      if (!status) return status;
    }
    return {};
  }

  // Called for one mesh after another; may be called again for an imported mesh.
  Status import_mesh(std::size_t mesh) {
    if (!input_.importer || mesh < input_.imports.size()) return {};
    Result<Imported> imported = input_.importer(mesh);
    if (!imported) return imported.error();
    if (Status status = check_digits(imported->mesh, imported->report); !status) return status;
    input_.scene.meshes[mesh].mesh = std::move(imported->mesh);
    std::vector<FaceRun>& runs = input_.scene.meshes[mesh].materials;
    runs = std::move(imported->materials.runs);
    renumber(runs, MaterialJoin(input_.scene.materials).add(imported->materials.names));
    input_.scene.meshes[mesh].user_data = std::move(imported->user_data);
    input_.imports.push_back(std::move(imported->report));
    return {};
  }

  // The grid of each mesh that must not choose one itself.
  Result<std::vector<std::optional<Grid>>> grids() {
    if (input_.has_top_level) {
      return scene_grids(input_.scene, plan_, options_.grid,
                         options_.geometry == GeometryId::kGrid);
    }
    std::vector<std::optional<Grid>> grids(plan_.meshes.size());
    const bool may_choose_grid =
        options_.may_use_grid && (options_.try_all || may_grid_win(options_.wishes));
    const bool may_share =
        grids.size() > 1 && (options_.geometry == GeometryId::kGrid || may_choose_grid);
    if (!may_share) return grids;
    // One grid for all, so that surfaces that touch still touch: all are measured first.
    for (std::size_t m = 0; m < grids.size(); ++m) {
      if (Status status = import_mesh(m); !status) return status.error();
    }
    std::vector<const SourceMesh*> meshes;
    for (const SceneMesh& mesh : input_.scene.meshes) meshes.push_back(&mesh.mesh);
    const Result<Grid> shared = choose_grid(meshes, options_.grid);
    if (shared) {
      grids.assign(grids.size(), *shared);
    } else if (!options_.may_use_grid) {
      return shared.error();
    }
    return grids;
  }

  [[nodiscard]] SearchOptions search_options(std::size_t mesh, bool has_grid) const {
    SearchOptions search = static_cast<const SearchOptions&>(options_);
    search.face_order = !input_.scene.meshes[mesh].user_data.empty();
    search.is_part = !options_.import.face_ids.empty();
    if (!input_.has_top_level) {
      search.face_order |= options_.materials;
      return search;
    }
    if (profile_.active_edges) search.active_edges = profile_.active_edges->value;
    const PlannedMesh& planned = plan_.meshes[mesh];
    search.codec = planned.codec;
    search.wishes.goal = planned.goal;
    search.wishes.queries = planned.queries;
    if (profile_.budget.bytes_per_triangle) {
      search.wishes.max_bytes_per_triangle = profile_.budget.bytes_per_triangle->value;
    }
    if (profile_.budget.slowdown) {
      search.wishes.max_slowdown = profile_.budget.slowdown->value;
    }
    // A limit of bytes for the whole file may need any candidate.
    if (profile_.budget.bytes) search.try_all = search.keep_all = true;
    search.face_ids = planned.face_ids || has_several_materials(mesh);
    search.grid.tolerance = planned.tolerance;
    if (planned.external) {
      search.geometry = GeometryId::kExternal;
    } else if (options_.geometry == GeometryId::kGrid && has_grid && profile_.path.empty()) {
      search.geometry = GeometryId::kGrid;
    } else {
      search.geometry = GeometryId::kExact;
    }
    search.may_use_grid = search.geometry == GeometryId::kExact && has_grid;
    return search;
  }

  [[nodiscard]] bool has_several_materials(std::size_t mesh) const {
    return plan_.meshes[mesh].materials && input_.scene.meshes[mesh].materials.size() > 1;
  }

  [[nodiscard]] std::uint32_t line_of_hidden_faces(std::size_t mesh) const {
    const auto found = std::find_if(
        plan_.decisions.begin(), plan_.decisions.end(), [mesh](const Decision& decision) {
          return decision.aspect == Aspect::kHiddenFaces && decision.owner == mesh;
        });
    return found == plan_.decisions.end() ? 0 : found->line;
  }

  Status try_meshes() {
    const auto grids = this->grids();
    if (!grids) return grids.error();
    for (std::size_t m = 0; m < plan_.meshes.size(); ++m) {
      if (!plan_.meshes[m].kept) continue;
      if (Status status = import_mesh(m); !status) return status;
      SourceMesh& mesh = input_.scene.meshes[m].mesh;
      const std::string number =
          input_.has_top_level ? fmt::format(" ({} of {})", m + 1, plan_.meshes.size()) : "";
      announce(progress_, "build " + mesh.name + number);
      drop_hidden_faces(mesh, plan_.meshes[m].hidden_faces);
      if (input_.has_top_level && mesh.faces.empty()) {  // no instance is of a tree without faces
        return Error{
            Errc::kProfileInvalid,
            fmt::format("{}:{}: hidden_faces leave nothing of {}; leave_out drops an object",
                        profile_.path.string(), line_of_hidden_faces(m), mesh.name)};
      }
      take_face_numbers(m);
      SearchOptions search = search_options(m, (*grids)[m].has_value());
      if (options_.number_by_tree) {
        // Ids of the faces of the mesh instead of polygons: in the tree they give its order.
        polygons_ = std::exchange(mesh.face_ids, {});
        search.face_ids = true;
      }
      Result<TriedTree> tried = try_encodings(mesh, search, (*grids)[m]);
      if (!tried) return in_source(m, tried.error());
      edges_.push_back(count_surface_edges(arrays_of(mesh)));
      if (options_.number_by_tree) {
        numbered_ = std::exchange(mesh, {});
        mesh.name = numbered_.name;
      }
      // Where trees of external geometry meet others is found once all are encoded.
      if (!plan_.meshes[m].external || !edge_degrees()) {
        mesh.positions = {};
        mesh.faces = {};
        mesh.face_ids = {};
      }
      mesh_of_tree_.push_back(m);
      wishes_.push_back(search.wishes);
      may_use_grid_.push_back(search.may_use_grid);
      contests_.push_back(std::move(tried->contest));
      tried_.push_back(std::move(*tried));
    }
    return {};
  }

  // Keeps what trees store of the numbers of faces, since the mesh is freed. Runs that no face has
  // any more, since faces were dropped, are left out; materials of scenes only where they are too
  // many to be stored.
  void take_face_numbers(std::size_t m) {
    const SourceMesh& mesh = input_.scene.meshes[m].mesh;
    std::vector<FaceRun>& materials = input_.scene.meshes[m].materials;
    if (!input_.has_top_level || materials.size() > mesh.faces.size()) {
      if (!materials.empty()) materials_of_faces_[m] = take_numbers(mesh, materials);
    }
    std::vector<FaceRun>& user_data = input_.scene.meshes[m].user_data;
    if (!user_data.empty()) user_data_of_faces_[m] = take_numbers(mesh, user_data);
  }

  static std::vector<std::uint32_t> take_numbers(const SourceMesh& mesh,
                                                 std::vector<FaceRun>& runs) {
    std::vector<std::uint32_t> ids;
    for (std::size_t face = 0; face < mesh.faces.size(); ++face) ids.push_back(mesh.face_id(face));
    std::vector<std::uint32_t> of_faces = numbers_of_faces(mesh, runs);
    runs = runs_of(ids, of_faces);
    return of_faces;
  }

  // Trees that share their geometry store are chosen together.
  Status choose_encodings() {
    std::vector<bool> shares;
    for (std::size_t t = 0; t < tried_.size(); ++t) shares.push_back(shares_store(t));
    const Status chosen = choose_encodings(shares);
    if (chosen || chosen.code() != Errc::kBudgetUnreachable) return chosen;
    return in_budget(budgets_unreachable(contests_, wishes_, shares));
  }

  Status choose_encodings(const std::vector<bool>& shares) {
    chosen_.resize(tried_.size());
    std::vector<std::size_t> sharing;
    std::vector<Contest> contests;
    std::vector<Wishes> wishes;
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      if (shares[t]) {
        sharing.push_back(t);
        contests.push_back(contests_[t]);
        wishes.push_back(wishes_[t]);
        continue;
      }
      const auto chosen = choose(std::span(&contests_[t], 1), wishes_[t]);
      if (!chosen) return in_mesh(mesh_of_tree_[t], chosen.error());
      chosen_[t] = chosen->front();
    }
    if (sharing.empty()) return {};
    const auto chosen = choose_each(contests, wishes);
    if (!chosen) return chosen.error();
    for (std::size_t i = 0; i < sharing.size(); ++i) {
      chosen_[sharing[i]] = (*chosen)[i];
      contests_[sharing[i]] = std::move(contests[i]);
    }
    return {};
  }

  // What no encoding keeps, with the line of the profile that wants it.
  [[nodiscard]] Error in_budget(const Error& error) const {
    const SceneBudget& budget = profile_.budget;
    const std::uint32_t line = budget.bytes_per_triangle ? budget.bytes_per_triangle->line
                               : budget.slowdown         ? budget.slowdown->line
                                                         : 0;
    if (error.code != Errc::kBudgetUnreachable || line == 0) return error;
    return {error.code, profile_.cite(line) + ": " + error.detail};
  }

  // Whether a tree has the same geometry store as others, so that surfaces that touch still touch.
  // In a scene, a tree has a separate store if the profile or the tree's needs decide it; it then
  // touches others within its tolerance. What else was tried decides nothing.
  [[nodiscard]] bool shares_store(std::size_t tree) const {
    const auto has = [&](GeometryId store) {
      const std::vector<Candidate>& candidates = contests_[tree].candidates;
      const std::vector<bool> eligible = may_be_chosen(candidates);
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (eligible[i] && candidates[i].geometry == store) return true;
      }
      return false;
    };
    if (!input_.has_top_level) return true;
    return may_use_grid_[tree] && has(GeometryId::kGrid) &&
           (has(GeometryId::kExact) || has(GeometryId::kArrays)) &&
           may_want_grid(contests_[tree], wishes_[tree]);
  }

  // In a scene, errors name the mesh; without one, users list the meshes themselves.
  // The same of a mesh that cannot be encoded, with its file and what helps.
  [[nodiscard]] Error in_source(std::size_t mesh, Error error) const {
    if (input_.has_top_level) {
      const Error named = in_mesh(mesh, error);
      return input_.imports.size() == 1 ? in_file(source_of(input_.imports.front()), named) : named;
    }
    const bool is_external = options_.geometry == GeometryId::kExternal;
    if (is_external && error.code == Errc::kMeshUnsupported && plan_.meshes.size() == 1) {
      error.detail += "; --write-reordered FILE writes a mesh whose faces they are";
    }
    return mesh < input_.imports.size() ? in_file(source_of(input_.imports[mesh]), error)
                                        : in_file(input_.scene.meshes[mesh].mesh.name, error);
  }
  [[nodiscard]] Error in_mesh(std::size_t mesh, const Error& error) const {
    if (!input_.has_top_level) return error;
    return {error.code, input_.scene.meshes[mesh].mesh.name + ": " + error.detail};
  }

  // A tree of the file: the chosen encoding. The candidates are kept if the file may turn out too
  // large.
  [[nodiscard]] EncodedTree tree_of(std::size_t t) {
    const PlannedMesh& planned = plan_.meshes[mesh_of_tree_[t]];
    TriedTree::Nodes& nodes = tried_[t].nodes[chosen_[t]];
    EncodedTree& family = tried_[t].families[nodes.family];
    const bool may_choose_again = profile_.budget.bytes.has_value();
    EncodedTree tree = may_choose_again ? family : std::move(family);
    tree.nodes = may_choose_again ? nodes.nodes : std::move(nodes.nodes);
    if (!planned.names) tree.name.clear();
    return tree;
  }

  Status assemble() {
    file_.trees.clear();
    for (std::size_t t = 0; t < tried_.size(); ++t) file_.trees.push_back(tree_of(t));
    if (input_.has_top_level) {
      place_trees();
      if (Status status = find_edges_between(); !status) return status;
    }
    if (options_.cook_record) {
      file_.record = make_cook_record(options_, input_, profile_);
    } else if (!input_.has_top_level && file_.trees.size() == 1) {
      file_.trees.front().name.clear();  // the source's, and there is no other tree to tell it from
    }
    return {};
  }

  // By how much surfaces of a scene bend at active edges; empty: they are left out.
  [[nodiscard]] std::optional<double> edge_degrees() const {
    if (!input_.has_top_level) return {};
    return profile_.active_edges ? profile_.active_edges->value : options_.active_edges;
  }

  Status find_edges_between() {
    const std::optional<double> degrees = edge_degrees();
    if (!degrees) return {};
    std::vector<MeshArrays> arrays;
    for (const std::size_t m : mesh_of_tree_) {
      arrays.push_back(plan_.meshes[m].external ? arrays_of(input_.scene.meshes[m].mesh)
                                                : MeshArrays());
    }
    return find_instance_edges(file_.trees, arrays, *degrees, *file_.scene);
  }

  // From here on the source of the tree is the mesh with its faces in the order of the tree.
  void number_by_tree(EncodedTree& tree) {
    EncodedGeometry& geometry = tree.geometry;
    SourceMesh& mesh = numbered_;
    std::vector<Face> faces;
    faces.reserve(tree.face_count);
    file_.tree_order.reserve(tree.face_count);
    const FaceIdView ids = geometry.face_ids.empty() ? FaceIdView() : FaceIdView(geometry.face_ids);
    for (std::uint32_t i = 0; i < tree.face_count; ++i) {
      const std::uint32_t face = ids ? ids[i] : i;
      faces.push_back(mesh.faces[face]);
      file_.tree_order.push_back(
          {polygons_.empty() ? face : polygons_[face], mesh.polygon_corners[face]});
    }
    mesh.faces = std::move(faces);
    tree.geometry_hash = hash_of(mesh);
    tree.faces_in_source_order = true;
    geometry.face_ids = {};
    geometry.face_id_bytes = 0;
  }

  void place_trees() {
    SceneParts& parts = file_.scene.emplace();
    parts.profile = profile_.path.string();
    parts.queries = plan_.queries;
    number_materials(parts.materials);
    std::vector<std::uint32_t> tree_of_mesh(plan_.meshes.size(), 0);
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      tree_of_mesh[mesh_of_tree_[t]] = static_cast<std::uint32_t>(t);
      parts.tree_materials.push_back(materials_of(t, file_.trees[t]));
    }
    for (std::size_t m = 0; m < plan_.meshes.size(); ++m) {
      const auto& first = plan_.meshes[m].same_as;
      if (first) tree_of_mesh[m] = tree_of_mesh[*first];
    }
    for (std::size_t i = 0; i < plan_.instances.size(); ++i) {
      const PlannedInstance& planned = plan_.instances[i];
      if (!planned.kept) continue;
      const SceneInstance& source = input_.scene.instances[i];
      const bool is_listed = source.id < profile_.instances.size();
      parts.instances.push_back({tree_of_mesh[source.mesh], source.id, planned.layer, planned.moves,
                                 planned.names ? source.name : std::string(), source.pose,
                                 std::nullopt, is_listed ? profile_.instances[source.id].line : 0});
    }
    for (const PlannedLayer& layer : plan_.layers) {
      parts.layers.push_back({layer.name, layer.collides_with, layer.queries});
    }
    add_left_out(tree_of_mesh, parts);
  }

  // Of trees without a top level: the smaller of both forms.
  void keep_materials() {
    if (!options_.materials) return;
    number_materials(file_.materials.names);
    const std::uint8_t width =
        material_number_bytes(static_cast<std::uint32_t>(file_.materials.names.size()));
    for (std::size_t t = 0; t < file_.trees.size(); ++t) {
      FaceNumbers& materials = file_.materials.of_trees.emplace_back();
      const auto known = materials_of_faces_.find(mesh_of_tree_[t]);
      if (known == materials_of_faces_.end()) continue;
      std::vector<FaceRun> runs = input_.scene.meshes[mesh_of_tree_[t]].materials;
      renumber(runs, material_number_);
      std::vector<std::uint32_t>& of_faces = known->second;
      for (std::uint32_t& material : of_faces) material = material_number_[material];
      EncodedTree& tree = file_.trees[t];
      materials = both_forms(tree, std::move(runs), of_faces);
      tree.material_forms = keep_smaller(materials, width, has_ids(tree));
    }
  }

  // Of all trees: likewise, in as few bits as the largest takes.
  void keep_user_data() {
    for (std::size_t t = 0; t < file_.trees.size(); ++t) {
      const auto known = user_data_of_faces_.find(mesh_of_tree_[t]);
      if (known == user_data_of_faces_.end()) continue;
      EncodedTree& tree = file_.trees[t];
      FaceNumbers numbers =
          both_forms(tree, input_.scene.meshes[mesh_of_tree_[t]].user_data, known->second);
      const std::uint8_t width =
          number_bytes(*std::max_element(numbers.faces.begin(), numbers.faces.end()));
      tree.user_data_forms = keep_smaller(numbers, width, has_ids(tree));
      tree.user_data = encode_face_numbers(numbers, width);
    }
  }

  static bool has_ids(const EncodedTree& tree) {
    return tree.faces_in_source_order || !tree.geometry.face_ids.empty();
  }

  // Numbers of the faces of a tree from those of its mesh: the runs of ids, and each face's.
  [[nodiscard]] FaceNumbers both_forms(const EncodedTree& tree, std::vector<FaceRun> runs,
                                       std::span<const std::uint32_t> of_faces) const {
    FaceNumbers numbers{std::move(runs), {}};
    for (const std::uint32_t face : tree.face_order) numbers.faces.push_back(of_faces[face]);
    if (options_.number_by_tree) {
      std::vector<std::uint32_t> ids(numbers.faces.size());
      std::iota(ids.begin(), ids.end(), 0u);
      numbers.runs = runs_of(ids, numbers.faces);
    }
    return numbers;
  }

  // Numbers the materials of meshes that keep theirs, in the order of the source.
  void number_materials(std::vector<std::string>& names) {
    std::vector<bool> used(input_.scene.materials.size(), false);
    for (const std::size_t m : mesh_of_tree_) {
      if (!plan_.meshes[m].materials) continue;
      for (const FaceRun& run : input_.scene.meshes[m].materials) used[run.number] = true;
    }
    material_number_.assign(used.size(), kNoMaterial);
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      material_number_[i] = static_cast<std::uint32_t>(names.size());
      names.push_back(plan_.material_names ? input_.scene.materials[i] : std::string());
    }
  }

  // Materials by runs of source faces if face ids are kept, else per face; then drops face ids that
  // only this needed.
  [[nodiscard]] FaceNumbers materials_of(std::size_t t, EncodedTree& tree) const {
    const std::size_t m = mesh_of_tree_[t];
    const std::vector<FaceRun>& runs = input_.scene.meshes[m].materials;
    FaceNumbers materials;
    const bool ids_are_wanted = plan_.meshes[m].face_ids;
    const bool ids_are_structure =
        tree.geometry.geometry == GeometryId::kExternal;  // leaves refer to faces by them
    const auto material_at = [&](std::uint32_t id) {
      const auto after = std::upper_bound(
          runs.begin(), runs.end(), id,
          [](std::uint32_t value, const FaceRun& run) { return value < run.first_face; });
      return material_number_[std::prev(after)->number];
    };
    if (plan_.meshes[m].materials && !runs.empty()) {
      if (runs.size() == 1 || ids_are_wanted || ids_are_structure) {
        for (const FaceRun& run : runs) {
          materials.runs.push_back({run.first_face, material_number_[run.number]});
        }
      } else {
        const FaceIdView ids =
            tree.faces_in_source_order ? FaceIdView() : FaceIdView(tree.geometry.face_ids);
        for (std::uint32_t face = 0; face < tree.face_count; ++face) {
          materials.faces.push_back(material_at(ids ? ids[face] : face));
        }
      }
    }
    if (!ids_are_wanted && !ids_are_structure) {
      tree.geometry.face_ids = {};
      tree.faces_in_source_order = false;
    }
    return materials;
  }

  // Lists the parts that a reader may miss: for the whole scene, or for one tree; once if one line
  // removed the part from every tree. Queries of some layers only are recorded in the layers.
  void add_left_out(const std::vector<std::uint32_t>& tree_of_mesh, SceneParts& parts) const {
    std::map<std::pair<Part, std::uint32_t>, std::vector<std::uint32_t>> of_trees;  // part, line
    for (const Decision& decision : plan_.decisions) {
      const std::optional<Part> part = part_of(decision.aspect);
      if (decision.kept || !part) continue;
      if (decision.owner_kind == OwnerKind::kFile) {
        parts.left_out.push_back({*part, kNoOwner, decision.line, profile_.cite(decision.line)});
      } else if (decision.owner_kind == OwnerKind::kMesh && plan_.meshes[decision.owner].kept &&
                 (*part == Part::kFaceIds || *part == Part::kMaterials)) {
        of_trees[{*part, decision.line}].push_back(tree_of_mesh[decision.owner]);
      }
    }
    if (profile_.path.empty() && !options_.face_ids) {
      parts.left_out.push_back({Part::kFaceIds, kNoOwner, 0, "--no-face-ids"});
    }
    for (const auto& [what, trees] : of_trees) {
      const auto& [part, line] = what;
      const bool is_all = trees.size() == file_.trees.size();
      for (const std::uint32_t tree : trees) {
        parts.left_out.push_back({part, is_all ? kNoOwner : tree, line, profile_.cite(line)});
        if (is_all) break;
      }
    }
  }

  // Replaces candidates until the file is not too large: trees change to smaller ones, first where
  // a byte saved costs the least time.
  Status keep_to_bytes() {
    if (!profile_.budget.bytes) return {};
    const std::uint64_t limit = profile_.budget.bytes->value;
    for (;;) {
      const Result<FileLayout> layout = layout_of(file_.parts());
      if (!layout) return layout.error();
      if (layout->bytes <= limit) return {};
      if (!make_something_smaller()) {
        return Error{Errc::kBudgetUnreachable,
                     fmt::format("{}: wanted a file of at most {} bytes; the smallest that is "
                                 "possible has {}; a larger 'tolerance' allows fewer",
                                 profile_.cite(profile_.budget.bytes->line), limit, layout->bytes)};
      }
      if (Status status = assemble(); !status) return status;
      keep_user_data();
    }
  }

  bool make_something_smaller() {
    std::size_t best_tree = tried_.size(), best_candidate = 0;
    double least = 0;
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      const std::vector<Candidate>& candidates = contests_[t].candidates;
      const std::vector<double> slower = slowdowns(contests_[t]);
      const std::vector<bool> eligible = may_be_chosen(candidates);
      const Candidate& now = candidates[chosen_[t]];
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        if (!eligible[c] || candidates[c].bytes() >= now.bytes()) continue;
        if (slower[c] > wishes_[t].max_slowdown.value_or(slower[c])) continue;
        const double cost = (slower[c] - slower[chosen_[t]]) /
                            static_cast<double>(now.bytes() - candidates[c].bytes());
        if (best_tree != tried_.size() && cost >= least) continue;
        best_tree = t;
        best_candidate = c;
        least = cost;
      }
    }
    if (best_tree == tried_.size()) return false;
    std::vector<Candidate>& candidates = contests_[best_tree].candidates;
    candidates[chosen_[best_tree]].rejected = kOverFileBytes;
    candidates[best_candidate].rejected.clear();
    chosen_[best_tree] = best_candidate;
    return true;
  }

  Status summarise() {
    Summary& summary = file_.summary;
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      CookedTree tree;
      tree.tree.name = input_.scene.meshes[mesh_of_tree_[t]].mesh.name;
      tree.edges = edges_[t];
      tree.collapsed = tried_[t].collapsed_of(chosen_[t]);
      if (!input_.has_top_level && !options_.face_ids && !options_.number_by_tree) {
        tree.left_out.push_back(
            {"face_ids", file_.trees[t].geometry.face_id_bytes, "--no-face-ids"});
      }
      summary.trees.push_back(std::move(tree));
    }
    if (input_.has_top_level) summary.scene = scene_summary();
    const Result<FileLayout> layout = layout_of(file_.parts());
    if (!layout) return layout.error();
    summary.why = account({input_.scene, profile_, plan_, mesh_of_tree_, file_.trees, contests_,
                           chosen_, file_.scene ? &*file_.scene : nullptr, options_},
                          *layout);
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      summary.trees[t].contest = std::move(contests_[t]);
    }
    summary.imports = std::move(input_.imports);
    return {};
  }

  [[nodiscard]] SceneSummary scene_summary() const {
    SceneSummary scene;
    const std::vector<PlacedTree>& instances = file_.scene->instances;
    for (const PlacedTree& instance : instances) {
      ++scene.instances;
      scene.moving += instance.moves ? 1 : 0;
      scene.placed_triangles += file_.trees[instance.tree].triangle_count;
    }
    scene.instances_left_out =
        static_cast<std::uint32_t>(plan_.instances.size() - instances.size());
    scene.meshes = static_cast<std::uint32_t>(plan_.meshes.size());
    scene.notices = plan_.notices;
    return scene;
  }

  CookInput input_;
  const Profile& profile_;
  const CookOptions& options_;
  const Progress& progress_;
  ScenePlan plan_;
  // One per tree of the file.
  std::vector<std::size_t> mesh_of_tree_;
  std::vector<TriedTree> tried_;
  std::vector<SurfaceEdges> edges_;
  std::vector<Contest> contests_;
  std::vector<Wishes> wishes_;
  std::vector<bool> may_use_grid_;
  std::vector<std::size_t> chosen_;

  // With number_by_tree.
  SourceMesh numbered_;                  // as imported, then in the order of the tree
  std::vector<std::uint32_t> polygons_;  // source numbers of its faces; empty: the same

  // Of meshes that have any.
  std::map<std::size_t, std::vector<std::uint32_t>> materials_of_faces_, user_data_of_faces_;
  std::vector<std::uint32_t> material_number_;
  CookedFile file_;
};

}  // namespace

Result<CookedFile> cook(CookInput input, const Profile& profile, const CookOptions& options,
                        const Progress& progress) {
  const DefaultFloatState state;
  return Cook(std::move(input), profile, options, progress).run();
}

}  // namespace boxtree::cooker
