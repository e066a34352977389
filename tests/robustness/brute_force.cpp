// SPDX-License-Identifier: MIT
// Loops over decoded triangles, using only the leaf predicates.
#include "tests/robustness/brute_force.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/traversal.h"
#include "tests/robustness/cast_reference.h"
#include "tests/support/infinity.h"

namespace boxtree::robustness {
namespace {

using test::kInfinity;

auto collector(std::vector<std::uint32_t>& found) {
  return [&found](const FaceRef& face) {
    found.push_back(face.id);
    return true;
  };
}

// Whether the ray sees only an edge of a triangle: no area, or in the ray's plane.
bool is_edge_on(const RayShear& ray, const Triangle& triangle) {
  std::array<Eigen::Vector2d, 3> seen;
  for (std::size_t c = 0; c < 3; ++c) {
    const Eigen::Vector3d from = triangle.corner[c] - triangle.corner[0];
    seen[c] = {from[ray.axis_x] - ray.shear_x * from[ray.axis_z],
               from[ray.axis_y] - ray.shear_y * from[ray.axis_z]};
  }
  const double area = std::abs(seen[1][0] * seen[2][1] - seen[1][1] * seen[2][0]);
  return area < 0x1p-40 * std::max(seen[1].squaredNorm(), seen[2].squaredNorm());
}

class Brute {
 public:
  Brute(Run& run, const Subject& subject)
      : run_(run),
        subject_(subject),
        frame_(BoundTree::of(subject.tree()).frame()),
        triangles_(decoded_triangles(subject.tree())),
        casts_(subject.tree()) {}

  void check_ray(const Ray& ray, std::size_t number) {
    const RayShear shear(frame_.to_tree(ray.origin), ray.direction);
    const double scale = frame_.scale;
    const double max_abs = BoundTree::of(subject_.tree()).largest_abs();
    // The product keeps t within the slabs of the triangle, which are as wide as its error bound.
    const double length = ray.direction.cwiseAbs().maxCoeff();
    const double doubt = 0x1p-46 * scale * (shear.origin.cwiseAbs().maxCoeff() + max_abs) / length;
    std::optional<double> surely;
    const auto hit = closest_hit(subject_.tree(), ray);
    const auto any = any_hit(subject_.tree(), ray);
    if (!hit.ok() || !any.ok()) return complain(false, "ray", number);
    bool is_found = false;
    for (const DecodedTriangle& t : triangles_) {
      const auto found = intersect_ray_triangle(shear, t.triangle);
      if (!found) continue;
      const double at = found->t * scale;
      if (is_edge_on(shear, t.triangle)) {
        // The hit is due to rounding, and may be anywhere between the corners.
        is_found |= hit.has_value() && hit->face.id == t.face;
        continue;
      }
      if (at < ray.t_min - doubt || at > ray.t_max + doubt) continue;
      if (at >= ray.t_min + doubt && at <= ray.t_max - doubt && (!surely || at < *surely)) {
        surely = at;
      }
      is_found |= hit.has_value() && hit->face.id == t.face && hit->triangle == t.half &&
                  std::abs(hit->t - at) <= doubt;
    }
    bool right = any.has_value() == hit.has_value();
    if (hit.has_value()) {
      right &= is_found && (!surely || hit->t <= *surely + doubt);
    } else {
      right &= !surely.has_value();
    }
    complain(right, "ray", number);
  }

  void check_box(const Eigen::AlignedBox3d& box, std::size_t number) {
    const Eigen::Vector3d low = frame_.to_tree(box.min()), high = frame_.to_tree(box.max());
    std::vector<std::uint32_t> expected = faces_that(
        [&](const Triangle& triangle) { return triangle_intersects_box(triangle, low, high); });
    std::vector<std::uint32_t> found;
    const auto result = overlap_box(subject_.tree(), box, collector(found));
    complain(result.ok() && same(found, expected), "box", number);
  }

  void check_sphere(const Sphere& sphere, std::size_t number) {
    const Eigen::Vector3d center = frame_.to_tree(sphere.center);
    const double radius = sphere.radius * frame_.inverse_scale;
    std::vector<std::uint32_t> expected = faces_that([&](const Triangle& triangle) {
      return squared_length(closest_point_on_triangle(center, triangle) - center) <=
             radius * radius;
    });
    std::vector<std::uint32_t> found;
    const auto result =
        overlap_sphere(subject_.tree(), sphere.center, sphere.radius, collector(found));
    complain(result.ok() && same(found, expected), "sphere", number);
  }

  void check_point(const Eigen::Vector3d& point, std::size_t number) {
    const Eigen::Vector3d at = frame_.to_tree(point);
    double best = kInfinity;
    for (const DecodedTriangle& t : triangles_) {
      best = std::min(best, (closest_point_on_triangle(at, t.triangle) - at).norm());
    }
    const auto closest = closest_point(subject_.tree(), point);
    if (!closest.ok()) return complain(false, "point", number);
    bool right = closest.has_value() == (best < kInfinity);
    if (closest.has_value()) {
      const double distance = closest->distance * frame_.inverse_scale;
      right &= std::abs(distance - best) <=
               0x1p-48 *
                   (best + at.cwiseAbs().maxCoeff() + BoundTree::of(subject_.tree()).largest_abs());
    }
    complain(right, "point", number);
  }

