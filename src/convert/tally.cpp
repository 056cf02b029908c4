#include "convert/columns.h"
#include "convert/formats.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fppg
{
namespace
{

/// What some particles of one body add up to.
struct BodyTally
{
    std::uint64_t count = 0;
    double volume = 0;
    Box3 limits;

    void add(const BodyTally& other)
    {
        count += other.count;
        volume += other.volume;
        limits.add(other.limits.min);
        limits.add(other.limits.max);
    }
};

struct Tally
{
    std::vector<BodyTally> bodies;
    std::uint64_t checksum = 0;
    std::uint64_t not_finite = 0;
    std::uint64_t coincident = 0; ///< with the particle before, in the same piece
    bool are_ids_in_order = true; ///< 0, 1, 2, ...
};

/// As tools/bench/README.md says it, so that other programs can compare.
std::uint64_t checksum_of(std::uint64_t id, const Vec3& p, float density)
{
    std::uint64_t sum = 0x9E3779B97F4A7C15;
    for (const std::uint64_t word :
         {id, std::bit_cast<std::uint64_t>(p.x), std::bit_cast<std::uint64_t>(p.y),
          std::bit_cast<std::uint64_t>(p.z), std::uint64_t{std::bit_cast<std::uint32_t>(density)}})
    {
        sum = (sum ^ word) * 0xD6E8FEB86659FD93;
        sum ^= sum >> 32;
    }
    return sum;
}

Tally tally_of(const ParticlePiece& piece, std::size_t bodies)
{
    Tally out;
    out.bodies.resize(bodies);
    for (std::size_t k = 0; k < piece.size(); ++k)
    {
        const Vec3& p = piece.positions[k];
        BodyTally& body = out.bodies[piece.bodies[k]];
        ++body.count;
        body.volume += piece.volumes[k];
        body.limits.add(p);
        out.not_finite += is_finite(p) ? 0 : 1;
        out.coincident += k > 0 && p == piece.positions[k - 1] ? 1 : 0;
        out.are_ids_in_order = out.are_ids_in_order && piece.ids[k] == piece.first + k;
        out.checksum += checksum_of(piece.ids[k], p, piece.densities[k]);
    }
    return out;
}

std::string limits_text(const Box3& box)
{
    return fmt::format("[[{}, {}, {}], [{}, {}, {}]]", box.min.x, box.min.y, box.min.z, box.max.x,
                       box.max.y, box.max.z);
}

} // namespace

void write_tally(const ParticleFeed& feed, const std::string& path, int threads,
                 ConvertedFiles& out)
{
    std::vector<Tally> pieces(feed.pieces());
    for_each_piece(feed, threads,
                   [&](std::size_t i, const ParticlePiece& piece)
                   { pieces[i] = tally_of(piece, feed.bodies.size()); });
    Tally all;
    all.bodies.resize(feed.bodies.size());
    for (const Tally& piece : pieces)
    {
        for (std::size_t b = 0; b < all.bodies.size(); ++b)
            if (piece.bodies[b].count > 0) all.bodies[b].add(piece.bodies[b]);
        all.checksum += piece.checksum;
        all.not_finite += piece.not_finite;
        all.coincident += piece.coincident;
        all.are_ids_in_order = all.are_ids_in_order && piece.are_ids_in_order;
    }
    constexpr std::array types{"fixed", "moving", "floating", "fluid"};
    std::string bodies;
    for (std::size_t b = 0; b < all.bodies.size(); ++b)
    {
        const BodyTally& body = all.bodies[b];
        if (body.count == 0) continue;
        bodies += fmt::format(
            "{}\n    {{\"name\": \"{}\", \"mk\": {}, \"type\": \"{}\", \"particles\": {}, "
            "\"volume_m3\": {}, \"limits_m\": {}}}",
            bodies.empty() ? "" : ",", feed.bodies[b].name, feed.bodies[b].mk,
            types[static_cast<std::size_t>(feed.bodies[b].type)], body.count, body.volume,
            limits_text(body.limits));
    }
    out.files.emplace_back(path).append(
        fmt::format("{{\n  \"particles\": {},\n  \"dp_m\": {},\n  \"checksum\": \"{:016x}\",\n  "
                    "\"ids_in_order\": {},\n"
                    "  \"not_finite\": {},\n  \"coincident\": {},\n  \"bodies\": [{}\n  ]\n}}\n",
                    feed.count, feed.dp, all.checksum, all.are_ids_in_order, all.not_finite,
                    all.coincident, bodies));
}

} // namespace fppg
