// SPDX-License-Identifier: MIT
#include "runtime/query/best_first.h"

#include <algorithm>
#include <bit>

#include "runtime/tree/root_box.h"
#include "runtime/walk/frontier.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
namespace {

class BestFirst {
 public:
  BestFirst(PointQuery& query, SearchBudget& budget, const NearNodes& nodes) noexcept
      : query_(query), budget_(budget), nodes_(nodes) {}

  Errc run(const BoundTree& tree) noexcept {
    const Errc error = visit({root_box<double>(tree), tree.root_ref(), tree.is_leaf()});
    sort();
    budget_.left = std::min(budget_.left, frontier_.least_left());
    return error;
  }

 private:
  static constexpr std::size_t kQueue = 1024;
  struct Entry {
    Box<double> box;
    NodeRef ref;
    bool is_leaf;
  };

  Errc visit(Entry entry) noexcept {
    double key = query_.key(entry.box);
    if (!push(key, enough(), entry)) return Errc::kInternal;
    while (pop(key, entry)) {
      bool goes_on = true;
      while (goes_on) {
        if (query_.nodes_expanded == budget_.nodes) {
          budget_.left = std::min(budget_.left, key);
          budget_.is_spent = true;
          return Errc::kOk;
        }
        ++query_.nodes_expanded;
        if (entry.is_leaf) {
          if (!nodes_.read(entry.ref)) return Errc::kOk;
          break;
        }
        Errc error = nodes_.expand(entry.ref, entry.box, children_);
        if (error == Errc::kOk) error = queue_children(goes_on, key, entry);
        if (error != Errc::kOk) return error;
      }
    }
    return Errc::kOk;
  }

  // The least key that is too large: equal distances are visited, so that ties end as in the exact
  // query. Keys are not negative, so that the next double is the next number in bits.
  [[nodiscard]] double enough() const noexcept {
    const double bound = query_.bound();
    if (bound == std::numeric_limits<double>::infinity()) return bound;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(bound) + 1);
  }

  [[nodiscard]] bool pop(double& key, Entry& entry) noexcept {
    sort();
    return frontier_.pop(enough(), key, entry);
  }
  void sort() noexcept {
    if (!is_sorted_) frontier_.sort(enough());
    is_sorted_ = true;
  }

  // Until something is found most children are as good as any, and are left out afterwards.
  [[nodiscard, gnu::noinline]] bool push(double key, double limit, const Entry& entry) noexcept {
    if (query_.found) return frontier_.push(key, limit, entry);
    is_sorted_ = false;
    return frontier_.add(key, entry);
  }

  [[nodiscard]] Entry child(std::uint32_t i) const noexcept {
    return {children_.box(i), children_.ref[i], children_.is_leaf(i)};
  }

  // Until something is found the nearest child is visited next, and not queued.
  Errc queue_children(bool& goes_on, double& key, Entry& entry) noexcept {
    const double limit = enough();
    std::uint32_t nearest = 0;
    goes_on = false;
    if (!query_.found) {
      for (std::uint32_t i = 1; i < children_.count; ++i) {
        if (children_.key[i] < children_.key[nearest]) nearest = i;
      }
      goes_on = children_.count > 0 && children_.key[nearest] < limit;
    }
    // No branch on whether a child is near: it is as likely as not.
    std::uint32_t near = 0;
    double left = budget_.left;
    for (std::uint32_t i = 0; i < children_.count; ++i) {
      const bool is_near = children_.key[i] < limit;
      near |= static_cast<std::uint32_t>(is_near) << i;
      left = std::min(left, is_near ? left : children_.key[i]);
    }
    budget_.left = left;
    if (goes_on) near &= ~(1u << nearest);
    for (; near != 0; near &= near - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(near));
      if (!push(children_.key[i], limit, child(i))) return Errc::kDepthExceeded;
    }
    if (goes_on) {
      key = children_.key[nearest];
      entry = child(nearest);
    }
    return Errc::kOk;
  }

  PointQuery& query_;
  SearchBudget& budget_;
  const NearNodes& nodes_;
  bool is_sorted_ = true;  // the frontier
  NearChildren children_;
  Frontier<Entry, kQueue, kStackSize<ErasedCodec>> frontier_;
};

}  // namespace

Errc search_best_first(const BoundTree& tree, PointQuery& query, SearchBudget& budget,
                       const NearNodes& nodes) noexcept {
  return BestFirst(query, budget, nodes).run(tree);
}

Errc search_best_first(const BoundTree& tree, PointQuery& query, SearchBudget& budget) noexcept {
  const ErasedCodec codec{&tree};
  const auto expand = [&](NodeRef node, const Box<double>& box, NearChildren& out) {
    const Errc error = query.nodes.count(codec.expand(node, box, out));
    if (error != Errc::kOk) return error;
    for (std::uint32_t i = 0; i < out.count; ++i) out.key[i] = query.key(out.box(i));
    return Errc::kOk;
  };
  const auto read = [&](NodeRef leaf) { return query.read(leaf); };
  return search_best_first(tree, query, budget, {expand, read});
}

Errc search_within(const BoundTree& tree, PointQuery& query, SearchBudget& budget) noexcept {
  if constexpr (kWalksTreesByVectors) {
    if (has_wide_nodes(tree)) return walk_wide(tree, query, budget);
  }
  return search_best_first(tree, query, budget);
}

}  // namespace boxtree
