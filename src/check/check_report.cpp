#include "check/judge_walls.h"
#include "core/json.h"
#include "core/text_table.h"
#include "fppg/check.h"
#include "report/html.h"

#include "files/vtk.h"

#include <fmt/format.h>

#include <bit>

namespace fppg
{

namespace
{

constexpr std::size_t examples_of_each = 10;

struct FaultWords
{
    const char* name;
    const char* column; ///< in tables; nullptr: not of walls
    const char* what;
    const char* advice;
};

constexpr FaultWords words[fault_count] = {
    {"no_normal", "no normal", "boundary particles within 2h of fluid have no normal",
     "The solver keeps them plain DBC, with SlipMode 2 and 3 at an undefined velocity: a run can "
     "lose fluid there, and two runs differ. Give <norgeometry> a surface that covers them, or a "
     "larger distanceh."},
    {"ghost_outside", "outside", "ghost nodes lie outside the domain",
     "Normals lead out of the case, to the dry side of a wall or the wrong one: give <norgeometry> "
     "the wet side only (setnormalinvert turns a surface round), or draw the wall thicker."},
    {"ghost_in_wall", "in wall", "ghost nodes lie in a wall",
     "Normals point into a wall, or the gap before the wall is narrower than its layers are deep: "
     "check the side of the surface, or take a smaller dp."},
    {"through_wall", "through", "normals pass through a wall",
     "They point to a surface behind another wall: give each wall its own surface, or a smaller "
     "distanceh."},
    {"looks_away", "away", "normals look away from the fluid",
     "The solver switches such a particle off: give <norgeometry> the wet side of the wall only, "
     "or "
     "draw the wall thicker."},
    {"weak_kernel", "sum < 0.1", "ghost nodes have a kernel sum below 0.1",
     "The solver takes rho0 or more there. Normals are longer than the gap, or end at a rim."},
    {"ill_conditioned", "cond. > 50", "ghost nodes are ill-conditioned",
     "The solver takes Shepard's sum there, without a gradient. Put the first layer half a dp "
     "behind the surface, so that its ghost nodes lie in the fluid."},
    {"wet_on_both_sides", "2 sides",
     "particles belong to walls that are wet on both sides and too thin",
     "One normal a particle cannot serve both sides: take a smaller dp, draw the wall thicker, or "
     "give each side a wall of its own."},
    {"in_buffer_zone", "buffer", "boundary particles in buffer zones of vres stop the solver",
     "It takes none there with DBC, and with mDBC none without a normal: move the zone, or give "
     "them normals and Boundary 2."},
    {"fluid_near_wall", nullptr, "fluid particles are nearer than 0.5 dp to a wall particle",
     "They fly off in the first steps: start the fluid farther from the wall."},
    {"close_pair", nullptr, "particles are nearer than 0.3 dp to another one",
     "They push each other off: look for parts that are drawn twice or overlap."},
    {"outside_domain", nullptr, "particles lie outside the domain",
     "The solver stops or takes them out: enlarge <simulationdomain>, or check <initials>."},
    {"near_inlet", nullptr, "wall particles are nearer than 0.7 dp to points of a zone of <inout>",
     "The solver stops there: its rows reach back from the zone, so put that farther from the wall "
     "behind it, or make it narrower."},
};

const FaultWords& words_of(Fault fault)
{
    return words[static_cast<std::size_t>(fault)];
}

const char* type_of_mk(const CheckedMk& mk)
{
    static constexpr const char* names[] = {"fixed", "moving", "floating", "fluid"};
    return names[static_cast<std::size_t>(mk.type)];
}

bool is_wall(const CheckedMk& mk)
{
    return mk.type != ParticleType::Fluid;
}

std::string dash_or(std::uint64_t count)
{
    return count == 0 ? "-" : std::to_string(count);
}

std::string share_of_no_penetration(const CheckedMk& mk)
{
    if (mk.front == 0) return "-";
    return fmt::format("{:.0f} %", 100.0 * static_cast<double>(mk.front_no_penetration) /
                                       static_cast<double>(mk.front));
}

/// The rows of the table of walls, its head first.
std::vector<std::vector<std::string>> wall_rows(const CheckReport& report)
{
    std::vector<std::vector<std::string>> rows{{"mk", "type", "particles", "near fluid"}};
    for (const FaultWords& of : words)
        if (of.column != nullptr) rows[0].push_back(of.column);
    rows[0].push_back("NoPen.");
    for (const CheckedMk& mk : report.mks)
    {
        if (!is_wall(mk)) continue;
        std::vector<std::string> row{std::to_string(mk.mk), type_of_mk(mk),
                                     std::to_string(mk.count), std::to_string(mk.near_fluid)};
        for (std::size_t f = 0; f < fault_count; ++f)
            if (words[f].column != nullptr) row.push_back(dash_or(mk.faults[f]));
        row.push_back(share_of_no_penetration(mk));
        rows.push_back(std::move(row));
    }
    return rows;
}

std::string first_example(const CheckReport& report, Fault fault, std::uint16_t mk)
{
    for (const FaultyParticle& p : report.faulty)
        if (p.mk == mk && (p.faults & bit_of(fault)) != 0)
            return fmt::format("the first is {} at ({:.6g}, {:.6g}, {:.6g})", p.id, p.position.x,
                               p.position.y, p.position.z);
    return "";
}

/// What was found, a line a mk and fault, and what to do.
std::vector<std::string> finding_lines(const CheckReport& report)
{
    std::vector<std::string> lines;
    for (std::size_t f = 0; f < fault_count; ++f)
    {
        const auto fault = static_cast<Fault>(f);
        bool is_found = false;
        for (const CheckedMk& mk : report.mks)
        {
            if (mk[fault] == 0) continue;
            std::string line =
                fmt::format("mk {}: {} {}; {}", mk.mk, mk[fault], words_of(fault).what,
                            first_example(report, fault, mk.mk));
            if (fault == Fault::BothSides)
                line += fmt::format("; thinnest {:.4g} m, median {:.4g} m, which needs dp {:.4g} m",
                                    mk.thinnest, mk.median_thickness, mk.dp_needed);
            if (!report.is_finding(mk, fault)) line += "; at most 1 %, which is no finding";
            lines.push_back(line);
            is_found = is_found || report.is_finding(mk, fault);
        }
        if (is_found) lines.push_back(std::string("  ") + words_of(fault).advice);
    }
    for (const CheckedMk& mk : report.mks)
        if (report.setup.no_penetration && is_wall(mk) && mk.front > 0 &&
            (2 * mk.front_no_penetration < mk.front || mk.mean_window < 0.1))
            lines.push_back(
                fmt::format("mk {}: NoPenetration acts on {} of {} particles next to fluid, nearer "
                            "than {:.2f} dp; "
                            "a first layer half a dp behind the surface makes it 0.75 dp",
                            mk.mk, mk.front_no_penetration, mk.front, mk.mean_window));
    return lines;
}

std::string headline(const CheckReport& report)
{
    const CheckSetup& setup = report.setup;
    std::string text =
        fmt::format("{}: {}, dp {:g} m, h {:.4g} m, {} particles, {} of fluid, ", setup.case_name,
                    setup.is_2d ? "2D" : "3D", setup.dp, setup.h, report.np, report.fluid);
    if (setup.boundary != 2) return text + "DBC";
    return text + fmt::format("mDBC, SlipMode {}{}", setup.slip_mode,
                              setup.no_penetration ? ", NoPenetration" : "");
}

std::string verdict(const CheckReport& report)
{
    return report.is_clean() ? "Nothing was found." : "There are findings.";
}

} // namespace

const char* fault_name(Fault fault)
{
    return words_of(fault).name;
}

std::uint64_t CheckReport::total(Fault fault) const
{
    std::uint64_t sum = 0;
    for (const CheckedMk& mk : mks) sum += mk[fault];
    return sum;
}

bool CheckReport::is_finding(const CheckedMk& mk, Fault fault) const
{
    const std::uint64_t count = mk[fault];
    if (fault == Fault::WeakKernel || fault == Fault::IllConditioned)
        return 100 * count > mk.near_fluid;
    return count > 0;
}

bool CheckReport::is_clean() const
{
    for (const CheckedMk& mk : mks)
        for (std::size_t f = 0; f < fault_count; ++f)
            if (is_finding(mk, static_cast<Fault>(f))) return false;
    return true;
}

std::string to_text(const CheckReport& report)
{
    std::string text = headline(report) + "\n";
    if (report.judges_normals)
    {
        text += fmt::format("Walls, with the cavity full of fluid ({} nodes besides the fluid):\n",
                            report.fill);
        text += text_table(wall_rows(report));
    }
    for (const std::string& line : finding_lines(report)) text += "  " + line + "\n";
    for (const std::string& note : report.setup.notes) text += "  " + note + "\n";
    return text + verdict(report) + "\n";
}

std::string to_html(const CheckReport& report)
{
    std::string html = "<h3>Check</h3>\n<p>" + escaped_html(headline(report)) + "</p>\n";
    if (report.judges_normals)
    {
        html += "<div class=\"scroll\"><table>";
        const char* cell = "th";
        for (const auto& row : wall_rows(report))
        {
            html += "<tr>";
            for (const std::string& text : row)
                html += fmt::format("<{0}>{1}</{0}>", cell, escaped_html(text));
            html += "</tr>\n";
            cell = "td";
        }
        html += "</table></div>\n";
    }
    html += "<ul>";
    for (const std::string& line : finding_lines(report))
        html += "<li>" + escaped_html(line) + "</li>\n";
    for (const std::string& note : report.setup.notes)
        html += "<li>" + escaped_html(note) + "</li>\n";
    return html + "</ul>\n<p>" + verdict(report) + "</p>\n";
}

std::string to_json(const CheckReport& report)
{
    const CheckSetup& setup = report.setup;
    Json root;
    root["case"] = setup.case_name;
    root["is_2d"] = setup.is_2d;
    root["dp"] = setup.dp;
    root["h"] = setup.h;
    root["boundary"] = setup.boundary;
    root["slip_mode"] = setup.slip_mode;
    root["no_penetration"] = setup.no_penetration;
    root["particles"] = report.np;
    root["fluid"] = report.fluid;
    root["fill_nodes"] = report.fill;
    root["judges_normals"] = report.judges_normals;
    root["is_clean"] = report.is_clean();
    root["close_pairs"] = report.close_pairs;
    root["mks"] = Json::array();
    for (const CheckedMk& mk : report.mks)
    {
        Json out;
        out["mk"] = mk.mk;
        out["type"] = type_of_mk(mk);
        out["particles"] = mk.count;
        out["near_fluid"] = mk.near_fluid;
        out["has_normals"] = mk.has_normals;
        Json& faults = out["faults"];
        Json& findings = out["findings"];
        findings = Json::array();
        for (std::size_t f = 0; f < fault_count; ++f)
        {
            faults[words[f].name] = mk.faults[f];
            if (report.is_finding(mk, static_cast<Fault>(f))) findings.push_back(words[f].name);
        }
        out["next_to_fluid"] = mk.front;
        out["no_penetration_can_act"] = mk.front_no_penetration;
        out["no_penetration_window_dp"] = mk.mean_window;
        out["thinnest_wet_on_both_sides"] = mk.thinnest;
        out["median_wet_on_both_sides"] = mk.median_thickness;
        out["dp_needed"] = mk.dp_needed;
        root["mks"].push_back(std::move(out));
    }
    Json& examples = root["examples"];
    examples = Json::object();
    for (std::size_t f = 0; f < fault_count; ++f)
    {
        Json list = Json::array();
        std::size_t known = 0;
        for (std::size_t k = 0; k < report.faulty.size() && known < examples_of_each; ++k)
        {
            const FaultyParticle& p = report.faulty[k];
            if ((p.faults >> f & 1U) == 0) continue;
            ++known;
            list.push_back({{"id", p.id},
                            {"mk", p.mk},
                            {"position", std::array{p.position.x, p.position.y, p.position.z}}});
        }
        examples[words[f].name] = std::move(list);
    }
    root["notes"] = setup.notes;
    return root.text(1) + "\n";
}

std::string to_vtk(const CheckReport& report)
{
    const std::size_t n = report.faulty.size();
    std::string out = vtk_head + fmt::format("POINTS {} float\n", n);
    const auto put_each = [&](const auto& put)
    {
        for (const FaultyParticle& p : report.faulty) put(p);
        out += '\n';
    };
    put_each(
        [&](const FaultyParticle& p)
        {
            for (int axis = 0; axis < 3; ++axis)
                append_big_endian(out, static_cast<float>(p.position[axis]));
        });
    out += fmt::format("VERTICES {} {}\n", n, 2 * n);
    std::uint32_t index = 0;
    put_each(
        [&](const FaultyParticle&)
        {
            append_big_endian(out, std::uint32_t{1});
            append_big_endian(out, index++);
        });
    out += fmt::format("POINT_DATA {}\n", n);
    const auto scalars = [&](const char* name, const char* type, const auto& value)
    {
        out += fmt::format("SCALARS {} {}\nLOOKUP_TABLE default\n", name, type);
        put_each([&](const FaultyParticle& p) { append_big_endian(out, value(p)); });
    };
    scalars("Idp", "unsigned_int", [](const FaultyParticle& p) { return p.id; });
    scalars("Mk", "unsigned_short", [](const FaultyParticle& p) { return p.mk; });
    scalars("Fault", "int",
            [](const FaultyParticle& p)
            { return static_cast<std::uint32_t>(std::countr_zero(p.faults)); });
    scalars("Faults", "unsigned_short", [](const FaultyParticle& p) { return p.faults; });
    out += "VECTORS Normal float\n";
    put_each(
        [&](const FaultyParticle& p)
        {
            for (const float c : p.normal) append_big_endian(out, c);
        });
    return out;
}

} // namespace fppg
