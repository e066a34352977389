// SPDX-License-Identifier: MIT
// Proves by walking the written file, not the tree in memory.
#include "cooker/proof/proof.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/face_number_proof.h"
#include "cooker/proof/names.h"
#include "cooker/proof/pack_proof.h"
#include "cooker/proof/reserved.h"
#include "cooker/proof/scene_proof.h"
#include "format/limits.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/walk/traversal.h"

namespace boxtree::cooker {
namespace {

// Trees with fewer faces are walked by one thread; others by a task for each subtree some levels
// down, up to 512 tasks.
constexpr std::uint32_t kFacesOfManyTasks = 16384;
constexpr std::uint32_t kBinaryTaskLevels = 9;
constexpr std::uint32_t kWideTaskLevels = 3;

// One bit per face, set when the face is reached: eight to a word, so that one exchange is enough
// for a full leaf.
class Reached {
 public:
  explicit Reached(std::uint32_t faces) : faces_(faces), words_((faces + kFaces - 1) / kFaces) {}

  [[nodiscard]] std::uint32_t faces() const { return faces_; }
  [[nodiscard]] bool has(std::uint32_t face) const {
    return (words_[face / kFaces].load(std::memory_order_relaxed) >> (face % kFaces) & 1u) != 0;
  }

  // Marks faces from `first` to the last of their word or before `end`, and calls twice(face) for
  // each that was marked before. Returns the next face. Precondition: first < end <= faces().
  template <class Twice>
  std::uint32_t mark(std::uint32_t first, std::uint32_t end, Twice twice) {
    const std::uint32_t word = first / kFaces;
    const std::uint32_t next = std::min((word + 1) * kFaces, end);
    const std::uint32_t mask = ((1u << (next - first)) - 1) << (first % kFaces);
    const auto before =
        words_[word].fetch_or(static_cast<std::uint8_t>(mask), std::memory_order_relaxed) & mask;
    if (before == 0) return next;
    for (std::uint32_t face = first; face < next; ++face) {
      if ((before >> (face % kFaces) & 1u) != 0) twice(face);
    }
    return next;
  }

 private:
  static constexpr std::uint32_t kFaces = 8;
  std::uint32_t faces_;
  std::vector<std::atomic<std::uint8_t>> words_;
};

// The walk of one subtree. Its counts and findings are added up in the order of the children, so
// that they do not depend on threads.
class Walk {
 public:
  Walk(const Tree& tree, bool with_geometry, Reached& reached, SharedWalkBound& bound,
       TreeProof& proof)
      : tree_(tree),
        with_geometry_(with_geometry),
        task_levels_(tree.face_count() < kFacesOfManyTasks     ? 0
                     : is_wide(BoundTree::of(tree).codec()) ? kWideTaskLevels
                                                            : kBinaryTaskLevels),
        reached_(reached),
        bound_(bound),
        proof_(proof) {}

  void run() {
    if (!tree_.empty()) {
      walk(BoundTree::of(tree_).root(), 0);
      visit_duplicates();
      report_unreached();
    }
    compare("depth", proof_.depth, BoundTree::of(tree_).depth());
    compare("nodes", proof_.node_count, BoundTree::of(tree_).node_count());
    compare("faces", proof_.face_count, tree_.face_count());
    if (with_geometry_) compare("triangles", proof_.triangle_count, tree_.triangle_count());
  }

 private:
  void add(Errc code, const std::string& what) {
    if (proof_.findings.size() < kMaxFindings) proof_.findings.push_back({code, what});
  }

  void compare(const char* what, std::uint32_t found, std::uint32_t stated) {
    if (found == stated) return;
    add(Errc::kRecordInvalid, "the record states " + std::to_string(stated) + " " + what +
                                  ", the tree has " + std::to_string(found));
  }

  // Returns the bounds of all triangles below. A box that contains these bounds contains each
  // triangle, so comparing every box with the bounds below it is the complete proof. The recursion
  // is at most kMaxDepth deep.
  Box<double> walk(const Node& node, std::uint32_t depth) {
    Box<double> content = node.is_leaf ? visit_leaf(node) : visit_node(node, depth);
    for (std::size_t k = 0; k < 3; ++k) {
      if (content.low[k] >= node.box.low[k] && content.high[k] <= node.box.high[k]) continue;
      if (content.low[k] > content.high[k]) break;  // nothing below, already reported
      ++proof_.escapes;
      add(Errc::kBoxEscape,
          fmt::format("{} {}, axis {}: triangles reach [{}, {}], the box [{}, {}]",
                      node.is_leaf ? "leaf at face" : "node", node.ref.first, k, content.low[k],
                      content.high[k], node.box.low[k], node.box.high[k]));
      break;
    }
    return content;
  }

