#include "embree_tracer.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <thread>

#include <embree3/rtcore.h>

namespace isophote::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr size_t kRaysPerChunk = 1024;

double secondsSince(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

RTCIntersectContext context() {
  RTCIntersectContext result;
  rtcInitIntersectContext(&result);
  return result; // as it comes: incoherent
}

void traceSingly(RTCScene scene, std::span<const Ray> rays, bool occluded, EmbreeHit* hits) {
  RTCIntersectContext c = context();
  for (size_t i = 0; i < rays.size(); ++i) {
    const Ray& ray = rays[i];
    RTCRayHit query{};
    query.ray = {.org_x = ray.origin.x,
                 .org_y = ray.origin.y,
                 .org_z = ray.origin.z,
                 .tnear = ray.tMin,
                 .dir_x = ray.direction.x,
                 .dir_y = ray.direction.y,
                 .dir_z = ray.direction.z,
                 .time = 0,
                 .tfar = ray.tMax,
                 .mask = ~0u,
                 .id = 0,
                 .flags = 0};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    if (occluded) {
      rtcOccluded1(scene, &c, &query.ray);
      hits[i] = {query.ray.tfar, query.ray.tfar < 0 ? 0 : kNothingMet};
    } else {
      rtcIntersect1(scene, &c, &query);
      hits[i] = {query.ray.tfar, query.hit.geomID == RTC_INVALID_GEOMETRY_ID ? kNothingMet : query.hit.primID};
    }
  }
}

void tracePackets(RTCScene scene, std::span<const Ray> rays, bool occluded, EmbreeHit* hits) {
  RTCIntersectContext c = context();
  for (size_t first = 0; first < rays.size(); first += 8) {
    const size_t count = std::min<size_t>(8, rays.size() - first);
    alignas(32) int valid[8] = {};
    alignas(32) RTCRayHit8 query{};
    for (size_t k = 0; k < count; ++k) {
      const Ray& ray = rays[first + k];
      valid[k] = -1;
      query.ray.org_x[k] = ray.origin.x;
      query.ray.org_y[k] = ray.origin.y;
      query.ray.org_z[k] = ray.origin.z;
      query.ray.dir_x[k] = ray.direction.x;
      query.ray.dir_y[k] = ray.direction.y;
      query.ray.dir_z[k] = ray.direction.z;
      query.ray.tnear[k] = ray.tMin;
      query.ray.tfar[k] = ray.tMax;
      query.ray.mask[k] = ~0u;
      query.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
    }
    if (occluded) {
      rtcOccluded8(valid, scene, &c, &query.ray);
    } else {
      rtcIntersect8(valid, scene, &c, &query);
    }
    for (size_t k = 0; k < count; ++k) {
      const bool met = occluded ? query.ray.tfar[k] < 0 : query.hit.geomID[k] != RTC_INVALID_GEOMETRY_ID;
      hits[first + k] = {query.ray.tfar[k], !met ? kNothingMet : occluded ? 0u : query.hit.primID[k]};
    }
  }
}

} // namespace

struct EmbreeTracer::Impl {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  double buildSeconds = 0;
  ~Impl() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }
};

EmbreeTracer::EmbreeTracer(std::span<const glm::vec3> corners) : impl_(std::make_unique<Impl>()) {
  impl_->device = rtcNewDevice(nullptr);
  if (impl_->device == nullptr) throw std::runtime_error("Embree gives no device");
  impl_->scene = rtcNewScene(impl_->device);
  rtcSetSceneBuildQuality(impl_->scene, RTC_BUILD_QUALITY_HIGH);
  RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_HIGH);
  void* vertices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3),
                                           corners.size());
  std::memcpy(vertices, corners.data(), corners.size_bytes());
  auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                 3 * sizeof(uint32_t), corners.size() / 3));
  for (uint32_t i = 0; i < corners.size(); ++i) indices[i] = i;
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(impl_->scene, geometry);
  rtcReleaseGeometry(geometry);
  const auto start = Clock::now();
  rtcCommitScene(impl_->scene);
  impl_->buildSeconds = secondsSince(start);
}

EmbreeTracer::~EmbreeTracer() = default;

double EmbreeTracer::buildSeconds() const { return impl_->buildSeconds; }

void EmbreeTracer::trace(const RayList& list, bool packets, std::vector<EmbreeHit>& hits) const {
  hits.resize(list.rays.size());
  const bool occluded = list.question == RayQuestion::Occluded;
  std::atomic<size_t> next = 0;
  const auto work = [&] {
    for (size_t first; (first = next.fetch_add(kRaysPerChunk)) < list.rays.size();) {
      const size_t count = std::min(kRaysPerChunk, list.rays.size() - first);
      const std::span rays(&list.rays[first], count);
      if (packets) {
        tracePackets(impl_->scene, rays, occluded, &hits[first]);
      } else {
        traceSingly(impl_->scene, rays, occluded, &hits[first]);
      }
    }
  };
  std::vector<std::thread> threads;
  for (uint32_t i = 1; i < std::max(1u, std::thread::hardware_concurrency()); ++i) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
}

} // namespace isophote::bench
