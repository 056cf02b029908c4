#include "fit/crossed_cells.h"

#include "fit/fit_shapes.h"
#include "fppg/error.h"

#include <gtest/gtest.h>

namespace fppg
{

namespace
{

using namespace test;

SurfaceMesh mesh_of(const TriangleSoup& soup)
{
    MeshReport report;
    return repair_mesh(soup, {}, 1, report);
}

/// Whether a facet reaches a cell, by cutting it at the cell's six faces.
bool reaches(std::vector<Vec3> polygon, const Vec3& middle, double dp)
{
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
        {
            std::vector<Vec3> kept;
            const auto inside = [&](const Vec3& p)
            { return 0.5 * dp - sign * (p[axis] - middle[axis]); };
            for (std::size_t i = 0; i < polygon.size(); ++i)
            {
                const Vec3& a = polygon[i];
                const Vec3& b = polygon[(i + 1) % polygon.size()];
                if (inside(a) >= 0) kept.push_back(a);
                if ((inside(a) < 0) != (inside(b) < 0))
                    kept.push_back(a + (b - a) * (inside(a) / (inside(a) - inside(b))));
            }
            polygon = kept;
        }
    return !polygon.empty();
}

} // namespace

TEST(FindCrossedCells, AgreesWithCuttingFacetsAtCellFaces)
{
    const SurfaceMesh mesh = mesh_of(sphere(1));
    const Vec3 origin{0.013, 0.021, 0.037};
    const double dp = 0.11;
    const auto cells = find_crossed_cells(mesh, origin, dp, 1);
    std::vector<std::array<std::int32_t, 3>> wanted;
    for (std::int32_t i = -12; i <= 12; ++i)
        for (std::int32_t j = -12; j <= 12; ++j)
            for (std::int32_t k = -12; k <= 12; ++k)
            {
                const Vec3 middle = origin + Vec3{i * dp, j * dp, k * dp};
                for (const auto& facet : mesh.facets)
                    if (reaches({mesh.vertices[facet[0]], mesh.vertices[facet[1]],
                                 mesh.vertices[facet[2]]},
                                middle, dp))
                    {
                        wanted.push_back({i, j, k});
                        break;
                    }
            }
    EXPECT_EQ(cells, wanted);
}

TEST(FindCrossedCells, CountsBothCellsBesideACommonFace)
{
    TriangleSoup soup;
    add_facet(soup, {0.1, 0.1, 0.5}, {0.3, 0.1, 0.5}, {0.1, 0.3, 0.5});
    const std::vector<std::array<std::int32_t, 3>> wanted{{0, 0, 0}, {0, 0, 1}};
    EXPECT_EQ(find_crossed_cells(mesh_of(soup), {}, 1, 1), wanted);
}

TEST(FindCrossedCells, DoesNotDependOnThreads)
{
    const SurfaceMesh mesh = mesh_of(sphere(4));
    EXPECT_EQ(find_crossed_cells(mesh, {}, 0.02, 1), find_crossed_cells(mesh, {}, 0.02, 8));
}

TEST(FindCrossedCells, RefusesAMeshFarWiderThanTheLattice)
{
    EXPECT_THROW(find_crossed_cells(mesh_of(octahedron(1)), {}, 1e-10, 1), GeometryError);
}

} // namespace fppg
