#include "walls/inside_body.h"

#include "fppg/error.h"

#include "core/parallel.h"
#include "meshes/crowded_points.h"
#include "meshes/mesh_facets.h"
#include "meshes/point_grid.h"
#include "meshes/round_surface.h"
#include "nodes/cell_nodes.h"
#include "offset/offset_surface.h"
#include "walls/fit_shape.h"
#include "walls/layer_builder.h"
#include "walls/wall_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>

namespace fppg
{
namespace
{

/// Bodies up to this thick, dp, are looked at for plates; what is thicker has room for nodes.
constexpr double thickest_plate_dp = 4.6;
/// A body is a plate where so much of its surface has nearly its mean thickness over it, ...
constexpr double plate_share = 0.35;
constexpr double nearly = 0.22;
/// ... and it is no bar: 2 V / A of a plate without rims is its thickness, that of a bar half of
/// it.
constexpr double bar_ratio = 1.7;
/// A body has one thickness where no more of its surface has another one, of what has any, and its
/// 2 V / A is not above that: rims make it smaller, thicker parts (the wheel behind thin teeth)
/// larger.
constexpr double most_of_other = 0.03;
/// Nodes farther than this from all particles of layers stay before others, dp, and none stays
/// that is nearer than the second.
constexpr double far_dp = 1.5;
constexpr double nearest_node_dp = 0.5;
/// Bodies less of whose particles are in the room under the layers have their number from these.
constexpr double little_room = 0.1;
/// The number of particles in layers is met to this, or to half a one.
constexpr double number_tolerance = 5e-4;

/// Bodies of this mean thickness or less have layers that turn within dp: finer cells.
constexpr double thin_dp = 2.5;
constexpr std::size_t thickness_samples = 600;

/// Of particles that are taken out one by one.
constexpr double most_surplus = 0.1;

struct Thickness
{
    double middle = 0; ///< median, metres
    double share = 0;  ///< of the surface that has nearly that
    double other = 0;  ///< of what is not thicker than was looked for, that has not
};

/// How thick a body is over its surface, as far as it is thinner than `most`, metres.
Thickness thickness_of(const WallDepth& wall, double most, const LatticeGrid& grid, int threads)
{
    std::vector<double> found =
        sample_thickness(wall, most, thickness_samples,
                         grid.is_2d ? std::optional(grid.origin.y) : std::nullopt, threads);
    std::sort(found.begin(), found.end());
    const auto first = std::upper_bound(found.begin(), found.end(), 0.0);
    Thickness out;
    if (first == found.end()) return out;
    out.middle = *(first + (found.end() - first) / 2);
    const auto near = std::count_if(
        first, found.end(), [&](double t) { return std::abs(t / out.middle - 1) < nearly; });
    out.share = static_cast<double>(near) / static_cast<double>(thickness_samples);
    out.other = 1 - static_cast<double>(near) / static_cast<double>(found.end() - first);
    return out;
}

/// As many sheets as a thickness is nearest to, in dp.
int sheets_through(double thickness_dp)
{
    int n = static_cast<int>(std::clamp(std::floor(thickness_dp), 1.0, 1e9));
    if (thickness_dp * thickness_dp > static_cast<double>(n) * (n + 1)) ++n;
    return n;
}

/// About a vertex: about the origin the digits of a body that is far from it would cancel out.
double volume_of(const SurfaceMesh& mesh)
{
    double six = 0;
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
        six += volume_times_six(mesh, f, mesh.vertices[0]);
    return six / 6;
}

/// What a round body has more than its facets bound, metres cubed. Each facet is split into four
/// whose new corners are on the true surface; that is three quarters of it, as chords go with the
/// square of their length.
double volume_beyond_facets(const FittedBody& body)
{
    const SurfaceMesh& mesh = body.mesh;
    std::vector<Vec3> middles(mesh.edges.size());
    for (std::size_t e = 0; e < mesh.edges.size(); ++e)
    {
        Vec3 p = 0.5 * (mesh.vertices[mesh.edges[e][0]] + mesh.vertices[mesh.edges[e][1]]);
        for (std::uint32_t f : mesh.edge_facets[e])
            if (f != no_index) project_to_exact(body, p, f);
        middles[e] = p;
    }
    double six = 0;
    const auto add = [&](const Vec3& a, const Vec3& b, const Vec3& c)
    { six += dot(a, cross(b, c)); };
    for (std::size_t f = 0; f < mesh.facets.size(); ++f)
    {
        const auto corner = [&](std::size_t k)
        { return mesh.vertices[mesh.facets[f][k]] - mesh.vertices[0]; };
        const auto middle = [&](std::size_t k)
        { return middles[mesh.facet_edges[f][k]] - mesh.vertices[0]; };
        add(corner(0), middle(0), middle(2));
        add(corner(1), middle(1), middle(0));
        add(corner(2), middle(2), middle(1));
        add(middle(0), middle(1), middle(2));
    }
    return 4.0 / 3 * (six / 6 - volume_of(mesh));
}

/// A node that may stay.
struct RoomNode
{
    double distance = 0; ///< to the nearest particle of a layer, dp
    std::uint32_t hash = 0;
    std::uint32_t x = 0;
    Span span;
};

class InsideFiller
{
public:
    InsideFiller(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
        : settings_(settings),
          grid_(grid),
          threads_(threads),
          out_(out),
          builder_(settings, grid, threads, out),
          dp3_(grid.dp * grid.dp * grid.dp)
    {
    }

    void run()
    {
        out_.body.is_inside = true;
        wall_ = builder_.wall_of(WallSide::Behind, true, settings_.feature_angle_deg,
                                 thickest_plate_dp);
        if (wall_ == nullptr) return;
        FitMeasures& measures = out_.body.measures;
        if ((out_.body.round != nullptr || out_.body.cad != nullptr) && !grid_.is_2d)
            measures.volume += volume_beyond_facets(out_.body);
        wanted_ = std::round(measures.volume / dp3_);
        make_plan();
        measure_room();
        measures.shell_volume = std::max(0.0, wanted_ - room_) * dp3_;
        builder_.build(WallSide::Behind, true, plan_);
        fit_number();
        if (plan_.number > 0) builder_.merge_sides();
        take_nodes();
        measure_layers(grid_, out_);
    }

private:
    void make_plan()
    {
        FittedBody& body = out_.body;
        plan_.depths_dp = {0.5};
        plan_.middle_dp = 0.5 + 0.5 * merge_dp;
        plan_.parts = 1;
        under_layers_ = grid_.dp;
        const double most_dp =
            settings_.across ? 1.3 * *settings_.across + 1.0 : 1.2 * thickest_plate_dp;
        const double mean = 2 * body.measures.volume / body.measures.area;
        if (mean < thin_dp * grid_.dp) plan_.cell_dp = 0.5 * offset_cell_dp;
        if (!settings_.across && mean > thickest_plate_dp * grid_.dp) return;
        const Thickness t =
            thickness_of(*wall_, std::max(most_dp * grid_.dp, 2 * mean), grid_, threads_);
        const bool is_thicker = mean > (1 + nearly) * t.middle;
        const bool is_even = t.other <= most_of_other && !is_thicker;
        const bool is_plate = is_even && t.share >= plate_share && t.middle < bar_ratio * mean &&
                              t.middle <= thickest_plate_dp * grid_.dp;
        if (!is_plate && !settings_.across) return;
        if (!(t.middle > 0))
            throw GeometryError(
                "across: the body has no two faces that look away from each other; expected a "
                "plate, a beam or a shell");
        body.thickness = t.middle;
        body.sheets = settings_.across.value_or(sheets_through(t.middle / grid_.dp));
        const double step = t.middle / body.sheets / grid_.dp;
        plan_.depths_dp.clear();
        const int half = body.sheets / 2;
        for (int k = 0; k < half; ++k) plan_.depths_dp.push_back((k + 0.5) * step);
        plan_.middle_dp = body.sheets % 2 == 1 ? 0.65 * t.middle / grid_.dp : 0;
        plan_.spacing_dp = std::pow(1 / step, power());
        under_layers_ = half * step * grid_.dp;
        if (!is_even)
            out_.warnings.push_back(fmt::format(
                "across: the sheets are those of a thickness of {:.4g} m, and {} another; there "
                "they "
                "are not whole. Parts of different thickness want an mkbound each; without across "
                "every part gets what its thickness has room for.",
                t.middle,
                is_thicker ? "thicker parts of the body have"
                           : fmt::format("{:.0f} % of the surface has", 100 * t.other)));
        // Where a body is thicker elsewhere, the sheet in the middle cannot make up for that.
        if (body.sheets % 2 == 1 && is_even) plan_.number = static_cast<std::size_t>(wanted_);
        if (body.sheets == 1)
        {
            const double across = step / plan_.spacing_dp;
            plan_.off_edges_dp = 0.5 * std::sqrt(1 + across * across);
        }
    }

    /// How many particles the room under the layers has place for.
    void measure_room()
    {
        if (plan_.depths_dp.empty())
        {
            room_ = wanted_;
            return;
        }
        std::shared_ptr<const WallDepth> wall = wall_;
        if (!grid_.is_2d)
        {
            const OffsetSurface under = builder_.surface_at(
                under_layers_ * (1 + 1e-6), plan_.cell_dp, WallSide::Behind, true, wall);
            room_ = std::max(0.0, volume_of(under.mesh)) / dp3_;
            return;
        }
        // Of each node's square as much as is under the layers.
        std::vector<double> of_slab(grid_.n[0], 0.0);
        const double half_diagonal = std::sqrt(0.5) * grid_.dp;
        Box3 box;
        for (const Vec3& v : out_.body.mesh.vertices) box.add(v);
        const auto node = [&](double at, int axis)
        {
            const double k = std::floor((at - grid_.origin[axis]) / grid_.step(axis));
            return static_cast<std::uint32_t>(
                std::clamp(k, 0.0, static_cast<double>(grid_.n[static_cast<std::size_t>(axis)])));
        };
        const std::uint32_t first = node(box.min.x, 0);
        const std::uint32_t end = std::min(node(box.max.x, 0) + 2, grid_.n[0]);
        parallel_for(end - first, threads_,
                     [&](std::size_t i)
                     {
                         const std::size_t x = first + i;
                         const std::uint32_t z_end = std::min(node(box.max.z, 2) + 2, grid_.n[2]);
                         for (std::uint32_t z = node(box.min.z, 2); z < z_end; ++z)
                         {
                             const Vec3 p = place_of(x, 0, z);
                             const double off = wall_->at(p).depth - under_layers_;
                             if (off > half_diagonal)
                                 of_slab[x] += 1;
                             else if (off > -half_diagonal)
                                 of_slab[x] += share_under_layers(p);
                         }
                     });
        for (const double count : of_slab) room_ += count * grid_.stretch.x * grid_.stretch.z;
    }

    /// How much of a square of dp about a point is under the layers, in 2D.
    double share_under_layers(const Vec3& p) const
    {
        constexpr int parts = 8;
        int inside = 0;
        for (int i = 0; i < parts * parts; ++i)
        {
            const int row = i / parts;
            const double x = (i % parts + 0.5) / parts - 0.5;
            const double z = (row + 0.5) / parts - 0.5;
            const Vec3 at = p + Vec3{x * grid_.step(0), 0, z * grid_.step(2)};
            if (wall_->at(at).depth > under_layers_) ++inside;
        }
        return static_cast<double>(inside) / (parts * parts);
    }

    Vec3 place_of(std::size_t x, std::uint32_t y, std::uint32_t z) const
    {
        return grid_.place(static_cast<double>(x), y, z);
    }

    /// Of the number of particles in a layer, to which their spacing goes.
    double power() const { return grid_.is_2d ? 1 : 0.5; }

    double laid() const { return static_cast<double>(out_.particles.size()); }

    /// Where there is little room for nodes the layers have the number that the volume asks for.
    void fit_number()
    {
        if (plan_.depths_dp.empty() || out_.layers.empty()) return;
        const bool has_room = room_ > little_room * wanted_ && out_.body.sheets == 0;
        const double off = wanted_ - laid() - room_;
        if (has_room && std::abs(off) < 0.01 * wanted_) return;
        const double of_layers = laid() / (laid() + room_);
        const double target = std::max(1.0, has_room ? laid() + of_layers * off : wanted_ - room_);
        // A surplus can be taken out, what is missing cannot be put in evenly.
        const auto miss = [&](double number)
        { return number >= target - 0.5 ? number - target : 3 * (target - number); };
        double best = laid(), best_spacing = plan_.spacing_dp, spacing = plan_.spacing_dp;
        const double enough = std::max(0.5, number_tolerance * target);
        for (int attempt = 0; attempt < 24 && miss(best) > enough; ++attempt)
        {
            if (attempt < 6)
                spacing *= std::pow(std::clamp(laid() / target, 0.25, 4.0), power());
            else // the number jumps here: places nearby are tried
                spacing = best_spacing * (1 + (attempt % 2 == 0 ? 1 : -1) * 0.0013 * (attempt - 5));
            builder_.lay_again(spacing, true);
            if (miss(laid()) < miss(best))
            {
                best = laid();
                best_spacing = spacing;
            }
        }
        // What is still missing the sheet in the middle of thin parts makes up for.
        if (plan_.number == 0) builder_.set_number(static_cast<std::size_t>(target));
        builder_.lay_again(best_spacing, false);
        if (plan_.number == 0) builder_.merge_sides();
        drop_surplus(std::round(target));
    }

    /// Takes the most crowded particles out, 2 dp from one another; of edges only where no more of
    /// faces can go.
    void drop_surplus(double target)
    {
        WallParticles& particles = out_.particles;
        auto surplus = laid() > target ? static_cast<std::size_t>(laid() - target) : 0;
        if (surplus == 0 || static_cast<double>(surplus) > most_surplus * target) return;
        const double apart = 2 * grid_.dp;
        const std::vector<double> nearest = nearest_distances(particles.positions, apart, threads_);
        std::vector<std::uint32_t> order;
        for (std::uint32_t i = 0; i < particles.size(); ++i)
            if (particles.kinds[i] != FitKind::Corner) order.push_back(i);
        const auto rank = [&](std::uint32_t i)
        { return std::pair(particles.kinds[i] != FitKind::Surface, nearest[i]); };
        std::stable_sort(order.begin(), order.end(),
                         [&](std::uint32_t a, std::uint32_t b) { return rank(a) < rank(b); });
        PointGrid dropped(apart, surplus);
        std::vector<char> goes(particles.size(), 0);
        for (std::size_t k = 0; k < order.size() && surplus > 0; ++k)
        {
            const Vec3& p = particles.positions[order[k]];
            if (dropped.has_nearer(p, apart)) continue;
            dropped.add(p);
            goes[order[k]] = 1;
            --surplus;
        }
        particles.erase(goes);
    }

    /// Of the nodes inside those stay that are the farthest from the layers, so many as the volume
    /// asks for.
    void take_nodes()
    {
        const double all = out_.body.measures.node_volume / dp3_;
        std::vector<std::vector<RoomNode>> of_slab(grid_.n[0]);
        const double reach = far_dp * grid_.dp;
        PointGrid taken(reach, out_.particles.size());
        for (const Vec3& p : out_.particles.positions) taken.add(p);
        std::vector<std::uint64_t> inside(grid_.n[0], 0);
        parallel_for(grid_.n[0], threads_,
                     [&](std::size_t x)
                     {
                         for (const Span& span : out_.volume[x])
                             for (std::uint32_t z = span.z_begin; z < span.z_end; ++z)
                             {
                                 ++inside[x];
                                 const Vec3 p = place_of(x, span.y, z);
                                 double squared = reach * reach;
                                 taken.for_each_near(p, reach,
                                                     [&](std::uint32_t, double s)
                                                     { squared = std::min(squared, s); });
                                 RoomNode node;
                                 node.distance = std::sqrt(squared) / grid_.dp;
                                 node.hash = static_cast<std::uint32_t>(
                                     3518319155U * x + 2882110345U * span.y + 2360945575U * z);
                                 node.x = static_cast<std::uint32_t>(x);
                                 node.span = {span.y, z, z + 1};
                                 if (node.distance >= nearest_node_dp) of_slab[x].push_back(node);
                             }
                     });
        double within = 0;
        std::vector<RoomNode> nodes;
        for (std::size_t x = 0; x < of_slab.size(); ++x)
        {
            within += static_cast<double>(inside[x]);
            nodes.insert(nodes.end(), of_slab[x].begin(), of_slab[x].end());
        }
        // The rest of the body is outside the domain.
        const double part = all > 0 ? std::min(1.0, within / all) : 1;
        const double wanted = std::max(0.0, std::round(part * (wanted_ - laid())));
        const auto kept = std::min(nodes.size(), static_cast<std::size_t>(wanted));
        std::nth_element(nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(kept),
                         nodes.end(),
                         [](const RoomNode& a, const RoomNode& b)
                         {
                             return std::tuple(-a.distance, a.hash, a.x, a.span.y, a.span.z_begin) <
                                    std::tuple(-b.distance, b.hash, b.x, b.span.y, b.span.z_begin);
                         });
        nodes.resize(kept);
        std::vector<Spans> stay(grid_.n[0]);
        for (const RoomNode& node : nodes) stay[node.x].push_back(node.span);
        parallel_for(grid_.n[0], threads_,
                     [&](std::size_t x)
                     {
                         sort_and_join(stay[x]);
                         out_.zone[x] = unite(out_.zone[x], subtract(out_.volume[x], stay[x]));
                     });
        out_.volume = std::move(stay);
        out_.body.measures.node_volume =
            part > 0 ? static_cast<double>(kept) / part * dp3_ : wanted * dp3_;
    }

    const FitSettings& settings_;
    const LatticeGrid& grid_;
    int threads_;
    FittedDraw& out_;
    LayerBuilder builder_;
    double dp3_;
    std::shared_ptr<const WallDepth> wall_;
    LayerPlan plan_;
    double wanted_ = 0;       ///< particles of the body
    double room_ = 0;         ///< of them under the layers
    double under_layers_ = 0; ///< depth where the room begins, metres
};

} // namespace

void fill_inside(const FitSettings& settings, const LatticeGrid& grid, int threads, FittedDraw& out)
{
    if (!(out.body.measures.volume > 0))
        throw GeometryError(
            "place=\"inside\": the shape bounds no volume that particles could fill; expected a "
            "closed solid");
    if (!out.body.is_solid)
        throw GeometryError(
            "place=\"inside\": only the surface of the shape is drawn; expected a solid, by "
            "autofill=\"true\" of a mesh file or <setdrawmode mode=\"full\" /> before another "
            "shape");
    InsideFiller(settings, grid, threads, out).run();
}

} // namespace fppg
