#pragma once

#include "fppg/case_def.h"
#include "fppg/lattice.h"
#include "fppg/particles.h"

#include "core/parallel.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

/// Depths of nodes and particles below the top of their water, as density.h defines them.
namespace fppg
{

/// How a node counts for the depth of the fluid below it.
enum class Medium : std::uint8_t
{
    None,
    Water, ///< fluid or floating
    Wall,  ///< fixed or moving
};

class DepthMeter
{
public:
    /// floatings_are_hosts  whether nodes of floating bodies may be hosts (is_host())
    DepthMeter(const RunField& field, const std::vector<ParticleType>& type_of_mk,
               bool floatings_are_hosts)
        : field_(field), type_of_mk_(type_of_mk), floatings_are_hosts_(floatings_are_hosts)
    {
    }

    Medium medium(std::uint16_t mk) const
    {
        const ParticleType type = type_of_mk_[mk];
        return type == ParticleType::Fluid || type == ParticleType::Floating ? Medium::Water
                                                                             : Medium::Wall;
    }

    bool is_fluid(std::uint16_t mk) const { return type_of_mk_[mk] == ParticleType::Fluid; }

    /// Whether the nearest node of the mk may give a particle off the lattice its depth: those of
    /// floating bodies do in GenCase, not where depths are raised under roofs.
    bool is_host(std::uint16_t mk) const
    {
        return is_fluid(mk) || (floatings_are_hosts_ && medium(mk) == Medium::Water);
    }

    /// For every run of a slab the steps from its highest node to the top of its column.
    std::vector<std::uint32_t> depths_along_z(std::size_t x) const
    {
        const std::vector<Run>& runs = field_.slabs[x];
        std::vector<std::uint32_t> depth(runs.size(), 0);
        for (std::size_t i = runs.size(); i-- > 0;)
        {
            if (medium(runs[i].mk) != Medium::Water || i + 1 == runs.size()) continue;
            const Run& above = runs[i + 1];
            if (above.y != runs[i].y || above.z_begin != runs[i].z_end) continue;
            depth[i] =
                medium(above.mk) == Medium::Wall ? 1 : depth[i + 1] + (above.z_end - above.z_begin);
        }
        return depth;
    }

private:
    const RunField& field_;
    const std::vector<ParticleType>& type_of_mk_;
    bool floatings_are_hosts_;
};

/// Whether a node counts for hswl: also one that a particle off the lattice hides, as it does in
/// GenCase, but none in the zone of a fitted wall.
inline bool counts_for_hswl(const RunField& field, const Run& run)
{
    return field.walls.bodies.empty() || !run.is_covered;
}

/// The node of water that gives a particle off the lattice its depth.
struct Host
{
    static constexpr std::uint32_t none = 0xFFFFFFFF;
    std::uint32_t slab = none;
    std::uint32_t run = 0;   ///< index in the slab
    std::uint32_t below = 0; ///< steps from the run's highest node down to the node
    Vec3 offset;             ///< from the particle to the node, in steps
};

class HostFinder
{
public:
    HostFinder(const RunField& field, const DepthMeter& meter) : field_(field), meter_(meter) {}

    Host find(const Vec3& p) const
    {
        const LatticeGrid& grid = field_.grid;
        const Vec3 q = grid.steps_to(p);
        std::array<std::int64_t, 3> nearest{};
        for (int axis = 0; axis < 3; ++axis)
        {
            const auto k = static_cast<std::size_t>(axis);
            nearest[k] = std::clamp<std::int64_t>(std::llround(q[axis]), 0,
                                                  static_cast<std::int64_t>(grid.n[k]) - 1);
        }
        Best best;
        search_column(nearest[0], nearest[1], q, best);
        for (int ring = 1; ring <= reach; ++ring)
        {
            // Columns of this ring are at least so far away.
            const double gap = ring - 0.5;
            if (best.distance <= gap * gap) break;
            for (std::int64_t dx = -ring; dx <= ring; ++dx)
                for (std::int64_t dy = -ring; dy <= ring; ++dy)
                    if (std::max(std::abs(dx), std::abs(dy)) == ring)
                        search_column(nearest[0] + dx, nearest[1] + dy, q, best);
        }
        return best.host;
    }

private:
    static constexpr int reach = 4; ///< steps
    struct Best
    {
        double distance = double{reach} * reach; ///< squared, in steps
        Host host;
    };

