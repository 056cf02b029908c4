#pragma once

#include "fppg/surface_mesh.h"

#include "meshes/cad_facets.h"
#include "meshes/exact_place.h"
#include "meshes/mesh_query.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace fppg
{

/// A CAD model in its place in the case.
struct CadSource
{
    std::shared_ptr<const CadFacets> facets;
    Transform place; ///< of the file's metres
};

/// A facet of one of several models.
struct CadRef
{
    std::uint32_t source = no_index; ///< no_index: none
    std::uint32_t facet = 0;         ///< of CadFacets
    bool is_known() const { return source != no_index; }
};

/// A place on an exact face.
struct FaceFoot
{
    Vec3 point;
    Vec3 normal; ///< unit, to the side to which the facet looks
};

/// CAD models in a case, asked by places.
class CadModels
{
public:
    /// sources  at least one
    CadModels(std::vector<CadSource> sources, int threads);

    /// The facet on which a point lies that looks along `normal`; none where no facet is within
    /// `reach`, or the nearest one looks elsewhere.
    CadRef find(const Vec3& p, const Vec3& normal, double reach) const;

    /// The place nearest to p on the exact face of a facet; nothing where Newton's method does not
    /// come to rest. The face goes on beyond its edges.
    ///
    /// start   on the facet or near it, from where to look
    std::optional<FaceFoot> foot(const CadRef& ref, const Vec3& p, const Vec3& start) const;

    /// Parameters of the face of a facet at a point of the facet.
    std::array<double, 2> parameters(const CadRef& ref, const Vec3& p) const;
    std::uint32_t face_of(const CadRef& ref) const
    {
        return sources_[ref.source].facets->face[ref.facet];
    }
    bool is_plane(const CadRef& ref) const
    {
        return sources_[ref.source].facets->is_plane[ref.facet] != 0;
    }

private:
    std::array<Vec3, 3> corners(const CadRef& ref) const;

    std::vector<CadSource> sources_;
    std::vector<std::uint32_t> begin_; ///< of the facets of each source in the query
    std::vector<double> sense_;        ///< -1 where the place mirrors
    std::unique_ptr<MeshQuery> query_; ///< over the facets of all sources, in the case
};

/// The exact surface behind the facets of a mesh that was made from CAD models: mended, cut, or
/// combined of them.
class CadSurface
{
public:
    /// mesh     connected; the functions below are given the same one
    /// threads  number of threads; the result does not depend on it
    CadSurface(const SurfaceMesh& mesh, std::vector<CadSource> sources, int threads);

    /// Moves a point on a facet to the exact surface; on an edge between two faces to where both
    /// meet. Corners are exact already.
    ///
    /// is_2d  y stays as it is
    void project(const SurfaceMesh& mesh, Vec3& p, std::uint32_t facet, bool is_2d) const;

    /// The exact face of a facet at the place nearest to p; nothing where there is none.
    std::optional<FaceFoot> foot(const SurfaceMesh& mesh, const Vec3& p, std::uint32_t facet) const;

    /// On an edge between two faces, the mean of their exact normals there; nothing elsewhere.
    std::optional<Vec3> edge_normal(const SurfaceMesh& mesh, const Vec3& p,
                                    std::uint32_t facet) const;

    /// A point seen from the exact surface.
    ///
    /// start    the place of the facets nearest to p, on `facet`
    /// returns  nothing where the facets are exact themselves, or their place is another
    std::optional<ExactPlace> at(const SurfaceMesh& mesh, const Vec3& p, const Vec3& start,
                                 std::uint32_t facet) const;

    /// The same in the plane y = constant of p: seen from the line in which the exact surface meets
    /// it.
    ///
    /// start  the place of that line's chords nearest to p, on `facet`
    std::optional<ExactPlace> in_plane(const SurfaceMesh& mesh, const Vec3& p, const Vec3& start,
                                       std::uint32_t facet) const;

    /// How far facets are from the exact surface, metres.
    double chord() const { return chord_; }
    /// Per edge, the angle between the exact faces on both sides at its middle, radians; below 0
    /// where they are not known.
    const std::vector<float>& bends() const { return bends_; }

private:
    /// Faces that meet at a place of a facet: one or two; none where more meet, or one is unknown.
    struct Meeting
    {
        std::array<CadRef, 2> refs;
        std::array<std::uint32_t, 2> facets{};
        std::size_t count = 0;
    };
    /// room  metres; what is so near to an edge of the facet is on it
    Meeting meeting_at(const SurfaceMesh& mesh, const Vec3& p, std::uint32_t facet,
                       double room) const;
    Meeting across(const SurfaceMesh& mesh, std::uint32_t edge) const;
    /// Whether the exact faces that meet there are planes, as their facets are.
    bool is_flat(const Meeting& meeting) const
    {
        return models_.is_plane(meeting.refs[0]) &&
               (meeting.count == 1 || models_.is_plane(meeting.refs[1]));
    }
    bool is_bent(std::uint32_t edge) const
    {
        return !(bends_[edge] >= 0 && bends_[edge] <= smooth);
    }
    double bend_at(const SurfaceMesh& mesh, std::uint32_t edge) const;
    void measure_chord(const SurfaceMesh& mesh, int threads);
    std::optional<ExactPlace> on_edge(const Meeting& meeting, const Vec3& p,
                                      const Vec3& start) const;

    static constexpr double smooth = 3.14159265358979323846 / 180;

    CadModels models_;
    std::vector<CadRef> refs_; ///< per facet
    std::vector<float> bends_;
    std::vector<std::uint32_t> bent_edge_; ///< per vertex, one that is bent
    std::vector<std::uint8_t> bent_count_; ///< per vertex, up to 255
    double chord_ = 0;
    double size_ = 0; ///< metres: by it rounding is measured
};

/// CadSurface::bends() of a body; empty where it is not of CAD.
inline std::span<const float> bends_of(const std::shared_ptr<const CadSurface>& cad)
{
    return cad != nullptr ? std::span<const float>(cad->bends()) : std::span<const float>();
}

} // namespace fppg
