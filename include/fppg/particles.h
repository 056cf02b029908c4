#pragma once

#include "fppg/initials.h"
#include "fppg/lattice.h"
#include "fppg/rgb.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

enum class ParticleType : std::uint8_t
{
    Fixed = 0,
    Moving = 1,
    Floating = 2,
    Fluid = 3,
};

/// `count` lattice nodes of one column in id order, from node (x, y, z) on, upwards in z unless the
/// block says otherwise; or `count` consecutive particles off the lattice.
struct ParticleRun
{
    /// A run of particles off the lattice, from this index of CaseParticles::off_lattice on. They
    /// follow one another upwards whatever the block says.
    static ParticleRun of_off_lattice(std::uint64_t begin, std::uint32_t count)
    {
        ParticleRun run;
        run.count = count;
        run.is_off_lattice = true;
        run.set_off_lattice_begin(begin);
        return run;
    }
    /// Of a run of particles off the lattice, which needs no node: x and y hold it.
    std::uint64_t off_lattice_begin() const { return x | static_cast<std::uint64_t>(y) << 32U; }
    void set_off_lattice_begin(std::uint64_t begin)
    {
        x = static_cast<std::uint32_t>(begin);
        y = static_cast<std::uint32_t>(begin >> 32U);
    }

    std::uint32_t x = 0;
    std::uint32_t y = 0;
    std::uint32_t z = 0;
    std::uint32_t count = 0;
    /// Fluid only: steps of dp from the run's highest node up to the top of its water column.
    std::uint32_t depth = 0;
    bool is_off_lattice = false;
};

/// Leaves values that are made without a value unwritten, so that the threads which fill them bring
/// their memory in. T is trivially copyable.
template <typename T>
struct UnwrittenAllocator : std::allocator<T>
{
    template <typename U>
    struct rebind
    {
        using other = UnwrittenAllocator<U>;
    };
    template <typename U>
    void construct(U*) noexcept
    {
    }
    template <typename U, typename... Arguments>
    void construct(U* at, Arguments&&... arguments)
    {
        ::new (static_cast<void*>(at)) U{std::forward<Arguments>(arguments)...};
    }
};

/// After resize() new runs must be written before they are read.
using ParticleRuns = std::vector<ParticleRun, UnwrittenAllocator<ParticleRun>>;

/// All particles of one mk. Ids of a block are consecutive.
struct ParticleBlock
{
    ParticleType type = ParticleType::Fixed;
    std::uint16_t mk = 0;      ///< absolute
    std::uint16_t mk_type = 0; ///< mkbound or mkfluid
    std::uint64_t begin = 0;   ///< first id
    std::uint64_t count = 0;
    bool run_descending = false; ///< a run's nodes follow one another downwards in z
    ParticleRuns runs;           ///< in id order; their counts add up to `count`
    std::string property;        ///< names joined with '+', or empty
    std::optional<Rgb> colour;   ///< of the CAD model that it was drawn from
    int ref_motion = -1;         ///< moving: index in the motion of Case.xml
    /// What `<initials>` does to its particles; nothing in them is empty. Runs and densities are
    /// those before it.
    std::vector<InitialOp> initials;
};

/// Particles off the lattice before `<initials>`, in id order, one entry each in all arrays.
struct OffLatticeParticles
{
    std::vector<Vec3> positions;
    std::vector<FitKind> kinds;
    /// Outward unit normal of the facet; on an edge or a corner the mean of the facets that meet
    /// there, weighted by their angles; zero for FitKind::Volume.
    std::vector<std::array<float, 3>> normals;
    std::vector<float> distances; ///< metres to the surface it belongs to, negative inside
    std::vector<float> rhop;      ///< boundary and floating particles: rhop0
    /// Of fitted walls: 1 the layer nearest to the surface or on it, 2 the next; 0: in no layer.
    std::vector<std::uint8_t> layers;
    /// How much of dp^3 (2D: dp^2) of a body it stands for (FittedBody::share); empty: all are 1.
    std::vector<float> shares;

    std::size_t size() const { return positions.size(); }
    bool is_of_wall(std::size_t i) const { return kinds[i] != FitKind::Volume; }
    bool has_walls() const
    {
        return std::any_of(kinds.begin(), kinds.end(),
                           [](FitKind kind) { return kind != FitKind::Volume; });
    }
};

/// Distance of a lattice node to the walls in pictures: it is not measured, and far from any.
inline constexpr float distance_of_nodes = 1e9F;

/// What the solver needs of a floating body. SI units.
struct FloatingBody
{
    std::size_t block = 0; ///< index into CaseParticles::blocks
    double mass_body = 0;
    double mass_part = 0;
    Vec3 center;
    std::array<Vec3, 3> inertia; ///< rows; off-diagonal entries carry the minus sign
};

