// The container JBinaryData, as seen in files of GenCase v5.4.354 and confirmed by what readers
// accept:
//
//   file   := head item
//   head   := 58 characters "#FileJBD JPartDataBi4" and blanks, '\n', 0, byte order, si64, 0, 0
//   item   := u32 size of what follows up to the size of the values
//             text "\nITEM\n", text name, bool hide, bool hide values, text "%.7E", text "%.15E",
//             u32 arrays, u32 items, u32 size of the values
//             values, arrays, items
//   values := text "\nVALUES", u32 count, count * (text name, i32 type, value)
//   array  := u32 size of what follows up to the size of the data
//             text "\nARRAY", text name, bool hide, i32 type, count, size of the data, data
//   text   := u32 length, characters;  bool := i32
//
// Everything is little-endian. Count and size of an array are u32, or u64 when si64 is 1; the byte
// order is then 10 instead of 0, so that older readers refuse the file.
//
// Vel is zero but where `<initials>` sets it, and a reserved file reads as zeros: only pieces with
// such particles are written.

#include "core/most_particles.h"
#include "core/parallel.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "particles/initials.h"
#include "particles/particle_stream.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

namespace fppg
{

namespace
{

static_assert(std::endian::native == std::endian::little,
              "values are copied into the file as they lie in memory");

enum class Bi4Type : std::int32_t
{
    Text = 1,
    Bool = 2,
    Int = 7,
    Uint = 8,
    Ullong = 10,
    Float = 11,
    Double = 12,
    Float3 = 22,
    Double3 = 23,
};

class Bi4Bytes
{
public:
    template <typename T>
    void put(T value)
    {
        static_assert(std::is_arithmetic_v<T>);
        bytes_.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
    void put_text(std::string_view text)
    {
        put(static_cast<std::uint32_t>(text.size()));
        bytes_.append(text);
    }
    void put_bool(bool value) { put(static_cast<std::int32_t>(value)); }
    void put_bytes(const std::string& bytes) { bytes_ += bytes; }
    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

/// The values of an item; each add_ writes one.
class Bi4Values
{
public:
    void add_text(std::string_view name, std::string_view value)
    {
        start(name, Bi4Type::Text);
        content_.put_text(value);
    }
    void add_bool(std::string_view name, bool value)
    {
        start(name, Bi4Type::Bool);
        content_.put_bool(value);
    }
    void add_int(std::string_view name, std::int32_t value)
    {
        start(name, Bi4Type::Int);
        content_.put(value);
    }
    void add_uint(std::string_view name, std::uint32_t value)
    {
        start(name, Bi4Type::Uint);
        content_.put(value);
    }
    void add_ullong(std::string_view name, std::uint64_t value)
    {
        start(name, Bi4Type::Ullong);
        content_.put(value);
    }
    void add_double(std::string_view name, double value)
    {
        start(name, Bi4Type::Double);
        content_.put(value);
    }
    void add_double3(std::string_view name, const Vec3& value)
    {
        start(name, Bi4Type::Double3);
        for (int axis = 0; axis < 3; ++axis) content_.put(value[axis]);
    }

    std::string bytes() const
    {
        Bi4Bytes all;
        all.put_text("\nVALUES");
        all.put(count_);
        all.put_bytes(content_.bytes());
        return all.bytes();
    }

private:
    Bi4Bytes content_;
    std::uint32_t count_ = 0;

    void start(std::string_view name, Bi4Type type)
    {
        content_.put_text(name);
        content_.put(static_cast<std::int32_t>(type));
        ++count_;
    }
};

std::string with_size(const Bi4Bytes& definition)
{
    Bi4Bytes all;
    all.put(static_cast<std::uint32_t>(definition.bytes().size()));
    all.put_bytes(definition.bytes());
    return all.bytes();
}

std::string bi4_head(bool has_64_bit_sizes)
{
    std::string head = "#FileJBD JPartDataBi4";
    head.resize(58, ' ');
    head += '\n';
    head += '\0';
    head += static_cast<char>(has_64_bit_sizes ? 10 : 0);
    head += static_cast<char>(has_64_bit_sizes ? 1 : 0);
    head.append(2, '\0');
    return head;
}

std::string bi4_item(std::string_view name, std::uint32_t arrays, std::uint32_t items,
                     const Bi4Values& values)
{
    const std::string value_bytes = values.bytes();
    Bi4Bytes definition;
    definition.put_text("\nITEM\n");
    definition.put_text(name);
    definition.put_bool(false);
    definition.put_bool(false);
    definition.put_text("%.7E");
    definition.put_text("%.15E");
    definition.put(arrays);
    definition.put(items);
    definition.put(static_cast<std::uint32_t>(value_bytes.size()));
    return with_size(definition) + value_bytes;
}

std::string bi4_array(std::string_view name, Bi4Type type, std::uint64_t count,
                      std::uint64_t element_size, bool has_64_bit_sizes)
{
    Bi4Bytes definition;
    definition.put_text("\nARRAY");
    definition.put_text(name);
    definition.put_bool(false);
    definition.put(static_cast<std::int32_t>(type));
    for (const std::uint64_t size : {count, count * element_size})
    {
        if (has_64_bit_sizes)
            definition.put(size);
        else
            definition.put(static_cast<std::uint32_t>(size));
    }
    return with_size(definition);
}

Bi4Values case_values(const CaseParticles& particles, const CaseConstants& constants,
                      const FileOrigin& origin)
{
    constexpr int peri_mode_unknown = 96;
    constexpr int axis_unknown = 99;
    Bi4Values values;
    values.add_uint("Piece", 0);
    values.add_uint("Npiece", 1);
    values.add_text("RunCode", "00000000");
    values.add_text("Date", "???");
    values.add_text("AppName", origin.app_name);
    values.add_text("CaseName", origin.case_name);
    values.add_bool("Data2d", constants.is_2d);
    values.add_double("Data2dPosY", constants.is_2d ? constants.y_2d : 0.0);
    values.add_double3("MapPosMin", {});
    values.add_double3("MapPosMax", {});
    values.add_int("PeriMode", peri_mode_unknown);
    values.add_double3("PeriXinc", {});
    values.add_double3("PeriYinc", {});
    values.add_double3("PeriZinc", {});
    values.add_int("AxisDiv", axis_unknown);
    values.add_ullong("CaseNp", particles.np);
    values.add_ullong("CaseNfixed", particles.n_fixed);
    values.add_ullong("CaseNmoving", particles.n_moving);
    values.add_ullong("CaseNfloat", particles.n_floating);
    values.add_ullong("CaseNfluid", particles.n_fluid);
    values.add_double3("CasePosMin", particles.pos_min);
    values.add_double3("CasePosMax", particles.pos_max);
    values.add_bool("NpDynamic", false);
    values.add_bool("ReuseIds", false);
    values.add_double("Dp", constants.dp);
    values.add_double("H", constants.h);
    values.add_double("B", constants.b);
    values.add_double("Rhop0", constants.rhop0);
    values.add_double("Gamma", constants.gamma);
    values.add_double("MassBound", constants.mass_bound);
    values.add_double("MassFluid", constants.mass_fluid);
    return values;
}

Bi4Values part_values(const CaseParticles& particles)
{
    Bi4Values values;
    values.add_uint("Cpart", 0);
    values.add_double("TimeStep", 0);
    values.add_uint("Npok", static_cast<std::uint32_t>(particles.np));
    values.add_uint("Nout", 0);
    values.add_uint("Step", 0);
    values.add_double("RunTime", 0);
    values.add_double3("DomainMin", {});
    values.add_double3("DomainMax", {});
    return values;
}

/// What stands before the data of an array, and where its data begin.
struct ArrayPlace
{
    std::string definition;
    std::uint64_t data = 0;
    std::uint64_t element_size = 0;
};

struct Bi4Layout
{
    std::string start; ///< all before the first array
    ArrayPlace idp, posd, vel, rhop;
    ArrayPlace normals; ///< without a definition where there are none
    std::uint64_t size = 0;
};

Bi4Layout lay_out(const CaseParticles& particles, const CaseConstants& constants,
                  const FileOrigin& origin, bool has_64_bit_sizes)
{
    Bi4Layout layout;
    layout.start =
        bi4_head(has_64_bit_sizes) +
        bi4_item("JPartDataBi4", 0, 1, case_values(particles, constants, origin)) +
        bi4_item("PART_0000", particles.bound_normals.empty() ? 4 : 5, 0, part_values(particles));
    layout.size = layout.start.size();
    const auto place =
        [&](std::string_view name, Bi4Type type, std::uint64_t element_size, std::uint64_t count)
    {
        ArrayPlace array;
        array.definition = bi4_array(name, type, count, element_size, has_64_bit_sizes);
        array.data = layout.size + array.definition.size();
        array.element_size = element_size;
        layout.size = array.data + count * element_size;
        return array;
    };
    layout.idp = place("Idp", Bi4Type::Uint, 4, particles.np);
    layout.posd = place("Posd", Bi4Type::Double3, 24, particles.np);
    layout.vel = place("Vel", Bi4Type::Float3, 12, particles.np);
    layout.rhop = place("Rhop", Bi4Type::Float, 4, particles.np);
    if (!particles.bound_normals.empty())
        layout.normals = place("BoundNor", Bi4Type::Float3, 12, particles.bound_normals.size());
    return layout;
}

/// Runs `<initials>` on the particles of a segment, given three positions, three velocities and a
/// density each.
void start_segment(const ParticleSegment& segment, double* pos, float* vel, float* rhop)
{
    for (std::uint32_t k = 0; k < segment.count; ++k)
    {
        InitialState state{{pos[3 * k], pos[3 * k + 1], pos[3 * k + 2]},
                           {},
                           rhop[k],
                           segment.id + k - segment.block->begin};
        apply_initials(segment.block->initials, state);
        for (int axis = 0; axis < 3; ++axis)
        {
            pos[3 * k + static_cast<std::uint32_t>(axis)] = state.position[axis];
            vel[3 * k + static_cast<std::uint32_t>(axis)] =
                static_cast<float>(state.velocity[axis]);
        }
        rhop[k] = static_cast<float>(state.rhop);
    }
}

void write_piece(OutputFile& file, const Bi4Layout& layout, const ParticleStream& stream,
                 const CaseParticles& particles, float rhop0, std::size_t piece)
{
    const std::uint64_t begin = stream.begin(piece);
    const std::size_t count = stream.end(piece) - begin;
    char* const buffer = piece_buffer(count * (24 + 4 + 4 + 12));
    auto* const pos = reinterpret_cast<double*>(buffer);
    auto* const rhop = reinterpret_cast<float*>(buffer + count * 24);
    auto* const idp = reinterpret_cast<std::uint32_t*>(buffer + count * 28);
    auto* const vel = reinterpret_cast<float*>(buffer + count * 32);
    bool has_vel = false;
    for (std::size_t k = 0; k < count; ++k) idp[k] = static_cast<std::uint32_t>(begin + k);
    stream.for_each_segment(piece,
                            [&](const ParticleSegment& segment)
                            {
                                double* p = pos + 3 * (segment.id - begin);
                                for_each_position(particles, segment,
                                                  [&](std::int64_t k, double x, double y, double z)
                                                  {
                                                      p[3 * k] = x;
                                                      p[3 * k + 1] = y;
                                                      p[3 * k + 2] = z;
                                                  });
                                float* r = rhop + (segment.id - begin);
                                for_each_density(particles, rhop0, segment,
                                                 [&](std::uint32_t k, float v) { r[k] = v; });
                                if (segment.block->initials.empty()) return;
                                if (!has_vel) std::fill_n(vel, 3 * count, 0.0F);
                                has_vel = true;
                                start_segment(segment, p, vel + 3 * (segment.id - begin), r);
                            });
    file.write_at(layout.idp.data + begin * 4, idp, count * 4);
    file.write_at(layout.posd.data + begin * 24, pos, count * 24);
    file.write_at(layout.rhop.data + begin * 4, rhop, count * 4);
    if (has_vel) file.write_at(layout.vel.data + begin * 12, vel, count * 12);
}

} // namespace

void write_bi4(OutputFile& file, const CaseParticles& particles, const CaseConstants& constants,
               const FileOrigin& origin, int threads, std::uint64_t limit_of_32_bit_sizes)
{
    if (particles.np > most_particles)
        throw IoError(
            fmt::format("cannot write '{}': {} particles, but the format holds at most "
                        "{} (ids have 32 bits)",
                        file.path(), particles.np, most_particles));
    Bi4Layout layout = lay_out(particles, constants, origin, false);
    if (layout.size >= limit_of_32_bit_sizes) layout = lay_out(particles, constants, origin, true);

    file.reserve(layout.size);
    file.write_at(0, layout.start.data(), layout.start.size());
    for (const ArrayPlace* array :
         {&layout.idp, &layout.posd, &layout.vel, &layout.rhop, &layout.normals})
        file.write_at(array->data - array->definition.size(), array->definition.data(),
                      array->definition.size());

    if (!particles.bound_normals.empty())
        file.write_at(layout.normals.data, particles.bound_normals.data(),
                      particles.bound_normals.size() * 12);

    const ParticleStream stream(particles, 0, particles.np, particles_per_piece);
    const auto rhop0 = static_cast<float>(constants.rhop0);
    parallel_for(stream.pieces(), threads,
                 [&](std::size_t piece)
                 { write_piece(file, layout, stream, particles, rhop0, piece); });
}

} // namespace fppg
