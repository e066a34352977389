// SPDX-License-Identifier: MIT
// Makes queries, and the bits of their answers.
#include "tests/robustness/answers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>

#include "tests/robustness/mesh_kinds.h"

namespace boxtree::robustness {
namespace {

class Maker {
 public:
  Maker(const SourceMesh& mesh, std::uint64_t seed)
      : mesh_(mesh), bounds_(bounds_of(mesh)), random_(seed) {
    const double extent = bounds_.diagonal().maxCoeff();
    size_ = bounds_.diagonal().cwiseMax(extent > 0 ? extent / 16 : 1);
  }

  QuerySet make(const QueryCounts& counts) {
    QuerySet queries;
    for (std::size_t i = 0; i < counts.rays; ++i) queries.rays.push_back(ray(i));
    for (std::size_t i = 0; i < counts.boxes; ++i) queries.boxes.push_back(box(i));
    for (std::size_t i = 0; i < counts.spheres; ++i) queries.spheres.push_back(sphere(i));
    for (std::size_t i = 0; i < counts.points; ++i) {
      queries.points.push_back(i % 5 == 0 ? vertex() : point());
    }
    for (std::size_t i = 0; i < counts.poses; ++i) queries.poses.push_back(pose(i));
    for (std::size_t i = 0; i < counts.casts; ++i) queries.casts.push_back(cast(i));
    return queries;
  }

 private:
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t n) {
    return std::min(static_cast<std::size_t>(unit() * static_cast<double>(n)), n - 1);
  }
  Eigen::Vector3d point() {
    Eigen::Vector3d p;
    for (Eigen::Index k = 0; k < 3; ++k)
      p[k] = bounds_.center()[k] + (unit() - 0.5) * 1.4 * size_[k];
    return p;
  }
  Eigen::Vector3d vertex() { return mesh_.positions[below(mesh_.positions.size())]; }
  Eigen::Vector3d axis() {
    return (unit() < 0.5 ? -1 : 1) * Eigen::Vector3d::Unit(static_cast<Eigen::Index>(below(3)));
  }

  Ray ray(std::size_t i) {
    Ray ray{point(), point() - point()};
    if (i % 3 == 0) ray.direction = vertex() - ray.origin;
    if (i % 7 == 0) ray.direction = size_.maxCoeff() * axis();
    if (i % 14 == 0) ray.origin = vertex() - 2 * ray.direction;
    if (i % 11 == 0) ray.origin = vertex();
    if (i % 13 == 0) ray.t_max = unit();
    if (ray.direction.isZero(0)) ray.direction = size_.maxCoeff() * axis();
    return ray;
  }
  Eigen::AlignedBox3d box(std::size_t i) {
    const double part = unit() * unit();
    const Eigen::Vector3d a = i % 3 == 0 ? vertex() : point();
    Eigen::Vector3d b = a + part * (point() - a);
    if (i % 5 == 0) b = vertex();
    if (i % 7 == 0) b[static_cast<Eigen::Index>(i % 3)] = a[static_cast<Eigen::Index>(i % 3)];
    if (i % 17 == 0) b = a;
    return {a.cwiseMin(b), a.cwiseMax(b)};
  }
  Sphere sphere(std::size_t i) {
    return {i % 3 == 0 ? vertex() : point(),
            i % 7 == 0 ? 0 : size_.maxCoeff() * unit() * unit() / 2};
  }
  Pose pose(std::size_t i) {
    Pose pose = Pose::Identity();
    if (i % 3 == 0) {  // aligned contact: moved by the difference of two vertices
      pose.translation() = vertex() - vertex();
      return pose;
    }
    // About the centre of the mesh.
    pose.translate(bounds_.center() + 0.6 * (point() - bounds_.center()));
    pose.rotate(
        Eigen::Quaterniond(unit() - 0.5, unit() - 0.5, unit() - 0.5, unit() - 0.5).normalized());
    if (i % 3 == 2) pose.scale(Eigen::Vector3d(0.5 + unit(), -0.5 - unit(), 0.5 + unit()));
    pose.translate(-bounds_.center());
    return pose;
  }

