#include "casedef/program.h"

#include "casedef/command_table.h"
#include "core/nearest_word.h"
#include "core/text.h"
#include "meshes/mesh_library.h"
#include "shapes/file_polygons.h"
#include "shapes/off_lattice_parts.h"
#include "shapes/polyhedra.h"

#include <fmt/format.h>

#include <charconv>
#include <utility>

namespace fppg
{
namespace
{

constexpr int max_list_depth = 100;
constexpr std::size_t max_commands = 10'000'000;

std::vector<std::string_view> children_of(const CommandRow& row)
{
    if (row.children.empty()) return {};
    std::vector<std::string_view> names = split(row.children, ' ');
    for (std::string_view& name : names)
        if (name.ends_with('+')) name.remove_suffix(1);
    return names;
}

/// throws CaseError for an element that the command does not have, or has once only
void check_children(const CommandRow& row, const Element& e, const AttributeReader& read)
{
    std::map<std::string_view, std::size_t> found;
    for (const Element& child : e.children)
    {
        if (child.kind != Element::Kind::Tag || child.name.starts_with('_') ||
            child.name.starts_with("fppg:"))
            continue;
        const std::size_t allowed = allowed_children(row, child.name);
        if (allowed == 0)
            read.fail(child,
                      fmt::format("<{}> has no such element{}, expected {}", e.name,
                                  did_you_mean(child.name, children_of(row)),
                                  row.children.empty()
                                      ? "none"
                                      : fmt::format("{}", fmt::join(children_of(row), ", "))));
        if (++found[child.name] > allowed)
            read.fail(child, fmt::format("<{}> has it already, expected one", e.name));
    }
}

} // namespace

Program::Program(CaseDef& case_def, VariableCommands& variable_commands,
                 const AttributeReader& reader, PatternTable named_patterns)
    : def(case_def),
      variables(variable_commands),
      read(reader),
      patterns(std::move(named_patterns)),
      line_begin(case_def.case_pos_min)
{
}

void Program::run(const Element& commands)
{
    const Element* main = nullptr;
    for (const Element& e : commands.children)
    {
        if (e.kind != Element::Kind::Tag || e.name.starts_with('_')) continue;
        if (e.name == "list")
        {
            const std::string name = read.text(e, "name");
            if (!lists.emplace(name, &e).second)
                read.fail(e, fmt::format("there is a list named '{}' already", name));
        }
        else if (e.name != "mainlist")
            def.warnings.push_back(
                fmt::format("{}:{}: <{}>: is not known in <commands> and has no effect{}, as with "
                            "GenCase; expected list or mainlist.",
                            def.file, e.line, e.name, did_you_mean(e.name, {"list", "mainlist"})));
        else if (main == nullptr)
            main = &e;
        else
            def.warnings.push_back(
                fmt::format("{}:{}: <mainlist>: is there twice, the second one is not run, as "
                            "with GenCase.",
                            def.file, e.line));
    }
    if (main == nullptr) read.fail(commands, "the element <mainlist> is missing in it");
    def.list_log.push_back("> MAIN");
    run_list(*main, "MAIN");
    def.list_log.push_back("<MAIN");
}

void Program::run_list(const Element& list, const std::string& name)
{
    if (++list_depth > max_list_depth)
        read.fail(list, fmt::format("lists call one another more than {} deep (list '{}')",
                                    max_list_depth, name));
    for (const Element& e : list.children)
        if (e.kind == Element::Kind::Tag && !e.name.starts_with('_')) run_command(e);
    --list_depth;
}

void Program::count_command(const Element& e)
{
    if (++commands_run > max_commands)
        read.fail(e, fmt::format("more than {} commands were run, the lists seem to be endless",
                                 max_commands));
}

/// So many commands a list runs for sure: calls under a condition, and calls that a variable
/// repeats, may be none; of lists that call themselves the depth is limited.
double Program::least_commands_in(const Element& list)
{
    const auto [known, is_new] = commands_in_lists_.emplace(&list, 0);
    if (!is_new) return known->second;
    double all = 0;
    for (const Element& e : list.children)
    {
        if (e.kind != Element::Kind::Tag || e.name.starts_with('_')) continue;
        if (e.find_attribute("if") != nullptr) continue;
        const std::string* name = e.name == "runlist" ? e.find_attribute("name") : nullptr;
        const auto called = name != nullptr ? lists.find(*name) : lists.end();
        ++all;
        if (called == lists.end()) continue;
        double times = 1;
        const std::string* text = e.find_attribute("times");
        if (text != nullptr && !text->empty())
        {
            const char* end = text->data() + text->size();
            const auto read_times = std::from_chars(text->data(), end, times);
            if (read_times.ec != std::errc() || read_times.ptr != end || !(times > 0)) times = 0;
        }
        all += times * (1 + least_commands_in(*called->second));
    }
    commands_in_lists_[&list] = all;
    return all;
}

void Program::expect_few_commands(const Element& e, const Element& list, int times)
{
    const double all = static_cast<double>(commands_run) + times * (1 + least_commands_in(list));
    if (all > static_cast<double>(max_commands))
        read.fail(e, fmt::format("{:.4g} commands or more would be run, expected at most {}: the "
                                 "lists call one another too often",
                                 all, max_commands));
}

void Program::run_command(const Element& e)
{
    const CommandRow* row = find_command(e.name);
    if (row == nullptr)
        read.fail(e, fmt::format("is not a command{}, see the templates for the commands of a list",
                                 did_you_mean(e.name, command_names())));
    if (!read.is_active(e)) return;
    count_command(e);
    check_children(*row, e, read);
    if (row->is_own) own_commands.emplace(e.name, e.line);
    row->run(*this, e);
}

void Program::add(const Element& e, Command what)
{
    auto* shape = std::get_if<Shape>(&what);
    auto* polyhedron = shape != nullptr ? std::get_if<PolyhedronOp>(shape) : nullptr;
    if (shape != nullptr && state.mk_next_auto)
        add_in_parts(e, std::move(*shape));
    else if (polyhedron != nullptr && has_quads_move_clips(*polyhedron))
        add_between_clips(e, std::move(*polyhedron));
    else
        add_whole(e, std::move(what));
}

void Program::add_whole(const Element& e, Command what)
{
    state.matrix = state.off_lattice ? matrix : Transform{};
    if (!shared_state || !(*shared_state == state))
        shared_state = std::make_shared<const DrawState>(state);
    const std::string* name = e.find_attribute("fppg:name");
    def.ops.push_back({{e.line, e.name, name != nullptr ? read.interpolated(e, *name) : ""},
                       shared_state,
                       std::move(what),
                       commands_run,
                       state.mk_next_auto ? nullptr : surface,
                       state.mk_next_auto ? nullptr : inner_surface});
}

std::uint32_t Program::count_file_parts(const Element& e, const MeshFileOp& op) const
{
    if (op.fill_inside) read.fail_unsupported(e, "setmknextauto together with fppg:fill");
    MeshFile cut;
    const MeshFile& file =
        def.meshes->read_drawn({e.line, e.name}, op, {def.case_pos_min, def.case_pos_max}, cut);
    const bool is_wire = state.mode == DrawMode::Wire;
    if (has_heights(op.reading.format))
    {
        // Cells that are bent do not count.
        std::uint32_t cells = 0;
        for_each_polygon(file, op, def.grid.dp,
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

void Program::take_next_mk(const Element& e)
{
    if (state.mk.kind == MkKind::Void) return;
    ++state.mk.mk;
    ++state.mk.mk_type;
    const int count = state.mk.kind == MkKind::Bound ? def.mkbound_count : def.mkfluid_count;
    if (state.mk.mk_type >= count)
        read.fail(e, fmt::format("setmknextauto goes on to mk {}, <mkconfig> leaves 0 to {}",
                                 state.mk.mk_type, count - 1));
}

bool Program::has_quads_move_clips(const PolyhedronOp& polyhedron) const
{
    return state.off_lattice && def.grid.is_2d && !defined_clips.empty() &&
           (state.mode != DrawMode::Wire || polyhedron.solid == SolidKind::Box);
}

void Program::add_between_clips(const Element& e, PolyhedronOp polyhedron)
{
    const std::vector<OffLatticePart> parts =
        off_lattice_parts(polyhedron, state.mode, matrix, def.grid);
    polyhedron.part_count = static_cast<std::uint32_t>(parts.size());
    for (polyhedron.part = 0; polyhedron.part < polyhedron.part_count; ++polyhedron.part)
    {
        const OffLatticePart& part = parts[polyhedron.part];
        if (part.is_section)
            put_clips({});
        else if (part.ends_quad)
            place_clips();
        add_whole(e, polyhedron);
        if (part.ends_quad) place_clips();
        if (state.mk_next_auto) take_next_mk(e);
    }
}

void Program::add_polyhedron_in_parts(const Element& e, PolyhedronOp polyhedron)
{
    if (has_quads_move_clips(polyhedron))
    {
        add_between_clips(e, std::move(polyhedron));
        return;
    }
    polyhedron.part_count = state.off_lattice
                                ? count_off_lattice_parts(polyhedron, state.mode, def.grid)
                                : count_parts(polyhedron, state.mode);
    const std::optional<std::uint32_t> between = part_between(polyhedron, state.mode);
    for (polyhedron.part = 0; polyhedron.part < polyhedron.part_count; ++polyhedron.part)
    {
        add_whole(e, polyhedron);
        if (polyhedron.part != between) take_next_mk(e);
    }
}

void Program::add_in_parts(const Element& e, Shape shape)
{
    if (auto* polyhedron = std::get_if<PolyhedronOp>(&shape))
    {
        add_polyhedron_in_parts(e, std::move(*polyhedron));
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

MkValue Program::mk_value(const Element& e, MkKind kind, int mk_type) const
{
    const int count = kind == MkKind::Bound ? def.mkbound_count : def.mkfluid_count;
    if (kind != MkKind::Void && (mk_type < 0 || mk_type >= count))
        read.fail(e,
                  fmt::format("mk {} is invalid, <mkconfig> leaves 0 to {} for {} (raise {} there)",
                              mk_type, count - 1, kind == MkKind::Bound ? "boundary" : "fluid",
                              kind == MkKind::Bound ? "boundcount" : "fluidcount"));
    MkValue value;
    value.kind = kind;
    value.mk_type = static_cast<std::uint16_t>(mk_type);
    if (kind == MkKind::Bound) value.mk = static_cast<std::uint16_t>(mk_type + def.mk_bound_first);
    if (kind == MkKind::Fluid) value.mk = static_cast<std::uint16_t>(mk_type + def.mk_fluid_first);
    return value;
}

void Program::set_mk(const Element& e, MkKind kind, int mk_type)
{
    state.mk = mk_value(e, kind, mk_type);
    const int count = kind == MkKind::Bound ? def.mkbound_count : def.mkfluid_count;
    if (kind == MkKind::Void || mk_type < count % 256 || count < 256 || is_large_mk_known) return;
    is_large_mk_known = true;
    def.warnings.push_back(
        fmt::format("{}:{}: <{}>: GenCase v5.4 refuses mk {}, as its mks have 8 bits and {}={} "
                    "leaves {} of them there; the solver takes mks up to 2047",
                    def.file, e.line, e.name, mk_type,
                    kind == MkKind::Bound ? "boundcount" : "fluidcount", count, count % 256));
}

void Program::add_clip(const ClipPlane& plane)
{
    defined_clips.push_back({plane.point, plane.normal / norm(plane.normal)});
    state.clips.push_back(placed_clip(defined_clips.back(), clip_matrix));
}

void Program::place_clips()
{
    if (defined_clips.empty()) return;
    clip_matrix = matrix;
    put_clips(matrix);
}

void Program::put_clips(const Transform& map)
{
    for (std::size_t i = 0; i < defined_clips.size(); ++i)
        state.clips[i] = placed_clip(defined_clips[i], map);
}

/// Only the turning part of the map meets the normal, as in GenCase v5.0 (8164 of 8168 nodes on
/// 200 moved, scaled and turned planes).
ClipPlane placed_clip(const ClipPlane& plane, const Transform& map)
{
    const Vec3& n = plane.normal;
    return {map(plane.point),
            {dot(map.linear[0], n), dot(map.linear[1], n), dot(map.linear[2], n)}};
}

} // namespace fppg
