#include "app/motion_check.h"

#include "casedef/transforms.h"
#include "particles/initials.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace fppg
{
namespace
{

constexpr int steps = 2000;

double number(const Element& e, std::string_view name, double otherwise)
{
    const std::string* text = e.find_attribute(name);
    if (text == nullptr) return otherwise;
    const std::size_t begin = std::min(text->find_first_not_of(" \t+"), text->size());
    double value = otherwise;
    std::from_chars(text->data() + begin, text->data() + text->size(), value);
    return value;
}

Vec3 vector(const Element& e, const char* child)
{
    const Element* c = e.find_child(child);
    if (c == nullptr) return {};
    return {number(*c, "x", 0), number(*c, "y", 0), number(*c, "z", 0)};
}

double child_number(const Element& e, const char* child, const char* name)
{
    const Element* c = e.find_child(child);
    return c == nullptr ? 0 : number(*c, name, 0);
}

/// One movement, from its start to the time t after it, as a map of the places at its start.
Transform moved(const Element& m, double t)
{
    const std::string* units = m.find_attribute("anglesunits");
    const double angle = units != nullptr && *units == "radians" ? 1 : std::numbers::pi / 180;
    const auto turn = [&](double by)
    {
        const Vec3 p1 = vector(m, "axisp1");
        const Vec3 along = vector(m, "axisp2") - p1;
        return norm(along) > 0 ? around(p1, rotation(along, by * angle)) : Transform{};
    };
    const auto circle = [&](double by)
    {
        const Vec3 ref = vector(m, "ref");
        return translation(turn(by)(ref) - ref);
    };
    const auto sine = [&](double ampl, double freq, double phase)
    {
        return ampl * (std::sin(2 * std::numbers::pi * freq * t + phase * angle) -
                       std::sin(phase * angle));
    };
    const double even = child_number(m, "vel", "ang") * t;
    const double faster =
        child_number(m, "velini", "ang") * t + child_number(m, "ace", "ang") * t * t / 2;
    const double swing = sine(child_number(m, "ampl", "v"), child_number(m, "freq", "v"),
                              child_number(m, "phase", "v"));
    if (m.name == "mvrect") return translation(vector(m, "vel") * t);
    if (m.name == "mvrectace")
        return translation(vector(m, "velini") * t + vector(m, "ace") * (t * t / 2));
    if (m.name == "mvrot") return turn(even);
    if (m.name == "mvrotace") return turn(faster);
    if (m.name == "mvrotsinu") return turn(swing);
    if (m.name == "mvcir") return circle(even);
    if (m.name == "mvcirace") return circle(faster);
    if (m.name == "mvcirsinu") return circle(swing);
    if (m.name == "mvrectsinu")
    {
        const Vec3 ampl = vector(m, "ampl");
        const Vec3 freq = vector(m, "freq");
        const Vec3 phase = vector(m, "phase");
        return translation({sine(ampl.x, freq.x, phase.x), sine(ampl.y, freq.y, phase.y),
                            sine(ampl.z, freq.z, phase.z)});
    }
    return {};
}

const Element* movement(const Element& object, const std::string& id)
{
    for (const Element& c : object.children)
    {
        const std::string* own = c.find_attribute("id");
        if (own != nullptr && *own == id && c.name != "begin") return &c;
    }
    return nullptr;
}

/// Where an object is at a time, by its own movements: each `<begin>` starts a chain at its time,
/// the one after it begins where that one left the object. Nothing: a file moves it, or, with
/// mvnull, what stands elsewhere for the solver, such as <wavepaddles>.
std::optional<Transform> place_at(const Element& object, double time)
{
    std::vector<const Element*> begins;
    for (const Element& c : object.children)
        if (c.name == "begin") begins.push_back(&c);
    std::stable_sort(begins.begin(), begins.end(),
                     [](const Element* a, const Element* b)
                     { return number(*a, "start", 0) < number(*b, "start", 0); });
    Transform place;
    for (std::size_t i = 0; i < begins.size(); ++i)
    {
        double now = number(*begins[i], "start", 0);
        double end = std::min(time, number(*begins[i], "finish", time));
        if (i + 1 < begins.size()) end = std::min(end, number(*begins[i + 1], "start", 0));
        const std::string* id = begins[i]->find_attribute("mov");
        // A chain of movements without duration never ends.
        for (int turns = 0; id != nullptr && now < end && turns < 100000; ++turns)
        {
            const Element* m = movement(object, *id);
            if (m == nullptr) break;
            if (m->name.ends_with("file") || m->name == "mvpredef" || m->name == "mvnull")
                return std::nullopt;
            const double duration = number(*m, "duration", 0);
            const double part = duration < 0 ? end - now : std::min(duration, end - now);
            place = moved(*m, part) * place;
            now += std::max(part, 0.0);
            id = m->find_attribute("next");
        }
    }
    return place;
}

class MotionChecker
{
public:
    MotionChecker(const CaseDef& def, const CaseParticles& particles)
        : def_(def), particles_(particles)
    {
        for (const Element& e : def.execution)
            if (e.name == "parameters")
                for (const Element& p : e.children)
                {
                    const std::string* key = p.find_attribute("key");
                    if (key != nullptr && *key == "TimeMax") end_ = number(p, "value", end_);
                }
    }

    std::vector<std::string> run()
    {
        if (!has_own_domain()) follow(def_.motion, {});
        return std::move(found_);
    }

private:
    bool has_own_domain() const
    {
        const auto is_given = [](const Element::Attribute& a)
        { return a.name.size() == 1 && a.value != "default"; };
        for (const Element& e : def_.execution)
        {
            const Element* domain = e.find_child("simulationdomain");
            if (domain == nullptr) continue;
            for (const Element& limit : domain->children)
                if (std::any_of(limit.attributes.begin(), limit.attributes.end(), is_given))
                    return true;
        }
        return false;
    }

    void follow(const Element& e, std::vector<const Element*> above)
    {
        for (const Element& c : e.children)
        {
            if (c.name != "objreal" && c.name != "obj") continue;
            std::vector<const Element*> chain = above;
            chain.push_back(&c);
            if (c.name == "objreal") check(c, chain);
            follow(c, chain);
        }
    }

    void check(const Element& object, const std::vector<const Element*>& chain)
    {
        const auto mkbound = static_cast<int>(number(object, "ref", -1));
        for (const ParticleBlock& block : particles_.blocks)
        {
            if (block.type != ParticleType::Moving || block.mk_type != mkbound) continue;
            const Box3 box = box_of(block);
            if (box.is_empty()) continue;
            for (int step = 1; step <= steps; ++step)
            {
                const double time = end_ * step / steps;
                Transform place;
                for (const Element* o : chain)
                {
                    const std::optional<Transform> own = place_at(*o, time);
                    if (!own) return;
                    place = place * *own;
                }
                if (leaves(object, box, place, time)) return;
            }
        }
    }

    Box3 box_of(const ParticleBlock& block) const
    {
        Box3 box;
        const Transform map = motion_of(block);
        for (const ParticleRun& run : block.runs)
        {
            if (run.count == 0) continue;
            const std::uint32_t step = run.is_off_lattice ? 1 : std::max(1U, run.count - 1);
            for (std::uint32_t k = 0; k < run.count; k += step)
                box.add(map(place_in_run(particles_, block, run, k)));
        }
        return box;
    }

    bool leaves(const Element& object, const Box3& box, const Transform& place, double time)
    {
        Box3 now;
        for (unsigned corner = 0; corner < 8; ++corner)
            now.add(place({(corner & 1U) != 0 ? box.max.x : box.min.x,
                           (corner & 2U) != 0 ? box.max.y : box.min.y,
                           (corner & 4U) != 0 ? box.max.z : box.min.z}));
        for (int axis = 0; axis < 3; ++axis)
        {
            if (def_.grid.is_2d && axis == 1) continue;
            const double room = def_.grid.dp;
            const double low = def_.case_pos_min[axis];
            const double high = def_.case_pos_max[axis];
            if (now.min[axis] >= low - room && now.max[axis] <= high + room) continue;
            found_.push_back(fmt::format(
                "{}:{}: <objreal ref=\"{}\">: by t = {:g} s its box has left the domain: {} from "
                "{:g} to {:g}, expected {:g} to {:g} up to TimeMax = {:g} s; move <pointmin> and "
                "<pointmax>, give a <simulationdomain> or shorten the motion",
                def_.file, object.line, *object.find_attribute("ref"), time, "xyz"[axis],
                now.min[axis], now.max[axis], low, high, end_));
            return true;
        }
        return false;
    }

    const CaseDef& def_;
    const CaseParticles& particles_;
    double end_ = 10;
    std::vector<std::string> found_;
};

} // namespace

std::vector<std::string> check_motion(const CaseDef& def, const CaseParticles& particles)
{
    return MotionChecker(def, particles).run();
}

} // namespace fppg
