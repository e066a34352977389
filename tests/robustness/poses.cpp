// SPDX-License-Identifier: MIT
// Poses: far away, nearly aligned, not rigid, not quite orthonormal.
#include <cmath>
#include <random>

#include <Eigen/LU>

#include "runtime/query/relative_pose.h"
#include "tests/robustness/brute_force.h"
#include "tests/robustness/mesh_kinds.h"

namespace boxtree::robustness {
namespace {

class Random {
 public:
  explicit Random(std::uint64_t seed) : random_(seed) {}
  double unit() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  Eigen::Vector3d vector() { return {unit() - 0.5, unit() - 0.5, unit() - 0.5}; }
  Eigen::Matrix3d rotation() {
    return Eigen::Quaterniond(unit() - 0.5, unit() - 0.5, unit() - 0.5, unit() - 0.5)
        .normalized()
        .toRotationMatrix();
  }

 private:
  std::mt19937_64 random_;
};

// Compares the answers in a pose with brute force in every codec and store. Returns the number of
// pairs.
std::size_t check_poses(Run& run, const SourceMesh& a, const SourceMesh& b,
                        const std::vector<Pose>& poses) {
  std::size_t pairs = 0;
  for (const Store& store : kStores) {
    std::vector<FacePairs> expected;
    for (const CodecInfo& codec : kCodecs) {
      const Subject s = make_subject(a, codec.id, store), t = make_subject(b, codec.id, store);
      for (std::size_t i = 0; i < poses.size(); ++i) {
        // All codecs of a store decode to the same triangles.
        if (expected.size() == i) {
          expected.push_back(brute_pairs(s.tree(), Pose::Identity(), t.tree(), poses[i]));
        }
        const FacePairs found = found_pairs(s.tree(), Pose::Identity(), t.tree(), poses[i]);
        pairs += found.size();
        run.check(found == expected[i],
                  [&] { return s.name + " against " + b.name + ": pose " + std::to_string(i); });
      }
    }
  }
  return pairs;
}

// Two rotated bodies, a metre long, 1e6 from the origin. A corner of the second is above the middle
// of a face of the first. The gap at which contact begins is known up to the rounding of the poses.
void far_away(Run& run) {
  Random random(4);
  const SourceMesh box = box_mesh(Eigen::Vector3d(0.5, 0.5, 0.5));
  for (const CodecInfo& codec : kCodecs) {
    const Subject subject = make_subject(box, codec.id, kExactStore);
    for (int i = 0; i < 40; ++i) {
      Pose first = Pose::Identity(), second = Pose::Identity();
      first.linear() = random.rotation();
      first.translation() = 1e6 * Eigen::Vector3d(1, -0.5, 0.75) + random.vector();
      second.linear() = random.rotation();
      const Eigen::Vector3d normal = first.linear().col(0);
      // The lowest corner along the normal: it touches at gap 0.
      Eigen::Vector3d corner;
      for (Eigen::Index k = 0; k < 3; ++k) {
        corner[k] = second.linear().col(k).dot(normal) > 0 ? -0.5 : 0.5;
      }
      // Positions relative to the first body are small; only the last sum is rounded at 1e6.
      const auto touches_at = [&](double gap) {
        const Eigen::Vector3d between = (0.5 + gap) * normal - second.linear() * corner;
        second.translation() = first.translation() + between;
        const auto contact = first_contact(subject.tree(), first, subject.tree(), second);
        return contact.ok() && contact.has_value();
      };
      run.check(!touches_at(1), "contact at a gap of 1");
      // The answer changes once between these; the rounding at 1e6 is 1.2e-10.
      double touching = -1e-3, apart = 1e-3;
      run.premise(touches_at(touching) && !touches_at(apart), "no contact begins");
      for (int step = 0; step < 60; ++step) {
        const double middle = (touching + apart) / 2;
        (touches_at(middle) ? touching : apart) = middle;
      }
      run.measure(std::abs((touching + apart) / 2));
    }
  }
}

// Translations that are exact in double: answers there equal those at the origin, to the last pair.
void huge_translations(Run& run) {
  const SourceMesh mesh = snapped(test::torus(16, 12), -6);
  Random random(8);
  for (const Store& store : kStores) {
    for (const CodecInfo& codec : kCodecs) {
      const Subject subject = make_subject(mesh, codec.id, store);
      std::size_t pairs = 0;
      for (int i = 0; i < 12; ++i) {
        Pose first = Pose::Identity(), second = Pose::Identity();
        first.linear() = random.rotation();
        second.linear() = random.rotation();
        second.translation() = (4 * random.vector()).array().round() * 0.125;
        const FacePairs expected = found_pairs(subject.tree(), first, subject.tree(), second);
        pairs += expected.size();
        for (const double away : {1e9, -1e9, 0x1p49}) {
          Pose there = first, beside = second;
          there.translation() += away * Eigen::Vector3d(1, -1, 0.5);
          beside.translation() += away * Eigen::Vector3d(1, -1, 0.5);
          run.check(found_pairs(subject.tree(), there, subject.tree(), beside) == expected,
                    [&] { return subject.name + ": " + std::to_string(away); });
          // One tree is here, the other far away.
          run.check(found_pairs(subject.tree(), first, subject.tree(), beside).empty(),
                    [&] { return subject.name + ": one at " + std::to_string(away); });
        }
      }
      run.premise(pairs > 100, "hardly any pair of faces touches");
    }
  }
  // The mesh is cooked far away, and the pose moves it back.
  const SourceMesh baked = plus(mesh, Eigen::Vector3d(0x1p17, -0x1p16, 0x1p17));
  const Subject here = make_subject(mesh, CodecId::kWide8, kExactStore);
  for (const CodecInfo& codec : kCodecs) {
    const Subject out = make_subject(baked, codec.id, kExactStore);
    Pose back = Pose::Identity();
    back.translation() = Eigen::Vector3d(-0x1p17 + 0.5, 0x1p16, -0x1p17);
    Pose shift = Pose::Identity();
    shift.translation() = Eigen::Vector3d(0.5, 0, 0);
    run.check(found_pairs(here.tree(), Pose::Identity(), out.tree(), back) ==
                  found_pairs(here.tree(), Pose::Identity(), here.tree(), shift),
              [&] { return out.name; });
  }
}

void near_parallel(Run& run) {
  const std::vector<Eigen::Vector3d> extents = {
      {1, 1, 1}, {1e-3, 1, 1e3}, {1e3, 1e-3, 1}, {1e6, 1, 1e-3}, {1e-3, 1e-3, 1e6}};
  std::size_t pairs = 0;
  for (const Eigen::Vector3d& half : extents) {
    const SourceMesh box = box_mesh(half);
    std::vector<Pose> poses;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      for (const double angle : {1e-9, -1e-8, 1e-7, 1e-6, -1e-5, 1e-4, 1e-3}) {
        for (Eigen::Index along = 0; along < 3; ++along) {
          Pose pose = Pose::Identity();
          pose.rotate(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)));
          pose.pretranslate(Eigen::Vector3d(2 * half[along] * Eigen::Vector3d::Unit(along)));
          poses.push_back(pose);
        }
      }
    }
    pairs += check_poses(run, box, box, poses);
  }
  run.premise(pairs > 1000, "hardly any pair of faces touches");
}

