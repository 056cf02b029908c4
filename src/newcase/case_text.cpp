#include "newcase/plan.h"

#include "meshes/mesh_formats.h"
#include "newcase/words.h"
#include "newcase/xml_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fppg
{

namespace
{

std::string escaped(const std::string& text)
{
    std::string out;
    for (const char c : text)
    {
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += c;
    }
    return out;
}

/// Groups of touching parts that keep their places: each is one body.
std::vector<std::vector<std::size_t>> bodies_of(const CasePlan& plan)
{
    std::vector<std::size_t> group(plan.parts.size());
    std::iota(group.begin(), group.end(), std::size_t{0});
    const auto root = [&](std::size_t i)
    {
        while (group[i] != i) i = group[i];
        return i;
    };
    for (const PartPair& pair : plan.pairs)
    {
        const NewPart& a = plan.parts[pair.first];
        const NewPart& b = plan.parts[pair.second];
        const bool have_inside = a.report.is_watertight && b.report.is_watertight;
        if (!pair.touches || !have_inside || a.role == PartRole::Inlet ||
            b.role == PartRole::Inlet || !move_alike(a, b) || a.role == PartRole::Floating ||
            b.role == PartRole::Floating)
            continue;
        const std::size_t one = root(pair.first), other = root(pair.second);
        group[std::max(one, other)] = std::min(one, other);
    }
    std::vector<std::vector<std::size_t>> out(plan.parts.size());
    for (std::size_t i = 0; i < plan.parts.size(); ++i) out[root(i)].push_back(i);
    std::erase_if(out, [](const auto& members) { return members.size() < 2; });
    return out;
}

/// What a turning part covers.
void add_swept(Box3& box, const NewPart& part)
{
    const AxisLine& axis = part.turning->axis;
    for (const Vec3& v : part.mesh.vertices)
    {
        const Vec3 way = v - axis.point;
        const double along = dot(way, axis.direction);
        const double radius = norm(way - along * axis.direction);
        const Vec3 middle = axis.point + along * axis.direction;
        Vec3 reach;
        for (int a = 0; a < 3; ++a)
            reach[a] = radius * std::sqrt(std::max(0.0, 1 - axis.direction[a] * axis.direction[a]));
        box.add(middle - reach);
        box.add(middle + reach);
    }
}

class CaseWriter
{
public:
    explicit CaseWriter(const CasePlan& plan) : plan_(plan), bodies_(bodies_of(plan)) {}

    std::string run()
    {
        xml_.line("<?xml version=\"1.0\" encoding=\"UTF-8\" ?>");
        xml_.comment(fmt::format("Made by fppg new, kind {}: {} {}. Run it with: fppg {} OUTPUT",
                                 new_case_kinds()[static_cast<std::size_t>(plan_.kind)],
                                 plan_.parts.size(), plan_.parts.size() == 1 ? "part" : "parts",
                                 "Case_Def"));
        xml_.open("case xmlns:fppg=\"urn:fppg\"");
        xml_.open("casedef");
        constants();
        geometry();
        floatings();
        fitted();
        initials();
        motion();
        xml_.close("casedef");
        execution();
        xml_.close("case");
        return xml_.take();
    }

private:
    const CasePlan& plan_;
    std::vector<std::vector<std::size_t>> bodies_;
    XmlLines xml_;

    bool flows() const { return plan_.water && plan_.water->flows; }
    std::string dp_down(double value) const { return fmt::format("#{}-6*Dp", xml_number(value)); }
    std::string dp_up(double value) const { return fmt::format("#{}+6*Dp", xml_number(value)); }

    void constants()
    {
        xml_.open("constantsdef");
        xml_.line("<gravity x=\"0\" y=\"0\" z=\"-9.81\" units_comment=\"m/s^2\" />");
        xml_.line("<rhop0 value=\"{}\" comment=\"Density: {}\" units_comment=\"kg/m^3\" />",
                  xml_number(plan_.liquid.rhop0), plan_.liquid.about);
        xml_.line(
            "<rhopgradient value=\"2\" comment=\"Density under the weight of the fluid above "
            "each particle\" />");
        xml_.line(
            "<hswl value=\"0\" auto=\"true\" comment=\"Depth of the fluid, found from the "
            "particles\" units_comment=\"m\" />");
        xml_.line("<gamma value=\"7\" comment=\"Exponent of the equation of state\" />");
        xml_.line(
            "<speedsystem value=\"{}\" auto=\"false\" comment=\"The largest speed: of parts, "
            "of the stream, or of fluid that falls by its depth\" units_comment=\"m/s\" />",
            xml_number(round_nearest(plan_.fastest, 3)));
        xml_.line(
            "<coefsound value=\"10\" comment=\"Speed of sound over that speed: densities "
            "change by 1 % at most\" />");
        xml_.line(
            "<speedsound value=\"{}\" auto=\"false\" comment=\"Ten times the largest speed; "
            "a higher one makes time steps shorter\" units_comment=\"m/s\" />",
            xml_number(plan_.speed_sound));
        xml_.line(
            "<coefh value=\"1\" comment=\"Smoothing length: h = coefh*sqrt(3*dp^2); walls "
            "get 3 layers\" />");
        xml_.line("<cflnumber value=\"0.2\" comment=\"Factor of the time step\" />");
        xml_.close("constantsdef");
        xml_.line("<mkconfig boundcount=\"240\" fluidcount=\"9\" />");
    }

    void geometry()
    {
        xml_.open("geometry");
        predefinition();
        Box3 box;
        for (const NewPart& part : plan_.parts)
        {
            box.add(part.box().min);
            box.add(part.box().max);
            if (part.turning) add_swept(box, part);
        }
        if (plan_.water)
        {
            box.add(plan_.water->box.min);
            box.add(plan_.water->box.max);
        }
        for (int axis = 0; axis < 3; ++axis)
        {
            const double unit = plan_.dp;
            box.min[axis] = std::floor(box.min[axis] / unit) * unit;
            box.max[axis] = std::ceil(box.max[axis] / unit) * unit;
        }
        xml_.open("definition dp=\"{}\" units_comment=\"m\"", xml_number(plan_.dp));
        xml_.line("<pointref x=\"0\" y=\"0\" z=\"0\" />");
        if (flows())
        {
            xml_.comment("Along x one period: what leaves at one end comes in at the other.");
            xml_.line("<pointmin x=\"{}\" y=\"{}\" z=\"{}\" />", xml_number(plan_.water->box.min.x),
                      dp_down(box.min.y), dp_down(box.min.z));
            xml_.line("<pointmax x=\"{}\" y=\"{}\" z=\"{}\" />", xml_number(plan_.water->box.max.x),
                      dp_up(box.max.y), dp_up(box.max.z));
        }
        else
        {
            xml_.comment("The box of all parts in all their places, and 6 dp for layers of walls.");
            xml_.line("<pointmin x=\"{}\" y=\"{}\" z=\"{}\" />", dp_down(box.min.x),
                      dp_down(box.min.y), dp_down(box.min.z));
            xml_.line("<pointmax x=\"{}\" y=\"{}\" z=\"{}\" />", dp_up(box.max.x), dp_up(box.max.y),
                      dp_up(box.max.z));
        }
        xml_.close("definition");
        xml_.open("commands");
        xml_.open("mainlist");
        if (plan_.water)
        {
            // Tyres keep a dp clear of the road, so that no particle is squeezed in between.
            if (plan_.kind == CaseKind::Wading)
                xml_.comment(
                    "The bed is a dp below the wheels: no particle is squeezed in between.");
            xml_.line("<newvarcte Ground=\"{}{}\" />", xml_number(plan_.water->box.min.z),
                      plan_.kind == CaseKind::Wading ? "-Dp" : "");
        }
        xml_.line("<setdrawmode mode=\"full\" />");
        for (const NewPart& part : plan_.parts)
            if (part.role != PartRole::Inlet) draw(part);
        if (plan_.water) draw_water_box();
        xml_.close("mainlist");
        xml_.close("commands");
        xml_.close("geometry");
    }

    void predefinition()
    {
        const auto uses = [&](const char* unit)
        {
            return std::any_of(plan_.parts.begin(), plan_.parts.end(),
                               [&](const NewPart& p) { return p.unit == unit; });
        };
        xml_.open("predefinition");
        if (uses("mm")) xml_.line("<newvarcte Mm=\"0.001\" _rem=\"Metres of a millimetre\" />");
        if (uses("cm")) xml_.line("<newvarcte Cm=\"0.01\" _rem=\"Metres of a centimetre\" />");
        if (uses("in")) xml_.line("<newvarcte Inch=\"0.0254\" _rem=\"Metres of an inch\" />");
        if (plan_.speed)
            xml_.line("<newvarcte Speed=\"{}\" _rem=\"m/s, of the {}\" />",
                      xml_number(*plan_.speed),
                      plan_.kind == CaseKind::Wading ? "vehicle along x" : "stream against x");
        xml_.line(
            "<newvarcte Boundary=\"2\" _rem=\"Walls 1: dynamic (DBC), 2: modified (mDBC), in "
            "layers; -evars:Boundary=1 changes it\" />");
        xml_.line("<newvarcte TimeMax=\"{}\" TimeOut=\"{}\" _rem=\"s\" />",
                  xml_number(plan_.duration), xml_number(plan_.time_out));
        xml_.close("predefinition");
    }

    void draw(const NewPart& part)
    {
        const char* does = part.role == PartRole::Housing    ? "holds the fluid"
                           : part.role == PartRole::Moving   ? "turns"
                           : part.role == PartRole::Floating ? "floats"
                                                             : "stands";
        xml_.comment(fmt::format("{}: {}.", part.name, does));
        xml_.line("<setmkbound mk=\"{}\" />", part.mkbound);
        const std::string command = fmt::format(
            "drawfile{} file=\"{}\"{}{} fppg:name=\"{}\"", mesh_format_name(part.format),
            escaped(part.file),
            part.step_part.empty() ? "" : fmt::format(" fppg:part=\"{}\"", escaped(part.step_part)),
            part.role == PartRole::Floating ? " fppg:fill=\"inside\"" : "", part.name);
        const char* scale = part.unit == "mm"   ? "Mm"
                            : part.unit == "cm" ? "Cm"
                            : part.unit == "in" ? "Inch"
                                                : nullptr;
        const std::string& up = plan_.options->up;
        if (scale == nullptr && up == "z")
        {
            xml_.line("<{} />", command);
            return;
        }
        xml_.open("{}", command);
        if (up != "z")
            xml_.line("<drawrotate angx=\"{}\" angy=\"{}\" angz=\"0\" />", up == "y" ? 90 : 0,
                      up == "x" ? -90 : 0);
        if (scale != nullptr) xml_.line("<drawscale x=\"#{0}\" y=\"#{0}\" z=\"#{0}\" />", scale);
        xml_.close(fmt::format("drawfile{}", mesh_format_name(part.format)).c_str());
    }

    void draw_water_box()
    {
        const WaterBox& w = *plan_.water;
        const Vec3 size = w.box.max - w.box.min;
        const std::string beyond = flows() ? "-10*Dp" : "";
        const std::string longer = flows() ? "+20*Dp" : "";
        const std::string x0 = (flows() ? "#" : "") + xml_number(w.box.min.x) + beyond;
        const std::string x1 = (flows() ? "#" : "") + xml_number(size.x) + longer;
        xml_.comment(flows() ? "The bed and its two walls, beyond both ends, which are joined."
                             : "The basin.");
        xml_.line("<setmkbound mk=\"0\" />");
        xml_.open("drawbox");
        xml_.line("<boxfill>{}</boxfill>",
                  flows() ? "bottom | front | back" : "bottom | left | right | front | back");
        xml_.line("<point x=\"{}\" y=\"{}\" z=\"#Ground\" />", x0, xml_number(w.box.min.y));
        xml_.line("<size x=\"{}\" y=\"{}\" z=\"#{}-Ground\" />", x1, xml_number(size.y),
                  xml_number(w.box.max.z));
        xml_.close("drawbox");
        xml_.comment("Water in all that is still empty, up to its level.");
        xml_.line("<setmkfluid mk=\"0\" />");
        xml_.open("fillbox {}", xml_place(w.seed));
        xml_.line("<modefill>void</modefill>");
        xml_.line("<point x=\"{}\" y=\"{}\" z=\"#Ground\" />", x0, xml_number(w.box.min.y));
        xml_.line("<size x=\"{}\" y=\"{}\" z=\"#{}-Ground\" />", x1, xml_number(size.y),
                  xml_number(w.level));
        xml_.close("fillbox");
    }

    void floatings()
    {
        if (std::none_of(plan_.parts.begin(), plan_.parts.end(),
                         [](const NewPart& p) { return p.role == PartRole::Floating; }))
            return;
        xml_.open("floatings");
        for (const NewPart& part : plan_.parts)
            if (part.role == PartRole::Floating)
                xml_.line("<floating mkbound=\"{}\" rhopbody=\"{}\" comment=\"{}\" />",
                          part.mkbound, xml_number(round_nearest(part.rhop_body, 6)), part.name);
        xml_.close("floatings");
    }

    void fitted()
    {
        xml_.comment(
            "Read by fppg only. Walls stand in layers behind their true surface, with "
            "normals for mDBC.");
        xml_.open("fppg");
        int n = 0;
        for (const NewPart& part : plan_.parts) n = std::max(n, part.mkbound);
        const int first = plan_.water ? 0 : 1;
        xml_.line("<bodyfitted mkbound=\"{}\" />",
                  n == first ? std::to_string(first) : fmt::format("{}-{}", first, n));
        for (const std::vector<std::size_t>& body : bodies_)
        {
            xml_.comment("Parts that touch and keep their places are one body; each keeps its mk.");
            xml_.open("boolean op=\"union\"");
            for (const std::size_t i : body) xml_.line("<part ref=\"{}\" />", plan_.parts[i].name);
            xml_.close("boolean");
        }
        if (plan_.fill) fill();
        if (std::any_of(plan_.parts.begin(), plan_.parts.end(),
                        [](const NewPart& p) { return p.role == PartRole::Floating; }))
            xml_.line(
                "<floatings exact=\"true\" comment=\"Mass, centre and inertia of the shape\" "
                "/>");
        xml_.close("fppg");
    }

    void fill()
    {
        const VesselFill& f = *plan_.fill;
        const std::string amount =
            f.amount == FluidAmount::Litres    ? fmt::format("litres=\"{}\"", xml_number(f.value))
            : f.amount == FluidAmount::Percent ? fmt::format("percent=\"{}\"", xml_number(f.value))
                                               : fmt::format("level=\"{}\"", xml_number(f.value));
        xml_.comment(fmt::format("The {} in {}: from a seed in its cavity, up to z = {} m.",
                                 plan_.liquid.name, plan_.parts[f.vessel].name,
                                 short_number(f.level)));
        xml_.open("fill mkfluid=\"0\" {}", amount);
        xml_.line("<seed {} />", xml_place(f.seed));
        xml_.close("fill");
    }

    void initials()
    {
        if (!flows() || !plan_.speed) return;
        xml_.comment(plan_.kind == CaseKind::Wading
                         ? "In the frame of the vehicle the water comes from the front; the bed "
                           "stands."
                         : "The stream, against x.");
        xml_.open("initials");
        xml_.line("<velocity mkfluid=\"0\" x=\"#-Speed\" y=\"0\" z=\"0\" />");
        xml_.close("initials");
    }

    void motion()
    {
        const bool moves = std::any_of(plan_.parts.begin(), plan_.parts.end(),
                                       [](const NewPart& p) { return p.turning.has_value(); });
        if (!moves) return;
        xml_.comment(
            "The solver turns clockwise seen from axisp2, so counter-clockwise seen from "
            "axisp1.");
        xml_.open("motion");
        for (const NewPart& part : plan_.parts)
        {
            if (!part.turning) continue;
            // The same for all parts of one axis: their motions are told to be one by their text.
            const AxisLine& axis = part.turning->axis;
            const Vec3 other = axis.point - axis.direction * 0.1;
            xml_.comment(part.name);
            xml_.open("objreal ref=\"{}\"", part.mkbound);
            xml_.line("<begin mov=\"1\" start=\"0\" />");
            // Longer than the run: a movement that ends with it lets the part stand.
            xml_.open("mvrot id=\"1\" duration=\"#2*TimeMax\" anglesunits=\"degrees\"");
            xml_.line("<vel ang=\"{}\" units_comment=\"degrees/s\" />",
                      xml_number(part.turning->degrees_per_s));
            xml_.line("<axisp1 {} />", xml_place(axis.point));
            xml_.line("<axisp2 {} />", xml_place(other));
            xml_.close("mvrot");
            xml_.close("objreal");
        }
        xml_.close("motion");
    }

    void parameter(const char* key, const std::string& value, const std::string& comment)
    {
        xml_.line("<parameter key=\"{}\" value=\"{}\" comment=\"{}\" />", key, value, comment);
    }

    void execution()
    {
        xml_.open("execution");
        write_inlet_zones(plan_, xml_);
        xml_.open("parameters");
        parameter("SavePosDouble", "0", "Output positions in single precision");
        parameter("Boundary", "#Boundary", "Walls: 1 dynamic (DBC), 2 modified (mDBC)");
        parameter("SlipMode", "2", "mDBC: 1: no velocity at walls, 2: no slip, 3: free slip");
        parameter("NoPenetration", "1", "With SlipMode 2 and 3: keeps fluid out of walls");
        parameter("StepAlgorithm", "2", "1: Verlet, 2: symplectic, steadier beside moving walls");
        parameter("Kernel", "2", "1: cubic spline, 2: Wendland");
        parameter("ViscoTreatment", "1", "1: artificial, 2: laminar and SPS, 3: laminar");
        parameter(
            "Visco", xml_number(plan_.visco),
            fmt::format(
                "Of the artificial viscosity: stands for {} m2/s at this dp, {} has {}",
                short_number(plan_.visco * std::sqrt(3.0) * plan_.dp * plan_.speed_sound / 10, 2),
                plan_.liquid.name, plan_.liquid.viscosity));
        parameter("ViscoBoundFactor", "1", "Viscosity at walls over that in the fluid");
        parameter("DensityDT", "2", "Density diffusion of Fourtakas et al.");
        parameter("DensityDTvalue", "0.1", "Its coefficient");
        parameter("Shifting", "0", "None");
        parameter("RigidAlgorithm", "1", "Floating bodies collide by SPH forces");
        parameter("FtPause", "0", "Time in which floating bodies are held, s");
        parameter("CoefDtMin", "0.05", "Smallest time step: coefdtmin*h/speedsound");
        parameter("DtIni", "0", "First time step; 0: h/speedsound");
        parameter("DtMin", "0", "Smallest time step; 0: from CoefDtMin");
        parameter("DtFixed", "0", "0: variable time step");
        parameter("TimeMax", "#TimeMax", "End of the run, s");
        parameter("TimeOut", "#TimeOut", "Time between two outputs, s");
        if (flows()) parameter("XPeriodicIncZ", "0", "Periodic in x");
        parameter("RhopOutMin", xml_number(0.7 * plan_.liquid.rhop0),
                  "Smallest density kept, kg/m3");
        parameter("RhopOutMax", xml_number(1.3 * plan_.liquid.rhop0),
                  "Largest density kept, kg/m3");
        simulation_domain();
        xml_.close("parameters");
        xml_.close("execution");
    }

    void simulation_domain()
    {
        const bool is_open = !plan_.fill || plan_.kind != CaseKind::Gearbox;
        const double height = round_up(std::max(plan_.depth, 0.1), 2);
        xml_.open("simulationdomain comment=\"{}\"",
                  is_open ? "The box of the particles, higher for splashes"
                          : "The box of the particles: nothing leaves the housing");
        xml_.line("<posmin x=\"default\" y=\"default\" z=\"default\" />");
        xml_.line("<posmax x=\"default\" y=\"default\" z=\"default{}\" />",
                  is_open ? fmt::format(" + {}", xml_number(height)) : "");
        xml_.close("simulationdomain");
    }
};

} // namespace

std::string case_text(const CasePlan& plan)
{
    return CaseWriter(plan).run();
}

} // namespace fppg
