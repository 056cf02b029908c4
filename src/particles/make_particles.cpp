#include "fppg/case_def.h"
#include "fppg/error.h"
#include "fppg/moving_parts.h"
#include "fppg/particles.h"

#include "core/most_particles.h"
#include "core/parallel.h"
#include "particles/density.h"
#include "particles/double_particles.h"
#include "particles/floating.h"
#include "particles/initials.h"
#include "particles/off_lattice_particles.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <mutex>
#include <set>

namespace fppg
{
namespace
{

class ParticleMaker
{
public:
    ParticleMaker(const CaseDef& def, RunField& field, int threads)
        : def_(def), field_(field), threads_(threads), type_of_mk_(65536, ParticleType::Fixed)
    {
    }

    CaseParticles run(CaseConstants& constants, std::vector<std::string>& warnings)
    {
        out_.grid = def_.grid;
        out_.has_walls = !field_.walls.bodies.empty();
        set_types();
        make_blocks();
        number_blocks();
        fill_runs();
        sort_off_lattice();
        set_limits();
        set_constants(constants);
        has_lower_fluid_ = compute_densities({def_, field_, type_of_mk_, off_lattice_begin_}, out_,
                                             constants, threads_);
        orient_blocks();
        merge_off_lattice();
        list_off_lattice_points();
        if (def_.constants.lattice_bound != 1) keep_single();
        if (double_particles(def_, out_)) set_limits();
        set_initials(def_, constants, out_);
        make_floatings();
        set_properties();
        warn(constants, warnings);
        return std::move(out_);
    }

private:
    /// Whether there are particles off the lattice.
    bool has_off_lattice() const { return !off_lattice_of_mk_.empty(); }

    void set_types()
    {
        for (std::uint32_t mk = 1; mk < def_.mk_bound_first; ++mk)
            type_of_mk_[mk] = ParticleType::Fluid;
        const std::set<int> moving = moving_mkbound(def_.motion);
        for (const int mk : moving)
            if (mk + def_.mk_bound_first < 65536)
                type_of_mk_[static_cast<std::size_t>(mk) + def_.mk_bound_first] =
                    ParticleType::Moving;
        for (const FloatingDef& f : def_.floatings)
            for (const std::uint16_t mk : f.mkbound)
            {
                if (mk + def_.mk_bound_first >= 65536) continue;
                if (moving.contains(mk))
                    throw CaseError(def_.file, f.line,
                                    fmt::format("<floating>: mkbound {} is moved by <motion> too, "
                                                "combining floating and "
                                                "moving objects is not possible",
                                                mk));
                type_of_mk_[static_cast<std::size_t>(mk) + def_.mk_bound_first] =
                    ParticleType::Floating;
            }
    }

    void make_blocks()
    {
        std::vector<char> used(65536, 0);
        for (const auto& slab : field_.slabs)
            for (const Run& r : slab)
                if (!r.is_covered) used[r.mk] = 1;
        if (field_.walls.particles.size() + field_.walls.volume.size() > 0)
        {
            off_lattice_of_mk_ = count_off_lattice_particles(field_.walls);
            for (std::size_t mk = 0; mk < used.size(); ++mk)
                if (off_lattice_of_mk_[mk] > 0) used[mk] = 1;
        }
        for (const ParticleType type : {ParticleType::Fixed, ParticleType::Moving,
                                        ParticleType::Floating, ParticleType::Fluid})
            for (std::uint32_t mk = 1; mk < 65536; ++mk)
            {
                if (!used[mk] || type_of_mk_[mk] != type) continue;
                ParticleBlock block;
                block.type = type;
                block.mk = static_cast<std::uint16_t>(mk);
                block.mk_type = static_cast<std::uint16_t>(
                    mk - (type == ParticleType::Fluid ? def_.mk_fluid_first : def_.mk_bound_first));
                out_.blocks.push_back(block);
            }
        block_of_mk_.assign(65536, no_block);
        for (std::size_t b = 0; b < out_.blocks.size(); ++b) block_of_mk_[out_.blocks[b].mk] = b;
    }

