#include "walls/touching_shells.h"

#include "core/disjoint_set.h"
#include "core/parallel.h"
#include "core/text.h"
#include "fppg/boolean.h"
#include "meshes/box_tree.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <utility>

namespace fppg
{
namespace
{

constexpr double touching_dp = 0.01;
constexpr double opposite =
    -0.999; ///< cosine between the normals of facets that look at each other
/// What two facets share of the smaller one, from which on they overlap.
constexpr double least_overlap = 1e-3;

/// Two facets of different shells that touch.
struct Contact
{
    std::array<std::uint32_t, 2> shells{};
    double gap = 0;  ///< metres
    double area = 0; ///< that they share, metres squared
};

Vec3 corner(const SurfaceMesh& mesh, std::uint32_t facet, std::size_t k)
{
    return mesh.vertices[mesh.facets[facet][k % 3]];
}

/// Facets joined across edges of two facets and, where more meet, from each to the one that bounds
/// the same piece of the inside: the first that runs the other way, seen turning from it inwards.
struct Shells
{
    std::vector<std::uint32_t> of_facet;
    std::uint32_t count = 0;
    std::vector<char> is_outward; ///< closed and facing outwards
};

struct EdgeSide
{
    std::uint32_t edge;
    std::uint32_t facet;
    std::uint32_t side;
    bool runs_up;
};

/// The sides at edges of more than two facets, by edge.
std::vector<EdgeSide> find_crowded_sides(const SurfaceMesh& mesh)
{
    std::vector<EdgeSide> sides;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        for (std::uint32_t s = 0; s < 3; ++s)
            if (mesh.is_manifold[mesh.facet_edges[f][s]] == 0)
                sides.push_back({mesh.facet_edges[f][s], f, s,
                                 mesh.facets[f][s] < mesh.facets[f][(s + 1) % 3]});
    std::sort(sides.begin(), sides.end(),
              [](const EdgeSide& a, const EdgeSide& b)
              { return a.edge != b.edge ? a.edge < b.edge : a.facet < b.facet; });
    return sides;
}

/// From a side to another one at its edge, turning inwards, radians; a facet in the same place is a
/// whole turn away.
double angle_inwards(const SurfaceMesh& mesh, const EdgeSide& from, const EdgeSide& to)
{
    const Vec3 along =
        corner(mesh, from.facet, from.side + 1) - corner(mesh, from.facet, from.side);
    const auto away = [&](const EdgeSide& side)
    {
        const Vec3 d =
            corner(mesh, side.facet, side.side + 2) - corner(mesh, side.facet, side.side);
        return d - along * (dot(d, along) / dot(along, along));
    };
    const Vec3 first = away(from), second = away(to);
    const double angle =
        std::atan2(-dot(second, mesh.normals[from.facet]) * norm(first), dot(second, first));
    return angle < 0.01 ? angle + 2 * std::numbers::pi : angle;
}

Shells find_shells(const SurfaceMesh& mesh)
{
    DisjointSet sets(mesh.facets.size());
    std::vector<char> is_open(mesh.facets.size(), 0);
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        for (std::size_t s = 0; s < 3; ++s)
        {
            const std::uint32_t other = mesh.neighbours[f][s];
            if (other != no_index)
                sets.join(f, other);
            else if (mesh.is_manifold[mesh.facet_edges[f][s]] != 0)
                is_open[f] = 1;
        }
    const std::vector<EdgeSide> sides = find_crowded_sides(mesh);
    for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end)
    {
        while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
        for (std::size_t i = begin; i < end; ++i)
        {
            std::size_t best = end;
            double least = 0;
            for (std::size_t k = begin; k < end; ++k)
            {
                if (sides[k].runs_up == sides[i].runs_up) continue;
                const double angle = angle_inwards(mesh, sides[i], sides[k]);
                if (best != end && angle >= least) continue;
                best = k;
                least = angle;
            }
            if (best == end)
                is_open[sides[i].facet] = 1;
            else
                sets.join(sides[i].facet, sides[best].facet);
        }
    }
    Shells shells;
    shells.of_facet.assign(mesh.facets.size(), no_index);
    Box3 box;
    for (const Vec3& p : mesh.vertices) box.add(p);
    const Vec3 middle = box.min + 0.5 * (box.max - box.min);
    std::vector<double> volume;
    std::vector<std::uint32_t> number(mesh.facets.size(), no_index);
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
    {
        std::uint32_t& own = number[sets.find(f)];
        if (own == no_index)
        {
            own = shells.count++;
            volume.push_back(0);
            shells.is_outward.push_back(1);
        }
        shells.of_facet[f] = own;
        volume[own] += dot(corner(mesh, f, 0) - middle,
                           cross(corner(mesh, f, 1) - middle, corner(mesh, f, 2) - middle));
        if (is_open[f] != 0) shells.is_outward[own] = 0;
    }
    for (std::uint32_t s = 0; s < shells.count; ++s)
        if (!(volume[s] > 0)) shells.is_outward[s] = 0;
    return shells;
}

/// The area of the part of facet g that lies over facet f, seen along the normal of f.
double shared_area(const SurfaceMesh& mesh, std::uint32_t f, std::uint32_t g)
{
    const Vec3& normal = mesh.normals[f];
    std::vector<Vec3> polygon{corner(mesh, g, 0), corner(mesh, g, 1), corner(mesh, g, 2)};
    std::vector<Vec3> kept;
    for (std::size_t s = 0; s < 3 && polygon.size() > 2; ++s)
    {
        const Vec3 from = corner(mesh, f, s);
        const Vec3 inwards = cross(normal, corner(mesh, f, s + 1) - from);
        kept.clear();
        for (std::size_t i = 0; i < polygon.size(); ++i)
        {
            const Vec3& a = polygon[i];
            const Vec3& b = polygon[(i + 1) % polygon.size()];
            const double in_a = dot(a - from, inwards), in_b = dot(b - from, inwards);
            if (in_a >= 0) kept.push_back(a);
            if ((in_a > 0 && in_b < 0) || (in_a < 0 && in_b > 0))
                kept.push_back(a + (b - a) * (in_a / (in_a - in_b)));
        }
        polygon.swap(kept);
    }
    double twice = 0;
    for (std::size_t i = 2; i < polygon.size(); ++i)
        twice -= dot(normal, cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
    return twice / 2;
}

/// The contact of two facets, its area 0 where they do not touch.
Contact contact_of(const SurfaceMesh& mesh, std::uint32_t f, std::uint32_t g, double within)
{
    Contact contact;
    if (!(dot(mesh.normals[f], mesh.normals[g]) < opposite)) return contact;
    const bool is_larger = mesh.areas[f] >= mesh.areas[g];
    const std::uint32_t large = is_larger ? f : g, small = is_larger ? g : f;
    for (std::size_t k = 0; k < 3; ++k)
        contact.gap = std::max(
            contact.gap,
            std::abs(dot(mesh.normals[large], corner(mesh, small, k) - corner(mesh, large, 0))));
    if (contact.gap > within) return contact;
    const double area = shared_area(mesh, large, small);
    if (area > least_overlap * mesh.areas[small]) contact.area = area;
    return contact;
}

std::vector<Contact> find_contacts(const SurfaceMesh& mesh, const Shells& shells, double within,
                                   int threads)
{
    std::vector<std::uint32_t> facets;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        if (shells.is_outward[shells.of_facet[f]] != 0) facets.push_back(f);
    std::vector<Box3> boxes(facets.size());
    const Vec3 room{within / 2, within / 2, within / 2};
    for (std::size_t i = 0; i < facets.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
        {
            boxes[i].add(corner(mesh, facets[i], k) - room);
            boxes[i].add(corner(mesh, facets[i], k) + room);
        }
    const BoxTree tree(boxes, threads);
    std::vector<std::vector<Contact>> found(tree.groups());
    parallel_for(
        found.size(), threads,
        [&](std::size_t group)
        {
            tree.for_each_pair_of(group,
                                  [&](std::uint32_t i, std::uint32_t k)
                                  {
                                      const auto [f, g] = std::minmax(facets[i], facets[k]);
                                      if (shells.of_facet[f] == shells.of_facet[g]) return;
                                      Contact contact = contact_of(mesh, f, g, within);
                                      if (!(contact.area > 0)) return;
                                      contact.shells = {shells.of_facet[f], shells.of_facet[g]};
                                      found[group].push_back(contact);
                                  });
        },
        16);
    std::vector<Contact> all;
    for (const std::vector<Contact>& some : found) all.insert(all.end(), some.begin(), some.end());
    return all;
}

TriangleSoup soup_of_shells(const SurfaceMesh& mesh, const Shells& shells,
                            const std::vector<char>& is_taken)
{
    TriangleSoup soup;
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f)
        if (is_taken[shells.of_facet[f]] != 0)
            for (std::size_t k = 0; k < 3; ++k) soup.vertices.push_back(corner(mesh, f, k));
    return soup;
}

} // namespace

void unite_touching_shells(SurfaceMesh& mesh, MeshReport& report, double dp, int threads)
{
    if (report.shells < 2) return;
    const Shells shells = find_shells(mesh);
    if (std::count(shells.is_outward.begin(), shells.is_outward.end(), 1) < 2) return;
    const std::vector<Contact> contacts = find_contacts(mesh, shells, touching_dp * dp, threads);
    if (contacts.empty()) return;
    DisjointSet groups(shells.count);
    std::vector<char> touches(shells.count, 0);
    double gap = 0, area = 0;
    for (const Contact& contact : contacts)
    {
        groups.join(contact.shells[0], contact.shells[1]);
        for (const std::uint32_t s : contact.shells) touches[s] = 1;
        gap = std::max(gap, contact.gap);
        area += contact.area;
    }
    std::map<std::uint32_t, std::vector<std::uint32_t>> members;
    std::vector<char> stays(shells.count, 1);
    for (std::uint32_t s = 0; s < shells.count; ++s)
        if (touches[s] != 0)
        {
            members[groups.find(s)].push_back(s);
            stays[s] = 0;
        }
    TriangleSoup soup = soup_of_shells(mesh, shells, stays);
    for (const auto& group : members)
    {
        std::vector<SurfaceMesh> meshes;
        for (const std::uint32_t s : group.second)
        {
            std::vector<char> is_taken(shells.count, 0);
            is_taken[s] = 1;
            MeshReport ignored;
            meshes.push_back(
                repair_mesh(soup_of_shells(mesh, shells, is_taken), {}, threads, ignored));
        }
        std::vector<BooleanPart> parts;
        BooleanNode tree;
        tree.op = BooleanOp::Union;
        for (std::uint32_t p = 0; p < meshes.size(); ++p)
        {
            parts.push_back({fmt::format("shell {}", group.second[p] + 1), &meshes[p], false});
            BooleanNode part;
            part.part = p;
            tree.operands.push_back(part);
        }
        const BooleanMesh united = boolean_mesh(parts, tree, {2 * gap}, threads);
        const TriangleSoup facets = soup_of(united.mesh);
        soup.vertices.insert(soup.vertices.end(), facets.vertices.begin(), facets.vertices.end());
    }
    MeshReport after;
    mesh = repair_mesh(soup, {.dp = dp}, threads, after);
    after.facets_read = report.facets_read;
    // What judge_edges() said last of the mesh before is said anew of the mesh now.
    const std::size_t outdated = (report.open_edges > 0 ? 1U : 0U) +
                                 (report.non_manifold_edges > 0 ? 1U : 0U) +
                                 (report.clashing_edges > 0 ? 1U : 0U);
    report.warnings.resize(report.warnings.size() - outdated);
    report.warnings.push_back(
        fmt::format("{} touch face to face; the walls between them, {:.3g} m2, are left out.",
                    counted(static_cast<std::size_t>(std::count(touches.begin(), touches.end(), 1)),
                            "closed part", "closed parts"),
                    area));
    report.warnings.insert(report.warnings.end(), after.warnings.begin(), after.warnings.end());
    after.warnings = std::move(report.warnings);
    report = std::move(after);
}

} // namespace fppg
