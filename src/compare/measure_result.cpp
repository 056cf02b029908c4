#include "compare/measure_result.h"

#include "compare/measure.h"
#include "core/parallel.h"
#include "files/particle_source.h"
#include "files/typical_distance.h"
#include "fppg/shapes.h"

#include <fmt/format.h>
#include <algorithm>
#include <mutex>
#include <optional>

namespace fppg
{

TriangleSoup read_geometry(const std::vector<std::string>& paths, int threads)
{
    TriangleSoup soup;
    for (const std::string& path : paths)
    {
        MeshReading reading;
        reading.format = mesh_format_of(path);
        const MeshFile mesh = read_mesh_file(path, reading, threads);
        if (mesh.soup.size() == 0)
            throw CompareError(fmt::format("cannot compare with '{}': it has no surface", path));
        soup.vertices.insert(soup.vertices.end(), mesh.soup.vertices.begin(),
                             mesh.soup.vertices.end());
    }
    return soup;
}

MeasuredResult measure_result(const std::string& name, const TriangleSoup& geometry,
                              std::uint64_t particles_at_once, int threads)
{
    const ParticleSource source(name);
    const FileIndex file(source, threads);
    MeasuredResult out;
    out.path = source.path();
    out.np = source.size();
    out.bounds = file.bounds();
    out.dp = source.dp() > 0
                 ? source.dp()
                 : typical_distance(
                       source.size(), [&](std::size_t i) { return source.position(i); }, threads);
    out.is_2d = is_in_plane(out.bounds, out.dp);
    std::vector<std::uint16_t> index(65536, 0);
    for (std::size_t mk = 0; mk < index.size(); ++mk)
    {
        if (file.counts()[mk] == 0) continue;
        index[mk] = static_cast<std::uint16_t>(out.mks.size());
        MeasuredMk& of = out.mks.emplace_back();
        of.mk = static_cast<std::uint16_t>(mk);
        of.type = file.types()[mk];
        of.count = file.counts()[mk];
    }
    if (out.np == 0) return out;

    std::optional<MeshQuery> query;
    if (geometry.size() > 0) query.emplace(geometry, threads);
    const Measuring measuring{out.dp, out.is_2d, query ? &*query : nullptr};
    const CompareFrame frame = frame_around(out.bounds, out.dp);
    std::vector<MkMeasures> total(out.mks.size());
    // The plan counts the file twice, as A and as B.
    for (const Slab& slab : plan_slabs(frame, file, file, 2 * particles_at_once, threads))
    {
        const CellGrid grid(frame, file, slab, threads);
        const std::size_t chunks =
            std::min<std::size_t>(grid.columns(), 8 * static_cast<std::size_t>(threads));
        std::mutex guard;
        parallel_for(chunks, threads,
                     [&](std::size_t chunk)
                     {
                         std::vector<MkMeasures> part(total.size());
                         const std::size_t end = grid.columns() * (chunk + 1) / chunks;
                         for (std::size_t c = grid.columns() * chunk / chunks; c < end; ++c)
                             measuring.measure_column(grid, c,
                                                      [&](std::uint16_t mk) -> MkMeasures&
                                                      { return part[index[mk]]; });
                         const std::lock_guard lock(guard);
                         for (std::size_t m = 0; m < total.size(); ++m) total[m].add(part[m]);
                     });
    }
    for (std::size_t m = 0; m < total.size(); ++m)
    {
        out.mks[m].alone = total[m].alone;
        out.mks[m].spacing_dp = total[m].spacing.statistics();
        out.mks[m].shepard = total[m].shepard.statistics();
        out.mks[m].distance_dp = total[m].distance.statistics();
    }
    return out;
}

} // namespace fppg
