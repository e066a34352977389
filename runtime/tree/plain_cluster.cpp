// SPDX-License-Identifier: MIT
#include "runtime/tree/plain_cluster.h"

#include <bit>
#include <cstring>

#include "format/bits.h"
#include "runtime/primitive/triangle.h"

namespace boxtree {
namespace {

// Positions of references as floats: [axis][slot].
using LeafPositions = float[3][kMostLeafReferences];

// What the references of a leaf lead to: vertices of the cluster, and where LeafTriangles has their
// positions.
struct LeafReferences {
  std::uint32_t count = 0;
  std::array<std::uint16_t, kMostLeafReferences> vertex;
  std::array<std::uint8_t, kMostLeafReferences> slot;
};

bool find(const ClusterView& clusters, std::uint32_t number, PlainCluster& out) {
  if (out.leaves.cluster == number) return true;
  out.leaves.cluster = LeafTable::kNone;
  Cluster cluster;
  if (!find_cluster(clusters, number, cluster) ||
      cluster.header().group_size() > ClusterHeader::kFastGroupSize ||
      !find_groups(cluster, out.groups)) {
    return false;
  }
  out.leaves = LeafTable(clusters);
  out.leaves.set(number, cluster);
  out.known = 0;
  out.group_count = cluster.groups;
  out.vertices_at = cluster.vertices_at;
  out.bases = cluster.bytes + cluster.bases_at;
  return true;
}

// As LeafDecoder (format/cluster.cpp) reads them: no field leaves the section. False where there is
// no such vertex.
bool find_references(const LeafTable& leaves, const LeafFields& faces, LeafReferences& out) {
  const std::uint32_t is_new = faces.new_thirds | faces.new_others << kLeafFaces;
  std::uint32_t next = faces.before;  // wraps to the first vertex of the cluster
  std::uint32_t at = faces.others;    // bit of the next field
  out.count = kLeafFaces + faces.others;
  for (std::uint32_t r = 0; r < out.count; ++r) {
    std::uint32_t vertex = 0;
    if (((is_new >> r) & 1u) != 0) {
      vertex = ++next;
    } else {
      vertex = faces.last - static_cast<std::uint32_t>(read_bits(faces.bytes, at, faces.old_bits));
      at += faces.old_bits;
    }
    if (vertex > leaves.last_vertex) return false;
    out.vertex[r] = static_cast<std::uint16_t>(vertex);
    out.slot[r] = static_cast<std::uint8_t>(r);
  }
  // Fourth corners come last.
  std::uint32_t r = kLeafFaces + 2 * faces.aparts;
  for (std::uint32_t quads = faces.quads; quads != 0; quads &= quads - 1, ++r) {
    const auto face = static_cast<std::uint32_t>(std::countr_zero(quads));
    out.slot[r] = static_cast<std::uint8_t>(LeafTriangles::kFourths + face);
  }
  return true;
}

// One corner of a face that is not apart is the third of the face before, the other one that it
// shares with that face. False for a step that is none.
bool join_faces(const LeafFields& faces, LeafTriangles& out) {
  std::uint32_t step = StripStep::kApart, apart = kLeafFaces, first = 0, second = 0;
  for (std::uint32_t f = 0; f < kLeafFaces; ++f) {
    if (step > StripStep::kApart) return false;
    if (step == StripStep::kApart) {
      first = apart;
      second = apart + 1;
      apart += 2;
    } else {
      (step >= StripStep::code(1, 0) ? second : first) = f - 1;
    }
    out.step[f] = step;
    out.corner[0][f] = first;
    out.corner[1][f] = second;
    step = (faces.fields >> (StripStep::kBits * f)) & ((1u << StripStep::kBits) - 1);
  }
  return true;
}

std::uint32_t group_of(const PlainCluster& cluster, std::uint32_t vertex) {
  return vertex * cluster.leaves.per_group >> 16;
}

// What all vertices of a cluster have in common on one axis.
struct Axis {
  std::uint64_t origin;
  std::uint32_t base_shift;
  std::uint32_t trailing;
  const std::uint8_t* width;  // of each group
  const std::byte* base;      // of each group

