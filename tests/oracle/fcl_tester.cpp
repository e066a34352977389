// SPDX-License-Identifier: MIT
// FCL: collide() of two models of one triangle each, in double.
#include <fcl/fcl.h>
#include <memory>

#include "tests/oracle/pair_tester.h"

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

}  // namespace

void add_fcl_testers(std::vector<PairTester>& testers) {
  testers.push_back({"fcl", "collide", intersect});
}

}  // namespace boxtree::test
