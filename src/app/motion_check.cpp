#include "app/motion_check.h"

#include "particles/initials.h"
#include "particles/motion_path.h"
#include "particles/run_positions.h"
#include "particles/simulation_domain.h"

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
        end_ = time_max(def.execution, end_);
    }

    std::vector<std::string> run()
    {
        const std::optional<Box3> domain =
            def_.vres.is_active() ? std::nullopt : solver_domain(def_, particles_);
        if (!domain) return {};
        domain_ = *domain;
        for_each_moving(def_.motion, [&](const Element& object, const MotionChain& chain)
                        { check(object, chain); });
        return std::move(found_);
    }

private:
    void check(const Element& object, const MotionChain& chain)
    {
        const auto mkbound = static_cast<int>(number_or(object, "ref", -1));
        for (const ParticleBlock& block : particles_.blocks)
        {
            if (block.type != ParticleType::Moving || block.mk_type != mkbound) continue;
            const std::vector<Vec3> places = ends_of_runs(block);
            if (places.empty()) continue;
            const std::array<Vec3, 8> around = box_around(places, {}).corners();
            const std::vector<Vec3> corners(around.begin(), around.end());
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

    static Box3 box_around(const std::vector<Vec3>& places, const Transform& place)
    {
        Box3 box;
        for (const Vec3& p : places) box.add(place(p));
        return box;
    }

    /// An axis along which a box is not in the domain.
    std::optional<int> axis_left(const Box3& box) const
    {
        for (int axis = 0; axis < 3; ++axis)
        {
            // The solver takes what leaves a period in at its other end.
            if ((def_.grid.is_2d && axis == 1) ||
                def_.grid.is_periodic[static_cast<std::size_t>(axis)])
                continue;
            if (box.min[axis] < domain_.min[axis] || box.max[axis] > domain_.max[axis]) return axis;
        }
        return std::nullopt;
    }

    void note(const Element& object, double time, int axis, const Box3& box)
    {
        found_.push_back(fmt::format(
            "{}:{}: <objreal ref=\"{}\">: by t = {:.3g} s it has left the domain of the solver, "
            "which ends there: {} from {:g} to {:g}, expected {:g} to {:g} up to TimeMax = {:g} s. "
            "That is where particles are at the start; give a <simulationdomain> that reaches "
            "further (\"default + 20%\") or shorten the motion",
            def_.file, object.line, *object.find_attribute("ref"), time, "xyz"[axis], box.min[axis],
            box.max[axis], domain_.min[axis], domain_.max[axis], end_));
    }

    const CaseDef& def_;
    const CaseParticles& particles_;
    Box3 domain_;
    double end_ = 10;
    std::vector<std::string> found_;
};

} // namespace

std::vector<std::string> check_motion(const CaseDef& def, const CaseParticles& particles)
{
    return MotionChecker(def, particles).run();
}

} // namespace fppg
