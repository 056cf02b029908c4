#include "meshes/small_pieces.h"

#include "core/morton.h"
#include "core/parallel_sort.h"

#include <array>
#include <cmath>
#include <tuple>

namespace fppg
{
namespace
{

/// One of 24 groups of directions, within which they turn by less than 71 degrees.
std::uint32_t facing(const Vec3& normal)
{
    std::uint32_t axis = 0;
    for (std::uint32_t a = 1; a < 3; ++a)
        if (std::fabs(normal[static_cast<int>(a)]) > std::fabs(normal[static_cast<int>(axis)]))
            axis = a;
    std::uint32_t signs = 0;
    for (int a = 0; a < 3; ++a) signs = 2 * signs + (normal[a] < 0 ? 1 : 0);
    return 8 * axis + signs;
}

struct Entry
{
    std::uint64_t key = 0; ///< of its cell on the Morton curve
    std::array<std::int64_t, 3> cell{};
    std::uint32_t kind = 0;
    std::uint32_t facing = 0;
    double off = 0; ///< from the middle of the cell, squared
    std::uint32_t piece = 0;

    auto group() const { return std::tie(key, cell, kind, facing); }
};

Entry entry_of(const SmallPiece& piece, std::uint32_t index, double cell)
{
    Entry out;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double at = piece.middle[axis] / cell;
        const double low = std::floor(at);
        out.cell[static_cast<std::size_t>(axis)] = static_cast<std::int64_t>(low);
        out.off += (at - low - 0.5) * (at - low - 0.5);
    }
    constexpr std::int64_t half = most_morton_cells / 2;
    const auto on_curve = [&](std::size_t axis)
    { return (out.cell[axis] + half) & (most_morton_cells - 1); };
    out.key = morton_key(on_curve(0), on_curve(1), on_curve(2));
    out.kind = piece.kind;
    out.facing = facing(piece.normal);
    out.piece = index;
    return out;
}

} // namespace

PiecesToAsk pieces_to_ask(const std::vector<SmallPiece>& pieces, double cell, int threads)
{
    std::vector<Entry> entries(pieces.size());
    parallel_for(
        entries.size(), threads,
        [&](std::size_t i)
        { entries[i] = entry_of(pieces[i], static_cast<std::uint32_t>(i), cell); },
        1024);
    parallel_sort(
        entries, threads,
        [](const Entry& a, const Entry& b)
        { return std::tuple(a.group(), a.off, a.piece) < std::tuple(b.group(), b.off, b.piece); });
    PiecesToAsk out;
    out.for_each.resize(pieces.size());
    const Entry* asked = nullptr;
    for (const Entry& entry : entries)
    {
        const bool is_small = pieces[entry.piece].is_small;
        const bool is_new = !is_small || asked == nullptr || asked->group() != entry.group();
        if (is_new) out.order.push_back(entry.piece);
        if (is_new && is_small) asked = &entry;
        out.for_each[entry.piece] = is_small ? asked->piece : entry.piece;
    }
    return out;
}

std::vector<AskedFacet> facets_to_ask(const SurfaceMesh& mesh, double size, int threads)
{
    std::vector<SmallPiece> pieces(mesh.facets.size());
    parallel_for(
        pieces.size(), threads,
        [&](std::size_t f)
        {
            const auto corner = [&](std::size_t k) { return mesh.vertices[mesh.facets[f][k % 3]]; };
            SmallPiece& piece = pieces[f];
            piece.middle = (corner(0) + corner(1) + corner(2)) / 3;
            piece.normal = mesh.normals[f];
            for (std::size_t k = 0; k < 3; ++k)
                piece.is_small = piece.is_small && norm(corner(k + 1) - corner(k)) < size;
        },
        1024);
    const PiecesToAsk asked = pieces_to_ask(pieces, size, threads);
    std::vector<double> areas(pieces.size(), 0);
    for (std::size_t f = 0; f < areas.size(); ++f) areas[asked.for_each[f]] += mesh.areas[f];
    std::vector<AskedFacet> out;
    for (const std::uint32_t f : asked.order) out.push_back({f, areas[f]});
    return out;
}

} // namespace fppg
