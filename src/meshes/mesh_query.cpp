#include "meshes/mesh_query.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "fppg/error.h"
#include "meshes/column_cut.h"
#include "meshes/embree.h"
#include "meshes/facet_distance.h"

namespace fppg
{

namespace
{

/// Room for what float rounds away in coordinates between -1 and 1 and in Embree's own arithmetic.
constexpr double rounding_room = 1.0 / (1 << 20);

} // namespace

/// The parts into which a facet is cut across its longest edge for its boxes: long and oblique, one
/// box of it would be large and empty, and near everything.
int parts_of(const Vec3* corners)
{
    constexpr double most = 32;
    Box3 box;
    double longest = 0;
    for (int k = 0; k < 3; ++k)
    {
        box.add(corners[k]);
        longest = std::max(longest, norm(corners[(k + 1) % 3] - corners[k]));
    }
    const Vec3 size = box.max - box.min;
    const double middle =
        std::max(std::min(size.x, size.y), std::min(std::max(size.x, size.y), size.z));
    const double height =
        norm(cross(corners[1] - corners[0], corners[2] - corners[0])) / std::max(longest, 1e-300);
    if (middle <= 4 * height) return 1;
    return static_cast<int>(
        std::min(most, std::ceil(middle / std::max(2 * height, middle / most))));
}

/// The box of part k of n of a facet.
Box3 box_of_part(const Vec3* corners, int k, int n)
{
    Box3 box;
    if (n == 1)
    {
        for (int corner = 0; corner < 3; ++corner) box.add(corners[corner]);
        return box;
    }
    int first = 0;
    for (int edge = 1; edge < 3; ++edge)
        if (norm(corners[(edge + 1) % 3] - corners[edge]) >
            norm(corners[(first + 1) % 3] - corners[first]))
            first = edge;
    const Vec3& a = corners[first];
    const Vec3& b = corners[(first + 1) % 3];
    const Vec3& top = corners[(first + 2) % 3];
    const Vec3 along = b - a;
    const double at_top = std::clamp(dot(top - a, along) / dot(along, along), 0.0, 1.0);
    const double begin = static_cast<double>(k) / n;
    const double end = static_cast<double>(k + 1) / n;
    for (const double t : {begin, end})
    {
        box.add(a + t * along);
        // The point of the other two edges above it.
        if (t < at_top)
            box.add(a + (t / at_top) * (top - a));
        else
            box.add(at_top < 1 ? b + ((1 - t) / (1 - at_top)) * (top - b) : top);
    }
    if (begin <= at_top && at_top <= end) box.add(top);
    return box;
}

/// Embree works on the mesh moved and scaled into [-1, 1], where float is finest. Facets are given
/// as boxes with callbacks, because triangles rounded to float would miss what doubles still hit.
struct MeshQuery::Scene
{
    struct ReleaseDevice
    {
        void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    };
    struct ReleaseScene
    {
        void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
    };

    TriangleSoup soup;
    Vec3 centre;
    double scale = 1; ///< half the largest extent of the mesh
    std::unique_ptr<RTCDeviceTy, ReleaseDevice> device;
    std::unique_ptr<RTCSceneTy, ReleaseScene> scene;
    /// Parts of facets, for the search of near points; empty where no facet is cut.
    struct Part
    {
        std::uint32_t facet = 0;
        std::uint8_t index = 0;
        std::uint8_t count = 1;
    };
    std::vector<Part> parts;
    std::unique_ptr<RTCSceneTy, ReleaseScene> part_scene;

    Scene(TriangleSoup mesh, int threads) : soup(std::move(mesh))
    {
        if (soup.size() == 0) throw GeometryError("a mesh without facets has no surface");
        Box3 box;
        for (const Vec3& vertex : soup.vertices)
        {
            if (!is_finite(vertex))
                throw GeometryError("a mesh with a coordinate that is not finite has no surface");
            box.add(vertex);
        }
        centre = box.min + 0.5 * (box.max - box.min);
        const Vec3 half = 0.5 * (box.max - box.min);
        scale = std::max({half.x, half.y, half.z});
        if (!(scale > 0)) scale = 1;
        build(threads);
    }

    void build(int threads)
    {
        device.reset(new_embree_device(threads));
        scene = make_scene(soup.size(), give_bounds);
        cut_facets();
        if (!parts.empty()) part_scene = make_scene(parts.size(), give_part_bounds);
    }

