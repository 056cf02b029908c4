#pragma once

#include "fppg/render.h"

#include <string>

namespace fppg
{

/// Rows and columns of a letter, in dots.
inline constexpr int letter_rows = 7;
inline constexpr int letter_columns = 5;

/// Writes a text into an image in black: letters of 5 x 7 dots, a dot `size` pixels wide. What
/// lies outside the image is left out; letters that are not known are blank.
///
/// x, y  pixel of the upper left corner
void draw_text(Image& image, int x, int y, int size, const std::string& text);

/// Width of a text in pixels.
int text_width(const std::string& text, int size);

/// Fills a rectangle, cut at the border of the image.
void fill_rectangle(Image& image, int x, int y, int width, int height, const Rgb& colour);

} // namespace fppg
