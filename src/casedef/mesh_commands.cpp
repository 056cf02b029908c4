// Commands that draw files of meshes and heights.
#include "casedef/command_table.h"
#include "fppg/error.h"
#include "fppg/shapes.h"

#include "casedef/xml_document.h"
#include "core/text.h"
#include "core/transforms.h"
#include "meshes/mesh_formats.h"
#include "meshes/mesh_library.h"
#include "meshes/read_step.h"
#include "shapes/file_polygons.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <string_view>
#include <utility>
#include <variant>

namespace fppg::commands
{
namespace
{

constexpr std::string_view drawfile = "drawfile";

/// A file that a VTM file names.
struct VtmEntry
{
    int index = 0;
    std::string name;
    std::string file; ///< beside the VTM file, as GenCase takes it
};

std::vector<std::string> names_of(const std::string& list)
{
    std::vector<std::string> names;
    for (const std::string_view part : split(list, ',')) names.emplace_back(trimmed(part));
    return names;
}

std::vector<VtmEntry> read_vtm(const std::string& path, const std::string& name)
{
    const Element root = read_xml(path);
    if (root.name != "VTKFile")
        throw CaseError(path, root.line, "is no VTM file: its root is not <VTKFile>");
    const Element* blocks = root.find_child("vtkMultiBlockDataSet");
    const Element* block = blocks == nullptr ? nullptr : blocks->find_child("Block");
    if (block == nullptr)
        throw CaseError(path, root.line,
                        "has no <Block> in <vtkMultiBlockDataSet>, expected one with <DataSet>s");
    const std::filesystem::path folder = std::filesystem::path(name).parent_path();
    std::vector<VtmEntry> entries;
    for (const Element& e : block->children)
    {
        if (e.kind != Element::Kind::Tag || e.name != "DataSet") continue;
        const std::string* file = e.find_attribute("file");
        if (file == nullptr) continue; // an empty part of the block
        VtmEntry entry;
        const std::string* index = e.find_attribute("index");
        entry.index = static_cast<int>(entries.size());
        if (index != nullptr)
        {
            const bool is_count = !index->empty() && index->size() < 9 &&
                                  index->find_first_not_of("0123456789") == std::string::npos;
            if (!is_count)
                throw CaseError(path, e.line,
                                fmt::format("<DataSet>: index=\"{}\" is no whole number", *index));
            entry.index = std::stoi(*index);
        }
        if (const std::string* label = e.find_attribute("name")) entry.name = *label;
        entry.file = (folder / *file).string();
        entries.push_back(std::move(entry));
    }
    if (entries.empty())
        throw CaseError(path, block->line, "<Block>: has no <DataSet> with a file");
    return entries;
}

/// GenCase reads the first block only.
std::size_t data_sets_elsewhere(const Element& e, bool is_counted)
{
    std::size_t n = 0;
    bool is_first_block = e.name == "vtkMultiBlockDataSet";
    for (const Element& child : e.children)
    {
        if (child.kind != Element::Kind::Tag) continue;
        if (child.name == "DataSet" && is_counted) ++n;
        const bool is_read = child.name == "Block" && is_first_block;
        if (child.name == "Block") is_first_block = false;
        n += data_sets_elsewhere(child, !is_read && e.name != "VTKFile");
    }
    return n;
}

Transform file_transform(const Program& p, const Element& e)
{
    Vec3 center;
    Vec3 scale{1, 1, 1};
    Vec3 angles;
    Vec3 move;
    if (const Element* c = e.find_child("drawcenter")) center = p.read.vec3(*c);
    if (const Element* c = e.find_child("drawscale")) scale = p.read.vec3(*c);
    if (const Element* c = e.find_child("drawrotate"))
        angles = {p.read.number(*c, "angx"), p.read.number(*c, "angy"), p.read.number(*c, "angz")};
    if (const Element* c = e.find_child("drawmove")) move = p.read.vec3(*c);
    return p.matrix * placement(center, scale, angles, move);
}

void read_depth(const Program& p, const Element& e, MeshFileOp& op)
{
    op.depth_min = 0;
    op.depth_max = 2 * p.def.grid.dp;
    op.reverse = p.read.flag_or(e, "reverse", false);
    bool is_limited = false;
    if (const Element* depth = e.find_child("depth"))
    {
        // A limit of 0 is none, as with GenCase v5.4: 2 dp apply where both are 0 or missing. Nor
        // is a depthmax below 0; a depthmin below 0 lets all depths in (a cube and an L with 8
        // pairs of limits, with and without reverse).
        op.depth_min = p.read.number_or(*depth, "depthmin", 0);
        const double high = p.read.number_or(*depth, "depthmax", 0);
        is_limited = high != 0 || op.depth_min != 0;
        if (high > 0)
            op.depth_max = high;
        else if (is_limited)
            op.depth_max = std::numeric_limits<double>::infinity();
    }
    op.any_depth = op.autofill && !is_limited;
}

/// polyselec: the shapes of a VTK file that are drawn.
ShapeSelection selection_of(const Program& p, const Element& select)
{
    const unsigned bits = p.read.word_bits(select, select.text, "polyselec",
                                           {{"all", 31},
                                            {"points", 1},
                                            {"lines", 2},
                                            {"triangles", 4},
                                            {"quads", 8},
                                            {"otherpolys", 16},
                                            {"polygons", 4 | 8 | 16}});
    return {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0, (bits & 16) != 0};
}

/// What is filled of a file, and how.
void read_filling(const Program& p, const Element& e, MeshFileOp& op)
{
    op.autofill = p.read.flag_or(e, "autofill", false);
    op.advanced = p.read.flag_or(e, "advanced", false);
    const std::string* fill = e.find_attribute("fppg:fill");
    if (fill == nullptr) return;
    if (*fill != "inside")
        p.read.fail(e, fmt::format("fppg:fill=\"{}\" is invalid, expected inside", *fill));
    op.fill_inside = true;
}

/// Found by experiment with GenCase v5.4.354: only the first block of the file is read; indices are
/// those written in it; names are matched with their case; a data set may be selected once; with
/// mkbound or mkfluid there must be as many numbers as data sets, taken in the order of both lists;
/// without, and behind the command, the mk is that of before. With advanced all data sets of one mk
/// are one mesh, whichever onlysurfaces they come from: rows count from where they enter the first
/// to where they leave one (two and three balls and cubes, with and without reverse). Under
/// setmknextauto that mesh gets the mk behind those of all polygons of its data sets; data sets
/// with an mk of their own do not change the mk behind the command (7 selections of three cubes, in
/// wire mode too).
class VtmDraw
{
public:
    VtmDraw(Program& p, const Element& e, MeshFileOp op) : p_(p), e_(e), op_(std::move(op))
    {
        op_.container = op_.file;
        path_ = p.def.meshes->find({e.line, e.name}, op_.container);
        entries_ = read_vtm(path_, op_.container);
        if (const std::size_t n = data_sets_elsewhere(read_xml(path_), false); n > 0)
            p.def.warnings.push_back(fmt::format(
                "{}:{}: <{}>: {}: {} data sets outside its first block are not drawn, as in "
                "GenCase.",
                p.def.file, e.line, e.name, path_, n));
        is_selected_.assign(entries_.size(), 0);
        counts_at_end_ = op_.advanced && p.state.mk_next_auto;
    }

