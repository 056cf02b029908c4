#pragma once

#include "fppg/lattice.h"
#include "fppg/vec.h"

#include "meshes/mesh_query.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace fppg
{

/// How far fluid has to go from where it stands, over nodes that no wall has.
class FluidWay
{
public:
    /// first_bound  mks below it are fluid
    FluidWay(const RunField& field, std::uint16_t first_bound);

    /// In dp, to the free cell nearest to a point (within about a cell); infinite where fluid
    /// cannot come. Without fluid it is 0 everywhere.
    double to(const Vec3& p) const;

private:
    std::size_t index(std::int64_t x, std::int64_t y, std::int64_t z) const
    {
        return static_cast<std::size_t>((x * n_[1] + y) * n_[2] + z);
    }

    void mark(std::int64_t x, const Run& run, bool is_bound);
    std::vector<std::size_t> go(const std::vector<std::size_t>& front, std::uint16_t step);

    LatticeGrid grid_;
    std::uint32_t side_ = 1; ///< nodes along the side of a cell
    std::array<std::int64_t, 3> n_{};
    std::vector<std::uint16_t> steps_; ///< from fluid, in cells
    bool has_fluid_ = false;
};

/// The parts of the surfaces of layered walls that fluid can touch.
///
/// Particles in a closed wall thinner than 4 h can look to two sides. Where fluid has a way
/// at least 10 dp longer to one of them, or none, that side counts as dry (the outside of a tank),
/// up to its rim, where the way is not so much longer; so does what another body covers. Everything
/// else is wet.
class WetSurface
{
public:
    /// reach  metres, 2 h
    WetSurface(const RunField& field, std::uint16_t first_bound, double reach, int threads);

    /// Metres, from a point to the nearest wet place; zero where none is within `most`.
    Vec3 vector_from(const Vec3& p, double most) const;
    bool is_empty() const { return query_ == nullptr; }
    /// Some sides are dry, so that the nearest surface is not always the right one.
    bool has_dry_sides() const { return has_dry_sides_; }

    /// Of walls that are wet on both sides and too thin to serve both: the mks with the least
    /// thickness, metres.
    struct ThinWall
    {
        std::uint16_t mk = 0;
        double thickness = 0;
        double area = 0; ///< metres squared, of both sides
    };
    const std::vector<ThinWall>& thin_walls() const { return thin_walls_; }

private:
    struct Piece
    {
        std::array<Vec3, 3> corners;
        Vec3 normal; ///< to the fluid
        std::uint32_t body = 0;
        const WallDepth* exact_wall = nullptr;
        bool is_closed = false;
        char state = 0;
        double thickness = 0;     ///< metres; 0: no other side was found
        bool is_straight = false; ///< the other side is behind it, not aside beyond an edge
        double way = 0;           ///< of fluid to it, dp
        double other_way = 0;     ///< of fluid to the other side

        Vec3 middle() const { return (corners[0] + corners[1] + corners[2]) / 3; }
    };
    /// The wall of a body with layers.
    struct BodyWall
    {
        const WallDepth* depth = nullptr;
        bool is_closed = false;
        Box3 box;
    };
    void cut_pieces(const RunField& field);
    void add_pieces(const Piece& whole, double longest);
    void judge(const RunField& field, const FluidWay& way, int threads);
    static bool is_covered(const Piece& piece, const std::vector<BodyWall>& walls, double dp);
    void compare_sides(Piece& piece, const WallDepth& wall, const FluidWay& way, double dp) const;
    void dry_to_the_rims();
    void dry_along_edges();
    void note_thin_walls(const RunField& field);

    double reach_;
    std::vector<Piece> pieces_;
    std::vector<ThinWall> thin_walls_;
    std::unique_ptr<MeshQuery> query_;
    std::vector<const WallDepth*>
        exact_walls_; ///< per facet of the query: null, or of walls whose surface is exact
    bool has_dry_sides_ = false;
};

} // namespace fppg
