#include "files/particle_source.h"

#include "casedef/xml_document.h"
#include "files/result_pair.h"
#include "fppg/error.h"
#include "platform/file_map.h"

#include <fmt/format.h>

#include <filesystem>

namespace fppg
{

namespace
{

std::string without_end(const std::string& text, std::size_t length)
{
    return text.substr(0, text.size() - length);
}

void expect_length(const std::string& path, const char* name, std::string_view data,
                   std::size_t width, std::size_t n)
{
    if (!data.empty() && data.size() != width * n)
        throw IoError(fmt::format("cannot read '{}': array {} has {} values for {} particles", path,
                                  name, data.size() / width, n));
}

/// Case.xml of an output of the solver, which puts it one folder above its parts; empty: not there.
std::string find_xml_of_output(const std::string& path, const Bi4View& bi4)
{
    const BinaryValue* name = find_value(bi4.items, "CaseName");
    if (name == nullptr) return {};
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    const std::string file = std::string(name->data) + ".xml";
    for (const std::filesystem::path& place : {folder / file, folder / ".." / file})
        if (is_file(place.string())) return place.lexically_normal().string();
    return {};
}

} // namespace

ParticleSource::ParticleSource(const std::string& name, const std::string& xml)
{
    const bool is_bi4_name = name.ends_with(".bi4") || name.ends_with(".xml");
    const bool is_vtk_name = name.ends_with(".vtk");
    if ((is_bi4_name || is_vtk_name) && !is_file(name))
        throw IoError(fmt::format("cannot read '{}': there is no such file", name));
    const std::string stem = is_bi4_name ? without_end(name, 4) : name;
    if (is_vtk_name)
        open_vtk(name);
    else if (is_file(stem + ".bi4"))
        open_bi4(stem, xml);
    else if (is_file(stem + "_All.vtk"))
        open_vtk(stem + "_All.vtk");
    else
        throw IoError(
            fmt::format("cannot read the case '{}': there is neither '{}.bi4' nor '{}_All.vtk'",
                        stem, stem, stem));
    if (size_ > UINT32_MAX)
        throw IoError(
            fmt::format("cannot read '{}': {} particles are more than ids", path_, size_));
}

void ParticleSource::open_bi4(const std::string& stem, const std::string& xml)
{
    path_ = stem + ".bi4";
    xml_path_ = xml.empty() ? stem + ".xml" : xml;
    file_ = std::make_unique<FileMap>(path_);
    bi4_ = view_bi4(file_->bytes(), path_);
    if (xml.empty() && !is_file(xml_path_))
        if (const std::string found = find_xml_of_output(path_, bi4_); !found.empty())
            xml_path_ = found;
    expect_case_xml({path_, xml_path_});
    xml_ = read_xml(xml_path_);
    facts_ = case_facts(*xml_, xml_path_);
    expect_one_run({path_, xml_path_}, facts_, bi4_);
    size_ = bi4_.size();
    is_single_ = bi4_.is_single();
    points_ = is_single_ ? bi4_.pos : bi4_.posd;
    density_ = bi4_.rhop;
    velocity_ = bi4_.vel;
    normals_ = bi4_.bound_normals;
    expect_length(path_, "Rhop", density_, 4, size_);
    expect_length(path_, "Vel", velocity_, 12, size_);
}

void ParticleSource::open_vtk(const std::string& path)
{
    path_ = path;
    for (const std::string_view end : {"_All.vtk", "_Bound.vtk", "_Fluid.vtk"})
        if (path.ends_with(end) && is_file(without_end(path, end.size()) + ".xml"))
        {
            xml_path_ = without_end(path, end.size()) + ".xml";
            xml_ = read_xml(xml_path_);
            facts_ = case_facts(*xml_, xml_path_);
        }
    file_ = std::make_unique<FileMap>(path_);
    vtk_ = std::make_unique<VtkWalk>(file_->bytes(), path_);
    const VtkWalk& walk = *vtk_;
    size_ = walk.points.count;
    is_single_ = walk.points.type != "double";
    if (size_ > 0 && is_single_ && walk.points.type != "float")
        walk.fail(
            fmt::format("its points have the type {}, expected float or double", walk.points.type));
    if (walk.mk.type.empty()) walk.fail("it has no point data Mk");
    walk.expect_integers("Mk", walk.mk);
    if (!walk.idp.type.empty()) walk.expect_integers("Idp", walk.idp);
    if (!walk.type.type.empty()) walk.expect_integers("Type", walk.type);
    points_ = walk.points.data;
    const auto take = [&](const char* name, const VtkArray& array, std::string_view& place)
    {
        if (array.type.empty()) return;
        walk.expect_floats(name, array);
        place = array.data;
    };
    take("Rhop", walk.density, density_);
    take("Vel", walk.velocity, velocity_);
    // Without NormalSize, "Normal" is that of the facet.
    if (walk.has_sizes) take("Normal", walk.normal, normals_);
}

const IdRange& ParticleSource::range_of(std::size_t i) const
{
    const IdRange* range = find_range(facts_.ranges, little_endian_id(i));
    if (range == nullptr)
        throw CaseError(xml_path_, 0,
                        fmt::format("no block of <particles> holds the id {} of '{}'",
                                    little_endian_id(i), path_));
    return *range;
}

std::uint16_t ParticleSource::mk(std::size_t i) const
{
    if (!vtk_) return range_of(i).mk;
    const std::uint32_t mk = integer(vtk_->mk, i);
    if (mk > UINT16_MAX) vtk_->fail(fmt::format("array Mk has {} at point {}", mk, i));
    return static_cast<std::uint16_t>(mk);
}

std::uint8_t ParticleSource::type(std::size_t i) const
{
    if (!vtk_) return static_cast<std::uint8_t>(range_of(i).type);
    const std::uint32_t type = integer(vtk_->type, i);
    if (type > 3) vtk_->fail(fmt::format("array Type has {} at point {}", type, i));
    return static_cast<std::uint8_t>(type);
}

} // namespace fppg
