// SPDX-License-Identifier: MIT
// Encoder of the geometry store "grid" (decoder: format/grid.cpp).
#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "cooker/encode/encoded.h"
#include "cooker/encode/face_ids.h"
#include "format/bits.h"
#include "format/grid.h"

namespace boxtree::cooker {
namespace {

using Point = std::array<std::int32_t, 3>;  // grid coordinates

// A face by the indices of its vertices in the cluster.
struct ClusterFace {
  std::array<std::uint16_t, 4> corner;
  std::uint32_t source;
  bool is_quad;
};

// The vertices of one cluster without duplicates. Vertices are compared by coordinates, not by
// source numbers, so vertices that are equal on the grid or were never welded are stored once.
class ClusterVertices {
 public:
  ClusterVertices() { slots_.fill(kFree); }

  [[nodiscard]] std::uint16_t number_of(const Point& point) {
    std::size_t slot = hash(point) % kSlots;
    while (slots_[slot] != kFree && points_[slots_[slot]] != point) slot = (slot + 1) % kSlots;
    if (slots_[slot] == kFree) {
      slots_[slot] = count_;
      points_[count_++] = point;
    }
    return slots_[slot];
  }
  [[nodiscard]] std::uint16_t count() const { return count_; }
  [[nodiscard]] const Point& operator[](std::size_t i) const { return points_[i]; }

 private:
  static constexpr std::size_t kMost = std::size_t{kClusterFaces} * 4;
  static constexpr std::size_t kSlots = 2 * kMost;  // at most half full, so that searches end
  static constexpr std::uint16_t kFree = 0xffff;

  static std::size_t hash(const Point& point) {
    // Fibonacci hashing: 2^64 over the golden ratio.
    std::uint64_t mixed = 0;
    for (const std::int32_t x : point) {
      mixed = (mixed ^ static_cast<std::uint32_t>(x)) * 0x9e3779b97f4a7c15u;
      mixed ^= mixed >> 32;
    }
    return mixed;
  }

  std::array<std::uint16_t, kSlots> slots_;
  std::array<Point, kMost> points_;
  std::uint16_t count_ = 0;
};

// A step of a strip from one face to the next, and the corner that it adds.
struct Step {
  std::uint32_t code = StripStep::kApart;
  std::uint32_t brings = 0;
};

Step step_between(const ClusterFace& from, const ClusterFace& to) {
  for (std::uint32_t edge = 0; edge < 3; ++edge) {
    for (std::uint32_t turn = 0; turn < 3; ++turn) {
      if (to.corner[turn] == from.corner[(edge + 1) % 3] &&
          to.corner[(turn + 1) % 3] == from.corner[edge]) {
        return {StripStep::code(edge, turn), (turn + 2) % 3};
      }
    }
  }
  return {};
}

// Orders the faces of a leaf so that many share an edge with the previous one: from each face,
// walks over shared edges to the neighbour with the fewest others left, and keeps the best walk.
void order_as_strip(std::span<ClusterFace> faces) {
  const std::size_t n = faces.size();
  std::array<std::uint32_t, kLeafFaces> next_to{};  // bit j: j can follow i
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      const bool follows = i != j && step_between(faces[i], faces[j]).code != StripStep::kApart;
      next_to[i] |= (follows ? 1u : 0u) << j;
    }
  }
  std::array<std::size_t, kLeafFaces> best{};
  int best_shared = -1;
  for (std::size_t start = 0; start < n; ++start) {
    std::array<std::size_t, kLeafFaces> walk{};
    std::uint32_t left = (1u << n) - 1;
    int shared = 0;
    std::size_t at = start;
    for (std::size_t length = 0;; ++length) {
      walk[length] = at;
      left &= ~(1u << at);
      if (left == 0) break;
      const std::uint32_t near = next_to[at] & left;
      shared += near != 0 ? 1 : 0;
      int fewest = static_cast<int>(n) + 1;
      for (std::size_t j = 0; j < n; ++j) {
        if ((((near != 0 ? near : left) >> j) & 1u) == 0) continue;
        const int others = std::popcount(next_to[j] & left);
        if (others < fewest) {
          fewest = others;
          at = j;
        }
      }
    }
    if (shared > best_shared) {
      best_shared = shared;
      best = walk;
    }
  }
  std::array<ClusterFace, kLeafFaces> ordered;
  for (std::size_t i = 0; i < n; ++i) ordered[i] = faces[best[i]];
  std::copy_n(ordered.begin(), n, faces.begin());
}

class BitWriter {
 public:
  explicit BitWriter(std::vector<std::byte>& out) : out_(out), at_(8 * out.size()) {}