  // Unsigned, so that corrupt sums wrap.
  [[nodiscard]] std::uint64_t number(std::uint64_t offset, std::uint32_t group) const {
    return offset + origin + (std::to_integer<std::uint64_t>(base[group]) << base_shift);
  }
};

std::array<Axis, 3> axes_of(const PlainCluster& cluster, bool is_f64) {
  const ClusterHeaderView header(cluster.leaves.bytes);
  const std::byte* const origins = cluster.leaves.bytes + sizeof(ClusterHeader);
  std::array<Axis, 3> axes;
  for (std::size_t k = 0; k < 3; ++k) {
    axes[k] = {is_f64 ? load<std::uint64_t>(origins, k) : load<std::uint32_t>(origins, k),
               header.base_shift(k), header.trailing(k), cluster.groups.width[k].data(),
               cluster.bases + k * cluster.group_count};
  }
  return axes;
}

// Few groups have the vertices of a leaf, so that they are looked at when one has.
void prepare_group(PlainCluster& cluster, std::uint32_t number) {
  const std::array<Axis, 3> axes = axes_of(cluster, false);
  PlainGroup& group = cluster.group[number];
  for (std::size_t k = 0; k < 3; ++k) {
    group.mask[k] = static_cast<std::uint32_t>(low_bits(axes[k].width[number]));
    group.base[k] = static_cast<std::uint32_t>(axes[k].number(0, number));
  }
  group.bit = 8 * (cluster.vertices_at + cluster.groups.start[number]);
  group.stride = cluster.groups.stride[number];
  group.width = {axes[0].width[number], axes[1].width[number]};
  cluster.known |= 1u << number;
}

// Calls put(slot, x, y, z) with the numbers of each reference, of 32 bits.
template <class Put>
void for_each_number(PlainCluster& cluster, const LeafReferences& references, const Put& put) {
  for (std::uint32_t r = 0; r < references.count; ++r) {
    const std::uint32_t vertex = references.vertex[r];
    const std::uint32_t number = group_of(cluster, vertex);
    if (((cluster.known >> number) & 1u) == 0) prepare_group(cluster, number);
    const PlainGroup& group = cluster.group[number];
    const std::uint32_t at =
        group.bit + (vertex - number * cluster.leaves.group_size) * group.stride;
    const std::byte* const bytes = cluster.leaves.bytes + at / 8;
    std::uint64_t word = load<std::uint64_t>(bytes) >> (at % 8);
    const std::uint32_t x = static_cast<std::uint32_t>(word) & group.mask[0];
    word >>= group.width[0];
    if (group.stride > kMostBitsRead) {  // then an offset may end behind the word
      const std::uint32_t y_at = at % 8 + group.width[0];
      word = load<std::uint64_t>(bytes + y_at / 8) >> (y_at % 8);
    }
    const std::uint32_t y = static_cast<std::uint32_t>(word) & group.mask[1];
    word >>= group.width[1];
    if (group.stride > kMostBitsRead) {
      const std::uint32_t z_at = at % 8 + group.width[0] + group.width[1];
      word = load<std::uint64_t>(bytes + z_at / 8) >> (z_at % 8);
    }
    const std::uint32_t z = static_cast<std::uint32_t>(word) & group.mask[2];
    put(references.slot[r], group.base[0] + x, group.base[1] + y, group.base[2] + z);
  }
}

// What numbers of 32 bits stand for, as LeafTriangles has it.
struct GridNumber {
  [[nodiscard]] static std::uint32_t stored(std::uint32_t number, std::uint32_t trailing) {
    return number << trailing;
  }
  [[nodiscard]] static float position(std::uint32_t stored) {
    return static_cast<float>(static_cast<std::int32_t>(stored));
  }
};
struct FloatNumber {
  [[nodiscard]] static std::uint32_t stored(std::uint32_t number, std::uint32_t trailing) {
    return std::bit_cast<std::uint32_t>(
        float_of_number(static_cast<std::int32_t>(number), trailing));
  }
  [[nodiscard]] static float position(std::uint32_t stored) { return std::bit_cast<float>(stored); }
};

// All slots, used or not: loops of a constant length, which compilers make vectors of.
template <class Number>
void convert(const ClusterHeaderView& header, float scale, LeafTriangles& out,
             LeafPositions& positions) {
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t trailing = header.trailing(k);
    for (std::size_t i = 0; i < kMostLeafReferences; ++i) {
      out.number[k][i] = Number::stored(out.number[k][i], trailing);
    }
    for (std::size_t i = 0; i < kMostLeafReferences; ++i) {
      positions[k][i] = Number::position(out.number[k][i]) * scale;
    }
  }
}

// The faces and the references of a leaf.
bool find_leaf(const ClusterView& clusters, std::uint32_t leaf, PlainCluster& found,
               LeafReferences& references, LeafTriangles& out) {
  LeafFields faces;
  if (!find(clusters, leaf / kClusterLeaves, found) ||
      !found.leaves.find(leaf % kClusterLeaves, faces) ||
      !find_references(found.leaves, faces, references) || !join_faces(faces, out)) {
    return false;
  }
  out.name_lanes(faces.quads);
  return true;
}

// LeafTriangles::number, and the positions, of numbers of 32 bits.
void read_numbers(PlainCluster& cluster, const LeafReferences& references, bool is_grid,
                  float scale, LeafTriangles& out, LeafPositions& positions) {
  std::memset(out.number, 0, sizeof(out.number));
  for_each_number(cluster, references,
                  [&](std::uint32_t slot, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
                    out.number[0][slot] = x;
                    out.number[1][slot] = y;
                    out.number[2][slot] = z;
                  });
  const ClusterHeaderView header(cluster.leaves.bytes);
  if (is_grid) {
    convert<GridNumber>(header, scale, out, positions);
  } else {
    convert<FloatNumber>(header, scale, out, positions);
  }
}

// Positions of numbers of 64 bits, in tree space. False where one is out of range.
bool read_doubles(const PlainCluster& cluster, const LeafReferences& references, const Frame& frame,
                  DoublePositions& out) {
  const std::array<Axis, 3> axes = axes_of(cluster, true);
  for (std::uint32_t r = 0; r < references.count; ++r) {
    const std::uint32_t vertex = references.vertex[r], group = group_of(cluster, vertex);
    std::uint32_t at = 8 * (cluster.vertices_at + cluster.groups.start[group]) +
                       (vertex - group * cluster.leaves.group_size) * cluster.groups.stride[group];
    Eigen::Vector3d stored;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t width = axes[k].width[group];
      const std::uint64_t offset = read_wide_bits(cluster.leaves.bytes, at, width);
      at += width;
      stored[static_cast<Eigen::Index>(k)] = double_of_number(
          static_cast<std::int64_t>(axes[k].number(offset, group)), axes[k].trailing);
    }
    const Eigen::Vector3d position = frame.to_tree(stored);
    if (!is_within_range(position)) return false;
    for (std::size_t k = 0; k < 3; ++k) {
      out[references.slot[r]][k] = position[static_cast<Eigen::Index>(k)];
    }
  }
  return true;
}

}  // namespace

