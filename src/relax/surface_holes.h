#pragma once

#include "relax/slide.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace fppg
{

class SurfaceLayer;

/// A place of a layer that is far from all its particles.
struct SurfaceHole
{
    SlidePlace place;
    double distance = 0;      ///< dp, to the nearest particle
    std::uint32_t beside = 0; ///< that particle
    std::uint32_t row = 0;    ///< of the layer's list, of the particle that it was found from
    bool is_filled = false;   ///< with a particle; or one of those filled leaves no hole here
};

/// Finds the holes of a layer at the corners of its particles' Voronoi cells. A cell is taken in
/// the plane of a facet, and its corner then moved away from the particles on the surface. Places
/// near edges are also found by samples.
class HoleFinder
{
public:
    /// is_out  per particle whether it no longer counts
    /// radius  dp; no surface point is to be farther from a particle
    HoleFinder(const SurfaceLayer& layer, const std::vector<char>& is_out, double radius);

    /// All holes, the farthest from particles first, and which of them are to be filled: each that
    /// is left by those before.
    ///
    /// may_fill    SurfaceLayer::renew()
    /// is_sampled  whether holes far from surface particles are looked for, too
    std::vector<SurfaceHole> find(const std::function<bool(const Vec3&, const Vec3&)>& may_fill,
                                  bool is_sampled) const;

private:
    void find_around(std::size_t row, std::vector<SurfaceHole>& holes) const;
    void find_in_plane(std::size_t row, std::uint32_t facet, std::vector<SurfaceHole>& holes) const;
    Box3 box_of_particles() const;
    std::vector<SlidePlace> sample_facets(bool at_edges) const;
    void find_by_samples(bool at_edges, std::vector<SurfaceHole>& holes) const;
    bool climb(SurfaceHole& hole, std::span<const std::uint32_t> near) const;
    Vec3 nearest_to(SurfaceHole& hole, std::span<const std::uint32_t> near) const;
    bool is_far_from_all(const SurfaceHole& hole) const;
    bool is_neighbour(const SurfaceHole& hole, std::uint32_t particle, const Vec3& offset) const;
    bool is_elsewhere(const Vec3& normal, const Vec3& offset, std::uint32_t particle) const;
    Vec3 offset_to(const SurfaceHole& hole, std::uint32_t particle) const;
    void choose(std::vector<SurfaceHole>& holes) const;

    const SurfaceLayer& layer_;
    const std::vector<char>& is_out_;
    double radius_;
    std::vector<std::uint32_t> row_of_; ///< per particle
};

} // namespace fppg
