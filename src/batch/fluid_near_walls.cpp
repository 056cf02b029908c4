#include "batch/fluid_near_walls.h"

#include "meshes/mesh_query.h"

#include <algorithm>

namespace fppg
{
namespace
{

constexpr std::uint64_t most_samples = 5000;

} // namespace

std::vector<Vec3> sample_fluid(const RunField& field, std::uint16_t first_bound)
{
    const auto for_each_run = [&](const auto& visit)
    {
        for (std::size_t x = 0; x < field.slabs.size(); ++x)
            for (const Run& run : field.slabs[x])
                if (run.mk < first_bound) visit(x, run);
    };
    std::uint64_t all = 0;
    for_each_run([&](std::size_t, const Run& run) { all += run.z_end - run.z_begin; });
    const std::uint64_t stride = std::max<std::uint64_t>(1, all / most_samples);
    std::vector<Vec3> out;
    std::uint64_t until_next = 0;
    for_each_run(
        [&](std::size_t x, const Run& run)
        {
            std::uint64_t z = run.z_begin + until_next;
            for (; z < run.z_end; z += stride)
                out.push_back(field.grid.place(
                    {static_cast<double>(x), static_cast<double>(run.y), static_cast<double>(z)}));
            until_next = z - run.z_end;
        });
    return out;
}

double share_near(const std::vector<Vec3>& places, const TriangleSoup& surface, double within,
                  int threads)
{
    if (places.empty() || surface.size() == 0) return 0;
    const MeshQuery query(TriangleSoup(surface), threads);
    const auto near = std::count_if(places.begin(), places.end(),
                                    [&](const Vec3& p)
                                    { return query.closest_point(p, within).distance <= within; });
    return static_cast<double>(near) / static_cast<double>(places.size());
}

} // namespace fppg