  void check_pose(const Pose& pose, std::size_t number) {
    const Tree& tree = subject_.tree();
    complain(found_pairs(tree, Pose::Identity(), tree, pose) ==
                 brute_pairs(tree, Pose::Identity(), tree, pose),
             "pose", number);
  }

  void check_cast(const Cast& cast, std::size_t number) {
    const std::string name = subject_.name + ": cast " + std::to_string(number);
    casts_.check_cast(run_, subject_.tree(), cast, name);
    casts_.check_contacts(run_, subject_.tree(), cast.shape, name);
  }

 private:
  void complain(bool right, const char* what, std::size_t number) {
    run_.check(right, [&] { return subject_.name + ": " + what + " " + std::to_string(number); });
  }

  template <class Test>
  std::vector<std::uint32_t> faces_that(Test test) {
    std::vector<std::uint32_t> faces;
    for (const DecodedTriangle& t : triangles_) {
      if (!faces.empty() && faces.back() == t.face) continue;
      if (test(t.triangle)) faces.push_back(t.face);
    }
    return faces;
  }
  static bool same(std::vector<std::uint32_t>& a, std::vector<std::uint32_t>& b) {
    std::sort(a.begin(), a.end());
    std::sort(b.begin(), b.end());
    return a == b;
  }

  Run& run_;
  const Subject& subject_;
  const Frame& frame_;
  std::vector<DecodedTriangle> triangles_;
  CastReference casts_;
};

bool boxes_intersect(const Box<double>& a, const Box<double>& b) {
  for (std::size_t k = 0; k < 3; ++k) {
    if (a.low[k] > b.high[k] || b.low[k] > a.high[k]) return false;
  }
  return true;
}

}  // namespace

void check_brute_force(Run& run, const Subject& subject, const QuerySet& queries) {
  Brute brute(run, subject);
  for (std::size_t i = 0; i < queries.rays.size(); ++i) brute.check_ray(queries.rays[i], i);
  for (std::size_t i = 0; i < queries.boxes.size(); ++i) brute.check_box(queries.boxes[i], i);
  for (std::size_t i = 0; i < queries.spheres.size(); ++i) {
    brute.check_sphere(queries.spheres[i], i);
  }
  for (std::size_t i = 0; i < queries.points.size(); ++i) {
    brute.check_point(queries.points[i], i);
  }
  for (std::size_t i = 0; i < queries.poses.size(); ++i) brute.check_pose(queries.poses[i], i);
  for (std::size_t i = 0; i < queries.casts.size(); ++i) brute.check_cast(queries.casts[i], i);
}

std::size_t check_answers(Run& run, const SourceMesh& mesh, const QuerySet& queries) {
  std::size_t hits = 0;
  for (const Store& store : kStores) {
    Answers first;
    for (const CodecInfo& codec : kCodecs) {
      const Subject subject = make_subject(mesh, codec.id, store);
      const Answers answers = run_query(subject.tree(), queries);
      hits += count_hits(answers);
      if (codec.id == kCodecs.front().id) {
        check_brute_force(run, subject, queries);
        first = answers;
        continue;
      }
      for (std::size_t i = 0; i < answers.size(); ++i) {
        run.check(answers[i] == first[i], [&] {
          return subject.name + ": answer " + std::to_string(i) + " is not that of " +
                 std::string(kCodecs.front().name);
        });
      }
    }
  }
  return hits;
}

FacePairs brute_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                      const Pose& second_pose) {
  const auto relative =
      RelativePose::make(BoundTree::of(first), first_pose, BoundTree::of(second), second_pose);
  if (!relative) throw std::runtime_error("the poses cannot be composed");
  struct Bounded {
    DecodedTriangle decoded;
    Box<double> bounds;
  };
  const auto bounded = [](std::vector<DecodedTriangle> triangles) {
    std::vector<Bounded> out;
    for (const DecodedTriangle& t : triangles) out.push_back({t, bounds_of(t.triangle)});
    return out;
  };
  std::vector<DecodedTriangle> moved = decoded_triangles(second);
  for (DecodedTriangle& t : moved) {
    for (Eigen::Vector3d& corner : t.triangle.corner) corner = relative->to_first().apply(corner);
  }
  const std::vector<Bounded> a = bounded(decoded_triangles(first)), b = bounded(std::move(moved));
  FacePairs pairs;
  for (const Bounded& s : a) {
    for (const Bounded& t : b) {
      if (!boxes_intersect(s.bounds, t.bounds)) continue;
      if (!triangles_intersect(s.decoded.triangle, t.decoded.triangle)) continue;
      pairs.emplace_back(s.decoded.face, t.decoded.face);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());  // halves of quads
  return pairs;
}

FacePairs found_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                      const Pose& second_pose) {
  FacePairs pairs;
  const auto visit =
      overlap_pairs(first, first_pose, second, second_pose, [&](const FacePair& pair) {
        pairs.emplace_back(pair.first.id, pair.second.id);
        return true;
      });
  if (!visit) throw std::runtime_error(visit.error().message());
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace boxtree::robustness