    /// Counts runs and nodes a slab and block, then the first id of every block.
    void number_blocks()
    {
        const std::size_t n = out_.blocks.size();
        run_begin_.assign((field_.slabs.size() + 1) * n, 0);
        std::vector<std::uint64_t> nodes(field_.slabs.size() * n, 0);
        parallel_for(
            field_.slabs.size(), threads_,
            [&](std::size_t x)
            {
                for (const Run& r : field_.slabs[x])
                {
                    if (r.is_covered) continue;
                    const std::size_t b = block_of_mk_[r.mk];
                    ++run_begin_[(x + 1) * n + b];
                    nodes[x * n + b] += r.z_end - r.z_begin;
                }
            },
            16);
        for (std::size_t x = 0; x < field_.slabs.size(); ++x)
            for (std::size_t b = 0; b < n; ++b)
            {
                run_begin_[(x + 1) * n + b] += run_begin_[x * n + b];
                out_.blocks[b].count += nodes[x * n + b];
            }
        if (has_off_lattice())
            for (ParticleBlock& block : out_.blocks) block.count += off_lattice_of_mk_[block.mk];
        std::uint64_t all = 0;
        for (const ParticleBlock& block : out_.blocks) all += block.count;
        if (all > most_particles)
            throw CaseError(
                def_.file, 0,
                fmt::format("the case has {} particles, the file format holds at most "
                            "{}; dp={:g} and larger ones fit",
                            all, most_particles_text,
                            dp_that_fits(def_.grid.dp, static_cast<double>(all), def_.grid.is_2d)));
        int moving = 0;
        for (std::size_t b = 0; b < n; ++b)
        {
            ParticleBlock& block = out_.blocks[b];
            block.begin = out_.np;
            out_.np += block.count;
            block.runs.resize(run_begin_[field_.slabs.size() * n + b]);
            if (block.type == ParticleType::Fixed) out_.n_fixed += block.count;
            if (block.type == ParticleType::Floating) out_.n_floating += block.count;
            if (block.type == ParticleType::Fluid) out_.n_fluid += block.count;
            if (block.type != ParticleType::Moving) continue;
            out_.n_moving += block.count;
            block.ref_motion = moving++;
        }
    }

    void fill_runs()
    {
        const std::size_t n = out_.blocks.size();
        parallel_for(
            field_.slabs.size(), threads_,
            [&](std::size_t x)
            {
                std::vector<std::uint64_t> next(
                    run_begin_.begin() + static_cast<std::ptrdiff_t>(x * n),
                    run_begin_.begin() + static_cast<std::ptrdiff_t>((x + 1) * n));
                for (const Run& r : field_.slabs[x])
                {
                    if (r.is_covered) continue;
                    const std::size_t b = block_of_mk_[r.mk];
                    out_.blocks[b].runs[next[b]++] = {static_cast<std::uint32_t>(x), r.y, r.z_begin,
                                                      r.z_end - r.z_begin, 0};
                }
            },
            16);
        run_begin_ = {};
    }

    /// The order that the definition asks for in an mk; the last one counts.
    PositionOrder order_of(std::uint16_t mk) const
    {
        PositionOrder order;
        for (const MkOrient& orient : def_.mk_orients)
            if (orient.mk == mk) order = PositionOrder(orient);
        return order;
    }

    /// Of all its particles, on nodes and off the lattice.
    Box3 box_of(const ParticleBlock& block) const
    {
        Box3 box;
        for (const ParticleRun& run : block.runs)
            for (const std::uint32_t k : {std::uint32_t{0}, run.count - 1})
                box.add(place_in_run(out_, block, run, k));
        const FittedWalls& walls = field_.walls;
        for (std::size_t i = 0; i < walls.particles.size(); ++i)
            if (walls.particles.mk[i] == block.mk) box.add(walls.particles.positions[i]);
        for (std::size_t i = 0; i < walls.volume.size(); ++i)
            if (walls.volume.mk[i] == block.mk) box.add(walls.volume.positions[i]);
        return box;
    }

