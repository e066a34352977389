// SPDX-License-Identifier: MIT
// Batches of rays over the wide codecs. Rays go through a tree in packets: a node or leaf is
// decoded once for all rays of a packet that reach it; each ray then meets eight boxes or triangles
// side by side, as a ray alone does. The closest hit of a ray does not depend on the order of a
// walk, so answers are those of rays alone; any hit does, so those rays are walked one by one.
#include <bit>
#include <optional>

#include "runtime/query/ray_batch_query.h"
#include "runtime/query/ray_filter.h"
#include "runtime/walk/packets.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/ray_batch_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/ray_set_up-inl.h"
#include "runtime/query/ray_triangles-inl.h"
#include "runtime/walk/prefetch-inl.h"
#include "runtime/walk/traversal_stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
void walk_ray_batch(RayBatch& batch) {
  for (std::size_t i = 0; i < batch.rays.size(); ++i) batch.answer_alone(i);
}
#else
// A set of rays of a packet: bit r is ray r.
using RaySet = std::uint32_t;
constexpr std::uint32_t kMostRays = RaySetUp::kMost;
static_assert(kMostRays % kWideChildren == 0 && kMostRays < 32);

// The rays of a packet that go to a child. Bit c of byte r: ray r goes to child c.
HWY_INLINE RaySet rays_through(const std::uint8_t* children_of_ray, std::uint32_t child) {
  RaySet rays = 0;
  for (std::uint32_t first = 0; first < kMostRays; first += 8) {
    constexpr std::uint64_t kLowest = 0x0101010101010101u;
    // Moves bit 8 j to bit 56 + j; no two bits of the product meet.
    constexpr std::uint64_t kGather = 0x0102040810204080u;
    const auto bytes =
        load<std::uint64_t>(reinterpret_cast<const std::byte*>(children_of_ray + first));
    rays |= static_cast<RaySet>((((bytes >> child) & kLowest) * kGather) >> 56) << first;
  }
  return rays;
}

// The rays that are in flight, and what of them does not depend on the codec.
class RayPacket {
 public:
  static constexpr std::size_t kMost = kMostRays;

  explicit RayPacket(RayBatch& batch) : batch_(batch), set_up_(batch.tree), leaf_(batch.tree) {}

  // Takes the rays of the batch from `first` on, `count` of them; those that miss the root box, or
  // are not set up side by side, get their answers.
  HWY_NOINLINE void take(std::size_t first, std::size_t count) {
    first_ = first;
    set_up_.set_up(batch_.rays.subspan(first, count));
    rays_ = set_up_.entering();
    filtered_ = prepared_ = 0;
    for (RaySet rest = ((1u << count) - 1) & ~rays_; rest != 0; rest &= rest - 1) {
      const auto r = static_cast<std::uint32_t>(std::countr_zero(rest));
      if (((set_up_.taken() >> r) & 1u) != 0) {
        batch_.answer_nothing(first + r);
      } else {
        batch_.answer_alone(first + r);
      }
    }
    const Floats d;
    for (std::size_t r = 0; r < kMostRays; r += kLanes) {
      hn::Store(hn::Load(d, set_up_.bounds() + r), d, bound_ + r);
    }
  }

  // Those that are in flight.
  [[nodiscard]] RaySet all() const { return rays_; }

  // Walks the tree with each ray by itself. Setting them up side by side pays all the same.
  HWY_NOINLINE void walk_alone(std::size_t first, std::size_t count) {
    take(first, count);
    for (RaySet rest = rays_; rest != 0; rest &= rest - 1) {
      const auto r = static_cast<std::uint32_t>(std::countr_zero(rest));
      WalkBound nodes(batch_.tree.node_count());
      const auto prepare = [&]() -> RayTest& { return test(r); };
      FilteredRay ray{filter(r), set_up_.t_max(r), nodes, prepare};
      answer(r, walk_wide(batch_.tree, ray));
    }
  }

  // Every ray's answer, once the walk is over. `walked`: its error, which any of them may have come
  // upon.
  HWY_NOINLINE void answer(Errc walked) {
    for (RaySet rest = rays_; rest != 0; rest &= rest - 1) {
      answer(static_cast<std::uint32_t>(std::countr_zero(rest)), walked);
    }
  }

  // Those of the rays whose bound is not below `key`.
  HWY_INLINE RaySet before_bound(RaySet rays, float key) const {
    const Floats d;
    RaySet left = 0;
    for (std::size_t r = 0; r < kMostRays; r += kLanes) {
      left |= bits_of(hn::Ge(hn::Load(d, bound_ + r), hn::Set(d, key))) << r;
    }
    return rays & left;
  }

