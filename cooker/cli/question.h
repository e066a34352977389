// SPDX-License-Identifier: MIT
// Questions as data: from options or from a line of a batch, to an answer in JSON.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <boxtree/boxtree.h>

#include "cooker/cli/output.h"
#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

struct RayQuestion {
  Ray ray{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  bool any = false;
};
/// What overlap may leave undecided.
struct OverlapOptions {
  double within = 0;
  std::uint64_t node_budget = kUnlimitedNodes;
};
struct BoxQuestion {
  Eigen::AlignedBox3d box;
  std::optional<OverlapOptions> overlap;  // asked whether there is any, instead of all faces
};
struct SphereQuestion {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius = 0;
};
struct PointQuestion {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  PointOptions options;
  bool with_bounds = false;  // an error or a budget was given
};
struct SecondTree {
  std::filesystem::path file;
  std::string tree = "0";
  std::filesystem::path mesh;  // its source, if its geometry is external
  Pose pose = Pose::Identity();
};
struct PairQuestion {
  SecondTree second;
  bool first_only = false;
};
struct DistanceQuestion {
  SecondTree second;
  DistanceOptions options;
};
struct OverlapQuestion {
  SecondTree second;
  OverlapOptions options;
};
/// Of a scene: what moves against the rest.
struct ContactsQuestion {
  bool first_only = false;
};
using Question = std::variant<RayQuestion, BoxQuestion, SphereQuestion, PointQuestion, PairQuestion,
                              DistanceQuestion, OverlapQuestion, ContactsQuestion>;

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
/// The same for a file that is open; `path` serves messages.
Result<OpenedTree> bind_tree(File opened, const std::filesystem::path& path,
                             const std::string& which, const std::filesystem::path& mesh);

/// Second trees of questions about two, each opened once.
class TreeCache {
 public:
  Result<const Tree*> get(const SecondTree& second);

 private:
  std::map<std::pair<std::string, std::string>, std::unique_ptr<OpenedTree>> opened_;
};

/// "X,Y,Z", or the 12 numbers of a 3x4 matrix row by row. Nothing if it is neither.
[[nodiscard]] std::optional<Pose> parse_pose(std::string_view text);

/// A question from one line of a batch: an object with the names of the options as keys, as in
/// {"kind":"ray","origin":[0,0,9],"direction":[0,0,-1]}. Without "kind" it is `default_kind`.
/// Error: kInvalidQuery with what was expected.
Result<Question> parse_question(std::string_view line, std::string_view default_kind);

/// Answers questions about one thing by alone(question), those about it and a second tree by
/// together(second, question).
template <class Alone, class Together>
Result<Json> ask_one_or_two(const Question& question, TreeCache& others, const Alone& alone,
                            const Together& together) {
  return std::visit(
      [&](const auto& q) -> Result<Json> {
        if constexpr (requires { q.second; }) {
          const Result<const Tree*> second = others.get(q.second);
          if (!second) return second.error();
          return together(**second, q);
        } else {
          return alone(q);
        }
      },
      question);
}

/// The answer in the form that `boxtree query --json` prints.
Result<Json> ask(const Tree& tree, const Question& question, TreeCache& others);

}  // namespace boxtree::cooker
