#pragma once

#include "render/embree_packets.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace fppg
{

/// Spheres that rays can be sent through.
class SphereScene
{
public:
    struct Sphere
    {
        float x, y, z, radius;
    };

    /// throws Error if Embree fails, std::bad_alloc if memory does not suffice
    SphereScene(const std::vector<Sphere>& spheres, int threads);

    RTCScene handle() const { return scene_.get(); }

private:
    struct ReleaseDevice
    {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    };
    struct ReleaseScene
    {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device_;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene_;
};

} // namespace fppg