  // Bit c: one of `rays` meets child c before its bound; at the earliest at least[c].
  HWY_INLINE std::uint32_t meet(const ChildBoxes& boxes, RaySet rays, std::uint8_t* children_of_ray,
                                float* least) {
    const Floats d;
    FloatVector key[kParts];
    for (std::size_t part = 0; part < kParts; ++part) {
      key[part] = hn::Set(d, std::numeric_limits<float>::infinity());
    }
    std::uint32_t passing = 0;
    const float* const planes = &boxes.low[0][0];
    constexpr std::size_t kSide = offsetof(ChildBoxes, high) / sizeof(float);
    for (; rays != 0; rays &= rays - 1) {
      const auto r = static_cast<std::uint32_t>(std::countr_zero(rays));
      std::uint32_t bits = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        FloatVector enter = hn::Zero(d);
        FloatVector leave = hn::Set(d, bound_[r]);
        for (std::size_t k = 0; k < 3; ++k) {
          const float* const axis = planes + k * kWideChildren + part * kLanes;
          const FloatVector inverse = hn::Set(d, set_up_.inverse(k, r));
          const std::size_t near_high = set_up_.near_high(k, r);
          enter = hn::Max(enter, hn::MulAdd(hn::Load(d, axis + near_high * kSide), inverse,
                                            hn::Set(d, set_up_.near_offset(k, r))));
          leave = hn::Min(leave, hn::MulAdd(hn::Load(d, axis + (1 - near_high) * kSide), inverse,
                                            hn::Set(d, set_up_.far_offset(k, r))));
        }
        const auto meets = hn::Le(enter, leave);
        key[part] = hn::Min(key[part], hn::IfThenElse(meets, enter, key[part]));
        hn::Store(enter, d, enter_[r] + part * kLanes);
        bits |= bits_of(meets) << (part * kLanes);
      }
      children_of_ray[r] = static_cast<std::uint8_t>(bits);
      passing |= bits;
    }
    for (std::size_t part = 0; part < kParts; ++part) {
      hn::Store(key[part], d, least + part * kLanes);
    }
    return passing;
  }

  // The leaf that is child `child` of the node that `rays` met last.
  HWY_NOINLINE Errc visit_leaf(std::uint32_t first, std::uint32_t count, RaySet rays,
                               std::uint32_t child) {
    if (!leaf_.load(first, count)) return leaf_.error();
    for (; rays != 0; rays &= rays - 1) {
      const auto r = static_cast<std::uint32_t>(std::countr_zero(rays));
      if (enter_[r][child] > bound_[r]) continue;
      const auto meet = [&](const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
        test(r).test(triangle, face, half);
      };
      if (!test_triangles(leaf_, filter(r), bound_[r], meet)) return leaf_.error();
      if (has_test(r)) bound_[r] = filters_[r].bound(tests_[r]->t_max);
    }
    return Errc::kOk;
  }

 private:
  // What rays need at leaves, which some never reach, and for exact tests, which fewer need.
  HWY_INLINE const RayFilter& filter(std::uint32_t r) {
    if (((filtered_ >> r) & 1u) == 0) {
      filtered_ |= 1u << r;
      set_up_.get(r, filters_[r]);
    }
    return filters_[r];
  }
  [[nodiscard]] bool has_test(std::uint32_t r) const { return ((prepared_ >> r) & 1u) != 0; }
  HWY_INLINE RayTest& test(std::uint32_t r) {
    if (!has_test(r)) prepare(r);
    return *tests_[r];
  }
  HWY_NOINLINE void prepare(std::uint32_t r) {
    const Ray& ray = batch_.rays[first_ + r];
    prepared_ |= 1u << r;
    hits_[r].is_hit = false;
    tests_[r]
        .emplace(batch_.tree, ray, exponent_of(largest_magnitude(ray.direction)), batch_.any,
                 hits_[r], batch_.wishes)
        .prepare();
  }

  void answer(std::uint32_t r, Errc walked) {
    if (walked != Errc::kOk) {
      batch_.answer_alone(first_ + r);
    } else if (has_test(r)) {
      batch_.answer(first_ + r, *tests_[r]);
    } else {
      batch_.answer_nothing(first_ + r);
    }
  }

  RayBatch& batch_;
  std::size_t first_ = 0;  // the place of ray 0 in the batch
  RaySet rays_ = 0, filtered_ = 0, prepared_ = 0;
  RaySetUp set_up_;
  HWY_ALIGN float bound_[kMostRays];  // parameters above it cannot improve the answer
  HWY_ALIGN float enter_[kMostRays][kWideChildren];  // children of the node that was met last
  RayFilter filters_[kMostRays];                     // of the rays `filtered_`
  RayCandidate hits_[kMostRays];                     // of those `prepared_`
  std::optional<RayTest> tests_[kMostRays];
  LeafFloats leaf_;
};

template <class Node>
class RayPacketWalk {
 public:
  RayPacketWalk(const BoundTree& tree, const WideCodec<Node>& codec, RayPacket& packet)
      : codec_(codec),
        packet_(packet),
        prefetch_(tree, codec),
        is_large_(Prefetch<Node>::pays(codec)),
        root_(tree.root_f32()) {}

