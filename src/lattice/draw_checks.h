#pragma once

#include "fppg/case_def.h"
#include "fppg/mesh.h"

#include <set>
#include <string>
#include <vector>

namespace fppg
{

/// Looks for diagnostics in draws that GenCase passes over in silence. Each kind of warning comes
/// once a line of the definition, however often a list runs it.
class DrawChecks
{
public:
    DrawChecks(const CaseDef& def, std::vector<std::string>& warnings)
        : def_(def), warnings_(warnings)
    {
    }

    /// A shape by the box around it: a mesh file whose size does not go with that of the domain
    /// (100 times as large, or as small and below 4 dp: a file in other units), a body thinner than
    /// dp, a shape that reaches beyond the nodes of the domain. Not for clipped draws.
    void check_shape(const DrawOp& op, const Box3& bounds);

    /// A file that is to be filled, with open edges, or with parts that face inwards or lie in one
    /// another.
    ///
    /// repairs  of the file as a solid; not looked at for autofill alone
    void check_closed(const SourceRef& source, const MeshFileOp& op, const TriangleSoup& soup,
                      const MeshReport& repairs);

    /// The nodes that a fill added, slab by slab, at the border of the domain.
    void check_fill(const SourceRef& source, const DrawState& state,
                    const std::vector<std::vector<Span>>& nodes);

private:
    enum class Kind
    {
        Size,
        Thin,
        Lost,
        Open,
        Folded,
        Leak,
    };

    bool is_flat(int axis) const
    {
        return (def_.grid.is_2d && axis == 1) || def_.grid.n[static_cast<std::size_t>(axis)] == 1;
    }
    void warn(const SourceRef& source, Kind kind, const std::string& text);

    const CaseDef& def_;
    std::vector<std::string>& warnings_;
    std::set<std::pair<int, Kind>> said_;
};

} // namespace fppg
