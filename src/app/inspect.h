#pragma once

#include "meshes/cad_facets.h"
#include "shapes/moments.h"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fppg/surface_mesh.h"

namespace fppg
{

/// What `fppg inspect` is asked. Lengths are in the unit of the file, which no format says.
struct InspectOptions
{
    std::string path;
    std::string parts{}; ///< MeshReading::parts
    double dp = 0;       ///< 0: nothing is said about particles and thin places
    double angle_deg = 30;
    double cad_angle_deg = 1; ///< between the exact faces of STEP files
    /// Of the file: "m", "cm", "mm" or "in"; empty: it is guessed. STEP files are read as metres.
    std::string unit{};
    double weld_distance = 0; ///< 0: corners with equal coordinates only
    int threads = 1;
    /// Particles are laid out to count them; without, areas and volumes estimate them.
    bool places_particles = true;
};

/// A body as particles stand for it, in the unit of the file, at density 1.
struct InspectedBody
{
    std::string of; ///< "shape", "on the surface" or "inside"
    std::size_t particles = 0;
    ExactBody body;
};

/// A mesh file as `fppg inspect` describes it.
struct Inspection
{
    InspectOptions options;
    MeshReport report;         ///< of the surface
    std::string format;        ///< "stl", "ply" and so on, by the ending of the name
    std::size_t points = 0;    ///< single ones, that a case draws beside the surface
    std::size_t polylines = 0; ///< likewise
    std::vector<std::string> file_warnings;
    std::vector<CadPart> cad_parts; ///< of STEP files, metres
    std::size_t facets = 0;
    std::size_t vertices = 0;
    std::vector<std::array<Vec3, 2>> open_edges; ///< the first few, by vertices
    std::string unit;                            ///< that of the options, or a guess: "m" or "mm"
    std::string unit_reason;                     ///< of a guess: a whole sentence
    /// A dp that makes so many particles that none was placed for a look: a whole sentence.
    std::string question;

    std::size_t lines = 0;
    std::size_t closed_lines = 0;
    double line_length = 0; ///< of all lines
    double longest_line = 0;
    double shortest_line = 0;
    std::size_t singular_points = 0;

    // With a dp only.
    std::size_t short_lines = 0;  ///< shorter than dp
    double surface_particles = 0; ///< area / dp^2
    double volume_particles = 0;  ///< volume / dp^3
    double corner_particles = 0;  ///< as placed; an estimate where there are very many
    double line_particles = 0;    ///< likewise
    /// Particles between lines and corners that -fit puts on the surface with its defaults; empty
    /// where they are too many to be placed for a look.
    std::optional<std::size_t> fitted_particles;
    double thin_share = 0; ///< of the area, where the opposite side is nearer than dp
    double thinnest = 0;   ///< the least distance found there; 0 if no place is thin
    Vec3 thinnest_at;
    /// The shape and what particles of both placements stand for, of closed meshes that make few
    /// enough particles for a look.
    std::vector<InspectedBody> bodies;
    /// For how many layers of mDBC there is room through the body, counted from both sides, at most
    /// most_layers: the share of the area for each number.
    static constexpr std::size_t most_layers = 4;
    std::array<double, most_layers + 1> layer_shares{};
    bool is_thickened = false; ///< to 2 dp under mDBC, as it has room for one layer (thicken())
    /// The share of the area with room for so many layers or more.
    double share_with_layers(std::size_t layers) const
    {
        double share = 0;
        for (std::size_t n = layers; n <= most_layers; ++n) share += layer_shares[n];
        return share;
    }
};

/// Reads, takes in and measures a mesh file of any kind that mesh_format_of() knows; a CSV file is
/// a table of heights.
///
/// throws  IoError, GeometryError as read_mesh_file() and repair_mesh(), and for a file without a
///         surface; the text names the file
Inspection inspect_mesh(const InspectOptions& options);

/// For people, about twenty lines.
std::string to_text(const Inspection& inspection);

/// For programs: one JSON object, its numbers with all digits.
std::string to_json(const Inspection& inspection);

} // namespace fppg