  // Whether a walk together pays: it does from some 1.9 rays a node on (docs/MEASUREMENTS.md).
  [[nodiscard]] bool was_shared() const { return meets_ >= 2 * nodes_; }

  // The children of a node at depth n are in open_[n]. Pending children belong to nodes on the path
  // to the current one, each at another depth.
  Errc run() {
    WalkBound nodes(codec_.node_count);
    Box<float> box = root_;
    std::size_t depth = 0;
    std::uint32_t number = 0;
    RaySet rays = packet_.all();
    stack_ = {};
    meets_ = nodes_ = 0;
    for (;;) {
      const NodeView<Node> node(codec_, number);
      const WideLinks links = node.links();
      const Errc error = nodes.count(check_links(codec_, number, links));
      if (error != Errc::kOk) return error;
      if (depth == open_.size()) return Errc::kDepthExceeded;
      meets_ += static_cast<std::uint64_t>(std::popcount(rays));
      ++nodes_;
      Children& children = open_[depth];
      children.links = links;
      for (std::size_t part = 0; part < kParts; ++part) decode(node, box, part, children.boxes);
      HWY_ALIGN std::uint8_t children_of_ray[kMostRays] = {};
      const std::uint32_t passing =
          packet_.meet(children.boxes, rays, children_of_ray, children.key) &
          ((1u << links.child_count) - 1);
      if (is_large_) {
        prefetch_.leaves(links, passing & ~links.inner_mask);
        prefetch_.nodes(links, passing & links.inner_mask);
      }
      for (std::uint32_t leaves = passing & ~links.inner_mask; leaves != 0;) {
        const std::uint32_t i = take_smallest(leaves, children.key);
        const RaySet through =
            packet_.before_bound(rays_through(children_of_ray, i), children.key[i]);
        if (through == 0) continue;
        const std::uint32_t face = first_face(links, i);
        const Errc failed =
            packet_.visit_leaf(face, std::min(kLeafFaces, codec_.face_count - face), through, i);
        if (failed != Errc::kOk) return failed;
      }
      const std::uint32_t inner = passing & links.inner_mask;
      for (std::uint32_t rest = inner; rest != 0; rest &= rest - 1) {
        const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
        children.rays[i] = rays_through(children_of_ray, i);
      }
      typename decltype(stack_)::Child at{depth,
                                          static_cast<std::uint32_t>(std::countr_zero(inner))};
      const bool is_alone = inner != 0 && (inner & (inner - 1)) == 0;
      if (!is_alone) stack_.push(inner, children.key, depth);
      if (!is_alone && !pop(at)) return Errc::kOk;
      for (;;) {
        const Children& of = open_[at.depth];
        rays = packet_.before_bound(of.rays[at.number], of.key[at.number]);
        if (rays != 0) {
          box = of.boxes.box(at.number);
          number = node_number(of.links, at.number);
          depth = at.depth + 1;
          break;
        }
        if (!pop(at)) return Errc::kOk;
      }
    }
  }

 private:
  struct Children {
    ChildBoxes boxes;
    HWY_ALIGN float key[kWideChildren];  // the least of any ray
    RaySet rays[kWideChildren];
    WideLinks links;
  };
  using Stack = TraversalStack<WideCodec<Node>::kDepthLimit>;

  HWY_INLINE bool pop(typename Stack::Child& at) {
    return stack_.pop(std::numeric_limits<float>::infinity(), at);
  }

  const WideCodec<Node>& codec_;
  RayPacket& packet_;
  const Prefetch<Node> prefetch_;
  const bool is_large_;
  const Box<float> root_;
  std::uint64_t meets_ = 0, nodes_ = 0;  // of rays and nodes, and nodes, by the last walk
  Stack stack_;
  std::array<Children, WideCodec<Node>::kDepthLimit> open_;
};

template <class Node>
Errc walk_packets_of_rays(const WideCodec<Node>& codec, RayBatch& batch) {
  RayPacket packet(batch);
  RayPacketWalk<Node> walk(batch.tree, codec, packet);
  answer_in_packets(batch.rays.size(), packet, walk, batch.any);
  return Errc::kOk;
}

void walk_ray_batch(RayBatch& batch) {
  if (!RaySetUp::takes(batch.tree)) {
    for (std::size_t i = 0; i < batch.rays.size(); ++i) batch.answer_alone(i);
    return;
  }
  static_cast<void>(with_wide_codec<Errc>(
      batch.tree, [&](const auto& codec) { return walk_packets_of_rays(codec, batch); }));
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_ray_batch);

}  // namespace

void walk_wide(RayBatch& batch) {
  BOXTREE_DISPATCH(walk_ray_batch)(batch);
}

}  // namespace boxtree
#endif