    std::unique_ptr<RTCSceneTy, ReleaseScene> make_scene(std::size_t count,
                                                         RTCBoundsFunction bounds)
    {
        std::unique_ptr<RTCSceneTy, ReleaseScene> out(rtcNewScene(device.get()));
        rtcSetSceneFlags(out.get(), RTC_SCENE_FLAG_ROBUST);
        const RTCGeometry geometry = rtcNewGeometry(device.get(), RTC_GEOMETRY_TYPE_USER);
        rtcSetGeometryUserPrimitiveCount(geometry, static_cast<unsigned>(count));
        rtcSetGeometryUserData(geometry, this);
        rtcSetGeometryBoundsFunction(geometry, bounds, nullptr);
        rtcSetGeometryIntersectFunction(geometry, meet_ray);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(out.get(), geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(out.get());
        expect_embree_worked(device.get());
        return out;
    }

    void cut_facets()
    {
        std::vector<int> counts(soup.size());
        for (std::size_t f = 0; f < soup.size(); ++f) counts[f] = parts_of(&soup.vertices[3 * f]);
        if (std::all_of(counts.begin(), counts.end(), [](int n) { return n == 1; })) return;
        for (std::size_t f = 0; f < soup.size(); ++f)
            for (int k = 0; k < counts[f]; ++k)
                parts.push_back({static_cast<std::uint32_t>(f), static_cast<std::uint8_t>(k),
                                 static_cast<std::uint8_t>(counts[f])});
    }

    Vec3 to_unit(const Vec3& point) const { return (point - centre) / scale; }

    static void give_bounds(const RTCBoundsFunctionArguments* arguments)
    {
        const Scene& self = *static_cast<const Scene*>(arguments->geometryUserPtr);
        self.give(box_of_part(&self.soup.vertices[3 * std::size_t{arguments->primID}], 0, 1),
                  *arguments->bounds_o);
    }

    static void give_part_bounds(const RTCBoundsFunctionArguments* arguments)
    {
        const Scene& self = *static_cast<const Scene*>(arguments->geometryUserPtr);
        const Part& part = self.parts[arguments->primID];
        self.give(
            box_of_part(&self.soup.vertices[3 * std::size_t{part.facet}], part.index, part.count),
            *arguments->bounds_o);
    }

    void give(const Box3& box, RTCBounds& bounds) const
    {
        const Vec3 low = to_unit(box.min);
        const Vec3 high = to_unit(box.max);
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
    void cast(RayContext& context) const
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
        embree_intersect(scene.get(), context, ray);
    }

    struct Nearest
    {
        const Scene* scene;
        Vec3 point;
        double reach; ///< what float rounding can change in a distance, in units of the box
        ClosestPoint best;
        Vec3 towards{}; ///< unit, to the best
    };

    /// Whether a facet is farther than the nearest point for sure: by how far its corners reach
    /// towards the point, along the line to the nearest one, and how far it is off that line. Of
    /// many facets around that are smaller than the distance all but a few are told so.
    static bool is_farther(const Vec3* corners, const Nearest& nearest)
    {
        const double best = nearest.best.distance;
        if (!(best > 0) || best == std::numeric_limits<double>::infinity()) return false;
        const Vec3& towards = nearest.towards;
        const Vec3 first = corners[0] - nearest.point;
        const double along = dot(first, towards);
        const Vec3 one = corners[1] - corners[0];
        const Vec3 two = corners[2] - corners[0];
        const double least =
            std::max(along + std::min({dot(one, towards), dot(two, towards), 0.0}), 0.0);
        const double off = std::sqrt(std::max(dot(first, first) - along * along, 0.0)) -
                           std::sqrt(std::max(dot(one, one), dot(two, two)));
        constexpr double room_for_rounding = 1 + 1e-9;
        return least * least + (off > 0 ? off * off : 0) > best * best * room_for_rounding;
    }

    static bool meet_point(RTCPointQueryFunctionArguments* arguments)
    {
        Nearest& nearest = *static_cast<Nearest*>(arguments->userPtr);
        const Scene& self = *nearest.scene;
        const std::uint32_t facet =
            self.parts.empty() ? arguments->primID : self.parts[arguments->primID].facet;
        if (facet == nearest.best.facet) return false;
        const Vec3* corners = &self.soup.vertices[3 * std::size_t{facet}];
        if (is_farther(corners, nearest)) return false;
        const Vec3 candidate = closest_on_facet(nearest.point, corners);
        const double distance = norm(candidate - nearest.point);
        const bool is_equal = distance == nearest.best.distance;
        if (!(distance < nearest.best.distance) && !(is_equal && facet < nearest.best.facet))
            return false;
        nearest.best = {candidate, facet, distance};
        nearest.towards = (candidate - nearest.point) / distance;
        const double unit = distance / self.scale;
        arguments->query->radius = static_cast<float>(unit * (1 + rounding_room) + nearest.reach);
        return true;
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

ClosestPoint MeshQuery::closest_point(const Vec3& point, double within) const
{
    const Vec3 unit = scene_->to_unit(point);
    Scene::Nearest nearest{scene_.get(), point, (1 + norm(unit)) * rounding_room, {}};
    constexpr double infinity = std::numeric_limits<double>::infinity();
    nearest.best.point = {infinity, infinity, infinity};
    nearest.best.distance = infinity;
    nearest.best.facet = std::numeric_limits<std::uint32_t>::max();

    RTCPointQuery query;
    query.x = static_cast<float>(unit.x);
    query.y = static_cast<float>(unit.y);
    query.z = static_cast<float>(unit.z);
    query.time = 0;
    query.radius = static_cast<float>(within / scene_->scale * (1 + rounding_room) + nearest.reach);
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(scene_->part_scene ? scene_->part_scene.get() : scene_->scene.get(), &query,
                  &context, Scene::meet_point, &nearest);
    return nearest.best;
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
