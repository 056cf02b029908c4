#include "casedef/program.h"

#include "fppg/error.h"

#include "casedef/known_commands.h"
#include "meshes/mesh_library.h"
#include "shapes/figures.h"
#include "shapes/file_polygons.h"
#include "shapes/free_parts.h"

#include <fmt/format.h>

namespace fppg
{
namespace
{

constexpr int max_list_depth = 100;
constexpr std::size_t max_commands = 10'000'000;

} // namespace

ProgramRunner::ProgramRunner(CaseDef& def, VariableCommands& variables, const AttributeReader& read,
                             PatternTable patterns)
    : def_(def),
      variables_(variables),
      read_(read),
      patterns_(std::move(patterns)),
      line_begin_(def.case_pos_min)
{
}

void ProgramRunner::run(const Element& commands)
{
    const Element* main = nullptr;
    for (const Element& e : commands.children)
    {
        if (e.kind != Element::Kind::Tag || e.name.starts_with('_')) continue;
        if (e.name == "list")
        {
            const std::string name = read_.text(e, "name");
            if (!lists_.emplace(name, &e).second)
                read_.fail(e, fmt::format("there is a list named '{}' already", name));
        }
        else if (e.name == "mainlist")
        {
            if (main == nullptr)
                main = &e;
            else
                def_.warnings.push_back(
                    fmt::format("{}:{}: <mainlist>: is there twice, the second one is not run, as "
                                "with GenCase.",
                                def_.file, e.line));
        }
        else
            def_.warnings.push_back(
                fmt::format("{}:{}: <{}>: is not known in <commands> and has no effect, as with "
                            "GenCase; expected list or mainlist.",
                            def_.file, e.line, e.name));
    }
    if (main == nullptr) read_.fail(commands, "the element <mainlist> is missing in it");
    def_.list_log.push_back("> MAIN");
    run_list(*main, "MAIN");
    def_.list_log.push_back("<MAIN");
}

void ProgramRunner::run_list(const Element& list, const std::string& name)
{
    if (++depth_ > max_list_depth)
        read_.fail(list, fmt::format("lists call one another more than {} deep (list '{}')",
                                     max_list_depth, name));
    for (const Element& e : list.children)
        if (e.kind == Element::Kind::Tag && !e.name.starts_with('_')) run_command(e);
    --depth_;
}

void ProgramRunner::count_command(const Element& e)
{
    if (++commands_run_ > max_commands)
        read_.fail(e, fmt::format("more than {} commands were run, the lists seem to be endless",
                                  max_commands));
}

void ProgramRunner::run_command(const Element& e)
{
    if (!is_known_command(e.name))
        read_.fail(e, "is not a command, see the templates for what can stand in a list");
    if (!read_.is_active(e)) return;
    count_command(e);
    check_children(e);
    if (!run_state_command(e) && !run_transform(e) && !run_clip(e) &&
        !variables_.run(e, def_.list_log) && !run_flow_command(e) && !run_draw(e) &&
        !run_fill_or_redraw(e))
        read_.fail_unsupported(e);
}

void ProgramRunner::check_children(const Element& e) const
{
    std::map<std::string_view, std::size_t> found;
    for (const Element& child : e.children)
    {
        if (child.kind != Element::Kind::Tag || child.name.starts_with('_') ||
            child.name.starts_with("fppg:"))
            continue;
        const std::size_t allowed = allowed_children(e.name, child.name);
        if (allowed == 0) read_.fail(child, fmt::format("<{}> has no such element", e.name));
        if (++found[child.name] > allowed)
            read_.fail(child, fmt::format("<{}> has it already, expected one", e.name));
    }
}

bool ProgramRunner::run_flow_command(const Element& e)
{
    const std::string& name = e.name;
    if (name == "runlist")
    {
        const std::string& list = read_.text(e, "name");
        const auto found = lists_.find(list);
        if (found == lists_.end()) read_.fail(e, fmt::format("there is no list named '{}'", list));
        const int times = !read_.text_or(e, "times", "").empty()
                              ? read_.integer(e, "times", 0, 1'000'000'000, true)
                              : 1;
        const bool is_printed = read_.plain_flag_or(*found->second, "printcall", true);
        for (int i = 0; i < times; ++i)
        {
            // An empty list counts too: each call leaves a line in the log.
            count_command(e);
            if (is_printed) def_.list_log.push_back("> " + list);
            run_list(*found->second, list);
        }
    }
    else if (name == "printf")
        def_.list_log.push_back(read_.interpolated(e, read_.text(e, "text")));
    else if (name == "abort")
        throw CaseError(def_.file, e.line,
                        fmt::format("<abort>: the case stops itself: {}",
                                    read_.interpolated(e, read_.text_or(e, "text", "(no text)"))));
    else if (name == "shapeout")
        shape_out(e);
    else if (name == "cellsout")
        cells_out(e);
    else if (name == "pointsmkout")
        add_whole(e, PointsMkOutOp{read_.text(e, "file")});
    else if (name == "debugout")
        return true; // a picture for GenCase's own debugging, written at a debug level only
    else
        return false;
    return true;
}

void ProgramRunner::add(const Element& e, Command what)
{
    auto* shape = std::get_if<Shape>(&what);
    auto* figure = shape != nullptr ? std::get_if<FigureOp>(shape) : nullptr;
    if (shape != nullptr && state_.mk_next_auto)
        add_in_parts(e, std::move(*shape));
    else if (figure != nullptr && has_quads_move_clips(*figure))
        add_between_clips(e, std::move(*figure));
    else
        add_whole(e, std::move(what));
}

void ProgramRunner::add_whole(const Element& e, Command what)
{
    state_.matrix = state_.off_lattice ? matrix_ : Transform{};
    if (!shared_state_ || !(shared_state_->matrix == state_.matrix))
        shared_state_ = std::make_shared<const DrawState>(state_);
    const std::string* name = e.find_attribute("fppg:name");
    def_.ops.push_back({{e.line, e.name, name != nullptr ? read_.interpolated(e, *name) : ""},
                        shared_state_,
                        std::move(what),
                        commands_run_});
}

std::uint32_t ProgramRunner::count_file_parts(const Element& e, const MeshFileOp& op) const
{
    if (op.fill_inside) read_.fail_unsupported(e, "setmknextauto together with fppg:fill");
    MeshFile cut;
    const MeshFile& file =
        def_.meshes->read_drawn({e.line, e.name}, op, {def_.case_pos_min, def_.case_pos_max}, cut);
    const bool is_wire = state_.mode == DrawMode::Wire;
    if (has_heights(op.reading.format))
    {
        // Cells that are bent do not count.
        std::uint32_t cells = 0;
        for_each_polygon(file, op, def_.grid.dp,
                         [&](const std::vector<std::uint32_t>& corners)
                         { cells += corners.size() == 4 ? 1 : 0; });
        return is_wire ? 4 * cells : cells;
    }
    const std::size_t quads = file.quads.size();
    std::size_t count =
        is_wire ? 3 * (file.soup.size() - 2 * quads) + 4 * quads : file.soup.size() - quads;
    if (!op.advanced)
        for (const std::vector<Vec3>& line : file.lines) count += line.size();
    return static_cast<std::uint32_t>(count);
}

void ProgramRunner::take_next_mk(const Element& e)
{
    if (state_.mk.kind == MkKind::Void) return;
    ++state_.mk.mk;
    ++state_.mk.mk_type;
    shared_state_.reset();
    const int count = state_.mk.kind == MkKind::Bound ? def_.mkbound_count : def_.mkfluid_count;
    if (state_.mk.mk_type >= count)
        read_.fail(e, fmt::format("setmknextauto goes on to mk {}, <mkconfig> leaves 0 to {}",
                                  state_.mk.mk_type, count - 1));
}

bool ProgramRunner::has_quads_move_clips(const FigureOp& figure) const
{
    return state_.off_lattice && def_.grid.is_2d && !defined_clips_.empty() &&
           (state_.mode != DrawMode::Wire || figure.solid == SolidKind::Box);
}

void ProgramRunner::add_between_clips(const Element& e, FigureOp figure)
{
    const std::vector<FreePart> parts = free_parts(figure, state_.mode, matrix_, def_.grid);
    figure.part_count = static_cast<std::uint32_t>(parts.size());
    for (figure.part = 0; figure.part < figure.part_count; ++figure.part)
    {
        const FreePart& part = parts[figure.part];
        if (part.is_section)
            put_clips({});
        else if (part.ends_quad)
            place_clips();
        add_whole(e, figure);
        if (part.ends_quad) place_clips();
        if (state_.mk_next_auto) take_next_mk(e);
    }
}

void ProgramRunner::add_figure_in_parts(const Element& e, FigureOp figure)
{
    if (has_quads_move_clips(figure))
    {
        add_between_clips(e, std::move(figure));
        return;
    }
    figure.part_count = state_.off_lattice ? count_free_parts(figure, state_.mode, def_.grid)
                                           : count_parts(figure, state_.mode);
    const std::optional<std::uint32_t> between = part_between(figure, state_.mode);
    for (figure.part = 0; figure.part < figure.part_count; ++figure.part)
    {
        add_whole(e, figure);
        if (figure.part != between) take_next_mk(e);
    }
}

void ProgramRunner::add_in_parts(const Element& e, Shape shape)
{
    if (auto* figure = std::get_if<FigureOp>(&shape))
    {
        add_figure_in_parts(e, std::move(*figure));
        return;
    }
    if (const auto* lines = std::get_if<LinesOp>(&shape))
    {
        for (const auto& segment : lines->segments)
        {
            add_whole(e, LinesOp{{segment}});
            take_next_mk(e);
        }
        return;
    }
    // Points and waves do not count; all layers of a round shape are one part.
    std::uint32_t count = 1;
    if (std::holds_alternative<PointsOp>(shape) || std::holds_alternative<WaveOp>(shape)) count = 0;
    if (const auto* file = std::get_if<MeshFileOp>(&shape)) count = count_file_parts(e, *file);
    add_whole(e, std::move(shape));
    for (std::uint32_t part = 0; part < count; ++part) take_next_mk(e);
}

void ProgramRunner::cells_out(const Element& e)
{
    CellsOutOp op;
    op.file = read_.text(e, "file");
    for (const char* name : {"mkbound", "mkfluid"})
    {
        if (e.find_attribute(name) == nullptr) continue;
        const int number = read_.integer(e, name, 0, 65000, false);
        const bool is_bound = name == std::string_view("mkbound");
        op.mk = static_cast<std::uint16_t>(number +
                                           (is_bound ? def_.mk_bound_first : def_.mk_fluid_first));
        op.suffix = fmt::format("_{}{}", name, number);
        break; // mkbound comes first, as with GenCase
    }
    add_whole(e, std::move(op));
}

void ProgramRunner::shape_out(const Element& e)
{
    std::string format = read_.text_or(e, "format", "vtk");
    for (char& c : format) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    ShapeOutOp op;
    op.file = read_.text(e, "file");
    if (format == "vtp")
        op.format = ShapeFormat::Vtp;
    else if (format == "vtu")
        op.format = ShapeFormat::Vtu;
    else if (format == "stl")
        op.format = ShapeFormat::Stl;
    else if (format != "vtk")
        read_.fail(e, fmt::format("format=\"{}\" is invalid, expected vtk, vtp, vtu or stl",
                                  read_.text(e, "format")));
    op.normal_dp = read_.number_or(e, "savenormal", 0);
    op.reset = read_.plain_flag_or(e, "reset", true);
    add(e, std::move(op));
}

} // namespace fppg