    void search_column(std::int64_t x, std::int64_t y, const Vec3& q, Best& best) const
    {
        if (x < 0 || y < 0 || x >= static_cast<std::int64_t>(field_.slabs.size())) return;
        const std::vector<Run>& runs = field_.slabs[static_cast<std::size_t>(x)];
        const double dx = static_cast<double>(x) - q.x;
        const double dy = static_cast<double>(y) - q.y;
        auto run = std::lower_bound(runs.begin(), runs.end(), y,
                                    [](const Run& r, std::int64_t v) { return r.y < v; });
        for (; run != runs.end() && run->y == y; ++run)
        {
            if (run->z_begin - q.z > reach) return;
            if (q.z - run->z_end > reach || !meter_.is_host(run->mk)) continue;
            const double node = std::clamp(std::round(q.z), static_cast<double>(run->z_begin),
                                           static_cast<double>(run->z_end - 1));
            const double dz = node - q.z;
            const double distance = dx * dx + dy * dy + dz * dz;
            if (distance >= best.distance) continue;
            best.distance = distance;
            best.host = {static_cast<std::uint32_t>(x),
                         static_cast<std::uint32_t>(run - runs.begin()),
                         run->z_end - 1 - static_cast<std::uint32_t>(node),
                         {dx, dy, dz}};
        }
    }

    const RunField& field_;
    const DepthMeter& meter_;
};

/// Calls body(run index in the slab, block, run index in the block) for all runs of particles, slab
/// by slab. Blocks hold their runs in the order of the slabs, so one cursor a block is enough.
class BlockCursor
{
public:
    explicit BlockCursor(CaseParticles& particles)
        : particles_(particles), next_(particles.blocks.size(), 0)
    {
        block_of_mk_.assign(65536, 0);
        for (std::size_t b = 0; b < particles.blocks.size(); ++b)
            block_of_mk_[particles.blocks[b].mk] = b;
    }

    template <typename Body>
    void visit(const std::vector<Run>& runs, const Body& body)
    {
        for (std::size_t i = 0; i < runs.size(); ++i)
        {
            if (runs[i].is_covered) continue;
            const std::size_t b = block_of_mk_[runs[i].mk];
            body(i, particles_.blocks[b], next_[b]++);
        }
    }

private:
    CaseParticles& particles_;
    std::vector<std::size_t> next_;
    std::vector<std::size_t> block_of_mk_;
};

/// Steps in the + direction of x and of y for every node of one slab's water runs.
struct SlabSteps
{
    std::vector<std::size_t> begin; ///< per run, first entry of its nodes
    std::vector<std::uint32_t> x;
    std::vector<std::uint32_t> y;
};

/// For the nodes of `run` the value that the neighbour runs [first, last) give: 0 where there is
/// none, 1 below a wall, the neighbour's own + 1 in water.
template <typename NeighbourValue>
void steps_to_neighbour(const Run& run, const Run* first, const Run* last,
                        const NeighbourValue& value_of, std::uint32_t* out)
{
    std::fill(out, out + (run.z_end - run.z_begin), 0u);
    for (const Run* n = first; n != last && n->z_begin < run.z_end; ++n)
    {
        const std::uint32_t begin = std::max(run.z_begin, n->z_begin);
        const std::uint32_t end = std::min(run.z_end, n->z_end);
        for (std::uint32_t z = begin; z < end; ++z) out[z - run.z_begin] = value_of(*n, z);
    }
}

inline const Run* row_begin(const std::vector<Run>& runs, std::uint32_t y)
{
    const auto it = std::lower_bound(runs.begin(), runs.end(), y,
                                     [](const Run& r, std::uint32_t v) { return r.y < v; });
    return runs.data() + (it - runs.begin());
}

/// Depths when gravity is not along z: one value a water node, slab by slab from the last x on.
class TiltedDepths
{
public:
    TiltedDepths(const Vec3& gravity, const RunField& field, const DepthMeter& meter)
        : field_(field),
          meter_(meter),
          gravity_(gravity),
          steps_{field.grid.step(0), field.grid.step(1), field.grid.step(2)},
          g_(norm(gravity_))
    {
    }

    /// What is known of one slab.
    struct Slab
    {
        std::size_t x = 0;
        SlabSteps steps;
        std::vector<std::uint32_t> top; ///< per run, from its highest node
    };

