#include "fppg/error.h"
#include "fppg/render.h"
#include "render/palette.h"

#include <fmt/format.h>
#include <png.h>

namespace fppg
{

std::string png_bytes(const Image& image, bool has_palette)
{
    static_assert(sizeof(Rgb) == 3, "colours follow one another without gaps");
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = has_palette ? PNG_FORMAT_RGB_COLORMAP : PNG_FORMAT_RGB;
    PaletteImage palette;
    if (has_palette) palette = make_palette(image);
    png.colormap_entries = static_cast<png_uint_32>(palette.colours.size());
    const void* pixels = has_palette ? static_cast<const void*>(palette.indices.data())
                                     : static_cast<const void*>(image.pixels.data());
    std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(png), '\0');
    png_alloc_size_t size = bytes.size();
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels, 0,
                                  palette.colours.data()) == 0)
        throw IoError(fmt::format("cannot make a PNG: {}", png.message));
    bytes.resize(size);
    return bytes;
}

void write_png(OutputFile& file, const Image& image, bool has_palette)
{
    file.append(png_bytes(image, has_palette));
}

} // namespace fppg
