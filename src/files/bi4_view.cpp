// The container is described at the head of src/files/bi4.cpp. Order of values and arrays does not
// matter to a reader, so all items are walked and the arrays wanted are picked by name.

#include "files/bi4_view.h"

#include "fppg/error.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>

namespace fppg
{

namespace
{

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
        pick("Vel", 22, 12, view.vel);
        pick("Rhop", 11, 4, view.rhop);
        pick("BoundNor", 22, 12, view.bound_normals);
        constexpr std::array<std::string_view, 6> known{"Idp", "Pos",  "Posd",
                                                        "Vel", "Rhop", "BoundNor"};
        if (std::find(known.begin(), known.end(), array.name) == known.end())
            view.others.emplace_back(array.name);
    }
    for (const BinaryItem& child : item.items) pick_arrays(child, path, view);
}

} // namespace

Bi4View view_bi4(std::string_view bytes, const std::string& path)
{
    Bi4View view;
    view.items = read_binary_items(bytes, path, "JPartDataBi4");
    for (const BinaryItem& item : view.items) pick_arrays(item, path, view);
    const std::size_t n = view.size();
    const std::size_t n_positions = view.is_single() ? view.pos.size() / 12 : view.posd.size() / 24;
    if (n_positions != n)
        throw IoError(
            fmt::format("cannot read '{}': it has {} ids and {} positions", path, n, n_positions));
    return view;
}

} // namespace fppg