    /// Calls body(slab, run index, node in the run, depth) for the water nodes of every slab, last
    /// slab first, and after_slab(slab) behind each.
    template <typename Body, typename AfterSlab>
    void for_each(const Body& body, const AfterSlab& after_slab)
    {
        Slab slab;
        for (std::size_t x = field_.slabs.size(); x-- > 0;)
        {
            const std::vector<Run>& runs = field_.slabs[x];
            slab.steps = count(x, slab.steps);
            slab.x = x;
            slab.top = meter_.depths_along_z(x);
            for (std::size_t i = 0; i < runs.size(); ++i)
            {
                if (meter_.medium(runs[i].mk) != Medium::Water) continue;
                const std::uint32_t n = runs[i].z_end - runs[i].z_begin;
                for (std::uint32_t k = 0; k < n; ++k) body(x, i, k, depth(slab, i, n - 1 - k, {}));
            }
            after_slab(slab);
        }
    }

    /// The depth `below` steps under the highest node of a run, and `offset` steps towards the
    /// smaller coordinates from there.
    double depth(const Slab& slab, std::size_t run, std::uint32_t below, const Vec3& offset) const
    {
        const Run& r = field_.slabs[slab.x][run];
        const std::size_t at = slab.steps.begin[run] + (r.z_end - r.z_begin - 1 - below);
        const double dx = std::max(slab.steps.x[at] + offset.x, 0.0) * steps_.x * gravity_.x;
        const double dy = std::max(slab.steps.y[at] + offset.y, 0.0) * steps_.y * gravity_.y;
        const double dz = std::max(slab.top[run] + below + offset.z, 0.0) * steps_.z * gravity_.z;
        return std::sqrt(dx * dx + dy * dy + dz * dz) / g_;
    }

private:
    SlabSteps count(std::size_t x, const SlabSteps& next) const
    {
        const std::vector<Run>& runs = field_.slabs[x];
        SlabSteps steps;
        std::size_t nodes = 0;
        for (const Run& r : runs)
        {
            steps.begin.push_back(nodes);
            nodes += r.z_end - r.z_begin;
        }
        steps.x.assign(nodes, 0);
        steps.y.assign(nodes, 0);
        const std::vector<Run> none;
        const std::vector<Run>& beyond = x + 1 < field_.slabs.size() ? field_.slabs[x + 1] : none;
        const auto value = [this](const std::vector<Run>& of, const SlabSteps& known,
                                  const std::vector<std::uint32_t>& values)
        {
            return [this, &of, &known, &values](const Run& n, std::uint32_t z) -> std::uint32_t
            {
                if (meter_.medium(n.mk) == Medium::Wall) return 1;
                return values[known.begin[static_cast<std::size_t>(&n - of.data())] +
                              (z - n.z_begin)] +
                       1;
            };
        };
        for (std::size_t i = runs.size(); i-- > 0;)
        {
            if (meter_.medium(runs[i].mk) != Medium::Water) continue;
            if (gravity_.x != 0)
                steps_to_neighbour(runs[i], row_begin(beyond, runs[i].y),
                                   row_begin(beyond, runs[i].y + 1), value(beyond, next, next.x),
                                   steps.x.data() + steps.begin[i]);
            if (gravity_.y != 0)
                steps_to_neighbour(runs[i], row_begin(runs, runs[i].y + 1),
                                   row_begin(runs, runs[i].y + 2), value(runs, steps, steps.y),
                                   steps.y.data() + steps.begin[i]);
        }
        return steps;
    }

    const RunField& field_;
    const DepthMeter& meter_;
    Vec3 gravity_;
    Vec3 steps_; ///< of the lattice, metres
    double g_;
};

/// Depths, in metres, of the particles off the lattice that are water.
class OffLatticeDepths
{
public:
    OffLatticeDepths(const RunField& field, const DepthMeter& meter,
                     const std::vector<std::uint64_t>& off_lattice_begin,
                     const CaseParticles& particles, int threads)
        : blocks_(particles.blocks), off_lattice_begin_(off_lattice_begin)
    {
        for (std::size_t b = 0; b < blocks_.size(); ++b)
            if (blocks_[b].type == ParticleType::Fluid || blocks_[b].type == ParticleType::Floating)
            {
                // Blocks are sorted by type, so all of water stand together.
                if (hosts_.empty()) first_ = off_lattice_begin[b];
                hosts_.resize(off_lattice_begin[b + 1] - first_);
            }
        depths_.assign(hosts_.size(), 0);
        of_nodes_.assign(hosts_.size(), 0);
        const HostFinder finder(field, meter);
        parallel_for(
            hosts_.size(), threads,
            [&](std::size_t i)
            { hosts_[i] = finder.find(particles.off_lattice.positions[first_ + i]); },
            1024);
    }

