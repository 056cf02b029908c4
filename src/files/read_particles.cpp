#include "fppg/read_particles.h"

#include "casedef/xml_document.h"
#include "core/parallel.h"
#include "files/case_facts.h"
#include "files/particle_readers.h"
#include "files/result_pair.h"
#include "files/typical_distance.h"
#include "fppg/error.h"
#include "platform/file_map.h"

#include <fmt/format.h>
#include <algorithm>
#include <optional>

namespace fppg
{

namespace
{

/// `text` without `end`, if it ends so.
std::optional<std::string> without(const std::string& text, std::string_view end)
{
    if (!text.ends_with(end) || text.size() == end.size()) return {};
    return text.substr(0, text.size() - end.size());
}

void set_mk_and_type(const CaseFacts& facts, const std::string& xml,
                     const std::vector<std::uint32_t>& idp, ParticleCloud& cloud, int threads)
{
    cloud.mk.resize(idp.size());
    cloud.type.resize(idp.size());
    const auto set = [&](std::size_t i)
    {
        const IdRange* range = find_range(facts.ranges, idp[i]);
        if (range == nullptr)
            throw CaseError(
                xml, 0,
                fmt::format("no block of <particles> holds the id {} of '{}'", idp[i], cloud.file));
        cloud.mk[i] = range->mk;
        cloud.type[i] = static_cast<std::uint8_t>(range->type);
    };
    parallel_for(idp.size(), threads, set, particles_per_chunk);
}

double guess_dp(const std::vector<Vec3>& positions, int threads)
{
    return typical_distance(
        positions.size(), [&](std::size_t i) { return positions[i]; }, threads);
}

ParticleCloud read_case(const std::string& stem, int threads)
{
    ParticleCloud cloud;
    cloud.file = stem + ".bi4";
    const std::string xml = stem + ".xml";
    expect_case_xml({cloud.file, xml});
    const CaseFacts facts = case_facts(read_xml(xml), xml);
    std::vector<std::uint32_t> idp;
    const FileMap file(cloud.file);
    const Bi4View view = view_bi4(file.bytes(), cloud.file);
    expect_one_run({cloud.file, xml}, facts, view);
    copy_particles(view, cloud, idp, threads);
    set_mk_and_type(facts, xml, idp, cloud, threads);
    cloud.colours = facts.colours;
    cloud.dp = facts.dp > 0 ? facts.dp : guess_dp(cloud.positions, threads);
    return cloud;
}

ParticleCloud read_particles_vtk(const std::string& path, int threads)
{
    ParticleCloud cloud;
    cloud.file = path;
    read_particles_vtk(path, cloud, threads);
    for (const char* end : {"_All.vtk", "_Bound.vtk", "_Fluid.vtk"})
        if (const std::optional<std::string> stem = without(path, end))
            if (is_file(*stem + ".xml"))
            {
                CaseFacts facts = case_facts(read_xml(*stem + ".xml"), *stem + ".xml");
                cloud.dp = facts.dp;
                cloud.colours = std::move(facts.colours);
            }
    if (cloud.dp == 0) cloud.dp = guess_dp(cloud.positions, threads);
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
    if (name.ends_with(".vtk")) return read_particles_vtk(name, threads);
    if (!stem) stem = name;
    const std::string picture = *stem + "_All.vtk";
    if (has_kind_first && !name.ends_with(".bi4") && is_file(picture))
        return read_particles_vtk(picture, threads);
    if (is_file(*stem + ".bi4")) return read_case(*stem, threads);
    if (is_file(picture)) return read_particles_vtk(picture, threads);
    throw IoError(
        fmt::format("cannot read the case '{}': there is neither '{}.bi4' nor '{}_All.vtk'", *stem,
                    *stem, *stem));
}

} // namespace fppg
