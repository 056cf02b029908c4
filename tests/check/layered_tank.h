#pragma once

#include "fppg/check.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

namespace fppg::test
{

/// A case in memory: an open tank whose floor and sides are three layers half a dp behind their
/// surfaces, each particle with the vector to the nearest point of the surface, and water in its
/// lower half. dp is 0.1 m, the tank is 2 m wide and 1.2 m high, surfaces stand at x = 0 and 2, z =
/// 0 (3D: y = 0 and 1 too).
class LayeredTank
{
public:
    static constexpr double dp = 0.1;
    static constexpr std::uint16_t wall_mk = 10;
    static constexpr std::uint16_t fluid_mk = 1;

    explicit LayeredTank(bool is_2d) : is_2d_(is_2d)
    {
        setup.case_name = "tank";
        setup.is_2d = is_2d;
        setup.dp = dp;
        setup.h = std::sqrt(is_2d ? 2.0 : 3.0) * dp;
        setup.volume = is_2d ? dp * dp : dp * dp * dp;
        setup.gravity = {0, 0, -9.81};
        setup.boundary = 2;
        setup.slip_mode = 2;
        setup.no_penetration = true;
        const auto cells = [&](const std::function<void(const Vec3&)>& body)
        {
            const int ny = is_2d ? 1 : 16;
            for (int i = 0; i < 26; ++i)
                for (int j = 0; j < ny; ++j)
                    for (int k = 0; k < 15; ++k)
                        body({(i - 2.5) * dp, is_2d ? 0 : (j - 2.5) * dp, (k - 2.5) * dp});
        };
        cells(
            [&](const Vec3& p)
            {
                const Vec3 n = way_to_surface(p);
                if (n != Vec3{}) add_wall(p, n);
            });
        cells(
            [&](const Vec3& p)
            {
                if (way_to_surface(p) == Vec3{} && p.z < 0.6) add_fluid(p);
            });
    }

    std::uint32_t add_wall(const Vec3& p, const Vec3& n, std::uint16_t mk = wall_mk)
    {
        // Walls stand before the fluid in all arrays, as in Case.bi4.
        const auto at = static_cast<std::ptrdiff_t>(particles.normals.size());
        particles.positions.insert(particles.positions.begin() + at, p);
        particles.mk.insert(particles.mk.begin() + at, mk);
        particles.type.insert(particles.type.begin() + at, ParticleType::Fixed);
        particles.ids.push_back(static_cast<std::uint32_t>(particles.ids.size()));
        particles.normals.push_back(
            {static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
        return static_cast<std::uint32_t>(at);
    }

    void add_fluid(const Vec3& p)
    {
        particles.positions.push_back(p);
        particles.mk.push_back(fluid_mk);
        particles.type.push_back(ParticleType::Fluid);
        particles.ids.push_back(static_cast<std::uint32_t>(particles.ids.size()));
    }

    /// Takes the fluid away for which `holds` is true.
    void drain(const std::function<bool(const Vec3&)>& holds)
    {
        CheckParticles left;
        left.normals = particles.normals;
        for (std::size_t i = 0; i < particles.positions.size(); ++i)
        {
            if (particles.type[i] == ParticleType::Fluid && holds(particles.positions[i])) continue;
            left.positions.push_back(particles.positions[i]);
            left.mk.push_back(particles.mk[i]);
            left.type.push_back(particles.type[i]);
            left.ids.push_back(static_cast<std::uint32_t>(left.ids.size()));
        }
        particles = std::move(left);
    }

    /// The boundary particle nearest to a place.
    std::size_t wall_at(const Vec3& p) const
    {
        std::size_t best = 0;
        for (std::size_t i = 0; i < particles.normals.size(); ++i)
            if (norm(particles.positions[i] - p) < norm(particles.positions[best] - p)) best = i;
        return best;
    }
    std::array<float, 3>& normal_at(const Vec3& p) { return particles.normals[wall_at(p)]; }

    CheckReport check(int threads = 2)
    {
        Box3 box;
        for (const Vec3& p : particles.positions)
            if (is_finite(p)) box.add(p);
        if (setup.domain.is_empty())
        {
            const Vec3 border{0.05 * setup.h, 0.05 * setup.h, 0.05 * setup.h};
            setup.domain = {box.min - border, box.max + border};
        }
        return check_particles(particles, setup, threads);
    }

    CheckParticles particles;
    CheckSetup setup;

private:
    /// Zero inside the tank.
    Vec3 way_to_surface(const Vec3& p) const
    {
        Vec3 nearest{std::clamp(p.x, 0.0, 2.0), std::clamp(p.y, 0.0, 1.0), std::max(p.z, 0.0)};
        if (is_2d_) nearest.y = p.y;
        return nearest - p;
    }

    bool is_2d_;
};

} // namespace fppg::test
