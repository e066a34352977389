// SPDX-License-Identifier: MIT
// Objects and arrays in the memory of an application.
#pragma once

#include <cstddef>
#include <new>
#include <type_traits>
#include <vector>

#include <boxtree/memory.h>

namespace boxtree {

/// Throws std::bad_alloc where there is none. Null stands for operator new.
[[nodiscard]] void* allocate(const Memory* memory, std::size_t size, std::size_t alignment);
/// What allocate() gave for the same size and alignment.
void release(const Memory* memory, void* place, std::size_t size, std::size_t alignment) noexcept;

/// Ends an object in memory that allocate() gave, whose Memory may be a part of it.
template <class T>
void destroy(const T* object) noexcept {
  const Memory memory = object->memory();
  auto* const place = const_cast<T*>(object);  // only what is constant for others is
  place->~T();
  release(&memory, place, sizeof(T), alignof(T));
}

/// Allocates for containers of the standard library. Keeps a pointer: the Memory has to live as
/// long as they do, in the object that owns them.
template <class T>
class MemoryOf {
 public:
  using value_type = T;
  using propagate_on_container_move_assignment = std::true_type;
  using propagate_on_container_swap = std::true_type;

  MemoryOf() = default;
  MemoryOf(const Memory* memory) noexcept : memory_(memory) {}
  template <class U>
  MemoryOf(const MemoryOf<U>& other) noexcept : memory_(other.memory()) {}

  [[nodiscard]] T* allocate(std::size_t count) {
    return static_cast<T*>(boxtree::allocate(memory_, count * sizeof(T), alignof(T)));
  }
  void deallocate(T* place, std::size_t count) noexcept {
    release(memory_, place, count * sizeof(T), alignof(T));
  }
  [[nodiscard]] const Memory* memory() const noexcept { return memory_; }
  template <class U>
  [[nodiscard]] bool operator==(const MemoryOf<U>& other) const noexcept {
    return memory_ == other.memory();
  }

 private:
  const Memory* memory_ = nullptr;
};

/// An array there. Moving one takes its memory along.
template <class T>
using Array = std::vector<T, MemoryOf<T>>;

}  // namespace boxtree
