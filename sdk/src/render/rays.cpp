#include "rays.h"

#if ETENDUE_EMBREE_MAJOR >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include <cmath>
#include <cstring>
#include <string>

namespace etendue::rendering {
namespace {

#if ETENDUE_EMBREE_MAJOR >= 4
using EmbreeContext = RTCRayQueryContext;
void initialise(EmbreeContext& context) { rtcInitRayQueryContext(&context); }
void intersect_one(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) {
  RTCIntersectArguments arguments;
  rtcInitIntersectArguments(&arguments);
  arguments.context = &context;
  rtcIntersect1(scene, &ray, &arguments);
}
void occluded_one(RTCScene scene, EmbreeContext& context, RTCRay& ray) {
  RTCOccludedArguments arguments;
  rtcInitOccludedArguments(&arguments);
  arguments.context = &context;
  rtcOccluded1(scene, &ray, &arguments);
}
#else
using EmbreeContext = RTCIntersectContext;
void initialise(EmbreeContext& context) { rtcInitIntersectContext(&context); }
void intersect_one(RTCScene scene, EmbreeContext& context, RTCRayHit& ray) { rtcIntersect1(scene, &context, &ray); }
void occluded_one(RTCScene scene, EmbreeContext& context, RTCRay& ray) { rtcOccluded1(scene, &context, &ray); }
#endif

// Embree hands its context to the callbacks of analytic shapes: ours carries the ray in double there and the distance back.
struct Query {
  EmbreeContext embree;  // first: the callbacks get a pointer to it
  const Ray* ray;
  double t_min, t_max;
  std::uint32_t skip;
  double t_analytic;
};

// Geometry numbers are the order of adding, so the thing's number and Embree's are the same.
void bounds_of_shape(const RTCBoundsFunctionArguments* arguments) {
  const Box box = box_of(*static_cast<const Shape*>(arguments->geometryUserPtr));
  const auto pad = [](double a, double b) { return 1e-5 * (std::abs(a) + std::abs(b)) + 1e-12; };
  RTCBounds& out = *arguments->bounds_o;
  out.lower_x = static_cast<float>(box.min.x - pad(box.min.x, box.max.x));
  out.lower_y = static_cast<float>(box.min.y - pad(box.min.y, box.max.y));
  out.lower_z = static_cast<float>(box.min.z - pad(box.min.z, box.max.z));
  out.upper_x = static_cast<float>(box.max.x + pad(box.min.x, box.max.x));
  out.upper_y = static_cast<float>(box.max.y + pad(box.min.y, box.max.y));
  out.upper_z = static_cast<float>(box.max.z + pad(box.min.z, box.max.z));
}

void intersect_shape(const RTCIntersectFunctionNArguments* arguments) {
  auto* query = reinterpret_cast<Query*>(arguments->context);
  if (arguments->valid[0] == 0 || arguments->geomID == query->skip) return;
  auto* ray_hit = reinterpret_cast<RTCRayHit*>(arguments->rayhit);
  const auto& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
  const auto t = intersect(shape, *query->ray, query->t_min, query->t_max);
  if (!t || *t >= static_cast<double>(ray_hit->ray.tfar)) return;
  query->t_analytic = *t;
  ray_hit->ray.tfar = static_cast<float>(*t);
  ray_hit->hit.geomID = arguments->geomID;
  ray_hit->hit.primID = 0;
}

void occlude_shape(const RTCOccludedFunctionNArguments* arguments) {
  auto* query = reinterpret_cast<Query*>(arguments->context);
  if (arguments->valid[0] == 0 || arguments->geomID == query->skip) return;
  const auto& shape = *static_cast<const Shape*>(arguments->geometryUserPtr);
  if (intersect(shape, *query->ray, query->t_min, query->t_max)) {
    reinterpret_cast<RTCRay*>(arguments->ray)->tfar = -std::numeric_limits<float>::infinity();
  }
}

RTCRay single_precision(const Ray& ray, double t_min, double t_max) {
  RTCRay out{};
  out.org_x = static_cast<float>(ray.origin.x);
  out.org_y = static_cast<float>(ray.origin.y);
  out.org_z = static_cast<float>(ray.origin.z);
  out.dir_x = static_cast<float>(ray.direction.x);
  out.dir_y = static_cast<float>(ray.direction.y);
  out.dir_z = static_cast<float>(ray.direction.z);
  out.tnear = static_cast<float>(t_min);
  out.tfar = static_cast<float>(t_max);
  out.mask = ~0u;
  return out;
}

// Moeller and Trumbore 1997, in double, against the triangle that Embree found; a little outside is as good as on the edge.
void refine(const Ray& ray, const Triangles& triangles, Hit& hit) {
  const auto& corner = triangles.corners[hit.triangle];
  const Vec3d a = triangles.positions[corner[0]];
  const Vec3d e1 = triangles.positions[corner[1]] - a, e2 = triangles.positions[corner[2]] - a;
  const Vec3d p = cross(ray.direction, e2);
  const double determinant = dot(e1, p);
  if (determinant == 0) return;
  const Vec3d s = ray.origin - a;
  const Vec3d q = cross(s, e1);
  const double t = dot(e2, q) / determinant;
  if (!std::isfinite(t)) return;
  hit.u = dot(s, p) / determinant;
  hit.v = dot(ray.direction, q) / determinant;
  hit.t = t;
}

}  // namespace

struct Rays::Embree {
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;
  std::vector<const Triangles*> triangles;  // by thing; null for analytic shapes
};

Rays::Rays() : embree_(std::make_unique<Embree>()) {
  embree_->device = rtcNewDevice(nullptr);
  if (embree_->device == nullptr) return;
  embree_->scene = rtcNewScene(embree_->device);
  rtcSetSceneFlags(embree_->scene, RTC_SCENE_FLAG_ROBUST);
}

Rays::~Rays() {
  if (embree_->scene != nullptr) rtcReleaseScene(embree_->scene);
  if (embree_->device != nullptr) rtcReleaseDevice(embree_->device);
}

std::uint32_t Rays::add(const Triangles& triangles) {
  const auto thing = static_cast<std::uint32_t>(embree_->triangles.size());
  embree_->triangles.push_back(&triangles);
  if (embree_->device == nullptr) return thing;
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), triangles.positions.size()));
  auto* indices = static_cast<std::uint32_t*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.corners.size()));
  if (vertices != nullptr && indices != nullptr) {
    for (const Vec3d& p : triangles.positions) {
      for (int i = 0; i < 3; ++i) *vertices++ = static_cast<float>(p[i]);
    }
    for (const auto& corner : triangles.corners) {
      for (const std::uint32_t i : corner) *indices++ = i;
    }
  }
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(embree_->scene, geometry, thing);
  rtcReleaseGeometry(geometry);
  return thing;
}

