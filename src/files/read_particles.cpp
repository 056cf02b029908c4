#include "fppg/read_particles.h"

#include "casedef/xml_document.h"
#include "core/parallel.h"
#include "files/particle_readers.h"
#include "fppg/error.h"
#include "fppg/particles.h"

#include <fmt/format.h>
#include <algorithm>
#include <charconv>
#include <filesystem>
#include <optional>

namespace fppg
{

namespace
{

constexpr std::size_t particles_a_chunk = 65536;

bool is_file(const std::string& path)
{
    std::error_code ignored;
    return std::filesystem::is_regular_file(path, ignored);
}

/// `text` without `end`, if it ends so.
std::optional<std::string> without(const std::string& text, std::string_view end)
{
    if (!text.ends_with(end) || text.size() == end.size()) return {};
    return text.substr(0, text.size() - end.size());
}

/// Ids of one mk.
struct IdRange
{
    std::uint64_t begin = 0;
    std::uint64_t end = 0;
    std::uint16_t mk = 0;
    ParticleType type = ParticleType::Fixed;
};

/// What Case.xml says of the particles.
struct CaseFacts
{
    std::vector<IdRange> ranges; ///< sorted
    double dp = 0;               ///< 0 where it does not say
};

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

std::optional<ParticleType> type_of(const std::string& name)
{
    static constexpr std::string_view names[] = {"fixed", "moving", "floating", "fluid"};
    for (std::uint8_t i = 0; i < 4; ++i)
        if (name == names[i]) return static_cast<ParticleType>(i);
    return {};
}

CaseFacts read_facts(const std::string& path)
{
    const Element root = read_xml(path);
    CaseFacts facts;
    const Element* execution = root.find_child("execution");
    if (execution == nullptr) return facts;
    if (const Element* particles = execution->find_child("particles"))
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

void set_mk_and_type(const CaseFacts& facts, const std::string& xml,
                     const std::vector<std::uint32_t>& idp, ParticleCloud& cloud, int threads)
{
    cloud.mk.resize(idp.size());
    cloud.type.resize(idp.size());
    const auto set = [&](std::size_t i)
    {
        const auto after =
            std::upper_bound(facts.ranges.begin(), facts.ranges.end(), idp[i],
                             [](std::uint32_t id, const IdRange& r) { return id < r.begin; });
        if (after == facts.ranges.begin() || idp[i] >= std::prev(after)->end)
            throw CaseError(
                xml, 0,
                fmt::format("no block of <particles> holds the id {} of '{}'", idp[i], cloud.file));
        cloud.mk[i] = std::prev(after)->mk;
        cloud.type[i] = static_cast<std::uint8_t>(std::prev(after)->type);
    };
    parallel_for(idp.size(), threads, set, particles_a_chunk);
}

/// The median of the distances from some particles, evenly spread over the file, to the nearest
/// particle that is not at the same place.
double typical_distance(const std::vector<Vec3>& positions, int threads)
{
    const std::size_t n = positions.size();
    const std::size_t samples = std::min<std::size_t>(n, 65);
    std::vector<double> squares(samples);
    const auto find_nearest = [&](std::size_t s)
    {
        const Vec3 from = positions[s * n / samples];
        double nearest = std::numeric_limits<double>::infinity();
        for (const Vec3& p : positions)
        {
            const double square = dot(p - from, p - from);
            if (square > 0 && square < nearest) nearest = square;
        }
        squares[s] = nearest;
    };
    parallel_for(samples, threads, find_nearest);
    if (samples == 0) return 1;
    std::nth_element(squares.begin(), squares.begin() + static_cast<std::ptrdiff_t>(samples / 2),
                     squares.end());
    const double distance = std::sqrt(squares[samples / 2]);
    return std::isfinite(distance) ? distance : 1;
}

ParticleCloud read_case(const std::string& stem, int threads)
{
    ParticleCloud cloud;
    cloud.file = stem + ".bi4";
    const std::string xml = stem + ".xml";
    if (!is_file(xml))
        throw IoError(fmt::format("'{}' has no mk of its own, and '{}', which has, is not there",
                                  cloud.file, xml));
    const CaseFacts facts = read_facts(xml);
    std::vector<std::uint32_t> idp;
    read_bi4(cloud.file, cloud, idp, threads);
    set_mk_and_type(facts, xml, idp, cloud, threads);
    cloud.dp = facts.dp > 0 ? facts.dp : typical_distance(cloud.positions, threads);
    return cloud;
}

ParticleCloud read_picture(const std::string& path, int threads)
{
    ParticleCloud cloud;
    cloud.file = path;
    read_particles_vtk(path, cloud, threads);
    for (const char* end : {"_All.vtk", "_Bound.vtk", "_Fluid.vtk"})
        if (const std::optional<std::string> stem = without(path, end))
            if (is_file(*stem + ".xml")) cloud.dp = read_facts(*stem + ".xml").dp;
    if (cloud.dp == 0) cloud.dp = typical_distance(cloud.positions, threads);
    return cloud;
}

} // namespace

ParticleCloud read_particles(const std::string& name, bool has_kind_first, int threads)
{
    std::optional<std::string> stem = without(name, ".bi4");
    if (!stem) stem = without(name, ".xml");
    const bool is_one_file = stem.has_value() || name.ends_with(".vtk");
    if (is_one_file && !is_file(name))
        throw IoError(fmt::format("cannot read '{}': there is no such file", name));
    if (name.ends_with(".vtk")) return read_picture(name, threads);
    if (!stem) stem = name;
    const std::string picture = *stem + "_All.vtk";
    if (has_kind_first && !name.ends_with(".bi4") && is_file(picture))
        return read_picture(picture, threads);
    if (is_file(*stem + ".bi4")) return read_case(*stem, threads);
    if (is_file(picture)) return read_picture(picture, threads);
    throw IoError(
        fmt::format("cannot read the case '{}': there is neither '{}.bi4' nor '{}_All.vtk'", *stem,
                    *stem, *stem));
}

} // namespace fppg
