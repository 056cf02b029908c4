#include "particles/particle_stream.h"

#include <cassert>
#include <memory>

namespace fppg
{

ParticleStream::ParticleStream(const CaseParticles& particles, std::uint64_t first,
                               std::uint64_t last, std::uint64_t piece_size)
    : particles_(&particles), first_(first), last_(last), piece_size_(piece_size)
{
    places_.reserve((last - first + piece_size - 1) / piece_size);
    std::uint64_t next = first; // id at which the next piece begins
    for (std::size_t b = 0; b < particles.blocks.size() && next < last; ++b)
    {
        const ParticleBlock& block = particles.blocks[b];
        if (block.begin + block.count <= next) continue;
        std::uint64_t id = block.begin;
        for (std::size_t r = 0; r < block.runs.size(); ++r)
        {
            const std::uint64_t end = id + block.runs[r].count;
            for (; next < end && next < last; next += piece_size)
                places_.push_back({b, r, static_cast<std::uint32_t>(next - id)});
            id = end;
        }
        assert(id == block.begin + block.count);
    }
    assert(next >= last);
}

char* piece_buffer(std::size_t bytes)
{
    thread_local std::unique_ptr<char[]> buffer;
    thread_local std::size_t size = 0;
    if (size < bytes)
    {
        buffer.reset(new char[bytes]);
        size = bytes;
    }
    return buffer.get();
}

} // namespace fppg
