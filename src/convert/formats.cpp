#include "convert/formats.h"

#include "convert/columns.h"
#include "core/nearest_word.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <mutex>
#include <utility>

namespace fppg
{

namespace
{

constexpr ParticleFormat formats[] = {
    {"csv", ".csv", ".csv", "text for any program, one line a particle", write_csv},
    {"vtu", ".vtu", ".vtu", "ParaView, VTK, meshio; TrixiParticles where all is one system",
     write_vtu},
    {"trixi", "", "_trixi.vtu", "TrixiParticles.jl: a VTU a body, named FILE_BODY.vtu",
     write_trixi},
    {"xdmf", ".xdmf", ".xdmf", "ParaView, meshio; its numbers lie in FILE.h5 beside it",
     write_xdmf},
    {"pysph", ".hdf5", ".hdf5", "PySPH, with an array a body", write_pysph},
    {"sphinxsys", ".xml", "_Reload.xml",
     "SPHinXsys since May 2026: reload/Reload.xml of all bodies", write_sphinxsys},
    {"sphinxsys-bodies", "", "_rld.xml",
     "older SPHinXsys: BODY_rld.xml of every body, in the folder of FILE", write_sphinxsys_bodies},
    {"bgeo", ".bgeo", ".bgeo", "SPlisHSPlasH, Houdini: BGEO version 5", write_bgeo},
    {"lammps-peri", ".data", "_peri.data", "LAMMPS read_data, atom_style peri", write_lammps_peri},
    {"lammps-sphere", "", "_sphere.data", "LAMMPS read_data, atom_style sphere",
     write_lammps_sphere},
    {"lammps-sph", "", "_sph.data", "LAMMPS read_data, atom_style sph", write_lammps_sph},
    {"peridigm", ".txt", ".txt", "Peridigm: x y z block volume", write_peridigm},
    {"ls-dyna", ".k", ".k", "LS-DYNA and OpenRadioss: *NODE and *ELEMENT_SPH_VOLUME",
     write_ls_dyna},
    {"radioss", ".rad", ".rad", "OpenRadioss: /NODE and /SPHCEL, to be included in a starter deck",
     write_radioss},
    {"tally", "", "_tally.json",
     "no particles: how many, their volumes and limits, and a checksum, of any number",
     write_tally},
};

std::string list_of_formats()
{
    std::string list;
    for (const ParticleFormat& format : formats)
        list += fmt::format("{}{}", list.empty() ? "" : ", ", format.name);
    return list;
}

} // namespace

std::span<const ParticleFormat> particle_formats()
{
    return formats;
}

const ParticleFormat& find_particle_format(const std::string& name, const std::string& path)
{
    std::vector<std::string_view> names;
    for (const ParticleFormat& format : formats)
    {
        if (name.empty() ? *format.ending != '\0' && path.ends_with(format.ending)
                         : name == format.name)
            return format;
        names.emplace_back(format.name);
    }
    if (name.empty())
        throw UsageError(
            fmt::format("the ending of '{}' means no format, expected --to and one of "
                        "{}",
                        path, list_of_formats()));
    throw UsageError(fmt::format("the format \"{}\" is unknown{}, expected {}", name,
                                 did_you_mean(name, names), list_of_formats()));
}

ConvertedFiles convert_particles(const ParticleFeed& feed, const ParticleFormat& format,
                                 const std::string& path, int threads)
{
    ConvertedFiles out;
    if (feed.is_single) out.losses.emplace_back("positions were read in single precision");
    format.write(feed, path, threads, out);
    return out;
}

void say_volumes(const ParticleFeed& feed, ConvertedFiles& out)
{
    if (!feed.has_volumes)
        out.losses.emplace_back(fmt::format(
            "a .bi4 holds no volumes: all are dp^{}; -to of a run knows those of fitted walls",
            feed.is_2d ? 2 : 3));
}

void say_single_positions(ConvertedFiles& out)
{
    out.losses.emplace_back("positions are rounded to float32");
}

void say_no_walls(const ParticleFeed& feed, ConvertedFiles& out)
{
    if (feed.has_normals) out.losses.emplace_back("the format has no room for normals");
}

ParticleFeed in_xy_plane(const ParticleFeed& feed, ConvertedFiles& out)
{
    if (!feed.is_2d) return feed;
    out.losses.emplace_back("the plane x-z of the case is x-y in the file");
    ParticleFeed turned = feed;
    turned.read = [read = feed.read](std::size_t number, ParticlePiece& piece)
    {
        read(number, piece);
        for (Vec3& p : piece.positions) p = {p.x, p.z, 0};
        for (std::array<float, 3>& v : piece.velocities) v = {v[0], v[2], 0};
        for (std::array<float, 3>& n : piece.normals) n = {n[0], n[2], 0};
    };
    return turned;
}

Box3 limits_of_feed(const ParticleFeed& feed, int threads)
{
    Box3 limits;
    std::mutex guard;
    for_each_piece(
        feed, threads,
        [&](std::size_t, const ParticlePiece& piece)
        {
            Box3 own;
            for (const Vec3& p : piece.positions) own.add(p);
            const std::lock_guard lock(guard);
            limits.add(own.min);
            limits.add(own.max);
        },
        PieceContent::Positions);
    return limits;
}

} // namespace fppg
