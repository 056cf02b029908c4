#pragma once

#include "fppg/render.h"

#include <cstdint>
#include <vector>

namespace fppg
{

/// An image of at most 256 colours.
struct PaletteImage
{
    std::vector<Rgb> colours;
    std::vector<std::uint8_t> indices; ///< one per pixel, in the order of Image
};

/// Chooses 256 colours for an image by median cut (Heckbert 1982) and gives every pixel one of
/// them. White stays white. The same image gives the same colours.
PaletteImage make_palette(const Image& image);

} // namespace fppg
