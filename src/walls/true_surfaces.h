#pragma once

#include "fppg/scene.h"

#include <string>
#include <vector>

namespace fppg
{

/// Gives walls in layers for mDBC the surface that the case draws for normals. Cases for mDBC draw
/// walls twice: as a surface half a dp before the nodes, which `<norgeometry>` names and normals
/// lead to, and on the nodes. The first is the true surface of the wall (16 of 35 public mDBC
/// cases; on the surface of the nodes CaseDamBreak3D has 3.7 % more fluid). Before the walls are
/// fitted.
///
/// A draw is on the nodes of a surface when half of the area of each is more than 0.05 dp and at
/// most 0.9 dp from the other, and nearly all of the wall at most 2 dp. Draws in other shape files
/// of the run that leave no particles are such surfaces too; shapes that are read from a file of
/// another run, and parts of combinations, are none.
///
/// Where `<norplane>` says the surface of a wall of plane faces, its outermost corners move onto
/// that plane (public mDBC Poiseuille flow: without, the channel is 4 % too wide).
///
/// Corners of walls without such a surface that stand on walls that have one go along with these;
/// of spheres and meshes, which do not, def.hints warns.
///
/// returns  a sentence a draw
/// throws   IoError for mesh files, with their places
std::vector<std::string> draw_true_surfaces(const Scene& scene, int threads, CaseDef& def);

} // namespace fppg
