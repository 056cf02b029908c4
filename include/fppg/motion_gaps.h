#pragma once

#include "fppg/vec.h"

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace fppg
{

struct MotionGapOptions
{
    double dp = 0;                                          ///< metres; 0: that of the definition
    std::vector<std::pair<std::string, std::string>> evars; ///< as -evars: of the generation
    double end = 0;                                         ///< seconds; 0: TimeMax of the case
    /// The parts of no pair move farther against each other between two looks, dp.
    double step_dp = 0.25;
    int most_steps =
        20000; ///< of a pair; longer motions are looked at in larger steps, which is said
    bool finds_passages = true;
    int threads = 1;
};

/// How near the surfaces of two boundary mks come to each other.
struct MkGap
{
    std::uint16_t first = 0; ///< mkbound
    std::uint16_t second = 0;
    std::string first_name; ///< of its draws
    std::string second_name;
    bool moves = false;  ///< against each other
    double least_dp = 0; ///< the least distance, dp; 0 where they overlap
    double time = 0;     ///< seconds, of the least
    Vec3 place;          ///< metres, at that time
    int looks = 0;
    double step_dp = 0; ///< the farthest that they move between two looks, dp
    // Where surfaces cross, or one part is in the solid of the other.
    int overlapping = 0;     ///< looks
    double overlap_time = 0; ///< seconds, of the first
    double depth_dp =
        0; ///< of the deepest corner or middle of a facet below the other's surface, dp
    Vec3 overlap_place;
};

/// A place of a surface in front of which another one is near.
struct NarrowPlace
{
    Vec3 position; ///< metres, at the start
    float gap_dp = 0;
    std::uint16_t mkbound = 0;
};

/// Gaps between parts over the motion of a case, and passages that are narrow at its start.
struct MotionGaps
{
    std::string definition;
    double dp = 0;
    double end = 0;           ///< seconds
    std::vector<MkGap> pairs; ///< by mkbound
    static constexpr std::array<double, 3> widths_dp{2, 3, 4};
    double area = 0;                     ///< of all surfaces that fluid can reach, m2
    std::array<double, 3> narrow_area{}; ///< of it, in front of less than widths_dp, m2
    std::vector<NarrowPlace> places;     ///< in front of less than the last of widths_dp
    double narrowest_dp = 0;             ///< of these; 0: there is none
    Vec3 narrowest_at;
    double resolving_dp = 0; ///< metres: with it 4 particles stand across nine in ten of them
    std::vector<std::string> notes; ///< what could not be judged, whole sentences
};

/// Follows the parts of a case through its motion. Surfaces are those of the draws, before any
/// particle is placed; distances between them are exact to rounding at every look, and the least of
/// a pair is refined between looks to 0.001 dp. Of parts with a <boolean> each counts whole.
///
/// Passages are looked for at the start, a place a dp^2, along the normals of closed surfaces and
/// on both sides of sheets, as far as 4 dp, where fluid of the case could flow to through openings
/// of about two dp.
///
/// definition  Case_Def.xml or Case.xml, its meshes beside it or where it names them
/// throws      CaseError, GeometryError, IoError as the readers
/// returns     the same for any number of threads
/// cost        looks times that of a distance of two meshes: some milliseconds for gears
MotionGaps measure_motion_gaps(const std::string& definition, const MotionGapOptions& options);

/// For people: a table of pairs and one of passages.
std::string to_text(const MotionGaps& gaps);

/// For programs: one JSON object.
std::string to_json(const MotionGaps& gaps);

/// Narrow places as points with arrays Gap (dp) and Mk, legacy VTK.
std::string to_vtk(const MotionGaps& gaps);

} // namespace fppg
