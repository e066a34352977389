// SPDX-License-Identifier: MIT
// Questions as data: from options or from a line of a batch, to an answer in JSON.
#pragma once

#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <boxtree/cooker/cli/output.h>
#include <boxtree/cooker/import/source_mesh.h>
#include <boxtree/runtime/boxtree.h>

namespace boxtree::cooker {

struct RayQuestion {
  Ray ray{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  bool any = false;
};
struct BoxQuestion {
  Eigen::AlignedBox3d box;
};
struct SphereQuestion {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};
struct PointQuestion {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  double max_distance = std::numeric_limits<double>::infinity();
};
struct PairQuestion {
  std::filesystem::path file;  // of the second tree
  std::string tree = "0";
  std::filesystem::path mesh;  // its source, if its geometry is external
  Pose pose = Pose::Identity();
  bool first_only = false;
};
using Question =
    std::variant<RayQuestion, BoxQuestion, SphereQuestion, PointQuestion, PairQuestion>;

/// A file, one of its trees, and the mesh that it is bound to if its geometry is external.
struct OpenedTree {
  File file;
  std::unique_ptr<SourceMesh> mesh;
  Tree tree;
};

/// Opens `path` and binds the tree with that number or name. `mesh` names the source of trees that
/// were cooked with --external; it is imported and compared by content.
Result<OpenedTree> open_tree(const std::filesystem::path& path, const std::string& which,
                             const std::filesystem::path& mesh);

/// Second trees of pair questions, each opened once.
class TreeCache {
 public:
  Result<const Tree*> get(const PairQuestion& question);

 private:
  std::map<std::pair<std::string, std::string>, std::unique_ptr<OpenedTree>> opened_;
};

/// "X,Y,Z", or the 12 numbers of a 3x4 matrix row by row. Nothing if it is neither.
[[nodiscard]] std::optional<Pose> parse_pose(std::string_view text);

/// A question from one line of a batch: an object with the names of the options as keys, as in
/// {"kind":"ray","origin":[0,0,9],"direction":[0,0,-1]}. Without "kind" it is `default_kind`.
/// Error: kInvalidQuery with what was expected.
Result<Question> parse_question(std::string_view line, std::string_view default_kind);

/// The answer in the form that `boxtree query --json` prints.
Result<Json> ask(const Tree& tree, const Question& question, TreeCache& others);

}  // namespace boxtree::cooker
