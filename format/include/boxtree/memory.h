// SPDX-License-Identifier: MIT
// Where files and scenes take the memory from that they own.
#pragma once

#include <cstddef>

namespace boxtree {

/// An allocator of the application's, as functions. Both or none are set; none stands for operator
/// new and, of copied files, for pages of the system. Called on the thread of the call that
/// allocates or frees; must not throw.
struct Memory {
  void* context = nullptr;  ///< Handed to both; has to live as long as what was allocated.
  /// Memory of at least `size` bytes at a multiple of `alignment` (a power of two), or nullptr,
  /// which is answered with std::bad_alloc; where a file is copied, of its bytes, by kOutOfMemory.
  void* (*allocate)(void* context, std::size_t size, std::size_t alignment) = nullptr;
  /// Takes back what `allocate` gave for the same size and alignment.
  void (*release)(void* context, void* memory, std::size_t size, std::size_t alignment) = nullptr;
};

}  // namespace boxtree
