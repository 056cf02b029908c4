#pragma once

#include <stddef.h>
#include <stdint.h>

/* Between the program and its plugin that reads STEP files by OpenCASCADE: plain C, so that neither
   depends on how the other was compiled. Lengths in millimetres, whatever the file's unit. */

/* A part of an assembly in its place. Pointers are valid during the call only. */
struct FppgStepPart
{
    const char* name;     /* of the instance, else of the part; may be empty */
    const double* points; /* 3 * point_count */
    size_t point_count;
    const uint32_t* corners; /* 3 * facet_count, counter-clockwise from outside */
    size_t facet_count;
    double volume;       /* of the exact solid, mm3; 0: it is no solid */
    double area;         /* of the exact faces, mm2 */
    size_t sharp_edges;  /* CAD edges whose faces bend by more than a degree */
    size_t smooth_edges; /* CAD edges whose faces are tangent */
};

typedef void (*FppgTakeStepPart)(void* to, const struct FppgStepPart* part);

/* Calls take() for every solid, or shell without one. Returns an empty text, or what is wrong.
   deflection: mm, of facets from the surface; angle: radians between neighbouring facets' normals.
 */
typedef const char* (*FppgReadStep)(const char* path, double deflection, double angle, void* to,
                                    FppgTakeStepPart take);
#define FPPG_READ_STEP "fppg_read_step"