    void sort_off_lattice()
    {
        off_lattice_begin_.assign(out_.blocks.size() + 1, 0);
        if (!has_off_lattice()) return;
        for (const ParticleBlock& block : out_.blocks) orders_.push_back(order_of(block.mk));
        // An mk has no block where a zone of other resolution left no particle of it.
        for (const std::uint16_t mk : field_.walls.off_lattice_mks)
            if (const std::size_t b = block_of_mk_[mk]; b != no_block)
                orders_[b].use_cells(box_of(out_.blocks[b]));
        out_.off_lattice = sort_off_lattice_particles(field_.walls, out_.blocks, orders_, threads_,
                                                      off_lattice_begin_);
    }

    void merge_off_lattice()
    {
        if (!has_off_lattice()) return;
        for (std::size_t b = 0; b < out_.blocks.size(); ++b)
            merge_off_lattice_particles(out_, out_.blocks[b], orders_[b], off_lattice_begin_[b],
                                        off_lattice_begin_[b + 1]);
    }

    void list_off_lattice_points()
    {
        for (const std::uint16_t mk : field_.walls.off_lattice_mks)
        {
            if (block_of_mk_[mk] == no_block) continue;
            const ParticleBlock& block = out_.blocks[block_of_mk_[mk]];
            for (const ParticleRun& run : block.runs)
                for (std::uint32_t k = 0; k < run.count; ++k)
                    out_.off_lattice_points.positions.push_back(place_in_run(out_, block, run, k));
            out_.off_lattice_points.mk.resize(out_.off_lattice_points.positions.size(), mk);
            out_.off_lattice_points.types.resize(out_.off_lattice_points.positions.size(),
                                                 block.type);
        }
    }

    void set_limits()
    {
        if (out_.np == 0) return;
        Box3 limits;
        for (const Vec3& p : out_.off_lattice.positions) limits.add(p);
        std::array<std::uint32_t, 3> low{UINT32_MAX, UINT32_MAX, UINT32_MAX};
        std::array<std::uint32_t, 3> high{0, 0, 0};
        std::mutex guard;
        constexpr std::size_t runs_per_part = 65536;
        for (const ParticleBlock& block : out_.blocks)
            parallel_for(
                (block.runs.size() + runs_per_part - 1) / runs_per_part, threads_,
                [&](std::size_t part)
                {
                    std::array<std::uint32_t, 3> l{UINT32_MAX, UINT32_MAX, UINT32_MAX};
                    std::array<std::uint32_t, 3> h{0, 0, 0};
                    const std::size_t end = std::min(block.runs.size(), (part + 1) * runs_per_part);
                    for (std::size_t i = part * runs_per_part; i < end; ++i)
                    {
                        const ParticleRun& r = block.runs[i];
                        if (r.is_off_lattice) continue;
                        const std::uint32_t below =
                            block.run_descending ? r.z - (r.count - 1) : r.z;
                        l = {std::min(l[0], r.x), std::min(l[1], r.y), std::min(l[2], below)};
                        h = {std::max(h[0], r.x), std::max(h[1], r.y),
                             std::max(h[2], below + r.count - 1)};
                    }
                    const std::lock_guard lock(guard);
                    for (std::size_t k = 0; k < 3; ++k)
                    {
                        low[k] = std::min(low[k], l[k]);
                        high[k] = std::max(high[k], h[k]);
                    }
                });
        for (int axis = 0; axis < 3; ++axis)
        {
            if (out_.np > out_.off_lattice.size())
            {
                limits.min[axis] = std::min(
                    limits.min[axis], def_.grid.origin[axis] + low[static_cast<std::size_t>(axis)] *
                                                                   def_.grid.step(axis));
                limits.max[axis] =
                    std::max(limits.max[axis],
                             def_.grid.origin[axis] +
                                 high[static_cast<std::size_t>(axis)] * def_.grid.step(axis));
            }
        }
        out_.pos_min = limits.min;
        out_.pos_max = limits.max;
    }

