// SPDX-License-Identifier: MIT
// Embree 3 or 4, single-threaded, default and compact scenes.
#include <algorithm>
#include <cmath>
#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif
#include <limits>

#include "runtime/primitive/predicates.h"
#include "tests/bench/subject.h"

namespace boxtree::bench {
namespace {

#if RTC_VERSION_MAJOR >= 4
void intersect(RTCScene scene, RTCRayHit& query) {
  rtcIntersect1(scene, &query);
}
void intersect(const int* valid, RTCScene scene, RTCRayHit8& query) {
  rtcIntersect8(valid, scene, &query);
}
#else
void intersect(RTCScene scene, RTCRayHit& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect1(scene, &context, &query);
}
void intersect(const int* valid, RTCScene scene, RTCRayHit8& query) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  rtcIntersect8(valid, scene, &context, &query);
}
#endif

class EmbreeSubject : public Subject {
 public:
  EmbreeSubject(const TriangleMesh& mesh, RTCSceneFlags flags) : mesh_(mesh) {
    device_ = rtcNewDevice("threads=1,set_affinity=0");
    rtcSetDeviceMemoryMonitorFunction(
        device_,
        [](void* bytes, ssize_t change, bool) {
          *static_cast<ssize_t*>(bytes) += change;
          return true;
        },
        &bytes_);
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_, flags);
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    // Embree reads 16 bytes at the last vertex.
    padded_ = mesh.positions;
    padded_.emplace_back(0, 0, 0);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                               padded_.data(), 0, sizeof(Eigen::Vector3f), mesh.positions.size());
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                               mesh.triangles.data(), 0, 3 * sizeof(std::uint32_t),
                               mesh.triangles.size());
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_);
  }
  ~EmbreeSubject() override {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }

  [[nodiscard]] SubjectBytes bytes() const override {
    const auto tree = static_cast<double>(bytes_);
    return {tree,
            tree + static_cast<double>(mesh_.positions.size() * 12 + mesh_.triangles.size() * 12)};
  }
  bool rays(std::span<const Ray> rays, std::span<double> out) override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      RTCRayHit query{};
      const Eigen::Vector3f origin = rays[i].origin.cast<float>();
      const Eigen::Vector3f direction = rays[i].direction.cast<float>();
      query.ray.org_x = origin.x();
      query.ray.org_y = origin.y();
      query.ray.org_z = origin.z();
      query.ray.dir_x = direction.x();
      query.ray.dir_y = direction.y();
      query.ray.dir_z = direction.z();
      query.ray.tfar = static_cast<float>(rays[i].t_max);
      query.ray.mask = ~0u;
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      intersect(scene_, query);
      out[i] = query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<double>::infinity()
                                                           : double{query.ray.tfar};
    }
    return true;
  }
  [[nodiscard]] bool ends_rays() const override { return true; }
  // Packets of eight.
  bool ray_batches(std::span<const Ray> rays, std::span<double> out) override {
    constexpr std::size_t kWidth = 8;
    for (std::size_t first = 0; first < rays.size(); first += kWidth) {
      const std::size_t count = std::min(kWidth, rays.size() - first);
      RTCRayHit8 query{};
      alignas(32) int valid[kWidth] = {};
      for (std::size_t i = 0; i < count; ++i) {
        const Eigen::Vector3f origin = rays[first + i].origin.cast<float>();
        const Eigen::Vector3f direction = rays[first + i].direction.cast<float>();
        valid[i] = -1;
        query.ray.org_x[i] = origin.x();
        query.ray.org_y[i] = origin.y();
        query.ray.org_z[i] = origin.z();
        query.ray.dir_x[i] = direction.x();
        query.ray.dir_y[i] = direction.y();
        query.ray.dir_z[i] = direction.z();
        query.ray.tfar[i] = static_cast<float>(rays[first + i].t_max);
        query.ray.mask[i] = ~0u;
        query.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
      }
      intersect(valid, scene_, query);
      for (std::size_t i = 0; i < count; ++i) {
        out[first + i] = query.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID
                             ? std::numeric_limits<double>::infinity()
                             : double{query.ray.tfar[i]};
      }
    }
    return true;
  }
  // Embree has no box query: uses its point query with the box's circumscribed sphere, and our
  // test.
  bool boxes(std::span<const Eigen::AlignedBox3d> boxes, std::span<double> out) override {
    struct Request {
      const TriangleMesh* mesh;
      const Eigen::AlignedBox3d* box;
      double count;
    };
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      Request request{&mesh_, &boxes[i], 0};
      run_query(boxes[i].center(), boxes[i].diagonal().norm() / 2, &request,
                [](RTCPointQueryFunctionArguments* arguments) {
                  auto& r = *static_cast<Request*>(arguments->userPtr);
                  const Triangle triangle = r.mesh->triangle(arguments->primID);
                  r.count += triangle_intersects_box(triangle, r.box->min(), r.box->max()) ? 1 : 0;
                  return false;
                });
      out[i] = request.count;
    }
    return true;
  }
  bool points(std::span<const Eigen::Vector3d> points, std::span<double> out) override {
    struct Request {
      const TriangleMesh* mesh;
      const Eigen::Vector3d* point;
      double best;
    };
    for (std::size_t i = 0; i < points.size(); ++i) {
      Request request{&mesh_, &points[i], std::numeric_limits<double>::infinity()};
      run_query(points[i], std::numeric_limits<float>::infinity(), &request,
                [](RTCPointQueryFunctionArguments* arguments) {
                  auto& r = *static_cast<Request*>(arguments->userPtr);
                  const Eigen::Vector3d closest =
                      closest_point_on_triangle(*r.point, r.mesh->triangle(arguments->primID));
                  const double distance = (closest - *r.point).norm();
                  if (distance >= r.best) return false;
                  r.best = distance;
                  arguments->query->radius = static_cast<float>(distance);
                  return true;
                });
      out[i] = request.best;
    }
    return true;
  }

 private:
  void run_query(const Eigen::Vector3d& centre, double radius, void* request,
                 RTCPointQueryFunction function) {
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    RTCPointQuery query{};
    query.x = static_cast<float>(centre.x());
    query.y = static_cast<float>(centre.y());
    query.z = static_cast<float>(centre.z());
    query.radius =
        std::nextafter(static_cast<float>(radius), std::numeric_limits<float>::infinity());
    rtcPointQuery(scene_, &query, &context, function, request);
  }

  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3f> padded_;
  ssize_t bytes_ = 0;
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace

void add_embree(std::vector<Library>& libraries) {
  for (const auto& [name, flags] :
       {std::pair("default", RTC_SCENE_FLAG_NONE), std::pair("compact", RTC_SCENE_FLAG_COMPACT),
        std::pair("robust", RTC_SCENE_FLAG_ROBUST)}) {
    libraries.push_back({"embree", name, [scene = flags](const TriangleMesh& mesh) {
                           return std::make_unique<EmbreeSubject>(mesh, scene);
                         }});
  }
}

}  // namespace boxtree::bench
