#include "convert/body_names.h"
#include "files/particle_source.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <memory>

namespace fppg
{

namespace
{

/// Pieces after which the pages read so far are given back.
constexpr std::size_t pieces_per_release = 16;

/// A number in an attribute.
double number_of(const Element& e, const char* attribute, const std::string& path)
{
    const std::string* text = e.find_attribute(attribute);
    double value = 0;
    const char* end = text != nullptr ? text->data() + text->size() : nullptr;
    if (text == nullptr || std::from_chars(text->data(), end, value).ptr != end)
        throw CaseError(path, e.line,
                        fmt::format("<{}>: expected a number in {}", e.name, attribute));
    return value;
}

/// A value of the .bi4, or of `<constants>` where an older file lacks it, or 0.
double constant_of(const ParticleSource& source, const char* in_bi4, const char* in_xml)
{
    if (const std::optional<double> value = find_number(source.bi4().items, in_bi4)) return *value;
    const Element* execution = source.xml()->find_child("execution");
    const Element* constants = execution != nullptr ? execution->find_child("constants") : nullptr;
    const Element* constant = constants != nullptr ? constants->find_child(in_xml) : nullptr;
    return constant != nullptr ? number_of(*constant, "value", source.xml_path()) : 0;
}

bool is_2d(const ParticleSource& source)
{
    const BinaryValue* value = find_value(source.bi4().items, "Data2d");
    std::int32_t flag = 0;
    if (value != nullptr && value->data.size() == sizeof flag)
        std::memcpy(&flag, value->data.data(), sizeof flag);
    return flag != 0;
}

/// The mass of the particles of a floating body: masspart is that of its fluid's particles.
double floating_mass(const Element& block, std::uint64_t count, const std::string& path)
{
    const Element* body = block.find_child("massbody");
    if (body == nullptr) throw CaseError(path, block.line, "<floating> has no massbody");
    return number_of(*body, "value", path) / static_cast<double>(count);
}

/// The blocks of Case.xml in the order of their ids, as CaseFacts::ranges.
void add_bodies(const ParticleSource& source, ParticleFeed& feed)
{
    const std::vector<IdRange>& ranges = source.facts().ranges;
    if (ranges.empty())
        throw CaseError(fmt::format("'{}' has no <particles>, expected the Case.xml of '{}'",
                                    source.xml_path(), source.path()));
    const double mass_fluid = constant_of(source, "MassFluid", "massfluid");
    const double mass_bound = constant_of(source, "MassBound", "massbound");
    std::vector<std::uint16_t> mk_types(ranges.size(), 0);
    for (const IdRange& range : ranges)
        feed.bodies.push_back({"", range.mk, range.type,
                               range.type == ParticleType::Fluid ? mass_fluid : mass_bound});
    const Element& particles = *source.xml()->find_child("execution")->find_child("particles");
    for (const Element& block : particles.children)
    {
        const std::string* begin = block.find_attribute("begin");
        if (block.kind != Element::Kind::Tag || begin == nullptr) continue;
        const auto id = static_cast<std::uint32_t>(number_of(block, "begin", source.xml_path()));
        const IdRange* range = find_range(ranges, id);
        if (range == nullptr) continue; // a block without particles
        const auto i = static_cast<std::size_t>(range - ranges.data());
        mk_types[i] = static_cast<std::uint16_t>(number_of(
            block, range->type == ParticleType::Fluid ? "mkfluid" : "mkbound", source.xml_path()));
        if (range->type == ParticleType::Floating)
            feed.bodies[i].mass =
                floating_mass(block, range->end - range->begin, source.xml_path());
    }
    static const Element none;
    const Element* casedef = source.xml()->find_child("casedef");
    name_bodies(casedef != nullptr ? *casedef : none, mk_types, feed.bodies);
}

void read_normals(const ParticleSource& source, std::size_t begin, ParticlePiece& out)
{
    out.normals.resize(out.size());
    for (std::size_t k = 0; k < out.size(); ++k)
    {
        const std::array<float, 3> n = source.normal(begin + k);
        const double length = std::hypot(double{n[0]}, double{n[1]}, double{n[2]});
        for (std::size_t a = 0; a < 3; ++a)
            out.normals[k][a] = length > 0 ? static_cast<float>(n[a] / length) : 0;
    }
}

void read_bodies(const ParticleSource& source, std::size_t begin, ParticlePiece& out)
{
    const IdRange* const first = source.facts().ranges.data();
    const IdRange* range = first;
    for (std::size_t k = 0; k < out.size(); ++k)
    {
        const std::uint32_t id = source.id(begin + k);
        if (id < range->begin || id >= range->end) range = &source.range_of(begin + k);
        out.ids[k] = id;
        out.bodies[k] = static_cast<std::uint16_t>(range - first);
    }
}

void read_positions(const ParticleSource& source, std::size_t begin, ParticlePiece& out)
{
    for (std::size_t k = 0; k < out.size(); ++k)
    {
        const Vec3 p = source.position(begin + k);
        if (!is_finite(p))
            throw IoError(fmt::format("'{}': particle {} is at ({}, {}, {})", source.path(),
                                      source.id(begin + k), p.x, p.y, p.z));
        out.positions[k] = p;
    }
}

/// Where a file lacks densities, all are rhop0; where it lacks velocities, all rest.
void read_source(const ParticleSource& source, const ParticleFeed& facts, std::size_t piece,
                 ParticlePiece& out)
{
    const std::size_t begin = piece * feed_piece;
    const std::size_t n = std::min(feed_piece, source.size() - begin);
    out.first = begin;
    out.positions.resize(n);
    out.ids.resize(n);
    out.bodies.resize(n);
    if (out.wanted != PieceContent::Bodies) read_positions(source, begin, out);
    if (out.wanted == PieceContent::Positions) return;
    read_bodies(source, begin, out);
    if (out.wanted == PieceContent::Bodies) return;
    out.velocities.resize(facts.has_velocities ? n : 0);
    out.densities.assign(n, static_cast<float>(facts.rhop0));
    out.volumes.assign(n, facts.unit_volume());
    for (std::size_t k = 0; k < n; ++k)
    {
        if (facts.has_velocities) out.velocities[k] = source.velocity(begin + k);
        if (source.has_density()) out.densities[k] = source.density(begin + k);
    }
    out.normals.clear(); // which another feed may have filled
    out.kinds.clear();
    if (facts.has_normals) read_normals(source, begin, out);
}

} // namespace

std::size_t ParticleFeed::pieces() const
{
    return (count + feed_piece - 1) / feed_piece;
}

double ParticleFeed::unit_volume() const
{
    return is_2d ? dp * dp : dp * dp * dp;
}

ParticleFeed feed_of_file(const std::string& name, const std::string& xml)
{
    const auto source = std::make_shared<const ParticleSource>(name, xml);
    if (!source->is_bi4())
        throw UsageError(
            fmt::format("'{}' is a VTK file, expected a .bi4 with Case.xml", source->path()));
    const Bi4View& bi4 = source->bi4();
    if (find_number(bi4.items, "Npiece").value_or(1) != 1)
        throw IoError(
            fmt::format("'{}' is one of several pieces, expected all particles in one "
                        "file",
                        source->path()));
    ParticleFeed feed;
    feed.case_name = std::filesystem::path(source->path()).stem().string();
    feed.count = source->size();
    feed.time = find_number(bi4.items, "TimeStep").value_or(0);
    feed.is_2d = is_2d(*source);
    feed.y_2d = find_number(bi4.items, "Data2dPosY").value_or(0);
    feed.dp = constant_of(*source, "Dp", "dp");
    feed.h = constant_of(*source, "H", "h");
    feed.rhop0 = constant_of(*source, "Rhop0", "rhop0");
    feed.gamma = constant_of(*source, "Gamma", "gamma");
    feed.b = constant_of(*source, "B", "b");
    feed.has_velocities = source->has_velocity();
    feed.has_normals = source->has_normals();
    feed.is_single = source->is_single();
    add_bodies(*source, feed);
    ParticleFeed facts = feed;
    const auto reads = std::make_shared<std::atomic<std::size_t>>(0);
    feed.read = [source, facts, reads](std::size_t piece, ParticlePiece& out)
    {
        read_source(*source, facts, piece, out);
        if (++*reads % pieces_per_release == 0) source->release();
    };
    return feed;
}

} // namespace fppg
