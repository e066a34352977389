// SPDX-License-Identifier: MIT
// The state of a ray query in one tree, shared by the walks of all codecs.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/ray.h>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/face_wishes.h"
#include "runtime/query/ray_slab.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/traversal.h"
#include "runtime/walk/work.h"

namespace boxtree {

/// The best hit so far: t in parameters of the query, the triangle in tree space.
struct RayCandidate {
  bool is_hit = false;  // if false, the rest is unspecified
  double t = 0;
  FaceRef face;
  std::uint32_t half = 0;
  double u = 0, v = 0;
  Triangle triangle;

  /// The point that was hit, in tree space, by the weights of the corners.
  [[nodiscard]] Eigen::Vector3d point() const noexcept {
    const auto& [a, b, c] = triangle.corner;
    const double w = (1 - u) - v;
    Eigen::Vector3d point;
    for (Eigen::Index k = 0; k < 3; ++k) point[k] = (w * a[k] + u * b[k]) + v * c[k];
    return point;
  }
};

/// A ray in tree space, origin + s * direction, where s = t * 2^parameter_exponent: the largest
/// component of the direction is in [1/2, 1), so that directions of any length behave alike and t
/// is converted without rounding.
struct RayInTree {
  RayInTree(const BoundTree& tree, const Ray& ray, int direction_exponent) noexcept
      : RayInTree(tree, ray, direction_exponent, tree.largest_abs()) {}
  /// `max_abs`: the largest absolute coordinate of any box.
  RayInTree(const BoundTree& tree, const Ray& ray, int direction_exponent, double max_abs) noexcept
      : parameter_exponent(direction_exponent - tree.scale_exponent()),
        origin(tree.frame().to_tree_lanes(AxisLanes(ray.origin))),
        direction(scaled(AxisLanes(ray.direction), -direction_exponent)),
        origin_max_abs(largest_magnitude(origin[0], origin[1], origin[2])),
        slab(origin, origin_max_abs, direction, max_abs),
        t_min(scaled(ray.t_min, parameter_exponent)),
        t_max(scaled(ray.t_max, parameter_exponent)) {}

  /// x * 2^exponent, by a product where the power is a normal number.
  [[nodiscard]] static double scaled(double x, int exponent) noexcept {
    return has_power(exponent) ? x * power(exponent) : std::ldexp(x, exponent);
  }
  [[nodiscard]] static AxisLanes scaled(const AxisLanes& v, int exponent) noexcept {
    AxisLanes product;
    if (has_power(exponent)) [[likely]] {
      const double factor = power(exponent);
      for (std::size_t k = 0; k < AxisLanes::kCount; ++k) product[k] = v[k] * factor;
    } else {
      for (std::size_t k = 0; k < AxisLanes::kCount; ++k) product[k] = std::ldexp(v[k], exponent);
    }
    return product;
  }

  /// The box test of traverse_nearest: where the ray enters a child's box, or infinity.
  template <class AnyBox>
  [[nodiscard]] double key(const AnyBox& box) const noexcept {
    return slab.key(box, t_min);
  }

  /// Whether the ray meets the root box, from `enter` on.
  [[nodiscard]] bool meets(const BoxLanes& root) noexcept {
    enter = key(root);
    return enter <= t_max && enter < std::numeric_limits<double>::infinity();
  }

  int parameter_exponent;
  AxisLanes origin;
  AxisLanes direction;
  double origin_max_abs;  // the largest magnitude of its components
  RaySlab slab;
  double t_min;
  double t_max;  // shrinks to the best hit
  double enter;  // where it meets the root box; unspecified before meets()

 private:
  static constexpr int kBias = std::numeric_limits<double>::max_exponent - 1;
  // Whether 2^exponent is a normal number, and the number.
  [[nodiscard]] static bool has_power(int exponent) noexcept { return std::abs(exponent) < kBias; }
  [[nodiscard]] static double power(int exponent) noexcept {
    return std::bit_cast<double>(static_cast<std::uint64_t>(exponent + kBias) << 52);
  }
};

/// Converts a parameter of the query to one of the ray. Clamped to the ray's own interval, as
/// conversion may underflow, for example for a subnormal direction.
[[nodiscard]] inline double parameter_of(const Ray& ray, double scaled, int exponent) noexcept {
  return std::clamp(RayInTree::scaled(scaled, -exponent), ray.t_min, ray.t_max) + 0.0;  // not -0
}

struct RayTest;

/// What a caller wants besides the closest or any hit of any face.
struct RayWishes {
  /// Whether the candidate is to be kept, with a face that is wanted. Where all hits are, visits
  /// it. A pointer, so that programs that have no wishes do not link it.
  using Meet = bool(RayTest& ray, RayCandidate& candidate);
  /// Receives every hit, named; returns the largest parameter that is still of interest, or a
  /// negative number to stop.
  using Visitor = FunctionRef<double(const RayTest& ray, const RayCandidate& found)>;

  FaceWishes faces;
  Meet* meet;
  const Visitor* all = nullptr;  // null: one hit is wanted
};

/// A ray that is tested against the triangles of one tree. `best` receives the answer, without the
/// id of its face; it holds no hit yet.
struct RayTest : RayInTree {
  RayTest(const BoundTree& queried, const Ray& ray, int direction_exponent, bool stop_at_first,
          RayCandidate& best, RayWishes* ray_wishes = nullptr) noexcept
      : RayInTree(queried, ray, direction_exponent),
        tree(queried),
        any(stop_at_first),
        hit(best),
        wishes(ray_wishes) {}

