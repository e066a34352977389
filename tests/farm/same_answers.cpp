// SPDX-License-Identifier: MIT
// boxtree_same_answers: a world in tiles against the same world as one tree. Each answer has the
// same face, and the same bits of every number; the t of casts, which state a lower bound beside
// it, agree within these.
//
//   boxtree_same_answers ONE.bxt TILES.bxt N      N queries of each kind; exit 1 if any differ
#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <boxtree/boxtree.h>

namespace {

using namespace boxtree;
using Eigen::Vector3d;

[[noreturn]] void give_up(const std::string& why) {
  static_cast<void>(std::fprintf(stderr, "boxtree_same_answers: %s\n", why.c_str()));
  std::exit(2);
}

template <class T>
T require(Result<T> result) {
  if (!result) give_up(result.error().message());
  return std::move(*result);
}

// All numbers of an answer, as bits; -0 and +0 are one number.
using Answer = std::vector<std::uint64_t>;

void add(Answer& answer, double x) {
  answer.push_back(std::bit_cast<std::uint64_t>(x == 0 ? 0.0 : x));
}
void add(Answer& answer, const Vector3d& v) {
  for (const double x : v) add(answer, x);
}

Answer of_hit(const RayHit& hit) {
  Answer answer{hit.face.id, hit.triangle};
  for (const double x : {hit.t, hit.u, hit.v}) add(answer, x);
  add(answer, hit.point);
  add(answer, hit.normal);
  return answer;
}

Answer of_point(const ClosestPoint& found) {
  Answer answer{found.face.id, found.triangle};
  add(answer, found.distance);
  add(answer, found.point);
  return answer;
}

template <class Found, class Describe>
Answer of_result(const Found& found, const Describe& describe) {
  if (!found.ok()) give_up(found.error().message());
  return found ? describe(*found) : Answer{};
}

// The ids of faces that a visit gives, in order.
template <class Visit>
Answer ids_of(const Visit& visit) {
  Answer ids;
  const auto status = visit(ids);
  if (!status) give_up(status.error().message());
  std::sort(ids.begin(), ids.end());
  return ids;
}

class Comparison {
 public:
  Comparison(const Tree& one, const Scene& tiles, std::uint64_t count)
      : one_(one), tiles_(tiles), count_(count), bounds_(one.bounds()) {}

  int run() {
    std::uint64_t different = 0;
    different += compare("rays", [&](int i) { return ray(i); });
    different += compare("first hits", [&](int i) { return first_hits(i); });
    different += compare("points", [&](int i) { return point(i); });
    different += compare("casts", [&](int i) { return cast(i); });
    different += compare("boxes", [&](int i) { return box(i); });
    different += compare("spheres", [&](int i) { return sphere(i); });
    return different == 0 ? 0 : 1;
  }

 private:
  using Pair = std::pair<Answer, Answer>;

  template <class Query>
  std::uint64_t compare(const char* what, const Query& query) {
    random_.seed(25);
    std::uint64_t different = 0, found = 0;
    const auto start = std::chrono::steady_clock::now();
    for (std::uint64_t i = 0; i < count_; ++i) {
      const auto& [one, tiles] = query(static_cast<int>(i % 4));
      found += one.empty() ? 0u : 1u;
      if (one == tiles) continue;
      if (different++ < 3) tell_difference(what, i, one, tiles);
    }
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    std::printf("%s: %llu, %llu with an answer, %llu different, %.1f s\n", what,
                static_cast<unsigned long long>(count_), static_cast<unsigned long long>(found),
                static_cast<unsigned long long>(different), seconds.count());
    return different;
  }

