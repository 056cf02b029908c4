// BGEO version 5, as Partio reads it: big-endian; 41 bytes of head, the point attributes, a row a
// point (x y z 1 and its attributes), 0x00 0xff. An attribute is a name, its size, its type (0
// float, 1 int, 5 vector) and that many defaults. Detail attributes follow the points.

#include "convert/columns.h"
#include "convert/formats.h"
#include "files/vtk.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <cmath>

namespace fppg
{

namespace
{

constexpr std::uint64_t most_points = 2147483647;

class BigEndianBytes
{
public:
    void put32(std::uint32_t value)
    {
        for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(value >> shift);
    }
    void put16(std::size_t value)
    {
        bytes += static_cast<char>(value >> 8U);
        bytes += static_cast<char>(value);
    }
    void put_attribute(const std::string& name, std::size_t size, std::uint32_t type)
    {
        put16(name.size());
        bytes += name;
        put16(size);
        put32(type);
        for (std::size_t i = 0; i < size; ++i) put32(0);
    }
    std::string bytes;
};

struct BgeoAttribute
{
    const char* name;
    std::size_t size;
    std::uint32_t type; ///< 0 float, 1 int, 5 vector
};

std::vector<BgeoAttribute> attributes_of(const ParticleFeed& feed)
{
    std::vector<BgeoAttribute> attributes{{"id", 1, 1},      {"velocity", 3, 5}, {"pscale", 1, 0},
                                          {"density", 1, 0}, {"mass", 1, 0},     {"volume", 1, 0},
                                          {"mk", 1, 1}};
    if (feed.has_normals) attributes.push_back({"N", 3, 5});
    if (feed.has_kinds) attributes.push_back({"kind", 1, 1});
    return attributes;
}

std::string bgeo_head(const ParticleFeed& feed, const std::vector<BgeoAttribute>& attributes)
{
    BigEndianBytes head;
    head.bytes = "BgeoV";
    head.put32(5);
    head.put32(static_cast<std::uint32_t>(feed.count));
    for (int i = 0; i < 3; ++i) head.put32(0); // primitives, groups of points and primitives
    head.put32(static_cast<std::uint32_t>(attributes.size()));
    for (int i = 0; i < 3; ++i) head.put32(0); // attributes of vertices, primitives, detail
    for (const BgeoAttribute& a : attributes) head.put_attribute(a.name, a.size, a.type);
    return head.bytes;
}

/// The rows of a piece.
void fill_rows(const ParticleFeed& feed, const ParticlePiece& piece, const Vec3& origin,
               std::vector<std::uint32_t>& rows)
{
    rows.clear();
    const auto put_float = [&](double v) { rows.push_back(big_endian(static_cast<float>(v))); };
    const auto put_int = [&](std::uint32_t v) { rows.push_back(big_endian(v)); };
    for (std::size_t k = 0; k < piece.size(); ++k)
    {
        const FeedBody& body = feed.bodies[piece.bodies[k]];
        for (int axis = 0; axis < 3; ++axis) put_float(piece.positions[k][axis] - origin[axis]);
        put_float(1);
        put_int(piece.ids[k]);
        for (std::size_t a = 0; a < 3; ++a)
            put_float(piece.velocities.empty() ? 0 : double{piece.velocities[k][a]});
        put_float(feed.dp / 2);
        put_float(double{piece.densities[k]});
        put_float(feed.mass(piece, k));
        put_float(piece.volumes[k]);
        put_int(body.mk);
        for (std::size_t a = 0; a < 3 && feed.has_normals; ++a)
            put_float(double{piece.normals[k][a]});
        if (feed.has_kinds) put_int(piece.kinds[k]);
    }
}

} // namespace

void write_bgeo(const ParticleFeed& feed, const std::string& path, int threads, ConvertedFiles& out)
{
    if (feed.count > most_points)
        throw IoError(fmt::format("cannot write '{}': {} particles, but BGEO holds at most {}",
                                  path, feed.count, most_points));
    const Box3 limits = feed.count > 0 ? limits_of_feed(feed, threads) : Box3{{}, {}};
    // A whole number of dp, so that lattices keep their places as far as float32 goes.
    Vec3 origin;
    for (int axis = 0; axis < 3; ++axis)
        origin[axis] = std::round((limits.min[axis] + limits.max[axis]) / 2 / feed.dp) * feed.dp;
    out.losses.emplace_back(
        fmt::format("positions are rounded to float32, relative to the local origin ({}, {}, {})",
                    origin.x, origin.y, origin.z));
    say_volumes(feed, out);
    const std::vector<BgeoAttribute> attributes = attributes_of(feed);
    std::size_t row = 16;
    for (const BgeoAttribute& a : attributes) row += 4 * a.size;
    const std::string head = bgeo_head(feed, attributes);
    OutputFile& file = out.files.emplace_back(path);
    file.reserve(head.size() + feed.count * row + 2);
    file.write_at(0, head.data(), head.size());
    for_each_piece(feed, threads,
                   [&](std::size_t, const ParticlePiece& piece)
                   {
                       thread_local std::vector<std::uint32_t> rows;
                       fill_rows(feed, piece, origin, rows);
                       file.write_at(head.size() + piece.first * row, rows.data(), 4 * rows.size());
                   });
    file.write_at(head.size() + feed.count * row, "\0\xff", 2);
}

} // namespace fppg
