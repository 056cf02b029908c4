#include "core/finite_number.h"
#include "fppg/error.h"
#include "fppg/render.h"

#include <fmt/format.h>
#include <cmath>

namespace fppg
{

namespace
{

} // namespace

ViewDirection parse_view(const std::string& text)
{
    struct Preset
    {
        const char* name;
        ViewDirection view;
    };
    static constexpr Preset presets[] = {
        {"iso", {30, 25}},  {"front", {0, 0}}, {"back", {180, 0}},   {"left", {270, 0}},
        {"right", {90, 0}}, {"top", {0, 90}},  {"bottom", {0, -90}},
    };
    for (const Preset& preset : presets)
        if (text == preset.name) return preset.view;
    if (const std::size_t comma = text.find(','); comma != std::string::npos)
    {
        const std::optional<double> azimuth =
            finite_number(std::string_view(text).substr(0, comma));
        const std::optional<double> elevation =
            finite_number(std::string_view(text).substr(comma + 1));
        if (azimuth && elevation && std::abs(*elevation) <= 90) return {*azimuth, *elevation};
    }
    throw UsageError(fmt::format(
        "the view \"{}\" is unknown, expected iso, front, back, left, right, top, bottom, or "
        "azimuth,elevation in degrees such as 30,25",
        text));
}

CutPlane parse_cut(const std::string& text)
{
    CutPlane cut;
    const std::size_t axis = text.empty() ? std::string::npos : std::string("xyz").find(text[0]);
    const bool has_sign = text.size() > 2 && (text[1] == '<' || text[1] == '>');
    const std::optional<double> at =
        has_sign ? finite_number(std::string_view(text).substr(2)) : std::optional<double>();
    if (axis == std::string::npos || !at)
        throw UsageError(
            fmt::format("the cut \"{}\" is unknown, expected for example y>0.3 or z<1", text));
    cut.axis = static_cast<int>(axis);
    cut.keep_above = text[1] == '>';
    cut.at = *at;
    return cut;
}

Rgb colour_of_mk(std::uint16_t mk, std::uint8_t type)
{
    // Fluids have mk 1 to 10 in GenCase's numbering (0 is never given), boundaries follow.
    static constexpr Rgb fluids[] = {{62, 137, 202}, {92, 186, 190}, {115, 130, 205}};
    static constexpr Rgb greys[] = {{176, 172, 166}, {148, 150, 152}, {198, 192, 182}};
    static constexpr Rgb moving[] = {{222, 148, 66}, {214, 186, 74}, {205, 120, 60}};
    static constexpr Rgb floating[] = {{196, 78, 74}, {205, 110, 140}, {160, 70, 50}};
    if (type == 0) return greys[(mk + 2U) % std::size(greys)];
    if (type == 1) return moving[(mk + 2U) % std::size(moving)];
    if (type == 2) return floating[(mk + 2U) % std::size(floating)];
    if (type == 3) return fluids[(mk + 2U) % std::size(fluids)];
    static constexpr Rgb boundaries[] = {{176, 172, 166}, {222, 148, 66},  {196, 78, 74},
                                         {112, 160, 84},  {150, 108, 176}, {214, 186, 74},
                                         {120, 92, 72},   {205, 120, 160}, {80, 130, 130}};
    if (mk < 10) return fluids[(mk + 2U) % std::size(fluids)];
    return boundaries[(mk - 10U) % std::size(boundaries)];
}

Rgb colour_of_kind(std::uint8_t kind)
{
    static constexpr Rgb colours[] = {
        {206, 52, 52},   // corner
        {232, 160, 44},  // edge
        {104, 152, 196}, // surface
        {200, 198, 194}, // volume
    };
    return kind < std::size(colours) ? colours[kind] : Rgb{130, 130, 130};
}

Rgb colour_of_layer(unsigned layer)
{
    static constexpr Rgb colours[] = {{206, 52, 52},  {232, 160, 44},  {112, 160, 84},
                                      {80, 130, 130}, {150, 108, 176}, {120, 92, 72}};
    return colours[(layer - 1) % std::size(colours)];
}

unsigned colour_value(const ParticleCloud& cloud, std::size_t i, RenderColour colour)
{
    if (colour == RenderColour::Mk || colour == RenderColour::Role) return cloud.mk[i];
    if (colour == RenderColour::Kind) return cloud.kind[i];
    if (cloud.layer[i] > 0) return cloud.layer[i];
    return !cloud.type.empty() && cloud.type[i] == 3 ? 0 : no_layer;
}

Rgb colour_of(const ParticleCloud& cloud, std::size_t i, RenderColour colour)
{
    if (colour == RenderColour::Kind) return colour_of_kind(cloud.kind[i]);
    if (colour == RenderColour::Layer && cloud.layer[i] > 0) return colour_of_layer(cloud.layer[i]);
    if (colour == RenderColour::Mk)
        if (const auto own = cloud.colours.find(cloud.mk[i]); own != cloud.colours.end())
            return own->second;
    return colour_of_mk(cloud.mk[i], cloud.type.empty() ? unknown_type : cloud.type[i]);
}

std::string colour_name(const ParticleCloud& cloud, std::size_t i, RenderColour colour)
{
    static constexpr const char* kinds[] = {"corner", "edge", "surface", "volume"};
    static constexpr const char* types[] = {"fixed", "moving", "floating", "fluid"};
    const unsigned value = colour_value(cloud, i, colour);
    if (colour == RenderColour::Kind)
        return value < std::size(kinds) ? kinds[value] : fmt::format("kind {}", value);
    if (colour == RenderColour::Layer)
        return value == 0          ? "fluid"
               : value == no_layer ? "no layer"
                                   : fmt::format("layer {}", value);
    const bool has_type = !cloud.type.empty() && cloud.type[i] < std::size(types);
    return fmt::format("mk {}{}{}", value, has_type ? " " : "",
                       has_type ? types[cloud.type[i]] : "");
}

} // namespace fppg
