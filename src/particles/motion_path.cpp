#include "particles/motion_path.h"

#include "core/transforms.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>

namespace fppg
{

double number_or(const Element& e, std::string_view name, double otherwise)
{
    const std::string* text = e.find_attribute(name);
    if (text == nullptr) return otherwise;
    const std::size_t begin = std::min(text->find_first_not_of(" \t+"), text->size());
    double value = otherwise;
    std::from_chars(text->data() + begin, text->data() + text->size(), value);
    return value;
}

namespace
{

Vec3 vector(const Element& e, const char* child)
{
    const Element* c = e.find_child(child);
    if (c == nullptr) return {};
    return {number_or(*c, "x", 0), number_or(*c, "y", 0), number_or(*c, "z", 0)};
}

double child_number(const Element& e, const char* child, const char* name)
{
    const Element* c = e.find_child(child);
    return c == nullptr ? 0 : number_or(*c, name, 0);
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
        return norm(along) > 0 ? around(p1, rotation(along, -by * angle)) : Transform{};
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

std::optional<Transform> own_place_at(const Element& object, double time)
{
    std::vector<const Element*> begins;
    for (const Element& c : object.children)
        if (c.name == "begin") begins.push_back(&c);
    std::stable_sort(begins.begin(), begins.end(),
                     [](const Element* a, const Element* b)
                     { return number_or(*a, "start", 0) < number_or(*b, "start", 0); });
    Transform place;
    for (std::size_t i = 0; i < begins.size(); ++i)
    {
        double now = number_or(*begins[i], "start", 0);
        double end = std::min(time, number_or(*begins[i], "finish", time));
        if (i + 1 < begins.size()) end = std::min(end, number_or(*begins[i + 1], "start", 0));
        const std::string* id = begins[i]->find_attribute("mov");
        // A chain of movements without duration never ends.
        for (int turns = 0; id != nullptr && now < end && turns < 100000; ++turns)
        {
            const Element* m = movement(object, *id);
            if (m == nullptr) break;
            if (m->name.ends_with("file") || m->name == "mvpredef" || m->name == "mvnull")
                return std::nullopt;
            const double duration = number_or(*m, "duration", 0);
            const double part = duration < 0 ? end - now : std::min(duration, end - now);
            place = moved(*m, part) * place;
            now += std::max(part, 0.0);
            id = m->find_attribute("next");
        }
    }
    return place;
}

} // namespace

std::optional<Transform> place_at(const MotionChain& chain, double time)
{
    Transform place;
    for (const Element* object : chain)
    {
        const std::optional<Transform> own = own_place_at(*object, time);
        if (!own) return std::nullopt;
        place = place * *own;
    }
    return place;
}

std::vector<Transform> places_over(const MotionChain& chain, double step, int steps)
{
    std::vector<Transform> out;
    for (int k = 0; k <= steps; ++k)
    {
        const std::optional<Transform> place = place_at(chain, k * step);
        if (!place) return {};
        out.push_back(*place);
    }
    return out;
}

TopSpeed top_speed(const std::vector<Transform>& places, double step,
                   const std::vector<Vec3>& points)
{
    TopSpeed out;
    for (std::size_t k = 1; k < places.size(); ++k)
        for (const Vec3& p : points)
        {
            const double speed = norm(places[k](p) - places[k - 1](p)) / step;
            if (speed > out.speed * (1 + 1e-6)) out = {speed, static_cast<double>(k) * step};
        }
    return out;
}

double time_max(const std::vector<Element>& execution, double otherwise)
{
    double end = otherwise;
    for (const Element& e : execution)
        if (e.name == "parameters")
            for (const Element& p : e.children)
            {
                const std::string* key = p.find_attribute("key");
                if (key != nullptr && *key == "TimeMax") end = number_or(p, "value", end);
            }
    return end;
}

} // namespace fppg