    void run()
    {
        bool has_selection = false;
        for (const Element& select : e_.children)
        {
            if (select.kind != Element::Kind::Tag || select.name != "onlysurfaces") continue;
            has_selection = true;
            draw_selection(select);
        }
        for (std::size_t i = 0; !has_selection && i < entries_.size(); ++i) draw_and_count(i);
        for (; count_ > 0; --count_) p_.take_next_mk(e_);
    }

private:
    void draw(std::size_t i)
    {
        op_.file = entries_[i].file;
        op_.is_drawn_before = false;
        if (op_.advanced)
        {
            const auto [first, is_new] = first_of_mk_.emplace(p_.state.mk.mk, p_.def.ops.size());
            op_.is_drawn_before = !is_new;
            if (!is_new)
                std::get<MeshFileOp>(std::get<Shape>(p_.def.ops[first->second].what))
                    .joined.push_back(op_.file);
        }
        if (counts_at_end_)
            p_.add_whole(e_, op_);
        else
            p_.add(e_, op_);
    }

    void draw_and_count(std::size_t i)
    {
        draw(i);
        if (!counts_at_end_) return;
        MeshFileOp one = op_;
        one.file = entries_[i].file;
        count_ += p_.count_file_parts(e_, one);
    }

    template <typename IsIt>
    std::size_t choose(const Element& select, const IsIt& is_it, const std::string& what)
    {
        const auto entry = std::find_if(entries_.begin(), entries_.end(), is_it);
        if (entry == entries_.end())
            p_.read.fail(select,
                         fmt::format("there is no data set with the {} in '{}'", what, path_));
        const auto i = static_cast<std::size_t>(entry - entries_.begin());
        if (is_selected_[i])
            p_.read.fail(select, fmt::format("the data set with the {} is selected twice", what));
        is_selected_[i] = 1;
        return i;
    }