std::uint32_t Rays::add(const Shape& shape) {
  const auto thing = static_cast<std::uint32_t>(embree_->triangles.size());
  embree_->triangles.push_back(nullptr);
  if (embree_->device == nullptr) return thing;
  RTCGeometry geometry = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry, 1);
  rtcSetGeometryUserData(geometry, const_cast<Shape*>(&shape));
  rtcSetGeometryBoundsFunction(geometry, bounds_of_shape, nullptr);
  rtcSetGeometryIntersectFunction(geometry, intersect_shape);
  rtcSetGeometryOccludedFunction(geometry, occlude_shape);
  rtcCommitGeometry(geometry);
  rtcAttachGeometryByID(embree_->scene, geometry, thing);
  rtcReleaseGeometry(geometry);
  return thing;
}

Status Rays::commit() {
  if (embree_->device != nullptr) rtcCommitScene(embree_->scene);
  const RTCError error = rtcGetDeviceError(embree_->device);
  if (embree_->device != nullptr && error == RTC_ERROR_NONE) return Done{};
  return Error{error == RTC_ERROR_OUT_OF_MEMORY ? "OUT_OF_MEMORY" : "EVALUATION_UNSUPPORTED",
               "Embree could not take the scene, its error is number " + std::to_string(static_cast<int>(error)),
               {},
               {},
               {}};
}

Hit Rays::closest(const Ray& ray, double t_min, double t_max, std::uint32_t skip) const {
  Query query{{}, &ray, t_min, t_max, skip, infinite};
  initialise(query.embree);
  RTCRayHit ray_hit{};
  ray_hit.ray = single_precision(ray, t_min, t_max);
  ray_hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  intersect_one(embree_->scene, query.embree, ray_hit);
  Hit hit;
  if (ray_hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return hit;
  hit.thing = ray_hit.hit.geomID;
  const Triangles* triangles = embree_->triangles[hit.thing];
  if (triangles == nullptr) {
    hit.t = query.t_analytic;
    return hit;
  }
  hit.triangle = ray_hit.hit.primID;
  hit.t = ray_hit.ray.tfar;
  hit.u = ray_hit.hit.u;
  hit.v = ray_hit.hit.v;
  refine(ray, *triangles, hit);
  return hit;
}

bool Rays::blocked(const Ray& ray, double t_min, double t_max, std::uint32_t skip) const {
  Query query{{}, &ray, t_min, t_max, skip, infinite};
  initialise(query.embree);
  RTCRay single = single_precision(ray, t_min, t_max);
  occluded_one(embree_->scene, query.embree, single);
  return single.tfar < 0;
}

}  // namespace etendue::rendering
