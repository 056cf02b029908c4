#include "files/case_facts.h"

#include "fppg/error.h"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace fppg
{

namespace
{

std::uint64_t whole_number(const Element& element, const char* name, std::uint64_t largest,
                           const std::string& path)
{
    const std::string* text = element.find_attribute(name);
    if (text == nullptr)
        throw CaseError(path, element.line,
                        fmt::format("<{}> has no attribute {}", element.name, name));
    std::uint64_t value = 0;
    const auto [end, error] = std::from_chars(text->data(), text->data() + text->size(), value);
    if (error != std::errc() || end != text->data() + text->size() || value > largest)
        throw CaseError(path, element.line,
                        fmt::format("<{} {}=\"{}\">: expected a whole number up to {}",
                                    element.name, name, *text, largest));
    return value;
}

/// A place of `<positions>`; nothing where it is not there or no place.
std::optional<Vec3> place(const Element* positions, const char* name)
{
    const Element* element = positions != nullptr ? positions->find_child(name) : nullptr;
    if (element == nullptr) return {};
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis)
    {
        const std::string* text = element->find_attribute(std::string(1, "xyz"[axis]));
        if (text == nullptr) return {};
        const char* end = text->data() + text->size();
        const auto read = std::from_chars(text->data(), end, p[axis]);
        if (read.ec != std::errc() || read.ptr != end) return {};
    }
    return p;
}

/// Between which particles lie, as GenCase v5.4 writes it into `<_summary>`.
Box3 limits_of(const Element& particles)
{
    const Element* summary = particles.find_child("_summary");
    const Element* positions = summary != nullptr ? summary->find_child("positions") : nullptr;
    const std::optional<Vec3> least = place(positions, "posmin");
    const std::optional<Vec3> greatest = place(positions, "posmax");
    if (!least || !greatest) return {};
    return {*least, *greatest};
}

std::optional<ParticleType> type_of(const std::string& name)
{
    static constexpr std::string_view names[] = {"fixed", "moving", "floating", "fluid"};
    for (std::uint8_t i = 0; i < 4; ++i)
        if (name == names[i]) return static_cast<ParticleType>(i);
    return {};
}

} // namespace

CaseFacts case_facts(const Element& root, const std::string& path)
{
    CaseFacts facts;
    const Element* execution = root.find_child("execution");
    if (execution == nullptr) return facts;
    if (const Element* particles = execution->find_child("particles"))
    {
        facts.limits = limits_of(*particles);
        for (const Element& block : particles->children)
        {
            const std::optional<ParticleType> type = type_of(block.name);
            if (block.kind != Element::Kind::Tag || !type) continue;
            IdRange range;
            range.begin = whole_number(block, "begin", UINT32_MAX, path);
            range.end = range.begin + whole_number(block, "count", UINT32_MAX, path);
            range.mk = static_cast<std::uint16_t>(whole_number(block, "mk", UINT16_MAX, path));
            range.type = *type;
            facts.ranges.push_back(range);
            const std::string* color = block.find_attribute("fppg:color");
            if (color == nullptr) continue;
            const std::optional<Rgb> rgb = rgb_of_hex(*color);
            if (!rgb)
                throw CaseError(path, block.line,
                                fmt::format("<{} fppg:color=\"{}\">: expected a colour as #1a99e6",
                                            block.name, *color));
            facts.colours[range.mk] = *rgb;
        }
    }
    std::sort(facts.ranges.begin(), facts.ranges.end(),
              [](const IdRange& a, const IdRange& b) { return a.begin < b.begin; });
    const Element* constants = execution->find_child("constants");
    const Element* dp = constants ? constants->find_child("dp") : nullptr;
    const std::string* value = dp ? dp->find_attribute("value") : nullptr;
    if (value != nullptr)
    {
        const auto [end, error] =
            std::from_chars(value->data(), value->data() + value->size(), facts.dp);
        if (error != std::errc() || !(facts.dp > 0) || !std::isfinite(facts.dp))
            throw CaseError(path, dp->line,
                            fmt::format("<dp value=\"{}\">: expected a distance above 0", *value));
    }
    return facts;
}

const IdRange* find_range(const std::vector<IdRange>& ranges, std::uint32_t id)
{
    const auto after =
        std::upper_bound(ranges.begin(), ranges.end(), id,
                         [](std::uint32_t i, const IdRange& r) { return i < r.begin; });
    if (after == ranges.begin() || id >= std::prev(after)->end) return nullptr;
    return &*std::prev(after);
}

} // namespace fppg