    std::vector<std::size_t> chosen(const Element& select)
    {
        const bool by_index = select.find_attribute("index") != nullptr;
        if (by_index == (select.find_attribute("name") != nullptr))
            p_.read.fail(select, "needs one of the attributes index and name");
        std::vector<std::size_t> found;
        if (by_index)
            for (const std::uint16_t number : p_.read.number_list(select, "index"))
                found.push_back(choose(
                    select, [number](const VtmEntry& v) { return v.index == number; },
                    fmt::format("index {}", number)));
        else
            for (const std::string& name : names_of(p_.read.text(select, "name")))
                found.push_back(choose(
                    select, [&name](const VtmEntry& v) { return v.name == name; },
                    fmt::format("name '{}'", name)));
        return found;
    }

    void draw_selection(const Element& select)
    {
        const std::vector<std::size_t> found = chosen(select);
        const bool has_bound = select.find_attribute("mkbound") != nullptr;
        const bool has_fluid = select.find_attribute("mkfluid") != nullptr;
        if (has_bound && has_fluid)
            p_.read.fail(select, "has both mkbound and mkfluid, expected one of them");
        if (!has_bound && !has_fluid)
        {
            for (const std::size_t i : found) draw_and_count(i);
            return;
        }
        const std::vector<std::uint16_t> mks =
            p_.read.number_list(select, has_bound ? "mkbound" : "mkfluid");
        if (mks.size() != found.size())
            p_.read.fail(select, fmt::format("names {} mks for {} data sets, expected as many",
                                             mks.size(), found.size()));
        const MkValue before = p_.state.mk;
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            p_.set_mk(select, has_bound ? MkKind::Bound : MkKind::Fluid, mks[i]);
            draw(found[i]);
        }
        p_.state.mk = before;
    }

