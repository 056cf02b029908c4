#include "fppg/normals.h"

#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"
#include "fppg/vres.h"

#include "core/parallel.h"
#include "nodes/run_at.h"
#include "nodes/snap.h"
#include "normals/cad_normals.h"
#include "normals/gap_normals.h"
#include "normals/geometry_normals.h"
#include "normals/other_surface.h"
#include "normals/part_normals.h"
#include "normals/shape_normals.h"
#include "normals/wet_setup.h"
#include "particles/initials.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace fppg
{
namespace
{

/// Walls of so many dp have two layers of mDBC with room between them.
constexpr double two_layers_dp = 2;

using Float3 = std::array<float, 3>;

/// Length of the normal of a particle on a fitted surface, which has no distance to it, in dp: the
/// solver takes zero for none, and mirrors the particle in the surface to where it stands.
constexpr double on_surface_dp = 0.01;

/// Long runs are divided among threads.
constexpr std::uint32_t most_at_once = 1024;
/// Nearer to its surface than this a particle counts as on it, dp.
constexpr double least_depth_dp = 0.1;
/// Below this two sides of a wall are in one place, and no dp serves it.
constexpr double folded_dp = 1e-6;

Float3 as_float(const Vec3& v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Length of a normal in the picture of svshapes: as GenCase v5.4.354 draws it, a fifth of the mean
/// distance from the centre to the corners.
ShapePolygons normal_line(const NormalFacet& facet, int index)
{
    Vec3 centre;
    for (std::uint32_t i = 0; i < facet.size; ++i) centre = centre + facet.corners[i];
    centre = centre / facet.size;
    double length = 0;
    for (std::uint32_t i = 0; i < facet.size; ++i) length += norm(facet.corners[i] - centre);
    ShapePolygons line;
    line.mk = index;
    line.vertices = {centre, centre + (0.2 * length / facet.size) * facet.unit};
    line.polygons = {{0, 1}};
    return line;
}

std::vector<ShapePolygons> picture(const std::vector<NormalFacet>& facets)
{
    std::vector<ShapePolygons> out;
    for (std::size_t f = 0; f < facets.size(); ++f)
        out.push_back(normal_line(facets[f], static_cast<int>(f)));
    for (std::size_t f = 0; f < facets.size(); ++f)
    {
        ShapePolygons shape;
        shape.mk = static_cast<int>(f);
        shape.vertices.assign(facets[f].corners.begin(),
                              facets[f].corners.begin() + facets[f].size);
        shape.polygons.emplace_back();
        for (std::uint32_t i = 0; i < facets[f].size; ++i) shape.polygons[0].push_back(i);
        out.push_back(std::move(shape));
    }
    return out;
}

class NormalsMaker
{
public:
    NormalsMaker(const CaseDef& def, const CaseParticles& particles, const RunField& field,
                 int threads, NormalsReport& report)
        : def_(def), particles_(particles), field_(field), threads_(threads), report_(report)
    {
        normals_.resize(particles.np - particles.n_fluid, Float3{});
        for (const ParticleBlock& block : particles.blocks)
        {
            if (block.type == ParticleType::Fluid) continue;
            std::uint64_t id = block.begin;
            for (const ParticleRun& run : block.runs)
            {
                for (std::uint32_t k = 0; k < run.count; k += most_at_once)
                    places_.push_back({&block, &run, id, k, std::min(run.count, k + most_at_once)});
                id += run.count;
            }
        }
    }

    std::vector<Float3> run(const std::vector<ShapePolygons>& geometry)
    {
        report_.log.emplace_back("Computing normals...");
        if (normals_.empty())
        {
            report_.log.emplace_back("  *** No boundary particles for computing normals.");
            return {};
        }
        if (def_.normals.geometry)
        {
            from_geometry(*def_.normals.geometry, geometry);
            if (auto w = note_other_surfaces(def_, field_.walls.bodies, geometry, threads_))
                report_.warnings.push_back(std::move(*w));
        }
        from_layers();
        for (const NormalOp& op : def_.normals.ops) execute(op);
        if (particles_.off_lattice.size() > 0) fill_on_surfaces();
        summarise();
        warn_of_no_normals();
        warn_of_cut_walls();
        return std::move(normals_);
    }

private:
    /// Particles of a run that one thread looks at.
    struct RunPlace
    {
        const ParticleBlock* block;
        const ParticleRun* run;
        std::uint64_t id;         ///< of the run's first particle
        std::uint32_t begin, end; ///< of these in the run
    };

    /// Calls body(run index, position, normal) for all boundary particles.
    template <typename Body>
    void for_all(const Body& body)
    {
        const auto visit = [&](std::size_t r)
        {
            const RunPlace& place = places_[r];
            for (std::uint32_t k = place.begin; k < place.end; ++k)
                body(r, position(place, k), normals_[place.id + k]);
        };
        parallel_for(places_.size(), threads_, visit, 64);
    }

    /// The same for the particles that a command selects.
    template <typename Body>
    void for_selected(const NormalOp& op, const Body& body)
    {
        for_all(
            [&](std::size_t r, const Vec3& p, Float3& normal)
            {
                const std::uint16_t mk = places_[r].block->mk;
                if (op.has_mk && std::find(op.mk.begin(), op.mk.end(), mk) == op.mk.end()) return;
                if (op.only.contains(p)) body(r, p, normal);
            });
    }

    Vec3 position(const RunPlace& place, std::uint32_t k) const
    {
        InitialState state;
        state.position = place_in_run(particles_, *place.block, *place.run, k);
        state.place = place.id + k - place.block->begin;
        if (!place.block->initials.empty()) apply_initials(place.block->initials, state);
        return state.position;
    }

    /// Sets the normals that `normal_at` gives other than zero.
    template <typename NormalAt>
    void set(const NormalOp& op, const NormalAt& normal_at)
    {
        for_selected(op,
                     [&](std::size_t, const Vec3& p, Float3& normal)
                     {
                         if (op.clear) normal = {};
                         const Vec3 n = normal_at(p);
                         if (!(n == Vec3{})) normal = as_float(n);
                     });
    }

    void from_geometry(const GeometryNormals& geometry, const std::vector<ShapePolygons>& polygons)
    {
        const double reach = geometry.distance_h * def_.h;
        std::vector<NormalFacet> facets = normal_facets(polygons);
        report_.log.push_back(
            fmt::format("  Evaluating {} particles with {} shapes (distance {:g}x H = {:g}).",
                        normals_.size(), facets.size(), geometry.distance_h, reach));
        if (facets.empty())
            report_.warnings.push_back(
                fmt::format("{}:{}: <norgeometry>: \"{}\" holds no polygon, so no particle gets a "
                            "normal from it.",
                            def_.file, geometry.line, geometry.file));
        if (geometry.save_shapes) report_.shapes = picture(facets);
        const GeometryQuery query(std::move(facets), reach, def_.grid.dp, threads_);
        const CadNormals cad(def_, threads_);
        const double limit = geometry.max_size_h * def_.h;
        std::vector<std::uint64_t> candidates(places_.size(), 0);
        std::vector<std::uint64_t> resized(places_.size(), 0);
        for_all(
            [&](std::size_t r, const Vec3& p, Float3& normal)
            {
                GeometryQuery::Answer answer = query.at(p);
                answer.normal = cad.exact(p, answer.normal);
                candidates[r] += answer.candidates;
                const Vec3 own = own_normal(r, normal);
                if (const int side = own == Vec3{} ? 0 : query.side_at(p, own, 0.5 * def_.grid.dp);
                    side != 0)
                    answer.normal = side * on_surface_dp * def_.grid.dp * own;
                const double size = norm(answer.normal);
                if (limit > 0 && size > limit)
                {
                    answer.normal = (limit / size) * answer.normal;
                    ++resized[r];
                }
                normal = as_float(answer.normal);
            });
        std::uint64_t all = 0;
        std::uint64_t all_resized = 0;
        for (std::size_t r = 0; r < places_.size(); ++r)
        {
            all += candidates[r];
            all_resized += resized[r];
        }
        report_.log.push_back(fmt::format("  Computed normals: {}", all));
        if (limit > 0)
            report_.log.push_back(
                fmt::format("  Resizes {}/{} huge normals with maximum size ({:g}x H = {:g}).",
                            all_resized, normals_.size(), geometry.max_size_h, limit));
    }

    /// Layers and what is under them look to the nearest place that fluid can touch; in buffers of
    /// `<vres>`, where the solver wants normals of all, however far it is.
    void from_layers()
    {
        for (const FittedBody& body : field_.walls.bodies)
        {
            if (!body.is_layer()) continue;
            is_layered_.resize(65536, 0);
            is_layered_[body.mk] = 1;
            for (const std::uint16_t mk : body.facet_mk) is_layered_[mk] = 1;
        }
        if (is_layered_.empty()) return;
        constexpr double everywhere = std::numeric_limits<double>::infinity();
        const double reach = 2 * def_.h;
        const WetSurface wet(field_, wet_setup(def_, particles_, reach), threads_);
        if (wet.is_empty()) return;
        const auto visit = [&](std::size_t r)
        {
            const RunPlace& place = places_[r];
            if (is_layered_[place.block->mk] == 0) return;
            Transform turn = motion_of(*place.block);
            turn.offset = {};
            for (std::uint32_t k = place.begin; k < place.end; ++k)
            {
                Float3& normal = normals_[place.id + k];
                const double depth = own_depth(r, normal);
                if (depth > 0 && !wet.has_dry_sides())
                    normal = as_float(depth * own_normal(r, normal));
                else
                {
                    const Vec3 p = place_in_run(particles_, *place.block, *place.run, k);
                    const double most = is_in_buffer(def_.vres, def_.zone, p) ? everywhere
                                        : depth > 0                           ? 2 * reach
                                                                              : reach;
                    normal = as_float(turn(wet.vector_from(p, most)));
                }
            }
        };
        parallel_for(places_.size(), threads_, visit, 64);
        warn_of_thin_walls(wet, reach);
    }

    void warn_of_thin_walls(const WetSurface& wet, double reach)
    {
        const auto warn = [&](const WetSurface::ThinWall& wall, const char* fault,
                              double thickness_dp, const char* or_else)
        {
            const bool is_folded = wall.thickness < folded_dp * def_.grid.dp;
            report_.warnings.push_back(
                fmt::format("{}: mkbound {} has walls of {:.3g} m {}; {}{}.", def_.file,
                            wall.mk - def_.mk_bound_first, is_folded ? 0.0 : wall.thickness,
                            fmt::format(fmt::runtime(fault), wall.area),
                            is_folded ? "two of its sides coincide there and need a distance"
                                      : fmt::format("they need a dp of {:.3g} m at most",
                                                    wall.thickness / thickness_dp),
                            or_else));
        };
        for (const WetSurface::ThinWall& wall : wet.thin_walls())
            warn(wall,
                 "with fluid on both sides, over {:.3g} m^2: thinner than 2h - dp/2, they cannot "
                 "serve both, as a particle has one normal",
                 reach / def_.grid.dp - 0.5, "");
        for (const WetSurface::ThinWall& wall : wet.one_layer_walls())
            warn(wall,
                 "beside fluid, over {:.3g} m^2: they have room for one layer of mDBC, and fluid "
                 "goes through one",
                 two_layers_dp, ", or the boundary condition DBC (Boundary=1)");
    }

    /// How deep a particle of a layer stands behind the true surface, metres; zero for all others.
    double own_depth(std::size_t r, const Float3& normal) const
    {
        const RunPlace& place = places_[r];
        if (!place.run->is_off_lattice) return 0;
        const OffLatticeParticles& all = particles_.off_lattice;
        const auto k = static_cast<std::uint64_t>(&normal - &normals_[place.id]);
        const std::uint64_t at = place.run->off_lattice_begin() + k;
        const double depth = -all.distances[at];
        return all.kinds[at] != FitKind::Volume && depth > least_depth_dp * def_.grid.dp ? depth
                                                                                         : 0;
    }

    /// The unit normal of the true surface at a particle that a fit put on it or behind it, else
    /// zero. `normal` is the entry of the particle in normals_.
    Vec3 own_normal(std::size_t r, const Float3& normal) const
    {
        const RunPlace& place = places_[r];
        if (!place.run->is_off_lattice) return {};
        const auto k = static_cast<std::uint64_t>(&normal - &normals_[place.id]);
        const std::array<float, 3>& n =
            particles_.off_lattice.normals[place.run->off_lattice_begin() + k];
        Transform turn = motion_of(*place.block);
        turn.offset = {};
        return turn({n[0], n[1], n[2]});
    }

    /// Particles on a fitted surface that no entry gives a direction.
    void fill_on_surfaces()
    {
        const double length = on_surface_dp * def_.grid.dp;
        for_all(
            [&](std::size_t r, const Vec3&, Float3& normal)
            {
                if (norm({normal[0], normal[1], normal[2]}) >= 0.99 * length) return;
                const Vec3 own = own_normal(r, normal);
                if (!(own == Vec3{}))
                    normal = as_float(std::max(length, own_depth(r, normal)) * own);
            });
    }

    void execute(const NormalOp& op)
    {
        // 0: no limit, but for norparts, which then gives none (GenCase v5.4.354).
        const double reach = op.max_distance_h > 0 ? op.max_distance_h * def_.h
                                                   : std::numeric_limits<double>::infinity();
        if (const auto* set_op = std::get_if<SetNormals>(&op.what))
        {
            const Float3 value = as_float(set_op->normal);
            for_selected(op, [&](std::size_t, const Vec3&, Float3& normal) { normal = value; });
        }
        else if (const auto* plane = std::get_if<PlaneNormals>(&op.what))
        {
            const double length = norm(plane->normal);
            const Vec3 unit = length > 0 ? plane->normal / length : Vec3{};
            if (plane->point)
            {
                const double offset = dot(*plane->point, unit);
                set(op, [&](const Vec3& p) { return to_plane(p, unit, offset, reach); });
            }
            else
                behind_outermost(op, unit, plane->limit_dp * def_.grid.dp, reach);
        }
        else if (const auto* sphere = std::get_if<SphereNormals>(&op.what))
            set(op, [&](const Vec3& p) { return to_sphere(p, *sphere, reach); });
        else if (const auto* cylinder = std::get_if<CylinderNormals>(&op.what))
            set(op, [&](const Vec3& p) { return to_cylinder(p, *cylinder, reach, def_.h); });
        else
            from_parts(op, op.max_distance_h * def_.h);
    }

    /// A plane for each mk by itself, `limit` beyond the outermost of its selected particles.
    void behind_outermost(const NormalOp& op, const Vec3& unit, double limit, double reach)
    {
        for (const std::uint16_t mk : op.mk)
        {
            NormalOp one = op;
            one.mk = {mk};
            const double offset = outermost(one, unit) + limit;
            set(one, [&](const Vec3& p) { return to_plane(p, unit, offset, reach); });
        }
    }

    /// The largest p . unit of the selected particles.
    double outermost(const NormalOp& op, const Vec3& unit)
    {
        std::vector<double> best(places_.size(), -std::numeric_limits<double>::infinity());
        for_selected(op, [&](std::size_t r, const Vec3& p, Float3&)
                     { best[r] = std::max(best[r], dot(p, unit)); });
        double most = -std::numeric_limits<double>::infinity();
        for (const double b : best) most = std::max(most, b);
        return most;
    }

    /// The least node of the box of all particles: that of the lattice where some stand off it,
    /// which count for the node nearest to them.
    Vec3 first_node() const
    {
        Vec3 low = particles_.pos_min;
        if (particles_.off_lattice.size() == 0) return low;
        const LatticeGrid& grid = particles_.grid;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double steps = (low[axis] - grid.origin[axis]) / grid.step(axis);
            // Half-way between two it is the lower one, so that no particle lies before it.
            low[axis] = grid.origin[axis] + std::ceil(steps - 0.5 - 1e-6) * grid.step(axis);
        }
        return low;
    }

    void from_parts(const NormalOp& op, double reach)
    {
        std::vector<Vec3> selected;
        for (const RunPlace& place : places_)
            if (!op.has_mk || std::find(op.mk.begin(), op.mk.end(), place.block->mk) != op.mk.end())
                for (std::uint32_t k = place.begin; k < place.end; ++k)
                    selected.push_back(position(place, k));
        const PartSurface surface(selected, first_node(), particles_.pos_max, def_.grid.dp, reach);
        set(op, [&](const Vec3& p) { return surface.normal_at(p); });
    }

    void summarise()
    {
        std::uint64_t zeros = 0;
        double largest = 0;
        for (const Float3& n : normals_)
        {
            const double size = norm({n[0], n[1], n[2]});
            zeros += size == 0 ? 1 : 0;
            largest = std::max(largest, size);
        }
        report_.log.push_back(
            fmt::format("  Final zero normals: {}/{} ({:.1f}%)   Maximum normal: {:g} ({:.2f} x h)",
                        zeros, normals_.size(),
                        100.0 * static_cast<double>(zeros) / static_cast<double>(normals_.size()),
                        largest, largest / def_.h));
        if (zeros == normals_.size())
            report_.log.emplace_back("  *** All boundary particles without normal data.");
        else if (zeros > 0)
            report_.log.emplace_back("  *** There are boundary particles without normal data.");
    }

    /// Under SlipMode 2 and 3 the solver (v5.4, JSphCpuSingle::MdbcBoundCorrection) sets velocities
    /// for viscosity at particles with a normal only: at others fluid meets what the memory held.
    void warn_of_no_normals()
    {
        if (def_.solver.boundary != 2 || def_.solver.slip_mode < 2) return;
        std::vector<std::uint16_t> mks;
        for (const ParticleBlock& block : particles_.blocks)
        {
            if (block.type != ParticleType::Fixed && block.type != ParticleType::Moving) continue;
            const Float3* first = normals_.data() + block.begin;
            if (std::all_of(first, first + block.count,
                            [](const Float3& n) { return n == Float3{}; }))
                mks.push_back(block.mk_type);
        }
        if (mks.empty()) return;
        report_.warnings.push_back(fmt::format(
            "{}: mkbound {} has no normals. With SlipMode {} the solver takes an undefined "
            "velocity "
            "where fluid meets such walls: a run can lose fluid there, and two runs differ. Let "
            "<bodyfitted> have this mkbound too, or give it <normals>.",
            def_.file, fmt::join(mks, ", "), def_.solver.slip_mode));
    }

    bool is_beside_fluid(const Vec3& p) const
    {
        for (int i = -1; i <= 1; ++i)
            for (int j = -1; j <= 1; ++j)
                for (int k = -1; k <= 1; ++k)
                {
                    Node n = snap(p, field_.grid);
                    n.x += i;
                    n.y += j;
                    n.z += k;
                    const Run* run = run_at(field_, n);
                    if (run != nullptr && run->mk < def_.mk_bound_first) return true;
                }
        return false;
    }

    /// What a void or another draw takes out of a body leaves a face that is not fitted, and the
    /// particles there without a normal.
    void warn_of_cut_walls()
    {
        if (def_.solver.boundary != 2 || is_layered_.empty()) return;
        std::vector<std::uint64_t> bare(places_.size(), 0);
        parallel_for(
            places_.size(), threads_,
            [&](std::size_t r)
            {
                const RunPlace& place = places_[r];
                if (is_layered_[place.block->mk] == 0) return;
                for (std::uint32_t k = place.begin; k < place.end; ++k)
                    if (normals_[place.id + k] == Float3{} && is_beside_fluid(position(place, k)))
                        ++bare[r];
            },
            64);
        std::map<std::uint16_t, std::uint64_t> of_mk;
        for (std::size_t r = 0; r < places_.size(); ++r)
            if (bare[r] > 0) of_mk[places_[r].block->mk_type] += bare[r];
        for (const auto& [mk, count] : of_mk)
            report_.warnings.push_back(fmt::format(
                "{}: {} particles of mkbound {} beside fluid have no normal, so the solver takes "
                "them for plain DBC: they stand where a void or another draw cut into their body, "
                "and the cut is not a fitted surface. Draw the body with that shape taken out of "
                "it (<boolean op=\"difference\">), or as sheets around the fluid.",
                def_.file, count, mk));
    }

    const CaseDef& def_;
    const CaseParticles& particles_;
    const RunField& field_;
    int threads_;
    NormalsReport& report_;
    std::vector<char> is_layered_; ///< by mk: has layers; empty: none has
    std::vector<RunPlace> places_; ///< of all runs of boundary particles
    std::vector<Float3> normals_;
};

} // namespace

std::vector<Float3> compute_normals(const CaseDef& def, const CaseParticles& particles,
                                    const RunField& field,
                                    const std::vector<ShapePolygons>& geometry, int threads,
                                    NormalsReport& report)
{
    std::vector<Float3> normals =
        NormalsMaker(def, particles, field, threads, report).run(geometry);
    turn_to_mouths(field, particles, normals);
    return normals;
}

} // namespace fppg
