#include "fppg/error.h"

#include "core/transforms.h"
#include "meshes/crowded_points.h"
#include "walls/layered_drawing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace fppg
{
namespace
{

using test::Drawing;
using test::relaxed;

constexpr double dp = Drawing::dp;

Drawing inside(bool is_2d = false)
{
    Drawing drawing(is_2d);
    drawing.def.fit.all->place = Placement::Inside;
    drawing.def.fit.all->depths_dp = {0.5};
    return drawing;
}

/// All particles of the mk that a drawing draws with.
std::vector<Vec3> particles_of(const RunField& field)
{
    std::vector<Vec3> out = field.walls.particles.positions;
    out.insert(out.end(), field.walls.volume.positions.begin(), field.walls.volume.positions.end());
    for (std::size_t x = 0; x < field.slabs.size(); ++x)
        for (const Run& run : field.slabs[x])
            for (std::uint32_t z = run.z_begin; z < run.z_end && !run.is_covered; ++z)
                out.push_back(field.grid.origin + dp * Vec3{static_cast<double>(x),
                                                            static_cast<double>(run.y),
                                                            static_cast<double>(z)});
    return out;
}

Vec3 centre_of(const std::vector<Vec3>& particles)
{
    Vec3 sum;
    for (const Vec3& p : particles) sum = sum + p;
    return sum / static_cast<double>(particles.size());
}

/// The mean square of the way from the centre along an axis, each particle a cube of dp.
double second_moment(const std::vector<Vec3>& particles, int axis)
{
    const Vec3 centre = centre_of(particles);
    double sum = 0;
    for (const Vec3& p : particles) sum += std::pow(p[axis] - centre[axis], 2);
    return sum / static_cast<double>(particles.size()) + dp * dp / 12;
}

double nearest_pair(const std::vector<Vec3>& particles)
{
    const std::vector<double> nearest = nearest_distances(particles, 2 * dp, 1);
    return *std::min_element(nearest.begin(), nearest.end());
}

/// The number is that of the volume, as near as a whole number can be.
void expect_volume(const std::vector<Vec3>& particles, double volume)
{
    EXPECT_NEAR(static_cast<double>(particles.size()), volume / std::pow(dp, 3), 1);
}

double depth_in_box(const Vec3& p, const Vec3& low, const Vec3& size)
{
    double depth = 1e9;
    for (int axis = 0; axis < 3; ++axis)
        depth = std::min({depth, p[axis] - low[axis], low[axis] + size[axis] - p[axis]});
    return depth;
}

TEST(InsideBody, OfABallHasItsVolumeCentreAndInertia)
{
    Drawing drawing = inside();
    const Vec3 centre{0.02, -0.03, 0.01};
    const double radius = 0.87;
    drawing.draw(SphereOp{centre, radius, {}});
    const RunField field = relaxed(drawing);
    const std::vector<Vec3> particles = particles_of(field);
    expect_volume(particles, 4.0 / 3 * std::numbers::pi * std::pow(radius, 3));
    EXPECT_LT(norm(centre_of(particles) - centre), 0.01 * dp);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(second_moment(particles, axis) / (radius * radius / 5), 1, 0.002);
    for (const Vec3& p : field.walls.particles.positions)
        EXPECT_NEAR(radius - norm(p - centre), 0.5 * dp, 1e-6 * dp);
    for (const Vec3& p : particles) EXPECT_GT(radius - norm(p - centre), 0.499 * dp);
    EXPECT_GT(nearest_pair(particles), 0.75 * dp);
}

TEST(InsideBody, OfABoxHasItsEdgesAndCorners)
{
    Drawing drawing = inside();
    const Vec3 low{-0.73, -0.57, -0.65};
    const Vec3 size{1.5, 1.2, 0.9};
    drawing.box(low, size);
    const std::vector<Vec3> particles = particles_of(relaxed(drawing));
    expect_volume(particles, size.x * size.y * size.z);
    EXPECT_LT(norm(centre_of(particles) - (low + 0.5 * size)), 0.01 * dp);
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(second_moment(particles, axis) / (size[axis] * size[axis] / 12), 1, 0.002);
    EXPECT_GT(nearest_pair(particles), 0.75 * dp);
    int corners = 0;
    for (const Vec3& p : particles)
    {
        EXPECT_GT(depth_in_box(p, low, size), 0.499 * dp);
        const Vec3 off = p - (low + 0.5 * size);
        corners += std::abs(std::abs(off.x) - 0.5 * size.x + 0.5 * dp) < 0.1 * dp &&
                           std::abs(std::abs(off.y) - 0.5 * size.y + 0.5 * dp) < 0.1 * dp &&
                           std::abs(std::abs(off.z) - 0.5 * size.z + 0.5 * dp) < 0.1 * dp
                       ? 1
                       : 0;
    }
    EXPECT_EQ(corners, 8);
}

TEST(InsideBody, HasItsVolumeFarFromTheOrigin)
{
    // As coordinates of maps are: four million dp to the north.
    const Vec3 far{5e5 * dp, 4e6 * dp, 0};
    const double radius = 0.37;
    for (const Vec3& at : {Vec3{}, far})
    {
        Drawing ball = inside();
        ball.def.grid.origin = ball.def.grid.origin + at;
        ball.draw(SphereOp{at + Vec3{0.02, -0.03, 0.01}, radius, {}});
        const std::vector<Vec3> of_ball = particles_of(relaxed(ball));
        expect_volume(of_ball, 4.0 / 3 * std::numbers::pi * std::pow(radius, 3));
        EXPECT_GT(nearest_pair(of_ball), 0.6 * dp);
        Drawing box = inside();
        box.def.grid.origin = box.def.grid.origin + at;
        box.box(at + Vec3{-0.43, -0.37, -0.45}, {0.9, 0.8, 0.6});
        const std::vector<Vec3> of_box = particles_of(relaxed(box));
        expect_volume(of_box, 0.9 * 0.8 * 0.6);
        EXPECT_GT(nearest_pair(of_box), 0.6 * dp);
    }
}

/// Heights of sheets, from the middle of a plate of thickness t.
struct Plate
{
    double thickness;
    int across; ///< 0: as many as it is dp thick
    int sheets;
};

class InsidePlate : public testing::TestWithParam<Plate>
{
};

TEST_P(InsidePlate, HasWholeSheetsOfItsVolume)
{
    const Plate plate = GetParam();
    Drawing drawing = inside();
    if (plate.across > 0) drawing.def.fit.all->across = plate.across;
    const Vec3 low{-0.91, -0.73, -0.037};
    const Vec3 size{1.77, 1.52, plate.thickness};
    drawing.box(low, size);
    const RunField field = relaxed(drawing);
    const std::vector<Vec3> particles = particles_of(field);
    expect_volume(particles, size.x * size.y * size.z);
    EXPECT_EQ(field.walls.bodies[0].sheets, plate.sheets);
    std::vector<int> count(static_cast<std::size_t>(plate.sheets), 0);
    for (const Vec3& p : particles)
    {
        const Vec3 off = p - (low + 0.5 * size);
        // Particles at the rim stand between the sheets as well.
        if (std::abs(off.x) > 0.5 * size.x - 1.8 * dp || std::abs(off.y) > 0.5 * size.y - 1.8 * dp)
            continue;
        const double at = (p.z - low.z) / size.z * plate.sheets - 0.5;
        const double sheet = std::round(at);
        ASSERT_GE(sheet, 0);
        ASSERT_LT(sheet, plate.sheets);
        EXPECT_NEAR(at, sheet, 0.1) << p.z;
        ++count[static_cast<std::size_t>(sheet)];
    }
    const double of_sheet = (size.x - 3.6 * dp) * (size.y - 3.6 * dp) * size.z / plate.sheets;
    // Rows are cut by the border of what is counted.
    for (const int n : count) EXPECT_NEAR(n * std::pow(dp, 3) / of_sheet, 1, 0.15);
    EXPECT_GT(nearest_pair(particles), 0.6 * dp);
}

INSTANTIATE_TEST_SUITE_P(Thickness, InsidePlate,
                         testing::Values(Plate{0.1, 0, 1}, Plate{0.117, 0, 1}, Plate{0.2, 0, 2},
                                         Plate{0.23, 0, 2}, Plate{0.3, 0, 3}, Plate{0.38, 0, 4},
                                         Plate{0.2, 3, 3}),
                         [](const auto& plate)
                         {
                             return "Of" +
                                    std::to_string(std::lround(1000 * plate.param.thickness)) +
                                    "In" + std::to_string(plate.param.sheets);
                         });

TEST(InsideBody, In2DHasTheAreaOfItsSection)
{
    Drawing drawing = inside(true);
    const Vec3 low{-0.93, -1, -0.37};
    const Vec3 size{1.77, 2, 0.81};
    drawing.box(low, size);
    const std::vector<Vec3> particles = particles_of(relaxed(drawing));
    EXPECT_NEAR(static_cast<double>(particles.size()), size.x * size.z / (dp * dp), 1);
    for (const Vec3& p : particles)
    {
        EXPECT_EQ(p.y, 0);
        EXPECT_GT(std::min({p.x - low.x, low.x + size.x - p.x, p.z - low.z, low.z + size.z - p.z}),
                  0.499 * dp);
    }
    EXPECT_GT(nearest_pair(particles), 0.7 * dp);
}

TEST(InsideBody, In2DHasTheCentreAndTheInertiaOfItsSection)
{
    Drawing drawing = inside(true);
    const Vec3 low{-0.83, -1, -0.31};
    const Vec3 size{1.57, 2, 0.77};
    PolyhedronOp box = make_box(low, size, {true, true, true, true, true, true}, true, {}, dp)[0];
    const Transform turn = rotation({0, 1, 0}, 0.3);
    transform_polyhedron(box, turn);
    drawing.draw(box);
    std::vector<Vec3> particles = particles_of(relaxed(drawing));
    const Transform back = rotation({0, 1, 0}, -0.3);
    for (Vec3& p : particles)
    {
        EXPECT_EQ(p.y, 0);
        p = back(p);
    }
    Vec3 middle = low + 0.5 * size;
    middle.y = 0;
    EXPECT_LT(norm(centre_of(particles) - middle), 0.01 * dp);
    for (const int axis : {0, 2})
        EXPECT_NEAR(second_moment(particles, axis) / (size[axis] * size[axis] / 12), 1, 0.002);
    EXPECT_GT(nearest_pair(particles), 0.7 * dp);
}

/// The particles of a beam of 2 x 0.5 in the plane that is turned, turned back.
std::vector<Vec3> beam(double angle, std::optional<int> sheets)
{
    Drawing drawing = inside(true);
    drawing.def.fit.all->across = sheets;
    const Transform turn = rotation({0, 1, 0}, angle);
    PolyhedronOp box = make_box({-0.97, -1, -0.23}, {2, 2, 0.5},
                                {true, true, true, true, true, true}, true, {}, dp)[0];
    transform_polyhedron(box, turn);
    drawing.draw(box);
    std::vector<Vec3> particles = particles_of(relaxed(drawing));
    const Transform back = rotation({0, 1, 0}, -angle);
    for (Vec3& p : particles)
    {
        EXPECT_EQ(p.y, 0); // the solver makes more of 1e-18
        p = back(p);
    }
    return particles;
}

TEST(InsideBody, OfABeamIsTheSameLatticeHoweverItIsTurned)
{
    for (const double angle : {0.0, 0.3, 1.2})
    {
        const std::vector<Vec3> particles = beam(angle, {});
        ASSERT_EQ(particles.size(), 100U);
        for (const Vec3& p : particles)
        {
            const double x = (p.x + 0.92) / dp, z = (p.z + 0.18) / dp;
            EXPECT_LT(std::abs(x - std::round(x)), 0.12);
            EXPECT_LT(std::abs(z - std::round(z)), 0.12);
        }
    }
}

TEST(InsideBody, OfABeamHasAsManyWholeSheetsAsAreAskedFor)
{
    for (const double angle : {0.0, 0.5})
    {
        const std::vector<Vec3> particles = beam(angle, 5);
        EXPECT_EQ(particles.size(), 100U);
        EXPECT_GT(nearest_pair(particles), 0.85 * dp);
        for (const Vec3& p : particles)
        {
            const double z = (p.z + 0.18) / dp;
            EXPECT_LT(std::abs(z - std::round(z)), 0.15);
        }
    }
}

TEST(InsideBody, IsTheSameWithAnyNumberOfThreads)
{
    Drawing drawing = inside();
    drawing.draw(SphereOp{{0.02, -0.03, 0.01}, 0.6, {}});
    drawing.box({0.83, -0.7, -0.6}, {0.21, 1.3, 1.1});
    const std::vector<Vec3> one = particles_of(relaxed(drawing, 1));
    for (const int threads : {2, 16}) EXPECT_EQ(particles_of(relaxed(drawing, threads)), one);
}

TEST(InsideBody, OfAHollowOrAnOpenShapeIsRefused)
{
    Drawing hollow = inside();
    hollow.state.mode = DrawMode::Face;
    hollow.draw(SphereOp{{0, 0, 0}, 0.6, {}});
    EXPECT_THROW(hollow.run(), GeometryError);
    Drawing open = inside();
    open.draw(make_box({-0.5, -0.5, -0.5}, {1, 1, 1}, {true, true, true, true, true, false}, false,
                       {}, dp)[0]);
    EXPECT_THROW(open.run(), GeometryError);
}

/// Without place="inside": what the particles of a wall and the nodes stand for.
class VolumeKept : public testing::TestWithParam<double>
{
};

TEST_P(VolumeKept, WhileAPlateIsRelaxed)
{
    Drawing drawing;
    const Vec3 size{1.77, 1.52, GetParam()};
    drawing.box({-0.91, -0.73, -0.037}, size);
    const RunField field = relaxed(drawing);
    const double volume = size.x * size.y * size.z;
    double walls = 0; // on faces one half is inside, on edges a quarter, on corners an eighth
    for (const FitKind kind : field.walls.particles.kinds)
        walls += kind == FitKind::Surface ? 0.5 : kind == FitKind::Edge ? 0.25 : 0.125;
    const double nodes = static_cast<double>(particles_of(field).size()) -
                         static_cast<double>(field.walls.particles.size());
    EXPECT_NEAR((walls + nodes) * std::pow(dp, 3) / volume, 1, 0.005);
    EXPECT_NEAR(
        (field.walls.bodies[0].measures.node_volume + field.walls.bodies[0].measures.wall_volume) /
            volume,
        1, 0.005);
}

INSTANTIATE_TEST_SUITE_P(Thickness, VolumeKept, testing::Values(0.2, 0.25, 0.3, 0.41, 0.77));

} // namespace
} // namespace fppg
