#pragma once

// The only place that knows which Embree there is: version 4 passes the context of a ray query
// within an argument struct, version 3 beside the ray, and the types have other names.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <new>

namespace fppg
{

/// Whether Embree ever ran out of memory or threads in this process: it keeps locks then, and
/// making or releasing any device waits for them without end (Embree 3.13.5).
inline std::atomic<bool> embree_ran_out{false};

struct ReleaseEmbreeDevice
{
    void operator()(RTCDevice device) const
    {
        if (!embree_ran_out) rtcReleaseDevice(device);
    }
};

struct ReleaseEmbreeScene
{
    void operator()(RTCScene scene) const
    {
        if (!embree_ran_out) rtcReleaseScene(scene);
    }
};

/// throws  std::bad_alloc, or Error, where Embree failed at what was asked of it last
inline void expect_embree_worked(RTCDevice device)
{
    const RTCError why = rtcGetDeviceError(device);
    // What its scheduler of tasks throws, as when pthread_create fails, is an unknown error to it.
    if (why == RTC_ERROR_OUT_OF_MEMORY || why == RTC_ERROR_UNKNOWN)
    {
        embree_ran_out = true;
        throw std::bad_alloc();
    }
    if (why != RTC_ERROR_NONE)
        throw Error(fmt::format("Embree failed with error {}", static_cast<int>(why)));
}

/// Embree with so many threads.
///
/// throws  as expect_embree_worked()
inline RTCDevice new_embree_device(int threads)
{
    if (embree_ran_out) throw std::bad_alloc();
    const RTCDevice device = rtcNewDevice(fmt::format("threads={}", std::max(threads, 1)).c_str());
    if (device != nullptr) return device;
    expect_embree_worked(nullptr);
    throw Error("Embree cannot be started");
}

#if RTC_VERSION_MAJOR >= 4

using EmbreeRayContext = RTCRayQueryContext;

/// Sends one ray through the scene; callbacks find `context` in their arguments.
inline void embree_intersect(RTCScene scene, EmbreeRayContext& context, RTCRayHit& ray)
{
    rtcInitRayQueryContext(&context);
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.context = &context;
    rtcIntersect1(scene, &ray, &arguments);
}

#else

using EmbreeRayContext = RTCIntersectContext;

/// Sends one ray through the scene; callbacks find `context` in their arguments.
inline void embree_intersect(RTCScene scene, EmbreeRayContext& context, RTCRayHit& ray)
{
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &ray);
}

#endif

} // namespace fppg