    Program& p_;
    const Element& e_;
    MeshFileOp op_;
    std::string path_;
    std::vector<VtmEntry> entries_;
    std::vector<char> is_selected_;
    std::map<std::uint16_t, std::size_t> first_of_mk_; ///< index of its first draw
    /// Under setmknextauto the polygons of all data sets of one mk count before their one mesh.
    bool counts_at_end_ = false;
    std::uint32_t count_ = 0;
};

GroundRectangle rectangle_of(const Program& p, const Element& r)
{
    const Element& point = p.read.child(r, "point");
    const Element& size = p.read.child(r, "size");
    const GroundRectangle out{p.read.number(point, "x"), p.read.number(point, "y"),
                              p.read.number(size, "x"), p.read.number(size, "y")};
    if (!(out.x_size >= 0 && out.y_size >= 0))
        p.read.fail(size, fmt::format("x={:g} y={:g} is invalid, expected 0 or more", out.x_size,
                                      out.y_size));
    return out;
}

/// The points from which a grid is made, and the grid.
void read_points(Program& p, const Element& e, const Element& grid, MeshFileOp& op,
                 BathymetryGrid& bathymetry)
{
    const Element& points = p.read.child(e, "zpoints");
    op.file = p.read.interpolated(e, p.read.text(points, "file"));
    Vec3 scale{1, 1, 1};
    Vec3 angles;
    Vec3 move;
    if (const Element* c = points.find_child("scale")) scale = p.read.vec3(*c);
    if (const Element* c = points.find_child("move")) move = p.read.vec3(*c);
    if (const Element* c = points.find_child("rotate"))
    {
        if (c->find_attribute("angx") == nullptr && c->find_attribute("angy") == nullptr &&
            c->find_attribute("angz") == nullptr)
            p.def.warnings.push_back(fmt::format(
                "{}:{}: <rotate> turns nothing, as in GenCase: it takes angx, angy and angz.",
                p.def.file, c->line));
        angles = {p.read.number_or(*c, "angx", 0), p.read.number_or(*c, "angy", 0),
                  p.read.number_or(*c, "angz", 0)};
    }
    bathymetry.transform = placement({}, scale, angles, move);
    if (const Element* c = points.find_child("selection"))
        bathymetry.selection = rectangle_of(p, *c);
    bathymetry.spacing = p.read.number(grid, "dp");
    if (!(bathymetry.spacing > 0))
        p.read.fail(grid, fmt::format("dp={:g} is invalid, expected a positive number",
                                      bathymetry.spacing));
    if (const Element* c = grid.find_child("initdomain")) bathymetry.domain = rectangle_of(p, *c);
}

/// How a grid goes on beyond its border.
void read_borders(const Program& p, const Element& grid, BathymetryGrid& bathymetry)
{
    if (const Element* expands = grid.find_child("expands"))
        for (std::size_t side = 0; side < 4; ++side)
        {
            static constexpr std::array<const char*, 4> sides{"xmin", "xmax", "ymin", "ymax"};
            const Element* c = expands->find_child(sides[side]);
            if (c == nullptr) continue;
            BathymetryRamp& ramp = bathymetry.expands[side];
            ramp.size = p.read.number(*c, "size");
            ramp.z = p.read.number_if(*c, "z");
            ramp.size2 = p.read.number_or(*c, "size2", 0);
            ramp.z2 = p.read.number_if(*c, "z2");
            if (ramp.size2 < 0)
                p.read.fail(*c,
                            fmt::format("size2={:g} is invalid, expected 0 or more", ramp.size2));
        }
    for (std::size_t axis = 0; axis < 2; ++axis)
        if (const Element* c = grid.find_child(axis == 0 ? "periodicx" : "periodicy"))
        {
            const BathymetryPeriod period{p.read.number(*c, "rampwidth"),
                                          p.read.number_or(*c, "flatwidth", 0)};
            if (!(period.ramp_width >= 0 && period.flat_width >= 0))
                p.read.fail(*c, "a width is negative, expected 0 or more");
            bathymetry.periods[axis] = period;
        }
}

double largest_scale(const Transform& t)
{
    double square = 0;
    for (int axis = 0; axis < 3; ++axis)
    {
        const Vec3 column{t.linear[0][axis], t.linear[1][axis], t.linear[2][axis]};
        square = std::max(square, dot(column, column));
    }
    return std::sqrt(square);
}

/// Draws a file as `op` says so far; its format is set.
void draw_file(Program& p, const Element& e, MeshFileOp op)
{
    // Without numbers it has no effect.
    if (const Element* layers = e.find_child("layers");
        layers != nullptr && !p.read.text_or(*layers, "vdp", "").empty())
        p.read.fail(*layers,
                    "layers of a mesh file are not supported (GenCase has them in 2D with "
                    "setfrdrawmode only)");
    if (const Element* clip = e.find_child("clipdomain"))
        op.clip_resize = p.read.number_or(*clip, "resize", 0);
    if (const Element* select = e.find_child("polyselec"))
    {
        if (op.reading.format != MeshFormat::Vtk)
            p.read.fail(*select, "is possible in <drawfilevtk> and <drawfilevtm> only");
        // With advanced all polygons of the file count, whichever are chosen: GenCase v5.4 draws a
        // cube of triangles, of quads and of both the same with each word.
        const ShapeSelection chosen = selection_of(p, *select);
        if (!op.advanced) op.reading.shapes = chosen;
    }
    op.transform = file_transform(p, e);
    if (op.reading.format == MeshFormat::Step)
        op.reading.deflection =
            cad_deflection_dp * p.def.grid.dp / std::max(largest_scale(op.transform), 1e-9);
    if (op.advanced) read_depth(p, e, op);
    // The file's own placement is a later transform: it takes the clips along for this draw (a ball
    // moved by drawmove behind a clipplane, a clipbox and a clipdomain, 9 cases; the template
    // ClipDomain), and behind it the clips stand where the matrix puts them, also those that came
    // after it and had not been moved before (one and two placed meshes under five matrices, a box
    // behind them, GenCase v5.4.354).
    const bool is_placed = std::any_of(
        e.children.begin(), e.children.end(),
        [](const Element& c)
        { return c.name == "drawscale" || c.name == "drawrotate" || c.name == "drawmove"; });
    const bool moves_clips = is_placed && !p.state.clips.empty();
    if (moves_clips) p.put_clips(op.transform);
    if (e.name == "drawfilevtm")
        VtmDraw(p, e, std::move(op)).run();
    else
        p.add(e, std::move(op));
    if (moves_clips) p.place_clips();
}

/// By the name of the command; of `drawfile` by the ending of the file.
MeshFormat format_of(const Program& p, const Element& e, const std::string& file)
{
    const std::string_view kind = std::string_view(e.name).substr(drawfile.size());
    if (kind == "vtm") return MeshFormat::Vtk;
    if (!kind.empty()) return *mesh_format_named(kind);
    const MeshFormat format = mesh_format_of(file);
    if (has_heights(format) || (format == MeshFormat::Stl && !lower_case(file).ends_with(".stl")))
        p.read.fail(e,
                    fmt::format("file=\"{}\": <drawfile> goes by the ending of the name, expected "
                                "one of a mesh or of STEP: {}",
                                file, mesh_format_list()));
    return format;
}

} // namespace

