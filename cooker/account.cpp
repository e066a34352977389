// SPDX-License-Identifier: MIT
// Makes lines of kept bytes from sections, and lines of parts left out from decisions.
#include "cooker/account.h"

#include <algorithm>
#include <cstring>
#include <optional>

#include <fmt/format.h>

#include "cooker/text/at_most.h"
#include "format/container.h"
#include "format/face_numbers.h"

namespace boxtree::cooker {
namespace {

class Account {
 public:
  Account(const CookedParts& cooked, std::vector<WhyLine>& why) : cooked_(cooked), why_(why) {}

  void add_kept(const FileLayout& layout) {
    std::uint64_t of_sections = 0;
    for (const SectionEntry& entry : layout.sections) {
      add_section(entry);
      of_sections += entry.size;
    }
    const std::uint64_t table = table_end(layout.sections.size());
    keep("header and section table", table, "what a reader opens the file by");
    keep("padding", layout.bytes - of_sections - table,
         "sections start at multiples of 8 bytes, those of 4096 bytes at multiples of 64");
  }

  void add_left_out() {
    for (const Decision& decision : cooked_.plan.decisions) {
      // Precision is reported with the chosen encoding; names by the objects and meshes without.
      if (decision.kept || decision.aspect == Aspect::kPrecision || is_names_of_file(decision)) {
        continue;
      }
      const Estimate estimate = bytes_of(decision);
      why_.push_back({aspect_name(decision.aspect), owner_of(decision), false, estimate.bytes,
                      estimate.is_estimate, decision.reason, cited(decision.line)});
    }
    if (cooked_.profile.path.empty() && !cooked_.options.face_ids) {
      std::uint64_t bytes = 0;
      for (const EncodedTree& tree : cooked_.trees) bytes += face_id_bytes(tree);
      why_.push_back(
          {aspect_name(Aspect::kFaceIds), "file", false, bytes, true, "--no-face-ids", {}});
    }
    if (!cooked_.options.cook_record) {
      why_.push_back({"cook record", "file", false, 0, true, "--strip", {}});
    }
    add_rounding();
  }

 private:
  static bool is_names_of_file(const Decision& decision) {
    return decision.aspect == Aspect::kNames && decision.owner_kind == OwnerKind::kFile;
  }

  struct Estimate {
    std::uint64_t bytes = 0;
    bool is_estimate = true;
  };

  [[nodiscard]] std::string cited(std::uint32_t line) const {
    return line == 0 ? std::string() : cooked_.profile.cite(line);
  }
  [[nodiscard]] std::string mesh_name(std::size_t mesh) const {
    return "mesh " + cooked_.scene.meshes[mesh].mesh.name;
  }
  [[nodiscard]] std::string owner_of(const Decision& decision) const {
    switch (decision.owner_kind) {
      case OwnerKind::kFile:
        return "file";
      case OwnerKind::kObject:
        return "object " + cooked_.profile.objects[decision.owner].name.value;
      case OwnerKind::kMesh:
        return mesh_name(decision.owner);
    }
    return {};
  }

  void keep(std::string part, std::uint64_t bytes, std::string reason) {
    why_.push_back({std::move(part), "file", true, bytes, false, std::move(reason), {}});
  }

  // The plan's decision on a part of a mesh, else on the whole file.
  [[nodiscard]] const Decision* decision_on(Aspect aspect, std::optional<std::size_t> mesh) const {
    const Decision* of_file = nullptr;
    for (const Decision& decision : cooked_.plan.decisions) {
      if (decision.aspect != aspect) continue;
      if (mesh && decision.owner_kind == OwnerKind::kMesh && decision.owner == *mesh) {
        return &decision;
      }
      if (decision.owner_kind == OwnerKind::kFile) of_file = &decision;
    }
    return of_file;
  }

  // What decided how a tree's vertices are stored: a precision that was wanted, or else the goal.
  [[nodiscard]] Aspect aspect_of_vertices(std::size_t tree) const {
    const std::size_t mesh = cooked_.mesh_of_tree[tree];
    const bool is_exact = mesh < cooked_.plan.meshes.size() && cooked_.plan.meshes[mesh].exact;
    if (is_exact) return Aspect::kPrecision;
    const bool is_grid = cooked_.trees[tree].geometry.geometry == GeometryId::kGrid;
    const Decision* precision = is_grid ? decision_on(Aspect::kPrecision, mesh) : nullptr;
    return precision != nullptr && precision->line != 0 ? Aspect::kPrecision : Aspect::kCodec;
  }

