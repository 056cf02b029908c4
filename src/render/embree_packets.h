#pragma once

// Packets of eight rays for Embree 3 and 4: version 4 passes the flags of a query within an
// argument struct, version 3 in a context beside the rays.

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace fppg
{

#if RTC_VERSION_MAJOR >= 4

/// The closest hits of eight rays that run much alike; valid is -1 for a ray to follow, else 0.
inline void embree_intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays)
{
    RTCIntersectArguments arguments;
    rtcInitIntersectArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &rays, &arguments);
}

/// Sets tfar of the rays that meet anything to minus infinity.
inline void embree_occluded8(const int* valid, RTCScene scene, RTCRay8& rays)
{
    RTCOccludedArguments arguments;
    rtcInitOccludedArguments(&arguments);
    arguments.flags = RTC_RAY_QUERY_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &rays, &arguments);
}

#else

/// The closest hits of eight rays that run much alike; valid is -1 for a ray to follow, else 0.
inline void embree_intersect8(const int* valid, RTCScene scene, RTCRayHit8& rays)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcIntersect8(valid, scene, &context, &rays);
}

/// Sets tfar of the rays that meet anything to minus infinity.
inline void embree_occluded8(const int* valid, RTCScene scene, RTCRay8& rays)
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    rtcOccluded8(valid, scene, &context, &rays);
}

#endif

} // namespace fppg
