#pragma once

#include "leak/case_solids.h"

#include <cstdint>
#include <set>
#include <vector>

namespace fppg
{

/// What is outside of everything that is drawn, on a lattice of its own.
class ClosedHousing
{
public:
    /// Floods the space around all boundary shapes from outside, past nodes that are nearer than
    /// 0.87 of the spacing to a surface. The spacing is dp, more where the box has more than 2^24
    /// nodes.
    ///
    /// motions  where shapes that move stand
    /// plane_y  of a case in two dimensions; the flood stays in it
    ClosedHousing(const CaseSolids& solids, const MotionOfMk& motions, double dp,
                  const double* plane_y, int threads);

    /// Whether the node nearest to the point is reached from outside.
    bool is_outside(const Vec3& p) const;
    /// The mks of the shapes that the flood comes to; what is within them bounds nothing.
    const std::set<std::uint16_t>& mks() const { return mks_; }

private:
    struct Wall
    {
        const CaseShape* shape = nullptr;
        const RigidMotion* motion = nullptr; ///< none: it stands still
        bool is_near(const Vec3& p, double distance) const;
    };

    void set_lattice(const Box3& box, double dp, const double* plane_y);
    Vec3 place(std::int64_t node) const;
    void flood(const std::vector<Wall>& walls);

    Vec3 origin_;
    double spacing_ = 0;
    std::array<std::int64_t, 3> n_{0, 0, 0};
    std::vector<std::uint8_t> state_; ///< of the nodes: 0 free, 1 near a surface, 2 outside
    std::set<std::uint16_t> mks_;
};

} // namespace fppg
