#include "casedef/initials.h"

#include "fppg/error.h"

#include "casedef/mesh_data.h"
#include "core/transforms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

namespace fppg
{
namespace
{

class InitialsReader
{
public:
    InitialsReader(const CaseDef& def, const AttributeReader& read,
                   std::vector<std::string>& warnings)
        : def_(def), read_(read), warnings_(warnings)
    {
    }

    InitialOp read(const Element& e) const
    {
        InitialOp op;
        op.line = e.line;
        if (e.name == "velocity")
            op.what = velocity(e);
        else if (e.name == "velwave")
            op.what = wave(e);
        else if (e.name == "densityuniform")
            op.what = density(e);
        else if (e.name == "densitygradient")
            op.what = gradient(e);
        else if (e.name == "densitydepth")
            op.what = depth(e);
        else if (e.name == "move")
            op.what = move(e);
        else if (e.name == "rotateaxis")
            op.what = turn(e);
        else if (e.name == "velmesh" || e.name == "densitymesh")
            op.what = mesh(e);
        else if (e.name == "moverandom")
            op.what = random_move(e);
        else
            read_.fail_unknown_element(
                e, "initials",
                {"velocity", "velwave", "velmesh", "densityuniform", "densitygradient",
                 "densitydepth", "densitymesh", "move", "moverandom", "rotateaxis"});
        const bool moves = std::holds_alternative<MoveParticles>(op.what);
        op.mk = mk(e, moves);
        op.only = read_only_pos(e, read_);
        return op;
    }

private:
    std::uint16_t mk(const Element& e, bool may_be_bound) const
    {
        const bool is_bound = e.find_attribute("mkbound") != nullptr;
        const bool is_fluid = e.find_attribute("mkfluid") != nullptr;
        if (is_bound && !may_be_bound)
            read_.fail(e, "mkbound is not possible here, only fluid can have such values");
        if (is_bound == is_fluid)
            read_.fail(e, is_bound       ? "mkbound and mkfluid are given, expected one of them"
                          : may_be_bound ? "attribute 'mkbound' or 'mkfluid' is missing"
                                         : "attribute 'mkfluid' is missing");
        const int number = read_.integer(e, is_bound ? "mkbound" : "mkfluid", 0, 65000, true);
        const int first = is_bound ? def_.mk_bound_first : def_.mk_fluid_first;
        // Numbers beyond those of <mkconfig> name nothing; 0 is the mk of no particle.
        const int count = is_bound ? def_.mkbound_count : def_.mkfluid_count;
        const bool exists = number < count;
        if (!exists)
            warnings_.push_back(fmt::format(
                "{}:{}: <{}>: there is no mk{} {}, so it has no effect; <mkconfig> has 0 to {}. "
                "GenCase takes a mkfluid beyond them for a boundary.",
                read_.file(), e.line, e.name, is_bound ? "bound" : "fluid", number, count - 1));
        return exists ? static_cast<std::uint16_t>(number + first) : std::uint16_t{0};
    }

