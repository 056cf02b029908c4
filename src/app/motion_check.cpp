#include "app/motion_check.h"

#include "particles/initials.h"
#include "particles/motion_path.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <vector>

namespace fppg
{
namespace
{

constexpr int steps = 2000;
/// Places of particles that are followed, times steps: of larger bodies fewer steps are looked at.
constexpr std::size_t most_places = 40'000'000;

class MotionChecker
{
public:
    MotionChecker(const CaseDef& def, const CaseParticles& particles)
        : def_(def), particles_(particles)
    {
        for (const Element& e : def.execution)
            if (e.name == "parameters")
                for (const Element& p : e.children)
                {
                    const std::string* key = p.find_attribute("key");
                    if (key != nullptr && *key == "TimeMax") end_ = number_or(p, "value", end_);
                }
    }

    std::vector<std::string> run()
    {
        if (!has_own_domain())
            for_each_moving(def_.motion, [&](const Element& object, const MotionChain& chain)
                            { check(object, chain); });
        return std::move(found_);
    }

private:
    bool has_own_domain() const
    {
        const auto is_given = [](const Element::Attribute& a)
        { return a.name.size() == 1 && a.value != "default"; };
        for (const Element& e : def_.execution)
        {
            const Element* domain = e.find_child("simulationdomain");
            if (domain == nullptr) continue;
            for (const Element& limit : domain->children)
                if (std::any_of(limit.attributes.begin(), limit.attributes.end(), is_given))
                    return true;
        }
        return false;
    }

    void check(const Element& object, const MotionChain& chain)
    {
        const auto mkbound = static_cast<int>(number_or(object, "ref", -1));
        for (const ParticleBlock& block : particles_.blocks)
        {
            if (block.type != ParticleType::Moving || block.mk_type != mkbound) continue;
            const std::vector<Vec3> places = ends_of_runs(block);
            if (places.empty()) continue;
            const std::vector<Vec3> corners = corners_around(places);
            // What turns within the domain stays there, though corners of its box leave it.
            const auto stride = static_cast<int>(places.size() * steps / most_places) + 1;
            for (int step = 1; step <= steps; ++step)
            {
                const double time = end_ * step / steps;
                const std::optional<Transform> place = place_at(chain, time);
                if (!place) return;
                if (!axis_left(box_around(corners, *place))) continue;
                if (step % stride != 0 && step != steps) continue;
                const Box3 box = box_around(places, *place);
                if (const std::optional<int> axis = axis_left(box))
                {
                    note(object, time, *axis, box);
                    return;
                }
            }
        }
    }

    /// The convex hull of a block is that of these.
    std::vector<Vec3> ends_of_runs(const ParticleBlock& block) const
    {
        std::vector<Vec3> places;
        const Transform map = motion_of(block);
        for (const ParticleRun& run : block.runs)
        {
            if (run.count == 0) continue;
            const std::uint32_t step = run.is_off_lattice ? 1 : std::max(1U, run.count - 1);
            for (std::uint32_t k = 0; k < run.count; k += step)
                places.push_back(map(place_in_run(particles_, block, run, k)));
        }
        return places;
    }

    static std::vector<Vec3> corners_around(const std::vector<Vec3>& places)
    {
        Box3 box;
        for (const Vec3& p : places) box.add(p);
        std::vector<Vec3> corners;
        for (unsigned corner = 0; corner < 8; ++corner)
            corners.push_back({(corner & 1U) != 0 ? box.max.x : box.min.x,
                               (corner & 2U) != 0 ? box.max.y : box.min.y,
                               (corner & 4U) != 0 ? box.max.z : box.min.z});
        return corners;
    }

    static Box3 box_around(const std::vector<Vec3>& places, const Transform& place)
    {
        Box3 box;
        for (const Vec3& p : places) box.add(place(p));
        return box;
    }

    /// An axis along which a box is not in the domain.
    std::optional<int> axis_left(const Box3& box) const
    {
        const double room = def_.grid.dp;
        for (int axis = 0; axis < 3; ++axis)
        {
            // The solver takes what leaves a period in at its other end.
            if ((def_.grid.is_2d && axis == 1) ||
                def_.grid.is_periodic[static_cast<std::size_t>(axis)])
                continue;
            if (box.min[axis] < def_.case_pos_min[axis] - room ||
                box.max[axis] > def_.case_pos_max[axis] + room)
                return axis;
        }
        return std::nullopt;
    }

    void note(const Element& object, double time, int axis, const Box3& box)
    {
        found_.push_back(fmt::format(
            "{}:{}: <objreal ref=\"{}\">: by t = {:g} s it has left the domain: {} from {:g} to "
            "{:g}, expected {:g} to {:g} up to TimeMax = {:g} s; move <pointmin> and <pointmax>, "
            "give a <simulationdomain> or shorten the motion",
            def_.file, object.line, *object.find_attribute("ref"), time, "xyz"[axis], box.min[axis],
            box.max[axis], def_.case_pos_min[axis], def_.case_pos_max[axis], end_));
    }

    const CaseDef& def_;
    const CaseParticles& particles_;
    double end_ = 10;
    std::vector<std::string> found_;
};

} // namespace

std::vector<std::string> check_motion(const CaseDef& def, const CaseParticles& particles)
{
    return MotionChecker(def, particles).run();
}

} // namespace fppg