  // Of every kind in turn.
  Cast cast(std::size_t i) {
    const double reach = size_.maxCoeff() * (0.02 + 0.2 * unit() * unit());
    Eigen::Vector3d half = reach * Eigen::Vector3d(0.1 + unit(), 0.1 + unit(), 0.1 + unit());
    std::vector<Shape> shapes = shapes_of(half);
    Shape shape = shapes[i % shapes.size()];
    if (i % 2 == 1) {
      const decltype(OrientedBox::rotation) turn(unit() - 0.5, unit() - 0.5, unit() - 0.5,
                                                 unit() - 0.5);
      std::visit(
          [&](auto& held) {
            if constexpr (requires { held.rotation; }) held.rotation = turn;
          },
          shape);
    }
    const Eigen::Vector3d from = i % 5 == 4 ? vertex() : point();
    Motion motion{vertex() - from, 1.5};
    if (i % 3 == 1) motion.direction = size_.maxCoeff() * axis();
    if (i % 7 == 6) motion.direction.setZero();
    return {moved_to(std::move(shape), from), motion};
  }

  const SourceMesh& mesh_;
  Eigen::AlignedBox3d bounds_;
  Eigen::Vector3d size_;  // extents; zeros replaced
  std::mt19937_64 random_;
};

// The size of the longest answer without a face: that of a ray.
constexpr std::size_t kLongestMiss = 3;

std::uint64_t bits(double x) {
  return std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x);  // -0 equals 0
}

// Builds one answer.
class Writer {
 public:
  explicit Writer(int exponent) : exponent_(exponent) {}
  void add(std::uint64_t word) { words_.push_back(word); }
  void add_number(double x) { add(bits(x)); }
  void add_length(double x) { add_number(std::ldexp(x, -exponent_)); }
  void sort_rest(std::size_t from) {
    std::sort(words_.begin() + static_cast<std::ptrdiff_t>(from), words_.end());
  }
  [[nodiscard]] std::vector<std::uint64_t> take() { return std::move(words_); }

 private:
  int exponent_;
  std::vector<std::uint64_t> words_;
};

template <class R>
std::uint64_t code_of(const R& result) {
  return static_cast<std::uint64_t>(result.code());
}

std::vector<std::uint64_t> query_ray(const Tree& tree, const Ray& ray, int exponent) {
  Writer out(exponent);
  const auto hit = closest_hit(tree, ray);
  out.add(code_of(hit));
  if (!hit.ok()) return out.take();
  const auto any = any_hit(tree, ray);
  out.add(code_of(any));
  out.add(any.ok() && any.has_value() ? 1 : 0);
  if (!hit.has_value()) return out.take();
  out.add(hit->face.id);
  out.add(hit->triangle);
  for (const double x : {hit->t, hit->u, hit->v}) out.add_number(x);
  return out.take();
}

std::vector<std::uint64_t> query_point(const Tree& tree, const Eigen::Vector3d& point,
                                       int exponent) {
  Writer out(exponent);
  const auto closest = closest_point(tree, point);
  out.add(code_of(closest));
  if (!closest.has_value()) return out.take();
  out.add(closest->face.id);
  out.add(closest->triangle);
  out.add_length(closest->distance);
  for (Eigen::Index k = 0; k < 3; ++k) out.add_length(closest->point[k]);
  return out.take();
}

std::vector<std::uint64_t> query_cast(const Tree& tree, const Cast& cast, int exponent) {
  return with_shape(cast.shape, [&](const auto& shape) {
    Writer out(exponent);
    const CastResult hit = cast_closest(tree, shape, cast.motion);
    out.add(code_of(hit));
    if (!hit.ok()) return out.take();
    const CastResult any = cast_any(tree, shape, cast.motion);
    out.add(code_of(any));
    out.add(any.ok() && any.has_value() ? 1 : 0);
    if (!hit.has_value()) return out.take();
    std::vector<std::array<std::uint64_t, 4>> all;
    const auto visit = cast_all(tree, shape, cast.motion, [&](const CastHit& each) {
      all.push_back({each.face.id, each.triangle, bits(each.t), bits(each.t_lower)});
      return cast.motion.t_max;
    });
    out.add(code_of(visit));
    out.add(hit->face.id);
    out.add(hit->triangle);
    out.add(static_cast<std::uint64_t>(hit->feature));
    out.add_number(hit->t);
    out.add_number(hit->t_lower);
    for (Eigen::Index k = 0; k < 3; ++k) {
      out.add_number(hit->normal[k]);
      out.add_length(hit->point[k]);
    }
    std::sort(all.begin(), all.end());
    for (const auto& each : all) {
      for (const std::uint64_t word : each) out.add(word);
    }
    return out.take();
  });
}

