#include "check/read_setup.h"

#include "casedef/inout_zones.h"
#include "core/finite_number.h"
#include "fppg/error.h"
#include "particles/motion_path.h"
#include "particles/simulation_domain.h"

#include <fmt/format.h>

#include <cmath>

namespace fppg
{

namespace
{

struct SetupReader
{
    const Element& root;
    const std::string& path;

    const Element* find(std::initializer_list<const char*> names) const
    {
        const Element* at = &root;
        for (const char* name : names)
            if (at != nullptr) at = at->find_child(name);
        return at;
    }
    double number_of(const Element& element, const char* attribute) const
    {
        const std::string* text = element.find_attribute(attribute);
        const auto value = text != nullptr ? finite_signed_number(*text) : std::nullopt;
        if (!value)
            throw CaseError(path, element.line,
                            fmt::format("<{} {}=\"{}\">: expected a number", element.name,
                                        attribute, text != nullptr ? *text : ""));
        return *value;
    }
    double constant(const char* name) const
    {
        const Element* element = find({"execution", "constants", name});
        if (element == nullptr)
            throw CaseError(path, 0,
                            fmt::format("there is no <execution><constants><{}>, which the solver "
                                        "needs; expected a case that is made",
                                        name));
        return number_of(*element, "value");
    }
    double positive(const char* name) const
    {
        const double value = constant(name);
        if (!(value > 0))
            throw CaseError(
                path, 0,
                fmt::format("<constants><{}> is {:g}, expected a value above 0", name, value));
        return value;
    }
    /// The last <parameter> of that key counts.
    const Element* parameter(std::string_view key) const
    {
        const Element* parameters = find({"execution", "parameters"});
        const Element* found = nullptr;
        if (parameters != nullptr)
            for (const Element& e : parameters->children)
                if (const std::string* of = e.find_attribute("key");
                    e.kind == Element::Kind::Tag && of != nullptr && *of == key)
                    found = &e;
        return found;
    }
    double parameter_or(std::string_view key, double otherwise) const
    {
        const Element* element = parameter(key);
        return element != nullptr ? number_of(*element, "value") : otherwise;
    }
};

bool is_true(const SetupReader& reader, const char* name)
{
    const Element* element = reader.find({"execution", "constants", name});
    const std::string* text = element != nullptr ? element->find_attribute("value") : nullptr;
    return text != nullptr && (*text == "true" || *text == "1");
}

void read_periodic(const SetupReader& reader, CheckSetup& setup, const Box3& particles)
{
    static constexpr const char* increments[3][2] = {{"XPeriodicIncY", "XPeriodicIncZ"},
                                                     {"YPeriodicIncX", "YPeriodicIncZ"},
                                                     {"ZPeriodicIncX", "ZPeriodicIncY"}};
    static constexpr int across[3][2] = {{1, 2}, {0, 2}, {0, 1}};
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t k = 0; k < 2; ++k)
            if (reader.parameter(increments[axis][k]) != nullptr)
            {
                setup.is_periodic[axis] = true;
                setup.periodic[axis][across[axis][k]] =
                    -reader.parameter_or(increments[axis][k], 0);
            }
    static constexpr const char* pairs[] = {"YZPeriodic", "XZPeriodic", "XYPeriodic"};
    for (std::size_t without = 0; without < 3; ++without)
        if (reader.parameter(pairs[without]) != nullptr)
        {
            setup.is_periodic = {true, true, true};
            setup.is_periodic[without] = false;
            setup.periodic = {};
        }
    for (int axis = 0; axis < 3; ++axis)
        if (setup.is_periodic[static_cast<std::size_t>(axis)])
            setup.periodic[static_cast<std::size_t>(axis)][axis] =
                particles.max[axis] - particles.min[axis] + setup.dp;
}

/// A box of <vres>; empty where it is not along the axes.
Box3 read_box(const SetupReader& reader, const Element& zone, const char* name)
{
    const Element* box = zone.find_child(name);
    const Element* least = box != nullptr ? box->find_child("pointmin") : nullptr;
    const Element* greatest = box != nullptr ? box->find_child("pointmax") : nullptr;
    if (least == nullptr || greatest == nullptr) return {};
    Box3 out;
    for (int axis = 0; axis < 3; ++axis)
    {
        const char attribute[] = {"xyz"[axis], '\0'};
        out.min[axis] = reader.number_of(*least, attribute);
        out.max[axis] = reader.number_of(*greatest, attribute);
    }
    return out;
}

/// Buffer zones of zone `id`: its own, and those around the zones in it (DualSPHysics v5.4,
/// JSphVRes::CreateZones).
void read_buffers(const SetupReader& reader, const Element& zone, const std::string& id,
                  CheckSetup& setup)
{
    const auto add = [&](const Element& of, const char* outer, const char* inner)
    {
        const BufferZone buffer{read_box(reader, of, outer), read_box(reader, of, inner)};
        if (!buffer.outer.is_empty() && !buffer.inner.is_empty())
            setup.buffers.push_back(buffer);
        else
            setup.notes.push_back(fmt::format(
                "A buffer zone that is turned ({}, line {}) was not judged.", outer, of.line));
    };
    for (const Element& child : zone.children)
    {
        if (child.kind != Element::Kind::Tag || child.name != "bufferbox") continue;
        const std::string* child_id = child.find_attribute("id");
        const std::string* parent = child.find_attribute("parentid");
        if (child_id != nullptr && *child_id == id && parent != nullptr)
            add(child, "bufferdomain", "innerdomain");
        if (parent != nullptr && *parent == id)
            add(child, "parentbufferinilimits", "parentbufferendlimits");
        read_buffers(reader, child, id, setup);
    }
}

/// Where moving blocks are, in 1,000 steps up to TimeMax.
void read_motion(const SetupReader& reader, CheckSetup& setup)
{
    constexpr int steps = 1000;
    const Element* motion = reader.find({"execution", "motion"});
    const Element* particles = reader.find({"execution", "particles"});
    const double end = reader.parameter_or("TimeMax", 0);
    if (motion == nullptr || particles == nullptr || !(end > 0)) return;
    const auto follow = [&](const Element& object, const MotionChain& chain)
    {
        MovingBlock block;
        block.step = end / steps;
        block.places = places_over(chain, block.step, steps);
        for (const Element& of : particles->children)
        {
            if (of.name != "moving" ||
                number_or(of, "refmotion", -1) != number_or(object, "ref", -2))
                continue;
            block.mk = static_cast<std::uint16_t>(number_or(of, "mk", 0));
            setup.moving.push_back(block);
        }
    };
    for_each_moving(*motion, follow);
}

void read_inlets(const SetupReader& reader, CheckSetup& setup)
{
    const Element* execution = reader.find({"execution"});
    const Element* particles = reader.find({"execution", "particles"});
    if (execution == nullptr || particles == nullptr) return;
    CaseDef def;
    def.execution = execution->children;
    def.grid.dp = setup.dp;
    def.grid.is_2d = setup.is_2d;
    if (const Element* y = reader.find({"execution", "constants", "data2dposy"}))
        def.grid.origin.y = reader.number_of(*y, "value");
    def.mk_fluid_first = static_cast<std::uint16_t>(number_or(*particles, "mkfluidfirst", 1));
    def.mk_bound_first = static_cast<std::uint16_t>(number_or(*particles, "mkboundfirst", 10));
    std::vector<std::string> unknown;
    const InOutZones zones = read_inout_zones(def, unknown);
    for (const auto& [mk, inlet] : zones.fluids)
        setup.inlets.push_back({mk, {}, inlet.way, inlet.layers});
    for (const InletShape& shape : zones.shapes)
        setup.inlets.push_back({std::nullopt, shape.points, shape.way, shape.layers});
}

} // namespace

