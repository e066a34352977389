// SPDX-License-Identifier: MIT
// Section instance_edges: edges that are boundaries of their tree and not active where an instance
// is placed, because the surface goes on in another instance. A row for each instance at rest, then
// the lists that rows refer to; instances with equal lists share one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "format/bytes.h"

namespace boxtree {

/// The list of an instance: entries `first` to `first` + `count` - 1.
struct EdgeListRow {
  std::uint32_t first;
  std::uint32_t count;
};
static_assert(sizeof(EdgeListRow) == 8 && std::is_trivially_copyable_v<EdgeListRow>);

/// One face of a list, which ascends strictly by face: bit i of `edges` is the edge from corner i
/// of the face to the next one.
struct ListedEdges {
  std::uint32_t face;  // of the tree's order, in a leaf
  std::uint32_t edges;

  [[nodiscard]] static constexpr ListedEdges of(std::uint32_t entry) noexcept {
    return {entry >> kEdgesOfFace, entry & ((1u << kEdgesOfFace) - 1)};
  }
  /// Precondition: face <= kMaxListedFace.
  [[nodiscard]] constexpr std::uint32_t entry() const noexcept {
    return face << kEdgesOfFace | edges;
  }

  static constexpr std::uint32_t kEdgesOfFace = 4;
};
/// Edges of faces after this one cannot be listed: they stay active.
inline constexpr std::uint32_t kMaxListedFace = 0xffffffffu >> ListedEdges::kEdgesOfFace;

/// The list of one instance, or none.
class InactiveEdges {
 public:
  InactiveEdges() noexcept = default;
  InactiveEdges(const std::byte* entries, std::uint32_t count) noexcept
      : entries_(entries), count_(count) {}

  [[nodiscard]] std::uint32_t size() const noexcept { return count_; }
  /// Precondition: i < size().
  [[nodiscard]] ListedEdges operator[](std::uint32_t i) const noexcept {
    return ListedEdges::of(load<std::uint32_t>(entries_, i));
  }
  /// Those of a triangle of a face, as bits: the edge from corner i of the triangle to the next
  /// one. `half`: 1 for the second half (0,2,3) of a quad. O(log size()).
  [[nodiscard]] std::uint32_t of_triangle(std::uint32_t face, std::uint32_t half) const noexcept {
    std::uint32_t first = 0;
    for (std::uint32_t count = count_; count > 0;) {
      const std::uint32_t middle = count / 2;
      const ListedEdges listed = (*this)[first + middle];
      if (listed.face == face) return half == 0 ? listed.edges & 7u : listed.edges >> 2 << 1;
      first += listed.face < face ? middle + 1 : 0;
      count = listed.face < face ? count - middle - 1 : middle;
    }
    return 0;
  }

 private:
  const std::byte* entries_ = nullptr;
  std::uint32_t count_ = 0;
};

/// The section, or none.
class InstanceEdgesView {
 public:
  InstanceEdgesView() noexcept = default;
  /// Precondition: are_rows_inside(section.size(), static_count).
  InstanceEdgesView(Bytes section, std::uint32_t static_count) noexcept
      : rows_(section.data()),
        row_count_(section.empty() ? 0 : static_count),
        entry_count_((section.size() - row_count_ * sizeof(EdgeListRow)) / sizeof(std::uint32_t)) {}

  /// Whether a section of that size has a row for each instance at rest, and whole entries.
  [[nodiscard]] static constexpr bool are_rows_inside(std::uint64_t bytes,
                                                      std::uint32_t static_count) noexcept {
    const std::uint64_t rows = std::uint64_t{static_count} * sizeof(EdgeListRow);
    return bytes == 0 || (bytes >= rows && (bytes - rows) % sizeof(std::uint32_t) == 0);
  }

  [[nodiscard]] std::uint64_t entry_count() const noexcept { return entry_count_; }
  /// Precondition: the instance rests, and there is a section.
  [[nodiscard]] EdgeListRow row(std::uint32_t instance) const noexcept {
    return load<EdgeListRow>(rows_, instance);
  }
  /// None for an instance that moves, and where the row is corrupt.
  [[nodiscard]] InactiveEdges of_instance(std::uint32_t instance) const noexcept {
    if (instance >= row_count_) return {};
    const EdgeListRow found = row(instance);
    if (!in_range(found.first, found.count, entry_count_)) return {};
    const std::byte* const entries = rows_ + std::size_t{row_count_} * sizeof(EdgeListRow);
    return {entries + std::size_t{found.first} * sizeof(std::uint32_t), found.count};
  }

 private:
  const std::byte* rows_ = nullptr;
  std::uint32_t row_count_ = 0;
  std::uint64_t entry_count_ = 0;
};

}  // namespace boxtree
