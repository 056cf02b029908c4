#include "files/helpers.h"
#include "files/vtk_reader.h"
#include "helpers/dense_grid.h"

#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <array>
#include <cmath>
#include <map>

namespace fppg
{

namespace
{

constexpr double test_dp = 0.1;
const Vec3 test_origin{-0.3, 0.2, 1.1};

/// mk of every node of a box, 0 void; x slowest, z fastest.
struct NodeField
{
    std::array<int, 3> n{};
    std::vector<int> mk;

    int at(int x, int y, int z) const
    {
        if (x < 0 || y < 0 || z < 0 || x >= n[0] || y >= n[1] || z >= n[2]) return 0;
        const int at = (x * n[1] + y) * n[2] + z;
        return mk[static_cast<std::size_t>(at)];
    }
};

RunField run_field(const NodeField& nodes, bool is_2d = false)
{
    RunField field;
    field.grid.origin = test_origin;
    field.grid.dp = test_dp;
    field.grid.is_2d = is_2d;
    for (std::size_t axis = 0; axis < 3; ++axis)
        field.grid.n[axis] = static_cast<std::uint32_t>(nodes.n[axis]);
    field.slabs.resize(field.grid.n[0]);
    for (int x = 0; x < nodes.n[0]; ++x)
        for (int y = 0; y < nodes.n[1]; ++y)
            for (int z = 0; z < nodes.n[2];)
            {
                int end = z + 1;
                while (end < nodes.n[2] && nodes.at(x, y, end) == nodes.at(x, y, z)) ++end;
                if (nodes.at(x, y, z) != 0)
                    field.slabs[static_cast<std::size_t>(x)].push_back(
                        {static_cast<std::uint32_t>(y), static_cast<std::uint32_t>(z),
                         static_cast<std::uint32_t>(end),
                         static_cast<std::uint16_t>(nodes.at(x, y, z) & ~test::covered),
                         (nodes.at(x, y, z) & test::covered) != 0});
                z = end;
            }
    return field;
}

std::string vtk_of(const RunField& field, int threads = 1)
{
    std::vector<ParticleType> type_of_mk(65536, ParticleType::Fixed);
    type_of_mk[1] = ParticleType::Fluid;
    return written([&](OutputFile& file) { write_cells_vtk(file, field, type_of_mk, threads); });
}

/// How often a unit face is drawn: cell (x, y, z), axis, whether it looks up, mk.
using UnitFaces = std::map<std::array<int, 6>, int>;

UnitFaces brute_force_faces(const NodeField& nodes)
{
    UnitFaces faces;
    for (int x = 0; x < nodes.n[0]; ++x)
        for (int y = 0; y < nodes.n[1]; ++y)
            for (int z = 0; z < nodes.n[2]; ++z)
                for (int axis = 0; axis < 3; ++axis)
                    for (const int up : {0, 1})
                    {
                        const int step = up ? 1 : -1;
                        const int mk = nodes.at(x, y, z);
                        const int other =
                            nodes.at(x + (axis == 0 ? step : 0), y + (axis == 1 ? step : 0),
                                     z + (axis == 2 ? step : 0));
                        if (mk != 0 && mk != other) ++faces[{x, y, z, axis, up, mk}];
                    }
    return faces;
}

/// Cuts the rectangles into unit faces; checks that each is 0.001 dp inside its cell and that its
/// normal looks out of it.
UnitFaces drawn_faces(const VtkFile& file)
{
    UnitFaces faces;
    const std::vector<int>& polygons = file.cells.at("POLYGONS");
    for (std::size_t q = 0; q < polygons.size() / 5; ++q)
    {
        std::array<Vec3, 4> p;
        Box3 box;
        for (std::size_t i = 0; i < 4; ++i)
        {
            const auto v = static_cast<std::size_t>(polygons[5 * q + 1 + i]);
            for (int axis = 0; axis < 3; ++axis)
                p[i][axis] =
                    (file.points[3 * v + static_cast<std::size_t>(axis)] - test_origin[axis]) /
                        test_dp +
                    0.5;
            box.add(p[i]);
        }
        const Vec3 normal = cross(p[1] - p[0], p[2] - p[0]);
        const int axis = std::abs(normal.x) > 0.5 ? 0 : std::abs(normal.y) > 0.5 ? 1 : 2;
        const int up = normal[axis] > 0 ? 1 : 0;
        const double plane = box.min[axis];
        EXPECT_NEAR(plane - std::round(plane), up ? -0.001 : 0.001, 1e-4);
        std::array<int, 3> low{};
        std::array<int, 3> high{};
        for (int a = 0; a < 3; ++a)
        {
            low[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(box.min[a]));
            high[static_cast<std::size_t>(a)] = static_cast<int>(std::lround(box.max[a]));
        }
        const auto own = static_cast<std::size_t>(axis);
        low[own] -= up;
        high[own] = low[own] + 1;
        for (int x = low[0]; x < high[0]; ++x)
            for (int y = low[1]; y < high[1]; ++y)
                for (int z = low[2]; z < high[2]; ++z)
                    ++faces[{x, y, z, axis, up, static_cast<int>(file.arrays.at("Mk")[q])}];
    }
    return faces;
}

NodeField random_field(int n_y)
{
    NodeField nodes;
    nodes.n = {*rc::gen::inRange(1, 7), n_y, *rc::gen::inRange(1, 7)};
    const int count = nodes.n[0] * nodes.n[1] * nodes.n[2];
    const auto size = static_cast<std::size_t>(count);
    nodes.mk = *rc::gen::container<std::vector<int>>(
        size, rc::gen::weightedElement<int>({{3, 0}, {3, 1}, {2, 10}, {1, 11}}));
    return nodes;
}

RC_GTEST_PROP(WriteCellsVtk, DrawsEachFaceBetweenDifferentMkOnce, ())
{
    const NodeField nodes = random_field(*rc::gen::inRange(1, 7));
    const VtkFile file(vtk_of(run_field(nodes)));
    RC_ASSERT(drawn_faces(file) == brute_force_faces(nodes));
}

RC_GTEST_PROP(WriteCellsVtk, DrawsTheAreasOfTwoDimensionalCells, ())
{
    const NodeField nodes = random_field(1);
    const VtkFile file(vtk_of(run_field(nodes, true)));
    UnitFaces expected;
    for (int x = 0; x < nodes.n[0]; ++x)
        for (int z = 0; z < nodes.n[2]; ++z)
            if (nodes.at(x, 0, z) != 0) ++expected[{x, z, nodes.at(x, 0, z)}];
    UnitFaces drawn;
    const std::vector<int>& polygons = file.cells.at("POLYGONS");
    for (std::size_t q = 0; q < polygons.size() / 5; ++q)
    {
        Box3 box;
        for (std::size_t i = 0; i < 4; ++i)
        {
            const auto v = 3 * static_cast<std::size_t>(polygons[5 * q + 1 + i]);
            box.add({file.points[v], file.points[v + 1], file.points[v + 2]});
        }
        RC_ASSERT(std::abs(box.min.y - 0.2001) < 1e-6 && box.min.y == box.max.y);
        const auto cell = [](double value, double origin)
        { return static_cast<int>(std::lround((value - origin) / test_dp + 0.5)); };
        for (int x = cell(box.min.x, test_origin.x); x < cell(box.max.x, test_origin.x); ++x)
            for (int z = cell(box.min.z, test_origin.z); z < cell(box.max.z, test_origin.z); ++z)
                ++drawn[{x, z, static_cast<int>(file.arrays.at("Mk")[q])}];
    }
    RC_ASSERT(drawn == expected);
}

TEST(WriteCellsVtk, DrawsNodesInTheZoneOfAWallAsThoseOfItsMk)
{
    NodeField nodes;
    nodes.n = {4, 5, 6};
    nodes.mk.resize(120);
    for (std::size_t i = 0; i < 120; ++i) nodes.mk[i] = std::array{0, 1, 1, 11, 11, 11}[i * 7 % 6];
    NodeField zoned = nodes;
    for (std::size_t i = 0; i < 120; i += 4)
        if (zoned.mk[i] != 0) zoned.mk[i] |= test::covered;
    RunField field = run_field(zoned);
    field.walls.bodies.emplace_back();
    EXPECT_TRUE(vtk_of(field) == vtk_of(run_field(nodes)));
}

TEST(WriteCellsVtk, DrawsABoxWithSixRectangles)
{
    NodeField nodes{{5, 4, 3}, std::vector<int>(60, 1)};
    const VtkFile file(vtk_of(run_field(nodes)));
    EXPECT_EQ(file.arrays.at("Mk"), std::vector<double>(6, 1));
    EXPECT_EQ(file.arrays.at("Type"), std::vector<double>(6, 3));
    EXPECT_EQ(file.types.at("Mk"), "unsigned_short");
}

TEST(WriteCellsVtk, DrawsNothingOfAnEmptyField)
{
    const VtkFile file(vtk_of(run_field({{2, 2, 2}, std::vector<int>(8, 0)})));
    EXPECT_TRUE(file.points.empty());
}

TEST(WriteCellsVtk, GivesTheSameBytesForAnyNumberOfThreads)
{
    NodeField nodes{{300, 12, 12}, {}};
    for (int x = 0; x < 300; ++x)
        for (int y = 0; y < 12; ++y)
            for (int z = 0; z < 12; ++z)
                nodes.mk.push_back((x * 7 + y * y + z * z) % 90 < 40 ? 10 : 0);
    const RunField field = run_field(nodes);
    const std::string one = vtk_of(field, 1);
    EXPECT_TRUE(one == vtk_of(field, 8));
    EXPECT_EQ(drawn_faces(VtkFile(one)), brute_force_faces(nodes));
}

} // namespace

} // namespace fppg
