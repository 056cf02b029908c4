// Combinations against those of CGAL, which finds them by another way (corefinement).
#include "boolean/boolean_parts.h"

#include "meshes/mesh_query.h"

#include <gtest/gtest.h>

#ifdef FPPG_HAS_CGAL

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/corefinement.h>
#include <CGAL/Surface_mesh.h>

#endif

namespace fppg
{
namespace
{

#ifndef FPPG_HAS_CGAL

TEST(BooleanMesh, AgreesWithCgal)
{
    GTEST_SKIP() << "CGAL was not there when this was built (libcgal-dev)";
}

#else

using namespace test;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using CgalMesh = CGAL::Surface_mesh<Kernel::Point_3>;

CgalMesh as_cgal(const SurfaceMesh& mesh)
{
    CgalMesh out;
    std::vector<CgalMesh::Vertex_index> index;
    for (const Vec3& v : mesh.vertices) index.push_back(out.add_vertex({v.x, v.y, v.z}));
    for (const auto& f : mesh.facets) out.add_face(index[f[0]], index[f[1]], index[f[2]]);
    return out;
}

TriangleSoup as_soup(const CgalMesh& mesh)
{
    TriangleSoup out;
    for (const auto f : mesh.faces())
        for (const auto v : CGAL::vertices_around_face(mesh.halfedge(f), mesh))
        {
            const auto& p = mesh.point(v);
            out.vertices.push_back({p.x(), p.y(), p.z()});
        }
    return out;
}

double area_of(const TriangleSoup& soup)
{
    double area = 0;
    for (std::size_t f = 0; f < soup.size(); ++f)
    {
        const Vec3* c = &soup.vertices[3 * f];
        area += 0.5 * norm(cross(c[1] - c[0], c[2] - c[0]));
    }
    return area;
}

TEST(BooleanMesh, AgreesWithCgal)
{
    namespace processing = CGAL::Polygon_mesh_processing;
    int compared = 0;
    for (unsigned seed = 1; seed <= 200; ++seed)
    {
        std::mt19937 random(seed);
        PartList list;
        for (int i = 0; i < 2; ++i) list.add(any_part(random, Placing::Random));
        for (const BooleanOp op :
             {BooleanOp::Union, BooleanOp::Intersection, BooleanOp::Difference})
        {
            CgalMesh a = as_cgal(list.meshes[0]), b = as_cgal(list.meshes[1]), theirs;
            const bool is_made = op == BooleanOp::Union
                                     ? processing::corefine_and_compute_union(a, b, theirs)
                                 : op == BooleanOp::Intersection
                                     ? processing::corefine_and_compute_intersection(a, b, theirs)
                                     : processing::corefine_and_compute_difference(a, b, theirs);
            const BooleanMesh own = list.run(of_two(op));
            if (!is_made || own.mesh.facets.empty() || theirs.number_of_faces() == 0)
            {
                EXPECT_EQ(own.mesh.facets.empty(), theirs.number_of_faces() == 0) << seed;
                continue;
            }
            ++compared;
            const TriangleSoup soup = as_soup(theirs);
            EXPECT_NEAR(area_of(soup), own.report.area, 1e-7 * own.report.area) << "seed " << seed;
            const MeshQuery on_theirs(soup);
            for (const Vec3& v : own.mesh.vertices)
                ASSERT_LT(on_theirs.closest_point(v).distance, 1e-6) << "seed " << seed;
            const MeshQuery on_own(soup_of(own.mesh));
            for (const Vec3& v : soup.vertices)
                ASSERT_LT(on_own.closest_point(v).distance, 1e-6) << "seed " << seed;
        }
    }
    EXPECT_GT(compared, 400);
}

#endif

} // namespace
} // namespace fppg
