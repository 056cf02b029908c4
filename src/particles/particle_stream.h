#pragma once

#include "fppg/particles.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace fppg
{

/// Of the files that are written in pieces: one MiB of the 32 bytes of Posd, Rhop and Idp in
/// Case.bi4; one MiB or two in VTK, of 27 bytes per particle, 12 more with velocities, 16 with
/// normals and 20 with walls.
inline constexpr std::uint64_t particles_per_piece = 32768;

/// Consecutive particles of one run. Their places among the particles of the run are
/// [offset, offset + count).
struct ParticleSegment
{
    const ParticleBlock* block = nullptr;
    const ParticleRun* run = nullptr;
    std::uint32_t offset = 0;
    std::uint32_t count = 0;
    std::uint64_t id = 0; ///< of the first one
};

/// Particles [first, last) cut into pieces of equal size that can be written independently of one
/// another. Only the place where each piece begins is kept, so memory grows with the number of
/// pieces; cost of making it: one pass over the runs.
class ParticleStream
{
public:
    /// particles  must outlive the stream
    ParticleStream(const CaseParticles& particles, std::uint64_t first, std::uint64_t last,
                   std::uint64_t piece_size);

    std::size_t pieces() const { return places_.size(); }
    std::uint64_t first() const { return first_; }
    std::uint64_t begin(std::size_t piece) const { return first_ + piece * piece_size_; }
    std::uint64_t end(std::size_t piece) const
    {
        return std::min(last_, first_ + (piece + 1) * piece_size_);
    }

    /// Calls body(segment) for the segments of a piece in id order.
    template <typename Body>
    void for_each_segment(std::size_t piece, const Body& body) const
    {
        auto [block, run, offset] = places_[piece];
        std::uint64_t id = begin(piece);
        const std::uint64_t stop = end(piece);
        while (id < stop)
        {
            const ParticleBlock& b = particles_->blocks[block];
            if (run == b.runs.size())
            {
                ++block;
                run = 0;
                continue;
            }
            ParticleSegment segment;
            segment.block = &b;
            segment.run = &b.runs[run];
            segment.offset = offset;
            segment.count = static_cast<std::uint32_t>(
                std::min<std::uint64_t>(segment.run->count - offset, stop - id));
            segment.id = id;
            if (segment.count > 0) body(segment);
            id += segment.count;
            offset = 0;
            ++run;
        }
    }

private:
    struct Place
    {
        std::size_t block = 0;
        std::size_t run = 0;
        std::uint32_t offset = 0;
    };

    const CaseParticles* particles_;
    std::uint64_t first_;
    std::uint64_t last_;
    std::uint64_t piece_size_;
    std::vector<Place> places_;
};

/// Calls put(place in the segment, x, y, z) for the position of every particle of a segment.
template <typename Put>
void for_each_position(const CaseParticles& particles, const ParticleSegment& segment,
                       const Put& put)
{
    if (segment.run->is_off_lattice)
    {
        const Vec3* p = particles.off_lattice.positions.data() + segment.run->off_lattice_begin() +
                        segment.offset;
        for (std::int64_t k = 0; k < segment.count; ++k) put(k, p[k].x, p[k].y, p[k].z);
        return;
    }
    const LatticeGrid& grid = particles.grid;
    const double x = grid.origin.x + segment.run->x * grid.step(0);
    const double y = grid.origin.y + segment.run->y * grid.step(1);
    const double origin_z = grid.origin.z;
    const double step_z = grid.step(2);
    const std::int64_t step = segment.block->run_descending ? -1 : 1;
    const std::int64_t z = static_cast<std::int64_t>(segment.run->z) + step * segment.offset;
    const std::int64_t count = segment.count;
    for (std::int64_t k = 0; k < count; ++k)
        put(k, x, y, origin_z + static_cast<double>(z + step * k) * step_z);
}

/// Calls put(place in the segment, density) for every particle of a segment.
template <typename Put>
void for_each_density(const CaseParticles& particles, float rhop0, const ParticleSegment& segment,
                      const Put& put)
{
    const std::uint32_t count = segment.count;
    if (segment.block->type != ParticleType::Fluid && !particles.bound_rhop.empty())
    {
        const float* values = particles.bound_rhop.data() + segment.id;
        for (std::uint32_t k = 0; k < count; ++k) put(k, values[k]);
        return;
    }
    if (segment.run->is_off_lattice)
    {
        const float* values =
            particles.off_lattice.rhop.data() + segment.run->off_lattice_begin() + segment.offset;
        for (std::uint32_t k = 0; k < count; ++k) put(k, values[k]);
        return;
    }
    if (segment.block->type != ParticleType::Fluid ||
        (particles.rhop.empty() && particles.rhop_of_depth.empty()))
    {
        for (std::uint32_t k = 0; k < count; ++k) put(k, rhop0);
        return;
    }
    if (!particles.rhop.empty())
    {
        const std::uint64_t first_fluid = particles.np - particles.n_fluid;
        const float* values = particles.rhop.data() + (segment.id - first_fluid);
        for (std::uint32_t k = 0; k < count; ++k) put(k, values[k]);
        return;
    }
    // The node of place p stands p steps below the run's highest node when the run descends, else
    // run.count - 1 - p steps.
    const float* table = particles.rhop_of_depth.data() + segment.run->depth;
    if (segment.block->run_descending)
    {
        const float* values = table + segment.offset;
        for (std::uint32_t k = 0; k < count; ++k) put(k, values[k]);
    }
    else
    {
        const float* values = table + (segment.run->count - segment.offset - count);
        for (std::uint32_t k = 0; k < count; ++k) put(k, values[count - 1 - k]);
    }
}

/// A buffer of at least that size, one per thread and kept for its next piece: a fresh one each
/// time would cost more than filling it. Valid until the thread calls this again.
char* piece_buffer(std::size_t bytes);

} // namespace fppg
