// SPDX-License-Identifier: MIT
// Family "scenes": rays, boxes, spheres, closest points and contacts of a scene whose instances
// move, against all placed triangles.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <tuple>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/poses.h"
#include "tests/oracle/exact/queries.h"
#include "tests/oracle/exact/ray_truth.h"
#include "tests/oracle/exact/scene_subject.h"

namespace boxtree::oracle {
namespace family_scenes {
namespace {

using SceneFaces = std::set<std::pair<std::uint32_t, std::uint32_t>>;  // id of the instance, face

struct State {
  const SceneSubject& subject;
  World world;
  Tally& tally;
};

std::string describe(const State& s, const SceneVariant& variant, const std::string& query,
                     const std::string& what, std::optional<std::uint32_t> placed) {
  std::string all = fmt::format("{}of {} instances: {}\n    {}", variant.name,
                                s.subject.poses.size(), what, query);
  if (!placed) return all;
  const Placed& p = s.world.placed[*placed];
  const cooker::SourceMesh& mesh = s.subject.meshes[s.subject.tree_of_id[p.id]];
  return all + fmt::format("\n    instance {} ({}), pose {}\n    in the world {}\n    {}", p.id,
                           s.subject.moves[p.id] ? "moving" : "static", text(s.subject.poses[p.id]),
                           text(s.world.group.triangles[*placed].at), text(mesh, {p.face}));
}

std::optional<std::uint32_t> index_of(const State& s, std::uint32_t id, std::uint32_t face,
                                      std::uint32_t half) {
  for (std::uint32_t i = 0; i < s.world.placed.size(); ++i) {
    const Placed& p = s.world.placed[i];
    if (p.id == id && p.face == face && p.half == half) return i;
  }
  return std::nullopt;
}

std::pair<std::uint32_t, std::uint32_t> key_of(const SceneVariant& variant, const SceneFace& face) {
  return {variant.id_of_number[face.instance], face.face.id};
}

// Boxes and spheres: faces that must be found, and faces that may be.
struct Expected {
  SceneFaces surely;
  SceneFaces perhaps;
};

void compare(const State& s, const SceneVariant& variant, const char* kind,
             const std::string& query, const Expected& expected,
             const std::vector<std::pair<std::uint32_t, std::uint32_t>>& found) {
  const SceneFaces once(found.begin(), found.end());
  const auto complain = [&](const char* what, const std::pair<std::uint32_t, std::uint32_t>& face) {
    s.tally.wrong(fmt::format("{}: {}", kind, what), [&] {
      return describe(s, variant, query,
                      fmt::format("instance {} face {} is {}", face.first, face.second, what),
                      index_of(s, face.first, face.second, 0));
    });
  };
  if (once.size() != found.size()) complain("repeated", found.front());
  for (const auto& face : expected.surely) {
    if (once.count(face) == 0) return complain("missed", face);
  }
  for (const auto& face : once) {
    if (expected.perhaps.count(face) == 0) return complain("extra", face);
  }
}

void check_box(const State& s, Draw& draw) {
  const Eigen::AlignedBox3d box = draw_box(draw, s.world.group);
  const BoxOf at{point_of(box.min()), point_of(box.max())};
  Expected expected;
  for (const Decoded& t : s.world.group.triangles) {
    if (!boxes_touch(t.bounds, at) || !triangle_touches_box(t.at, at)) continue;
    expected.surely.emplace(s.world.placed[t.face].id, s.world.placed[t.face].face);
  }
  expected.perhaps = expected.surely;
  const std::string query = fmt::format("box {} to {}", text(at.low), text(at.high));
  for (const SceneVariant& variant : s.subject.variants) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    const auto visit = overlap_box(variant.scene, box, [&](const SceneFace& face) {
      found.push_back(key_of(variant, face));
      return true;
    });
    s.tally.answer();
    if (visit) {
      compare(s, variant, "box", query, expected, found);
    } else {
      s.tally.wrong("box: error", [&] { return describe(s, variant, query, "error", {}); });
    }
  }
}

double unit_of(const Decoded& t, const Point& p) {
  return ulp_of(std::max(t.largest, largest(p)));
}

void check_sphere(const State& s, Draw& draw) {
  const Position position = draw_position(draw, s.world.group);
  const double radius = draw_length(draw, s.world.group, position);
  const Point at = point_of(position.at);
  if (!(largest(at) <= 0x1p200) || !std::isfinite(radius)) return;
  const ExactPoint exact = as<Dyadic>(at);
  Expected expected;
  for (const Decoded& t : s.world.group.triangles) {
    const double slack = kUlps * unit_of(t, at);
    if (distance_below(at, t.bounds) * (1 - 0x1p-50) > radius + 2 * slack) continue;
    const Quotient square = squared_distance(exact, t.exact);
    const Dyadic less = Dyadic(radius) - Dyadic(slack), more = Dyadic(radius) + Dyadic(slack);
    if (Quotient{more * more, 1.0} < square) continue;
    const auto face = std::make_pair(s.world.placed[t.face].id, s.world.placed[t.face].face);
    expected.perhaps.insert(face);
    if (less.sign() >= 0 && !(Quotient{less * less, 1.0} < square)) expected.surely.insert(face);
  }
  const std::string query = fmt::format("sphere {} radius {:a}", text(at), radius);
  for (const SceneVariant& variant : s.subject.variants) {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    const auto visit = overlap_sphere(variant.scene, position.at, radius, [&](const SceneFace& f) {
      found.push_back(key_of(variant, f));
      return true;
    });
    s.tally.answer();
    if (visit) {
      compare(s, variant, "sphere", query, expected, found);
    } else if (visit.code() == Errc::kInvalidQuery) {
      s.tally.refused();
    } else {
      s.tally.wrong("sphere: error", [&] { return describe(s, variant, query, "error", {}); });
    }
  }
}

void examine_closest(const State& s, const SceneVariant& variant, const std::string& query,
                     const Point& at, const SceneClosestPoint& answer) {
  const double distance = answer.distance;
  const std::uint32_t id = variant.id_of_number[answer.instance];
  const auto own = index_of(s, id, answer.face.id, answer.triangle);
  const auto complain = [&](const char* category, const std::string& what, std::uint32_t index) {
    s.tally.wrong(category, [&] { return describe(s, variant, query, what, index); });
  };
  if (!own) return complain("point: no such face", "no such face", 0);
  if (!std::isfinite(distance)) return complain("point: infinite", "infinite", *own);
  const ExactPoint exact = as<Dyadic>(at);
  const Decoded& t = s.world.group.triangles[*own];
  const Quotient square = squared_distance(exact, t.exact);
  const double error = error_in_units(distance, square, unit_of(t, at));
  s.tally.error(error);
  if (error > kUlps) {
    complain("point: distance of the face",
             fmt::format("off by {:.3g} ulp: {:.17g}, exact {:.17g}", error, distance,
                         root_below(square)),
             *own);
  }
  for (const Decoded& other : s.world.group.triangles) {
    if (distance_below(at, other.bounds) >= distance) continue;
    const Quotient nearer = squared_distance(exact, other.exact);
    if (is_at_most(distance, nearer)) continue;
    const double by = error_in_units(distance, nearer, unit_of(other, at));
    s.tally.error(by);
    if (by <= kUlps) continue;
    complain("point: a nearer face",
             fmt::format("nearer by {:.3g} ulp: {:.17g} and not {:.17g}", by, root_below(nearer),
                         distance),
             other.face);
    return;
  }
}

using ClosestKey = std::tuple<double, double, double, double, std::uint32_t, std::uint32_t>;

void check_point(const State& s, Draw& draw) {
  const Position position = draw_position(draw, s.world.group);
  const Point at = point_of(position.at);
  const std::string query = "point " + text(at);
  std::optional<ClosestKey> first;
  for (const SceneVariant& variant : s.subject.variants) {
    const auto answer = closest_point(variant.scene, position.at);
    s.tally.answer();
    if (!answer.ok()) {
      s.tally.refused();
      if (answer.code() != Errc::kInvalidQuery || first) {
        s.tally.wrong("point: error", [&] { return describe(s, variant, query, "error", {}); });
      }
      continue;
    }
    if (!answer.has_value()) {
      s.tally.wrong("point: nothing", [&] { return describe(s, variant, query, "nothing", {}); });
      continue;
    }
    const SceneClosestPoint& c = *answer;
    const ClosestKey key{
        c.distance, c.point[0], c.point[1], c.point[2], variant.id_of_number[answer->instance],
        c.face.id};
    if (!first) first = key;
    if (key != *first) {
      s.tally.wrong("point: other bits", [&] { return describe(s, variant, query, "bits", {}); });
    }
    examine_closest(s, variant, query, at, *answer);
  }
}

// By how much a ray can be off that was brought into an instance's object space and back: the
// condition of the pose times the roundings of what is added up on the way.
struct RayError {
  double relative;
  double absolute;
};
RayError ray_error(const Pose& pose, double origin, double largest_of_instance) {
  const int exponent = std::ilogb(pose.linear().cwiseAbs().maxCoeff());
  const Eigen::Matrix3d linear =
      pose.linear() * std::ldexp(1.0, -exponent / 2) * std::ldexp(1.0, -(exponent - exponent / 2));
  const Eigen::Matrix3d inverse = linear.inverse();
  const double condition = (linear.cwiseAbs() * inverse.cwiseAbs()).rowwise().sum().maxCoeff();
  const double magnitude = pose.translation().cwiseAbs().maxCoeff() + largest_of_instance + origin;
  return {0x1p-46 * condition, 0x1p-46 * condition * magnitude};
}

struct RaySetting {
  Ray ray;
  std::string query;
  std::vector<RayTruth> truth;
};

Ray draw_ray(Draw& draw, const Group& world) {
  Ray ray;
  ray.origin = draw_position(draw, world).at;
  ray.direction = draw_position(draw, world).at - ray.origin;
  if (draw.one_in(4)) ray.direction = {draw.unit(), draw.unit(), draw.unit()};
  if (draw.one_in(4)) ray.origin -= ray.direction * draw.power(0, 10);
  if (draw.one_in(4)) ray.direction *= draw.power(-100, 100);
  if (draw.one_in(6)) ray.direction[draw.below(3)] = 0;
  if (draw.one_in(6)) ray.t_max = 2 * draw.part();
  if (!ray.direction.allFinite() || ray.direction.isZero(0)) ray.direction = {1, 0.5, 0.25};
  return ray;
}

void examine_hit(const State& s, const SceneVariant& variant, const RaySetting& r,
                 const SceneRayHit& hit) {
  const auto own = index_of(s, variant.id_of_number[hit.instance], hit.face.id, hit.triangle);
  const auto complain = [&](const char* category, const std::string& what) {
    s.tally.wrong(category, [&] { return describe(s, variant, r.query, what, own); });
  };
  if (!own) return complain("ray: no such face", "no such face");
  const RayTruth& truth = r.truth[*own];
  if (!truth.may_be_hit) complain("ray: a hit beside the face", "beside the face");
  const double low = (std::isnan(truth.t) ? truth.t_low : truth.t) - truth.t_tolerance;
  const double high = (std::isnan(truth.t) ? truth.t_high : truth.t) + truth.t_tolerance;
  if (std::isfinite(low) && std::isfinite(high) && (hit.t < low || hit.t > high)) {
    complain("ray: wrong t", fmt::format("t {:.17g}, exact {:.17g} to {:.17g}", hit.t, low, high));
  }
  if (!(hit.t >= r.ray.t_min && hit.t <= r.ray.t_max)) complain("ray: t out of range", "");
}

void examine_missed(const State& s, const SceneVariant& variant, const RaySetting& r,
                    const std::optional<SceneRayHit>& hit) {
  for (std::uint32_t i = 0; i < r.truth.size(); ++i) {
    const RayTruth& truth = r.truth[i];
    const double tolerance = truth.t_tolerance + 2 * std::numeric_limits<double>::denorm_min();
    if (!truth.is_surely_hit || !std::isfinite(truth.t) || !std::isfinite(tolerance)) continue;
    if (!(truth.t - tolerance >= r.ray.t_min && truth.t + tolerance <= r.ray.t_max)) continue;
    if (hit && hit->t <= truth.t + tolerance) continue;
    s.tally.wrong(hit ? "ray: a nearer hit missed" : "ray: missed", [&] {
      return describe(s, variant, r.query, fmt::format("hit at {:.17g} is exact", truth.t), i);
    });
    return;
  }
}

void check_ray(const State& s, Draw& draw) {
  RaySetting r{draw_ray(draw, s.world.group), {}, {}};
  const Point origin = point_of(r.ray.origin);
  if (!(largest(origin) <= 0x1p190)) return;
  r.query = fmt::format("ray from {} along {} t {:a} to {:a}", text(origin),
                        text(point_of(r.ray.direction)), r.ray.t_min, r.ray.t_max);
  const ExactRay exact(origin, point_of(r.ray.direction));
  std::map<std::uint32_t, RayError> errors;
  for (const Decoded& t : s.world.group.triangles) {
    const std::uint32_t id = s.world.placed[t.face].id;
    if (errors.count(id) == 0) {
      double largest_of_instance = 0;
      for (const Decoded& other : s.world.group.triangles) {
        if (s.world.placed[other.face].id != id) continue;
        largest_of_instance = std::max(largest_of_instance, other.largest);
      }
      errors.emplace(id, ray_error(s.subject.poses[id], largest(origin), largest_of_instance));
    }
    const RayError& error = errors.at(id);
    if (std::isfinite(error.absolute) && std::isfinite(error.relative)) {
      r.truth.push_back(truth_of(exact, t.at, error.relative, error.absolute, 0));
    } else {
      r.truth.push_back({false, true, std::numeric_limits<double>::quiet_NaN(),
                         -std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::infinity(), 0});
    }
  }
  using Key = std::tuple<double, double, double, std::uint32_t, std::uint32_t>;
  std::optional<std::optional<Key>> first;
  for (const SceneVariant& variant : s.subject.variants) {
    const auto hit = closest_hit(variant.scene, r.ray);
    s.tally.answer();
    if (!hit.ok()) {
      s.tally.refused();
      if (hit.code() != Errc::kInvalidQuery || first) {
        s.tally.wrong("ray: error", [&] { return describe(s, variant, r.query, "error", {}); });
      }
      continue;
    }
    std::optional<Key> key;
    if (hit.has_value()) {
      const SceneRayHit& h = *hit;
      key = Key{h.t, h.u, h.v, variant.id_of_number[hit->instance], h.face.id};
      examine_hit(s, variant, r, *hit);
    }
    if (!first) first = key;
    if (key != *first) {
      s.tally.wrong("ray: other bits", [&] { return describe(s, variant, r.query, "bits", {}); });
    }
    examine_missed(s, variant, r, hit.as_optional());
    const auto any = any_hit(variant.scene, r.ray);
    s.tally.answer();
    if (!any.ok() || any.has_value() != hit.has_value()) {
      s.tally.wrong("ray: any hit is not as closest hit",
                    [&] { return describe(s, variant, r.query, "any", {}); });
    } else if (any.has_value()) {
      examine_hit(s, variant, r, *any);
    }
  }
}

// Contacts of two instances: decided in the space of either tree, so pairs on which both agree.
using Contact = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
struct Contacts {
  std::set<Contact> surely, perhaps;  // instance, face, instance, face; the smaller id first
  bool is_known = true;
};

void add_contacts(const SceneSubject& subject, const Scene& scene, std::uint32_t a, std::uint32_t b,
                  Contacts& all) {
  const std::uint32_t s = subject.tree_of_id[a], t = subject.tree_of_id[b];
  const std::span<const Tree> trees = scene.trees();
  const PlacedPair forth{subject.poses[a], subject.poses[b], false};
  const PlacedPair back{subject.poses[b], subject.poses[a], false};
  const auto in_first = images(trees[s], subject.trees[t], forth, trees[t]);
  const auto in_second = images(trees[t], subject.trees[s], back, trees[s]);
  if (!in_first || !in_second) {
    all.is_known = false;
    return;
  }
  for (std::size_t i = 0; i < subject.trees[s].triangles.size(); ++i) {
    for (std::size_t j = 0; j < subject.trees[t].triangles.size(); ++j) {
      const Decoded& x = subject.trees[s].triangles[i];
      const Decoded& y = subject.trees[t].triangles[j];
      const bool one = triangles_touch(x.at, in_first->triangles[j].at);
      const bool other = triangles_touch(in_second->triangles[i].at, y.at);
      if (one || other) all.perhaps.emplace(a, x.face, b, y.face);
      if (one && other) all.surely.emplace(a, x.face, b, y.face);
    }
  }
}

Contact contact_of(const SceneVariant& variant, const ScenePair& pair) {
  const auto [i, f] = key_of(variant, pair.first);
  const auto [j, g] = key_of(variant, pair.second);
  return i < j ? Contact{i, f, j, g} : Contact{j, g, i, f};
}

void compare_contacts(const State& s, const SceneVariant& variant, const char* query,
                      const Contacts& expected, const std::vector<Contact>& found) {
  const std::set<Contact> once(found.begin(), found.end());
  const auto complain = [&](const char* category, const Contact& c) {
    s.tally.wrong(fmt::format("{}: {}", query, category), [&] {
      const auto [i, f, j, g] = c;
      return describe(s, variant,
                      fmt::format("instance {} face {}, instance {} face {}", i, f, j, g), category,
                      index_of(s, i, f, 0)) +
             "\n    other pose " + text(s.subject.poses[j]);
    });
  };
  if (once.size() != found.size()) complain("repeated", found.front());
  for (const Contact& c : expected.surely) {
    if (once.count(c) == 0) return complain("missed", c);
  }
  for (const Contact& c : once) {
    if (expected.perhaps.count(c) == 0) return complain("extra", c);
  }
}

void check_contacts(const State& s, Draw& draw) {
  Contacts of_moving, of_one;
  const auto count = static_cast<std::uint32_t>(s.subject.poses.size());
  const std::uint32_t one = draw.below(count);
  const Scene& any = s.subject.variants[0].scene;
  for (std::uint32_t a = 0; a < count; ++a) {
    for (std::uint32_t b = a + 1; b < count; ++b) {
      if (s.subject.moves[a] || s.subject.moves[b]) add_contacts(s.subject, any, a, b, of_moving);
      if (a == one || b == one) add_contacts(s.subject, any, a, b, of_one);
    }
  }
  for (const SceneVariant& variant : s.subject.variants) {
    std::vector<Contact> found;
    const auto collect = [&](const ScenePair& pair) {
      found.push_back(contact_of(variant, pair));
      return true;
    };
    const auto run = [&](const Result<Visit>& visit, const char* query, const Contacts& expected) {
      s.tally.answer();
      if (!expected.is_known) {
        s.tally.refused();
      } else if (!visit) {
        s.tally.wrong(fmt::format("{}: error", query),
                      [&] { return describe(s, variant, query, visit.error().message(), {}); });
      } else {
        compare_contacts(s, variant, query, expected, found);
      }
      found.clear();
    };
    run(contacts(variant.scene, collect), "contacts", of_moving);
    run(contacts_of(variant.scene, variant.number_of_id[one], collect), "contacts of one", of_one);
  }
}

}  // namespace
}  // namespace family_scenes

void run_scenes(Draw& draw, Tally& tally, std::uint64_t number) {
  using namespace family_scenes;
  constexpr int kRounds = 5, kUpdates = 300;
  const auto subject = draw_scene(draw);
  if (!subject) {
    tally.answer();
    tally.refused();
    return;
  }
  const int decades = 50 * static_cast<int>(std::log10(subject->world_size) / 50);
  tally.begin_case(number, subject->poses.size(), fmt::format("world size 1e{}", decades));
  for (int round = 0; round < kRounds; ++round) {
    const State s{*subject, world_of(*subject), tally};
    for (int i = 0; i < 12; ++i) check_ray(s, draw);
    for (int i = 0; i < 8; ++i) check_box(s, draw);
    for (int i = 0; i < 8; ++i) check_sphere(s, draw);
    for (int i = 0; i < 8; ++i) check_point(s, draw);
    check_contacts(s, draw);
    for (std::uint32_t i = update_some(draw, *subject, kUpdates); i > 0; --i) tally.refused();
  }
}

}  // namespace boxtree::oracle
