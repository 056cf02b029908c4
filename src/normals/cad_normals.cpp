#include "normals/cad_normals.h"

#include "meshes/mesh_library.h"

#include <cmath>
#include <vector>

namespace fppg
{
namespace
{

/// Facets are within 0.01 dp of their surface, about.
constexpr double facet_room_dp = 0.03;

} // namespace

CadNormals::CadNormals(const CaseDef& def, int threads) : room_(facet_room_dp * def.grid.dp)
{
    std::vector<CadSource> sources;
    for (const DrawOp& draw : def.ops)
    {
        const auto* file = shape_as<MeshFileOp>(draw);
        if (file == nullptr || file->reading.format != MeshFormat::Step || !def.meshes ||
            draw.state->mk.kind != MkKind::Bound)
            continue;
        const MeshFile& mesh =
            def.meshes->read(draw.source, file->file, file->reading, threads).mesh;
        sources.push_back({mesh.cad, file->transform});
    }
    if (!sources.empty()) models_ = std::make_unique<CadModels>(std::move(sources), threads);
}

Vec3 CadNormals::exact(const Vec3& particle, const Vec3& to_facet) const
{
    const double length = norm(to_facet);
    if (models_ == nullptr || !(length > 0)) return to_facet;
    const Vec3 start = particle + to_facet;
    const CadRef ref = models_->find(start, to_facet / length, room_);
    if (!ref.is_known() || models_->is_plane(ref)) return to_facet;
    const auto foot = models_->foot(ref, particle, start);
    if (!foot) return to_facet;
    const Vec3 out = foot->point - particle;
    // The face goes on beyond its edges, where no facet is.
    const bool is_there = std::fabs(norm(out) - length) <= room_ &&
                          models_->find(foot->point, foot->normal, room_).is_known();
    return is_there ? out : to_facet;
}

} // namespace fppg
