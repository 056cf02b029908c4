#include "batch/particle_limit.h"

#include "fppg/error.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <system_error>

namespace fppg
{

namespace
{

/// The first draw has so many nodes in its domain, 64 along every axis of a cube.
constexpr double nodes_at_first = 262144;
/// A draw of so many particles tells the share of volumes and surfaces well enough.
constexpr double enough_particles = 20000;
/// No draw has more columns of nodes in its domain; it takes some 0.1 s.
constexpr double most_columns = 4e6;
/// Below this share of the particles a volume may be a rounding of surfaces.
constexpr double least_volume = 0.1;
/// A number that is not far above the limit is counted by the draw itself.
constexpr double clearly_above = 1.1;

/// How many particles a case has: volume / dp^3 + surface / dp^2, in 2D area / dp^2 + length / dp.
class ParticleLaw
{
public:
    /// counts  with the particle distances dp and dp / 2
    ParticleLaw(double dp, double count, double count_of_half, int dimensions)
        : dp_(dp / 2), dimensions_(dimensions)
    {
        volume_ = 2 * (count_of_half - std::exp2(dimensions - 1) * count);
        if (volume_ < least_volume * count_of_half) volume_ = 0;
        surface_ = count_of_half - volume_;
    }

    double at(double dp) const
    {
        const double finer = dp_ / dp;
        return (volume_ * finer + surface_) * std::pow(finer, dimensions_ - 1);
    }

    /// The particle distance that gives so many.
    double dp_of(double count) const
    {
        double least = dp_ * 1e-9;
        double most = dp_ * 1e3;
        for (int i = 0; i < 100; ++i)
        {
            const double middle = std::sqrt(least * most);
            (at(middle) > count ? least : most) = middle;
        }
        return most;
    }

private:
    double dp_;
    int dimensions_;
    double volume_;
    double surface_;
};

class CoarseDraws
{
public:
    CoarseDraws(const std::string& path, const CaseOptions& options, int threads)
        : path_(path), options_(options), threads_(threads)
    {
        options_.fit = FitChoice::Off;
    }

    double particles_at(double dp)
    {
        options_.dp = dp;
        const CaseDef def = read_case(path_, options_);
        const Scene scene = make_scene(def);
        options_.meshes = scene.meshes;
        LatticeReport report;
        RunField field = draw_on_lattice(scene, threads_, {}, report);
        CaseConstants constants;
        std::vector<std::string> warnings;
        return static_cast<double>(make_particles(def, field, threads_, constants, warnings).np);
    }

private:
    const std::string& path_;
    CaseOptions options_;
    int threads_;
};

std::optional<ParticleLaw> find_law(CoarseDraws& draws, const LatticeGrid& grid)
{
    const int dimensions = grid.is_2d ? 2 : 3;
    const double columns = static_cast<double>(grid.n[0]) * grid.n[1];
    const double nodes = columns * grid.n[2];
    double dp = grid.dp * std::pow(nodes / nodes_at_first, 1.0 / dimensions);
    double count = draws.particles_at(dp);
    while (dp / 2 > grid.dp)
    {
        const double coarser = dp / 2 / grid.dp;
        if (columns / std::pow(coarser, dimensions - 1) > most_columns) return {};
        const double of_half = draws.particles_at(dp / 2);
        if (of_half > enough_particles) return ParticleLaw(dp, count, of_half, dimensions);
        count = of_half;
        dp /= 2;
    }
    return {};
}

} // namespace

ParticleLimit limit_of_disk(const std::string& folder, double bytes)
{
    ParticleLimit limit;
    std::error_code error;
    const std::string place = folder.empty() ? "." : folder;
    const std::filesystem::space_info space = std::filesystem::space(place, error);
    const auto available = static_cast<double>(space.available);
    if (error || !(bytes > 0) || available / bytes >= limit.most) return limit;
    limit.most = std::max(1.0, available / bytes);
    limit.holder = fmt::format("the disk of {} has room for about {:.2g} ({:.3g} GB)", place,
                               limit.most, available * 1e-9);
    limit.is_of_disk = true;
    return limit;
}

void expect_room(const CaseDef& def, std::uint64_t particles, const ParticleLimit& limit)
{
    const auto count = static_cast<double>(particles);
    if (!limit.is_of_disk || count <= limit.most) return;
    throw IoError(fmt::format("{}: the case has {} particles with dp={:g}, {}; dp={:g} fits",
                              def.file, particles, def.grid.dp, limit.holder,
                              dp_that_fits(def.grid.dp, count, def.grid.is_2d, limit.most)));
}

void expect_particles_fit(const std::string& path, const CaseOptions& options, const CaseDef& def,
                          int threads, const ParticleLimit& limit)
{
    const LatticeGrid& grid = def.grid;
    const double nodes = static_cast<double>(grid.n[0]) * grid.n[1] * grid.n[2];
    if (nodes < limit.most || def.vres.is_active()) return;
    std::optional<ParticleLaw> law;
    try
    {
        CoarseDraws draws(path, options, threads);
        law = find_law(draws, grid);
    }
    catch (const Error&)
    {
        // Some cases can only be drawn with a small dp.
    }
    if (!law) return;
    const double count = law->at(grid.dp);
    if (count <= clearly_above * limit.most) return;
    // What no disk could hold does not depend on this one's room.
    const ParticleLimit of_format;
    const ParticleLimit& exceeded = count > clearly_above * of_format.most ? of_format : limit;
    const std::string text = fmt::format(
        "the case would have about {:.2g} particles with dp={:g}, {}; dp={:g} and larger ones fit",
        count, grid.dp, exceeded.holder, dp_rounded_up(law->dp_of(0.95 * limit.most)));
    if (exceeded.is_of_disk) throw IoError(path + ": " + text);
    throw CaseError(path, 0, text);
}

} // namespace fppg
