// SPDX-License-Identifier: MIT
// Finds nodes as assimp does, starting at the scene.
#include "cooker/import/collada_nodes.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/node_nesting.h"
#include "cooker/import/transform_values.h"

namespace boxtree::cooker {
namespace {

struct TransformKind {
  std::string_view name;
  std::size_t numbers;
};
constexpr std::array kTransformKinds = {TransformKind{"matrix", 16}, TransformKind{"rotate", 4},
                                        TransformKind{"translate", 3}, TransformKind{"scale", 3},
                                        TransformKind{"lookat", 9}};

class NodeChecker {
 public:
  NodeChecker(const std::unordered_set<std::string>& ids, ColladaFaults& faults)
      : ids_(ids), faults_(faults) {}

  bool check(pugi::xml_node collada) {
    collect(collada);
    if (root_ == kNone) return true;  // assimp refuses it
    // The first that assimp comes to, by its name or id.
    for (std::uint32_t i = root_; i < nodes_[root_].end; ++i) {
      const char* const unnamed = i == root_ ? "Scene" : "";
      by_name_.emplace(nodes_[i].element.attribute("name").as_string(unnamed), i);
      by_name_.emplace(nodes_[i].element.attribute("id").as_string(), i);
    }
    return check_placed();
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Node {
    pugi::xml_node element;
    std::uint32_t end = 0;  // of a scene or a node in a library: behind the last node in it
    std::vector<std::uint32_t> children;
  };

  void collect(pugi::xml_node collada) {
    for (const pugi::xml_node part : collada.children()) {
      const std::string_view name = part.name();
      if (name == "library_visual_scenes" || name == "library_nodes") {
        const char* const kind = name == "library_nodes" ? "node" : "visual_scene";
        for (const pugi::xml_node tree : part.children(kind)) {
          library_[tree.attribute("id").as_string()] = add_tree(tree);
        }
      } else if (name == "scene") {
        const std::string_view url = part.child("instance_visual_scene").attribute("url").value();
        const auto found = library_.find(std::string(url.substr(url.empty() ? 0 : 1)));
        if (root_ == kNone && found != library_.end()) root_ = found->second;
      }
    }
  }

  // Nodes in the order of the document.
  std::uint32_t add_tree(pugi::xml_node tree) {
    const auto root = static_cast<std::uint32_t>(nodes_.size());
    std::vector<std::pair<pugi::xml_node, std::uint32_t>> left{{tree, kNone}};
    while (!left.empty()) {
      const auto [element, parent] = left.back();
      left.pop_back();
      const auto node = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back({element, 0, {}});
      if (parent != kNone) nodes_[parent].children.push_back(node);
      for (pugi::xml_node child = element.last_child(); child; child = child.previous_sibling()) {
        if (std::string_view(child.name()) == "node") left.emplace_back(child, node);
      }
    }
    nodes_[root].end = static_cast<std::uint32_t>(nodes_.size());
    return root;
  }

  // All nodes that the scene leads to, numbered as they are found.
  bool check_placed() {
    std::vector<std::uint32_t> placed{root_}, number_of(nodes_.size(), kNone);
    number_of[root_] = 0;
    NodesBelow children;
    for (std::size_t next = 0; next < placed.size(); ++next) {
      std::vector<std::uint32_t> below = nodes_[placed[next]].children;
      if (!check_parts(nodes_[placed[next]].element, below)) return false;
      for (std::uint32_t& child : below) {
        if (number_of[child] == kNone) {
          number_of[child] = static_cast<std::uint32_t>(placed.size());
          placed.push_back(child);
        }
        child = number_of[child];
      }
      children.push_back(std::move(below));
    }
    const auto fault = find_nesting_fault(children);
    if (!fault) return true;
    enter(nodes_[placed[fault->node]].element);
    return faults_.fail("", "instances of nodes that end", fault->what);
  }

  void enter(pugi::xml_node element) {
    const std::string_view id = element.attribute("id").as_string();
    faults_.enter(element, id.empty() ? "" : " " + in_quotes(id));
  }

  // Adds the nodes that it has instances of to `below`.
  bool check_parts(pugi::xml_node element, std::vector<std::uint32_t>& below) {
    enter(element);
    for (const pugi::xml_node part : element.children()) {
      const std::string_view name = part.name();
      if (name == "skew") {
        return faults_.fail("skew", "none, since assimp's reader crashes on it",
                            "one; export without skew, as a matrix");
      }
      for (const TransformKind& kind : kTransformKinds) {
        if (name == kind.name && !check_transform(part, kind)) return false;
      }
      if (name == "instance_node" && !add_instance(part, below)) return false;
      const bool is_mesh = name == "instance_geometry" || name == "instance_controller";
      std::string id;
      if (is_mesh && !faults_.reference(part, "url", id)) return false;
      if (is_mesh && !ids_.contains(id)) {
        return faults_.fail(fmt::format("{}: url", name), "the id of a geometry or controller",
                            in_quotes(id));
      }
    }
    return true;
  }

  bool add_instance(pugi::xml_node instance, std::vector<std::uint32_t>& below) {
    std::string id;
    if (!faults_.reference(instance, "url", id)) return false;
    auto found = library_.find(id);
    if (found == library_.end()) {
      found = by_name_.find(id);
      if (found == by_name_.end()) {
        return faults_.fail("instance_node: url",
                            "the id of a node of the scene, or of one right in library_nodes",
                            in_quotes(id));
      }
    }
    below.push_back(found->second);
    return true;
  }

  bool check_transform(pugi::xml_node transform, const TransformKind& kind) {
    std::string_view text;
    if (!faults_.text(transform, text)) return false;
    std::array<double, 16> numbers{};
    std::size_t count = 0;
    const bool are_numbers = each_word(text, [&](std::string_view word) {
      const std::optional<double> number = collada_number(word);
      if (!number) return faults_.fail(kind.name, "numbers", in_quotes(word));
      if (count < numbers.size()) numbers[count] = *number;
      ++count;
      return true;
    });
    if (!are_numbers) return false;
    if (count != kind.numbers) {
      return faults_.fail(kind.name, fmt::format("{} numbers", kind.numbers),
                          std::to_string(count));
    }
    if (kind.name == "rotate") return check_axis(numbers);
    return kind.name != "matrix" || check_last_row(numbers);
  }

  // Assimp's matrix of a rotation about another axis scales.
  bool check_axis(const std::array<double, 16>& numbers) {
    const double length = std::hypot(numbers[0], numbers[1], numbers[2]);
    return std::fmod(numbers[3], 360) == 0 || is_unit_length(length) ||
           faults_.fail("rotate", "an axis of length 1, which assimp takes it for",
                        fmt::format("length {:.6g}", length));
  }

  bool check_last_row(const std::array<double, 16>& numbers) {
    for (std::size_t i = 12; i < 16; ++i) {
      if (!is_in_last_row(numbers[i], i - 12)) {
        return faults_.fail("matrix", "0, 0, 0, 1 as its last row",
                            fmt::format("{:.6g} in column {}", numbers[i], i - 12));
      }
    }
    return true;
  }

  const std::unordered_set<std::string>& ids_;
  ColladaFaults& faults_;
  std::vector<Node> nodes_;
  std::uint32_t root_ = kNone;
  std::unordered_map<std::string, std::uint32_t> library_, by_name_;
};

}  // namespace

bool check_nodes(pugi::xml_node collada, const std::unordered_set<std::string>& ids,
                 ColladaFaults& faults) {
  return NodeChecker(ids, faults).check(collada);
}

}  // namespace boxtree::cooker
