#pragma once

#include "fppg/element.h"
#include "fppg/vec.h"

#include <optional>
#include <string_view>
#include <vector>

namespace fppg
{

/// The number of an attribute, blanks and a + before it dropped; `otherwise` where there is none.
double number_or(const Element& e, std::string_view name, double otherwise);

/// An `<objreal>` of `<motion>` and the objects around it, the outermost first.
using MotionChain = std::vector<const Element*>;

/// Where an object of `<motion>` is at a time, as a map of the places at the start: each `<begin>`
/// of an object starts a chain of movements at its time, the one after it begins where that one
/// left the object; an object moves with those around it. Rotations are clockwise seen from axisp2,
/// as in the solver v5.4. Nothing: a file moves it, or, with
/// mvnull, what stands elsewhere for the solver, such as <wavepaddles>.
///
/// time  seconds
std::optional<Transform> place_at(const MotionChain& chain, double time);

/// place_at() at 0, step, 2 step, ... steps * step; empty where one of them is nothing.
std::vector<Transform> places_over(const MotionChain& chain, double step, int steps);

/// Of a body that moves.
struct TopSpeed
{
    double speed = 0; ///< m/s
    double time = 0;  ///< seconds, at the end of the step with it
};

/// The largest mean speed over a step of any of the points.
///
/// places  places_over()
TopSpeed top_speed(const std::vector<Transform>& places, double step,
                   const std::vector<Vec3>& points);

/// The value of TimeMax among the children of `<execution>`, seconds.
double time_max(const std::vector<Element>& execution, double otherwise);

/// Calls visit(object, chain) for every `<objreal>` in `<motion>` or an object, the chain with the
/// objects around it and itself.
template <typename Visit>
void for_each_moving(const Element& e, const Visit& visit, const MotionChain& around = {})
{
    for (const Element& c : e.children)
    {
        if (c.name != "objreal" && c.name != "obj") continue;
        MotionChain chain = around;
        chain.push_back(&c);
        if (c.name == "objreal") visit(c, chain);
        for_each_moving(c, visit, chain);
    }
}

} // namespace fppg
