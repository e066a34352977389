// SPDX-License-Identifier: MIT
// Pairs of trees: exact decisions, barely touching contact, and cases without contact.
#include <cmath>
#include <random>

#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"
#include "tests/unit/primitive/exact_simplex.h"
#include "tests/unit/primitive/triangle_cases.h"

namespace boxtree::robustness {
namespace {

std::vector<test::IntVector> whole_corners(const Triangle& triangle) {
  std::vector<test::IntVector> corners;
  for (const Eigen::Vector3d& corner : triangle.corner) corners.push_back(test::to_integer(corner));
  return corners;
}

// Compares two trees of triangles with integer coordinates, each triangle with each, with integer
// arithmetic by an independent algorithm.
void exact_pairs(Run& run) {
  constexpr std::int64_t kRange = 1 << 14;  // coordinates below 2^19: exact in f32 and on the grid
  const std::size_t count = run.count(60, 400);
  for (const test::Family family : test::kFamilies) {
    test::TriangleCases cases(0xe8ac7, kRange);
    std::vector<Corners> first, second;
    for (std::size_t i = 0; i < count; ++i) {
      const test::TrianglePair pair = cases.pair(family);
      first.push_back(pair.first.corner);
      second.push_back(pair.second.corner);
    }
    FacePairs expected;
    for (std::uint32_t i = 0; i < count; ++i) {
      for (std::uint32_t j = 0; j < count; ++j) {
        if (test::hulls_intersect(whole_corners({first[i]}), whole_corners({second[j]}))) {
          expected.emplace_back(i, j);
        }
      }
    }
    run.premise(!expected.empty() && expected.size() < count * count,
                std::string(test::name_of(family)) + ": all pairs are alike");
    const SourceMesh a = from_triangles("first", first), b = from_triangles("second", second);
    for (const Store& store : kStores) {
      for (const CodecInfo& codec : kCodecs) {
        const Subject s = make_subject(a, codec.id, store), t = make_subject(b, codec.id, store);
        const FacePairs found = found_pairs(s.tree(), Pose::Identity(), t.tree(), Pose::Identity());
        run.check(found == expected,
                  [&] { return std::string(test::name_of(family)) + ": " + s.name; });
      }
    }
  }
}

struct Touching {
  const char* name;
  SourceMesh first;
  SourceMesh second;  // touches the first one at rest; along +x they separate
  Eigen::Vector3d shift;
};

std::vector<Touching> touching() {
  const SourceMesh box = box_mesh(Eigen::Vector3d(1, 1, 1));
  const auto one = [](const char* name, const Corners& corners) {
    return from_triangles(name, {corners});
  };
  return {
      {"face on face", box, box, {2, 0.25, 0.5}},
      {"edge on edge, parallel", box, box, {2, 2, 0.5}},
      {"vertex on vertex", box, box, {2, 2, 2}},
      {"vertex on face",
       box,
       one("",
           {Eigen::Vector3d(1, 0.25, 0.125), Eigen::Vector3d(3, 1, 0), Eigen::Vector3d(3, 0, 1)}),
       {0, 0, 0}},
      {"vertex on edge",
       one("", {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-2, 0, 1)}),
       one("", {Eigen::Vector3d(0, 0.25, 0), Eigen::Vector3d(2, 1, 1), Eigen::Vector3d(2, -1, 1)}),
       {0, 0, 0}},
      {"edge on edge, crossed",
       one("", {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-1, 0, 0)}),
       one("", {Eigen::Vector3d(0, 0, -1), Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, 0, 0)}),
       {0, 0, 0}},
  };
}

// Contact ends exactly where the meshes stop touching, and does not recur: gaps of +-2^-k, as far
// as double distinguishes them from zero.
void touching_sweep(Run& run) {
  Eigen::Matrix3d quarter_turn;
  quarter_turn << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  for (const Touching& t : touching()) {
    for (const Store& store : kStores) {
      for (const CodecInfo& codec : kCodecs) {
        const Subject first = make_subject(t.first, codec.id, store);
        const Subject second = make_subject(t.second, codec.id, store);
        for (int turns = 0; turns < 4; ++turns) {
          Pose here = Pose::Identity();
          for (int i = 0; i < turns; ++i) here.linear() = here.linear() * quarter_turn;
          for (int k = 1; k <= 48; ++k) {
            for (const double gap : {-std::ldexp(1.0, -k), 0.0, std::ldexp(1.0, -k)}) {
              Pose there = here;
              there.translation() =
                  here.linear() * Eigen::Vector3d(t.shift[0] + gap, t.shift[1], t.shift[2]);
              const auto contact = first_contact(first.tree(), here, second.tree(), there);
              run.check(contact.ok() && contact.has_value() == (gap <= 0), [&] {
                return std::string(t.name) + ", " + first.name + ": gap " + std::to_string(gap) +
                       " (2^-" + std::to_string(k) + ")";
              });
            }
          }
        }
      }
    }
  }
}

