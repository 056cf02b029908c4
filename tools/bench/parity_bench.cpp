// Which lattice nodes lie inside a closed mesh: our exact rows along columns against rays of Embree
// along the same columns, with its own triangles in float and with boxes whose facets are cut in
// double (MeshQuery). One run, one thread; a table for a page.
//
//   parity_bench [NODES_ALONG_AN_AXIS]      default 300
//
// The body is a lumpy ball. Its rings of vertices lie on rows of nodes, so that rays meet edges and
// vertices, as they do in drawings with round numbers.

#include "fppg/shapes.h"
#include "meshes/embree.h"
#include "meshes/mesh_query.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

namespace
{

using fppg::Vec3;

constexpr double pi = std::numbers::pi;

double seconds_since(std::clock_t start)
{
    return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Resident memory of this process now, MB.
double memory_mb()
{
    std::ifstream file("/proc/self/statm");
    double pages = 0;
    file >> pages >> pages;
    return pages * 4096e-6;
}

/// A ball of radius 0.7 to 1.1 with so many rings of twice as many quads.
fppg::TriangleSoup lumpy_ball(int rings)
{
    const auto corner = [&](int ring, int step)
    {
        const double theta = pi * ring / rings;
        const double phi = pi * step / rings;
        const double r = 0.9 + 0.1 * std::sin(5 * theta) * std::cos(3 * phi);
        return Vec3{r * std::sin(theta) * std::cos(phi), r * std::sin(theta) * std::sin(phi),
                    r * std::cos(theta)};
    };
    fppg::TriangleSoup soup;
    for (int ring = 0; ring < rings; ++ring)
        for (int step = 0; step < 2 * rings; ++step)
        {
            const int next = (step + 1) % (2 * rings);
            const Vec3 a = corner(ring, step);
            const Vec3 b = corner(ring + 1, step);
            const Vec3 c = corner(ring + 1, next);
            const Vec3 d = corner(ring, next);
            if (ring + 1 < rings) soup.vertices.insert(soup.vertices.end(), {a, b, c});
            if (ring > 0) soup.vertices.insert(soup.vertices.end(), {a, c, d});
        }
    return soup;
}

/// Marks the nodes of a column between crossings at odd and even places.
void mark(std::vector<double>& heights, const fppg::LatticeGrid& grid, char* column)
{
    std::sort(heights.begin(), heights.end());
    for (std::size_t i = 0; i + 1 < heights.size(); i += 2)
        for (std::uint32_t z = 0; z < grid.n[2]; ++z)
        {
            const double height = grid.origin.z + z * grid.dp;
            if (height >= heights[i] && height <= heights[i + 1]) column[z] = 1;
        }
}

struct HitList : fppg::EmbreeRayContext
{
    std::vector<double>* heights = nullptr;
};

/// Embree's triangles in float: every hit along the ray is noted and passed.
class FloatRays
{
public:
    explicit FloatRays(const fppg::TriangleSoup& soup)
        : device_(rtcNewDevice("threads=1")), scene_(rtcNewScene(device_))
    {
        rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corners = static_cast<float*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    3 * sizeof(float), soup.vertices.size()));
        auto* facets = static_cast<unsigned*>(
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    3 * sizeof(unsigned), soup.size()));
        for (std::size_t i = 0; i < soup.vertices.size(); ++i)
        {
            for (int axis = 0; axis < 3; ++axis)
                corners[3 * i + static_cast<std::size_t>(axis)] =
                    static_cast<float>(soup.vertices[i][axis]);
            facets[i] = static_cast<unsigned>(i);
        }
        rtcSetGeometryIntersectFilterFunction(geometry, note_hit);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene_, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene_);
    }
    ~FloatRays()
    {
        rtcReleaseScene(scene_);
        rtcReleaseDevice(device_);
    }
    FloatRays(const FloatRays&) = delete;
    FloatRays& operator=(const FloatRays&) = delete;

    void heights(double x, double y, std::vector<double>& out) const
    {
        HitList context;
        context.heights = &out;
        RTCRayHit ray{};
        ray.ray.org_x = static_cast<float>(x);
        ray.ray.org_y = static_cast<float>(y);
        ray.ray.org_z = -2;
        ray.ray.dir_z = 1;
        ray.ray.tfar = 4;
        ray.ray.mask = ~0U;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        fppg::embree_intersect(scene_, context, ray);
    }

