// Faces between cells, made from runs. A plane of faces across x lies between two slabs and is made
// from their columns alone. Planes across y and z reach over all slabs: every slab yields its
// strips of faces, and strips that repeat in the next slab grow into one rectangle.
//
// "Low" faces look towards smaller coordinates. The plane p of an axis lies half a cell below the
// nodes of index p.

#include "core/parallel.h"
#include "files/vtk.h"
#include "fppg/error.h"
#include "fppg/files.h"
#include "fppg/lattice.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <span>
#include <tuple>

namespace fppg
{

namespace
{

/// Faces of one plane in a row along the second direction, [low, high).
struct Strip
{
    std::uint32_t plane = 0;
    std::uint32_t low = 0;
    std::uint32_t high = 0;
    std::uint16_t mk = 0;
    bool is_low_face = false;

    auto key() const { return std::tie(plane, is_low_face, low, high, mk); }
    bool operator<(const Strip& other) const { return key() < other.key(); }
    bool operator==(const Strip& other) const { return key() == other.key(); }
};

/// A strip repeated over [begin, end) of the first direction.
struct Rectangle
{
    Strip strip;
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

/// Grows strips into rectangles. Rows come with rising numbers, their strips sorted.
class RectangleMerger
{
public:
    explicit RectangleMerger(std::vector<Rectangle>& done) : done_(&done) {}