  Box<double> visit_node(const Node& node, std::uint32_t depth) {
    Box<double> content = empty_box<double>();
    if (depth == kMaxDepth) {
      add(Errc::kDepthExceeded, "node " + std::to_string(node.ref.first) + " is below depth " +
                                    std::to_string(kMaxDepth));
      return content;
    }
    NodeChildren children;
    const NodeState state = BoundTree::of(tree_).expand(node, children);
    if (const Errc error = bound_.count(state); error != Errc::kOk) {
      add(error, fault_of_node(node.ref.first, state));
      return content;
    }
    ++proof_.node_count;
    proof_.depth = std::max(proof_.depth, depth + 1);
    if (depth < task_levels_) return walk_in_tasks(children, depth + 1);
    for (std::uint32_t i = 0; i < children.count; ++i) {
      expand(content, walk(children.child[i], depth + 1));
    }
    return content;
  }

  Box<double> walk_in_tasks(const NodeChildren& children, std::uint32_t depth) {
    struct Part {
      TreeProof proof;
      Box<double> content;
    };
    std::array<Part, std::tuple_size_v<decltype(children.child)>> parts;
    tbb::parallel_for(tbb::blocked_range<std::uint32_t>(0, children.count, 1),
                      [&](const tbb::blocked_range<std::uint32_t>& range) {
                        for (std::uint32_t i = range.begin(); i < range.end(); ++i) {
                          Walk below(tree_, with_geometry_, reached_, bound_, parts[i].proof);
                          parts[i].content = below.walk(children.child[i], depth);
                        }
                      });
    Box<double> content = empty_box<double>();
    for (std::uint32_t i = 0; i < children.count; ++i) {
      expand(content, parts[i].content);
      add_up(parts[i].proof);
    }
    return content;
  }

  void add_up(const TreeProof& part) {
    proof_.depth = std::max(proof_.depth, part.depth);
    proof_.node_count += part.node_count;
    proof_.face_count += part.face_count;
    proof_.triangle_count += part.triangle_count;
    proof_.degenerate_count += part.degenerate_count;
    proof_.missed += part.missed;
    proof_.escapes += part.escapes;
    for (const Error& finding : part.findings) add(finding.code, finding.detail);
  }

  // The order in which threads reach a face affects only the report of a corrupt tree.
  bool mark_reached(std::uint32_t first, std::uint32_t count, const char* twice) {
    const std::uint32_t end = first + count;
    std::uint32_t repeated = 0;
    for (std::uint32_t face = first; face < end;) {
      face = reached_.mark(face, end, [&](std::uint32_t met) {
        add(Errc::kFaceRepeated, "face " + std::to_string(met) + " " + twice);
        ++repeated;
      });
    }
    proof_.face_count += count - repeated;
    return repeated == 0;
  }

  Box<double> visit_leaf(const Node& leaf) {
    Box<double> content = empty_box<double>();
    if (!in_range(leaf.ref.first, leaf.ref.second, reached_.faces())) {
      add(Errc::kFaceOutOfRange, "a leaf names face " + std::to_string(leaf.ref.first) + " of " +
                                     std::to_string(reached_.faces()));
      return content;
    }
    mark_reached(leaf.ref.first, leaf.ref.second, "is in two leaves");
    if (!with_geometry_) return content;
    TriangleBatch batch;
    if (const Errc error = BoundTree::of(tree_).leaf_triangles(leaf, batch); error != Errc::kOk) {
      add(error, "leaf at face " + std::to_string(leaf.ref.first) + " cannot be read");
      return content;
    }
    for (std::uint32_t i = 0; i < batch.count; ++i) visit_triangle(batch.triangle(i), content);
    return content;
  }

  void visit_triangle(const Triangle& triangle, Box<double>& content) {
    ++proof_.triangle_count;
    if (is_degenerate(triangle)) ++proof_.degenerate_count;
    expand(content, bounds_of(triangle));
  }

  // Queries report a duplicate together with its original, and decide ties for the original. The
  // original must therefore be in a leaf, be bitwise identical, and have the smaller id. Originals
  // must ascend for the binary search.
  void visit_duplicates() {
    const std::uint32_t in_leaves = BoundTree::of(tree_).counts().faces_in_leaves;
    std::uint32_t before = 0;
    for (std::uint32_t copy = in_leaves; copy < tree_.face_count(); ++copy) {
      const std::uint32_t original = BoundTree::of(tree_).original_of(copy);
      const bool is_original = original < in_leaves && original >= before && reached_.has(original);
      if (!is_original) {
        add(Errc::kFaceOutOfRange, "face " + std::to_string(copy) + " is a copy of face " +
                                       std::to_string(original) +
                                       ", which is in no leaf or out of order");
        continue;
      }
      before = original;
      if (!mark_reached(copy, 1, "is in a leaf and a copy of another one")) continue;
      if (!has_same_triangles(original, copy) ||
          (tree_.has_face_ids() &&
           BoundTree::of(tree_).face_id(original) > BoundTree::of(tree_).face_id(copy))) {
        add(Errc::kDuplicateDiffers, "face " + std::to_string(copy) +
                                         " is listed as a copy of face " +
                                         std::to_string(original));
      }
    }
  }

