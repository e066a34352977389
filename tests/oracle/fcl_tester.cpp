// SPDX-License-Identifier: MIT
// FCL: collide() of two models of one triangle each, and of one and a shape, in double.
#include <fcl/fcl.h>
#include <memory>

#include "tests/oracle/pair_tester.h"
#include "tests/oracle/shape_tester.h"

namespace boxtree::test {
namespace {

using Model = fcl::BVHModel<fcl::OBBRSSd>;

std::shared_ptr<Model> model_of(const Triangle& triangle) {
  auto model = std::make_shared<Model>();
  model->beginModel(1, 3);
  model->addTriangle(triangle.corner[0], triangle.corner[1], triangle.corner[2]);
  model->endModel();
  return model;
}

bool intersect(const Triangle& p, const Triangle& q) {
  const auto first = model_of(p), second = model_of(q);
  fcl::CollisionResultd result;
  const fcl::Transform3d here = fcl::Transform3d::Identity();
  return fcl::collide(first.get(), here, second.get(), here, fcl::CollisionRequestd(1, false),
                      result) > 0;
}

// Capsules of FCL lie along z.
fcl::Transform3d turned_to(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  pose.translation() = (from + to) / 2;
  pose.linear() = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), to - from).matrix();
  return pose;
}

// Six sides of corners whose number has a bit for each axis.
std::shared_ptr<fcl::Convexd> convex_of(const std::vector<Eigen::Vector3d>& corners) {
  auto sides = std::make_shared<std::vector<int>>(std::vector<int>{
      4, 0, 4, 6, 2, 4, 1, 3, 7, 5, 4, 0, 1, 5, 4, 4, 2, 6, 7, 3, 4, 0, 2, 3, 1, 4, 4, 5, 7, 6});
  return std::make_shared<fcl::Convexd>(
      std::make_shared<const std::vector<Eigen::Vector3d>>(corners), 6, sides);
}

bool touches(const Triangle& triangle, const TestedShape& shape) {
  const auto model = model_of(triangle);
  const std::vector<Eigen::Vector3d>& p = shape.points;
  fcl::Transform3d pose = fcl::Transform3d::Identity();
  std::shared_ptr<fcl::CollisionGeometryd> other;
  if (shape.kind == 0) {
    other = std::make_shared<fcl::Sphered>(shape.radius);
    pose.translation() = p[0];
  } else if (shape.kind == 1) {
    other = std::make_shared<fcl::Capsuled>(shape.radius, (p[1] - p[0]).norm());
    pose = turned_to(p[0], p[1]);
  } else if (shape.kind == 2) {
    other = std::make_shared<fcl::Boxd>(Eigen::Vector3d(p[7] - p[0]));
    pose.translation() = (p[0] + p[7]) / 2;
  } else {
    other = convex_of(p);
  }
  fcl::CollisionResultd result;
  return fcl::collide(model.get(), fcl::Transform3d::Identity(), other.get(), pose,
                      fcl::CollisionRequestd(1, false), result) > 0;
}

}  // namespace

void add_fcl_testers(std::vector<ShapeTester>& testers) {
  testers.push_back({"fcl", "collide", touches});
}

void add_fcl_testers(std::vector<PairTester>& testers) {
  testers.push_back({"fcl", "collide", intersect});
}

}  // namespace boxtree::test
