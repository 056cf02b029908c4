#pragma once

#include "files/bi4_view.h"
#include "files/case_facts.h"
#include "files/vtk_walk.h"
#include "fppg/element.h"
#include "fppg/vec.h"
#include "platform/file_map.h"

#include <array>
#include <bit>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace fppg
{

/// The particles of a result as they lie in its mapped file: nothing is copied, any particle may be
/// asked for at any time and from several threads. For files that memory does not hold.
class ParticleSource
{
public:
    /// name    as read_particles() takes it: a case without extension, or one file
    /// xml     Case.xml of a .bi4; empty: beside it, or, for an output of the solver, CASE.xml by
    ///         its CaseName in its folder and the one above
    /// throws  IoError if there is no such file, or it is not whole or not of a known format;
    ///         CaseError if Case.xml cannot be read
    explicit ParticleSource(const std::string& name, const std::string& xml = {});
    ParticleSource(const ParticleSource&) = delete;
    ParticleSource& operator=(const ParticleSource&) = delete;

    const std::string& path() const { return path_; }
    bool is_bi4() const { return !vtk_; }
    const Bi4View& bi4() const { return bi4_; }
    /// The tree of Case.xml; of a VTK file only where Case.xml lies beside it.
    const std::optional<Element>& xml() const { return xml_; }
    const std::string& xml_path() const { return xml_path_; }
    /// Of Case.xml, metres; 0 where it does not say.
    double dp() const { return facts_.dp; }
    const CaseFacts& facts() const { return facts_; }
    /// Whether positions went through float32.
    bool is_single() const { return is_single_; }
    bool has_ids() const { return is_bi4() || !vtk_->idp.type.empty(); }
    bool has_types() const { return is_bi4() || !vtk_->type.type.empty(); }
    bool has_density() const { return !density_.empty(); }
    bool has_velocity() const { return !velocity_.empty(); }
    bool has_normals() const { return !normals_.empty(); }

    /// FileMap::release() of the file of the particles.
    void release() const { file_->release(); }

    std::size_t size() const { return size_; }
    /// Metres, as the file says: not checked to be finite.
    Vec3 position(std::size_t i) const
    {
        if (is_single_)
        {
            const std::array<float, 3> p = floats(points_, i);
            return {p[0], p[1], p[2]};
        }
        double p[3];
        std::memcpy(p, points_.data() + 24 * i, sizeof p);
        if (vtk_)
            for (int axis = 0; axis < 3; ++axis)
                p[axis] = std::bit_cast<double>(
                    big_endian_at(points_.data() + 24 * i + 8 * static_cast<std::size_t>(axis), 8));
        return {p[0], p[1], p[2]};
    }
    /// Of a .bi4. throws  CaseError if no block of Case.xml holds the id
    const IdRange& range_of(std::size_t i) const;
    /// The index where the file has no ids.
    std::uint32_t id(std::size_t i) const
    {
        if (!vtk_) return little_endian_id(i);
        if (vtk_->idp.type.empty()) return static_cast<std::uint32_t>(i);
        return integer(vtk_->idp, i);
    }
    /// throws  CaseError if no block of Case.xml holds the id, IoError if it is no mk
    std::uint16_t mk(std::size_t i) const;
    /// As ParticleType. throws  as mk()
    std::uint8_t type(std::size_t i) const;
    float density(std::size_t i) const
    {
        float value;
        if (vtk_) return float_at(density_.data() + 4 * i);
        std::memcpy(&value, density_.data() + 4 * i, sizeof value);
        return value;
    }
    std::array<float, 3> velocity(std::size_t i) const { return floats(velocity_, i); }
    /// The way to the boundary's surface; zero for particles beyond the array.
    std::array<float, 3> normal(std::size_t i) const
    {
        if (12 * i + 12 > normals_.size()) return {};
        return floats(normals_, i);
    }

private:
    std::string path_;
    std::unique_ptr<FileMap> file_;
    Bi4View bi4_;
    std::unique_ptr<VtkWalk> vtk_;
    std::string xml_path_;
    std::optional<Element> xml_;
    CaseFacts facts_;
    std::size_t size_ = 0;
    bool is_single_ = false;
    std::string_view points_, density_, velocity_, normals_;

    void open_bi4(const std::string& stem, const std::string& xml);
    void open_vtk(const std::string& path);
    std::uint32_t little_endian_id(std::size_t i) const
    {
        std::uint32_t id;
        std::memcpy(&id, bi4_.idp.data() + 4 * i, sizeof id);
        return id;
    }
    static std::uint32_t integer(const VtkArray& array, std::size_t i)
    {
        const std::size_t width = array.data.size() / array.count;
        return static_cast<std::uint32_t>(big_endian_at(array.data.data() + i * width, width));
    }
    std::array<float, 3> floats(std::string_view data, std::size_t i) const
    {
        std::array<float, 3> out;
        std::memcpy(out.data(), data.data() + 12 * i, sizeof out);
        if (vtk_)
            for (std::size_t c = 0; c < 3; ++c) out[c] = float_at(data.data() + 12 * i + 4 * c);
        return out;
    }
};

} // namespace fppg
