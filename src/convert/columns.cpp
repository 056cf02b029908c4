#include "convert/columns.h"

#include "core/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace fppg
{

namespace
{

static_assert(std::endian::native == std::endian::little,
              "columns are written as they lie in memory");

template <typename Get>
void fill_numbers(std::size_t n, double* out, const Get& get)
{
    for (std::size_t i = 0; i < n; ++i) out[i] = static_cast<double>(get(i));
}

/// The components of vectors, or one of them.
template <typename Get>
void fill_vectors(std::size_t n, int axis, double* out, const Get& get)
{
    if (axis >= 0) return fill_numbers(n, out, [&](std::size_t i) { return get(i, axis); });
    for (std::size_t i = 0; i < n; ++i)
        for (int a = 0; a < 3; ++a) out[3 * i + static_cast<std::size_t>(a)] = get(i, a);
}

template <typename Array>
void fill_floats(const std::vector<Array>& values, std::size_t n, int axis, double* out)
{
    if (values.empty()) return std::fill_n(out, axis < 0 ? 3 * n : n, 0.0), void();
    fill_vectors(n, axis, out,
                 [&](std::size_t i, int a)
                 { return double{values[i][static_cast<std::size_t>(a)]}; });
}

/// The numbers of a column for a piece whose first particle is number `first` of the file.
void fill_field(const ParticleFeed& feed, const ParticlePiece& piece, std::uint64_t first,
                const Column& column, double* out)
{
    const std::size_t n = piece.size();
    const auto fill = [&](const auto& get) { fill_numbers(n, out, get); };
    const auto body = [&](std::size_t i) -> const FeedBody&
    { return feed.bodies[piece.bodies[i]]; };
    switch (column.field)
    {
        case Field::Position:
            return fill_vectors(n, column.axis, out,
                                [&](std::size_t i, int a) { return piece.positions[i][a]; });
        case Field::Velocity:
            return fill_floats(piece.velocities, n, column.axis, out);
        case Field::Normal:
            return fill_floats(piece.normals, n, column.axis, out);
        case Field::Density:
            return fill([&](std::size_t i) { return piece.densities[i]; });
        case Field::Pressure:
            return fill([&](std::size_t i) { return pressure_of(feed, piece.densities[i]); });
        case Field::Mass:
            return fill([&](std::size_t i) { return feed.mass(piece, i); });
        case Field::Volume:
            return fill([&](std::size_t i) { return piece.volumes[i]; });
        case Field::Spacing:
            return fill([&](std::size_t) { return feed.dp; });
        case Field::Smoothing:
            return fill([&](std::size_t) { return feed.h; });
        case Field::Id:
            return fill([&](std::size_t i) { return piece.ids[i]; });
        case Field::Mk:
            return fill([&](std::size_t i) { return body(i).mk; });
        case Field::Type:
            return fill([&](std::size_t i) { return static_cast<int>(body(i).type); });
        case Field::Kind:
            return fill([&](std::size_t i)
                        { return piece.kinds.empty() ? std::uint8_t{3} : piece.kinds[i]; });
        case Field::Index:
            return fill([&](std::size_t i) { return first + i; });
        case Field::IndexAfter:
            return fill([&](std::size_t i) { return first + i + 1; });
        case Field::One:
            return fill([](std::size_t) { return 1; });
        case Field::Zero:
            return fill([](std::size_t) { return 0; });
    }
}

template <typename T>
void cast_numbers(const double* from, std::size_t n, char* out)
{
    for (std::size_t i = 0; i < n; ++i)
    {
        const T value = static_cast<T>(from[i]);
        std::memcpy(out + i * sizeof value, &value, sizeof value);
    }
}

void cast_to(ColumnType type, const double* from, std::size_t n, char* out)
{
    switch (type)
    {
        case ColumnType::UInt8:
            return cast_numbers<std::uint8_t>(from, n, out);
        case ColumnType::Int32:
            return cast_numbers<std::int32_t>(from, n, out);
        case ColumnType::UInt32:
            return cast_numbers<std::uint32_t>(from, n, out);
        case ColumnType::Int64:
            return cast_numbers<std::int64_t>(from, n, out);
        case ColumnType::Float32:
            return cast_numbers<float>(from, n, out);
        case ColumnType::Float64:
            return cast_numbers<double>(from, n, out);
    }
}

/// The bytes of a column of a piece, the first particle of which is number `first` of its array.
void fill_bytes(const ParticleFeed& feed, const ParticlePiece& piece, std::uint64_t first,
                const Column& column, char* out)
{
    if (column.field == Field::Position && column.is_vector() && column.type == ColumnType::Float64)
    {
        static_assert(sizeof(Vec3) == 3 * sizeof(double));
        std::memcpy(out, piece.positions.data(), piece.size() * sizeof(Vec3));
        return;
    }
    thread_local std::vector<double> numbers;
    numbers.resize(piece.size() * (column.is_vector() ? 3 : 1));
    fill_field(feed, piece, first, column, numbers.data());
    cast_to(column.type, numbers.data(), numbers.size(), out);
}

/// Writes the columns of a piece, the first particle of which is number `first` of the arrays.
void write_piece_columns(OutputFile& file, const ParticleFeed& feed, const ParticlePiece& piece,
                         std::uint64_t first, const std::vector<PlacedColumn>& columns)
{
    thread_local std::vector<char> bytes;
    for (const PlacedColumn& placed : columns)
    {
        const std::size_t width = placed.column.bytes_per_particle();
        bytes.resize(piece.size() * width);
        fill_bytes(feed, piece, first, placed.column, bytes.data());
        file.write_at(placed.at + first * width, bytes.data(), bytes.size());
    }
}

template <typename T>
void select_entries(const std::vector<T>& from, const std::vector<std::uint32_t>& chosen,
                    std::vector<T>& to)
{
    to.clear();
    if (from.empty()) return;
    for (const std::uint32_t i : chosen) to.push_back(from[i]);
}

} // namespace

std::size_t width_of(ColumnType type)
{
    constexpr std::array<std::size_t, 6> widths{1, 4, 4, 8, 4, 8};
    return widths[static_cast<std::size_t>(type)];
}

double pressure_of(const ParticleFeed& feed, float density)
{
    if (!(feed.rhop0 > 0)) return 0;
    return feed.b * (std::pow(double{density} / feed.rhop0, feed.gamma) - 1);
}

void select_body(const ParticlePiece& piece, std::uint16_t body, ParticlePiece& out)
{
    std::vector<std::uint32_t> chosen;
    for (std::uint32_t i = 0; i < piece.size(); ++i)
        if (piece.bodies[i] == body) chosen.push_back(i);
    out.first = piece.first;
    select_entries(piece.positions, chosen, out.positions);
    select_entries(piece.velocities, chosen, out.velocities);
    select_entries(piece.densities, chosen, out.densities);
    select_entries(piece.volumes, chosen, out.volumes);
    select_entries(piece.normals, chosen, out.normals);
    select_entries(piece.ids, chosen, out.ids);
    select_entries(piece.bodies, chosen, out.bodies);
    select_entries(piece.kinds, chosen, out.kinds);
}

void for_each_piece(const ParticleFeed& feed, int threads,
                    const std::function<void(std::size_t, const ParticlePiece&)>& body,
                    PieceContent wanted)
{
    parallel_for(feed.pieces(), threads,
                 [&](std::size_t i)
                 {
                     thread_local ParticlePiece piece;
                     piece.wanted = wanted;
                     feed.read(i, piece);
                     body(i, piece);
                 });
}

BodyOrder order_by_body(const ParticleFeed& feed, int threads)
{
    BodyOrder order;
    order.pieces.resize(feed.pieces());
    order.counts.assign(feed.bodies.size(), 0);
    for_each_piece(
        feed, threads,
        [&](std::size_t i, const ParticlePiece& piece)
        {
            std::vector<std::uint32_t> counts(feed.bodies.size(), 0);
            for (const std::uint16_t body : piece.bodies) ++counts[body];
            for (std::size_t body = 0; body < counts.size(); ++body)
                if (counts[body] > 0)
                    order.pieces[i].push_back({static_cast<std::uint16_t>(body), 0, counts[body]});
        });
    for (std::vector<BodyOrder::Part>& parts : order.pieces)
        for (BodyOrder::Part& part : parts)
        {
            part.first = order.counts[part.body];
            order.counts[part.body] += part.count;
        }
    return order;
}

void fill_column(const ParticleFeed& feed, const Column& column, char* out, int threads)
{
    const std::size_t width = column.bytes_per_particle();
    for_each_piece(
        feed, threads,
        [&](std::size_t, const ParticlePiece& piece)
        { fill_bytes(feed, piece, piece.first, column, out + piece.first * width); },
        column.field == Field::Position ? PieceContent::Positions : PieceContent::All);
}

void write_columns(OutputFile& file, const ParticleFeed& feed,
                   const std::vector<PlacedColumn>& columns, int threads)
{
    for_each_piece(feed, threads,
                   [&](std::size_t, const ParticlePiece& piece)
                   { write_piece_columns(file, feed, piece, piece.first, columns); });
}

void write_columns_by_body(const ParticleFeed& feed, const BodyOrder& order,
                           const std::vector<BodyColumns>& bodies, int threads)
{
    const auto write = [&](const ParticlePiece& piece, const BodyOrder::Part& part)
    {
        const BodyColumns& to = bodies[part.body];
        write_piece_columns(*to.file, feed, piece, part.first, to.columns);
    };
    for_each_piece(feed, threads,
                   [&](std::size_t i, const ParticlePiece& piece)
                   {
                       const std::vector<BodyOrder::Part>& parts = order.pieces[i];
                       if (parts.size() == 1) return write(piece, parts.front());
                       for (const BodyOrder::Part& part : parts)
                       {
                           thread_local ParticlePiece chosen;
                           select_body(piece, part.body, chosen);
                           write(chosen, part);
                       }
                   });
}

} // namespace fppg
