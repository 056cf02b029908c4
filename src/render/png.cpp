#include "fppg/error.h"
#include "fppg/render.h"

#include <fmt/format.h>
#include <png.h>

namespace fppg
{

void write_png(OutputFile& file, const Image& image)
{
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    static_assert(sizeof(Rgb) == 3, "pixels follow one another without gaps");
    std::vector<char> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
    png_alloc_size_t size = bytes.size();
    const int is_done =
        png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr);
    if (is_done == 0) throw IoError(fmt::format("cannot write '{}': {}", file.path(), png.message));
    file.append(bytes.data(), size);
}

} // namespace fppg
