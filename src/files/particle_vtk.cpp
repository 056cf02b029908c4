// Every part of the file has a size that is known beforehand, so its pieces are written at their
// places by several threads. Vel is zero everywhere, and a reserved file reads as zeros: it is
// never written.

#include "core/parallel.h"
#include "files/particle_stream.h"
#include "files/vtk.h"
#include "fppg/error.h"
#include "fppg/files.h"

#include <fmt/format.h>

namespace fppg
{

namespace
{

/// 31 bytes a particle, 51 with walls: one MiB or two.
constexpr std::uint64_t particles_a_piece = 32768;
constexpr std::uint64_t max_particles = 2147483647U;

/// A part of the file: a line or more of text, then `width` bytes a particle.
struct Part
{
    std::string text;
    std::uint64_t data = 0;
};

struct Layout
{
    Part points, vertices, idp, vel, rhop, type, mk, kind, normal, distance;
    bool has_vel_and_rhop = false;
    bool has_walls = false;
    std::uint64_t mk_width = 1;
    std::uint64_t size = 0;
};

Layout lay_out(std::uint64_t n, bool has_vel_and_rhop, bool has_walls, std::uint64_t mk_width)
{
    Layout layout;
    layout.has_vel_and_rhop = has_vel_and_rhop;
    layout.has_walls = has_walls;
    layout.mk_width = mk_width;
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
        fmt::format("\nFIELD FieldData {}", (has_vel_and_rhop ? 4 : 2) + (has_walls ? 3 : 0));
    if (has_vel_and_rhop)
    {
        place(layout.vel, fmt::format("{}\nVel 3 {} float\n", fields, n), 12);
        place(layout.rhop, fmt::format("\nRhop 1 {} float\n", n), 4);
    }
    place(layout.type,
          fmt::format("{}\nType 1 {} unsigned_char\n", has_vel_and_rhop ? "" : fields, n), 1);
    place(layout.mk,
          fmt::format("\nMk 1 {} {}\n", n, mk_width == 1 ? "unsigned_char" : "unsigned_short"),
          mk_width);
    if (has_walls)
    {
        place(layout.kind, fmt::format("\nKind 1 {} int\n", n), 4);
        place(layout.normal, fmt::format("\nNormal 3 {} float\n", n), 12);
        place(layout.distance, fmt::format("\nDistance 1 {} float\n", n), 4);
    }
    layout.size += 1;
    return layout;
}

/// Where the values of a piece stand in its buffer.
struct PieceBuffer
{
    PieceBuffer(char* start, std::size_t n, bool has_walls)
        : points(reinterpret_cast<std::uint32_t*>(start)),
          vertices(points + 3 * n),
          idp(vertices + 2 * n),
          rhop(idp + n),
          kind(rhop + n),
          normal(kind + (has_walls ? n : 0)),
          distance(normal + (has_walls ? 3 * n : 0)),
          mk16(reinterpret_cast<std::uint16_t*>(distance + (has_walls ? n : 0))),
          mk8(reinterpret_cast<std::uint8_t*>(mk16)),
          type(mk8 + 2 * n)
    {
    }
    static std::size_t bytes_a_particle(bool has_walls)
    {
        return 12 + 8 + 4 + 4 + 2 + 1 + (has_walls ? 4 + 12 + 4 : 0);
    }

