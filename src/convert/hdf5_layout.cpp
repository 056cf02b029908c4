// An HDF5 file, as the specification says (version 3.0, "superblock version 0"):
//
//   superblock   96 bytes: versions, sizes, end of file, the root group's entry
//   group        object header with a symbol table message -> B-tree of one node -> symbol node
//   with
//                the entries in order of their names; a local heap holds the names
//   dataset      object header with dataspace, datatype, fill value and contiguous layout
//   attribute    a message of either header
//
// Nodes are as large as the superblock's K says, whatever they hold. Everything is little-endian.

#include "convert/hdf5_layout.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <type_traits>

namespace fppg
{

namespace
{

constexpr std::uint64_t undefined_address = UINT64_MAX;
constexpr std::uint16_t leaf_k = 63; ///< a symbol node holds 2 K entries
constexpr std::uint16_t internal_k = 1;
constexpr std::size_t superblock_size = 96;
constexpr std::size_t tree_size = 24 + 2 * internal_k * 16 + 8;
constexpr std::size_t entry_size = 40;
constexpr std::size_t symbols_size = 8 + 2 * leaf_k * entry_size;

class Hdf5Bytes
{
public:
    template <typename T>
    Hdf5Bytes& put(T value)
    {
        static_assert(std::is_arithmetic_v<T>);
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
        return *this;
    }
    Hdf5Bytes& put8(int value) { return put(static_cast<std::uint8_t>(value)); }
    Hdf5Bytes& put16(std::size_t value) { return put(static_cast<std::uint16_t>(value)); }
    Hdf5Bytes& put32(std::size_t value) { return put(static_cast<std::uint32_t>(value)); }
    Hdf5Bytes& put64(std::uint64_t value) { return put(value); }
    Hdf5Bytes& text(std::string_view value)
    {
        bytes.append(value);
        return *this;
    }
    /// Zeros up to a multiple of 8.
    Hdf5Bytes& pad()
    {
        bytes.resize((bytes.size() + 7) / 8 * 8, '\0');
        return *this;
    }
    std::string bytes;
};

std::string padded(Hdf5Bytes bytes)
{
    return std::move(bytes.pad().bytes);
}

std::string whole_number_type(std::size_t width, bool is_signed)
{
    Hdf5Bytes out;
    out.put8(0x10).put8(is_signed ? 8 : 0).put16(0).put32(width);
    out.put16(0).put16(8 * width);
    return std::move(out.bytes);
}

std::string ieee_type(std::size_t width)
{
    Hdf5Bytes out;
    const bool is_double = width == 8;
    out.put8(0x11).put8(0x20).put8(is_double ? 63 : 31).put8(0).put32(width);
    out.put16(0).put16(8 * width);
    out.put8(is_double ? 52 : 23).put8(is_double ? 11 : 8).put8(0).put8(is_double ? 52 : 23);
    out.put32(is_double ? 1023 : 127);
    return std::move(out.bytes);
}

std::string text_type(std::size_t length)
{
    Hdf5Bytes out;
    out.put8(0x13).put8(0).put16(0).put32(length);
    return std::move(out.bytes);
}

std::string type_of_column(ColumnType type)
{
    if (type == ColumnType::Float32 || type == ColumnType::Float64)
        return ieee_type(width_of(type));
    return whole_number_type(width_of(type),
                             type == ColumnType::Int32 || type == ColumnType::Int64);
}

std::string dataspace(const std::vector<std::uint64_t>& sizes)
{
    Hdf5Bytes out;
    out.put8(1).put8(static_cast<int>(sizes.size())).put8(0).put8(0).put32(0);
    for (const std::uint64_t size : sizes) out.put64(size);
    return std::move(out.bytes);
}

struct Message
{
    int type = 0;
    std::string data; ///< of a multiple of 8 bytes
};

Message attribute_message(const Hdf5Attribute& attribute)
{
    std::string type;
    Hdf5Bytes value;
    if (const auto* number = std::get_if<std::int64_t>(&attribute.value))
    {
        type = whole_number_type(8, true);
        value.put(*number);
    }
    else if (const auto* real = std::get_if<double>(&attribute.value))
    {
        type = ieee_type(8);
        value.put(*real);
    }
    else
    {
        const auto& text = std::get<std::string>(attribute.value);
        type = text_type(text.size() + 1);
        value.text(text).put8(0);
    }
    const std::string space = dataspace({});
    Hdf5Bytes out;
    out.put8(1).put8(0).put16(attribute.name.size() + 1).put16(type.size()).put16(space.size());
    out.text(attribute.name).put8(0).pad().text(type).pad().text(space).pad().text(value.bytes);
    return {0x000C, padded(out)};
}

std::string object_header(const std::vector<Message>& messages)
{
    Hdf5Bytes body;
    for (const Message& message : messages)
        body.put16(static_cast<std::size_t>(message.type))
            .put16(message.data.size())
            .put32(0)
            .text(message.data);
    Hdf5Bytes out;
    out.put8(1).put8(0).put16(messages.size()).put32(1).put32(body.bytes.size()).put32(0);
    out.text(body.bytes);
    return std::move(out.bytes);
}

std::string dataset_header(const Hdf5Object& object, std::uint64_t at)
{
    std::vector<std::uint64_t> sizes{object.count};
    if (object.column.is_vector()) sizes.push_back(3);
    const std::uint64_t bytes = object.count * object.column.bytes_per_particle();
    Hdf5Bytes type;
    type.text(type_of_column(object.column.type));
    Hdf5Bytes fill; // version 2, made early, never written, not defined
    fill.put8(2).put8(1).put8(1).put8(0);
    Hdf5Bytes layout;
    layout.put8(3).put8(1).put64(bytes > 0 ? at : undefined_address).put64(bytes);
    std::vector<Message> messages{{0x0001, dataspace(sizes)},
                                  {0x0003, padded(type)},
                                  {0x0005, padded(fill)},
                                  {0x0008, padded(layout)}};
    for (const Hdf5Attribute& attribute : object.attributes)
        messages.push_back(attribute_message(attribute));
    return object_header(messages);
}

std::string group_header(const Hdf5Object& object, std::uint64_t tree, std::uint64_t heap)
{
    Hdf5Bytes table;
    table.put64(tree).put64(heap);
    std::vector<Message> messages{{0x0011, table.bytes}};
    for (const Hdf5Attribute& attribute : object.attributes)
        messages.push_back(attribute_message(attribute));
    return object_header(messages);
}

/// A thing in a group.
struct Link
{
    std::string name;
    std::size_t object = 0;
    std::uint64_t name_at = 0; ///< in the heap
};

/// An object and where its parts stand in the file.
struct Placed
{
    std::vector<Link> links; ///< of a group, by name
    std::string names;       ///< of its heap
    std::uint64_t header = 0, tree = 0, symbols = 0, heap = 0;
};

/// The things of each group, and the names of its heap.
std::vector<Placed> link_objects(const std::vector<Hdf5Object>& objects)
{
    std::vector<Placed> placed(objects.size());
    for (std::size_t i = 1; i < objects.size(); ++i)
    {
        const std::string& path = objects[i].path;
        const std::size_t slash = path.rfind('/');
        const std::string parent = slash == std::string::npos ? "" : path.substr(0, slash);
        for (std::size_t g = 0; g < i; ++g)
            if (objects[g].path == parent && !objects[g].is_dataset)
                placed[g].links.push_back(
                    {path.substr(slash == std::string::npos ? 0 : slash + 1), i, 0});
    }
    for (Placed& group : placed)
    {
        if (group.links.size() > 2 * leaf_k)
            throw IoError(fmt::format("{} bodies are more than the {} that the file can hold",
                                      group.links.size(), 2 * leaf_k));
        std::sort(group.links.begin(), group.links.end(),
                  [](const Link& a, const Link& b) { return a.name < b.name; });
        group.names.assign(8, '\0');
        for (Link& link : group.links)
        {
            link.name_at = group.names.size();
            Hdf5Bytes name;
            group.names += padded(std::move(name.text(link.name).put8(0)));
        }
    }
    return placed;
}

std::string tree_node(const Placed& group)
{
    Hdf5Bytes out;
    out.text("TREE").put8(0).put8(0).put16(group.links.empty() ? 0 : 1);
    out.put64(undefined_address).put64(undefined_address).put64(0);
    if (!group.links.empty()) out.put64(group.symbols).put64(group.links.back().name_at);
    out.bytes.resize(tree_size, '\0');
    return std::move(out.bytes);
}

std::string symbol_node(const Placed& group, const std::vector<Placed>& placed)
{
    Hdf5Bytes out;
    out.text("SNOD").put8(1).put8(0).put16(group.links.size());
    for (const Link& link : group.links)
        out.put64(link.name_at).put64(placed[link.object].header).put64(0).put64(0).put64(0);
    out.bytes.resize(symbols_size, '\0');
    return std::move(out.bytes);
}

std::string local_heap(const Placed& group)
{
    Hdf5Bytes out;
    // 1: no free room.
    out.text("HEAP").put32(0).put64(group.names.size()).put64(1).put64(group.heap + 32);
    return std::move(out.text(group.names).bytes);
}

std::string superblock(const Placed& root, std::uint64_t size)
{
    Hdf5Bytes out;
    out.text("\x89HDF\r\n\x1a\n").put8(0).put8(0).put8(0).put8(0).put8(0).put8(8).put8(8).put8(0);
    out.put16(leaf_k).put16(internal_k).put32(0);
    out.put64(0).put64(undefined_address).put64(size).put64(undefined_address);
    out.put64(0).put64(root.header).put32(1).put32(0).put64(root.tree).put64(root.heap);
    return std::move(out.bytes);
}

} // namespace

std::string lay_out_hdf5(std::vector<Hdf5Object>& objects, std::uint64_t& size)
{
    std::vector<Placed> placed = link_objects(objects);
    // Sizes do not depend on places, so headers are made twice.
    std::uint64_t at = superblock_size;
    const auto take = [&](std::size_t bytes) { return std::exchange(at, at + bytes); };
    for (std::size_t i = 0; i < objects.size(); ++i)
    {
        Placed& place = placed[i];
        if (objects[i].is_dataset)
        {
            place.header = take(dataset_header(objects[i], 0).size());
            continue;
        }
        place.header = take(group_header(objects[i], 0, 0).size());
        place.tree = take(tree_size);
        place.symbols = take(symbols_size);
        place.heap = take(32 + place.names.size());
    }
    const std::uint64_t end_of_head = at;
    for (Hdf5Object& object : objects)
        if (object.is_dataset)
            object.at = take((object.count * object.column.bytes_per_particle() + 7) / 8 * 8);
    size = at;
    std::string head = superblock(placed[0], size);
    for (std::size_t i = 0; i < objects.size(); ++i)
    {
        const Placed& place = placed[i];
        if (objects[i].is_dataset)
            head += dataset_header(objects[i], objects[i].at);
        else
            head += group_header(objects[i], place.tree, place.heap) + tree_node(place) +
                    symbol_node(place, placed) + local_heap(place);
    }
    if (head.size() != end_of_head) throw std::logic_error("an HDF5 file was laid out wrongly");
    return head;
}

} // namespace fppg
