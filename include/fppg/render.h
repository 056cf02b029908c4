#pragma once

#include "fppg/files.h"
#include "fppg/read_particles.h"
#include "fppg/rgb.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// Pixels, rows from the top, each row from the left.
struct Image
{
    int width = 0;
    int height = 0;
    std::vector<Rgb> pixels;

    const Rgb& at(int x, int y) const
    {
        return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                      static_cast<std::size_t>(x)];
    }
};

/// Where the camera stands, as seen from the particles; degrees. Azimuth 0 is in front (towards
/// -y), 90 on the right (+x); elevation 90 is above (+z), where +y is upwards in the picture.
struct ViewDirection
{
    double azimuth_deg = 30;
    double elevation_deg = 25;
};

/// Keeps the particles whose centre is on one side of a plane across an axis, or on it (to
/// 1e-6 dp).
struct CutPlane
{
    int axis = 0; ///< 0 x, 1 y, 2 z
    bool keep_above = true;
    double at = 0; ///< metres
};

enum class RenderColour : std::uint8_t
{
    Mk,   ///< ParticleCloud::colours where they have one, else Role
    Role, ///< colour_of_mk()
    Kind,
    Layer,
};

struct RenderOptions
{
    int width = 1600; ///< pixels of the whole image, 16 to 16384
    int height = 1200;
    ViewDirection view;
    double zoom = 1;            ///< above 0; 1 shows all particles
    std::optional<Vec3> center; ///< in the middle of the picture; without it the particles' middle
    RenderColour colour = RenderColour::Mk;
    std::vector<CutPlane> cuts;     ///< all must hold
    std::vector<std::uint16_t> mks; ///< only these; empty: all
    double radius_dp = 0.5;         ///< of a sphere, dp of its case; above 0
    int samples = 2;                ///< rays per pixel along each axis, 1 to 8
    /// Fixed walls between the camera and fluid, moving or floating parts are left out.
    bool opens_walls = false;
    bool has_scale_bar = false; ///< at the lower left: a round length, with its unit
    bool has_legend = false;    ///< what the colours stand for, at the upper left
};

/// Reads a view: iso, front, back, left, right, top, bottom, or "azimuth,elevation" in degrees.
/// throws UsageError that lists them
ViewDirection parse_view(const std::string& text);

/// Reads a cut plane such as "y>0.3" or "z<1". throws UsageError
CutPlane parse_cut(const std::string& text);

/// The colour of a mk by what it is: fluid blue, fixed grey, moving orange to yellow, floating red;
/// shades by mk. The same in every picture.
///
/// type  as ParticleType; others: not known, by GenCase's usual numbers of mk
Rgb colour_of_mk(std::uint16_t mk, std::uint8_t type);
inline constexpr std::uint8_t unknown_type = 255;
/// The colour of a kind. Values of no kind are grey.
Rgb colour_of_kind(std::uint8_t kind);
/// The colour of a layer of a wall, from 1 on.
Rgb colour_of_layer(unsigned layer);

/// What the colour of particle i stands for: its mk, its kind, or its layer (fluid: 0, other
/// particles without a layer: no_layer).
unsigned colour_value(const ParticleCloud& cloud, std::size_t i, RenderColour colour);
inline constexpr unsigned no_layer = 256;
Rgb colour_of(const ParticleCloud& cloud, std::size_t i, RenderColour colour);
/// For a legend: "mk 11 fixed", "edge", "layer 2", ...
std::string colour_name(const ParticleCloud& cloud, std::size_t i, RenderColour colour);

/// Draws particles as spheres on white: orthographic, two lights that move with the camera, one
/// of which throws shadows. Several clouds stand side by side in panels of equal width, seen by one
/// camera: the same place is at the same pixel of every panel.
///
/// clouds   one or two
/// threads  number of threads; the image does not depend on it
/// returns  an image of the size asked for
/// throws   UsageError if the options are out of range, no particle is left to draw, or the colour
///          is by kind or layer and a cloud has none
/// cost     about 80 bytes per particle besides the clouds; a million particles at 1600 x 1200 take
///          1.5 s of processor time, with reading and PNG (AMD EPYC)
Image render_particles(const std::vector<ParticleCloud>& clouds, const RenderOptions& options,
                       int threads);

/// The bytes of write_png(). throws IoError
std::string png_bytes(const Image& image, bool has_palette = false);

/// Writes an image as PNG, 8 bits a channel; with a palette of 256 colours chosen for it the file
/// is about a third as large. throws IoError
void write_png(OutputFile& file, const Image& image, bool has_palette = false);

} // namespace fppg