  // Of a budget that excluded some encoding of a tree; 0 if none did.
  [[nodiscard]] std::uint32_t line_of_budget(std::size_t tree) const {
    const SceneBudget& budget = cooked_.profile.budget;
    for (const Candidate& candidate : cooked_.contests[tree].candidates) {
      if (candidate.rejected == kOverTime && budget.slowdown) return budget.slowdown->line;
      if (candidate.rejected == kOverBytes && budget.bytes_per_triangle) {
        return budget.bytes_per_triangle->line;
      }
      if (candidate.rejected == kOverFileBytes && budget.bytes) return budget.bytes->line;
    }
    return 0;
  }

  void add_section(const SectionEntry& entry) {
    WhyLine line;
    line.part = section_name(entry.kind);
    line.bytes = entry.size;
    std::optional<std::size_t> mesh;
    if (entry.owner != kNoOwner) mesh = cooked_.mesh_of_tree[entry.owner];
    line.owner = mesh ? mesh_name(*mesh) : "file";
    std::optional<Aspect> aspect;
    line.reason = purpose(entry, aspect);
    const Decision* decision = aspect ? decision_on(*aspect, mesh) : nullptr;
    if (decision == nullptr && aspect && cooked_.parts == nullptr) {
      const std::string decided = reason_of_option(*aspect, entry);
      if (!decided.empty()) line.reason += line.reason.empty() ? decided : "; " + decided;
    }
    if (decision != nullptr) {
      line.reason += line.reason.empty() ? decision->reason : "; " + decision->reason;
      line.line = cited(decision->line);
      const bool is_encoding = aspect == Aspect::kCodec || aspect == Aspect::kPrecision;
      const std::uint32_t budget =
          is_encoding && decision->line == 0 ? line_of_budget(entry.owner) : 0;
      if (budget != 0) {
        line.reason += ", within the budget";
        line.line = cited(budget);
      }
    }
    const bool are_edges =
        entry.kind == SectionKind::kActiveEdges || entry.kind == SectionKind::kInstanceEdges;
    if (are_edges && cooked_.profile.active_edges) {
      line.line = cited(cooked_.profile.active_edges->line);
    }
    const bool is_user_data =
        entry.kind == SectionKind::kUserDataRuns || entry.kind == SectionKind::kFaceUserData;
    if (is_user_data && cooked_.profile.user_data) {
      line.line = cited(cooked_.profile.user_data->line);
    }
    why_.push_back(std::move(line));
  }

  // The reason for a section, with the plan's decision on it.
  [[nodiscard]] std::string purpose(const SectionEntry& entry,
                                    std::optional<Aspect>& aspect) const {
    switch (entry.kind) {
      case SectionKind::kTrees:
        return "one record a tree, with what was proven of it";
      case SectionKind::kNodes:
        aspect = Aspect::kCodec;
        return fmt::format("codec {}", codec_name(cooked_.trees[entry.owner].nodes.codec));
      case SectionKind::kVertices:
      case SectionKind::kCorners:
        aspect = aspect_of_vertices(entry.owner);
        return geometry_reason(entry.kind, cooked_.trees[entry.owner]);
      case SectionKind::kFaceIds:
        aspect = Aspect::kFaceIds;
        return {};
      case SectionKind::kDuplicates:
        return fmt::format("{} faces are copies of others, which stand in leaves for them",
                           cooked_.trees[entry.owner].geometry.duplicate_count);
      case SectionKind::kActiveEdges:
        return fmt::format("boundaries, and edges that bend away by more than {:g} degrees",
                           cooked_.trees[entry.owner].edge_degrees);
      case SectionKind::kInstanceEdges:
        return "boundaries of trees at which the surface goes on in another instance";
      case SectionKind::kNames:
        return "objects'; those of instances, meshes and materials that keep theirs; reasons of "
               "parts left out";
      case SectionKind::kCookRecord:
        return "how the file was made; --strip leaves it out";
      case SectionKind::kScene:
      case SectionKind::kSceneNodes:
      case SectionKind::kInstances:
        return fmt::format("{} instances", cooked_.parts->instances.size());
      case SectionKind::kPoses:
        return entry.size == cooked_.parts->instances.size() * kNumbersOfPose * sizeof(float)
                   ? "f32 holds every number"
                   : "some number needs f64";
      case SectionKind::kLayers:
        return "which layers answer which queries and collide with which";
      case SectionKind::kMaterials:
        return "where their names are";
      case SectionKind::kMaterialRuns:
      case SectionKind::kFaceMaterials:
        aspect = Aspect::kMaterials;
        return {};
      case SectionKind::kUserDataRuns:
      case SectionKind::kFaceUserData:
        return fmt::format("'{}' of the source; {}", cooked_.options.import.user_data,
                           forms_text(*cooked_.trees[entry.owner].user_data_forms));
      case SectionKind::kLeftOut:
        return "so that a query for what is left out is told why";
      case SectionKind::kBlob:
        return "the file, compressed whole";
      case SectionKind::kPack:
      case SectionKind::kMembers:
        return {};  // of packs, which are not cooked
    }
    return {};
  }