void draw_mesh_file(Program& p, const Element& e)
{
    MeshFileOp op;
    op.file = p.read.text(e, "file");
    op.reading.format = format_of(p, e, op.file);
    if (const std::string* parts = e.find_attribute("fppg:part"))
    {
        if (op.reading.format != MeshFormat::Step)
            p.read.fail(e, "fppg:part is possible for STEP files only, expected <drawfilestep>");
        if (trimmed(*parts).empty())
            p.read.fail(e, "fppg:part is empty, expected names of parts, separated by commas");
        op.reading.parts = p.read.text(e, "fppg:part");
    }
    // A table is a surface without an inside: GenCase does not heed the filling there.
    if (!has_heights(op.reading.format))
        read_filling(p, e, op);
    else if (const std::string& mode = p.read.text(e, "mode"); mode != "bathymetry")
        p.read.fail(e, fmt::format("mode=\"{}\" is invalid, expected bathymetry", mode));
    draw_file(p, e, std::move(op));
}

/// Found by experiment with GenCase v5.4.354, on the polygons that its shapeout writes: a grid that
/// a file gives needs no points; rotate takes angx, angy and angz and does not heed x, y, z; the
/// current matrix acts on the whole grid.
void draw_bathymetry(Program& p, const Element& e)
{
    MeshFileOp op;
    op.reading.format = MeshFormat::Bathymetry;
    BathymetryGrid bathymetry;
    const Element& grid = p.read.child(e, "grid");
    bathymetry.is_grid_file = grid.find_attribute("file") != nullptr;
    if (bathymetry.is_grid_file)
        op.file = p.read.interpolated(e, p.read.text(grid, "file"));
    else
        read_points(p, e, grid, op, bathymetry);
    read_borders(p, grid, bathymetry);
    if (const Element* c = grid.find_child("finalmove")) bathymetry.final_move = p.read.vec3(*c);
    op.reading.bathymetry = bathymetry;
    op.transform = p.matrix;
    // An attribute `file` in the place of `value` asks for nothing.
    if (const Element* c = e.find_child("savepoints"))
        op.saves_points = p.read.flag_or(*c, "value", false);
    if (const Element* c = e.find_child("savegrid"))
        op.saves_grid = p.read.flag_or(*c, "value", false);
    p.add(e, std::move(op));
}

} // namespace fppg::commands
