// SPDX-License-Identifier: MIT
// One scene through the stages, each a member of SceneCook in the order of the data.
#include "cooker/scene/cook_scene.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <utility>

#include <fmt/format.h>

#include "cooker/cook_record.h"
#include "cooker/scene/hidden_faces.h"
#include "cooker/scene/precision.h"
#include "cooker/scene/scene_account.h"
#include "cooker/scene/scene_grid.h"
#include "format/container.h"
#include "format/numbers.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

// Without a profile, what the options say holds for every mesh.
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

class SceneCook {
 public:
  SceneCook(const CookOptions& options, const Profile& profile, const Progress& progress)
      : options_(options), profile_(profile), progress_(progress) {}

  Result<CookedFile> run(LoadedScene loaded) {
    loaded_ = std::move(loaded);
    if (Status status = plan(); !status) return status.error();
    if (Status status = try_meshes(); !status) return status.error();
    if (Status status = choose_encodings(); !status) return status.error();
    if (Status status = assemble(); !status) return status.error();
    if (Status status = keep_to_bytes(); !status) return status.error();
    return cooked();
  }

 private:
  void step(const std::string& what) const {
    if (progress_) progress_(what);
  }

  Status plan() {
    Result<ScenePlan> plan = plan_scene(loaded_.scene, profile_);
    if (!plan) return plan.error();
    plan_ = std::move(*plan);
    if (profile_.path.empty()) apply_options(options_, plan_);
    return {};
  }

  [[nodiscard]] SearchOptions search_options(std::size_t mesh, bool has_grid) const {
    const PlannedMesh& planned = plan_.meshes[mesh];
    SearchOptions search = static_cast<const SearchOptions&>(options_);
    search.codec = planned.codec;
    search.wishes.goal = planned.goal;
    search.wishes.queries = planned.queries;
    if (profile_.budget.bytes_per_triangle) {
      search.wishes.max_bytes_per_triangle = profile_.budget.bytes_per_triangle->value;
    }
    if (profile_.budget.slowdown) {
      search.wishes.max_slowdown = profile_.budget.slowdown->value;
    }
    // A number of bytes for the whole file may need any of them.
    if (profile_.budget.bytes) search.try_all = true;
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
    return plan_.meshes[mesh].materials && loaded_.scene.meshes[mesh].materials.size() > 1;
  }

  Status try_meshes() {
    const std::vector<std::optional<Grid>> grids =
        scene_grids(loaded_.scene, plan_, options_.grid.bits);
    for (std::size_t m = 0; m < plan_.meshes.size(); ++m) {
      if (!plan_.meshes[m].kept) continue;
      SourceMesh& mesh = loaded_.scene.meshes[m].mesh;
      step(fmt::format("build {} ({} of {})", mesh.name, m + 1, plan_.meshes.size()));
      drop_hidden_faces(mesh, plan_.meshes[m].hidden_faces);
      if (mesh.faces.empty()) {
        return Error{Errc::kProfileInvalid,
                     mesh.name + ": hidden_faces leave nothing of it; leave_out drops an object"};
      }
      const SearchOptions search = search_options(m, grids[m].has_value());
      Result<TriedTree> tried = try_encodings(mesh, search, grids[m]);
      if (!tried) return Error{tried.code(), mesh.name + ": " + tried.error().detail};
      mesh.positions = {};
      mesh.faces = {};
      mesh.face_ids = {};
      mesh_of_tree_.push_back(m);
      wishes_.push_back(search.wishes);
      may_use_grid_.push_back(search.may_use_grid);
      contests_.push_back(std::move(tried->contest));
      tried_.push_back(std::move(*tried));
    }
    return {};
  }

