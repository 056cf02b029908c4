#pragma once

#include "fppg/files.h"
#include "meshes/box_tree.h"

#include <array>
#include <optional>
#include <vector>

namespace fppg
{

/// A triangle or a quad with what the normals need of it.
struct NormalFacet
{
    std::array<Vec3, 4> corners;
    std::uint32_t size = 0; ///< of them in use, 3 or 4
    Vec3 unit;              ///< by the right-hand rule on the first three corners
};

/// The polygons as norgeometry uses them: coordinates rounded to float32, those of five and more
/// corners cut into the triangles (0, 1, 2), (0, 2, 3), ..., points and lines left out. A quad
/// stays one, also where its fourth corner is off the plane of the others. (Found with GenCase
/// v5.4.354: svshapes of polygons with 3 to 6 corners.) For triangles, convex quads and cut
/// polygons the numbers of candidates and all normals agree in every run. Quads that are not convex
/// get other normals there, by no rule that was found; here their outline counts. Of quads that are
/// not plane 30 of 1,239 normals differ.
std::vector<NormalFacet> normal_facets(const std::vector<ShapePolygons>& geometry);

/// Answers which normal norgeometry gives a boundary particle.
///
/// Rules N1 to N5, by experiments with GenCase v5.4.354 (39,930 of 39,930 particles among random
/// triangles, 0 of 41,185 wrong on boxes, wedges, cylinders, spheres and meshes; of N4 and N5
/// 11,200 of 11,200 particles before two to six facets of nearly equal distance, part of them of
/// one direction). Lengths and components of directions are equal here when they differ by no more
/// than 1e-4 dp, also the latter, which have no unit (dp 0.125 and 0.5):
/// - N1: d is the distance from the particle p to the facet's plane along its unit normal u, above
///   zero where p is behind it; f = p + d u; e is the distance in the plane from f to the facet, 0
///   inside. A facet is a candidate when 0 < d <= D, e <= D and p lies in the facet's box enlarged
///   by D
/// - N2: it faces the particle when e <= 1e-4 dp; its vector is then d u, else the one to the
///   nearest point of its outline
/// - N3: any facing candidate comes before all others
/// - N4: of those that face, the first in the file of every direction counts, if its d is equal to
///   the least d of all; so a face hides nearer ones of its direction, and the normal is zero when
///   none is left. One: its vector. Several: w along the sum of their vectors, length
///   min of d_i / (w . u_i) over w . u_i > 0; beyond 1.5 D the first one's own vector; zero where
///   the sum is exactly zero
/// - N5: of those that do not face, the shortest of every direction counts, in the place of the
///   first one of its direction in the file. Of these a group is built: each joins it if its
///   length is equal to that of the group's first, and begins the group anew if it is shorter.
///   With three in the group the normal leads to the point where three planes cross: those of the
///   first three whose length is equal to that of the group's first. Otherwise, the shortest
///   vector; at equal lengths the first
///
/// One thing differs: where the three planes of N5 cross farther than 1.5 D or nowhere, GenCase
/// writes the vector to that far point or, from parallel planes, to the point (0, 0, 0); here the
/// shortest vector counts.
class GeometryQuery
{
public:
    /// reach  D, metres
    GeometryQuery(std::vector<NormalFacet> facets, double reach, double dp, int threads);

    struct Answer
    {
        Vec3 normal;                  ///< zero without candidate
        std::uint32_t candidates = 0; ///< what GenCase sums up as computed normals
    };

    /// May be called from several threads at once.
    Answer at(const Vec3& particle) const;

    /// 1 where the facets nearest to p look along n, -1 where they look against it; 0 where none is
    /// within the distance, metres, or they cancel out. Facets less than 0.01 dp farther than the
    /// nearest one count, so that both do at an edge.
    int side_at(const Vec3& p, const Vec3& n, double within) const;

private:
    struct Facing
    {
        std::uint32_t facet;
        double distance;
    };

    /// A candidate that does not face the particle.
    struct Aside
    {
        std::uint32_t facet;
        Vec3 vector;
        double length;
    };

    bool is_same_direction(std::uint32_t facet, std::uint32_t other) const;
    Vec3 join(std::vector<Facing>& facing, double least) const;
    Vec3 nearest_of(std::vector<Aside>& aside, double least) const;
    std::optional<Vec3> crossing_of_three(const std::vector<Aside>& aside) const;

    std::vector<NormalFacet> facets_;
    double reach_;
    double tolerance_;
    BoxTree tree_;
};

} // namespace fppg