    std::uint32_t* points;
    std::uint32_t* vertices;
    std::uint32_t* idp;
    std::uint32_t* rhop;
    std::uint32_t* kind;
    std::uint32_t* normal;
    std::uint32_t* distance;
    std::uint16_t* mk16;
    std::uint8_t* mk8;
    std::uint8_t* type;
};

/// Kind, normal and distance.
void fill_walls(const PieceBuffer& buffer, std::size_t at, const FreeParticles& free,
                const ParticleSegment& segment)
{
    const ParticleRun& run = *segment.run;
    if (!run.is_free())
    {
        std::fill_n(buffer.kind + at, segment.count,
                    big_endian(static_cast<std::uint32_t>(FitKind::Volume)));
        std::fill_n(buffer.normal + 3 * at, 3 * std::size_t{segment.count}, std::uint32_t{0});
        std::fill_n(buffer.distance + at, segment.count, big_endian(distance_of_nodes));
        return;
    }
    for (std::size_t k = 0; k < segment.count; ++k)
    {
        const std::size_t from = run.free_begin() + segment.offset + k;
        buffer.kind[at + k] = big_endian(static_cast<std::uint32_t>(free.kinds[from]));
        for (std::size_t axis = 0; axis < 3; ++axis)
            buffer.normal[3 * (at + k) + axis] = big_endian(free.normals[from][axis]);
        buffer.distance[at + k] = big_endian(free.distances[from]);
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
    if (layout.has_vel_and_rhop)
    {
        std::uint32_t* rhop = buffer.rhop + at;
        for_each_density(particles, rhop0, segment,
                         [&](std::uint32_t k, float v) { rhop[k] = big_endian(v); });
    }
    if (layout.has_walls) fill_walls(buffer, at, particles.free, segment);
    const ParticleBlock& block = *segment.block;
    std::fill_n(buffer.type + at, segment.count, static_cast<std::uint8_t>(block.type));
    if (layout.mk_width == 1)
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
    const PieceBuffer buffer(piece_buffer(count * PieceBuffer::bytes_a_particle(layout.has_walls)),
                             count, layout.has_walls);
    for (std::size_t k = 0; k < count; ++k)
    {
        buffer.vertices[2 * k] = big_endian(std::uint32_t{1});
        buffer.vertices[2 * k + 1] = big_endian(static_cast<std::uint32_t>(place + k));
        buffer.idp[k] = big_endian(static_cast<std::uint32_t>(begin + k));
    }
    stream.for_each_segment(
        piece, [&](const ParticleSegment& segment)
        { fill_segment(buffer, segment.id - begin, layout, particles, rhop0, segment); });

    const auto write = [&](const Part& part, const void* data, std::size_t width)
    { file.write_at(part.data + place * width, data, count * width); };
    write(layout.points, buffer.points, 12);
    write(layout.vertices, buffer.vertices, 8);
    write(layout.idp, buffer.idp, 4);
    if (layout.has_vel_and_rhop) write(layout.rhop, buffer.rhop, 4);
    write(layout.type, buffer.type, 1);
    write(layout.mk, buffer.mk8, layout.mk_width);
    if (!layout.has_walls) return;
    write(layout.kind, buffer.kind, 4);
    write(layout.normal, buffer.normal, 12);
    write(layout.distance, buffer.distance, 4);
}

} // namespace

void write_particles_vtk(OutputFile& file, const CaseParticles& particles,
                         const CaseConstants& constants, VtkSelection selection, int threads)
{
    const std::uint64_t n_bound = particles.np - particles.n_fluid;
    const std::uint64_t first = selection == VtkSelection::Fluid ? n_bound : 0;
    const std::uint64_t last = selection == VtkSelection::Bound ? n_bound : particles.np;
    const std::uint64_t n = last - first;
    if (n > max_particles)
        throw IoError(
            fmt::format("cannot write '{}': {} particles, but legacy VTK holds at most "
                        "{} (indices have 32 bits)",
                        file.path(), n, max_particles));
    std::uint64_t mk_width = 1;
    for (const ParticleBlock& block : particles.blocks)
        if (block.mk > 255 && block.begin < last && block.begin + block.count > first) mk_width = 2;

    const bool has_walls = particles.has_walls && selection != VtkSelection::Fluid;
    const Layout layout = lay_out(n, selection != VtkSelection::Bound, has_walls, mk_width);
    file.reserve(layout.size);
    for (const Part* part :
         {&layout.points, &layout.vertices, &layout.idp, &layout.vel, &layout.rhop, &layout.type,
          &layout.mk, &layout.kind, &layout.normal, &layout.distance})
        file.write_at(part->data - part->text.size(), part->text.data(), part->text.size());
    file.write_at(layout.size - 1, "\n", 1);

    const ParticleStream stream(particles, first, last, particles_a_piece);
    const auto rhop0 = static_cast<float>(constants.rhop0);
    parallel_for(stream.pieces(), threads,
                 [&](std::size_t piece)
                 { write_piece(file, layout, stream, particles, rhop0, piece); });
}

} // namespace fppg