  // Trees that can have either geometry store share one, so that what touches still does; the
  // others have theirs by what is asked of them, and touch within their tolerance.
  Status choose_encodings() {
    chosen_.resize(tried_.size());
    std::vector<std::size_t> free;
    std::vector<Contest> free_contests;
    std::vector<Wishes> free_wishes;
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      if (has_both_stores(t)) {
        free.push_back(t);
        free_contests.push_back(std::move(contests_[t]));
        free_wishes.push_back(wishes_[t]);
        continue;
      }
      const auto chosen = choose(std::span(&contests_[t], 1), wishes_[t]);
      if (!chosen) return in_mesh(t, chosen.error());
      chosen_[t] = chosen->front();
    }
    if (free.empty()) return {};
    const auto chosen = choose_each(free_contests, free_wishes);
    if (!chosen) return chosen.error();
    for (std::size_t i = 0; i < free.size(); ++i) {
      chosen_[free[i]] = (*chosen)[i];
      contests_[free[i]] = std::move(free_contests[i]);
    }
    return {};
  }

  // Whether a tree can have either store: not where the profile, or what it asks of the tree, has
  // decided already.
  [[nodiscard]] bool has_both_stores(std::size_t tree) const {
    const auto has = [&](GeometryId store) {
      const std::vector<Candidate>& candidates = contests_[tree].candidates;
      const std::vector<bool> eligible = may_be_chosen(candidates);
      for (std::size_t i = 0; i < candidates.size(); ++i) {
        if (eligible[i] && candidates[i].geometry == store) return true;
      }
      return false;
    };
    return may_use_grid_[tree] && has(GeometryId::kExact) && has(GeometryId::kGrid);
  }

  [[nodiscard]] Error in_mesh(std::size_t tree, const Error& error) const {
    const std::string& name = loaded_.scene.meshes[mesh_of_tree_[tree]].mesh.name;
    return {error.code, name + ": " + error.detail};
  }

  // A tree of the file: the chosen encoding without what only served to make it. What it was chosen
  // from is kept where the file may turn out too large.
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
    trees_.clear();
    parts_ = {};
    parts_.queries = plan_.queries;
    number_materials();
    std::vector<std::uint32_t> tree_of_mesh(plan_.meshes.size(), 0);
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      tree_of_mesh[mesh_of_tree_[t]] = static_cast<std::uint32_t>(t);
      trees_.push_back(tree_of(t));
      parts_.tree_materials.push_back(materials_of(t, trees_.back()));
    }
    for (std::size_t m = 0; m < plan_.meshes.size(); ++m) {
      const auto& first = plan_.meshes[m].same_as;
      if (first) tree_of_mesh[m] = tree_of_mesh[*first];
    }
    for (std::size_t i = 0; i < plan_.instances.size(); ++i) {
      const PlannedInstance& planned = plan_.instances[i];
      if (!planned.kept) continue;
      const SceneInstance& source = loaded_.scene.instances[i];
      parts_.instances.push_back({tree_of_mesh[source.mesh], source.id, planned.layer,
                                  planned.moves, planned.names ? source.name : std::string(),
                                  source.pose});
    }
    for (const PlannedLayer& layer : plan_.layers) {
      parts_.layers.push_back({layer.name, layer.meets, layer.queries});
    }
    add_left_out(tree_of_mesh);
    if (options_.cook_record) record_ = record();
    return {};
  }

  // Materials of meshes that are kept with theirs, in the order of the source.
  void number_materials() {
    std::vector<bool> used(loaded_.scene.materials.size(), false);
    for (const std::size_t m : mesh_of_tree_) {
      if (!plan_.meshes[m].materials) continue;
      for (const MaterialRun& run : loaded_.scene.meshes[m].materials) used[run.material] = true;
    }
    material_number_.assign(used.size(), kNoMaterial);
    for (std::size_t i = 0; i < used.size(); ++i) {
      if (!used[i]) continue;
      material_number_[i] = static_cast<std::uint32_t>(parts_.materials.size());
      parts_.materials.push_back(plan_.material_names ? loaded_.scene.materials[i] : std::string());
    }
  }

  // By runs of source faces where faces know their numbers, else one by one; ids that served this
  // alone go.
  [[nodiscard]] TreeMaterials materials_of(std::size_t t, EncodedTree& tree) const {
    const std::size_t m = mesh_of_tree_[t];
    const std::vector<MaterialRun>& runs = loaded_.scene.meshes[m].materials;
    TreeMaterials materials;
    const bool ids_are_wanted = plan_.meshes[m].face_ids;
    const bool ids_are_structure =
        tree.geometry.geometry == GeometryId::kExternal;  // leaves name faces by them
    const auto material_at = [&](std::uint32_t id) {
      const auto after = std::upper_bound(
          runs.begin(), runs.end(), id,
          [](std::uint32_t value, const MaterialRun& run) { return value < run.first_face; });
      return material_number_[std::prev(after)->material];
    };
    if (plan_.meshes[m].materials && !runs.empty()) {
      if (runs.size() == 1 || ids_are_wanted || ids_are_structure) {
        for (const MaterialRun& run : runs) {
          materials.runs.push_back({run.first_face, material_number_[run.material]});
        }
      } else {
        const NumberView ids(tree.geometry.face_ids.data(), tree.geometry.face_id_bytes);
        for (std::uint32_t face = 0; face < tree.face_count; ++face) {
          materials.faces.push_back(material_at(ids[face]));
        }
      }
    }
    if (!ids_are_wanted && !ids_are_structure) {
      tree.geometry.face_ids = {};
      tree.geometry.face_id_bytes = 0;
    }
    return materials;
  }

  // What a reader may miss: of the whole scene, or of one tree; once where one line took it from
  // every tree. Queries that only some layers answer are told by the layers.
  void add_left_out(const std::vector<std::uint32_t>& tree_of_mesh) {
    std::map<std::pair<Part, std::uint32_t>, std::vector<std::uint32_t>> of_trees;  // part, line
    for (const Decision& decision : plan_.decisions) {
      const std::optional<Part> part = part_of(decision.aspect);
      if (decision.kept || !part) continue;
      if (decision.owner_kind == OwnerKind::kFile) {
        parts_.left_out.push_back({*part, kNoOwner, decision.line, profile_.cite(decision.line)});
      } else if (decision.owner_kind == OwnerKind::kMesh && plan_.meshes[decision.owner].kept &&
                 (*part == Part::kFaceIds || *part == Part::kMaterials)) {
        of_trees[{*part, decision.line}].push_back(tree_of_mesh[decision.owner]);
      }
    }
    if (profile_.path.empty() && !options_.face_ids) {
      parts_.left_out.push_back({Part::kFaceIds, kNoOwner, 0, "--no-face-ids"});
    }
    for (const auto& [what, trees] : of_trees) {
      const auto& [part, line] = what;
      const bool is_all = trees.size() == trees_.size();
      for (const std::uint32_t tree : trees) {
        parts_.left_out.push_back({part, is_all ? kNoOwner : tree, line, profile_.cite(line)});
        if (is_all) break;
      }
    }
  }

  [[nodiscard]] std::string record() const {
    std::vector<RecordedSource> sources;
    for (std::size_t i = 0; i < loaded_.imports.size(); ++i) {
      sources.push_back({loaded_.import_names[i], loaded_.imports[i].content_hash,
                         loaded_.imports[i].source_faces});
    }
    return make_cook_record(options_, sources, profile_hash(profile_));
  }

  // A file that is too large: trees change to smaller candidates, first where a byte saved costs
  // the least time, until it fits.
  Status keep_to_bytes() {
    if (!profile_.budget.bytes) return {};
    const std::uint64_t limit = profile_.budget.bytes->value;
    for (;;) {
      const Result<FileLayout> layout = layout_of({trees_, record_, &parts_});
      if (!layout) return layout.error();
      if (layout->bytes <= limit) return {};
      if (!make_something_smaller()) {
        return Error{Errc::kBudgetUnreachable,
                     fmt::format("{}: wanted a file of at most {} bytes; the smallest that is "
                                 "possible has {}",
                                 profile_.cite(profile_.budget.bytes->line), limit, layout->bytes)};
      }
      if (Status status = assemble(); !status) return status;
    }
  }

  bool make_something_smaller() {
    std::size_t best_tree = tried_.size(), best_candidate = 0;
    double least = 0;
    for (std::size_t t = 0; t < tried_.size(); ++t) {
      const std::vector<Candidate>& candidates = contests_[t].candidates;
      const std::vector<double> slower = slowdowns(candidates, wishes_[t].queries);
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
    candidates[chosen_[best_tree]].rejected = "over the budget of the file's bytes";
    candidates[best_candidate].rejected.clear();
    chosen_[best_tree] = best_candidate;
    return true;
  }

  Result<CookedFile> cooked() {
    CookedFile file;
    Summary& summary = file.summary;
    std::vector<const Contest*> contests;
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      CookedTree tree;
      tree.tree.name = loaded_.scene.meshes[mesh_of_tree_[t]].mesh.name;
      tree.collapsed = tried_[t].collapsed[tried_[t].nodes[chosen_[t]].family];
      contests.push_back(&contests_[t]);
      summary.trees.push_back(std::move(tree));
    }
    SceneSummary scene;
    for (const PlacedTree& instance : parts_.instances) {
      ++scene.instances;
      scene.moving += instance.moves ? 1 : 0;
      scene.placed_triangles += trees_[instance.tree].triangle_count;
    }
    scene.instances_left_out =
        static_cast<std::uint32_t>(plan_.instances.size() - parts_.instances.size());
    scene.meshes = static_cast<std::uint32_t>(plan_.meshes.size());
    scene.notices = plan_.notices;
    const Result<FileLayout> layout = layout_of({trees_, record_, &parts_});
    if (!layout) return layout.error();
    scene.why = account({loaded_.scene, profile_, plan_, mesh_of_tree_, trees_, contests, chosen_,
                         parts_, options_},
                        *layout);
    summary.scene = std::move(scene);
    for (std::size_t t = 0; t < trees_.size(); ++t) {
      summary.trees[t].contest = std::move(contests_[t]);
    }
    summary.imports = std::move(loaded_.imports);
    file.trees = std::move(trees_);
    file.scene = std::move(parts_);
    file.record = std::move(record_);
    return file;
  }

  const CookOptions& options_;
  const Profile& profile_;
  const Progress& progress_;
  LoadedScene loaded_;
  ScenePlan plan_;
  // One a tree of the file.
  std::vector<std::size_t> mesh_of_tree_;
  std::vector<TriedTree> tried_;
  std::vector<Contest> contests_;
  std::vector<Wishes> wishes_;
  std::vector<bool> may_use_grid_;
  std::vector<std::size_t> chosen_;
  std::vector<EncodedTree> trees_;
  // Of the file.
  std::vector<std::uint32_t> material_number_;
  SceneParts parts_;
  std::string record_;
};

}  // namespace

Result<CookedFile> cook_scene(LoadedScene source, const Profile& profile,
                              const CookOptions& options, const Progress& progress) {
  const DefaultFloatState state;
  return SceneCook(options, profile, progress).run(std::move(source));
}

}  // namespace boxtree::cooker
