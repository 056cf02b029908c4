#pragma once

#include "fppg/case_def.h"
#include "fppg/files.h"
#include "fppg/particles.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace fppg
{

/// The particles of one mk, as other codes know them: by a name.
struct FeedBody
{
    /// The case's name of the mk or of its draws, else as "bound0" or "fluid1"; one of its own for
    /// every body. Letters, digits and '_', first a letter.
    std::string name;
    std::uint16_t mk = 0; ///< absolute
    ParticleType type = ParticleType::Fixed;
    double mass = 0; ///< of a particle of volume dp^3, kg; in 2-D of dp^2, kg per metre
};

/// What of a piece is asked for; other arrays may hold anything.
enum class PieceContent : std::uint8_t
{
    All,
    Positions,
    Bodies,
};

/// Some consecutive particles, one entry each in all arrays but those that the feed lacks.
struct ParticlePiece
{
    PieceContent wanted = PieceContent::All; ///< set by who asks for the piece
    std::uint64_t first = 0;                 ///< index of the first one among all
    std::vector<Vec3> positions;
    std::vector<std::array<float, 3>> velocities;
    std::vector<float> densities;
    std::vector<double> volumes;
    std::vector<std::array<float, 3>> normals; ///< unit vectors, zero where there is none
    std::vector<std::uint32_t> ids;
    std::vector<std::uint16_t> bodies; ///< index into ParticleFeed::bodies
    std::vector<std::uint8_t> kinds;   ///< as FitKind; those on nodes are Volume

    std::size_t size() const { return positions.size(); }
};

/// What a file of another code is made from: particles that are handed out piece by piece, so that
/// memory does not grow with their number. SI units.
struct ParticleFeed
{
    std::string case_name; ///< without folder
    std::uint64_t count = 0;
    double time = 0; ///< seconds, of an output of the solver
    bool is_2d = false;
    double y_2d = 0;
    double dp = 0;
    double h = 0;
    double rhop0 = 0;
    double gamma = 0;
    double b = 0; ///< of the equation of state, Pa
    bool has_velocities = false;
    bool has_normals = false;
    bool has_kinds = false;
    bool has_volumes = false; ///< of their own; otherwise all are dp^3, in 2-D dp^2
    bool is_single = false;   ///< positions went through float32
    std::vector<FeedBody> bodies;
    /// Fills a piece with the particles [piece * feed_piece, (piece + 1) * feed_piece), fewer at
    /// the end. Several threads may ask at once. throws IoError, CaseError
    std::function<void(std::size_t piece, ParticlePiece& out)> read;

    std::size_t pieces() const;
    /// dp^3, in 2-D dp^2.
    double unit_volume() const;
    /// Of a particle of a piece, kg; in 2-D kg per metre.
    double mass(const ParticlePiece& piece, std::size_t k) const
    {
        return bodies[piece.bodies[k]].mass * (piece.volumes[k] / unit_volume());
    }
};

/// Particles of a piece.
inline constexpr std::size_t feed_piece = 32768;

/// The particles of a written result, ours or GenCase's, or of an output of the solver.
///
/// name  a case without extension, its .bi4 or .xml, or an output PartXXXX.bi4
/// xml   Case.xml; empty: beside the .bi4, for an output of the solver also by its CaseName in its
///       folder and the one above
/// throws  IoError if a file is missing or not whole; CaseError if Case.xml lacks the ranges of ids
ParticleFeed feed_of_file(const std::string& name, const std::string& xml = {});

/// The particles of a case that was just made; both must outlive the feed. Here volumes of fitted
/// walls, their outward normals and kinds are known.
ParticleFeed feed_of_case(const CaseDef& def, const CaseParticles& particles,
                          const CaseConstants& constants);

/// What a writer made.
struct ConvertedFiles
{
    std::vector<OutputFile> files;   ///< whole, not yet under their names
    std::vector<std::string> losses; ///< what the format does not hold, whole sentences
};

/// A format of particles that another code reads.
struct ParticleFormat
{
    const char* name;
    const char* ending; ///< of a file name that means this format; empty: only its name does
    const char* suffix; ///< of the file beside a case, as "_peri.data"
    const char* what;   ///< for help: who reads it
    /// path  of the file; formats of several files put theirs beside it
    void (*write)(const ParticleFeed& feed, const std::string& path, int threads,
                  ConvertedFiles& out);
};

/// All formats, as help lists them.
std::span<const ParticleFormat> particle_formats();

/// The format of that name, or that a path's ending means where the name is empty.
///
/// throws  UsageError that lists the formats
const ParticleFormat& find_particle_format(const std::string& name, const std::string& path);

/// Writes a feed in a format. The same input gives the same bytes for any number of threads. A
/// format that cannot say that a plane case is x-z gets its z as y.
///
/// throws  IoError if a file cannot be written, or the format cannot hold that many particles
ConvertedFiles convert_particles(const ParticleFeed& feed, const ParticleFormat& format,
                                 const std::string& path, int threads);

} // namespace fppg
