#pragma once

#include "fppg/vec.h"

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fppg
{

/// Particles of one colour, that the legend shows and hides together.
struct ScenePart
{
    std::string label;
    std::string colour; ///< "#rrggbb"
    std::vector<Vec3> positions;
    std::uint16_t mk = 0; ///< absolute; of parts by mk
    /// Where the part is, as maps of its places, at times evenly from 0 to SceneSet::end; empty: it
    /// stands.
    std::vector<Transform> frames{};
};

/// A place that the view marks, in one frame of the motion.
struct SceneMark
{
    std::size_t frame = 0;
    Vec3 place;
    std::string text; ///< what is there
};

struct SceneSet
{
    std::string name;
    double dp = 0; ///< diameter of a particle, metres
    std::vector<ScenePart> parts;
    double end = 0;                  ///< seconds, of the motion; 0: nothing moves
    std::string mark_label{};        ///< what marks mean, for the legend; empty: there are none
    std::size_t frames = 1;          ///< of the marks, at times evenly from 0 to `end`
    std::vector<SceneMark> marks{};  ///< by frames
    std::vector<Vec3> start_marks{}; ///< places without words that are marked at 0 s
};

/// A set as JSON: coordinates of 16 bits in the box of the set, base64, the parts behind one
/// another.
std::string to_json(const SceneSet& set);

/// What can be chosen to be looked at: sets side by side, by their index.
struct SceneView
{
    std::string title;
    std::vector<std::size_t> sets;
    std::vector<std::string> names{}; ///< of the sets in this view; empty: their own
};

/// The 3-D view as a part of a page: particles, controls, and the script that draws them. Without
/// a view, or in a program that was built without the script, a sentence that says so.
///
/// sets  as to_json() writes them
std::string scene_html(const std::vector<std::string>& sets, const std::vector<SceneView>& views);

/// The script of the 3-D view; empty in a program that was built without it.
std::string_view viewer_script();

} // namespace fppg