// Poses that are exact on lattice coordinates: the same pairs as with transformed vertices.
void affine_poses(Run& run) {
  const SourceMesh first = snapped(times(test::torus(14, 10), 4), -4);
  const SourceMesh second = snapped(times(test::sphere(8, 10), 2), -4);
  std::vector<Eigen::Matrix3d> maps;
  for (const double scale : {0x1p-10, 0.25, 1.0, 2.0, 0x1p10}) {
    maps.push_back(scale * Eigen::Matrix3d::Identity());
  }
  maps.emplace_back(Eigen::Vector3d(-1, 1, 1).asDiagonal());
  maps.emplace_back(Eigen::Vector3d(1, 0x1p-10, 1).asDiagonal());
  maps.emplace_back(Eigen::Vector3d(-2, 0.5, -1).asDiagonal());
  Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
  shear(0, 1) = 0.5;
  maps.push_back(shear);
  shear(2, 0) = -0.25;
  maps.push_back(shear * Eigen::Vector3d(1, -1, 2).asDiagonal());
  std::size_t pairs = 0;
  for (const Store& store : kStores) {
    for (const CodecInfo& codec : kCodecs) {
      const Subject a = make_subject(first, codec.id, store);
      const Subject b = make_subject(second, codec.id, store);
      for (std::size_t i = 0; i < maps.size(); ++i) {
        Pose pose = Pose::Identity();
        pose.linear() = maps[i];
        pose.translation() = Eigen::Vector3d(4, 0.5, 0.25);
        SourceMesh baked = second;
        for (std::size_t v = 0; v < baked.positions.size(); ++v) {
          const Eigen::Vector3d p = pose * second.positions[v];
          for (Eigen::Index k = 0; k < 3; ++k) {
            baked.positions.f32[3 * v + static_cast<std::size_t>(k)] = static_cast<float>(p[k]);
          }
        }
        const Subject c = make_subject(baked, codec.id, store);
        const FacePairs expected =
            found_pairs(a.tree(), Pose::Identity(), c.tree(), Pose::Identity());
        pairs += expected.size();
        run.check(found_pairs(a.tree(), Pose::Identity(), b.tree(), pose) == expected,
                  [&] { return a.name + ": map " + std::to_string(i); });
      }
    }
  }
  run.premise(pairs > 1000, "hardly any pair of faces touches");
  // Scales that are rounded: compared with brute force.
  std::vector<Pose> poses;
  Random random(22);
  for (const double scale : {1e-3, 0.1, 10.0, 1e3}) {
    Pose pose = Pose::Identity();
    pose.linear() = scale * random.rotation() * Eigen::Vector3d(1, -1, 1e-3).asDiagonal();
    pose.translation() = Eigen::Vector3d(4, 0.5, 0.25);
    poses.push_back(pose);
  }
  run.premise(check_poses(run, first, second, poses) > 100, "hardly any pair of faces touches");
}

