#include <array>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "meshes/spans_helpers.h"
#include "meshes/test_shapes.h"

namespace fppg
{

namespace
{

using Point = std::array<std::int64_t, 3>;
using Tetrahedron = std::array<Point, 4>;

/// Six times the signed volume; exact.
std::int64_t volume(const Point& a, const Point& b, const Point& c, const Point& d)
{
    const auto e = [&d](const Point& p, std::size_t axis) { return p[axis] - d[axis]; };
    return e(a, 0) * (e(b, 1) * e(c, 2) - e(b, 2) * e(c, 1)) +
           e(a, 1) * (e(b, 2) * e(c, 0) - e(b, 0) * e(c, 2)) +
           e(a, 2) * (e(b, 0) * e(c, 1) - e(b, 1) * e(c, 0));
}

/// The four-plane test: inside or on the border if no facet has the point strictly outside.
bool contains(const Tetrahedron& t, const Point& p)
{
    return volume(p, t[1], t[2], t[3]) >= 0 && volume(t[0], p, t[2], t[3]) >= 0 &&
           volume(t[0], t[1], p, t[3]) >= 0 && volume(t[0], t[1], t[2], p) >= 0;
}

/// A tetrahedron of positive volume with corners in [-size, size].
Tetrahedron any_tetrahedron(std::int64_t size)
{
    const auto to_tetrahedron = [](const std::vector<std::int64_t>& numbers)
    {
        Tetrahedron t;
        for (std::size_t i = 0; i < 12; ++i) t[i / 3][i % 3] = numbers[i];
        return t;
    };
    const auto volume_of = [](const Tetrahedron& t) { return volume(t[0], t[1], t[2], t[3]); };
    // The whole range is used from the first case on: small ranges yield hardly any volume.
    const auto coordinate =
        rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(-size, size + 1));
    Tetrahedron t = *rc::gen::suchThat(
        rc::gen::map(rc::gen::container<std::vector<std::int64_t>>(12, coordinate), to_tetrahedron),
        [&](const Tetrahedron& candidate) { return volume_of(candidate) != 0; });
    if (volume_of(t) < 0) std::swap(t[2], t[3]);
    return t;
}

void add(TriangleSoup& soup, const Tetrahedron& t)
{
    std::array<Vec3, 4> p;
    for (std::size_t i = 0; i < 4; ++i)
        p[i] = {static_cast<double>(t[i][0]), static_cast<double>(t[i][1]),
                static_cast<double>(t[i][2])};
    test::add_facet(soup, p[0], p[1], p[2]);
    test::add_facet(soup, p[0], p[3], p[1]);
    test::add_facet(soup, p[0], p[2], p[3]);
    test::add_facet(soup, p[1], p[3], p[2]);
}

/// Compares the closed tetrahedra, moved by `offset`, with all nodes of the lattice around them
/// that are multiples of `step` away from `offset`.
void check_union(std::vector<Tetrahedron> parts, std::int64_t size, std::int64_t step,
                 const Point& offset = {0, 0, 0})
{
    TriangleSoup soup;
    for (Tetrahedron& part : parts)
    {
        for (Point& p : part)
            for (std::size_t axis = 0; axis < 3; ++axis) p[axis] += offset[axis];
        add(soup, part);
    }
    const std::int64_t half = size / step + 1;
    const auto low = [&](std::size_t axis)
    { return static_cast<double>(offset[axis] - half * step); };
    const LatticeGrid grid = test::cube_grid({low(0), low(1), low(2)}, static_cast<double>(step),
                                             static_cast<std::uint32_t>(2 * half + 1));
    const std::vector<bool> nodes = test::nodes_of(inside_spans(soup, grid, 1), grid);
    std::size_t at = 0;
    std::size_t wrong = 0;
    for (std::int64_t i = -half; i <= half; ++i)
        for (std::int64_t j = -half; j <= half; ++j)
            for (std::int64_t k = -half; k <= half; ++k, ++at)
            {
                bool is_inside = false;
                for (const Tetrahedron& part : parts)
                    is_inside =
                        is_inside || contains(part, {offset[0] + i * step, offset[1] + j * step,
                                                     offset[2] + k * step});
                wrong += nodes[at] != is_inside ? 1 : 0;
            }
    RC_ASSERT(wrong == 0u);
}

} // namespace

RC_GTEST_PROP(InsideSpansProperty, TetrahedronWithCornersOnNodesIsClosed, ())
{
    check_union({any_tetrahedron(4)}, 4, 1);
}

RC_GTEST_PROP(InsideSpansProperty, TetrahedraThatTouchAndOverlapAreJoined, ())
{
    check_union({any_tetrahedron(2), any_tetrahedron(2), any_tetrahedron(2)}, 2, 1);
}

RC_GTEST_PROP(InsideSpansProperty, TetrahedronOfAnyShapeIsFound, ())
{
    check_union({any_tetrahedron(1000)}, 1000, 101);
}

RC_GTEST_PROP(InsideSpansProperty, TetrahedronFarFromTheOriginIsClosed, ())
{
    check_union({any_tetrahedron(4)}, 4, 1, {1000003, -2000003, 500009});
}

} // namespace fppg