  void put(std::uint64_t value, std::uint32_t width) {
    out_.resize((at_ + width + 7) / 8);
    write_bits(out_.data(), at_, width, value);
    at_ += width;
  }

 private:
  std::vector<std::byte>& out_;
  std::uint64_t at_;
};

// Appends clusters to `out`, one after another.
class ClusterEncoder {
 public:
  ClusterEncoder(std::vector<std::byte>& out, bool may_have_quads)
      : out_(out), may_have_quads_(may_have_quads) {}

  // Appends the bytes of a cluster. The caller adds their offset to the record.
  ClusterRecord encode(std::span<const ClusterFace> faces, const ClusterVertices& vertices) {
    record_ = {};
    record_.vertex_count = vertices.count();
    number_.assign(vertices.count(), kUnnamed);
    stored_.clear();
    leaves_.clear();
    starts_ = {0};
    for (std::size_t first = 0; first < faces.size(); first += kLeafFaces) {
      write_leaf(faces.subspan(first, std::min<std::size_t>(kLeafFaces, faces.size() - first)));
      starts_.push_back(leaves_.size());
    }
    write_starts();
    out_.insert(out_.end(), leaves_.begin(), leaves_.end());
    write_positions(vertices);
    while (out_.size() % kClusterUnit != 0) out_.push_back(std::byte{0});
    return record_;
  }

 private:
  static constexpr std::uint16_t kUnnamed = 0xffff;

  void write_leaf(std::span<const ClusterFace> faces) {
    BitWriter bits(leaves_);
    bits.put(stored_.size(), width_below(number_.size() + 1));
    named_.clear();
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const ClusterFace& face = faces[f];
      if (may_have_quads_) bits.put(face.is_quad ? 1 : 0, 1);
      const Step step = f == 0 ? Step{} : step_between(faces[f - 1], face);
      if (f > 0) bits.put(step.code, StripStep::kBits);
      if (step.code == StripStep::kApart) {
        for (std::size_t c = 0; c < 3; ++c) refer(face.corner[c], bits);
      } else {
        refer(face.corner[step.brings], bits);
      }
      if (face.is_quad) refer(face.corner[3], bits);
    }
  }

  void refer(std::uint16_t vertex, BitWriter& bits) {
    const auto named = std::find(named_.begin(), named_.end(), vertex);
    if (named != named_.end()) {
      bits.put(0, 2);
      bits.put(static_cast<std::uint64_t>(named - named_.begin()), width_below(named_.size()));
      return;
    }
    named_.push_back(vertex);
    if (number_[vertex] == kUnnamed) {
      number_[vertex] = static_cast<std::uint16_t>(stored_.size());
      stored_.push_back(vertex);
      bits.put(1, 1);
    } else {
      bits.put(2, 2);  // the first bit is the least significant
      bits.put(number_[vertex], width_below(stored_.size()));
    }
  }

  void write_starts() {
    std::size_t least = 255;
    for (std::size_t i = 1; i < starts_.size(); ++i) least = std::min(least, starts_[i] / i);
    std::size_t most = 0;
    for (std::size_t i = 0; i < starts_.size(); ++i) most = std::max(most, starts_[i] - i * least);
    record_.leaf_bytes = static_cast<std::uint8_t>(least);
    record_.leaf_bits = static_cast<std::uint8_t>(std::bit_width(most));
    BitWriter bits(out_);
    for (std::size_t i = 0; i < starts_.size(); ++i) {
      bits.put(starts_[i] - i * least, record_.leaf_bits);
    }
  }

  void write_positions(const ClusterVertices& vertices) {
    Point high = vertices[0];
    record_.origin = vertices[0];
    for (std::size_t i = 0; i < vertices.count(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        record_.origin[k] = std::min(record_.origin[k], vertices[i][k]);
        high[k] = std::max(high[k], vertices[i][k]);
      }
    }
    const auto offset = [&](const Point& point, std::size_t k) {
      return static_cast<std::uint64_t>(std::int64_t{point[k]} - record_.origin[k]);
    };
    for (std::size_t k = 0; k < 3; ++k) {
      record_.width[k] = static_cast<std::uint8_t>(std::bit_width(offset(high, k)));
    }
    BitWriter bits(out_);
    for (const std::uint16_t vertex : stored_) {
      for (std::size_t k = 0; k < 3; ++k) bits.put(offset(vertices[vertex], k), record_.width[k]);
    }
  }

  std::vector<std::byte>& out_;
  bool may_have_quads_;
  ClusterRecord record_{};
  std::vector<std::byte> leaves_;
  std::vector<std::size_t> starts_;    // of leaves, and the end of the last
  std::vector<std::uint16_t> number_;  // where a vertex is stored in the cluster
  std::vector<std::uint16_t> stored_;  // vertices in the order in which they are stored
  std::vector<std::uint16_t> named_;   // vertices that the leaf has used so far
};

