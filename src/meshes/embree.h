#pragma once

// The only place that knows which Embree there is: version 4 passes the context of a ray query
// within an argument struct, version 3 beside the ray, and the types have other names.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace fppg
{

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
