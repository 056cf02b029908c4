#pragma once

#include "fppg/scene.h"

#include "leak/rigid_motion.h"
#include "leak/solid.h"

#include <map>
#include <string>
#include <vector>

namespace fppg
{

/// Where the shapes of each moving mk stand; a mk without an entry stands still.
using MotionOfMk = std::map<std::uint16_t, RigidMotion>;

/// A drawn shape, or part of a combination.
struct CaseShape
{
    std::string name;
    MkKind kind = MkKind::Bound;
    std::uint16_t mk = 0; ///< absolute
    bool is_filled = false;
    bool is_closed = false;
    std::unique_ptr<Solid> solid;
};

/// What takes part in the sequence of draws: a shape, or a combination of shapes.
struct CaseDraw
{
    std::vector<std::size_t> shapes; ///< the parts of a combination in their order, or one shape
    BooleanNode tree;                ///< of a combination
    bool is_combination = false;
    std::vector<char> stays; ///< per part of a combination
    bool is_judged = true;   ///< fluid in it counts, or what is in it is not solid any more
};

/// The shapes of a case in the order in which they were drawn.
struct CaseSolids
{
    std::vector<CaseShape> shapes;
    std::vector<CaseDraw> draws;
    std::vector<std::string> notes;

    static constexpr std::size_t none = SIZE_MAX;
    /// The shape whose solid the point is in, `none` where it is in none. Later draws win: what is
    /// void or fluid takes from the solid before it, and moves with it.
    std::size_t find(const Vec3& p, const MotionOfMk& motions) const;
};

/// Takes in the shapes that a scene leaves. Points, lines, wires and fills have no inside.
///
/// throws  IoError, GeometryError for mesh files
CaseSolids case_solids(const Scene& scene, int threads);

} // namespace fppg
