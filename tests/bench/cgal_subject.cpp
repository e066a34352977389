// SPDX-License-Identifier: MIT
// CGAL's AABB tree, exact predicates.
#include <CGAL/AABB_tree.h>
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/version.h>
#if CGAL_VERSION_MAJOR >= 6
#include <CGAL/AABB_traits_3.h>
#include <CGAL/AABB_triangle_primitive_3.h>
#include <variant>
#else
#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_triangle_primitive.h>
#endif
#include <cmath>
#include <iterator>
#include <limits>

#include "tests/bench/subject.h"

namespace boxtree::bench {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Iterator = std::vector<Kernel::Triangle_3>::const_iterator;
#if CGAL_VERSION_MAJOR >= 6
using Primitive = CGAL::AABB_triangle_primitive_3<Kernel, Iterator>;
using Traits = CGAL::AABB_traits_3<Kernel, Primitive>;
template <class T, class... Kinds>
const T* held(const std::variant<Kinds...>& intersection) {
  return std::get_if<T>(&intersection);
}
#else
using Primitive = CGAL::AABB_triangle_primitive<Kernel, Iterator>;
using Traits = CGAL::AABB_traits<Kernel, Primitive>;
template <class T, class... Kinds>
const T* held(const boost::variant<Kinds...>& intersection) {
  return boost::get<T>(&intersection);
}
#endif
using CgalTree = CGAL::AABB_tree<Traits>;

Kernel::Point_3 to_point(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

class CgalSubject : public Subject {
 public:
  explicit CgalSubject(const TriangleMesh& mesh) : mesh_(mesh) {
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
      const Triangle triangle = mesh.triangle(i);
      triangles_.emplace_back(to_point(triangle.corner[0]), to_point(triangle.corner[1]),
                              to_point(triangle.corner[2]));
    }
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
    tree_.accelerate_distance_queries();
  }

  // Nodes hold a box in double and two pointers, primitives an iterator; triangles are stored
  // separately.
  [[nodiscard]] SubjectBytes bytes() const override {
    const auto n = static_cast<double>(triangles_.size());
    const double tree = n * (sizeof(CGAL::AABB_node<Traits>) + sizeof(Primitive));
    return {tree, tree + n * sizeof(Kernel::Triangle_3)};
  }
  bool rays(std::span<const Ray> rays, std::span<double> out) override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Kernel::Ray_3 ray(
          to_point(rays[i].origin),
          Kernel::Vector_3(rays[i].direction.x(), rays[i].direction.y(), rays[i].direction.z()));
      out[i] = std::numeric_limits<double>::infinity();
      const auto hit = tree_.first_intersection(ray);
      if (!hit) continue;
      const auto distance_to = [&](const Kernel::Point_3& p) {
        return std::sqrt(CGAL::squared_distance(p, ray.source())) / rays[i].direction.norm();
      };
      if (const auto* point = held<Kernel::Point_3>(hit->first)) {
        out[i] = distance_to(*point);
      } else if (const auto* segment = held<Kernel::Segment_3>(hit->first)) {
        out[i] = std::min(distance_to(segment->source()), distance_to(segment->target()));
      }
    }
    return true;
  }
  bool boxes(std::span<const Eigen::AlignedBox3d> boxes, std::span<double> out) override {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Kernel::Iso_cuboid_3 box(to_point(boxes[i].min()), to_point(boxes[i].max()));
      out[i] = static_cast<double>(tree_.number_of_intersected_primitives(box));
    }
    return true;
  }
  bool points(std::span<const Eigen::Vector3d> points, std::span<double> out) override {
    for (std::size_t i = 0; i < points.size(); ++i) {
      out[i] = std::sqrt(tree_.squared_distance(to_point(points[i])));
    }
    return true;
  }
  bool first_contacts(std::span<const Pose> poses, std::span<double> out) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out[i] = any_of_copy(
                   poses[i],
                   [&](const Kernel::Triangle_3& triangle) { return tree_.do_intersect(triangle); })
                   ? 1
                   : 0;
    }
    return true;
  }
  bool all_pairs(std::span<const Pose> poses, std::span<double> out) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      out[i] = 0;
      any_of_copy(poses[i], [&](const Kernel::Triangle_3& triangle) {
        out[i] += static_cast<double>(tree_.number_of_intersected_primitives(triangle));
        return false;
      });
    }
    return true;
  }

 private:
  // CGAL's pair queries need closed halfedge meshes; a triangle soup is queried triangle by
  // triangle.
  template <class Test>
  bool any_of_copy(const Pose& pose, Test test) {
    const auto bounds = tree_.bbox();
    for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Triangle source = mesh_.triangle(t);
      const Kernel::Triangle_3 triangle(to_point(pose * source.corner[0]),
                                        to_point(pose * source.corner[1]),
                                        to_point(pose * source.corner[2]));
      if (triangle.is_degenerate() || !CGAL::do_overlap(triangle.bbox(), bounds)) continue;
      if (test(triangle)) return true;
    }
    return false;
  }

  const TriangleMesh& mesh_;
  std::vector<Kernel::Triangle_3> triangles_;
  CgalTree tree_;
};

}  // namespace

void add_cgal(std::vector<Library>& libraries) {
  libraries.push_back({"cgal", "aabb-tree", [](const TriangleMesh& mesh) {
                         return std::make_unique<CgalSubject>(mesh);
                       }});
}

}  // namespace boxtree::bench
