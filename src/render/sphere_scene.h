#pragma once

#include "meshes/embree.h"
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
    std::unique_ptr<RTCDeviceTy, ReleaseEmbreeDevice> device_;
    std::unique_ptr<RTCSceneTy, ReleaseEmbreeScene> scene_;
};

} // namespace fppg