  // What decided on a part of a file without a top level.
  [[nodiscard]] std::string reason_of_option(Aspect aspect, const SectionEntry& entry) const {
    switch (aspect) {
      case Aspect::kFaceIds:
        return "numbers of the source's faces; --no-face-ids leaves them out";
      case Aspect::kMaterials: {
        const std::optional<FaceNumberBytes>& forms = cooked_.trees[entry.owner].material_forms;
        return forms ? "--materials; " + forms_text(*forms) : "--materials";
      }
      default:
        return {};  // sections say why, and the contest of encodings does
    }
  }

  static std::string geometry_reason(SectionKind kind, const EncodedTree& tree) {
    if (tree.geometry.geometry == GeometryId::kGrid) {
      return "grid, " + moves_in_words(tree.geometry.max_vertex_error);
    }
    if (kind == SectionKind::kVertices) {
      if (tree.positions_f64) return "exact, f64";
      const double moved = tree.geometry.max_vertex_error;
      return moved > 0
                 ? fmt::format("exact, f32, which moved a vertex by up to {}", at_most(moved, 3))
                 : "exact, f32";
    }
    return tree.geometry.corner_bytes == 2 ? "16 bits number every vertex"
                                           : "vertices take numbers of 32 bits";
  }

  static std::uint64_t face_id_bytes(const EncodedTree& tree) {
    return tree.geometry.face_id_bytes;
  }

  // Bytes per triangle in this file: an estimate for meshes that were never cooked.
  [[nodiscard]] double bytes_per_triangle() const {
    double bytes = 0, triangles = 0;
    for (const EncodedTree& tree : cooked_.trees) {
      bytes += static_cast<double>(tree.nodes.bytes.size() + tree.geometry.vertices.size() +
                                   tree.geometry.corners.size());
      triangles += tree.triangle_count;
    }
    return triangles > 0 ? bytes / triangles : 0;
  }

  [[nodiscard]] Estimate bytes_of(const Decision& decision) const {
    switch (decision.aspect) {
      case Aspect::kFaceIds:
        return {sum_over_trees(decision, face_id_bytes), true};
      case Aspect::kMaterials:
        return {material_bytes(decision), true};
      case Aspect::kNames:
        return {name_bytes(decision), true};
      case Aspect::kInstances:
        return {instance_bytes(decision), true};
      case Aspect::kMesh:
        return {about(mesh_triangles(decision.owner)), true};
      case Aspect::kHiddenFaces:
        return {about(static_cast<double>(cooked_.plan.meshes[decision.owner].hidden_face_count)),
                true};
      case Aspect::kGeometry:
        return {about(mesh_triangles(decision.owner)), true};
      case Aspect::kRay:
      case Aspect::kBox:
      case Aspect::kPoint:
      case Aspect::kPair:
      case Aspect::kContacts:
      case Aspect::kPrecision:
      case Aspect::kCodec:
        break;  // no part of the file is for one of them alone
    }
    return {0, false};
  }

