// SPDX-License-Identifier: MIT
// The pending entries of a best-first walk, in memory of fixed size.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace boxtree {

/// Pending entries, the one with the least key first; of equal keys the one pushed last, so that a
/// walk among boxes that all overlap goes down and not sideways. When the queue is full, new
/// entries go to a stack, and pop() empties that first: the walk is depth-first for a while, and no
/// entry is lost. `Stack` must hold the pending entries of a depth-first walk.
template <class Entry, std::size_t Queue, std::size_t Stack>
class Frontier {
 public:
  /// Adds an entry with a key; entries with keys of `enough` and above will never be taken. False
  /// when not even the stack has room: then the tree is deeper than any valid one.
  [[nodiscard]] bool push(double key, double enough, const Entry& entry) noexcept {
    if (queued_ == Queue && enough < swept_) sweep(enough);
    const std::size_t before = queued_;
    if (!add(key, entry)) return false;
    if (queued_ != before) std::push_heap(handles_.begin(), end());
    return true;
  }

  /// The same for entries that sort() puts in order before any is taken and before least_left():
  /// many of them may have become too far by then.
  [[nodiscard]] bool add(double key, const Entry& entry) noexcept {
    if (stacked_ > 0 || queued_ == Queue) {
      if (stacked_ == Stack) return false;
      stack_[stacked_++] = {key, entry};
      return true;
    }
    // Places of entries that were taken stay in the handles behind the queue, for reuse.
    if (queued_ == places_)
      handles_[places_].place = static_cast<std::uint32_t>(places_), ++places_;
    Handle& handle = handles_[queued_++];
    handle.key = key;
    handle.number = pushed_++;
    entries_[handle.place] = entry;
    return true;
  }
  void sort(double enough) noexcept { sweep(enough); }

  /// Takes the next entry whose key is below `enough`; false if there is none.
  [[nodiscard]] bool pop(double enough, double& key, Entry& entry) noexcept {
    return pop(enough, key, entry, [](const Entry&) { return 0.0; });
  }

  /// The same where keys may have grown since entries were pushed: `key_now` computes that of an
  /// entry. Each turn of the loop below gives an entry its key of now, so there are no more turns
  /// than entries.
  template <class KeyNow>
  [[nodiscard]] bool pop(double enough, double& key, Entry& entry, KeyNow key_now) noexcept {
    while (stacked_ > 0) {
      const Stacked& top = stack_[--stacked_];
      const double now = std::max(top.key, key_now(top.entry));
      if (!(now < enough)) {
        least_left_ = std::min(least_left_, now);
        continue;
      }
      key = now;
      entry = top.entry;
      return true;
    }
    while (queued_ > 0 && handles_.front().key < enough) {
      const double now = key_now(entries_[handles_.front().place]);
      std::pop_heap(handles_.begin(), end());
      Handle& handle = handles_[queued_ - 1];
      if (!(now > handle.key)) {
        key = handle.key;
        entry = entries_[handle.place];
        --queued_;
        return true;
      }
      if (now < enough) {
        handle.key = now;
        std::push_heap(handles_.begin(), end());
      } else {
        least_left_ = std::min(least_left_, now);
        --queued_;
      }
    }
    return false;
  }

  /// The least key of all that was pushed and not taken; infinity if there is none.
  [[nodiscard]] double least_left() const noexcept {
    double least = least_left_;
    if (queued_ > 0) least = std::min(least, handles_.front().key);
    for (std::size_t i = 0; i < stacked_; ++i) least = std::min(least, stack_[i].key);
    return least;
  }

 private:
  struct Handle {
    double key;
    std::uint32_t number;  // when it was pushed; only decides ties
    std::uint32_t place;

    // The standard library's heaps have the greatest in front.
    friend bool operator<(const Handle& a, const Handle& b) noexcept {
      return a.key != b.key ? a.key > b.key : a.number < b.number;
    }
  };
  struct Stacked {
    double key;
    Entry entry;
  };

  [[nodiscard]] auto end() noexcept {
    return handles_.begin() + static_cast<std::ptrdiff_t>(queued_);
  }

  // Drops what will never be taken. Once for each value of `enough`: it costs as much as the queue
  // is long.
  [[gnu::noinline]] void sweep(double enough) noexcept {
    swept_ = enough;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < queued_; ++i) {
      if (handles_[i].key < enough) {
        std::swap(handles_[kept++], handles_[i]);
      } else {
        least_left_ = std::min(least_left_, handles_[i].key);
      }
    }
    queued_ = kept;
    std::make_heap(handles_.begin(), end());
  }

  std::size_t queued_ = 0;
  std::size_t places_ = 0;  // that handles refer to
  std::size_t stacked_ = 0;
  std::uint32_t pushed_ = 0;
  double swept_ = std::numeric_limits<double>::infinity();
  double least_left_ = std::numeric_limits<double>::infinity();
  std::array<Handle, Queue> handles_;
  std::array<Entry, Queue> entries_;
  std::array<Stacked, Stack> stack_;
};

}  // namespace boxtree