    void add_row(std::uint32_t row, std::span<const Strip> strips)
    {
        if (row != next_row_) finish();
        next_row_ = row + 1;
        growing_.clear();
        auto old = active_.begin();
        for (const Strip& strip : strips)
        {
            while (old != active_.end() && old->strip < strip) done_->push_back(*old++);
            const bool goes_on = old != active_.end() && old->strip == strip;
            growing_.push_back({strip, goes_on ? (old++)->begin : row, row + 1});
        }
        done_->insert(done_->end(), old, active_.end());
        active_.swap(growing_);
    }
    void finish()
    {
        done_->insert(done_->end(), active_.begin(), active_.end());
        active_.clear();
    }

private:
    std::vector<Rectangle>* done_;
    std::vector<Rectangle> active_;
    std::vector<Rectangle> growing_;
    std::uint32_t next_row_ = 0;
};

using Column = std::span<const Run>;

/// The runs of the column that begins at `begin`.
Column column_at(const std::vector<Run>& slab, std::size_t begin)
{
    std::size_t end = begin;
    while (end < slab.size() && slab[end].y == slab[begin].y) ++end;
    return {slab.data() + begin, end - begin};
}

/// Appends the parts of `column` beside which `neighbour` does not carry the same mk.
void add_visible_parts(Column column, Column neighbour, std::uint32_t plane, bool is_low_face,
                       std::vector<Strip>& out)
{
    std::size_t n = 0;
    for (const Run& run : column)
    {
        std::uint32_t z = run.z_begin;
        while (n < neighbour.size() && neighbour[n].z_end <= run.z_begin) ++n;
        for (std::size_t i = n; i < neighbour.size() && neighbour[i].z_begin < run.z_end; ++i)
        {
            if (neighbour[i].mk != run.mk) continue;
            if (neighbour[i].z_begin > z)
                out.push_back({plane, z, neighbour[i].z_begin, run.mk, is_low_face});
            z = std::max(z, neighbour[i].z_end);
        }
        if (z < run.z_end) out.push_back({plane, z, run.z_end, run.mk, is_low_face});
    }
}

/// Faces across x between the slabs `plane` - 1 and `plane`: rows along y, strips along z.
std::vector<Rectangle> faces_across_x(const RunField& field, std::uint32_t plane)
{
    static const std::vector<Run> nothing;
    const std::vector<Run>& below = plane > 0 ? field.slabs[plane - 1] : nothing;
    const std::vector<Run>& above = plane < field.slabs.size() ? field.slabs[plane] : nothing;
    std::vector<Rectangle> rectangles;
    RectangleMerger merger(rectangles);
    std::vector<Strip> strips;
    std::size_t b = 0;
    std::size_t a = 0;
    while (b < below.size() || a < above.size())
    {
        const std::uint32_t y = std::min(b < below.size() ? below[b].y : UINT32_MAX,
                                         a < above.size() ? above[a].y : UINT32_MAX);
        const Column b_column =
            b < below.size() && below[b].y == y ? column_at(below, b) : Column{};
        const Column a_column =
            a < above.size() && above[a].y == y ? column_at(above, a) : Column{};
        strips.clear();
        add_visible_parts(b_column, a_column, plane, false, strips);
        add_visible_parts(a_column, b_column, plane, true, strips);
        merger.add_row(y, strips);
        b += b_column.size();
        a += a_column.size();
    }
    merger.finish();
    return rectangles;
}

/// Faces across y of one slab, strips along z.
std::vector<Strip> strips_across_y(const std::vector<Run>& slab)
{
    std::vector<Strip> strips;
    Column before;
    for (std::size_t i = 0; i < slab.size();)
    {
        const Column column = column_at(slab, i);
        const std::uint32_t y = column.front().y;
        if (!before.empty() && before.front().y + 1 != y)
        {
            add_visible_parts(before, {}, before.front().y + 1, false, strips);
            before = {};
        }
        add_visible_parts(before, column, y, false, strips);
        add_visible_parts(column, before, y, true, strips);
        before = column;
        i += column.size();
    }
    if (!before.empty()) add_visible_parts(before, {}, before.front().y + 1, false, strips);
    return strips;
}

/// Faces across z of one slab, strips along y. Runs that touch carry different mk, so each end of a
/// run is a face. The faces of a row come sorted by plane and side, one each, so strips grow from
/// row to row as rectangles do; there are far fewer of them to be sorted than faces.
std::vector<Strip> strips_across_z(const std::vector<Run>& slab)
{
    std::vector<Strip> strips;
    std::vector<Strip> active;
    std::vector<Strip> growing;
    const auto side = [](const Strip& s) { return std::tie(s.plane, s.is_low_face); };
    for (std::size_t i = 0; i < slab.size();)
    {
        const std::uint32_t y = slab[i].y;
        growing.clear();
        auto old = active.begin();
        const auto add = [&](std::uint32_t plane, bool is_low_face, std::uint16_t mk)
        {
            Strip face{plane, y, y + 1, mk, is_low_face};
            while (old != active.end() && side(*old) < side(face)) strips.push_back(*old++);
            if (old != active.end() && side(*old) == side(face))
            {
                if (old->mk == mk && old->high == y)
                    face.low = old->low;
                else
                    strips.push_back(*old);
                ++old;
            }
            growing.push_back(face);
        };
        for (; i < slab.size() && slab[i].y == y; ++i)
        {
            add(slab[i].z_begin, true, slab[i].mk);
            add(slab[i].z_end, false, slab[i].mk);
        }
        strips.insert(strips.end(), old, active.end());
        active.swap(growing);
    }
    strips.insert(strips.end(), active.begin(), active.end());
    return strips;
}

/// The cells of one slab of a 2-D field, strips along z.
std::vector<Strip> strips_of_cells(const std::vector<Run>& slab)
{
    std::vector<Strip> strips;
    for (const Run& run : slab) strips.push_back({0, run.z_begin, run.z_end, run.mk, true});
    return strips;
}

/// Makes the strips of all slabs, some slabs at a time on all threads, and grows them along x.
template <typename MakeStrips>
std::vector<Rectangle> merge_slabs(const RunField& field, int threads, const MakeStrips& make)
{
    constexpr std::size_t slabs_at_a_time = 256;
    std::vector<Rectangle> rectangles;
    RectangleMerger merger(rectangles);
    std::vector<std::vector<Strip>> strips(std::min(slabs_at_a_time, field.slabs.size()));
    for (std::size_t first = 0; first < field.slabs.size(); first += slabs_at_a_time)
    {
        const std::size_t count = std::min(slabs_at_a_time, field.slabs.size() - first);
        parallel_for(count, threads,
                     [&](std::size_t i)
                     {
                         strips[i] = make(field.slabs[first + i]);
                         // Those across y come sorted.
                         if (!std::is_sorted(strips[i].begin(), strips[i].end()))
                             std::sort(strips[i].begin(), strips[i].end());
                     });
        for (std::size_t i = 0; i < count; ++i)
            merger.add_row(static_cast<std::uint32_t>(first + i), strips[i]);
    }
    merger.finish();
    return rectangles;
}

/// Rectangles across one axis: `row_axis` is that of begin and end, `strip_axis` of low and high.
struct Faces
{
    int axis = 0;
    int row_axis = 0;
    int strip_axis = 0;
    std::vector<Rectangle> rectangles;
};

std::vector<Faces> all_faces(const RunField& field, int threads)
{
    if (field.grid.is_2d) return {{1, 0, 2, merge_slabs(field, threads, strips_of_cells)}};
    std::vector<std::vector<Rectangle>> planes(field.slabs.size() + 1);
    parallel_for(planes.size(), threads,
                 [&](std::size_t plane)
                 { planes[plane] = faces_across_x(field, static_cast<std::uint32_t>(plane)); });
    std::vector<Rectangle> across_x;
    for (std::vector<Rectangle>& plane : planes)
    {
        across_x.insert(across_x.end(), plane.begin(), plane.end());
        plane = {};
    }
    return {{0, 1, 2, std::move(across_x)},
            {1, 0, 2, merge_slabs(field, threads, strips_across_y)},
            {2, 0, 1, merge_slabs(field, threads, strips_across_z)}};
}

/// The corners, anticlockwise seen from outside.
std::array<Vec3, 4> corners(const LatticeGrid& grid, const Faces& faces, const Rectangle& r)
{
    const auto edge = [&](int axis, std::uint32_t index)
    { return grid.origin[axis] + (static_cast<double>(index) - 0.5) * grid.step(axis); };
    Vec3 corner;
    const double inwards = 0.001 * grid.dp;
    if (grid.is_2d)
        corner[faces.axis] = grid.origin[faces.axis] + inwards;
    else
        corner[faces.axis] =
            edge(faces.axis, r.strip.plane) + (r.strip.is_low_face ? inwards : -inwards);
    std::array<Vec3, 4> out{corner, corner, corner, corner};
    for (std::size_t i = 0; i < 4; ++i)
    {
        out[i][faces.row_axis] = edge(faces.row_axis, i == 1 || i == 2 ? r.end : r.begin);
        out[i][faces.strip_axis] = edge(faces.strip_axis, i >= 2 ? r.strip.high : r.strip.low);
    }
    // Row axis times strip axis gives the axis itself, or its opposite for y.
    const bool looks_up = faces.axis != 1;
    if (looks_up == r.strip.is_low_face) std::swap(out[1], out[3]);
    return out;
}

/// A face and its number among those of all mks.
struct NumberedFace
{
    const Faces* faces;
    const Rectangle* rectangle;
    std::uint64_t number;
};

/// Writes points and polygons of the faces that `is_shown` takes, then the values of cells that
/// `write_values` writes by the function it is given. Returns the number of faces.
template <typename IsShown, typename WriteValues>
std::uint64_t write_faces(OutputFile& file, const RunField& field, int threads, bool may_be_empty,
                          const IsShown& is_shown, const WriteValues& write_values)
{
    const std::vector<Faces> all = all_faces(field, threads);
    std::uint64_t n = 0;
    for (const Faces& faces : all)
        for (const Rectangle& r : faces.rectangles) n += is_shown(r) ? 1U : 0U;
    if (n == 0 && !may_be_empty) return 0;
    constexpr std::uint64_t max_rectangles = 536870911;
    if (n > max_rectangles)
        throw IoError(
            fmt::format("cannot write '{}': {} rectangles, but legacy VTK holds at most "
                        "{} (indices have 32 bits)",
                        file.path(), n, max_rectangles));

    // Calls body(faces, rectangle, bytes) for all rectangles and writes the bytes now and then.
    const auto write_for_each = [&](const auto& body)
    {
        constexpr std::size_t bytes_at_a_time = 1 << 20;
        std::string bytes;
        std::uint64_t number = 0;
        for (const Faces& faces : all)
            for (const Rectangle& r : faces.rectangles)
            {
                const NumberedFace face{&faces, &r, number++};
                if (!is_shown(r)) continue;
                body(face, bytes);
                if (bytes.size() < bytes_at_a_time) continue;
                file.append(bytes);
                bytes.clear();
            }
        file.append(bytes);
    };
    file.append(fmt::format("{}POINTS {} float\n", vtk_head, 4 * n));
    write_for_each(
        [&](const NumberedFace& face, std::string& bytes)
        {
            for (const Vec3& corner : corners(field.grid, *face.faces, *face.rectangle))
                for (int axis = 0; axis < 3; ++axis)
                    append_big_endian(bytes, static_cast<float>(corner[axis]));
        });
    file.append(fmt::format("\nPOLYGONS {} {}\n", n, 5 * n));
    std::uint32_t vertex = 0;
    write_for_each(
        [&](const NumberedFace&, std::string& bytes)
        {
            append_big_endian(bytes, std::uint32_t{4});
            for (int i = 0; i < 4; ++i) append_big_endian(bytes, vertex++);
        });
    write_values(n, write_for_each);
    file.append("\n");
    return n;
}

} // namespace

void write_cells_vtk(OutputFile& file, const RunField& field,
                     const std::vector<ParticleType>& type_of_mk, int threads)
{
    if (field.walls.has_zones())
    {
        write_cells_vtk(file, plain_nodes(field, threads), type_of_mk, threads);
        return;
    }
    write_faces(
        file, field, threads, true, [](const Rectangle&) { return true; },
        [&](std::uint64_t n, const auto& write_for_each)
        {
            file.append(fmt::format(
                "\nCELL_DATA {}\nSCALARS Mk unsigned_short\nLOOKUP_TABLE default\n", n));
            write_for_each([&](const NumberedFace& face, std::string& bytes)
                           { append_big_endian(bytes, face.rectangle->strip.mk); });
            file.append(fmt::format("\nFIELD FieldData 1\nType 1 {} unsigned_char\n", n));
            write_for_each([&](const NumberedFace& face, std::string& bytes)
                           { bytes += static_cast<char>(type_of_mk[face.rectangle->strip.mk]); });
        });
}

std::uint64_t write_shown_cells_vtk(OutputFile& file, const RunField& field,
                                    std::optional<std::uint16_t> mk, int threads)
{
    return write_faces(
        file, field, threads, false, [&](const Rectangle& r) { return !mk || r.strip.mk == *mk; },
        [&](std::uint64_t n, const auto& write_for_each)
        {
            file.append(fmt::format("\nCELL_DATA {}\nSCALARS Mk int\nLOOKUP_TABLE default\n", n));
            write_for_each(
                [&](const NumberedFace& face, std::string& bytes) {
                    append_big_endian(bytes, static_cast<std::uint32_t>(face.rectangle->strip.mk));
                });
            file.append(fmt::format("\nFIELD FieldData 1\nObjId 1 {} int\n", n));
            write_for_each([&](const NumberedFace& face, std::string& bytes)
                           { append_big_endian(bytes, static_cast<std::uint32_t>(face.number)); });
        });
}

} // namespace fppg
