// Every part of the file has a size that is known in advance, so its pieces are written at their
// places by several threads. Vel is zero but where `<initials>` sets it, and a reserved file reads
// as zeros: only pieces with such particles are written.

#include "core/parallel.h"
#include "files/vtk.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "particles/initials.h"
#include "particles/particle_stream.h"

#include <fmt/format.h>

namespace fppg
{

namespace
{

constexpr std::uint64_t max_vtk_particles = 2147483647U;

/// A part of the file: a line or more of text, then `width` bytes per particle.
struct Part
{
    std::string text;
    std::uint64_t data = 0;
};

/// What the file says of a particle besides place, id, type and mk.
struct Contents
{
    bool vel_and_rhop = false;
    bool normals = false; ///< then Mk stands before Type
    bool walls = false;
    std::uint64_t mk_width = 1;
    bool volumes = false;
};

struct Layout
{
    Part points, vertices, idp, vel, rhop, type, mk, normals, sizes, kind, wall_normal, distance,
        layer, volume;
    Contents has;
    std::uint64_t size = 0;
};

Layout lay_out(std::uint64_t n, const Contents& has)
{
    Layout layout;
    layout.has = has;
    // Binary data end with a line end, so all parts but the first begin with one.
    const auto place = [&](Part& part, std::string text, std::uint64_t width)
    {
        part.text = std::move(text);
        part.data = layout.size + part.text.size();
        layout.size = part.data + n * width;
    };
    place(layout.points, fmt::format("{}POINTS {} float\n", vtk_head, n), 12);
    place(layout.vertices, fmt::format("\nVERTICES {} {}\n", n, 2 * n), 8);
    place(layout.idp,
          fmt::format("\nPOINT_DATA {}\nSCALARS Idp unsigned_int\nLOOKUP_TABLE default\n", n), 4);
    const std::string fields =
        fmt::format("\nFIELD FieldData {}", 2 + (has.vel_and_rhop ? 2 : 0) + (has.normals ? 2 : 0) +
                                                (has.walls ? 4 : 0) + (has.volumes ? 1 : 0));
    const char* const mk_type = has.mk_width == 1 ? "unsigned_char" : "unsigned_short";
    if (has.vel_and_rhop)
    {
        place(layout.vel, fmt::format("{}\nVel 3 {} float\n", fields, n), 12);
        place(layout.rhop, fmt::format("\nRhop 1 {} float\n", n), 4);
    }
    if (has.normals)
    {
        place(layout.mk, fmt::format("{}\nMk 1 {} {}\n", fields, n, mk_type), has.mk_width);
        place(layout.type, fmt::format("\nType 1 {} unsigned_char\n", n), 1);
        place(layout.normals, fmt::format("\nNormal 3 {} float\n", n), 12);
        place(layout.sizes, fmt::format("\nNormalSize 1 {} float\n", n), 4);
    }
    else
    {
        place(layout.type,
              fmt::format("{}\nType 1 {} unsigned_char\n", has.vel_and_rhop ? "" : fields, n), 1);
        place(layout.mk, fmt::format("\nMk 1 {} {}\n", n, mk_type), has.mk_width);
    }
    if (has.walls)
    {
        place(layout.kind, fmt::format("\nKind 1 {} int\n", n), 4);
        place(layout.wall_normal,
              fmt::format("\n{} 3 {} float\n", has.normals ? "WallNormal" : "Normal", n), 12);
        place(layout.distance, fmt::format("\nDistance 1 {} float\n", n), 4);
        place(layout.layer, fmt::format("\nLayer 1 {} int\n", n), 4);
    }
    if (has.volumes) place(layout.volume, fmt::format("\nVolume 1 {} double\n", n), 8);
    layout.size += 1;
    return layout;
}

/// Where the values of a piece stand in its buffer.
struct PieceBuffer
{
    PieceBuffer(char* start, std::size_t n, const Contents& has)
        : points(reinterpret_cast<std::uint32_t*>(start)),
          vertices(points + 3 * n),
          idp(vertices + 2 * n),
          rhop(idp + n),
          vel(rhop + n),
          normals(vel + (has.vel_and_rhop ? 3 * n : 0)),
          sizes(normals + (has.normals ? 3 * n : 0)),
          kind(sizes + (has.normals ? n : 0)),
          wall_normal(kind + (has.walls ? n : 0)),
          distance(wall_normal + (has.walls ? 3 * n : 0)),
          layer(distance + (has.walls ? n : 0)),
          mk16(reinterpret_cast<std::uint16_t*>(layer + (has.walls ? n : 0))),
          mk8(reinterpret_cast<std::uint8_t*>(mk16)),
          type(mk8 + 2 * n)
    {
    }
    static std::size_t bytes_per_particle(const Contents& has)
    {
        return std::size_t{12 + 8 + 4 + 4 + 2 + 1} + (has.vel_and_rhop ? 12 : 0) +
               (has.normals ? 16 : 0) + (has.walls ? 24 : 0);
    }

