#include "render/palette.h"

#include <algorithm>
#include <array>

namespace fppg
{

namespace
{

constexpr std::size_t most_colours = 256;
constexpr Rgb white = {255, 255, 255};
/// Colours that agree in the upper six bits of every channel are taken together.
constexpr unsigned dropped_bits = 2;
constexpr std::size_t cells = std::size_t{1} << 3 * (8 - dropped_bits);

/// Pixels of nearly one colour.
struct Cell
{
    std::size_t place = 0;
    std::uint64_t count = 0;
    std::array<std::uint64_t, 3> sum{};

    unsigned level(std::size_t channel) const
    {
        return static_cast<unsigned>(sum[channel] / count);
    }
};

/// Cells [begin, end) of the list.
struct Group
{
    std::size_t begin = 0;
    std::size_t end = 0;
    std::size_t widest_channel = 0;
    std::uint64_t weight = 0; ///< width of that channel times the number of pixels
};

std::size_t cell_of(const Rgb& colour)
{
    std::size_t place = 0;
    for (const std::uint8_t level : colour)
        place = place << (8 - dropped_bits) | static_cast<std::size_t>(level >> dropped_bits);
    return place;
}

std::vector<Cell> count_colours(const Image& image)
{
    std::vector<Cell> all(cells);
    for (const Rgb& pixel : image.pixels)
    {
        if (pixel == white) continue;
        Cell& cell = all[cell_of(pixel)];
        ++cell.count;
        for (std::size_t channel = 0; channel < 3; ++channel) cell.sum[channel] += pixel[channel];
    }
    for (std::size_t place = 0; place < cells; ++place) all[place].place = place;
    std::erase_if(all, [](const Cell& cell) { return cell.count == 0; });
    return all;
}

Group make_group(const std::vector<Cell>& list, std::size_t begin, std::size_t end)
{
    Group group{begin, end};
    std::uint64_t count = 0;
    for (std::size_t i = begin; i < end; ++i) count += list[i].count;
    for (std::size_t channel = 0; channel < 3; ++channel)
    {
        unsigned lowest = 255;
        unsigned highest = 0;
        for (std::size_t i = begin; i < end; ++i)
        {
            lowest = std::min(lowest, list[i].level(channel));
            highest = std::max(highest, list[i].level(channel));
        }
        const std::uint64_t weight = std::uint64_t{highest - lowest} * count;
        if (end - begin > 1 && highest > lowest && weight > group.weight)
        {
            group.weight = weight;
            group.widest_channel = channel;
        }
    }
    return group;
}

/// Cuts a group across its widest channel, with half of the pixels on each side.
std::size_t cut_place(std::vector<Cell>& list, const Group& group)
{
    const auto first = list.begin() + static_cast<std::ptrdiff_t>(group.begin);
    const auto last = list.begin() + static_cast<std::ptrdiff_t>(group.end);
    std::sort(first, last,
              [&](const Cell& a, const Cell& b)
              {
                  const unsigned level_a = a.level(group.widest_channel);
                  const unsigned level_b = b.level(group.widest_channel);
                  return level_a != level_b ? level_a < level_b : a.place < b.place;
              });
    std::uint64_t count = 0;
    for (std::size_t i = group.begin; i < group.end; ++i) count += list[i].count;
    std::uint64_t below = list[group.begin].count;
    std::size_t place = group.begin + 1;
    for (; place + 1 < group.end && 2 * below < count; ++place) below += list[place].count;
    return place;
}

} // namespace

PaletteImage make_palette(const Image& image)
{
    std::vector<Cell> list = count_colours(image);
    std::vector<Group> groups;
    if (!list.empty()) groups.push_back(make_group(list, 0, list.size()));
    while (!groups.empty() && groups.size() + 1 < most_colours)
    {
        const auto heaviest =
            std::max_element(groups.begin(), groups.end(),
                             [](const Group& a, const Group& b) { return a.weight < b.weight; });
        if (heaviest->weight == 0) break;
        const std::size_t cut = cut_place(list, *heaviest);
        const Group upper = make_group(list, cut, heaviest->end);
        *heaviest = make_group(list, heaviest->begin, cut);
        groups.push_back(upper);
    }

    PaletteImage out;
    out.colours.push_back(white);
    std::vector<std::uint8_t> index_of_cell(cells, 0);
    for (const Group& group : groups)
    {
        std::uint64_t count = 0;
        std::array<std::uint64_t, 3> sum{};
        for (std::size_t i = group.begin; i < group.end; ++i)
        {
            index_of_cell[list[i].place] = static_cast<std::uint8_t>(out.colours.size());
            count += list[i].count;
            for (std::size_t channel = 0; channel < 3; ++channel)
                sum[channel] += list[i].sum[channel];
        }
        Rgb mean;
        for (std::size_t channel = 0; channel < 3; ++channel)
            mean[channel] = static_cast<std::uint8_t>((sum[channel] + count / 2) / count);
        out.colours.push_back(mean);
    }
    out.indices.reserve(image.pixels.size());
    for (const Rgb& pixel : image.pixels)
        out.indices.push_back(pixel == white ? std::uint8_t{0} : index_of_cell[cell_of(pixel)]);
    return out;
}

} // namespace fppg
