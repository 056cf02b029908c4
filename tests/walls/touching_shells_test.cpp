#include "walls/touching_shells.h"

#include <gtest/gtest.h>

#include "meshes/test_shapes.h"

namespace fppg
{
namespace
{

using test::box;
using test::inverted;
using test::joined;

constexpr double dp = 0.05;

/// The same box with the other diagonal in each face.
TriangleSoup with_other_diagonals(const TriangleSoup& soup)
{
    TriangleSoup out;
    for (std::size_t i = 0; i + 5 < soup.vertices.size(); i += 6)
    {
        const Vec3* p = &soup.vertices[i];
        test::add_quad(out, p[1], p[2], p[5], p[0]);
    }
    return out;
}

struct United
{
    explicit United(const TriangleSoup& soup)
    {
        mesh = repair_mesh(soup, {.dp = dp, .is_solid = true}, 2, report);
        unite_touching_shells(mesh, report, dp, 2);
    }
    bool says_that_parts_touch() const
    {
        for (const std::string& warning : report.warnings)
            if (warning.find("touch face to face") != std::string::npos) return true;
        return false;
    }
    SurfaceMesh mesh;
    MeshReport report;
};

TEST(TouchingShells, AreOneBodyHoweverTheSharedFaceIsMeshed)
{
    const TriangleSoup left = box({0, 0, 0}, {1, 1, 1});
    for (const double gap : {0.0, 1e-6, -1e-6, 1e-4})
        for (const bool is_other : {false, true})
        {
            TriangleSoup right = box({1 + gap, 0, 0}, {2, 1, 1});
            if (is_other) right = with_other_diagonals(right);
            const United united(joined(left, right));
            EXPECT_NEAR(united.report.volume, 2, 3e-4) << gap << is_other;
            EXPECT_NEAR(united.report.area, 10, 1e-3) << gap << is_other;
            EXPECT_EQ(united.report.open_edges, 0u) << gap << is_other;
        }
}

TEST(TouchingShells, LoseThePartOfAFaceThatTheyShare)
{
    const United united(joined(box({0, 0, 0}, {1, 1, 1}), box({1, 0.3, 0.2}, {2, 0.7, 0.8})));
    EXPECT_TRUE(united.says_that_parts_touch());
    EXPECT_NEAR(united.report.volume, 1.24, 1e-9);
    EXPECT_NEAR(united.report.area, 6 + 2.48 - 2 * 0.24, 1e-9);
    EXPECT_EQ(united.report.open_edges, 0u);
    EXPECT_EQ(united.report.shells, 1u);
}

TEST(TouchingShells, StayApartWhereTheyOnlyComeNearOrShareAnEdge)
{
    const TriangleSoup left = box({0, 0, 0}, {1, 0.5, 0.5});
    for (const TriangleSoup& right : {box({1.002, 0, 0}, {2, 1, 1}), box({1, 0.5, 0.5}, {2, 1, 1})})
    {
        const United united(joined(left, right));
        EXPECT_FALSE(united.says_that_parts_touch());
        EXPECT_EQ(united.mesh.facets.size(), 24u);
    }
}

TEST(TouchingShells, LeaveCavitiesAlone)
{
    const TriangleSoup hollow =
        joined(box({0, 0, 0}, {1, 1, 1}), inverted(box({0.2, 0.2, 0.2}, {0.8, 0.8, 0.8})));
    const United united(joined(hollow, with_other_diagonals(box({1, 0, 0}, {2, 1, 1}))));
    EXPECT_NEAR(united.report.volume, 2 - 0.216, 1e-9);
    EXPECT_NEAR(united.report.area, 10 + 6 * 0.36, 1e-9);
}

} // namespace
} // namespace fppg