    bool is_empty() const { return hosts_.empty(); }
    std::uint64_t first() const { return first_; }
    double depth(std::uint64_t particle) const { return depths_[particle - first_]; }
    /// The largest depth of the nodes that the particles are nearest to.
    double deepest() const
    {
        return of_nodes_.empty() ? 0 : *std::max_element(of_nodes_.begin(), of_nodes_.end());
    }

    void measure_along_z(const std::vector<std::vector<std::uint32_t>>& top, double step)
    {
        for (std::size_t i = 0; i < hosts_.size(); ++i)
        {
            const Host& h = hosts_[i];
            if (h.slab == Host::none) continue;
            const double steps = top[h.slab][h.run] + h.below;
            depths_[i] = std::max(steps + h.offset.z, 0.0) * step;
            of_nodes_[i] = steps * step;
        }
    }

    /// Sorts the particles by slab, so that measure() finds those of one.
    void sort_by_slab(std::size_t slabs)
    {
        slab_begin_.assign(slabs + 1, 0);
        for (const Host& h : hosts_)
            if (h.slab != Host::none) ++slab_begin_[h.slab + 1];
        for (std::size_t x = 0; x < slabs; ++x) slab_begin_[x + 1] += slab_begin_[x];
        by_slab_.resize(slab_begin_[slabs]);
        std::vector<std::uint64_t> next(slab_begin_.begin(), slab_begin_.end() - 1);
        for (std::size_t i = 0; i < hosts_.size(); ++i)
            if (hosts_[i].slab != Host::none)
                by_slab_[next[hosts_[i].slab]++] = static_cast<std::uint32_t>(i);
    }
    void measure(const TiltedDepths& tilted, const TiltedDepths::Slab& slab)
    {
        for (std::uint64_t k = slab_begin_[slab.x]; k < slab_begin_[slab.x + 1]; ++k)
        {
            const Host& h = hosts_[by_slab_[k]];
            depths_[by_slab_[k]] = tilted.depth(slab, h.run, h.below, h.offset);
            of_nodes_[by_slab_[k]] = tilted.depth(slab, h.run, h.below, {});
        }
    }

    /// Calls body(particle, block) for those of the fluid.
    template <typename Body>
    void for_each_of_fluid(const Body& body) const
    {
        for (std::size_t b = 0; b < blocks_.size(); ++b)
            if (blocks_[b].type == ParticleType::Fluid)
                for (std::uint64_t i = off_lattice_begin_[b]; i < off_lattice_begin_[b + 1]; ++i)
                    body(i, blocks_[b]);
    }

private:
    const std::vector<ParticleBlock>& blocks_;
    const std::vector<std::uint64_t>& off_lattice_begin_;
    std::uint64_t first_ = 0;
    std::vector<Host> hosts_;
    std::vector<double> depths_;
    std::vector<double> of_nodes_;
    std::vector<std::uint64_t> slab_begin_;
    std::vector<std::uint32_t> by_slab_;
};

/// What the nodes of water reach to.
struct WaterLimits
{
    // Of s = -position . gravity / g over the fluid, for rhopgradient 3.
    double s_max = -std::numeric_limits<double>::infinity();
    double s_min = std::numeric_limits<double>::infinity();
    std::uint32_t z_max = 0;   ///< of the fluid
    std::uint32_t deepest = 0; ///< steps, fluid and floating, vertical gravity

    void add(double s)
    {
        s_max = std::max(s_max, s);
        s_min = std::min(s_min, s);
    }
    void add(const WaterLimits& other)
    {
        s_max = std::max(s_max, other.s_max);
        s_min = std::min(s_min, other.s_min);
        z_max = std::max(z_max, other.z_max);
        deepest = std::max(deepest, other.deepest);
    }
};

} // namespace fppg
