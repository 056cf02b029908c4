#pragma once

#include <array>
#include <stdexcept>
#include <string>

#include "fppg/error.h"
#include "fppg/new_case.h"
#include "helpers/case_text.h"
#include "helpers/gears.h"
#include "meshes/test_shapes.h"

namespace fppg::test
{

/// A box with a cavity, and perhaps without its lid; metres.
inline TriangleSoup housing(const Vec3& low, const Vec3& high, double wall, bool is_open = false)
{
    TriangleSoup soup = box(low, high);
    const Vec3 by{wall, wall, wall};
    Vec3 top = high - by;
    if (is_open) top.z = high.z;
    TriangleSoup inner = box(low + by, top);
    for (std::size_t f = 0; f < inner.size(); ++f)
        std::swap(inner.vertices[3 * f + 1], inner.vertices[3 * f + 2]);
    if (is_open)
    {
        // A basin: the bottom and four sides of both boxes, and the rim between them.
        const auto without_top = [](const TriangleSoup& from, double z)
        {
            TriangleSoup out;
            for (std::size_t f = 0; f < from.size(); ++f)
            {
                const Vec3* c = &from.vertices[3 * f];
                if (c[0].z == z && c[1].z == z && c[2].z == z) continue;
                out.vertices.insert(out.vertices.end(), c, c + 3);
            }
            return out;
        };
        soup = without_top(soup, high.z);
        inner = without_top(inner, high.z);
        const Vec3 a = low + by;
        const std::array<Vec3, 4> outer{Vec3{low.x, low.y, high.z}, Vec3{high.x, low.y, high.z},
                                        Vec3{high.x, high.y, high.z}, Vec3{low.x, high.y, high.z}};
        const std::array<Vec3, 4> rim{Vec3{a.x, a.y, high.z}, Vec3{top.x, a.y, high.z},
                                      Vec3{top.x, top.y, high.z}, Vec3{a.x, top.y, high.z}};
        for (std::size_t i = 0; i < 4; ++i)
            add_quad(soup, outer[i], outer[(i + 1) % 4], rim[(i + 1) % 4], rim[i]);
    }
    soup.vertices.insert(soup.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    return soup;
}

/// Two gears of 20 and 30 teeth that mesh, about z, in a housing; millimetres in the files.
class GearboxParts
{
public:
    explicit GearboxParts(double distance = 0.05, bool is_open = false)
    {
        const GearShape a{.teeth = 20, .backlash = 0.0004};
        const GearShape b{.teeth = 30, .backlash = 0.0004, .turned_deg = 6};
        write_stl(folder / "pinion.stl", gear_mesh(a), 1000);
        write_stl(folder / "wheel.stl", gear_mesh(b, {distance, 0, 0}), 1000);
        write_stl(folder / "housing.stl",
                  housing({-0.03, -0.042, -0.02}, {0.092, 0.042, 0.02}, 0.004, is_open), 1000);
        options.inputs = {folder.path().string()};
        options.output = folder / "Case_Def.xml";
        options.rotations = {"pinion=3000deg/s"};
        options.fill = "oil=0.1l@housing";
        options.particles = 40000;
    }

    TemporaryFolder folder;
    NewCaseOptions options;
};

inline const Proposal& proposal(const NewCase& made, const std::string& what)
{
    for (const Proposal& p : made.proposals)
        if (p.what == what) return p;
    throw std::runtime_error("no proposal of " + what);
}

inline std::string fault_of(const NewCaseOptions& options)
{
    try
    {
        (void)propose_case(options);
    }
    catch (const Error& error)
    {
        return error.what();
    }
    return "";
}

} // namespace fppg::test
