// Commands that draw files of meshes and heights.
#include "fppg/error.h"

#include "casedef/program.h"
#include "casedef/transforms.h"
#include "casedef/xml_document.h"
#include "meshes/mesh_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>

namespace fppg
{
namespace
{

/// A file that a VTM file names.
struct VtmEntry
{
    int index = 0;
    std::string name;
    std::string file; ///< beside the VTM file, as GenCase takes it
};

std::string trimmed(const std::string& text)
{
    const std::size_t first = text.find_first_not_of(" \t");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t") - first + 1);
}

std::vector<std::string> names_of(const std::string& list)
{
    std::vector<std::string> names;
    std::size_t begin = 0;
    while (begin <= list.size())
    {
        const std::size_t end = std::min(list.find(',', begin), list.size());
        names.push_back(trimmed(list.substr(begin, end - begin)));
        begin = end + 1;
    }
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

} // namespace

Transform ProgramRunner::file_transform(const Element& e) const
{
    Vec3 center;
    Vec3 scale{1, 1, 1};
    Vec3 angles;
    Vec3 move;
    if (const Element* c = e.find_child("drawcenter")) center = read_.vec3(*c);
    if (const Element* c = e.find_child("drawscale")) scale = read_.vec3(*c);
    if (const Element* c = e.find_child("drawrotate"))
        angles = {read_.number(*c, "angx"), read_.number(*c, "angy"), read_.number(*c, "angz")};
    if (const Element* c = e.find_child("drawmove")) move = read_.vec3(*c);
    return matrix_ * placement(center, scale, angles, move);
}

void ProgramRunner::read_depth(const Element& e, MeshFileOp& op) const
{
    op.depth_min = 0;
    op.depth_max = 2 * def_.grid.dp;
    op.reverse = read_.flag_or(e, "reverse", false);
    bool is_limited = false;
    if (const Element* depth = e.find_child("depth"))
    {
        // A limit of 0 is none, as with GenCase v5.4: 2 dp apply where both are 0 or missing. Nor
        // is a depthmax below 0; a depthmin below 0 lets all depths in (a cube and an L with 8
        // pairs of limits, with and without reverse).
        op.depth_min = read_.number_or(*depth, "depthmin", 0);
        const double high = read_.number_or(*depth, "depthmax", 0);
        is_limited = high != 0 || op.depth_min != 0;
        if (high > 0)
            op.depth_max = high;
        else if (is_limited)
            op.depth_max = std::numeric_limits<double>::infinity();
    }
    op.any_depth = op.autofill && !is_limited;
}

void ProgramRunner::draw_mesh_file(const Element& e)
{
    MeshFileOp op;
    op.file = read_.text(e, "file");
    const bool is_table = e.name == "drawfilecsv";
    if (e.name == "drawfileply") op.reading.format = MeshFormat::Ply;
    if (e.name == "drawfilevtk" || e.name == "drawfilevtm") op.reading.format = MeshFormat::Vtk;
    if (is_table)
    {
        op.reading.format = MeshFormat::CsvBathymetry;
        if (const std::string& mode = read_.text(e, "mode"); mode != "bathymetry")
            read_.fail(e, fmt::format("mode=\"{}\" is invalid, expected bathymetry", mode));
    }
    // A table is a surface without an inside: GenCase does not heed these there.
    if (!is_table)
    {
        op.autofill = read_.flag_or(e, "autofill", false);
        op.advanced = read_.flag_or(e, "advanced", false);
        if (const std::string* fill = e.find_attribute("fppg:fill"))
        {
            if (*fill != "inside")
                read_.fail(e, fmt::format("fppg:fill=\"{}\" is invalid, expected inside", *fill));
            op.fill_inside = true;
        }
    }
    // Without numbers it has no effect.
    if (const Element* layers = e.find_child("layers");
        layers != nullptr && !read_.text_or(*layers, "vdp", "").empty())
        read_.fail(*layers,
                   "layers of a mesh file are not supported (GenCase has them in 2D with "
                   "setfrdrawmode only)");
    if (const Element* clip = e.find_child("clipdomain"))
        op.clip_resize = read_.number_or(*clip, "resize", 0);
    if (const Element* select = e.find_child("polyselec"))
    {
        if (op.reading.format != MeshFormat::Vtk)
            read_.fail(*select, "is possible in <drawfilevtk> and <drawfilevtm> only");
        ShapeSelection& shapes = op.reading.shapes;
        const unsigned bits = read_.word_bits(*select, select->text, "polyselec",
                                              {{"all", 31},
                                               {"points", 1},
                                               {"lines", 2},
                                               {"triangles", 4},
                                               {"quads", 8},
                                               {"otherpolys", 16},
                                               {"polygons", 4 | 8 | 16}});
        shapes = {(bits & 1) != 0, (bits & 2) != 0, (bits & 4) != 0, (bits & 8) != 0,
                  (bits & 16) != 0};
        // With advanced all polygons of the file count, whichever are chosen: GenCase v5.4 draws a
        // cube of triangles, of quads and of both the same with each word.
        if (op.advanced) shapes = {};
    }
    op.transform = file_transform(e);
    if (op.advanced) read_depth(e, op);
    // The file's own placement is a later transform: it takes the clips along for this draw (a ball
    // moved by drawmove behind a clipplane, a clipbox and a clipdomain, 9 cases; the template
    // ClipDomain), and behind it the clips stand where the matrix puts them, also those that came
    // after it and had not been moved before (one and two placed meshes under five matrices, a box
    // behind them, GenCase v5.4.354).
    const bool is_placed = std::any_of(
        e.children.begin(), e.children.end(),
        [](const Element& c)
        { return c.name == "drawscale" || c.name == "drawrotate" || c.name == "drawmove"; });
    const bool moves_clips = is_placed && !state_.clips.empty();
    if (moves_clips) put_clips(op.transform);
    if (e.name == "drawfilevtm")
        draw_vtm_file(e, std::move(op));
    else
        add(e, std::move(op));
    if (moves_clips) place_clips();
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
void ProgramRunner::draw_vtm_file(const Element& e, MeshFileOp op)
{
    op.container = op.file;
    const std::string path = def_.meshes->find({e.line, e.name}, op.container);
    const std::vector<VtmEntry> entries = read_vtm(path, op.container);
    if (const std::size_t n = data_sets_elsewhere(read_xml(path), false); n > 0)
        def_.warnings.push_back(fmt::format(
            "{}:{}: <{}>: {}: {} data sets outside its first block are not drawn, as in GenCase.",
            def_.file, e.line, e.name, path, n));
    std::vector<char> is_selected(entries.size(), 0);
    std::map<std::uint16_t, std::size_t> first_of_mk;
    // Under setmknextauto the polygons of all data sets of one mk count before their one mesh.
    const bool counts_at_end = op.advanced && state_.mk_next_auto;
    std::uint32_t count = 0;
    const auto draw = [&](std::size_t i)
    {
        op.file = entries[i].file;
        op.is_drawn_before = false;
        if (op.advanced)
        {
            const auto [first, is_new] = first_of_mk.emplace(state_.mk.mk, def_.ops.size());
            op.is_drawn_before = !is_new;
            if (!is_new)
                std::get<MeshFileOp>(std::get<Shape>(def_.ops[first->second].what))
                    .joined.push_back(op.file);
        }
        if (counts_at_end)
            add_whole(e, op);
        else
            add(e, op);
    };
    const auto count_parts_of = [&](std::size_t i)
    {
        if (!counts_at_end) return;
        MeshFileOp one = op;
        one.file = entries[i].file;
        count += count_file_parts(e, one);
    };
    bool has_selection = false;
    for (const Element& select : e.children)
    {
        if (select.kind != Element::Kind::Tag || select.name != "onlysurfaces") continue;
        has_selection = true;
        const bool by_index = select.find_attribute("index") != nullptr;
        const bool by_name = select.find_attribute("name") != nullptr;
        if (by_index == by_name) read_.fail(select, "needs one of the attributes index and name");
        std::vector<std::size_t> found;
        const auto choose = [&](const auto& is_it, const std::string& what)
        {
            const auto entry = std::find_if(entries.begin(), entries.end(), is_it);
            if (entry == entries.end())
                read_.fail(select,
                           fmt::format("there is no data set with the {} in '{}'", what, path));
            const auto i = static_cast<std::size_t>(entry - entries.begin());
            if (is_selected[i])
                read_.fail(select, fmt::format("the data set with the {} is selected twice", what));
            is_selected[i] = 1;
            found.push_back(i);
        };
        if (by_index)
            for (const std::uint16_t number : read_.number_list(select, "index"))
                choose([number](const VtmEntry& v) { return v.index == number; },
                       fmt::format("index {}", number));
        else
            for (const std::string& name : names_of(read_.text(select, "name")))
                choose([&name](const VtmEntry& v) { return v.name == name; },
                       fmt::format("name '{}'", name));
        const bool has_bound = select.find_attribute("mkbound") != nullptr;
        const bool has_fluid = select.find_attribute("mkfluid") != nullptr;
        if (has_bound && has_fluid)
            read_.fail(select, "has both mkbound and mkfluid, expected one of them");
        if (!has_bound && !has_fluid)
        {
            for (const std::size_t i : found)
            {
                draw(i);
                count_parts_of(i);
            }
            continue;
        }
        const std::vector<std::uint16_t> mks =
            read_.number_list(select, has_bound ? "mkbound" : "mkfluid");
        if (mks.size() != found.size())
            read_.fail(select, fmt::format("names {} mks for {} data sets, expected as many",
                                           mks.size(), found.size()));
        const MkValue before = state_.mk;
        for (std::size_t i = 0; i < found.size(); ++i)
        {
            set_mk(select, has_bound ? MkKind::Bound : MkKind::Fluid, mks[i]);
            draw(found[i]);
        }
        state_.mk = before;
        shared_state_.reset();
    }
    if (!has_selection)
        for (std::size_t i = 0; i < entries.size(); ++i)
        {
            draw(i);
            count_parts_of(i);
        }
    for (; count > 0; --count) take_next_mk(e);
}

/// Found by experiment with GenCase v5.4.354, on the polygons that its shapeout writes: a grid that
/// a file gives needs no points; rotate takes angx, angy and angz and does not heed x, y, z; the
/// current matrix acts on the whole grid.
void ProgramRunner::draw_bathymetry(const Element& e)
{
    MeshFileOp op;
    op.reading.format = MeshFormat::Bathymetry;
    BathymetryGrid bathymetry;
    const Element& grid = read_.child(e, "grid");
    bathymetry.is_grid_file = grid.find_attribute("file") != nullptr;
    const auto rectangle = [&](const Element& r)
    {
        const Element& point = read_.child(r, "point");
        const Element& size = read_.child(r, "size");
        const GroundRectangle out{read_.number(point, "x"), read_.number(point, "y"),
                                  read_.number(size, "x"), read_.number(size, "y")};
        if (!(out.x_size >= 0 && out.y_size >= 0))
            read_.fail(size, fmt::format("x={:g} y={:g} is invalid, expected 0 or more", out.x_size,
                                         out.y_size));
        return out;
    };
    if (bathymetry.is_grid_file)
        op.file = read_.interpolated(e, read_.text(grid, "file"));
    else
    {
        const Element& points = read_.child(e, "zpoints");
        op.file = read_.interpolated(e, read_.text(points, "file"));
        Vec3 scale{1, 1, 1};
        Vec3 angles;
        Vec3 move;
        if (const Element* c = points.find_child("scale")) scale = read_.vec3(*c);
        if (const Element* c = points.find_child("move")) move = read_.vec3(*c);
        if (const Element* c = points.find_child("rotate"))
        {
            if (c->find_attribute("angx") == nullptr && c->find_attribute("angy") == nullptr &&
                c->find_attribute("angz") == nullptr)
                def_.warnings.push_back(fmt::format(
                    "{}:{}: <rotate> turns nothing, as in GenCase: it takes angx, angy and angz.",
                    def_.file, c->line));
            angles = {read_.number_or(*c, "angx", 0), read_.number_or(*c, "angy", 0),
                      read_.number_or(*c, "angz", 0)};
        }
        bathymetry.transform = placement({}, scale, angles, move);
        if (const Element* c = points.find_child("selection")) bathymetry.selection = rectangle(*c);
        bathymetry.spacing = read_.number(grid, "dp");
        if (!(bathymetry.spacing > 0))
            read_.fail(grid, fmt::format("dp={:g} is invalid, expected a positive number",
                                         bathymetry.spacing));
        if (const Element* c = grid.find_child("initdomain")) bathymetry.domain = rectangle(*c);
    }
    if (const Element* expands = grid.find_child("expands"))
        for (std::size_t side = 0; side < 4; ++side)
        {
            static constexpr std::array<const char*, 4> sides{"xmin", "xmax", "ymin", "ymax"};
            const Element* c = expands->find_child(sides[side]);
            if (c == nullptr) continue;
            BathymetryRamp& ramp = bathymetry.expands[side];
            ramp.size = read_.number(*c, "size");
            ramp.z = read_.number_if(*c, "z");
            ramp.size2 = read_.number_or(*c, "size2", 0);
            ramp.z2 = read_.number_if(*c, "z2");
            if (ramp.size2 < 0)
                read_.fail(*c,
                           fmt::format("size2={:g} is invalid, expected 0 or more", ramp.size2));
        }
    for (std::size_t axis = 0; axis < 2; ++axis)
        if (const Element* c = grid.find_child(axis == 0 ? "periodicx" : "periodicy"))
        {
            const BathymetryPeriod period{read_.number(*c, "rampwidth"),
                                          read_.number_or(*c, "flatwidth", 0)};
            if (!(period.ramp_width >= 0 && period.flat_width >= 0))
                read_.fail(*c, "a width is negative, expected 0 or more");
            bathymetry.periods[axis] = period;
        }
    if (const Element* c = grid.find_child("finalmove")) bathymetry.final_move = read_.vec3(*c);
    op.reading.bathymetry = bathymetry;
    op.transform = matrix_;
    // An attribute `file` in the place of `value` asks for nothing.
    if (const Element* c = e.find_child("savepoints"))
        op.saves_points = read_.flag_or(*c, "value", false);
    if (const Element* c = e.find_child("savegrid"))
        op.saves_grid = read_.flag_or(*c, "value", false);
    add(e, std::move(op));
}

} // namespace fppg
