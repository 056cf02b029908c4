#include "app/motion_check.h"

#include "particles/initials.h"
#include "particles/motion_path.h"
#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace fppg
{
namespace
{

constexpr int steps = 2000;

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
            const Box3 box = box_of(block);
            if (box.is_empty()) continue;
            for (int step = 1; step <= steps; ++step)
            {
                const double time = end_ * step / steps;
                const std::optional<Transform> place = place_at(chain, time);
                if (!place || leaves(object, box, *place, time)) return;
            }
        }
    }

    Box3 box_of(const ParticleBlock& block) const
    {
        Box3 box;
        const Transform map = motion_of(block);
        for (const ParticleRun& run : block.runs)
        {
            if (run.count == 0) continue;
            const std::uint32_t step = run.is_off_lattice ? 1 : std::max(1U, run.count - 1);
            for (std::uint32_t k = 0; k < run.count; k += step)
                box.add(map(place_in_run(particles_, block, run, k)));
        }
        return box;
    }

    bool leaves(const Element& object, const Box3& box, const Transform& place, double time)
    {
        Box3 now;
        for (unsigned corner = 0; corner < 8; ++corner)
            now.add(place({(corner & 1U) != 0 ? box.max.x : box.min.x,
                           (corner & 2U) != 0 ? box.max.y : box.min.y,
                           (corner & 4U) != 0 ? box.max.z : box.min.z}));
        for (int axis = 0; axis < 3; ++axis)
        {
            // The solver takes what leaves a period in at its other end.
            if ((def_.grid.is_2d && axis == 1) ||
                def_.grid.is_periodic[static_cast<std::size_t>(axis)])
                continue;
            const double room = def_.grid.dp;
            const double low = def_.case_pos_min[axis];
            const double high = def_.case_pos_max[axis];
            if (now.min[axis] >= low - room && now.max[axis] <= high + room) continue;
            found_.push_back(fmt::format(
                "{}:{}: <objreal ref=\"{}\">: by t = {:g} s its box has left the domain: {} from "
                "{:g} to {:g}, expected {:g} to {:g} up to TimeMax = {:g} s; move <pointmin> and "
                "<pointmax>, give a <simulationdomain> or shorten the motion",
                def_.file, object.line, *object.find_attribute("ref"), time, "xyz"[axis],
                now.min[axis], now.max[axis], low, high, end_));
            return true;
        }
        return false;
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