    std::uint32_t* points;
    std::uint32_t* vertices;
    std::uint32_t* idp;
    std::uint32_t* rhop;
    std::uint32_t* vel;     ///< with vel_and_rhop
    std::uint32_t* normals; ///< with normals, as sizes
    std::uint32_t* sizes;
    std::uint32_t* kind; ///< with walls, as wall_normal, distance and layer
    std::uint32_t* wall_normal;
    std::uint32_t* distance;
    std::uint32_t* layer;
    std::uint16_t* mk16;
    std::uint8_t* mk8;
    std::uint8_t* type;
};

/// Runs `<initials>` on the particles of a segment.
void start_segment(const PieceBuffer& buffer, std::size_t at, const Contents& has,
                   const CaseParticles& particles, const ParticleSegment& segment)
{
    const auto start = [&](std::int64_t place, double x, double y, double z)
    {
        const std::size_t k = at + static_cast<std::size_t>(place);
        InitialState state{{x, y, z},
                           {},
                           0,
                           segment.id + static_cast<std::uint64_t>(place) - segment.block->begin};
        if (has.vel_and_rhop)
            state.rhop = static_cast<double>(std::bit_cast<float>(big_endian(buffer.rhop[k])));
        apply_initials(segment.block->initials, state);
        for (int axis = 0; axis < 3; ++axis)
        {
            const std::size_t i = 3 * k + static_cast<std::size_t>(axis);
            buffer.points[i] = big_endian(static_cast<float>(state.position[axis]));
            if (has.vel_and_rhop)
                buffer.vel[i] = big_endian(static_cast<float>(state.velocity[axis]));
        }
        if (has.vel_and_rhop) buffer.rhop[k] = big_endian(static_cast<float>(state.rhop));
    };
    for_each_position(particles, segment, start);
}

/// Normals of `count` boundary particles from id `begin` on, and their lengths.
void fill_normals(const PieceBuffer& buffer, const CaseParticles& particles, std::uint64_t begin,
                  std::size_t count)
{
    for (std::size_t k = 0; k < count; ++k)
    {
        const std::array<float, 3>& n = particles.bound_normals[begin + k];
        for (std::size_t i = 0; i < 3; ++i) buffer.normals[3 * k + i] = big_endian(n[i]);
        const double length = norm({n[0], n[1], n[2]});
        buffer.sizes[k] = big_endian(static_cast<float>(length));
    }
}

/// Kind, normal, distance and layer.
void fill_walls(const PieceBuffer& buffer, std::size_t at, const OffLatticeParticles& off_lattice,
                const ParticleSegment& segment)
{
    const ParticleRun& run = *segment.run;
    if (!run.is_off_lattice)
    {
        std::fill_n(buffer.kind + at, segment.count,
                    big_endian(static_cast<std::uint32_t>(FitKind::Volume)));
        std::fill_n(buffer.wall_normal + 3 * at, 3 * std::size_t{segment.count}, std::uint32_t{0});
        std::fill_n(buffer.distance + at, segment.count, big_endian(distance_of_nodes));
        std::fill_n(buffer.layer + at, segment.count, std::uint32_t{0});
        return;
    }
    Transform turn = motion_of(*segment.block);
    turn.offset = {};
    for (std::size_t k = 0; k < segment.count; ++k)
    {
        const std::size_t from = run.off_lattice_begin() + segment.offset + k;
        buffer.kind[at + k] = big_endian(static_cast<std::uint32_t>(off_lattice.kinds[from]));
        const std::array<float, 3>& n = off_lattice.normals[from];
        const Vec3 normal = turn({n[0], n[1], n[2]});
        for (int axis = 0; axis < 3; ++axis)
            buffer.wall_normal[3 * (at + k) + static_cast<std::size_t>(axis)] =
                big_endian(static_cast<float>(normal[axis]));
        buffer.distance[at + k] = big_endian(off_lattice.distances[from]);
        buffer.layer[at + k] = big_endian(std::uint32_t{off_lattice.layers[from]});
    }
}

void fill_segment(const PieceBuffer& buffer, std::size_t at, const Layout& layout,
                  const CaseParticles& particles, float rhop0, const ParticleSegment& segment)
{
    std::uint32_t* points = buffer.points + 3 * at;
    for_each_position(particles, segment,
                      [&](std::int64_t k, double x, double y, double z)
                      {
                          points[3 * k] = big_endian(static_cast<float>(x));
                          points[3 * k + 1] = big_endian(static_cast<float>(y));
                          points[3 * k + 2] = big_endian(static_cast<float>(z));
                      });
    if (layout.has.vel_and_rhop)
    {
        std::uint32_t* rhop = buffer.rhop + at;
        for_each_density(particles, rhop0, segment,
                         [&](std::uint32_t k, float v) { rhop[k] = big_endian(v); });
    }
    if (layout.has.walls) fill_walls(buffer, at, particles.off_lattice, segment);
    const ParticleBlock& block = *segment.block;
    if (!block.initials.empty()) start_segment(buffer, at, layout.has, particles, segment);
    std::fill_n(buffer.type + at, segment.count, static_cast<std::uint8_t>(block.type));
    if (layout.has.mk_width == 1)
        std::fill_n(buffer.mk8 + at, segment.count, static_cast<std::uint8_t>(block.mk));
    else
        std::fill_n(buffer.mk16 + at, segment.count, big_endian(block.mk));
}

void write_piece(OutputFile& file, const Layout& layout, const ParticleStream& stream,
                 const CaseParticles& particles, float rhop0, std::size_t piece)
{
    const std::uint64_t begin = stream.begin(piece);
    const std::size_t count = stream.end(piece) - begin;
    const std::uint64_t place = begin - stream.first();
    const Contents& has = layout.has;
    const PieceBuffer buffer(piece_buffer(count * PieceBuffer::bytes_per_particle(has)), count,
                             has);
    for (std::size_t k = 0; k < count; ++k)
    {
        buffer.vertices[2 * k] = big_endian(std::uint32_t{1});
        buffer.vertices[2 * k + 1] = big_endian(static_cast<std::uint32_t>(place + k));
        buffer.idp[k] = big_endian(static_cast<std::uint32_t>(begin + k));
    }
    bool has_vel = false;
    if (has.vel_and_rhop)
        stream.for_each_segment(piece, [&](const ParticleSegment& segment)
                                { has_vel = has_vel || !segment.block->initials.empty(); });
    if (has_vel) std::fill_n(buffer.vel, 3 * count, 0U);
    stream.for_each_segment(
        piece, [&](const ParticleSegment& segment)
        { fill_segment(buffer, segment.id - begin, layout, particles, rhop0, segment); });
    if (has.normals) fill_normals(buffer, particles, begin, count);

    const auto write = [&](const Part& part, const void* data, std::size_t width)
    { file.write_at(part.data + place * width, data, count * width); };
    write(layout.points, buffer.points, 12);
    write(layout.vertices, buffer.vertices, 8);
    write(layout.idp, buffer.idp, 4);
    if (has.vel_and_rhop) write(layout.rhop, buffer.rhop, 4);
    if (has_vel) write(layout.vel, buffer.vel, 12);
    if (has.normals)
    {
        write(layout.normals, buffer.normals, 12);
        write(layout.sizes, buffer.sizes, 4);
    }
    write(layout.type, buffer.type, 1);
    write(layout.mk, buffer.mk8, has.mk_width);
    if (has.volumes)
    {
        std::vector<std::uint64_t> volumes(count);
        for (std::size_t k = 0; k < count; ++k)
            volumes[k] = big_endian(particles.volumes[begin + k]);
        write(layout.volume, volumes.data(), 8);
    }
    if (!has.walls) return;
    write(layout.kind, buffer.kind, 4);
    write(layout.wall_normal, buffer.wall_normal, 12);
    write(layout.distance, buffer.distance, 4);
    write(layout.layer, buffer.layer, 4);
}

} // namespace

void write_particles_vtk(OutputFile& file, const CaseParticles& particles,
                         const CaseConstants& constants, VtkSelection selection, int threads)
{
    const std::uint64_t n_bound = particles.np - particles.n_fluid;
    const std::uint64_t first = selection == VtkSelection::Fluid ? n_bound : 0;
    const std::uint64_t last = selection == VtkSelection::Bound ? n_bound : particles.np;
    const std::uint64_t n = last - first;
    if (n > max_vtk_particles)
        throw IoError(
            fmt::format("cannot write '{}': {} particles, but legacy VTK holds at most "
                        "{} (indices have 32 bits)",
                        file.path(), n, max_vtk_particles));
    const bool has_normals = selection == VtkSelection::Bound && !particles.bound_normals.empty();
    std::uint64_t mk_width = has_normals ? 2 : 1;
    for (const ParticleBlock& block : particles.blocks)
        if (block.mk > 255 && block.begin < last && block.begin + block.count > first) mk_width = 2;

    const Layout layout =
        lay_out(n, {selection != VtkSelection::Bound, has_normals,
                    particles.has_walls && selection != VtkSelection::Fluid, mk_width,
                    !particles.volumes.empty() && selection != VtkSelection::Fluid});
    file.reserve(layout.size);
    for (const Part* part :
         {&layout.points, &layout.vertices, &layout.idp, &layout.vel, &layout.rhop, &layout.type,
          &layout.mk, &layout.normals, &layout.sizes, &layout.kind, &layout.wall_normal,
          &layout.distance, &layout.layer, &layout.volume})
        file.write_at(part->data - part->text.size(), part->text.data(), part->text.size());
    file.write_at(layout.size - 1, "\n", 1);

    const ParticleStream stream(particles, first, last, particles_per_piece);
    const auto rhop0 = static_cast<float>(constants.rhop0);
    parallel_for(stream.pieces(), threads,
                 [&](std::size_t piece)
                 { write_piece(file, layout, stream, particles, rhop0, piece); });
}

} // namespace fppg
