// SPDX-License-Identifier: MIT
// FCL's hierarchies in double: oriented boxes, axis-aligned boxes, 18-DOPs.
#include <cmath>
#include <fcl/fcl.h>
#include <limits>
#include <set>
#include <type_traits>

#include "tests/bench/subject.h"

namespace boxtree::bench {
namespace {

template <class Volume>
class FclSubject : public Subject {
 public:
  explicit FclSubject(const TriangleMesh& mesh) : mesh_(mesh) {
    std::vector<Eigen::Vector3d> points;
    for (const Eigen::Vector3f& p : mesh.positions) points.emplace_back(p.cast<double>());
    std::vector<fcl::Triangle> triangles;
    for (const auto& t : mesh.triangles) triangles.emplace_back(t[0], t[1], t[2]);
    model_->beginModel();
    model_->addSubModel(points, triangles);
    model_->endModel();
  }

  [[nodiscard]] SubjectBytes bytes() const override {
    const double tree = static_cast<double>(model_->getNumBVs()) * sizeof(fcl::BVNode<Volume>) +
                        static_cast<double>(mesh_.triangles.size() * sizeof(unsigned));
    return {tree, tree + static_cast<double>(mesh_.triangles.size() * sizeof(fcl::Triangle) +
                                             mesh_.positions.size() * sizeof(Eigen::Vector3d))};
  }
  bool boxes(std::span<const Eigen::AlignedBox3d> boxes, std::span<double> out) override {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      const Eigen::Vector3d sizes = boxes[i].sizes();
      const auto box = std::make_shared<fcl::Boxd>(sizes.x(), sizes.y(), sizes.z());
      const fcl::CollisionObjectd here(model_);
      const fcl::CollisionObjectd there(box, Eigen::Matrix3d::Identity(), boxes[i].center());
      fcl::CollisionResultd result;
      fcl::collide(&here, &there, fcl::CollisionRequestd(kAll, false), result);
      std::set<long> faces;
      for (std::size_t c = 0; c < result.numContacts(); ++c) faces.insert(result.getContact(c).b1);
      out[i] = static_cast<double>(faces.size());
    }
    return true;
  }
  // The other volumes do not rotate with a pose: FCL would rebuild the copy for each query.
  bool distances(std::span<const DistanceRequest> queries, std::span<double> out) override {
    if constexpr (!std::is_same_v<Volume, fcl::OBBRSSd>) return false;
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const fcl::DistanceRequestd request(true, false, queries[i].relative_error, 0);
      fcl::DistanceResultd result;
      out[i] = fcl::distance(model_.get(), fcl::Transform3d::Identity(), model_.get(),
                             transform_of(queries[i].pose), request, result);
    }
    return true;
  }
  bool first_contacts(std::span<const Pose> poses, std::span<double> out) override {
    return collide_with_copy(poses, out, 1);
  }
  bool all_pairs(std::span<const Pose> poses, std::span<double> out) override {
    return collide_with_copy(poses, out, kAll);
  }

 protected:
  static constexpr std::size_t kAll = 100'000'000;

  static fcl::Transform3d transform_of(const Pose& pose) {
    fcl::Transform3d transform = fcl::Transform3d::Identity();
    transform.linear() = pose.linear();
    transform.translation() = pose.translation();
    return transform;
  }

  bool collide_with_copy(std::span<const Pose> poses, std::span<double> out, std::size_t most) {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      fcl::CollisionResultd result;
      out[i] = static_cast<double>(fcl::collide(model_.get(), fcl::Transform3d::Identity(),
                                                model_.get(), transform_of(poses[i]),
                                                fcl::CollisionRequestd(most, false), result));
    }
    return true;
  }

  const TriangleMesh& mesh_;
  std::shared_ptr<fcl::BVHModel<Volume>> model_ = std::make_shared<fcl::BVHModel<Volume>>();
};

template <class Volume>
void add(std::vector<Library>& libraries, const char* variant) {
  libraries.push_back({"fcl", variant, [](const TriangleMesh& mesh) {
                         return std::make_unique<FclSubject<Volume>>(mesh);
                       }});
}

}  // namespace

void add_fcl(std::vector<Library>& libraries) {
  add<fcl::OBBRSSd>(libraries, "obbrss");
  add<fcl::AABBd>(libraries, "aabb");
  add<fcl::KDOPd<18>>(libraries, "kdop18");
}

}  // namespace boxtree::bench
