#include "meshes/mesh_query.h"

#include <algorithm>
#include <cmath>
#include <mutex>

#include <fmt/format.h>

#include "fppg/error.h"
#include "meshes/column_cut.h"
#include "meshes/embree.h"
#include "meshes/unit_cube.h"

namespace fppg
{

namespace
{

/// Room for what float rounds away in coordinates between -1 and 1 and in Embree's own arithmetic.
constexpr double rounding_room = 1.0 / (1 << 20);

} // namespace

/// Rays are Embree's, which works on the mesh moved and scaled into [-1, 1], where float is finest.
/// Facets are given as boxes with callbacks, because triangles rounded to float would miss what
/// doubles still hit. Nearest points are those of a tree of our own, which need no callbacks. Both
/// are made when they are needed first.
struct MeshQuery::Scene
{
    TriangleSoup soup;
    Vec3 centre;
    double scale = 1; ///< half the largest extent of the mesh
    int threads = 1;
    std::once_flag needs_near, needs_rays;
    std::unique_ptr<NearTree> near;
    std::unique_ptr<RTCDeviceTy, ReleaseEmbreeDevice> device;
    std::unique_ptr<RTCSceneTy, ReleaseEmbreeScene> scene;

    Scene(TriangleSoup mesh, int n) : soup(std::move(mesh)), threads(n)
    {
        if (soup.size() == 0) throw GeometryError("a mesh without facets has no surface");
        Box3 box;
        for (const Vec3& vertex : soup.vertices)
        {
            if (!is_finite(vertex))
                throw GeometryError("a mesh with a coordinate that is not finite has no surface");
            box.add(vertex);
        }
        const UnitCube cube = unit_cube_of(box);
        centre = cube.centre;
        scale = cube.scale;
    }

    const NearTree& near_tree()
    {
        std::call_once(needs_near,
                       [&] { near = std::make_unique<NearTree>(soup, centre, scale, threads); });
        return *near;
    }

    RTCScene ray_scene()
    {
        std::call_once(needs_rays, [&] { make_ray_scene(); });
        return scene.get();
    }

    void make_ray_scene()
    {
        device.reset(new_embree_device(threads));
        scene.reset(rtcNewScene(device.get()));
        rtcSetSceneFlags(scene.get(), RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(soup.size()));
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, give_bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry, meet_ray);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene.get());
        expect_embree_worked(device.get());
    }

    Vec3 to_unit(const Vec3& point) const { return (point - centre) / scale; }

    static void give_bounds(const RTCBoundsFunctionArguments* arguments)
    {
        const Scene& self = *static_cast<const Scene*>(arguments->geometryUserPtr);
        Box3 box;
        for (std::size_t corner = 0; corner < 3; ++corner)
            box.add(self.soup.vertices[3 * std::size_t{arguments->primID} + corner]);
        const Vec3 low = self.to_unit(box.min);
        const Vec3 high = self.to_unit(box.max);
        RTCBounds& bounds = *arguments->bounds_o;
        bounds.lower_x = static_cast<float>(low.x - rounding_room);
        bounds.lower_y = static_cast<float>(low.y - rounding_room);
        bounds.lower_z = static_cast<float>(low.z - rounding_room);
        bounds.upper_x = static_cast<float>(high.x + rounding_room);
        bounds.upper_y = static_cast<float>(high.y + rounding_room);
        bounds.upper_z = static_cast<float>(high.z + rounding_room);
    }

    struct RayContext : EmbreeRayContext
    {
        Vec3 origin;
        int axis = 0;
        std::vector<Crossing>* found = nullptr; ///< all crossings of the half line, or
        LineSums* sums = nullptr;               ///< only the sums of the whole line
        const std::function<bool(std::uint32_t)>* counts = nullptr; ///< for the sums; may be null
    };

    /// Notes the crossing and reports no hit, so that the ray goes on to the end.
    static void meet_ray(const RTCIntersectFunctionNArguments* arguments)
    {
        if (arguments->valid[0] == 0) return;
        const Scene& self = *static_cast<const Scene*>(arguments->geometryUserPtr);
        const RayContext& context = *static_cast<const RayContext*>(arguments->context);
        const ColumnFacet facet(&self.soup.vertices[3 * std::size_t{arguments->primID}],
                                context.axis);
        const Vec3 at = ColumnFacet::turned(context.origin, context.axis);
        if (!cut_column(facet, at.x, at.y).is_crossed) return;
        const bool is_before = side_of_plane(facet, at.x, at.y, at.z) > 0;
        if (context.sums != nullptr)
        {
            if (context.counts != nullptr && !(*context.counts)(arguments->primID)) return;
            (is_before ? context.sums->before : context.sums->behind) -= facet.facing;
            return;
        }
        if (is_before) return;
        const double position = std::max(at.z, height_above(facet, at.x, at.y).z);
        context.found->push_back({position, -facet.facing, arguments->primID});
    }

    /// A ray that starts below the whole mesh; where a half line begins is decided in double.
    void cast(RayContext& context)
    {
        const int axis = context.axis;
        Vec3 start = to_unit(context.origin);
        for (int other = 0; other < 3; ++other)
            if (other != axis && !(std::abs(start[other]) <= 1 + rounding_room)) return;
        start[axis] = -2;
        RTCRayHit ray{};
        ray.ray.org_x = static_cast<float>(start.x);
        ray.ray.org_y = static_cast<float>(start.y);
        ray.ray.org_z = static_cast<float>(start.z);
        ray.ray.dir_x = axis == 0 ? 1.0F : 0.0F;
        ray.ray.dir_y = axis == 1 ? 1.0F : 0.0F;
        ray.ray.dir_z = axis == 2 ? 1.0F : 0.0F;
        ray.ray.tnear = 0;
        ray.ray.tfar = std::numeric_limits<float>::infinity();
        ray.ray.mask = ~0U;
        ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        embree_intersect(ray_scene(), context, ray);
    }
};

MeshQuery::MeshQuery(TriangleSoup soup, int threads)
    : scene_(std::make_unique<Scene>(std::move(soup), threads))
{
}

MeshQuery::~MeshQuery() = default;
MeshQuery::MeshQuery(MeshQuery&&) noexcept = default;
MeshQuery& MeshQuery::operator=(MeshQuery&&) noexcept = default;

const TriangleSoup& MeshQuery::soup() const
{
    return scene_->soup;
}

void MeshQuery::prepare_nearest() const
{
    scene_->near_tree();
}

ClosestPoint MeshQuery::closest_point(const Vec3& point, double within) const
{
    return scene_->near_tree().closest(point, within);
}

std::vector<Crossing> MeshQuery::crossings(const Vec3& origin, int axis) const
{
    std::vector<Crossing> found;
    Scene::RayContext context;
    context.origin = origin;
    context.axis = axis;
    context.found = &found;
    scene_->cast(context);
    std::sort(found.begin(), found.end(),
              [](const Crossing& a, const Crossing& b)
              { return a.position != b.position ? a.position < b.position : a.facet < b.facet; });
    return found;
}

LineSums MeshQuery::line_sums(const Vec3& point, int axis,
                              const std::function<bool(std::uint32_t)>& counts) const
{
    LineSums sums;
    Scene::RayContext context;
    context.origin = point;
    context.axis = axis;
    context.sums = &sums;
    if (counts) context.counts = &counts;
    scene_->cast(context);
    return sums;
}

} // namespace fppg
