#include "meshes/t_junctions.h"

#include <algorithm>
#include <array>
#include <unordered_map>
#include <utility>

#include "core/parallel.h"
#include "meshes/box_tree.h"
#include "meshes/edge_map.h"
#include "meshes/mesh_facets.h"

namespace fppg
{

std::vector<Junction> find_t_junctions(const SurfaceMesh& mesh, double least, double most,
                                       int threads)
{
    std::vector<std::uint32_t> open;
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
        if (is_open(mesh, e)) open.push_back(static_cast<std::uint32_t>(e));
    if (open.empty()) return {};
    std::vector<Box3> boxes(open.size());
    std::vector<double> room(open.size());
    std::vector<std::uint32_t> ends;
    for (std::size_t i = 0; i < open.size(); ++i)
    {
        const Vec3 &a = mesh.vertices[mesh.edges[open[i]][0]],
                   &b = mesh.vertices[mesh.edges[open[i]][1]];
        const double rounding = float_step * std::max(largest_coordinate(a), largest_coordinate(b));
        room[i] = std::min({std::max(rounding, least), most, 0.01 * norm(b - a)});
        for (const Vec3& end : {a, b})
            for (const double sign : {-1.0, 1.0})
                boxes[i].add(end + sign * Vec3{room[i], room[i], room[i]});
        ends.insert(ends.end(), mesh.edges[open[i]].begin(), mesh.edges[open[i]].end());
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());

    const BoxTree tree(boxes, threads);
    std::vector<std::vector<Junction>> found(ends.size());
    parallel_for(
        ends.size(), threads,
        [&](std::size_t i)
        {
            const Vec3& p = mesh.vertices[ends[i]];
            Box3 at;
            at.add(p);
            tree.for_each_overlap(at,
                                  [&](std::uint32_t k)
                                  {
                                      const auto [from, to] = mesh.edges[open[k]];
                                      const Facet& own = mesh.facets[mesh.edge_facets[open[k]][0]];
                                      if (std::find(own.begin(), own.end(), ends[i]) != own.end())
                                          return;
                                      const Vec3 along = mesh.vertices[to] - mesh.vertices[from];
                                      const Vec3 away = p - mesh.vertices[from];
                                      const double share = dot(away, along) / dot(along, along);
                                      // At an end it is no junction: a piece between them would
                                      // have no area.
                                      const double at_end = room[k] / norm(along);
                                      if (!(share > at_end && share < 1 - at_end) ||
                                          norm(away - share * along) > room[k])
                                          return;
                                      found[i].push_back({open[k], ends[i], share});
                                  });
        },
        1024);
    std::vector<Junction> all;
    for (const std::vector<Junction>& some : found) all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end(),
              [](const Junction& a, const Junction& b)
              {
                  if (a.edge != b.edge) return a.edge < b.edge;
                  return a.share != b.share ? a.share < b.share : a.vertex < b.vertex;
              });
    return all;
}

void split_at(const std::vector<Junction>& junctions, SurfaceMesh& mesh)
{
    /// A facet with the vertices that lie on each of its sides, in the sides' direction.
    struct Part
    {
        Facet corners;
        std::array<std::vector<std::uint32_t>, 3> on_side;
    };
    std::unordered_map<std::uint32_t, Part> parts;
    std::vector<std::uint32_t> split;
    for (const Junction& junction : junctions)
    {
        const std::uint32_t f = mesh.edge_facets[junction.edge][0];
        const auto [place, is_new] = parts.try_emplace(f);
        Part& part = place->second;
        if (is_new)
        {
            split.push_back(f);
            part.corners = mesh.facets[f];
        }
        for (std::size_t s = 0; s < 3; ++s)
        {
            if (mesh.facet_edges[f][s] != junction.edge) continue;
            std::vector<std::uint32_t>& list = part.on_side[s];
            list.insert(
                mesh.facets[f][s] == mesh.edges[junction.edge][0] ? list.end() : list.begin(),
                junction.vertex);
        }
    }
    for (const std::uint32_t f : split)
    {
        bool is_first = true;
        std::vector<Part> open{std::move(parts[f])};
        while (!open.empty())
        {
            const Part part = std::move(open.back());
            open.pop_back();
            std::size_t s = 0;
            while (s < 3 && part.on_side[s].empty()) ++s;
            if (s == 3)
            {
                if (is_first)
                    mesh.facets[f] = part.corners;
                else
                    mesh.facets.push_back(part.corners);
                is_first = false;
                continue;
            }
            const std::uint32_t a = part.corners[s], b = part.corners[(s + 1) % 3],
                                c = part.corners[(s + 2) % 3], middle = part.on_side[s].front();
            const std::vector<std::uint32_t> rest(part.on_side[s].begin() + 1,
                                                  part.on_side[s].end());
            open.push_back({{a, middle, c}, {{{}, {}, part.on_side[(s + 2) % 3]}}});
            open.push_back({{middle, b, c}, {{rest, part.on_side[(s + 1) % 3], {}}}});
        }
    }
}

} // namespace fppg