    InitialVariant velocity(const Element& e) const
    {
        require_known_children(e, {"onlypos", "direction", "velocity", "velocity2", "velocity3"},
                               read_);
        const Element* direction = e.find_child("direction");
        if (direction == nullptr) return UniformVelocity{read_.vec3(e)};
        const Vec3 along = read_.vec3(*direction);
        const Vec3 unit = norm(along) > 0 ? along / norm(along) : Vec3{};
        std::vector<const Element*> forms;
        for (const char* name : {"velocity", "velocity2", "velocity3"})
            if (const Element* form = e.find_child(name)) forms.push_back(form);
        if (forms.empty())
            read_.fail(e, "the element <velocity> (or <velocity2>, <velocity3>) is missing in it");
        if (forms.size() > 1)
            read_.fail(*forms[1], "only one of velocity, velocity2, velocity3 is possible");
        const Element& form = *forms.front();
        if (form.name == "velocity") return UniformVelocity{read_.number(form, "v") * unit};
        ProfileVelocity profile;
        profile.direction = unit;
        for (const char* suffix : {"", "2", "3"})
        {
            if (form.name == "velocity2" && suffix[0] == '3') break;
            profile.speeds.push_back(read_.number(form, fmt::format("v{}", suffix)));
            profile.z.push_back(read_.number(form, fmt::format("z{}", suffix)));
        }
        for (std::size_t i = 0; i < profile.z.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                if (profile.z[i] == profile.z[j])
                    read_.fail(form, fmt::format("z = {:g} is given twice, expected different "
                                                 "heights",
                                                 profile.z[i]));
        return profile;
    }

    InitialVariant wave(const Element& e) const
    {
        require_known_children(e, {"onlypos"}, read_);
        WaveVelocity wave;
        wave.depth = read_.number(e, "depth");
        wave.height = read_.number(e, "hmaxwave");
        wave.x0 = read_.number(e, "x0");
        wave.is_negative = read_.flag_or(e, "negative", false);
        if (!(wave.depth > 0) || !(wave.height >= 0))
            read_.fail(e, fmt::format("depth=\"{:g}\" hmaxwave=\"{:g}\" is no wave, expected a "
                                      "depth above 0 and a height of at least 0",
                                      wave.depth, wave.height));
        return wave;
    }

    InitialVariant density(const Element& e) const
    {
        require_known_children(e, {"onlypos"}, read_);
        return UniformDensity{read_.number(e, "rhop")};
    }

    InitialVariant gradient(const Element& e) const
    {
        require_known_children(e, {"onlypos", "pos1", "pos2"}, read_);
        const Element& first = read_.child(e, "pos1");
        const Element& second = read_.child(e, "pos2");
        GradientDensity gradient{read_.vec3(first), read_.vec3(second), read_.number(first, "rhop"),
                                 read_.number(second, "rhop")};
        if (gradient.pos1 == gradient.pos2)
            read_.fail(second, "is the same point as <pos1>, expected another one");
        return gradient;
    }

    /// A value of 0 stands for the case's own, as in GenCase v5.4.354 (seen for gravity).
    std::optional<double> own_value(const Element& e, const char* name) const
    {
        const Element* c = e.find_child(name);
        if (c == nullptr) return std::nullopt;
        const double v = read_.number(*c, "value");
        if (!(v >= 0))
            read_.fail(*c, fmt::format("value=\"{:g}\" is invalid, expected more than 0", v));
        return v > 0 ? std::optional(v) : std::nullopt;
    }

    InitialVariant depth(const Element& e) const
    {
        require_known_children(e, {"onlypos", "posswl", "gravity", "rhop0", "gamma", "b"}, read_);
        DepthDensity depth;
        if (const Element* surface = e.find_child("posswl")) depth.surface = read_.vec3(*surface);
        if (const Element* gravity = e.find_child("gravity"))
            if (const Vec3 g = read_.vec3(*gravity); norm(g) > 0) depth.gravity = g;
        depth.rhop0 = own_value(e, "rhop0");
        depth.gamma = own_value(e, "gamma");
        depth.b = own_value(e, "b");
        return depth;
    }

    InitialVariant mesh(const Element& e) const
    {
        const bool is_velocity = e.name == "velmesh";
        if (is_velocity)
            require_known_children(e, {"onlypos", "direction", "meshdata"}, read_);
        else
            require_known_children(e, {"onlypos", "meshdata"}, read_);
        Vec3 direction;
        if (const Element* d = e.find_child("direction")) direction = read_.vec3(*d);
        const bool has_direction = norm(direction) > 0;
        if (has_direction) direction = direction / norm(direction);
        const Element& file = read_.child(e, "meshdata");
        // Only speeds say whether they have a direction of their own; densities never do.
        const bool wants_vector = is_velocity && !magnitude(file);
        if (is_velocity && !wants_vector && !has_direction)
            read_.fail(e, "a <direction> other than zero is missing in it, speeds need one");
        const MeshData data = read_mesh_data(find_file(file), !is_velocity   ? "Rhop"
                                                              : wants_vector ? "Vel"
                                                                             : "VelDir");
        if (data.is_vector != wants_vector)
            read_.fail(file, fmt::format("the file holds {} per node, expected {}",
                                         data.is_vector ? "three numbers" : "one number",
                                         wants_vector ? "three (magnitude is false)" : "one"));
        MeshValues mesh = data.mesh;
        for (int axis = 0; axis < 3; ++axis)
            mesh.origin[axis] += read_.number_or(file, std::string("set") + "xyz"[axis], 0);
        const std::vector<double> numbers =
            values_at_time(data, read_.number_or(file, "initialtime", 0));
        if (!is_velocity)
        {
            mesh.values = numbers;
            return MeshDensity{std::make_shared<MeshValues>(std::move(mesh))};
        }
        const double sign = read_.flag_or(file, "reverse", false) ? -1 : 1;
        const std::size_t width = wants_vector ? 3 : 1;
        MeshVelocity velocity;
        for (int axis = 0; axis < 3; ++axis)
        {
            mesh.values.clear();
            for (std::size_t i = 0; i < numbers.size(); i += width)
            {
                const Vec3 own = wants_vector ? Vec3{numbers[i], numbers[i + 1], numbers[i + 2]}
                                              : numbers[i] * direction;
                const Vec3 v =
                    wants_vector && has_direction ? dot(own, direction) * direction : own;
                mesh.values.push_back(sign * v[axis]);
            }
            velocity.components[static_cast<std::size_t>(axis)] =
                std::make_shared<MeshValues>(mesh);
        }
        return velocity;
    }

    bool magnitude(const Element& file) const
    {
        read_.text(file, "magnitude");
        return read_.flag_or(file, "magnitude", true);
    }

    /// A file in the working directory, as with GenCase, or beside the definition.
    std::string find_file(const Element& e) const
    {
        std::string name = read_.text(e, "file");
        if (std::filesystem::exists(name)) return name;
        const std::filesystem::path beside =
            std::filesystem::path(read_.file()).parent_path() / name;
        if (std::filesystem::exists(beside)) return beside.string();
        throw IoError(
            fmt::format("{}:{}: <{} file=\"{}\">: there is no such file, neither in the "
                        "working directory nor beside the definition",
                        read_.file(), e.line, e.name, name));
    }

    InitialVariant move(const Element& e) const
    {
        require_known_children(e, {}, read_);
        return MoveParticles{translation(read_.vec3(e))};
    }

    InitialVariant random_move(const Element& e) const
    {
        require_known_children(e, {}, read_);
        RandomMove move;
        // Whatever its size, a seed is taken modulo 2^32, as strange ones are by GenCase.
        const double seed = std::trunc(read_.number(e, "randomseed"));
        if (!(std::fabs(seed) < 9e15))
            read_.fail(e, fmt::format("attribute randomseed=\"{}\" is out of range, expected a "
                                      "whole number",
                                      read_.text(e, "randomseed")));
        move.seed = static_cast<std::uint32_t>(static_cast<std::int64_t>(seed));
        const double all = read_.number_or(e, "dpxyz", 0);
        for (int axis = 0; axis < 3; ++axis)
        {
            const double width = read_.number_or(e, std::string("dp") + "xyz"[axis], all);
            if (!(width >= 0))
                read_.fail(e, fmt::format("a displacement of {:g} dp along {} is invalid, expected "
                                          "0 or more",
                                          width, "xyz"[axis]));
            move.width[axis] = def_.grid.is_2d && axis == 1 ? 0 : width * def_.grid.dp;
        }
        return move;
    }

    InitialVariant turn(const Element& e) const
    {
        require_known_children(e, {"axisp1", "axisp2"}, read_);
        const Vec3 p1 = read_.child_vec3(e, "axisp1");
        const Vec3 p2 = read_.child_vec3(e, "axisp2");
        const double angle = read_.number(e, "angle");
        const std::string units = read_.text_or(e, "anglesunits", "degrees");
        if (units != "degrees" && units != "radians")
            read_.fail(e, fmt::format("attribute anglesunits=\"{}\" is invalid, expected degrees "
                                      "or radians",
                                      units));
        // An axis without length turns nothing; the turn is clockwise seen from p2.
        if (p1 == p2) return MoveParticles{};
        return MoveParticles{
            around(p1, rotation(p2 - p1, units == "degrees" ? -radians(angle) : -angle))};
    }

    const CaseDef& def_;
    const AttributeReader& read_;
    std::vector<std::string>& warnings_;
};

} // namespace

std::vector<const Element*> active_children(const Element& list, const AttributeReader& read)
{
    std::vector<const Element*> out;
    for (const Element& e : list.children)
        if (e.kind == Element::Kind::Tag && !e.name.starts_with('_') &&
            read.flag_or(e, "active", true))
            out.push_back(&e);
    return out;
}

void require_known_children(const Element& e, const std::vector<std::string_view>& known,
                            const AttributeReader& read)
{
    for (const Element& c : e.children)
    {
        if (c.kind != Element::Kind::Tag || c.name.starts_with('_')) continue;
        if (std::find(known.begin(), known.end(), c.name) == known.end())
            read.fail_unknown_element(c, e.name, known);
    }
}

PositionFilter read_only_pos(const Element& e, const AttributeReader& read)
{
    PositionFilter filter;
    const Element* only = e.find_child("onlypos");
    if (only == nullptr) return filter;
    require_known_children(*only, {"posmin", "posmax"}, read);
    if (const Element* low = only->find_child("posmin"))
        filter.min = read.vec3_or(*low, filter.min);
    if (const Element* high = only->find_child("posmax"))
        filter.max = read.vec3_or(*high, filter.max);
    return filter;
}

std::vector<InitialOp> read_initials(const Element& list, const CaseDef& def,
                                     const AttributeReader& read,
                                     std::vector<std::string>& warnings)
{
    const InitialsReader reader(def, read, warnings);
    std::vector<InitialOp> out;
    for (const Element* e : active_children(list, read)) out.push_back(reader.read(*e));
    return out;
}

} // namespace fppg