/// Constants of the case as they go into Case.xml and Case.bi4; SI units.
struct CaseConstants
{
    bool is_2d = false;
    double y_2d = 0;
    Vec3 gravity;
    double cfl_number = 0;
    double gamma = 0;
    double rhop0 = 0;
    bool has_eps = false;
    double eps = 0;
    double dp = 0;
    double h = 0;
    double b = 0;
    double mass_bound = 0;
    double mass_fluid = 0;
    // Not stored in the files, printed:
    double hswl = 0;
    double speed_system = 0;
    double speed_sound = 0;
    double surface = 0; ///< highest fluid against gravity, metres; set for rhopgradient 3
};

/// Particles as `_FreePt.vtk` shows them, one entry each in all arrays.
struct OffLatticePoints
{
    std::vector<Vec3> positions;
    std::vector<std::uint16_t> mk;
    std::vector<ParticleType> types;
};

/// The particles of a case in id order: fixed, moving, floating, fluid; within a type by mk; within
/// an mk by x, y, z (or by the order that mkorient asks for), those off the lattice among the
/// nodes. Positions and densities of nodes are not stored: writers make them from the runs, node n
/// at grid.origin + n * grid.dp, and apply the `initials` of the block.
struct CaseParticles
{
    LatticeGrid grid;
    std::vector<ParticleBlock> blocks;
    OffLatticeParticles off_lattice;
    bool has_walls = false; ///< the case has fitted walls: pictures show kind, normal, distance
    std::uint64_t np = 0;
    std::uint64_t n_fixed = 0;
    std::uint64_t n_moving = 0;
    std::uint64_t n_floating = 0;
    std::uint64_t n_fluid = 0;
    Vec3 pos_min; ///< exact limits of all positions; zeros when np is 0
    Vec3 pos_max;
    std::vector<FloatingBody> floatings;

    /// Fluid density. When gravity is along z (or zero), `rhop` is empty and the node `s` steps
    /// below the highest node of a run has rhop_of_depth[run.depth + s]. Otherwise `rhop` holds one
    /// value per fluid particle, in id order, those off the lattice too. Boundary and floating
    /// particles have rhop0. Particles off the lattice have free.rhop.
    std::vector<float> rhop_of_depth;
    std::vector<float> rhop;
    /// Density of every boundary and floating particle, in id order, those off the lattice too;
    /// empty: rhop0.
    std::vector<float> bound_rhop;

    /// Metres cubed (2D: squared) that each particle stands for, in id order; empty: no body asks
    /// for its own (FitSettings::has_exact_volumes).
    std::vector<double> volumes;

    /// From every boundary particle to the boundary's surface, in id order; empty: the case asks
    /// for no normals. Zero: none.
    std::vector<std::array<float, 3>> bound_normals;

    /// All particles of the mks that have one of `setfrdrawmode`, those on nodes too, by mk, in an
    /// mk in id order; before `<lattice>` and `<initials>`.
    OffLatticePoints off_lattice_points;
};

struct CaseDef;

/// Turns the nodes of a case into its particles and derives the constants that depend on them:
/// order and ids (rules N1 to N4), floating bodies, densities and hswl by GenCase's formulas.
/// `<initials>` are distributed over the blocks; floating bodies and limits are those after it.
///
/// With fitted walls, covered nodes give no particle; the particles of field.walls join the block
/// of their mk. In the order of a block all positions are compared as doubles; at equal ones nodes
/// come first, then the particles of walls, then those of the volume. Fluid of `<setfrdrawmode>`
/// has rhop0, as in GenCase, unless def.hydrostatic_off_lattice. Another fluid particle off the
/// lattice has the density of its true place below the top of the water column of its nearest node;
/// where that is no water, of the nearest node of water within 4 dp, and rhop0 where there is none.
///
/// field      the particles of its walls move into the result: it has none afterwards
/// threads    number of threads; the result does not depend on it
/// constants  filled: what the definition fixes, the rest by formula
/// warnings   sentences that GenCase prints too are appended: no particles, no fluid, depth or b
///            zero
/// throws    CaseError when a block is both moving and floating, a move leads out of the domain, or
///           there are more particles than ids
/// cost      O(runs) time and memory; O(particles) only where gravity is neither zero nor along z
///           or `<initials>` need every place; O(n log n) for n particles off the lattice
CaseParticles make_particles(const CaseDef& def, RunField& field, int threads,
                             CaseConstants& constants, std::vector<std::string>& warnings);

} // namespace fppg
