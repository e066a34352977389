// SPDX-License-Identifier: MIT
// Families "casts" and "contacts": when shapes that move first touch, and which triangles they
// touch at rest, against the exact distances of what they sweep.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <tuple>
#include <variant>
#include <vector>

#include <fmt/format.h>

#include "tests/oracle/cgal_distance.h"
#include "tests/oracle/exact/families.h"
#include "tests/oracle/exact/queries.h"

namespace boxtree::oracle {
namespace {

using LongVector = Eigen::Matrix<long double, 3, 1>;

// What cast.h allows, in units of the largest coordinate.
constexpr double kDoubt = 0x1p-46;

// A hull that owns its points.
struct Hull {
  std::vector<Eigen::Vector3d> points;
  Eigen::Vector3d position;
  decltype(ConvexHull::rotation) rotation{1, 0, 0, 0};
};
using Shape = std::variant<Sphere, Capsule, OrientedBox, Hull>;

template <class Body>
decltype(auto) with_shape(const Shape& shape, Body body) {
  return std::visit(
      [&]<class S>(const S& held) {
        if constexpr (std::is_same_v<S, Hull>) {
          return body(ConvexHull{held.points, held.position, held.rotation});
        } else {
          return body(held);
        }
      },
      shape);
}

// The points whose hull, with a radius around it, the shape is: without rounding, times a factor,
// the square of the length of its rotation.
struct ExactShape {
  std::vector<ExactVector> points;
  double radius = 0;
  ExactNumber factor{1};
  LongVector center = LongVector::Zero();
  long double reach = 0;  // around it, at least
  double largest_at = 0;  // coordinate of the center
  double local_size = 0;  // coordinate of a hull's points
};

ExactVector turned(const decltype(OrientedBox::rotation)& q, const ExactVector& v) {
  const ExactNumber w(q.w());
  const ExactVector u = exact(q.vec());
  const auto cross = [](const ExactVector& a, const ExactVector& b) -> ExactVector {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  // q v q*, which is |q|^2 times the turned vector.
  const ExactNumber two(2);
  return (w * w - dot(u, u)) * v + (two * dot(u, v)) * u + (two * w) * cross(u, v);
}

ExactShape exact_shape(const Shape& shape) {
  ExactShape out;
  const auto add = [&](const decltype(OrientedBox::rotation)& q, const Eigen::Vector3d& at,
                       const std::vector<Eigen::Vector3d>& points) {
    out.factor = ExactNumber(q.w()) * ExactNumber(q.w()) + dot(exact(q.vec()), exact(q.vec()));
    for (const Eigen::Vector3d& p : points) {
      out.points.push_back(turned(q, exact(p)) + out.factor * exact(at));
      out.reach = std::max(out.reach, p.cast<long double>().norm());
      out.local_size = std::max(out.local_size, p.cwiseAbs().maxCoeff());
    }
    out.center = at.cast<long double>();
  };
  if (const auto* const sphere = std::get_if<Sphere>(&shape)) {
    add({1, 0, 0, 0}, sphere->center, {Eigen::Vector3d::Zero()});
    out.radius = sphere->radius;
  } else if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    out.points = {exact(capsule->start), exact(capsule->end)};
    const LongVector a = capsule->start.cast<long double>(), b = capsule->end.cast<long double>();
    out.center = (a + b) / 2;
    out.reach = (a - b).norm() / 2;
    out.radius = capsule->radius;
  } else if (const auto* const box = std::get_if<OrientedBox>(&shape)) {
    std::vector<Eigen::Vector3d> corners;
    for (int i = 0; i < 8; ++i) {
      corners.push_back(box->half_extents.cwiseProduct(
          Eigen::Vector3d((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1)));
    }
    add(box->rotation, box->center, corners);
  } else {
    const auto& hull = std::get<Hull>(shape);
    add(hull.rotation, hull.position, hull.points);
  }
  out.largest_at = static_cast<double>(out.center.cwiseAbs().maxCoeff());
  return out;
}

// A triangle in object space, without rounding.
struct Target {
  const Decoded* decoded;
  std::array<ExactVector, 3> corner;
  LongVector center;
  long double radius;  // of a ball around it
};

struct Setting {
  const Subject& subject;
  const Group& group;
  std::vector<Target> targets;
  double largest = 0;  // coordinate, object space
  double resolution = 0;
  std::string name;
};

Setting setting_of(const Subject& subject, const Group& group) {
  Setting s{subject, group, {}, 0, 0, {}};
  const Frame& frame = group.frame();
  for (const Decoded& t : group.triangles) {
    Target target{&t, {}, LongVector::Zero(), 0};
    std::array<LongVector, 3> corner;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        const auto i = static_cast<Eigen::Index>(k);
        target.corner[c][k] =
            ExactNumber(t.at[c][k]) * ExactNumber(frame.scale) + ExactNumber(frame.origin[i]);
        corner[c][i] = static_cast<long double>(t.at[c][k]) * frame.scale + frame.origin[i];
        s.largest = std::max(s.largest, static_cast<double>(std::abs(corner[c][i])));
      }
    }
    target.center = (corner[0] + corner[1] + corner[2]) / 3;
    for (const LongVector& c : corner) {
      target.radius = std::max(target.radius, (c - target.center).norm());
    }
    s.targets.push_back(std::move(target));
  }
  // Distances are resolved to 2^-500 of the extent, which is about 1 in tree space.
  s.resolution = 0x1p-500 * frame.scale;
  return s;
}

// Whether the shape, on its way to `to`, comes within `distance` of the triangle, or nearer than
// it. `touching`: at just that distance, too.
bool comes_near(const ExactShape& shape, const Eigen::Vector3d& direction, double to,
                const Target& target, const ExactNumber& distance, bool touching) {
  // Balls first, with more room than their rounding needs.
  const LongVector d = direction.cast<long double>();
  const LongVector w = target.center - shape.center;
  const long double dd = d.squaredNorm();
  const long double s = dd > 0 ? std::clamp<long double>(w.dot(d) / dd, 0, to) : 0;
  const long double near =
      target.radius + shape.reach + std::abs(static_cast<long double>(CGAL::to_double(distance)));
  const long double rounding =
      0x1p-50L * (target.center.norm() + shape.center.norm() + s * std::sqrt(dd));
  if ((w - s * d).norm() > near * (1 + 0x1p-40L) + rounding) return false;

  std::vector<ExactVector> swept = shape.points;
  if (to > 0 && dd > 0) {
    const ExactVector way = (shape.factor * ExactNumber(to)) * exact(direction);
    for (const ExactVector& p : shape.points) swept.push_back(p + way);
  }
  std::array<ExactVector, 3> corners;
  for (std::size_t c = 0; c < 3; ++c) corners[c] = shape.factor * target.corner[c];
  const ExactSquare square = squared_distance(swept, corners);
  const ExactNumber limit = shape.factor * distance;
  const ExactSquare limit_square(limit * limit);
  return square < limit_square || (touching && square == limit_square);
}

std::string describe(const Setting& s, const Cooked& cooked, const Shape& shape,
                     const Motion* motion, const std::string& what,
                     const std::vector<std::uint32_t>& faces) {
  const auto v = [](const Eigen::Vector3d& p) { return text(point_of(p)); };
  const auto q = [](const auto& r) {
    return fmt::format("wxyz {:a} {:a} {:a} {:a}", r.w(), r.x(), r.y(), r.z());
  };
  std::string placed;
  if (const auto* const sphere = std::get_if<Sphere>(&shape)) {
    placed = fmt::format("sphere {} radius {:a}", v(sphere->center), sphere->radius);
  } else if (const auto* const capsule = std::get_if<Capsule>(&shape)) {
    placed = fmt::format("capsule {} {} radius {:a}", v(capsule->start), v(capsule->end),
                         capsule->radius);
  } else if (const auto* const box = std::get_if<OrientedBox>(&shape)) {
    placed =
        fmt::format("box {} half {} {}", v(box->center), v(box->half_extents), q(box->rotation));
  } else {
    const auto& hull = std::get<Hull>(shape);
    placed = fmt::format("hull {} {}", v(hull.position), q(hull.rotation));
    for (const Eigen::Vector3d& p : hull.points) placed += fmt::format(" {}", v(p));
  }
  if (motion != nullptr) {
    placed += fmt::format("\n    direction {} t_max {:a}", v(motion->direction), motion->t_max);
  }
  return fmt::format("{}: {}\n    {}\n    {}", cooked.name, what, placed,
                     text(s.subject.mesh, faces));
}

// Beyond what queries promise to take, or near it: they may be refused.
bool may_be_refused(const Setting& s, const ExactShape& shape) {
  const double extent = s.group.frame().scale;
  return std::max(shape.largest_at, static_cast<double>(shape.reach) + shape.radius) >
         0x1p184 * extent;
}

double doubt_of(const Setting& s, const ExactShape& shape, double of_start) {
  const double size = s.largest + 2 * (static_cast<double>(shape.reach) + shape.radius) +
                      2 * shape.local_size + of_start * shape.largest_at;
  return kDoubt * size + s.resolution + 0x1p-1060;
}

void check_cast(const Setting& s, const Shape& tested, const Motion& motion, Tally& tally) {
  const ExactShape shape = exact_shape(tested);
  const double doubt = doubt_of(s, shape, 0.125);
  if (4 * doubt > std::numeric_limits<double>::max()) return;  // a shape too large to be compared
  const ExactNumber radius(shape.radius);
  std::optional<CastResult> first;
  for (std::size_t i = 0; i < s.group.trees.size(); ++i) {
    const Cooked& cooked = *s.group.trees[i];
    const CastResult hit = with_shape(
        tested, [&](const auto& placed) { return cast_closest(cooked.tree, placed, motion); });
    tally.answer();
    const auto wrong = [&](const char* what) {
      tally.wrong(what, [&] {
        std::string found = "nothing";
        std::vector<std::uint32_t> faces;
        if (hit.ok() && hit) {
          faces.push_back(hit->face.id);
          found = fmt::format("face {} t {:a} t_lower {:a}", hit->face.id, hit->t, hit->t_lower);
        }
        return describe(s, cooked, tested, &motion, found, faces);
      });
    };
    if (!hit.ok()) {
      if (may_be_refused(s, shape) && hit.code() == Errc::kInvalidQuery) {
        tally.refused();
      } else {
        wrong("cast: error");
      }
      continue;
    }
    if (first) {  // the others have the same bits
      const CastResult& other = *first;
      if (hit.has_value() != other.has_value() ||
          (hit && (hit->t != other->t || hit->t_lower != other->t_lower ||
                   hit->face.id != other->face.id || hit->triangle != other->triangle))) {
        wrong("cast: another than plain-f32");
      }
      continue;
    }
    first = hit;
    const auto touches = [&](double to) {
      return std::any_of(s.targets.begin(), s.targets.end(), [&](const Target& target) {
        return comes_near(shape, motion.direction, to, target, radius, true);
      });
    };
    if (!hit) {
      if (touches(motion.t_max)) wrong("cast: missed");
      continue;
    }
    if (!(0 <= hit->t_lower && hit->t_lower <= hit->t && hit->t <= motion.t_max)) {
      wrong("cast: order of times");
    }
    if (hit->t_lower > 0 && touches(std::nextafter(hit->t_lower, 0))) {
      wrong("cast: touches before t_lower");
    }
    const auto named = std::find_if(s.targets.begin(), s.targets.end(), [&](const Target& target) {
      return target.decoded->face == hit->face.id && target.decoded->half == hit->triangle;
    });
    if (named == s.targets.end()) {
      wrong("cast: no such face");
      continue;
    }
    if (!comes_near(shape, motion.direction, hit->t, *named, radius + ExactNumber(doubt), true)) {
      wrong("cast: does not touch by t");
    }
    if (!comes_near(shape, motion.direction, hit->t_lower, *named, radius + ExactNumber(4 * doubt),
                    true)) {
      wrong("cast: t_lower is too early");
    }
  }
}

using Key = std::pair<std::uint32_t, std::uint32_t>;

void check_contacts(const Setting& s, const Shape& tested, Tally& tally) {
  const ExactShape shape = exact_shape(tested);
  const double doubt = doubt_of(s, shape, 1);
  if (4 * doubt > std::numeric_limits<double>::max()) return;
  const ExactNumber radius(shape.radius);
  const Eigen::Vector3d still = Eigen::Vector3d::Zero();
  std::optional<std::vector<Key>> first;
  for (std::size_t i = 0; i < s.group.trees.size(); ++i) {
    const Cooked& cooked = *s.group.trees[i];
    std::vector<Key> found;
    std::vector<Contact> contacts;
    const auto visit = with_shape(tested, [&](const auto& placed) {
      return collide(cooked.tree, placed, [&](const Contact& contact) {
        found.emplace_back(contact.face.id, contact.triangle);
        contacts.push_back(contact);
        return true;
      });
    });
    tally.answer();
    const auto wrong = [&](const char* what, std::uint32_t face) {
      tally.wrong(what, [&] {
        return describe(s, cooked, tested, nullptr,
                        fmt::format("{} contacts; face {}", found.size(), face), {face});
      });
    };
    if (!visit.ok()) {
      if (may_be_refused(s, shape) && visit.code() == Errc::kInvalidQuery) {
        tally.refused();
      } else {
        wrong("contacts: error", 0);
      }
      continue;
    }
    std::sort(found.begin(), found.end());
    const auto twice = std::adjacent_find(found.begin(), found.end());
    if (twice != found.end()) wrong("contacts: repeated", twice->first);
    if (first) {
      if (found != *first) wrong("contacts: others than plain-f32", 0);
      continue;
    }
    first = found;
    for (const Target& target : s.targets) {
      const std::uint32_t face = target.decoded->face;
      const Key key(face, target.decoded->half);
      if (!std::binary_search(found.begin(), found.end(), key)) {
        if (comes_near(shape, still, 0, target, radius, true)) wrong("contacts: missed", face);
        continue;
      }
      if (!comes_near(shape, still, 0, target, radius + ExactNumber(doubt), true)) {
        wrong("contacts: invented", face);
      }
    }
    for (const Contact& contact : contacts) {
      const auto named =
          std::find_if(s.targets.begin(), s.targets.end(), [&](const Target& target) {
            return target.decoded->face == contact.face.id &&
                   target.decoded->half == contact.triangle;
          });
      if (named == s.targets.end()) {
        wrong("contacts: no such face", contact.face.id);
        continue;
      }
      if (!contact.normal.allFinite() || !std::isfinite(contact.depth)) {
        tally.wrong("contacts: not finite", [&] {
          return describe(s, cooked, tested, nullptr,
                          fmt::format("face {} depth {:a} normal {}", contact.face.id,
                                      contact.depth, text(point_of(contact.normal))),
                          {contact.face.id});
        });
        continue;
      }
      // Moved by its depth along its normal the shape is beyond the triangle.
      const ExactVector normal = exact(contact.normal);
      std::optional<ExactNumber> highest, lowest;
      for (const ExactVector& c : named->corner) {
        const ExactNumber at = shape.factor * dot(c, normal);
        if (!highest || at > *highest) highest = at;
      }
      for (const ExactVector& p : shape.points) {
        const ExactNumber at = dot(p, normal);
        if (!lowest || at < *lowest) lowest = at;
      }
      const ExactNumber parted =
          shape.factor * (ExactNumber(contact.depth) - radius + ExactNumber(8 * doubt));
      if (!(contact.depth >= 0) || *highest - *lowest > parted) {
        tally.wrong("contacts: the depth does not part them", [&] {
          const double more = CGAL::to_double(*highest - *lowest) / CGAL::to_double(shape.factor) +
                              shape.radius - contact.depth;
          return describe(
              s, cooked, tested, nullptr,
              fmt::format("face {} half {} depth {:a} normal {}: deeper by {:.3g}, {:.3g} "
                          "times what is allowed",
                          contact.face.id, contact.triangle, contact.depth,
                          text(point_of(contact.normal)), more, more / doubt),
              {contact.face.id});
        });
      }
    }
  }
}

decltype(OrientedBox::rotation) draw_rotation(Draw& d) {
  if (d.one_in(3)) return {1, 0, 0, 0};
  if (d.one_in(4)) return {1, d.power(-60, -3), 0, 0};
  decltype(OrientedBox::rotation) q(d.unit(), d.unit(), d.unit(), d.unit());
  if (d.one_in(4)) q.coeffs() = (4 * q.coeffs()).array().round().matrix();
  if (q.coeffs().isZero(0)) q.w() = 1;
  if (d.one_in(4)) q.coeffs() *= d.power(-100, 100);
  return q;
}

enum class Kinds { kPlain, kHulls };

Shape draw_shape(Draw& d, Kinds kinds, const Eigen::Vector3d& at, double length) {
  const auto vector = [&] {
    Eigen::Vector3d v(d.unit(), d.unit(), d.unit());
    if (d.one_in(3)) v = (4 * v).array().round() / 4;
    return v;
  };
  switch (kinds == Kinds::kHulls ? 3 : d.below(3)) {
    case 0:
      return Sphere{at, length};
    case 1: {
      const double part = d.one_in(3) ? 1 : d.power(-8, 4);
      return Capsule{at, at + length * part * vector(), length};
    }
    case 2: {
      OrientedBox box;
      box.center = at;
      box.half_extents = length * vector().cwiseAbs();
      if (d.one_in(3)) box.half_extents[d.below(3)] = length;
      box.rotation = draw_rotation(d);
      return box;
    }
    default: {
      Hull hull;
      const std::uint32_t count = 1 + d.below(6);
      for (std::uint32_t i = 0; i < count; ++i) hull.points.push_back(length * vector());
      if (d.one_in(4)) {
        for (Eigen::Vector3d& p : hull.points) p[2] = 0;
      }
      hull.position = at;
      hull.rotation = draw_rotation(d);
      return hull;
    }
  }
}

bool is_finite(const Shape& shape) {
  return std::visit(
      []<class S>(const S& held) {
        if constexpr (std::is_same_v<S, Sphere>) {
          return held.center.allFinite() && std::isfinite(held.radius);
        } else if constexpr (std::is_same_v<S, Capsule>) {
          return held.start.allFinite() && held.end.allFinite() && std::isfinite(held.radius);
        } else if constexpr (std::is_same_v<S, OrientedBox>) {
          return held.center.allFinite() && held.half_extents.allFinite();
        } else {
          bool finite = held.position.allFinite();
          for (const Eigen::Vector3d& p : held.points) finite &= p.allFinite();
          return finite;
        }
      },
      shape);
}

// Towards a position on or near the mesh, along an axis, or nowhere.
Motion draw_motion(Draw& d, const Group& group, const Eigen::Vector3d& from) {
  Motion motion;
  motion.direction = draw_position(d, group).at - from;
  if (d.one_in(4)) {
    const double length = motion.direction.stableNorm();
    motion.direction = d.sign() * length * Eigen::Vector3d::Unit(d.below(3));
  }
  if (d.one_in(8)) motion.direction *= d.power(-60, 60);
  if (d.one_in(16)) motion.direction.setZero();
  motion.t_max = d.one_in(3) ? 1 : 2 * d.part();
  return motion;
}

struct Drawn {
  Shape shape;
  Eigen::Vector3d at;
};
std::optional<Drawn> draw_placed(Draw& d, Kinds kinds, const Group& group) {
  const Position position = draw_position(d, group);
  if (!(largest(to_tree(group.frame(), position.at)) <= 0x1p210)) return std::nullopt;
  const double length = draw_length(d, group, position);
  Drawn drawn{draw_shape(d, kinds, position.at, length), position.at};
  if (!is_finite(drawn.shape)) return std::nullopt;
  return drawn;
}

template <class Check>
void run(Draw& draw, Kinds kinds, Tally& tally, std::uint64_t number, Check check) {
  constexpr int kShapes = 12;
  MeshWish wish;
  wish.faces = 16;
  const auto subject = make_subject(draw_mesh(draw, wish), draw.one_in(3));
  tally.begin_case(number, subject->mesh.faces.size(), subject->mesh.name);
  for (const Group& group : subject->groups) {
    const Setting setting = setting_of(*subject, group);
    for (int i = 0; i < kShapes; ++i) {
      const auto drawn = draw_placed(draw, kinds, group);
      if (drawn && setting.largest < 0x1p1000) check(setting, *drawn);  // else doubts overflow
    }
  }
}

}  // namespace

void run_casts(Draw& draw, Tally& tally, std::uint64_t number) {
  run(draw, Kinds::kPlain, tally, number, [&](const Setting& setting, const Drawn& drawn) {
    const Motion motion = draw_motion(draw, setting.group, drawn.at);
    if (motion.direction.allFinite()) check_cast(setting, drawn.shape, motion, tally);
  });
}

void run_contacts(Draw& draw, Tally& tally, std::uint64_t number) {
  run(draw, Kinds::kPlain, tally, number, [&](const Setting& setting, const Drawn& drawn) {
    check_contacts(setting, drawn.shape, tally);
  });
}

void run_hulls(Draw& draw, Tally& tally, std::uint64_t number) {
  run(draw, Kinds::kHulls, tally, number, [&](const Setting& setting, const Drawn& drawn) {
    const Motion motion = draw_motion(draw, setting.group, drawn.at);
    if (motion.direction.allFinite()) check_cast(setting, drawn.shape, motion, tally);
    check_contacts(setting, drawn.shape, tally);
  });
}

}  // namespace boxtree::oracle
