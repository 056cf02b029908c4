#include "render/sphere_scene.h"

#include "fppg/error.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstring>
#include <new>

namespace fppg
{

namespace
{

void check(RTCDevice device)
{
    const RTCError code = rtcGetDeviceError(device);
    if (code == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (code != RTC_ERROR_NONE)
        throw Error(fmt::format("Embree failed with error {}", static_cast<int>(code)));
}

} // namespace

SphereScene::SphereScene(const std::vector<Sphere>& spheres, int threads)
    : device_(rtcNewDevice(fmt::format("threads={}", std::max(threads, 1)).c_str()))
{
    if (!device_)
        throw Error(fmt::format("Embree cannot be started: error {}",
                                static_cast<int>(rtcGetDeviceError(nullptr))));
    scene_.reset(rtcNewScene(device_.get()));
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    // Embree keeps a copy of its own, aligned as it needs it.
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                           sizeof(Sphere), spheres.size());
    if (buffer == nullptr)
    {
        rtcReleaseGeometry(geometry);
        check(device_.get());
        throw std::bad_alloc();
    }
    std::memcpy(buffer, spheres.data(), spheres.size() * sizeof(Sphere));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
    check(device_.get());
}

} // namespace fppg
