#include "fppg/case_def.h"
#include "fppg/error.h"

#include "casedef/attributes.h"
#include "casedef/draw_block.h"
#include "casedef/execution.h"
#include "casedef/expression.h"
#include "casedef/fit_block.h"
#include "casedef/floatings.h"
#include "casedef/initials.h"
#include "casedef/known_names.h"
#include "casedef/motion.h"
#include "casedef/normals.h"
#include "casedef/patterns.h"
#include "casedef/program.h"
#include "casedef/properties.h"
#include "casedef/variable_commands.h"
#include "casedef/vres.h"
#include "casedef/xml_document.h"
#include "core/most_particles.h"
#include "meshes/mesh_library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace fppg
{
namespace
{

/// Whether a shape of boundary particles is drawn by nodes.
bool has_walls_on_lattice(const CaseDef& def)
{
    return std::any_of(
        def.ops.begin(), def.ops.end(),
        [&](const DrawOp& op)
        {
            const MkValue& mk = op.state->mk;
            return mk.kind == MkKind::Bound && std::holds_alternative<Shape>(op.what) &&
                   (fit_settings(def.fit, mk.mk) == nullptr || op.state->mode == DrawMode::Wire ||
                    shape_as<PointsOp>(op) != nullptr || shape_as<LinesOp>(op) != nullptr);
        });
}

/// The version of GenCase whose language this is.
constexpr std::array<int, 3> language_version{5, 4, 354};

class CaseReader
{
public:
    CaseReader(const std::string& path, const CaseOptions& options)
        : options_(options), read_(path, variables_), commands_(variables_, read_, options.evars)
    {
        def_.file = path;
        def_.case_name = options.case_name;
    }

    CaseDef run()
    {
        def_.document = read_document(def_.file);
        const Element& root = root_of(def_.document);
        def_.meshes = options_.meshes ? options_.meshes : std::make_shared<MeshLibrary>(def_.file);
        if (root.name != "case")
            throw CaseError(def_.file, root.line,
                            fmt::format("<{}>: the root must be <case>, as in a GenCase definition",
                                        root.name));
        const Element& casedef = read_.child(root, "casedef");
        check_version(casedef);
        def_.casedef = casedef;
        def_.execution = read_execution(root, read_);
        read_constants(read_.child(casedef, "constantsdef"));
        read_mk_config(read_.child(casedef, "mkconfig"));
        const Element& geometry = read_.child(casedef, "geometry");
        set_early_variables();
        if (const Element* before = geometry.find_child("predefinition"))
            run_predefinition(*before);
        const Element* vres = casedef.find_child("vres");
        if (vres != nullptr && !read_.plain_flag_or(*vres, "active", true)) vres = nullptr;
        if (vres != nullptr) def_.case_name = zone_name(options_.case_name, options_.zone);
        const Element& definition = read_.child(geometry, "definition");
        read_definition(definition);
        if (options_.vres != nullptr) enter_zone(definition);
        apply_formulas();
        set_case_variables();
        if (vres != nullptr && options_.vres == nullptr)
            def_.vres = read_vres(*vres, definition, read_, variables_, def_, pointref_);

        PatternTable patterns;
        if (const Element* e = casedef.find_child("patterns")) patterns = read_patterns(*e, read_);
        Program program(def_, commands_, read_, std::move(patterns));
        program.run(read_.child(geometry, "commands"));
        commands_.require_all_overrides_used();
        evaluate_execution(def_.execution, read_);
        if (vres == nullptr)
            read_periodic_axes(def_.execution, def_.file, def_.grid.is_periodic, def_.period_shift);

        if (const Element* e = casedef.find_child("initials"))
            def_.initials = read_initials(*e, def_, read_, def_.warnings);
        if (const Element* e = casedef.find_child("floatings")) read_floatings(*e, read_, def_);
        read_properties(casedef.find_child("properties"), read_, def_);
        if (const Element* e = casedef.find_child("motion"))
            def_.motion = evaluated_motion(*e, read_);
        if (const Element* e = casedef.find_child("normals"))
            def_.normals = read_normals(*e, def_, read_, def_.warnings);
        warn_of_refused_normals(def_, read_, def_.warnings);
        for (const char* section : {"floatings", "properties", "motion"})
            if (const Element* e = casedef.find_child(section)) warn_of_conditions(*e, section);
        note_data_files(casedef);
        read_draw_block(read_, def_);
        read_fit(root, read_, options_.fit, def_);
        // Body-fitted walls are for fppg alone anyway.
        for (const auto& [name, line] : program.own_commands)
            if (def_.fit.is_empty())
                def_.warnings.push_back(fmt::format(
                    "{}:{}: <{}>: is a command of fppg's own; GenCase does not know it and refuses "
                    "the case.",
                    def_.file, line, name));
        if (!def_.fit.is_empty()) settle_lattice(casedef);
        if (vres != nullptr) check_vres(*vres);
        apply_overrides(def_.casedef);
        for (const Variable& v : variables_.exported())
        {
            const auto* text = std::get_if<std::string>(&v.value);
            def_.user_variables.push_back({v.name, text != nullptr,
                                           text != nullptr ? 0 : std::get<double>(v.value),
                                           text != nullptr ? *text : ""});
        }
        def_.variables_log = variables_.describe_all();
        for (std::string& warning : unknown_names(root, def_.file))
            def_.warnings.push_back(std::move(warning));
        return std::move(def_);
    }

private:
    /// Body-fitted walls need no second particle per node.
    void settle_lattice(const Element& casedef)
    {
        ConstantsDef& c = def_.constants;
        if (c.lattice_fluid != 1 || (c.lattice_bound != 1 && has_walls_on_lattice(def_)))
            read_.fail(casedef,
                       "<lattice> with two particles per node is not possible together with "
                       "body-fitted walls, expected bound=\"1\" and fluid=\"1\", or no -fit and no "
                       "<bodyfitted>");
        if (c.lattice_bound == 1) return;
        def_.warnings.push_back(fmt::format(
            "{}:{}: <lattice bound=\"{}\">: all walls are body-fitted, which have one particle per "
            "dp^2: taken for bound=\"1\".",
            def_.file, casedef.line, c.lattice_bound));
        c.lattice_bound = 1;
        apply_formulas();
    }

    void check_version(const Element& casedef) const
    {
        const std::string* wanted = casedef.find_attribute("requiredversion");
        if (wanted == nullptr) return;
        std::array<int, 3> version{};
        const int fields =
            std::sscanf(wanted->c_str() + (wanted->starts_with('v') ? 1 : 0), "%d.%d.%d", // NOLINT
                        version.data(), &version[1], &version[2]);
        if (fields >= 1 && version > language_version)
            read_.fail(casedef,
                       fmt::format(
                           "the case asks for version {} of GenCase or later, this program follows "
                           "v{}.{}.{}",
                           *wanted, language_version[0], language_version[1], language_version[2]));
    }

    /// A constant that `auto="true"` leaves to its formula.
    std::optional<double> fixed_value(const Element& constants, const char* name,
                                      bool is_required) const
    {
        const Element* e = constants.find_child(name);
        if (e == nullptr)
        {
            if (is_required) read_.child(constants, name);
            return std::nullopt;
        }
        if (read_.plain_flag_or(*e, "auto", false)) return std::nullopt;
        return read_.number(*e, "value");
    }

    void read_constants(const Element& e)
    {
        ConstantsDef& c = def_.constants;
        if (const Element* lattice = e.find_child("lattice"))
        {
            c.lattice_bound = read_.integer(*lattice, "bound", 0, 1000, false);
            c.lattice_fluid = read_.integer(*lattice, "fluid", 0, 1000, false);
        }
        c.gravity = read_.child_vec3(e, "gravity");
        c.rhop0 = read_.child_value(e, "rhop0");
        if (const Element* gradient = e.find_child("rhopgradient"))
            c.rhop_gradient = read_.integer(*gradient, "value", 1, 3, false);
        c.hswl = fixed_value(e, "hswl", true);
        c.gamma = read_.child_value(e, "gamma");
        c.speed_system = fixed_value(e, "speedsystem", false);
        c.coef_sound = read_.child_value(e, "coefsound");
        c.speed_sound = fixed_value(e, "speedsound", false);
        const Element* coef_h = e.find_child("coefh");
        if (coef_h == nullptr) coef_h = e.find_child("coefficient");
        const Element* hdp = e.find_child("hdp");
        if (coef_h != nullptr && hdp != nullptr)
            read_.fail(*hdp, "only one constant must be defined, coefh or hdp");
        if (coef_h != nullptr) c.coef_h = read_.number(*coef_h, "value");
        if (hdp != nullptr) c.hdp = read_.number(*hdp, "value");
        if (!c.coef_h && !c.hdp) read_.fail(e, "the element <coefh> (or <hdp>) is missing in it");
        c.cfl_number = read_.child_value(e, "cflnumber");
        if (const Element* eps = e.find_child("eps")) c.eps = read_.number(*eps, "value");
        c.h = fixed_value(e, "h", false);
        c.b = fixed_value(e, "b", false);
        c.mass_bound = fixed_value(e, "massbound", false);
        c.mass_fluid = fixed_value(e, "massfluid", false);
        if (!(c.rhop0 > 0))
            read_.fail(*e.find_child("rhop0"),
                       fmt::format("{:g} is no density, expected more than 0", c.rhop0));
        if (!(c.gamma > 0))
            read_.fail(*e.find_child("gamma"),
                       fmt::format("{:g} is invalid, expected more than 0", c.gamma));
    }

    /// For what GenCase passes over without a word.
    void warn_unknown(const Element& e, const char* parent, const char* expected)
    {
        def_.warnings.push_back(
            fmt::format("{}:{}: <{}>: is not known in <{}> and has no effect, expected {}",
                        def_.file, e.line, e.name, parent, expected));
    }

    /// GenCase v5.4.354 takes both counts up to 65530 together, keeps their last 8 bits and refuses
    /// more than 250 of what is left (some 40 pairs of counts). Its edition with mks of 16
    /// bits does without, as fppg does.
    void warn_of_small_mks(const Element& e)
    {
        const int bound = def_.mkbound_count % 256;
        const int fluid = def_.mkfluid_count % 256;
        if (bound + fluid > 250)
            def_.warnings.push_back(fmt::format(
                "{}:{}: <mkconfig>: GenCase v5.4 refuses boundcount={} with fluidcount={}, as its "
                "mks have 8 bits, expected at most 250 together for it",
                def_.file, e.line, def_.mkbound_count, def_.mkfluid_count));
        else if (fluid != def_.mkfluid_count)
            def_.warnings.push_back(fmt::format(
                "{}:{}: <mkconfig>: GenCase v5.4 takes fluidcount={} as {}, as its mks have 8 "
                "bits: mkbound 0 is mk {} there and mk {} here",
                def_.file, e.line, def_.mkfluid_count, fluid, fluid + 1, def_.mkfluid_count + 1));
    }

    void read_mk_config(const Element& e)
    {
        def_.mkbound_count = read_.integer(e, "boundcount", 0, 65530, false);
        def_.mkfluid_count = read_.integer(e, "fluidcount", 0, 65530, false);
        const int count = def_.mkbound_count + def_.mkfluid_count;
        if (count > 65530)
            read_.fail(e, fmt::format("boundcount and fluidcount are {} together, expected at "
                                      "most 65530",
                                      count));
        warn_of_small_mks(e);
        def_.mk_fluid_first = 1;
        def_.mk_bound_first = static_cast<std::uint16_t>(def_.mkfluid_count + 1);
        for (const Element& o : e.children)
        {
            if (o.kind != Element::Kind::Tag || o.name.starts_with('_')) continue;
            const bool is_bound = o.name == "mkorientbound";
            if (!is_bound && o.name != "mkorientfluid")
            {
                warn_unknown(o, "mkconfig", "mkorientbound or mkorientfluid");
                continue;
            }
            MkOrient orient;
            orient.mk =
                static_cast<std::uint16_t>(read_.integer(o, "mk", 0, 60000, false) +
                                           (is_bound ? def_.mk_bound_first : def_.mk_fluid_first));
            const std::string& order = read_.text(o, "orient");
            std::set<int> seen;
            for (std::size_t i = 0; i < order.size() && i < 3; ++i)
            {
                const char lower = static_cast<char>(order[i] | 0x20);
                if (lower < 'x' || lower > 'z') break;
                orient.axes[i] = lower - 'x';
                orient.descending[i] = order[i] != lower;
                seen.insert(lower);
            }
            if (order.size() != 3 || seen.size() != 3)
                read_.fail(
                    o, fmt::format(
                           "orient=\"{}\" is invalid, expected the letters x, y, z in some order, "
                           "capital for descending",
                           order));
            def_.mk_orients.push_back(orient);
        }
    }

    void predefine(const std::string& name, VariableValue value, bool is_exported = false)
    {
        try
        {
            variables_.predefine(name, std::move(value), is_exported);
        }
        catch (const ExpressionError& error)
        {
            // Only a variable of <predefinition> can be in its way.
            const Element* geometry = def_.casedef.find_child("geometry");
            read_.fail(*geometry->find_child("predefinition"), error.what());
        }
    }

    void set_early_variables()
    {
        predefine("Gravity_x", def_.constants.gravity.x);
        predefine("Gravity_y", def_.constants.gravity.y);
        predefine("Gravity_z", def_.constants.gravity.z);
        predefine("Rhop0", def_.constants.rhop0);
        predefine("VResId", static_cast<double>(options_.zone), true);
    }

    void run_predefinition(const Element& e)
    {
        for (const Element& c : e.children)
        {
            if (c.kind != Element::Kind::Tag || c.name.starts_with('_') || !read_.is_active(c))
                continue;
            static const std::vector<std::string_view> known{
                "newvarcte", "newvarstrcte", "newvar", "newvarstr", "setvar", "setvarstr"};
            if (std::find(known.begin(), known.end(), c.name) == known.end())
                read_.fail_unknown_element(c, "predefinition", known);
            commands_.run(c, def_.list_log);
        }
    }

    /// Of a lattice through `ref`, the last node that is not above `low`, in GenCase's arithmetic:
    /// one farther down where `ref` is a rounding error above its node (402 random lattices of
    /// v5.4.354, a quarter with ref whole dps away; all to the last bit).
    static double lowest_node(double low, double ref, double dp)
    {
        const double away = ref - (low + std::floor((ref - low) / dp + 0.5) * dp);
        return low + (away > 0 ? away - dp : away);
    }

    void read_definition(const Element& e)
    {
        LatticeGrid& grid = def_.grid;
        grid.dp = options_.dp ? *options_.dp : read_.number(e, "dp");
        if (!(grid.dp > 0) || !std::isfinite(grid.dp))
            read_.fail(e, fmt::format("dp is {:g}, expected a particle distance above 0", grid.dp));
        // GenCase knows it in the attributes of the children.
        predefine("Dp", zone_dp());
        const Vec3 low = read_.child_vec3(e, "pointmin");
        const Vec3 high = read_.child_vec3(e, "pointmax");
        grid.is_2d = low.y == high.y;
        for (int axis = 0; axis < 3; ++axis)
            if (low[axis] > high[axis])
                read_.fail(
                    *e.find_child("pointmin"),
                    fmt::format(
                        "the lower limit {:g} of {} is above the upper limit {:g} in <pointmax>",
                        low[axis], "xyz"[axis], high[axis]));
        grid.origin = low;
        // The lattice goes through pointref (rule L1); a flat case keeps its y.
        if (const Element* ref = e.find_child("pointref"))
        {
            pointref_ = read_.vec3_or(*ref, {});
            // An axis that it leaves out is that of pointmin.
            const Vec3 r = read_.vec3_or(*ref, low);
            for (int axis = 0; axis < 3; ++axis)
                if (!(grid.is_2d && axis == 1))
                    grid.origin[axis] = lowest_node(low[axis], r[axis], grid.dp);
        }
        set_nodes(e, high);
    }

    double zone_dp() const
    {
        return options_.vres != nullptr ? options_.vres->zones[options_.zone].dp : def_.grid.dp;
    }

    /// The lattice of a zone: from the lowest corner of its buffer's limits to the highest, which
    /// has a node.
    void enter_zone(const Element& e)
    {
        def_.vres = *options_.vres;
        def_.zone = options_.zone;
        const VresZone& zone = def_.vres.zones[def_.zone];
        const Box3 limits = limits_of(zone.buffer);
        def_.grid.dp = zone.dp;
        def_.grid.origin = limits.min;
        Vec3 high = limits.max;
        for (int axis = 0; axis < 3; ++axis)
            if (!(def_.grid.is_2d && axis == 1)) high[axis] += zone.dp * 1.001;
        set_nodes(e, high);
        def_.casedef.find_child("geometry")
            ->find_child("definition")
            ->set_attribute("dp", fmt::format("#{}", zone.dp));
    }

    void check_vres(const Element& e) const
    {
        if (!def_.point_files.empty())
            read_.fail(e,
                       "regions of other resolution together with <fppg><points> are not "
                       "supported yet");
    }

    /// Nodes up to the highest limits, which have none themselves.
    void set_nodes(const Element& e, const Vec3& high)
    {
        LatticeGrid& grid = def_.grid;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double n = std::floor((high[axis] - grid.origin[axis]) / grid.dp);
            // Four thousand million nodes an axis: the index type of the lattice.
            if (!(n < 4.0e9))
                read_.fail(e, fmt::format("the domain has {:g} nodes along {}, more than 4e9; "
                                          "dp={:g} and larger ones "
                                          "fit",
                                          n, "xyz"[axis], dp_rounded_up(grid.dp * n / 4.0e9)));
            grid.n[static_cast<std::size_t>(axis)] = static_cast<std::uint32_t>(std::max(1.0, n));
        }
        if (grid.is_2d) grid.n[1] = 1;
        if (grid.n[0] > 200'000'000)
            read_.fail(e, fmt::format("the domain has {} nodes along x, more than this program can "
                                      "hold (2e8); dp={:g} and larger ones fit",
                                      grid.n[0], dp_rounded_up(grid.dp * grid.n[0] / 2e8)));
        def_.case_pos_min = grid.origin;
        def_.case_pos_max = high;
    }

    /// h = coefh * sqrt(dim) * dp or hdp * dp, masses rhop0 * dp^dim, unless they are given.
    /// Verified against GenCase v5.4: 3D dp 0.0085 coefh 1 gives h 0.014722431864.
    void apply_formulas()
    {
        const ConstantsDef& c = def_.constants;
        const double dp = def_.grid.dp;
        def_.h = c.h     ? *c.h
                 : c.hdp ? *c.hdp * dp
                         : c.coef_h.value_or(1) * std::sqrt(def_.grid.is_2d ? 2.0 : 3.0) * dp;
        const double mass = c.rhop0 * (def_.grid.is_2d ? dp * dp : dp * dp * dp);
        def_.mass_bound = c.mass_bound.value_or(c.lattice_bound == 1 ? mass : mass / 2);
        def_.mass_fluid = c.mass_fluid.value_or(c.lattice_fluid == 1 ? mass : mass / 2);
    }

    void set_case_variables()
    {
        const LatticeGrid& grid = def_.grid;
        predefine("PosMin_x", def_.case_pos_min.x);
        predefine("PosMin_y", def_.case_pos_min.y);
        predefine("PosMin_z", def_.case_pos_min.z);
        predefine("PosMax_x", def_.case_pos_max.x);
        predefine("PosMax_y", def_.case_pos_max.y);
        predefine("PosMax_z", def_.case_pos_max.z);
        predefine("CaseName", def_.case_name);
        predefine("Data2D", grid.is_2d ? 1.0 : 0.0);
        predefine("Data2DPosy", grid.is_2d ? grid.origin.y : 0.0);
        predefine("H", def_.h);
        predefine("MassBound", def_.mass_bound);
        predefine("MassFluid", def_.mass_fluid);
    }

    /// The files that the solver reads, for the copy beside the result: those of motions, of the
    /// velocities and forces of floatings, of properties, and mesh data as text.
    void note_data_files(const Element& e)
    {
        for (const char* section : {"motion", "floatings", "properties", "initials"})
            if (const Element* found = e.find_child(section)) note_files_in(*found);
    }

    void note_files_in(const Element& e)
    {
        for (const Element& c : e.children)
        {
            if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
            const std::string name = read_.text_or(c, c.name == "file" ? "name" : "file", "");
            const bool is_binary = c.name == "meshdata" && !name.ends_with(".csv");
            if (!name.empty() && !is_binary &&
                std::none_of(def_.data_files.begin(), def_.data_files.end(),
                             [&](const DataFileUse& use) { return use.name == name; }))
                def_.data_files.push_back({name, c.line});
            note_files_in(c);
        }
    }

    /// In these sections GenCase passes over `if` without a word.
    void warn_of_conditions(const Element& e, const char* section)
    {
        for (const Element& c : e.children)
        {
            if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
            if (c.find_attribute("if") != nullptr)
                def_.warnings.push_back(
                    fmt::format("{}:{}: <{}>: attribute if has no effect in <{}>, expected _{} for "
                                "an element that does not count",
                                def_.file, c.line, c.name, section, c.name));
            warn_of_conditions(c, section);
        }
    }

    /// The copy of the definition shows the values that -evars gave.
    void apply_overrides(Element& e) const
    {
        if (e.name == "newvarcte" || e.name == "newvarstrcte")
            for (Element::Attribute& a : e.attributes)
                for (const auto& [name, value] : options_.evars)
                    if (a.name == name) a.value = value;
        for (Element& c : e.children) apply_overrides(c);
    }

    CaseOptions options_;
    CaseDef def_;
    Vec3 pointref_;
    Variables variables_;
    AttributeReader read_;
    VariableCommands commands_;
};

} // namespace

std::string zone_name(const std::string& case_name, std::size_t zone)
{
    return fmt::format("{}_vres{:02}", case_name, zone);
}

CaseDef read_case(const std::string& path, const CaseOptions& options)
{
    return CaseReader(path, options).run();
}

Element read_definition_tree(const std::string& path)
{
    return read_document(path);
}

} // namespace fppg
