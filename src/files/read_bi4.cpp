// The container is described at the head of src/files/bi4.cpp. Order of values and arrays does not
// matter to a reader, so all items are walked and the arrays wanted are picked by name.

#include "core/binary_items.h"
#include "core/file_map.h"
#include "core/parallel.h"
#include "files/particle_readers.h"
#include "fppg/error.h"

#include <fmt/format.h>
#include <cstring>
#include <string_view>

namespace fppg
{

namespace
{

constexpr std::size_t particles_a_chunk = 65536;

struct Bi4View
{
    std::string_view idp, pos, posd;
};

/// Finds the arrays of an item and of those in it.
void pick_arrays(const BinaryItem& item, const std::string& path, Bi4View& view)
{
    for (const BinaryArray& array : item.arrays)
    {
        const auto pick = [&](std::string_view wanted, int expected_type, std::uint64_t width,
                              std::string_view& place)
        {
            if (array.name != wanted) return;
            if (array.type != expected_type || array.data.size() % width != 0 ||
                array.data.size() / width != array.count)
                throw IoError(fmt::format(
                    "cannot read '{}': array {} has type {} and {} bytes for {} particles", path,
                    array.name, array.type, array.data.size(), array.count));
            place = array.data;
        };
        pick("Idp", 8, 4, view.idp);
        pick("Pos", 22, 12, view.pos);
        pick("Posd", 23, 24, view.posd);
    }
    for (const BinaryItem& child : item.items) pick_arrays(child, path, view);
}

template <typename T>
void copy_positions(std::string_view data, std::vector<Vec3>& positions, int threads)
{
    const auto copy = [&](std::size_t i)
    {
        T p[3];
        std::memcpy(p, data.data() + i * sizeof p, sizeof p);
        positions[i] = {p[0], p[1], p[2]};
    };
    parallel_for(positions.size(), threads, copy, particles_a_chunk);
}

} // namespace

void read_bi4(const std::string& path, ParticleCloud& cloud, std::vector<std::uint32_t>& idp,
              int threads)
{
    const FileMap file(path);
    Bi4View view;
    for (const BinaryItem& item : read_binary_items(file.bytes(), path, "JPartDataBi4"))
        pick_arrays(item, path, view);
    const std::size_t n = view.idp.size() / 4;
    // Where a file has both, the solver takes the single ones too.
    const bool is_single = view.posd.empty() || !view.pos.empty();
    const std::size_t n_positions = is_single ? view.pos.size() / 12 : view.posd.size() / 24;
    if (n_positions != n)
        throw IoError(
            fmt::format("cannot read '{}': it has {} ids and {} positions", path, n, n_positions));
    idp.resize(n);
    if (n > 0) std::memcpy(idp.data(), view.idp.data(), 4 * n);
    cloud.positions.resize(n);
    if (is_single)
        copy_positions<float>(view.pos, cloud.positions, threads);
    else
        copy_positions<double>(view.posd, cloud.positions, threads);
}

} // namespace fppg