private:
    static void note_hit(const RTCFilterFunctionNArguments* arguments)
    {
        const auto& context = *static_cast<const HitList*>(
            static_cast<const fppg::EmbreeRayContext*>(arguments->context));
        context.heights->push_back(
            static_cast<double>(RTCRayN_tfar(arguments->ray, arguments->N, 0)) - 2);
        arguments->valid[0] = 0;
    }

    RTCDevice device_;
    RTCScene scene_;
};

std::size_t count_wrong(const std::vector<char>& nodes, const std::vector<char>& exact)
{
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < nodes.size(); ++i) wrong += nodes[i] != exact[i] ? 1 : 0;
    return wrong;
}

void print_row(std::size_t facets, const char* method, double build, double columns, double mb,
               std::size_t wrong)
{
    std::printf("| %zu | %s | %.2f | %.2f | %.0f | %zu |\n", facets, method, build, columns, mb,
                wrong);
}

/// The nodes inside by rays along z, one a column. `heights(x, y, out)` gives the crossings.
template <typename Heights>
std::vector<char> nodes_by_rays(const fppg::LatticeGrid& grid, const Heights& heights)
{
    std::vector<char> nodes(std::size_t{grid.n[0]} * grid.n[1] * grid.n[2], 0);
    std::vector<double> found;
    for (std::uint32_t x = 0; x < grid.n[0]; ++x)
        for (std::uint32_t y = 0; y < grid.n[1]; ++y)
        {
            found.clear();
            heights(grid.origin.x + x * grid.dp, grid.origin.y + y * grid.dp, found);
            mark(found, grid, &nodes[(std::size_t{x} * grid.n[1] + y) * grid.n[2]]);
        }
    return nodes;
}

void compare(int rings, const fppg::LatticeGrid& grid)
{
    const fppg::TriangleSoup soup = lumpy_ball(rings);
    double before = memory_mb();
    auto start = std::clock();
    const fppg::SpanSet spans = fppg::inside_spans(soup, grid, 1);
    const double exact_seconds = seconds_since(start);
    print_row(soup.size(), "exact rows (inside_spans)", 0, exact_seconds, memory_mb() - before, 0);
    std::vector<char> exact(std::size_t{grid.n[0]} * grid.n[1] * grid.n[2], 0);
    for (std::size_t slab = 0; slab < spans.slabs.size(); ++slab)
        for (const fppg::Span& span : spans.slabs[slab])
            for (std::uint32_t z = span.z_begin; z < span.z_end; ++z)
                exact[((spans.x_begin + slab) * grid.n[1] + span.y) * grid.n[2] + z] = 1;
    {
        before = memory_mb();
        start = std::clock();
        const FloatRays rays(soup);
        const double build = seconds_since(start);
        const double mb = memory_mb() - before;
        start = std::clock();
        const auto nodes = nodes_by_rays(
            grid, [&](double x, double y, std::vector<double>& out) { rays.heights(x, y, out); });
        print_row(soup.size(), "Embree, triangles in float", build, seconds_since(start), mb,
                  count_wrong(nodes, exact));
    }
    before = memory_mb();
    start = std::clock();
    const fppg::MeshQuery query(soup, 1);
    const double build = seconds_since(start);
    const double mb = memory_mb() - before;
    start = std::clock();
    const auto nodes = nodes_by_rays(grid,
                                     [&](double x, double y, std::vector<double>& out)
                                     {
                                         for (const auto& c : query.crossings({x, y, -2}, 2))
                                             out.push_back(c.position);
                                     });
    print_row(soup.size(), "Embree, boxes cut in double (MeshQuery)", build, seconds_since(start),
              mb, count_wrong(nodes, exact));
}

} // namespace

int main(int argc, char** argv)
{
    const int n = argc > 1 ? std::atoi(argv[1]) : 300;
    fppg::LatticeGrid grid;
    grid.dp = 2.4 / n;
    grid.origin = {-1.2, -1.2, -1.2};
    grid.n = {static_cast<std::uint32_t>(n + 1), static_cast<std::uint32_t>(n + 1),
              static_cast<std::uint32_t>(n + 1)};
    std::printf(
        "| facets | method | making ready, s | columns, s | memory, MB | wrong nodes |\n"
        "| --- | --- | --- | --- | --- | --- |\n");
    for (const int rings : {158, 500, 1000}) compare(rings, grid);
    return 0;
}
