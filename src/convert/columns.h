#pragma once

#include "fppg/convert.h"

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

/// What a file says of every particle.
enum class Field : std::uint8_t
{
    Position,
    Velocity,
    Normal,
    Density,
    Pressure,
    Mass,
    Volume,
    Spacing,   ///< dp
    Smoothing, ///< h
    Id,
    Mk,
    Type,       ///< as ParticleType
    Kind,       ///< as FitKind
    Index,      ///< place in the file, from 0
    IndexAfter, ///< the next one's
    One,
    Zero,
};

enum class ColumnType : std::uint8_t
{
    UInt8,
    Int32,
    UInt32,
    Int64,
    Float32,
    Float64,
};

/// Bytes of a number.
std::size_t width_of(ColumnType type);

/// An array of numbers, little-endian, one or three per particle.
struct Column
{
    std::string name;
    Field field = Field::Position;
    ColumnType type = ColumnType::Float64;
    int axis = -1; ///< of a vector: 0 to 2 is one component, -1 all three

    bool is_vector() const { return axis < 0 && field <= Field::Normal; }
    std::size_t bytes_per_particle() const { return (is_vector() ? 3 : 1) * width_of(type); }
};

/// A column and where in the file its first number stands.
struct PlacedColumn
{
    Column column;
    std::uint64_t at = 0;
};

/// Where the particles of every body go when each body has its own arrays: behind those of the
/// same body in earlier pieces.
struct BodyOrder
{
    struct Part
    {
        std::uint16_t body = 0;
        std::uint64_t first = 0; ///< among those of the body
        std::uint32_t count = 0;
    };
    std::vector<std::vector<Part>> pieces; ///< bodies of every piece, by index
    std::vector<std::uint64_t> counts;     ///< of every body
};

/// cost  one pass over the particles; memory grows with the pieces and the bodies in them
BodyOrder order_by_body(const ParticleFeed& feed, int threads);

/// The particles of one body of a piece, in their order.
void select_body(const ParticlePiece& piece, std::uint16_t body, ParticlePiece& out);

/// Pa, by the equation of state of DualSPHysics; 0 where the feed does not know it.
double pressure_of(const ParticleFeed& feed, float density);

/// Calls body(piece number, piece) for all pieces, spread over threads.
void for_each_piece(const ParticleFeed& feed, int threads,
                    const std::function<void(std::size_t, const ParticlePiece&)>& body,
                    PieceContent wanted = PieceContent::All);

/// Fills an array in memory with a column of all particles.
void fill_column(const ParticleFeed& feed, const Column& column, char* out, int threads);

/// Writes the columns of all particles at their places.
void write_columns(OutputFile& file, const ParticleFeed& feed,
                   const std::vector<PlacedColumn>& columns, int threads);

/// The columns of one body and the file that they are in.
struct BodyColumns
{
    OutputFile* file = nullptr;
    std::vector<PlacedColumn> columns;
};

/// The same with columns of its own for every body.
void write_columns_by_body(const ParticleFeed& feed, const BodyOrder& order,
                           const std::vector<BodyColumns>& bodies, int threads);

} // namespace fppg
