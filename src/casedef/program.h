#pragma once

#include "fppg/case_def.h"

#include "casedef/attributes.h"
#include "casedef/patterns.h"
#include "casedef/variable_commands.h"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace fppg
{

/// More points than any command has.
inline constexpr std::size_t many_points = 100'000'000;

/// Executes the commands of a case into draw operations.
///
/// State (rules O1 to O4, T1 to T4, found by experiment with GenCase v5.4.354):
/// - every transform multiplies the current matrix on the right: the one written last acts first.
///   Points of draws, fills and redraws all go through it
/// - a clip stands at the coordinates written, whatever the matrix is then. Every transform after
///   it, matrixload, matrixreset and stateload too but not matrixsave, puts all clips at their
///   coordinates under the matrix that it leaves; clips defined later begin under that matrix,
///   until clipreset. The point and the tip of the normal are moved, also where the matrix slants
///   (90 random programs and 100 slanted clips, none different)
/// - statesave and stateload do what mksave, matrixsave, dpctessave and their loads do, on the same
///   stacks, and keep draw mode, box limit mode and what is active besides, but not the
///   clips; loading from an empty stack does nothing
/// - mksave and mkload keep mk, mkback and pattern
/// - resetdraw forgets what was drawn and the whole state, matrix, clips and stacks included, but
///   not the pattern
/// - setmknextbound takes the current mkbound + 1 (next="false": - 1), or 0 when the current mk is
///   no bound one; setmknextfluid likewise
///
/// Commands are functions of a program and their element (command_table.h); what several of them
/// need is here.
struct Program
{
    /// patterns  by their names in small letters
    Program(CaseDef& case_def, VariableCommands& variable_commands, const AttributeReader& reader,
            PatternTable named_patterns);

    /// Runs `<mainlist>` of `<commands>`; fills ops, list_log and warnings of the case.
    void run(const Element& commands);
    void run_list(const Element& list, const std::string& name);
    /// Stops lists without an end.
    void count_command(const Element& e);
    /// Refuses calls of a list that would run too many commands, before the first one.
    void expect_few_commands(const Element& e, const Element& list, int times);

    MkValue mk_value(const Element& e, MkKind kind, int mk_type) const;
    void set_mk(const Element& e, MkKind kind, int mk_type);
    void add_clip(const ClipPlane& plane);
    /// Puts the clips where the current matrix moves them.
    void place_clips();
    void put_clips(const Transform& map);

    /// Adds a command of the case with the current state: under setmknextauto part by part.
    void add(const Element& e, Command what);
    void add_whole(const Element& e, Command what);
    /// Under the current matrix.
    void add_polyhedron(const Element& e, PolyhedronOp polyhedron);
    /// Goes on to the next mk, which must exist even where nothing is drawn with it, as for
    /// GenCase.
    void take_next_mk(const Element& e);
    /// The mks that a mesh file goes on by under setmknextauto, one for each part. Single points
    /// are drawn with the first and are no part; then come the lines, each with a part for its
    /// first point and one for every segment, then the polygons in the order of the file: triangles
    /// and quads, wider ones as their triangles; in wire mode the sides of these. `advanced` draws
    /// none of them and has no lines, but counts the polygons. What autofill or advanced add is
    /// drawn with the mk that comes next, which stays (30 draws of STL, PLY and VTK files in every
    /// mode, on and off the lattice, in GenCase v5.4.354 and where it can v5.0, none different).
    std::uint32_t count_file_parts(const Element& e, const MeshFileOp& op) const;

    std::vector<Vec3> points_of(const Element& e, std::size_t at_least, std::size_t at_most) const;
    std::vector<Vec3> transformed_points(const Element& e, std::size_t at_least,
                                         std::size_t at_most) const;
    PolyhedronOp polyhedron_of(const Element& e) const;
    BoxRegion box_of(const Element& e) const;
    BoxRegion limit_box_of(const Element& e, bool with_limits) const;
    /// The same under the current matrix.
    BoxLimits limits_of(const Element& e, bool with_limits) const;
    /// Keeps the box of a fill or redraw for its picture. What resetdraw has forgotten stays until
    /// the command comes again.
    void keep_debug_box(const Element& e, bool with_limits, std::optional<Vec3> seed);
    /// throws CaseError where it is missing
    bool flag_of(const Element& e, std::string_view name) const;
    /// One number of `layers vdp`.
    struct Layer
    {
        double dp = 0;
        bool is_shown = true; ///< in shape files: with a star, or all where none has one
    };
    /// The outermost first.
    std::vector<Layer> layers_of(const Element& e) const;
    /// A polyhedron that stands for a layer.
    void add_layer(const Element& e, PolyhedronOp polyhedron, bool is_shown);
    /// The shape whose shells are added next, and no shape after the last.
    std::shared_ptr<const Shape> surface;
    std::shared_ptr<const Shape> inner_surface; ///< DrawOp::inner_surface, likewise
    /// The same of a polyhedron, under the current matrix.
    std::shared_ptr<const Shape> surface_of(PolyhedronOp polyhedron) const;
    /// throws CaseError where it is not above 0
    double radius_of(const Element& e) const;
    /// The box around a cube that the matrix has moved.
    Box3 moved_cube(const Vec3& center, double radius) const;
    /// throws CaseError for a layer without a radius
    void check_layers(const Element& e, double radius, const std::vector<Layer>& layers) const;
    std::vector<int> mask_of(const Element& e) const;
    std::optional<std::uint16_t> absolute_mk(const Element& e, const char* attribute,
                                             MkKind kind) const;
    /// Fails where an attribute names no mk of this kind.
    void check_mk(const Element& e, const char* attribute, MkKind kind) const;
    /// Sides by words, in the order of BoxSide; solid stands for all of them, whatever else is
    /// there.
    struct BoxSides
    {
        std::array<bool, 6> sides{};
        bool is_solid = false;
    };
    BoxSides box_sides(const Element& e, const Element& list) const;

    CaseDef& def;
    VariableCommands& variables;
    const AttributeReader& read;
    PatternTable patterns;
    std::map<std::string, const Element*> lists;
    DrawState state;
    std::shared_ptr<const DrawState> shared_state; ///< of the last draw
    Transform matrix;
    std::vector<ClipPlane> defined_clips; ///< as written
    Transform clip_matrix;                ///< of the last transform that found a clip
    /// Where `drawlineto` begins, before the matrix: at first and after `resetdraw` <pointmin>,
    /// then the last place of setlinebegin, drawline, drawlines, drawlineto (14 cases in GenCase
    /// v5.0).
    Vec3 line_begin;
    std::vector<DrawState> saved_states; ///< without mks, pattern, constants, clips
    std::vector<Transform> saved_matrices;
    /// mk, mk_back, pattern
    std::vector<std::tuple<MkValue, std::optional<MkValue>, std::shared_ptr<const DrawPattern>>>
        saved_mks;
    std::vector<DrawConstants> saved_constants;
    bool is_large_mk_known = false;     ///< a warning named an mk that GenCase v5.4 refuses
    std::size_t pictures_forgotten = 0; ///< this many pictures are older than the last resetdraw
    /// fppg's own commands that were run, which GenCase refuses, with the lines of the first ones.
    std::map<std::string, int> own_commands;
    int list_depth = 0;
    std::size_t commands_run = 0;

private:
    std::map<const Element*, double> commands_in_lists_;

    double least_commands_in(const Element& list);
    void run_command(const Element& e);
    bool has_quads_move_clips(const PolyhedronOp& polyhedron) const;
    /// GenCase v5.4.354 resets the matrix while it looks for where a quad off the lattice, or a
    /// solid box, meets the plane of a 2D case, and then puts it back, with all clips: particles
    /// there are clipped by the clips as written, and all that comes later by those under the
    /// matrix, a quad in the plane too (17 shapes of one case; a quad that does not meet the plane
    /// counts).
    void add_between_clips(const Element& e, PolyhedronOp polyhedron);
    /// Under setmknextauto: every part is drawn with the mk after that of the part before.
    void add_in_parts(const Element& e, Shape shape);
    void add_polyhedron_in_parts(const Element& e, PolyhedronOp polyhedron);
};

/// A clip under a matrix.
ClipPlane placed_clip(const ClipPlane& plane, const Transform& map);

} // namespace fppg
