// SPDX-License-Identifier: MIT
// The handles of the C interface: objects of the C++ one, in memory of the caller's allocator.
#pragma once

#include <boxtree_c.h>
#include <cstddef>
#include <new>
#include <utility>

#include <boxtree/boxtree.h>

#include "format/memory.h"
#include "runtime/c/call.h"

namespace boxtree::c {

/// Where a handle and what it owns is allocated.
class Allocation {
 public:
  /// Operator new.
  Allocation() = default;

  /// Reads what the caller gives; nullptr stands for operator new. False if it has no functions.
  [[nodiscard]] static bool read(const bxt_allocator* given, Allocation& allocation) noexcept {
    if (given == nullptr) return true;
    bxt_allocator hooks = {sizeof(bxt_allocator), nullptr, nullptr, nullptr};
    if (!read_struct(given, hooks) || hooks.allocate == nullptr || hooks.release == nullptr) {
      return false;
    }
    allocation.memory_ = {hooks.context, hooks.allocate, hooks.release};
    return true;
  }

  [[nodiscard]] const Memory& memory() const noexcept { return memory_; }

  /// A new Handle, which knows where it came from. Throws std::bad_alloc.
  template <class Handle, class... Args>
  [[nodiscard]] Handle* make(Args&&... args) const {
    void* const place = allocate(&memory_, sizeof(Handle), alignof(Handle));
    return ::new (place) Handle{std::forward<Args>(args)..., *this};
  }

  /// Ends what make() made; nullptr is nothing.
  template <class Handle>
  static void release(Handle* handle) noexcept {
    if (handle == nullptr) return;
    destroy(handle);
  }

 private:
  Memory memory_;
};

}  // namespace boxtree::c

struct bxt_file {
  boxtree::File inside;
  boxtree::c::Allocation allocation;

  [[nodiscard]] const boxtree::Memory& memory() const noexcept { return allocation.memory(); }
};

struct bxt_tree {
  boxtree::Tree inside;
  boxtree::c::Allocation allocation;

  [[nodiscard]] const boxtree::Memory& memory() const noexcept { return allocation.memory(); }
};

#if BOXTREE_HAS_SCENE_QUERIES
struct bxt_scene {
  boxtree::Scene inside;
  boxtree::c::Allocation allocation;

  [[nodiscard]] const boxtree::Memory& memory() const noexcept { return allocation.memory(); }
};
#endif