  [[nodiscard]] std::uint64_t about(double triangles) const {
    return static_cast<std::uint64_t>(triangles * bytes_per_triangle());
  }
  [[nodiscard]] double mesh_triangles(std::size_t mesh) const {
    const auto at = std::find(cooked_.mesh_of_tree.begin(), cooked_.mesh_of_tree.end(), mesh);
    if (at != cooked_.mesh_of_tree.end()) {
      return cooked_.trees[static_cast<std::size_t>(at - cooked_.mesh_of_tree.begin())]
          .triangle_count;
    }
    return static_cast<double>(cooked_.scene.meshes[mesh].mesh.triangle_count());
  }

  template <class Bytes>
  [[nodiscard]] std::uint64_t sum_over_trees(const Decision& decision, Bytes bytes) const {
    std::uint64_t sum = 0;
    for (std::size_t t = 0; t < cooked_.trees.size(); ++t) {
      if (decision.owner_kind == OwnerKind::kMesh && cooked_.mesh_of_tree[t] != decision.owner) {
        continue;
      }
      if (decision.owner_kind == OwnerKind::kObject) continue;
      sum += bytes(cooked_.trees[t]);
    }
    return sum;
  }

  [[nodiscard]] std::uint64_t material_bytes(const Decision& decision) const {
    std::uint64_t bytes = 0;
    for (std::size_t m = 0; m < cooked_.scene.meshes.size(); ++m) {
      if (decision.owner_kind == OwnerKind::kMesh && m != decision.owner) continue;
      bytes += cooked_.scene.meshes[m].materials.size() * sizeof(FaceRun);
    }
    return bytes;
  }

  [[nodiscard]] std::uint64_t name_bytes(const Decision& decision) const {
    std::uint64_t bytes = 0;
    if (decision.owner_kind == OwnerKind::kMesh) {
      return cooked_.scene.meshes[decision.owner].mesh.name.size();
    }
    for (std::size_t i = 0; i < cooked_.plan.instances.size(); ++i) {
      const PlannedInstance& planned = cooked_.plan.instances[i];
      const bool is_meant =
          decision.owner_kind == OwnerKind::kFile || planned.object == decision.owner;
      if (planned.kept && !planned.names && is_meant) {
        bytes += cooked_.scene.instances[i].name.size();
      }
    }
    return bytes;
  }

  [[nodiscard]] std::uint64_t instance_bytes(const Decision& decision) const {
    std::uint64_t count = 0;
    for (const PlannedInstance& planned : cooked_.plan.instances) {
      const bool is_meant =
          decision.owner_kind == OwnerKind::kFile || planned.object == decision.owner;
      count += !planned.kept && is_meant ? 1 : 0;
    }
    return count * (sizeof(InstanceRecord) + kNumbersOfPose * sizeof(float));
  }

  // Bytes of positions saved by a grid: the difference to the largest without one.
  void add_rounding() {
    for (std::size_t t = 0; t < cooked_.trees.size(); ++t) {
      const std::vector<Candidate>& candidates = cooked_.contests[t].candidates;
      const Candidate& chosen = candidates[cooked_.chosen[t]];
      if (chosen.geometry != GeometryId::kGrid) continue;
      std::uint64_t saved = 0;
      for (const Candidate& other : candidates) {
        if (!is_lossless(other.geometry) || other.geometry_bytes <= chosen.geometry_bytes) {
          continue;
        }
        saved = std::max(saved, other.geometry_bytes - chosen.geometry_bytes);
      }
      if (saved == 0) continue;  // exact geometry was not tried
      const std::size_t mesh = cooked_.mesh_of_tree[t];
      const Decision* decision = decision_on(Aspect::kPrecision, mesh);
      why_.push_back({"digits of positions", mesh_name(mesh), false, saved, false,
                      decision != nullptr ? decision->reason
                      : cooked_.parts != nullptr
                          ? "a grid keeps what the scene can tell apart"
                          : "a grid was chosen or wanted; --exact keeps every bit",
                      decision != nullptr ? cited(decision->line) : std::string()});
    }
  }

  const CookedParts& cooked_;
  std::vector<WhyLine>& why_;
};

}  // namespace

std::vector<WhyLine> account(const CookedParts& cooked, const FileLayout& layout) {
  std::vector<WhyLine> why;
  Account lines(cooked, why);
  if (cooked.options.blob) {
    why.push_back({"blob", "file", true, 0, false, "the file, compressed whole", {}});
  } else {
    lines.add_kept(layout);
  }
  lines.add_left_out();
  return why;
}

}  // namespace boxtree::cooker