PlainCluster::PlainCluster() noexcept = default;

bool PlainClusterReader::read(std::uint32_t leaf, float scale, LeafTriangles& triangles,
                              LeafCoordinates& out) noexcept {
  LeafReferences references;
  LeafPositions position;
  if (!find_leaf(clusters_, leaf, found_, references, triangles)) return false;
  if (clusters_.numbers != ClusterNumbers::kF64) {
    read_numbers(found_, references, clusters_.numbers == ClusterNumbers::kGrid, scale, triangles,
                 position);
  } else {
    if (!read_doubles(found_, references, frame_, doubles_)) return false;
    for (std::uint32_t r = 0; r < references.count; ++r) {
      const std::uint32_t slot = references.slot[r];
      for (std::size_t k = 0; k < 3; ++k) position[k][slot] = static_cast<float>(doubles_[slot][k]);
    }
  }
  if (triangles.count == kLeafFaces) {
    for (std::uint32_t face = 0; face < kLeafFaces; ++face) {
      const std::uint32_t first = triangles.corner[0][face], second = triangles.corner[1][face];
      for (std::size_t k = 0; k < 3; ++k) {
        out[0][k][face] = position[k][first];
        out[1][k][face] = position[k][second];
        out[2][k][face] = position[k][face];
      }
    }
    return true;
  }
  for (std::uint32_t lane = 0; lane < triangles.count; ++lane) {
    std::uint32_t corner[3];
    triangles.find_corners(lane, corner);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) out[c][k][lane] = position[k][corner[c]];
    }
  }
  return true;
}

}  // namespace boxtree
