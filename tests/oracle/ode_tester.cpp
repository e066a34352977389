// SPDX-License-Identifier: MIT
// ODE: contacts of two trimeshes. Its trees crash with one triangle, so that each has a second one,
// far from everything.
#include <array>
#include <ode/ode.h>

#include "tests/oracle/pair_tester.h"

namespace boxtree::test {
namespace {

// ODE starts and ends once.
struct OdeSession {
  OdeSession() { dInitODE2(0); }
  ~OdeSession() { dCloseODE(); }
};

// A triangle as a trimesh, and another one at `away` on all axes; ODE refers to its arrays.
class TriangleMesh {
 public:
  TriangleMesh(const Triangle& triangle, float away) {
    for (std::size_t i = 0; i < 9; ++i) {
      positions_[i] = static_cast<float>(triangle.corner[i / 3][static_cast<Eigen::Index>(i % 3)]);
    }
    positions_[9] = positions_[10] = positions_[11] = away;
    positions_[12] = positions_[13] = positions_[17] = away;
    positions_[14] = positions_[15] = positions_[16] = away * 1.5F;
    data_ = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data_, positions_.data(), 3 * sizeof(float), 6, indices_.data(), 6,
                                3 * sizeof(dTriIndex));
    mesh_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
  }
  ~TriangleMesh() {
    dGeomDestroy(mesh_);
    dGeomTriMeshDataDestroy(data_);
  }
  TriangleMesh(const TriangleMesh&) = delete;
  TriangleMesh& operator=(const TriangleMesh&) = delete;

  [[nodiscard]] dGeomID mesh() const { return mesh_; }

 private:
  std::array<float, 18> positions_;
  std::array<dTriIndex, 6> indices_ = {0, 1, 2, 3, 4, 5};
  dTriMeshDataID data_ = nullptr;
  dGeomID mesh_ = nullptr;
};

bool intersect(const Triangle& p, const Triangle& q) {
  static const OdeSession session;
  constexpr float kFar = 1000;
  const TriangleMesh a(p, kFar), b(q, -kFar);
  dContactGeom contact;
  return dCollide(a.mesh(), b.mesh(), 1, &contact, sizeof(contact)) > 0;
}

}  // namespace

void add_ode_testers(std::vector<PairTester>& testers) {
  testers.push_back({"ode", "opcode", intersect});
}

}  // namespace boxtree::test
