// SPDX-License-Identifier: MIT
// ODE: OPCODE trees behind its trimesh geometry.
#include <limits>
#include <ode/ode.h>

#include "runtime/primitive/predicates.h"
#include "tests/bench/subject.h"

namespace boxtree::bench {
namespace {

// Initialises ODE once per process.
struct OdeSession {
  OdeSession() { dInitODE2(0); }
  ~OdeSession() { dCloseODE(); }
};

struct BoxRequest {
  const TriangleMesh* mesh = nullptr;
  const Eigen::AlignedBox3d* box = nullptr;
  double count = 0;
};
// ODE's array callback has no user pointer apart from the geometry's own data.
void count_triangles(dGeomID trimesh, dGeomID, const int* triangles, int count) {
  auto& request = *static_cast<BoxRequest*>(dGeomGetData(trimesh));
  for (int i = 0; i < count; ++i) {
    const Triangle triangle = request.mesh->triangle(static_cast<std::size_t>(triangles[i]));
    request.count +=
        triangle_intersects_box(triangle, request.box->min(), request.box->max()) ? 1 : 0;
  }
}

class OdeSubject : public Subject {
 public:
  explicit OdeSubject(const TriangleMesh& mesh) : mesh_(mesh) {
    static const OdeSession session;
    for (const auto& t : mesh.triangles) indices_.insert(indices_.end(), t.begin(), t.end());
    data_ = dGeomTriMeshDataCreate();
    dGeomTriMeshDataBuildSingle(data_, mesh.positions.data(), sizeof(Eigen::Vector3f),
                                static_cast<int>(mesh.positions.size()), indices_.data(),
                                static_cast<int>(indices_.size()), 3 * sizeof(dTriIndex));
    here_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
    there_ = dCreateTriMesh(nullptr, data_, nullptr, nullptr, nullptr);
  }
  ~OdeSubject() override {
    dGeomDestroy(here_);
    dGeomDestroy(there_);
    dGeomTriMeshDataDestroy(data_);
  }

  // OPCODE's default "no leaf" tree: a node of 40 bytes per triangle.
  [[nodiscard]] SubjectBytes bytes() const override {
    constexpr double kNodeBytes = 40;
    const double tree = kNodeBytes * static_cast<double>(mesh_.triangles.size());
    return {tree, tree + static_cast<double>(indices_.size() * sizeof(dTriIndex) +
                                             mesh_.positions.size() * sizeof(Eigen::Vector3f))};
  }
  bool rays(std::span<const Ray> rays, std::span<double> out) override {
    const dReal length = 4 * mesh_.bounds.diagonal().norm();
    const dGeomID ray = dCreateRay(nullptr, length);
    dGeomRaySetClosestHit(ray, 1);
    dGeomRaySetBackfaceCull(ray, 0);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Eigen::Vector3d& o = rays[i].origin;
      const Eigen::Vector3d& d = rays[i].direction;
      dGeomRaySet(ray, o.x(), o.y(), o.z(), d.x(), d.y(), d.z());
      dContactGeom contact;
      out[i] = dCollide(here_, ray, 1, &contact, sizeof(contact)) > 0
                   ? double{contact.depth} / d.norm()
                   : std::numeric_limits<double>::infinity();
    }
    dGeomDestroy(ray);
    return true;
  }
  bool boxes(std::span<const Eigen::AlignedBox3d> boxes, std::span<double> out) override {
    dGeomTriMeshSetArrayCallback(here_, count_triangles);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      BoxRequest request{&mesh_, &boxes[i]};
      dGeomSetData(here_, &request);
      const Eigen::Vector3d sizes = boxes[i].sizes();
      const Eigen::Vector3d centre = boxes[i].center();
      const dGeomID box = dCreateBox(nullptr, sizes.x(), sizes.y(), sizes.z());
      dGeomSetPosition(box, centre.x(), centre.y(), centre.z());
      dContactGeom contact;
      dCollide(here_, box, 1, &contact, sizeof(contact));
      dGeomDestroy(box);
      out[i] = request.count;
    }
    dGeomTriMeshSetArrayCallback(here_, nullptr);
    return true;
  }
  bool first_contacts(std::span<const Pose> poses, std::span<double> out) override {
    for (std::size_t i = 0; i < poses.size(); ++i) {
      const Pose& pose = poses[i];
      dMatrix3 rotation{};
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) rotation[4 * r + c] = pose.linear()(r, c);
      }
      dGeomSetRotation(there_, rotation);
      dGeomSetPosition(there_, pose.translation().x(), pose.translation().y(),
                       pose.translation().z());
      dContactGeom contact;
      out[i] = dCollide(here_, there_, 1, &contact, sizeof(contact)) > 0 ? 1 : 0;
    }
    return true;
  }

 private:
  const TriangleMesh& mesh_;
  std::vector<dTriIndex> indices_;
  dTriMeshDataID data_ = nullptr;
  dGeomID here_ = nullptr;
  dGeomID there_ = nullptr;
};

}  // namespace

void add_ode(std::vector<Library>& libraries) {
  libraries.push_back({"ode", "opcode", [](const TriangleMesh& mesh) {
                         return std::make_unique<OdeSubject>(mesh);
                       }});
}

}  // namespace boxtree::bench