    void set_constants(CaseConstants& constants) const
    {
        const ConstantsDef& c = def_.constants;
        constants.is_2d = def_.grid.is_2d;
        constants.y_2d = def_.grid.is_2d ? def_.grid.origin.y : 0;
        constants.gravity = c.gravity;
        constants.cfl_number = c.cfl_number;
        constants.gamma = c.gamma;
        constants.rhop0 = c.rhop0;
        constants.has_eps = c.eps.has_value();
        constants.eps = c.eps.value_or(0);
        constants.dp = def_.grid.dp;
        constants.h = def_.h;
        constants.mass_bound = def_.mass_bound;
        constants.mass_fluid = def_.mass_fluid;
    }

    /// Puts the particles of a block into the order that mkorient asks for (rule N2). Where z is
    /// not the fastest axis, every node becomes a run of its own.
    void orient_blocks()
    {
        for (const MkOrient& asked : def_.mk_orients)
        {
            const auto found =
                std::find_if(out_.blocks.begin(), out_.blocks.end(),
                             [&](const ParticleBlock& b) { return b.mk == asked.mk; });
            if (found == out_.blocks.end()) continue;
            ParticleBlock& block = *found;
            const std::vector<std::uint16_t>& mks = field_.walls.off_lattice_mks;
            const bool has_off_lattice_ones =
                std::find(mks.begin(), mks.end(), asked.mk) != mks.end();
            const MkOrient orient = has_off_lattice_ones ? orient_of_cells(asked) : asked;
            const bool z_is_fastest = orient.axes[2] == 2;
            if (!z_is_fastest || !out_.rhop.empty()) split_into_nodes(block);
            block.run_descending = false;
            const bool has_values = block.type == ParticleType::Fluid && !out_.rhop.empty();
            const std::uint64_t first = block.begin - (out_.np - out_.n_fluid);
            if (has_values)
                for (std::size_t i = 0; i < block.runs.size(); ++i)
                    block.runs[i].depth = static_cast<std::uint32_t>(i);
            if (z_is_fastest && orient.descending[2])
            {
                block.run_descending = true;
                for (ParticleRun& r : block.runs) r.z += r.count - 1;
            }
            const auto key = [&](const ParticleRun& r)
            {
                const std::array<std::uint32_t, 3> at{r.x, r.y, r.z};
                std::array<std::int64_t, 3> k{};
                for (std::size_t i = 0; i < 3; ++i)
                {
                    k[i] = at[static_cast<std::size_t>(orient.axes[i])];
                    if (orient.descending[i]) k[i] = -k[i];
                }
                return k;
            };
            std::sort(block.runs.begin(), block.runs.end(),
                      [&](const ParticleRun& a, const ParticleRun& b) { return key(a) < key(b); });
            if (!has_values) continue;
            const std::vector<float> old(
                out_.rhop.begin() + static_cast<std::ptrdiff_t>(first),
                out_.rhop.begin() + static_cast<std::ptrdiff_t>(first + block.count));
            for (std::size_t i = 0; i < block.runs.size(); ++i)
            {
                out_.rhop[first + i] = old[block.runs[i].depth];
                block.runs[i].depth = 0;
            }
        }
    }

    static void split_into_nodes(ParticleBlock& block)
    {
        ParticleRuns nodes;
        nodes.reserve(block.count);
        for (const ParticleRun& r : block.runs)
            for (std::uint32_t i = 0; i < r.count; ++i)
                nodes.push_back({r.x, r.y, r.z + i, 1, r.depth + (r.count - 1 - i)});
        block.runs = std::move(nodes);
    }

