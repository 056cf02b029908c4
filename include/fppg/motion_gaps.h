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
    // Particles of the case at its dp, estimated; 0: unknown.
    double volume_particles = 0;    ///< fluid and floating bodies
    double wall_particles = 0;      ///< their number grows with the area
    std::vector<std::string> notes; ///< what could not be judged, whole sentences

    /// How many times as many particles of fluid the case has with `resolving_dp`; 1 where its dp
    /// does.
    double resolving_factor() const;
};

/// Two boundary mks that are near each other at a time.
struct NearPlace
{
    std::size_t look = 0; ///< index of the time
    Vec3 place;           ///< metres, at that time
    double gap_dp = 0;    ///< 0 where they overlap
    std::uint16_t first = 0;
    std::uint16_t second = 0;
};

/// Where parts of a case are near each other at some times: to be drawn.
struct NearPlaces
{
    std::vector<NearPlace> places;   ///< by times, then by mkbound
    std::vector<NarrowPlace> narrow; ///< of passages at the start, nearer than asked for
    std::vector<std::pair<std::uint16_t, std::string>> names; ///< of draws, by mkbound
    std::uint16_t mk_bound_first = 0;                         ///< absolute mk of mkbound 0
    std::vector<std::string> notes;
};

/// Follows the parts of a case through its motion. Surfaces are those of the draws, before any
/// particle is placed; distances between them are exact to rounding at every look, and the least of
/// a pair is refined between looks to 0.001 dp. Of parts with a <boolean> each counts whole.
///
/// Passages are looked for at the start, a place a dp^2, along the normals of closed surfaces and
/// on both sides of sheets, as far as 4 dp, where fluid of the case could flow to through openings
/// of about two dp, and through narrower passages from there on.
///
/// definition  Case_Def.xml or Case.xml, its meshes beside it or where it names them
/// throws      CaseError, GeometryError, IoError as the readers
/// returns     the same for any number of threads
/// cost        looks times that of a distance of two meshes: some milliseconds for gears
MotionGaps measure_motion_gaps(const std::string& definition, const MotionGapOptions& options);

/// The place where every two mks are nearest at each of some times, if that is within a gap. Parts
/// that touch and keep their places are left out: they are one body.
///
/// times      seconds
/// within_dp  the gap, at most 4 dp
/// throws     as measure_motion_gaps()
NearPlaces find_near_places(const std::string& definition, const MotionGapOptions& options,
                            const std::vector<double>& times, double within_dp);

/// For people: a table of pairs and one of passages.
std::string to_text(const MotionGaps& gaps);

/// For programs: one JSON object.
std::string to_json(const MotionGaps& gaps);

/// Narrow places as points with arrays Gap (dp) and Mk, legacy VTK.
std::string to_vtk(const MotionGaps& gaps);

} // namespace fppg