CheckSetup read_setup(const Element& root, const std::string& path, const Box3& particles)
{
    const SetupReader reader{root, path};
    CheckSetup setup;
    setup.is_2d = is_true(reader, "data2d");
    setup.dp = reader.positive("dp");
    setup.h = reader.positive("h");
    setup.volume = reader.positive("massfluid") / reader.positive("rhop0");
    setup.speed_sound =
        std::sqrt(reader.constant("b") * reader.constant("gamma") / reader.positive("rhop0"));
    setup.cfl_number = reader.constant("cflnumber");
    if (const Element* gravity = reader.find({"execution", "constants", "gravity"}))
        setup.gravity = {reader.number_of(*gravity, "x"), reader.number_of(*gravity, "y"),
                         reader.number_of(*gravity, "z")};
    setup.least_step = reader.parameter_or("DtMin", 0);
    setup.boundary = static_cast<int>(reader.parameter_or("Boundary", 1));
    setup.slip_mode = static_cast<int>(reader.parameter_or("SlipMode", 1));
    setup.no_penetration = setup.slip_mode >= 2 && reader.parameter_or("NoPenetration", 0) != 0;
    if (reader.parameter_or("Kernel", 2) == 1)
        setup.notes.push_back(
            "Ghost nodes were judged with the Wendland kernel; the case asks for "
            "the cubic spline.");
    read_periodic(reader, setup, particles);
    const Element* parameters = reader.find({"execution", "parameters"});
    setup.domain = solver_domain(parameters != nullptr ? *parameters : Element{}, path,
                                 {particles, setup.dp, setup.h, setup.is_periodic, setup.is_2d});
    read_motion(reader, setup);
    read_inlets(reader, setup);
    const Element* vres = reader.find({"execution", "vres"});
    const std::string* id = vres != nullptr ? vres->find_attribute("selid") : nullptr;
    if (id != nullptr) read_buffers(reader, *vres, *id, setup);
    return setup;
}

} // namespace fppg