    /// The particles as they are before `<lattice>` makes two of each: floating bodies are theirs.
    void keep_single()
    {
        single_.grid = out_.grid;
        single_.off_lattice.positions = out_.off_lattice.positions;
        single_.blocks.resize(out_.blocks.size());
        for (std::size_t b = 0; b < out_.blocks.size(); ++b)
            if (out_.blocks[b].type == ParticleType::Floating) single_.blocks[b] = out_.blocks[b];
    }

    void make_floatings()
    {
        for (std::size_t b = 0; b < out_.blocks.size(); ++b)
        {
            if (out_.blocks[b].type != ParticleType::Floating) continue;
            if (const FloatingDef* f = floating_of(out_.blocks[b]))
                out_.floatings.push_back(floating_body(*f, single_.blocks.empty() ? out_ : single_,
                                                       b, out_.blocks[b].initials,
                                                       def_.constants.rhop0));
        }
    }

    /// The definition of a floating block; a later one for the same mkbound wins.
    const FloatingDef* floating_of(const ParticleBlock& block) const
    {
        for (auto f = def_.floatings.rbegin(); f != def_.floatings.rend(); ++f)
            if (std::find(f->mkbound.begin(), f->mkbound.end(), block.mk_type) != f->mkbound.end())
                return &*f;
        return nullptr;
    }

    void set_properties()
    {
        for (ParticleBlock& block : out_.blocks)
        {
            std::set<std::string> names;
            for (const auto& [mk, name] : def_.property_links)
                if (mk == block.mk) names.insert(name);
            block.property = fmt::format("{}", fmt::join(names, "+"));
        }
    }

    void warn(const CaseConstants& constants, std::vector<std::string>& warnings) const
    {
        const double g = norm(def_.constants.gravity);
        if (out_.np == 0)
            warnings.push_back(
                "No particles were created in the defined domain. The solver refuses such a case.");
        else if (out_.n_fluid == 0)
            warnings.push_back("No fluid particles were created in the defined domain.");
        if (!def_.constants.hswl && out_.n_fluid == 0)
            warnings.push_back(
                "Automatic maximum depth is zero since there are no fluid particles.");
        else if (!def_.constants.hswl && g == 0)
            warnings.push_back("Automatic maximum depth is zero since gravity is zero.");
        if (has_lower_fluid_)
            warnings.push_back(fmt::format(
                "{}: <rhopgradient value=\"3\"> takes the depth under the highest fluid for all; "
                "beside body-fitted walls fluid that stands lower has the density of its own "
                "depth.",
                def_.file));
        if (constants.b == 0)
            warnings.push_back("Constant B is zero. The solver refuses such a case.");
    }

    const CaseDef& def_;
    RunField& field_;
    int threads_;
    std::vector<ParticleType> type_of_mk_;
    static constexpr std::size_t no_block = SIZE_MAX;
    std::vector<std::size_t> block_of_mk_;
    std::vector<std::uint64_t> off_lattice_of_mk_; ///< particles off the lattice; empty without any
    std::vector<std::uint64_t>
        off_lattice_begin_; ///< per block its first one in out_.off_lattice, then their number
    std::vector<PositionOrder> orders_;    ///< of every block, where some are off the lattice
    std::vector<std::uint64_t> run_begin_; ///< per slab and block, index of the slab's first run
    bool has_lower_fluid_ = false;
    CaseParticles single_; ///< floating blocks before `<lattice>` doubles them; or empty
    CaseParticles out_;
};

} // namespace

CaseParticles make_particles(const CaseDef& def, RunField& field, int threads,
                             CaseConstants& constants, std::vector<std::string>& warnings)
{
    return ParticleMaker(def, field, threads).run(constants, warnings);
}

} // namespace fppg