  bool has_same_triangles(std::uint32_t original, std::uint32_t copy) {
    if (!with_geometry_) return true;
    TriangleBatch a, b;
    if (BoundTree::of(tree_).leaves().read(original, 1, a) != Errc::kOk ||
        BoundTree::of(tree_).leaves().read(copy, 1, b) != Errc::kOk || a.count != b.count) {
      return false;
    }
    Box<double> content = empty_box<double>();
    for (std::uint32_t i = 0; i < a.count; ++i) {
      visit_triangle(b.triangle(i), content);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        for (std::size_t k = 0; k < 3; ++k) {
          const auto bits = [&](const TriangleBatch& batch) {
            return std::bit_cast<std::uint64_t>(batch.coordinate[corner][k][i]);
          };
          if (bits(a) != bits(b)) return false;
        }
      }
    }
    return true;
  }

  void report_unreached() {
    for (std::uint32_t f = 0; f < reached_.faces(); ++f) {
      if (reached_.has(f)) continue;
      ++proof_.missed;
      add(Errc::kFaceUnreachable, "no leaf holds face " + std::to_string(f));
    }
  }

  const Tree& tree_;
  bool with_geometry_;
  std::uint32_t task_levels_;
  Reached& reached_;
  SharedWalkBound& bound_;
  TreeProof& proof_;
};

Status check_degenerate(const TreeRecord& record, const TreeProof& proof) {
  if (record.degenerate_count == proof.degenerate_count) return {};
  return Error{Errc::kRecordInvalid, "the record states " +
                                         std::to_string(record.degenerate_count) +
                                         " triangles without area, the tree has " +
                                         std::to_string(proof.degenerate_count)};
}

// Binds for a structural check: leaves of external geometry are never read.
Result<Tree> bind_for_proof(const File& file, std::uint32_t index,
                            const std::optional<MeshArrays>& mesh) {
  BindOptions options;
  options.mesh = mesh;
  options.verify_mesh = mesh.has_value();
  if (!mesh) options.mesh = absent_arrays(OpenFile::of(file).tree_record(index));
  return Tree::bind(file, index, options);
}

// The index of a pack and, where that is valid, every member.
Findings verify_members(const File& pack, const std::optional<MeshArrays>& mesh) {
  Findings findings = check_pack(pack);
  if (!findings.empty()) return findings;
  for_each_member(pack, [&](std::string_view name, std::span<const std::uint32_t> trees) {
    if (findings.size() >= kMaxFindings) return;
    const Result<Member> member = pack.member(trees.front());
    if (!member) {
      findings.push_back(member.error());
      return;
    }
    for (Error& finding : verify_file(member->file, mesh)) {
      finding.detail = "member " + std::string(name) + ": " + finding.detail;
      findings.push_back(std::move(finding));
    }
  });
  return findings;
}

}  // namespace

std::string fault_of_node(std::uint32_t node, NodeState state) {
  return "node " + std::to_string(node) +
         (state == NodeState::kValid ? " is one more than the record states: one is met twice"
                                     : " contradicts itself");
}

TreeProof prove_tree(const Tree& tree, bool with_geometry) {
  TreeProof proof;
  Reached reached(tree.empty() ? 0 : tree.face_count());
  SharedWalkBound bound(BoundTree::of(tree).node_count());
  Walk(tree, with_geometry, reached, bound, proof).run();
  return proof;
}

Findings verify_file(const File& file, const std::optional<MeshArrays>& mesh) {
  Findings findings;
  if (Status status = check_padding(file.bytes(), OpenFile::of(file).container()); !status) {
    findings.push_back(status.error());
  }
  for (std::size_t section = 0; findings.size() < kMaxFindings; ++section) {
    const Status status = OpenFile::of(file).verify_checksums(section);
    if (status) break;  // of all that are left
    findings.push_back(status.error());
  }
  if (file.is_pack()) {
    for (Error& finding : verify_members(file, mesh)) findings.push_back(std::move(finding));
    return findings;
  }
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    const Result<Tree> tree = bind_for_proof(file, i, mesh);
    if (!tree) {
      findings.push_back(tree.error());
      continue;
    }
    const bool with_geometry =
        BoundTree::of(*tree).geometry() != GeometryId::kExternal || mesh.has_value();
    TreeProof proof = prove_tree(*tree, with_geometry);
    const TreeRecord record = OpenFile::of(file).tree_record(i);
    for (Error& finding : check_reserved(file, i)) {
      proof.findings.push_back(std::move(finding));
    }
    if (Status status = check_degenerate(record, proof); with_geometry && !status) {
      proof.findings.push_back(status.error());
    }
    if (Status status = check_text(OpenFile::of(file).section(SectionKind::kNames),
                                   record.name_offset, record.name_bytes, "its name");
        !status) {
      proof.findings.push_back(status.error());
    }
    for (Error& finding : proof.findings) {
      finding.detail = "tree " + std::to_string(i) + ": " + finding.detail;
      findings.push_back(std::move(finding));
    }
  }
  const auto add = [&](const std::string& fault) {
    if (findings.size() < kMaxFindings) findings.push_back({Errc::kRecordInvalid, fault});
  };
  if (!file.has_scene()) check_materials(file, add);
  check_user_data(file, add);
  for (Error& finding : prove_scene(file)) findings.push_back(std::move(finding));
  return findings;
}

}  // namespace boxtree::cooker
