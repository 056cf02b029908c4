#pragma once

#include <stddef.h>
#include <stdint.h>

/* Between the program and its plugin that reads STEP files by OpenCASCADE: plain C, so that neither
   depends on how the other was compiled. Lengths in millimetres, whatever the file's unit. */

/* A solid of an assembly, or a shell that is in none. Texts live as long as the file is open. */
struct FppgStepPart
{
    const char* name; /* of the instance, else of the part; may be empty */
    const char*
        path; /* names of the assemblies above it, of the instance and the part, one a line */
    int has_color;
    double color[3]; /* sRGB, 0 to 1 */
};

/* A part as facets, with what its exact faces say. Pointers are valid during the call only. */
struct FppgStepMesh
{
    const double* points; /* 3 * point_count */
    size_t point_count;
    const uint32_t* corners; /* 3 * facet_count, counter-clockwise from outside */
    size_t facet_count;
    const uint32_t* faces; /* facet_count: the face of each facet, for surface() */
    const double* uv;      /* 6 * facet_count: u, v of the three corners on that face */
    double volume;         /* mm3; 0: it is a shell */
    double area;           /* mm2 */
    double center[3];      /* mm, of the volume */
    double inertia[6];     /* mm5, of the volume about its center: xx, yy, zz, xy, yz, xz */
    size_t sharp_edges;    /* CAD edges whose faces bend by more than a degree, or end */
    size_t smooth_edges;   /* CAD edges whose faces are tangent */
    double sharp_length;   /* mm, of the first */
};

struct FppgStepFile;

/* What the plugin does. All but surface() are called by one thread at a time. */
struct FppgStep
{
    /* Opens a file; null with what is wrong in *fault, a text that lives until the next call. */
    struct FppgStepFile* (*open)(const char* path, const char** fault);
    void (*close)(struct FppgStepFile* file);
    size_t (*part_count)(const struct FppgStepFile* file);
    void (*part)(const struct FppgStepFile* file, size_t index, struct FppgStepPart* out);
    /* Makes the facets of a part and hands them over. Returns an empty text, or what is wrong.
       deflection: mm, of facets from the surface, 0: 1/2000 of the part's size; angle: radians
       between facets that meet on a face, about. */
    const char* (*mesh)(struct FppgStepFile* file, size_t index, double deflection, double angle,
                        void* to, void (*take)(void* to, const struct FppgStepMesh* mesh));
    /* A point of a face with its first and second derivatives: S, Su, Sv, Suu, Suv, Svv; not
       numbers where it has none. */
    void (*surface)(const struct FppgStepFile* file, uint32_t face, double u, double v,
                    double out[18]);
    /* Whether a face is a plane. */
    int (*is_plane)(const struct FppgStepFile* file, uint32_t face);
};

/* The function that the plugin exports. */
typedef const struct FppgStep* (*FppgStepEntry)(void);
#define FPPG_STEP_ENTRY "fppg_step_of_version_2"
