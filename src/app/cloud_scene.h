#pragma once

#include "fppg/check.h"
#include "fppg/motion_gaps.h"
#include "fppg/read_particles.h"
#include "fppg/render.h"
#include "report/scene.h"

#include <cstdint>
#include <string>
#include <vector>

namespace fppg
{

/// Particles that a report page holds of one result at most.
inline constexpr std::size_t most_in_scene = 200000;

/// Particles of one result that the picture of a page shows at most.
inline constexpr std::size_t most_in_picture = 1500000;

/// The particles of a cloud as a set of the 3-D view, a part an mk, by mk.
SceneSet scene_by_mk(const ParticleCloud& cloud, const std::string& name);

/// Gives the parts that move in a case their places over its motion, which the page plays.
void add_motion(SceneSet& set, const std::vector<MovingBlock>& moving);

/// The times of the frames of a set, seconds.
std::vector<double> frame_times(const SceneSet& set);

/// Marks where parts are nearer than `within_dp` to each other, in each frame, and adds the names
/// of their draws to the legend.
///
/// places  of frame_times()
void add_marks(SceneSet& set, const NearPlaces& places, double within_dp);

} // namespace fppg
