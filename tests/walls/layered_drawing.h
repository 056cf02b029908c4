#pragma once

#include "fppg/normals.h"
#include "fppg/particles.h"
#include "fppg/read_shapes.h"
#include "fppg/relax_walls.h"
#include "fppg/shapes.h"

#include "helpers/drawing.h"

#include <cmath>
#include <string>
#include <vector>

namespace fppg::test
{

/// Reach of the kernel at coefh 1, metres.
inline const double kernel_reach = 2 * std::sqrt(3.0) * Drawing::dp;

/// A drawing whose walls are for mDBC, with three layers.
inline Drawing layered(bool is_2d = false)
{
    Drawing drawing(is_2d);
    drawing.def.h = kernel_reach / 2;
    drawing.def.normals.is_active = true;
    drawing.def.fit.all->boundary = WallBoundary::Mdbc;
    drawing.def.fit.all->depths_dp = {0.5, 1.5, 2.5};
    if (is_2d) drawing.def.fit.all->depths_dp = {0.5, 1.5};
    return drawing;
}

inline RunField relaxed(const Drawing& drawing, int threads = 1)
{
    RunField field = drawing.run(threads);
    RelaxReport report;
    relax_walls(drawing.def, field, threads, {}, report);
    return field;
}

struct WallNormals
{
    std::vector<Vec3> positions;
    std::vector<Vec3> normals;
    NormalsReport report;
};

/// Of the boundary particles.
inline WallNormals normals_of(const Drawing& drawing, RunField field)
{
    CaseDef def = drawing.def;
    def.constants.rhop0 = 1000;
    def.constants.gamma = 7;
    def.constants.coef_sound = 20;
    def.constants.coef_h = 1;
    CaseConstants constants;
    std::vector<std::string> warnings;
    const CaseParticles particles = make_particles(def, field, 1, constants, warnings);
    WallNormals out;
    for (const auto& n : compute_normals(def, particles, field, {}, 1, out.report))
        out.normals.push_back({n[0], n[1], n[2]});
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.type == ParticleType::Fluid) continue;
        for (const ParticleRun& run : block.runs)
            for (std::uint32_t k = 0; k < run.count; ++k)
                out.positions.push_back(
                    run.is_off_lattice
                        ? particles.off_lattice.positions[run.off_lattice_begin() + k]
                        : field.grid.origin + Drawing::dp * Vec3{static_cast<double>(run.x),
                                                                 static_cast<double>(run.y),
                                                                 static_cast<double>(run.z + k)});
    }
    return out;
}

} // namespace fppg::test
