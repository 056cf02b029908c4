#pragma once

#include "fppg/lattice.h"
#include "fppg/vec.h"

#include "meshes/mesh_query.h"
#include "meshes/point_grid.h"
#include "normals/fluid_way.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace fppg
{

/// The parts of the surfaces of layered walls that fluid can touch.
///
/// Particles in a closed wall thinner than 4 h can look to two sides. One of them counts as dry
/// where fluid has no way to it, or one that is at least 10 dp longer and
/// - from there it would run out of the domain (the outside of a tank), or
/// - it has to rise 10 dp more, above where it stands (the inside of a boat).
/// The parts that move come to where fluid is: of these a side is dry only where fluid would run
/// out of the domain and from the other side would not (a tank that moves; not the teeth of a
/// gear), or where fluid stands at the other side at the start and the part does not turn over (a
/// gate, a piston, a flap). A dry side goes on up to its rim, where the way is not so much longer,
/// and behind what covers the wet side. What another body, or the layers of a sheet, cover is dry
/// too, and what looks into a closed gap (relax/gap_rows.h) before another body. Everything else is
/// wet.
class WetSurface
{
public:
    struct Setup
    {
        std::uint16_t first_bound = 0; ///< mks below it are fluid
        Vec3 gravity;
        double reach = 0;             ///< metres, 2 h
        std::vector<char> is_moving;  ///< by mk: moves on a given path
        std::vector<char> turns_over; ///< likewise: by more than a right angle
        std::vector<char> floats;     ///< by mk
    };
    WetSurface(const RunField& field, const Setup& setup, int threads);

    /// Metres, from a point to the nearest wet place; zero where none is within `most`.
    Vec3 vector_from(const Vec3& p, double most) const;
    bool is_empty() const { return query_ == nullptr; }
    /// Some sides are dry, so that the nearest surface is not always the right one.
    bool has_dry_sides() const { return has_dry_sides_; }

    /// Walls beside fluid that are too thin: the mks with the least thickness, metres.
    struct ThinWall
    {
        std::uint16_t mk = 0;
        double thickness = 0;
        double area = 0; ///< metres squared, of the wet sides
    };
    /// Wet on both sides, which they cannot serve both.
    const std::vector<ThinWall>& thin_walls() const { return thin_walls_; }
    /// With room for one layer of those for mDBC, which is half a step deep.
    const std::vector<ThinWall>& one_layer_walls() const { return one_layer_walls_; }

private:
    struct Piece
    {
        std::array<Vec3, 3> corners;
        Vec3 normal;            ///< to the fluid
        std::uint32_t wall = 0; ///< in walls_
        std::uint16_t mk = 0;
        bool is_moving = false;
        bool turns_over = false;
        char state = 0;
        double thickness = 0;          ///< metres; 0: no other side was found
        bool is_straight = false;      ///< the other side is behind it, not aside beyond an edge
        bool is_other_covered = false; ///< another wall stands on the other side
        FluidWay::Way way;             ///< of fluid to it
        double other_way = 0;          ///< the length of that to the other side, dp

        Vec3 middle() const { return (corners[0] + corners[1] + corners[2]) / 3; }
        double length() const; ///< of the longest side
        std::array<Piece, 2> halves() const;
    };
    struct Facet
    {
        std::array<Vec3, 3> corners;
        std::size_t first_piece = 0;
    };
    /// A side of a body that has layers.
    struct Wall
    {
        std::uint32_t body = 0;
        const WallDepth* depth = nullptr;
        double deepest = 0; ///< metres, to where its layers end
        double first = 0;   ///< metres, how deep the first of them is
        bool is_closed = false;
        bool is_moving = false;
        bool floats = false;
        Box3 box;
        std::vector<std::uint32_t> near; ///< other bodies' walls that may cover parts of it
    };
    void find_walls(const std::vector<FittedBody>& bodies);
    void cut_pieces(const std::vector<FittedBody>& bodies);
    void add_pieces(const Piece& whole, double longest);
    void find_covered(int threads);
    std::vector<Piece> cut_at_covers(Piece& piece) const;
    void cut_along_border(const Piece& piece, std::vector<Piece>& out) const;
    bool may_cover(const Wall& wall, const Box3& box) const;
    bool may_be_covered(const Piece& piece) const;
    bool is_covered(const Piece& piece, const Vec3& at) const;
    double width_before(const Piece& piece, const Vec3& at) const;
    bool is_closed(const Piece& piece) const { return walls_[piece.wall].is_closed; }
    void judge(const RunField& field, const FluidWay& way, int threads);
    void compare_all_sides(const FluidWay& way, int threads);
    void compare_sides(Piece& piece, const FluidWay& way) const;
    void dry_to_the_rims();
    void dry_beside_dry(int threads);
    void note_thin_walls(const RunField& field);
    void make_query(int threads);

    Setup setup_;
    double reach_;
    double dp_;
    std::vector<Wall> walls_;
    std::vector<Facet> facets_;
    std::vector<Piece> pieces_; ///< of one facet after the other
    PointGrid closed_gaps_;
    std::vector<ThinWall> thin_walls_;
    std::vector<ThinWall> one_layer_walls_;
    std::unique_ptr<MeshQuery> query_;
    std::vector<const WallDepth*>
        exact_walls_; ///< per facet of the query: null, or of walls whose surface is exact
    bool has_dry_sides_ = false;
};

} // namespace fppg
