// SPDX-License-Identifier: MIT
#include "format/memory.h"

namespace boxtree {
namespace {

// Operator new aligns so, whatever is wanted.
bool is_usual(std::size_t alignment) {
  return alignment <= __STDCPP_DEFAULT_NEW_ALIGNMENT__;
}

}  // namespace

void* allocate(const Memory* memory, std::size_t size, std::size_t alignment) {
  if (memory == nullptr || memory->allocate == nullptr) {
    return is_usual(alignment) ? ::operator new(size)
                               : ::operator new(size, std::align_val_t(alignment));
  }
  void* const place = memory->allocate(memory->context, size, alignment);
  if (place == nullptr) throw std::bad_alloc();
  return place;
}

void release(const Memory* memory, void* place, std::size_t size, std::size_t alignment) noexcept {
  if (memory != nullptr && memory->release != nullptr) {
    memory->release(memory->context, place, size, alignment);
  } else if (is_usual(alignment)) {
    ::operator delete(place);
  } else {
    ::operator delete(place, std::align_val_t(alignment));
  }
}

}  // namespace boxtree
