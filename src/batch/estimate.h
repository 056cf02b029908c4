#pragma once

#include "fppg/case_def.h"
#include "fppg/particles.h"

#include "batch/estimated_work.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

struct EstimateOptions
{
    CaseOptions case_options;
    int threads = 1;
    // What the run would write.
    bool saves_bi4 = true;
    bool saves_all = false;   ///< _All.vtk
    bool saves_parts = false; ///< _Bound.vtk and _Fluid.vtk
};

struct EstimatedBlock
{
    ParticleType type = ParticleType::Fixed;
    std::uint16_t mk = 0; ///< absolute
    std::uint64_t count = 0;
    bool is_exact = true; ///< false: a body-fitted wall
};

/// What a case needs, estimated before it runs.
struct Estimate
{
    std::string definition;
    double dp = 0;
    std::array<std::uint32_t, 3> nodes{}; ///< of the domain
    bool is_exact = true;                 ///< of the counts: nothing is body-fitted
    std::uint64_t np = 0;
    std::uint64_t n_fixed = 0;
    std::uint64_t n_moving = 0;
    std::uint64_t n_floating = 0;
    std::uint64_t n_fluid = 0;
    std::vector<EstimatedBlock> blocks; ///< in the order of ids

    double wall_area = 0;        ///< of body-fitted shapes inside the domain, metres squared
    double line_length = 0;      ///< of their edges, metres
    std::uint64_t n_wall = 0;    ///< particles on their surfaces and in layers
    std::uint64_t n_line = 0;    ///< of them, on edges
    std::uint64_t triangles = 0; ///< drawn

    double memory_bytes = 0;           ///< at its peak
    double output_bytes = 0;           ///< of the files with particles
    double seconds = 0;                ///< on the threads asked for
    StageSeconds stages;               ///< make up seconds
    std::vector<std::string> files;    ///< that the case reads besides itself; absolute paths
    std::vector<std::string> warnings; ///< of reading and drawing
};

/// Reads a case and draws it on the lattice, in memory only. Without body-fitted walls the counts
/// are those of a run. A body-fitted mk counts, per shape drawn with it inside the domain and its
/// clips, area / dp^2 particles on the surface (1.5 times as many with density="cell"), of them
/// length / dp on its edges, in each layer as many as a ball with its area and volume would have,
/// and in a solid volume / dp^3 less half of the surface's and the layers'; what later draws cut
/// off, and what parts share, is not taken off. In 2D it counts its nodes. Memory and
/// time follow from counts by the rates of src/batch/rates.h, from the time that drawing takes, and
/// of layers from searches tried on their walls (walls/wall_probe.h).
///
/// path    the definition, with its extension
/// throws  as read_case() and draw_on_lattice()
/// cost    that of drawing on the lattice, and of taking in the meshes of fitted walls
Estimate estimate_case(const std::string& path, const EstimateOptions& options);

/// For people, about ten lines.
std::string to_text(const Estimate& estimate);

/// For programs: one JSON object.
std::string to_json(const Estimate& estimate);

} // namespace fppg
