#include "render/sphere_scene.h"

#include "meshes/embree.h"

#include <cstring>
#include <new>

namespace fppg
{

SphereScene::SphereScene(const std::vector<Sphere>& spheres, int threads)
    : device_(new_embree_device(threads))
{
    scene_.reset(rtcNewScene(device_.get()));
    const RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_SPHERE_POINT);
    // Embree keeps a copy of its own, aligned as it needs it.
    void* buffer = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4,
                                           sizeof(Sphere), spheres.size());
    if (buffer == nullptr)
    {
        rtcReleaseGeometry(geometry);
        expect_embree_worked(device_.get());
        throw std::bad_alloc();
    }
    std::memcpy(buffer, spheres.data(), spheres.size() * sizeof(Sphere));
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_.get(), geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene_.get());
    expect_embree_worked(device_.get());
}

} // namespace fppg