void drifted_rotations(Run& run) {
  const SourceMesh first = test::city(20, 2), second = test::torus(16, 12);
  Random random(23);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < run.count(30, 500); ++i) {
    Pose pose = Pose::Identity();
    pose.linear() = random.rotation();
    if (i % 3 == 0) pose.linear() *= i % 2 == 0 ? 1 + 1e-3 : 1 - 1e-3;
    if (i % 3 == 1) {
      for (Eigen::Index k = 0; k < 3; ++k) pose.linear().col(k) += 2e-4 * random.vector();
    }
    pose.translation() = Eigen::Vector3d(3, 1, 1) + 4 * random.vector();
    poses.push_back(pose);
  }
  run.premise(check_poses(run, first, second, poses) > 1000, "hardly any pair of faces touches");
}

}  // namespace

std::vector<Case> pose_cases() {
  return {
      {"R04", "FarAway", "both bodies at 1e6, turned: where contact begins, of a gap of 1",
       "error of the gap", 1e-6, far_away},
      {"R17", "NearParallelAxes", "boxes of extents 1e-3 to 1e6 turned by 1e-9 to 1e-3",
       "wrong pair sets", 0, near_parallel},
      {"R22", "AffinePoses", "scale, mirror, shear against meshes transformed beforehand",
       "wrong pair sets", 0, affine_poses},
      {"R23", "DriftedRotations", "rotations off by 1e-3 in scale or 1e-4 in each entry",
       "wrong pair sets", 0, drifted_rotations},
      {"E08", "HugeTranslations", "poses at 1e9 and 2^49, meshes baked at 2^17", "wrong pair sets",
       0, huge_translations},
  };
}

}  // namespace boxtree::robustness