  static void tell_difference(const char* what, std::uint64_t query, const Answer& one,
                              const Answer& tiles) {
    const std::size_t at = static_cast<std::size_t>(
        std::mismatch(one.begin(), one.end(), tiles.begin(), tiles.end()).first - one.begin());
    std::printf("%s %llu: %zu and %zu numbers; number %zu is", what,
                static_cast<unsigned long long>(query), one.size(), tiles.size(), at);
    for (const Answer* answer : {&one, &tiles}) {
      if (at >= answer->size()) {
        std::printf(" none");
      } else {
        std::printf(" %llu (%.17g)", static_cast<unsigned long long>((*answer)[at]),
                    std::bit_cast<double>((*answer)[at]));
      }
    }
    std::printf("\n");
  }

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(random_() >> 11) * 0x1p-53);
  }
  Vector3d inside(double scale) {
    const Vector3d center = bounds_.center(), half = bounds_.sizes() * (0.5 * scale);
    Vector3d at;
    for (int k = 0; k < 3; ++k) at[k] = uniform(center[k] - half[k], center[k] + half[k]);
    return at;
  }
  Triangle some_triangle() {
    const auto index = static_cast<std::uint32_t>(random_() % one_.face_count());
    return require(one_.triangle({kNoFaceId, index}, 0));
  }
  // A corner, or the middle of an edge, which several faces share, of tiles that meet there, too.
  Vector3d some_corner(int kind) {
    const Triangle triangle = some_triangle();
    const Vector3d a = triangle.corner[0], b = triangle.corner[1];
    return kind % 2 == 0 ? a : Vector3d((a + b) / 2);
  }

  // Down or aslant, through corners and edges; from far away; from inside.
  Ray some_ray(int kind) {
    const double size = bounds_.sizes().norm();
    if (kind < 2) {
      const Vector3d at = some_corner(kind);
      Vector3d direction(0, 0, -1);
      if (random_() % 2 == 0) direction = {0.25, -0.5, -1};
      return {Vector3d(at - direction * 0x1p10), direction};
    }
    const Vector3d from =
        kind == 2 ? Vector3d(bounds_.center() + (inside(1) - bounds_.center()).normalized() * size)
                  : inside(1);
    return {from, Vector3d(inside(1) - from)};
  }

  Pair ray(int kind) {
    const Ray each = some_ray(kind);
    return {of_result(closest_hit(one_, each), of_hit),
            of_result(closest_hit(tiles_, each), of_hit)};
  }

  Pair first_hits(int kind) {
    const Ray each = some_ray(kind);
    RayHit hits[6];
    SceneRayHit in_tiles[6];
    Pair answers;
    const std::size_t count = require(nearest_hits(one_, each, hits));
    for (std::size_t i = 0; i < count; ++i) {
      const Answer hit = of_hit(hits[i]);
      answers.first.insert(answers.first.end(), hit.begin(), hit.end());
    }
    const std::size_t of_tiles = require(nearest_hits(tiles_, each, in_tiles));
    for (std::size_t i = 0; i < of_tiles; ++i) {
      const Answer hit = of_hit(in_tiles[i]);
      answers.second.insert(answers.second.end(), hit.begin(), hit.end());
    }
    return answers;
  }

  Pair point(int kind) {
    const Vector3d at = kind < 2 ? some_corner(kind) : inside(kind == 2 ? 1 : 1.5);
    return {of_result(closest_point(one_, at), of_point),
            of_result(closest_point(tiles_, at), of_point)};
  }

  Pair cast(int kind) {
    const Ray line = some_ray(kind);
    const Motion motion{line.direction};
    const Sphere shape{line.origin, bounds_.sizes().maxCoeff() * uniform(0, 0.005)};
    const auto one = cast_closest(one_, shape, motion);
    const auto tiles = cast_closest(tiles_, shape, motion);
    if (!one.ok() || !tiles.ok()) give_up("a cast failed");
    if (!one || !tiles) return {Answer(one ? 1 : 0), Answer(tiles ? 1 : 0)};
    Pair answers{Answer{0}, Answer{0}};
    for (Answer* answer : {&answers.first, &answers.second}) {
      add(*answer, std::max(one->t_lower, tiles->t_lower));
    }
    // Each says between which numbers its t is; so do both together.
    if (std::max(one->t_lower, tiles->t_lower) > std::min(one->t, tiles->t)) {
      add(answers.second, tiles->t);
    }
    return answers;
  }

  Pair box(int kind) {
    const Vector3d at = kind < 2 ? some_corner(kind) : inside(1);
    const double edge = bounds_.sizes().maxCoeff() * (kind == 0 ? 0 : uniform(0, 0.01));
    const Eigen::AlignedBox3d each(at, Vector3d(at + Vector3d::Constant(edge)));
    return {ids_of([&](Answer& ids) {
              return overlap_box(one_, each, [&](const FaceRef& face) {
                ids.push_back(face.id);
                return true;
              });
            }),
            ids_of([&](Answer& ids) {
              return overlap_box(tiles_, each, [&](const SceneFace& face) {
                ids.push_back(face.face.id);
                return true;
              });
            })};
  }

  Pair sphere(int kind) {
    const Vector3d at = kind < 2 ? some_corner(kind) : inside(1);
    const double radius = bounds_.sizes().maxCoeff() * (kind == 0 ? 0 : uniform(0, 0.01));
    return {ids_of([&](Answer& ids) {
              return overlap_sphere(one_, at, radius, [&](const FaceRef& face) {
                ids.push_back(face.id);
                return true;
              });
            }),
            ids_of([&](Answer& ids) {
              return overlap_sphere(tiles_, at, radius, [&](const SceneFace& face) {
                ids.push_back(face.face.id);
                return true;
              });
            })};
  }

  const Tree& one_;
  const Scene& tiles_;
  const std::uint64_t count_;
  const Eigen::AlignedBox3d bounds_;
  std::mt19937_64 random_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) give_up("expected ONE.bxt TILES.bxt N");
  const File one = require(File::open(argv[1]));
  const File tiles = require(File::open(argv[2]));
  const Tree tree = require(Tree::bind(one, 0, {.require_face_ids = true}));
  const Scene scene = require(Scene::bind(tiles, {.require_face_ids = true}));
  return Comparison(tree, scene, std::strtoull(argv[3], nullptr, 10)).run();
}