// Clusters encoded by one task.
struct Block {
  std::vector<ClusterRecord> records;
  std::vector<std::byte> bytes;
  std::uint32_t vertex_count = 0;
};

Point grid_point(const Positions& positions, std::uint32_t vertex) {
  const Eigen::Vector3d position = positions[vertex];
  Point point;
  for (std::size_t k = 0; k < 3; ++k) {
    const double q = position[static_cast<Eigen::Index>(k)];
    assert(q == std::floor(q) && std::abs(q) <= 1 << 30);
    point[k] = static_cast<std::int32_t>(q);
  }
  return point;
}

Block encode_block(const SourceMesh& mesh, std::span<std::uint32_t> order, bool may_have_quads,
                   LeafOrder leaf_order) {
  Block block;
  ClusterEncoder encoder(block.bytes, may_have_quads);
  for (std::size_t first = 0; first < order.size(); first += kClusterFaces) {
    const std::span<std::uint32_t> of_cluster =
        order.subspan(first, std::min<std::size_t>(kClusterFaces, order.size() - first));
    ClusterVertices vertices;
    std::vector<ClusterFace> faces;
    for (const std::uint32_t source : of_cluster) {
      const Face& face = mesh.faces[source];
      ClusterFace named{{}, source, face.is_quad()};
      for (std::size_t c = 0; c < (named.is_quad ? 4u : 3u); ++c) {
        named.corner[c] = vertices.number_of(grid_point(mesh.positions, face.corner[c]));
      }
      faces.push_back(named);
    }
    for (std::size_t leaf = 0; leaf < faces.size(); leaf += kLeafFaces) {
      const std::size_t count = std::min<std::size_t>(kLeafFaces, faces.size() - leaf);
      if (leaf_order == LeafOrder::kFree) order_as_strip(std::span(faces).subspan(leaf, count));
    }
    for (std::size_t i = 0; i < faces.size(); ++i) of_cluster[i] = faces[i].source;
    const auto offset = static_cast<std::uint32_t>(block.bytes.size() / kClusterUnit);
    block.records.push_back(encoder.encode(faces, vertices));
    block.records.back().offset = offset;
    block.vertex_count += vertices.count();
  }
  return block;
}

}  // namespace

EncodedGeometry encode_grid_geometry(const QuantisedMesh& quantised,
                                     std::vector<std::uint32_t>& order, LeafOrder leaf_order,
                                     bool face_ids) {
  const SourceMesh& mesh = quantised.mesh;
  const bool may_have_quads = std::any_of(mesh.faces.begin(), mesh.faces.end(),
                                          [](const Face& face) { return face.is_quad(); });
  EncodedGeometry out;
  out.geometry = GeometryId::kGrid;
  out.grid_exponent = quantised.step_exponent;
  out.max_vertex_error = quantised.max_vertex_error;
  out.corners_per_face = may_have_quads ? 4 : 3;

  constexpr std::size_t kBlockFaces = std::size_t{64} * kClusterFaces;
  std::vector<Block> blocks((order.size() + kBlockFaces - 1) / kBlockFaces);
  const auto encode = [&](std::size_t i) {
    const std::size_t first = i * kBlockFaces;
    const std::size_t count = std::min(kBlockFaces, order.size() - first);
    blocks[i] =
        encode_block(mesh, std::span(order).subspan(first, count), may_have_quads, leaf_order);
  };
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks.size(), 1),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i < range.end(); ++i) encode(i);
                    });
  std::size_t bytes = kClusterPadding;
  for (const Block& block : blocks) bytes += block.bytes.size();
  if (!blocks.empty()) out.vertices.reserve(bytes);
  for (Block& block : blocks) {
    const auto offset = static_cast<std::uint32_t>(out.vertices.size() / kClusterUnit);
    for (ClusterRecord& record : block.records) record.offset += offset;
    const Bytes records = std::as_bytes(std::span(block.records));
    out.corners.insert(out.corners.end(), records.begin(), records.end());
    out.vertices.insert(out.vertices.end(), block.bytes.begin(), block.bytes.end());
    out.vertex_count += block.vertex_count;
    block = {};
  }
  if (!blocks.empty()) out.vertices.resize(out.vertices.size() + kClusterPadding);
  if (face_ids && !order.empty()) encode_face_ids(mesh, order, out);
  return out;
}

}  // namespace boxtree::cooker