  /// Whether the ray intersects the root box. If it does, prepares the tests of what is inside.
  /// Call it before any walk.
  [[nodiscard]] bool enters_root() noexcept {
    if (!meets(tree.root_lanes())) return false;
    prepare();
    return true;
  }
  /// The same for a ray that is known to.
  void prepare() noexcept { shear = RayShear(origin, direction, slab.inverse()); }

  /// Whether no other triangle can matter.
  [[nodiscard]] bool is_done() const noexcept {
    return (any && hit.is_hit) || error != Errc::kOk ||
           (wishes != nullptr && wishes->faces.stopped);
  }

  void test(const Triangle& triangle, std::uint32_t face_index, std::uint32_t half) {
    const SlabInterval interval = slab.intersect(bounds_of(triangle));
    if (interval.enter > interval.leave) return;
    const std::optional<RayTriangleHit> found = intersect_ray_triangle(shear, triangle);
    if (!found) return;
    // The hit lies in the triangle's bounds; clamping t to them makes it agree with every key
    // above.
    const double t = std::clamp(found->t, interval.enter, interval.leave);
    if (t < t_min || t > t_max) return;
    FaceRef face{kNoFaceId, face_index};
    if (wishes != nullptr) {
      RayCandidate candidate{true, t, face, half, found->u, found->v, triangle};
      if (!wishes->meet(*this, candidate)) return;
      face = candidate.face;
    }
    if (hit.is_hit && t == hit.t) {
      name(tree, face);
      name(tree, hit.face);
      if (!comes_before(tree, face, half, hit.face, hit.half)) return;
    }
    hit.is_hit = true;
    hit.t = t_max = t;
    hit.face = face;
    hit.half = half;
    hit.u = found->u;
    hit.v = found->v;
    hit.triangle = triangle;
  }

  /// Puts the hit, if there is one, in terms of the caller's ray.
  void finish(const Ray& ray) noexcept {
    if (!hit.is_hit) return;
    hit.t = parameter_of(ray, hit.t, parameter_exponent);
    name(tree, hit.face);
  }

  const BoundTree& tree;
  RayShear shear;
  bool any;
  RayCandidate& hit;
  RayWishes* wishes;
  Errc error = Errc::kOk;
};

/// A query of traverse_nearest.
struct RayQuery : RayTest {
  RayQuery(const BoundTree& queried, const Ray& ray, int direction_exponent, WalkBound& bound,
           bool stop_at_first, RayCandidate& best, RayWishes* ray_wishes = nullptr) noexcept
      : RayTest(queried, ray, direction_exponent, stop_at_first, best, ray_wishes), nodes(bound) {}

  [[nodiscard]] double bound() const noexcept { return t_max; }

  [[nodiscard]] bool leaf(NodeRef ref) {
    error = tree.leaves().read(ref.first, ref.second, batch);
    if (error != Errc::kOk) return false;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      test(batch.triangle(i), batch.face[i], half_of_face(batch, i));
    }
    return !is_done();
  }

  WalkBound& nodes;
  TriangleBatch batch;
};

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, RayQuery& query);

/// The RayWishes::Meet of callers that have any.
[[nodiscard]] bool meet_wishes(RayTest& ray, RayCandidate& candidate);

/// The field of a ray that is not valid: the direction, whose largest component is `length`, unless
/// it is finite and not zero, or an end of the interval; null if there is none. The origin is
/// checked once it is in tree space.
[[nodiscard]] inline const char* invalid_field(const Ray& ray, double length) noexcept {
  if (!(length > 0 && length <= std::numeric_limits<double>::max())) return "direction";
  if (!(ray.t_min >= 0)) return "t_min";
  return ray.t_min <= ray.t_max ? nullptr : "t_max";  // the comparisons are false for NaN
}

/// The same for a ray that was refused.
[[nodiscard, gnu::cold]] const char* refused_field(const Ray& ray) noexcept;

/// The power of two that scales the largest component of a direction into [1/2, 1). Precondition:
/// it is finite and not zero.
[[nodiscard]] inline int exponent_of(double length) noexcept {
  if (length >= std::numeric_limits<double>::min()) [[likely]] {  // a normal number
    constexpr int kBias = std::numeric_limits<double>::max_exponent - 2;
    return static_cast<int>(std::bit_cast<std::uint64_t>(length) >> 52) - kBias;
  }
  int exponent = 0;
  static_cast<void>(std::frexp(length, &exponent));
  return exponent;
}

/// What a caller is told of a hit with t in the ray's own parameters.
[[nodiscard]] RayHit described(const BoundTree& tree, const RayCandidate& hit) noexcept;

/// closest_hit or any_hit for callers that have set the floating-point state. `hit`: the answer,
/// with t in the ray's own parameters.
Errc cast_ray(const BoundTree& tree, const Ray& ray, bool stop_at_first, QueryWork& work,
              RayCandidate& hit, RayWishes* wishes = nullptr);

}  // namespace boxtree
