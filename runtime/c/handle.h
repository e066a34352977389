// SPDX-License-Identifier: MIT
// The handles of the C interface: objects of the C++ one, in memory of the caller's allocator.
#pragma once

#include <boxtree_c.h>
#include <cstddef>
#include <new>
#include <utility>

#include <boxtree/boxtree.h>

#include "runtime/c/call.h"

namespace boxtree::c {

/// Where a handle allocates.
class Allocation {
 public:
  /// That of C++.
  Allocation() = default;

  /// Reads what the caller gives; nullptr stands for that of C++. False if it has no functions.
  [[nodiscard]] static bool read(const bxt_allocator* given, Allocation& allocation) noexcept {
    if (given == nullptr) return true;
    return read_struct(given, allocation.hooks_) && allocation.hooks_.allocate != nullptr &&
           allocation.hooks_.release != nullptr;
  }

  /// A new Handle, which knows where it came from. Throws std::bad_alloc.
  template <class Handle, class... Args>
  [[nodiscard]] Handle* make(Args&&... args) const {
    void* const memory = allocate(sizeof(Handle), alignof(Handle));
    if (memory == nullptr) throw std::bad_alloc();
    return ::new (memory) Handle{std::forward<Args>(args)..., *this};
  }

  /// Ends what make() made; nullptr is nothing.
  template <class Handle>
  static void release(Handle* handle) noexcept {
    if (handle == nullptr) return;
    const Allocation allocation = handle->allocation;
    handle->~Handle();
    allocation.release(handle, sizeof(Handle), alignof(Handle));
  }

 private:
  [[nodiscard]] void* allocate(std::size_t size, std::size_t alignment) const {
    if (hooks_.allocate != nullptr) return hooks_.allocate(hooks_.context, size, alignment);
    return ::operator new(size, std::align_val_t(alignment));
  }
  void release(void* memory, std::size_t size, std::size_t alignment) const noexcept {
    if (hooks_.release != nullptr) {
      hooks_.release(hooks_.context, memory, size, alignment);
    } else {
      ::operator delete(memory, std::align_val_t(alignment));
    }
  }

  bxt_allocator hooks_ = {sizeof(bxt_allocator), nullptr, nullptr, nullptr};
};

}  // namespace boxtree::c

struct bxt_file {
  boxtree::File inside;
  boxtree::c::Allocation allocation;
};

struct bxt_tree {
  boxtree::Tree inside;
  boxtree::c::Allocation allocation;
};

#if BOXTREE_HAS_SCENE_QUERIES
struct bxt_scene {
  boxtree::Scene inside;
  boxtree::c::Allocation allocation;
};
#endif