// Contact compares surfaces: a cube inside a cube is no contact. Containment is another query,
// answered by the number of times that a ray leaves the surface.
void containment(Run& run) {
  for (const Store& store : kStores) {
    for (const CodecInfo& codec : kCodecs) {
      const Subject big = make_subject(box_mesh(Eigen::Vector3d(4, 4, 4)), codec.id, store);
      const Subject small = make_subject(box_mesh(Eigen::Vector3d(1, 1, 1)), codec.id, store);
      for (int i = -11; i <= 11; ++i) {
        Pose pose = Pose::Identity();
        pose.translation() = Eigen::Vector3d(0.25 * i, 0.125 * i, 0);
        const auto contact = first_contact(big.tree(), Pose::Identity(), small.tree(), pose);
        run.check(contact.ok() && !contact.has_value(), [&] { return big.name; });
        const auto out = closest_hit(big.tree(), {pose.translation(), {0.3, 0.2, 1}});
        run.check(out.ok() && out.has_value(), [&] { return big.name + ": ray out"; });
      }
    }
  }
}

// No number in an answer is NaN, for any mesh; without a contact there is no record.
void no_nan(Run& run) {
  std::vector<SourceMesh> meshes = test::all_kinds();
  std::vector<Corners> points;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Vector3d p(i % 5, i % 7, i % 3), q = p + Eigen::Vector3d(i % 2, 0, 0);
    points.push_back({p, q, p});
  }
  meshes.push_back(from_triangles("points and segments", points));
  std::size_t misses = 0;
  const auto is_weight = [](double x) { return x >= 0 && x <= 1; };
  for (const SourceMesh& mesh : meshes) {
    const QuerySet queries = queries_for(mesh, 27, {300, 0, 0, 100, 4, 40});
    for_each_subject(mesh, [&](const Subject& subject) {
      const auto name = [&] { return subject.name; };
      for (const Ray& ray : queries.rays) {
        const auto hit = closest_hit(subject.tree(), ray);
        misses += hit.has_value() ? 0u : 1u;
        if (!hit.has_value()) continue;
        run.check(hit->t >= ray.t_min && hit->t <= ray.t_max && std::isfinite(hit->t), name);
        run.check(is_weight(hit->u) && is_weight(hit->v), name);
      }
      for (const Eigen::Vector3d& point : queries.points) {
        const auto closest = closest_point(subject.tree(), point);
        run.check(closest.has_value() && closest->point.allFinite() && closest->distance >= 0,
                  name);
      }
      for (const Cast& cast : queries.casts) {
        with_shape(cast.shape, [&](const auto& shape) {
          const CastResult hit = cast_closest(subject.tree(), shape, cast.motion);
          misses += hit.has_value() ? 0u : 1u;
          run.check(hit.ok(), name);
          if (!hit.has_value()) return;
          run.check(hit->t_lower >= 0 && hit->t_lower <= hit->t && hit->t <= cast.motion.t_max,
                    name);
          run.check(hit->point.allFinite() && hit->normal.allFinite(), name);
        });
      }
      Pose away = Pose::Identity();
      away.translation() = 3 * bounds_of(mesh).diagonal() + Eigen::Vector3d::Ones();
      const auto contact = first_contact(subject.tree(), Pose::Identity(), subject.tree(), away);
      run.check(contact.ok() && !contact.has_value(), name);
    });
  }
  run.premise(misses > 1000, "hardly any ray misses");
}

}  // namespace

std::vector<Case> pair_cases() {
  return {
      {"R12", "ExactTrianglePairs",
       "pairs of trees of whole coordinates against integer arithmetic", "wrong pair sets", 0,
       exact_pairs},
      {"R24", "TouchingSweep", "gaps of +-2^-k around exact contact, k to 48", "flips", 0,
       touching_sweep},
      {"R26", "Containment", "a cube inside a cube touches nothing", "false contacts", 0,
       containment},
      {"R27", "NoNaN", "numbers in answers, hit or no hit", "not finite or out of range", 0,
       no_nan},
  };
}

}  // namespace boxtree::robustness
