// SPDX-License-Identifier: MIT
// Inputs of the targets that query: a file, and behind it 64 bytes that say what is queried.
// Behind, so that what libFuzzer inserts or cuts off leaves the file's offsets alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include <boxtree/boxtree.h>

namespace boxtree::fuzz {

inline constexpr std::size_t kQueryBytes = 64;

/// Numbers of every magnitude, and options, out of any 64 bytes.
class QueryInput {
 public:
  explicit QueryInput(Bytes bytes);

  /// Number 0 to 11: small fractions mostly, also powers of two of every size, infinities and NaN.
  [[nodiscard]] double number(std::size_t index) const;
  [[nodiscard]] Eigen::Vector3d vector(std::size_t index) const;  // from that number on
  /// The identity, a shift by the numbers from 9 on, or all twelve of them as a matrix.
  [[nodiscard]] Pose pose() const;
  /// Byte 0 to 15.
  [[nodiscard]] std::uint8_t option(std::size_t index) const;
  /// None, or a few nodes.
  [[nodiscard]] QueryLimits limits() const;

 private:
  std::array<std::byte, kQueryBytes> bytes_{};
};

/// An input, split into file and query. The file lies at the end of memory of its own, at an
/// offset of 0 to 7 from an aligned address, so that a read behind it is found and misaligned ones
/// happen.
struct Input {
  explicit Input(Bytes bytes);
  [[nodiscard]] Bytes file() const { return Bytes(memory).subspan(shift); }

  QueryInput query;
  std::size_t shift;
  std::vector<std::byte> memory;
};

/// Holds what queries on a file say against what `verify` says of it.
class Check {
 public:
  /// `mesh`: of trees with external geometry. `file` outlives the check.
  explicit Check(const File& file, const std::optional<MeshArrays>& mesh = {})
      : file_(file), mesh_(mesh) {}

  /// Takes each Result of a query: an error of corrupt bytes is a finding when `verify` accepts the
  /// file.
  template <class R>
  void operator()(const R& result) const {
    if (!result.ok()) error(result.code());
  }
  /// The same of an error.
  void error(Errc code) const;
  /// Takes what answers promise of a file that `verify` accepts.
  void holds(bool is_true, const char* otherwise) const;

 private:
  [[nodiscard]] bool is_file_valid() const;

  const File& file_;
  std::optional<MeshArrays> mesh_;
};

}  // namespace boxtree::fuzz
