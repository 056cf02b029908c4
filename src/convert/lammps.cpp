// Data files of LAMMPS (read_data) and the text of Peridigm. Types and blocks are the bodies,
// from 1.

#include "convert/formats.h"
#include "convert/text_lines.h"
#include "fppg/error.h"

#include <numbers>

namespace fppg
{

namespace
{

/// The head of a data file, up to the particles. The box goes half a dp beyond them.
void begin_data(OutputFile& file, const ParticleFeed& feed, const char* style, bool has_masses,
                int threads)
{
    if (feed.count > 2147483647)
        throw IoError(
            fmt::format("cannot write '{}': {} particles, but LAMMPS in its usual build "
                        "holds at most 2147483647",
                        file.path(), feed.count));
    const Box3 limits = feed.count > 0 ? limits_of_feed(feed, threads) : Box3{{}, {}};
    const double half = feed.dp / 2;
    std::string text = fmt::format(
        "particles of {} by fppg, dp {}; SI units\n\n{} atoms\n{} atom "
        "types\n\n",
        feed.case_name, feed.dp, feed.count, feed.bodies.size());
    for (int axis = 0; axis < 3; ++axis)
        text += fmt::format("{} {} {}lo {}hi\n", limits.min[axis] - half, limits.max[axis] + half,
                            "xyz"[axis], "xyz"[axis]);
    if (has_masses)
    {
        text += "\nMasses\n\n";
        for (std::size_t body = 0; body < feed.bodies.size(); ++body)
            text += fmt::format("{} {} # {}\n", body + 1, feed.bodies[body].mass,
                                feed.bodies[body].name);
    }
    file.append(text + fmt::format("\nAtoms # {}\n\n", style));
}

/// Whether any particle moves; LAMMPS takes all for resting without velocities.
void append_velocities(OutputFile& file, const ParticleFeed& feed, bool has_spin, int threads)
{
    if (!feed.has_velocities || feed.count == 0) return;
    file.append("\nVelocities\n\n");
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k,
                     std::uint64_t number)
                 {
                     const std::array<float, 3>& v = piece.velocities[k];
                     put_text(text, "{} {} {} {}{}\n", number + 1, v[0], v[1], v[2],
                              has_spin ? " 0 0 0" : "");
                 });
}

/// kg/m^3 of what the particle is made of: of a floating body that of the body, else its density.
double material_density(const ParticleFeed& feed, const ParticlePiece& piece, std::size_t k)
{
    const FeedBody& body = feed.bodies[piece.bodies[k]];
    if (body.type == ParticleType::Floating) return body.mass / feed.unit_volume();
    return double{piece.densities[k]};
}

void say_bodies(const ParticleFeed& feed, const char* what, ConvertedFiles& out)
{
    std::string list;
    for (std::size_t body = 0; body < feed.bodies.size(); ++body)
        list += fmt::format("{}{} {}", body > 0 ? ", " : "", body + 1, feed.bodies[body].name);
    out.losses.emplace_back(fmt::format("{}: {}", what, list));
    say_no_walls(feed, out);
}

} // namespace

void write_lammps_peri(const ParticleFeed& given, const std::string& path, int threads,
                       ConvertedFiles& out)
{
    const ParticleFeed feed = in_xy_plane(given, out);
    say_volumes(feed, out);
    say_bodies(feed, "names of bodies are atom types", out);
    OutputFile& file = out.files.emplace_back(path);
    begin_data(file, feed, "peri", false, threads);
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k,
                     std::uint64_t number)
                 {
                     const Vec3& p = piece.positions[k];
                     put_text(text, "{} {} {} {} {} {} {}\n", number + 1, piece.bodies[k] + 1,
                              piece.volumes[k], material_density(feed, piece, k), p.x, p.y, p.z);
                 });
    append_velocities(file, feed, false, threads);
}

void write_lammps_sphere(const ParticleFeed& given, const std::string& path, int threads,
                         ConvertedFiles& out)
{
    const ParticleFeed feed = in_xy_plane(given, out);
    out.losses.emplace_back(fmt::format("spheres of diameter dp have pi/6 = {:.4f} of the volume",
                                        std::numbers::pi / 6));
    say_bodies(feed, "names of bodies are atom types", out);
    OutputFile& file = out.files.emplace_back(path);
    begin_data(file, feed, "sphere", false, threads);
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k,
                     std::uint64_t number)
                 {
                     const Vec3& p = piece.positions[k];
                     put_text(text, "{} {} {} {} {} {} {}\n", number + 1, piece.bodies[k] + 1,
                              feed.dp, material_density(feed, piece, k), p.x, p.y, p.z);
                 });
    append_velocities(file, feed, true, threads);
}

void write_lammps_sph(const ParticleFeed& given, const std::string& path, int threads,
                      ConvertedFiles& out)
{
    const ParticleFeed feed = in_xy_plane(given, out);
    out.losses.emplace_back("the file has no volumes; internal energy is 0 and heat capacity 1");
    say_bodies(feed, "names of bodies are atom types", out);
    OutputFile& file = out.files.emplace_back(path);
    begin_data(file, feed, "sph", true, threads);
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k,
                     std::uint64_t number)
                 {
                     const Vec3& p = piece.positions[k];
                     put_text(text, "{} {} {} 0 1 {} {} {}\n", number + 1, piece.bodies[k] + 1,
                              piece.densities[k], p.x, p.y, p.z);
                 });
    append_velocities(file, feed, false, threads);
}

void write_peridigm(const ParticleFeed& feed, const std::string& path, int threads,
                    ConvertedFiles& out)
{
    say_volumes(feed, out);
    say_bodies(feed, "names of bodies are blocks", out);
    out.losses.emplace_back("the file has no density and no velocity");
    OutputFile& file = out.files.emplace_back(path);
    file.append("# x y z block volume\n");
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k, auto)
                 {
                     const Vec3& p = piece.positions[k];
                     put_text(text, "{} {} {} {} {}\n", p.x, p.y, p.z, piece.bodies[k] + 1,
                              piece.volumes[k]);
                 });
}

} // namespace fppg
