#pragma once

#include "fppg/lattice.h"
#include "fppg/vec.h"

#include "nodes/snap.h"

#include <memory>
#include <optional>
#include <vector>

namespace fppg
{

/// An axis and the way along it that is up.
struct UpAxis
{
    int axis = 2;
    bool is_positive = true;

    bool is_z() const { return axis == 2 && is_positive; }
};

/// The way up where gravity is along an axis; nothing where it is not, or there is none.
std::optional<UpAxis> up_axis(const Vec3& gravity);

/// The nodes of a field, without its walls, whose columns along z go upwards: axes are exchanged,
/// and the one that is up is turned round where gravity is along its positive way. Where z is up it
/// is the field itself, which must live as long.
class UpwardField
{
public:
    UpwardField(const RunField& field, const UpAxis& up, int threads);

    const RunField& field() const { return *field_; }
    /// Where a place or a direction, and a node, of the given field are in this one.
    Vec3 turned(const Vec3& p) const;
    Node turned(const Node& node) const;
    /// Back again.
    Vec3 turned_back(const Vec3& p) const;

private:
    std::vector<Run> runs_of_slab(const RunField& field, std::size_t slab) const;

    UpAxis up_;
    int across_ = 0; ///< the axes that become x and y
    int along_ = 1;
    std::int64_t last_ = 0;                  ///< node along the axis that is up
    std::shared_ptr<const RunField> turned_; ///< null: z is up
    const RunField* field_;
};

} // namespace fppg