std::vector<std::uint64_t> query_contacts(const Tree& tree, const Shape& tested, int exponent) {
  return with_shape(tested, [&](const auto& shape) {
    std::vector<std::vector<std::uint64_t>> all;
    const auto visit = collide(tree, shape, [&](const Contact& contact) {
      Writer one(exponent);
      one.add(contact.face.id);
      one.add(contact.triangle);
      one.add(static_cast<std::uint64_t>(contact.feature));
      one.add_length(contact.depth);
      for (Eigen::Index k = 0; k < 3; ++k) {
        one.add_number(contact.normal[k]);
        one.add_length(contact.point[k]);
      }
      all.push_back(one.take());
      return true;
    });
    std::sort(all.begin(), all.end());
    Writer out(0);
    out.add(code_of(visit));
    for (const auto& one : all) {
      for (const std::uint64_t word : one) out.add(word);
    }
    return out.take();
  });
}

// Query: visitor -> result of a query that visits faces.
template <class Query>
std::vector<std::uint64_t> query_faces(Query query) {
  Writer out(0);
  const auto result = query([&](const FaceRef& face) {
    out.add(face.id);
    return true;
  });
  out.sort_rest(0);
  out.add(code_of(result));
  return out.take();
}

std::vector<std::uint64_t> query_pairs(const Tree& tree, const Pose& pose) {
  Writer out(0);
  const auto result = overlap_pairs(tree, Pose::Identity(), tree, pose, [&](const FacePair& pair) {
    out.add(std::uint64_t{pair.first.id} << 32 | pair.second.id);
    return true;
  });
  out.sort_rest(0);
  out.add(code_of(result));
  const auto contact = first_contact(tree, Pose::Identity(), tree, pose);
  out.add(contact.ok() && contact.has_value() ? 1 : 0);
  return out.take();
}

}  // namespace

QuerySet queries_for(const SourceMesh& mesh, std::uint64_t seed, const QueryCounts& counts) {
  return Maker(mesh, seed).make(counts);
}

QuerySet scaled(const QuerySet& queries, int exponent) {
  const double factor = std::ldexp(1.0, exponent);
  QuerySet out = queries;
  for (Ray& ray : out.rays) {
    ray.origin *= factor;
    ray.direction *= factor;
  }
  for (Eigen::AlignedBox3d& box : out.boxes) box = {box.min() * factor, box.max() * factor};
  for (Sphere& sphere : out.spheres) sphere = {sphere.center * factor, sphere.radius * factor};
  for (Eigen::Vector3d& point : out.points) point *= factor;
  for (Pose& pose : out.poses) pose.translation() *= factor;
  for (Cast& cast : out.casts) {
    cast.shape = times(std::move(cast.shape), factor);
    cast.motion.direction *= factor;
  }
  return out;
}

Answers run_query(const Tree& tree, const QuerySet& queries, int exponent) {
  Answers answers;
  for (const Ray& ray : queries.rays) answers.push_back(query_ray(tree, ray, exponent));
  for (const Eigen::AlignedBox3d& box : queries.boxes) {
    answers.push_back(
        query_faces([&](FaceVisitor visitor) { return overlap_box(tree, box, visitor); }));
  }
  for (const Sphere& sphere : queries.spheres) {
    answers.push_back(query_faces([&](FaceVisitor visitor) {
      return overlap_sphere(tree, sphere.center, sphere.radius, visitor);
    }));
  }
  for (const Eigen::Vector3d& point : queries.points) {
    answers.push_back(query_point(tree, point, exponent));
  }
  for (const Pose& pose : queries.poses) answers.push_back(query_pairs(tree, pose));
  for (const Cast& cast : queries.casts) {
    answers.push_back(query_cast(tree, cast, exponent));
    answers.push_back(query_contacts(tree, cast.shape, exponent));
  }
  return answers;
}

std::size_t count_differing(const Answers& a, const Answers& b) {
  if (a.size() != b.size()) return std::max(a.size(), b.size());
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.size(); ++i) count += a[i] != b[i] ? 1u : 0u;
  return count;
}

std::size_t count_hits(const Answers& answers) {
  return static_cast<std::size_t>(std::count_if(
      answers.begin(), answers.end(), [](const auto& a) { return a.size() > kLongestMiss; }));
}

}  // namespace boxtree::robustness
