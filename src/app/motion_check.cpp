#include "app/motion_check.h"

#include "core/finite_number.h"
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
constexpr double border = 0.05; ///< of the solver around all particles, h
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
        if (!def_.vres.is_active() && set_domain())
            for_each_moving(def_.motion, [&](const Element& object, const MotionChain& chain)
                            { check(object, chain); });
        return std::move(found_);
    }

private:
    /// The domain of the solver v5.4: that of all particles and 0.05 h, with what
    /// <simulationdomain> adds. False where old keys of <parameters> give it.
    bool set_domain()
    {
        domain_.min = particles_.pos_min - border * def_.h * Vec3{1, 1, 1};
        domain_.max = particles_.pos_max + border * def_.h * Vec3{1, 1, 1};
        for (const Element& e : def_.execution)
        {
            if (e.name != "parameters") continue;
            if (std::any_of(e.children.begin(), e.children.end(), gives_domain)) return false;
            if (const Element* domain = e.find_child("simulationdomain")) widen_domain(*domain);
        }
        return true;
    }

    static bool gives_domain(const Element& parameter)
    {
        const std::string* key = parameter.find_attribute("key");
        return key != nullptr && (*key == "IncZ" || key->starts_with("DomainFixed") ||
                                  key->starts_with("DomainParticles"));
    }

    void widen_domain(const Element& given)
    {
        const Vec3 size = domain_.max - domain_.min;
        for (const Element& limit : given.children)
            for (int axis = 0; axis < 3; ++axis)
            {
                const std::string* value = limit.find_attribute(std::string(1, "xyz"[axis]));
                if (value == nullptr) continue;
                const bool is_min = limit.name == "posmin";
                double& place = is_min ? domain_.min[axis] : domain_.max[axis];
                place = limit_of(*value, place, is_min ? -size[axis] : size[axis]);
            }
    }

    /// Of "default", "default + 0.5", "default - 10%" or a number.
    ///
    /// size  of the domain without it, negative for the lower end
    static double limit_of(std::string text, double otherwise, double size)
    {
        std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
        constexpr std::string_view word = "default";
        const bool adds = text.starts_with(word);
        if (adds) text.erase(0, std::min(text.size(), word.size() + 1));
        const bool is_percent = text.ends_with('%');
        if (is_percent) text.pop_back();
        const std::optional<double> value = finite_number(text);
        if (!value) return otherwise;
        if (!adds) return *value;
        return otherwise + (is_percent ? *value / 100 * size : std::copysign(*value, size));
    }

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
            "which "
            "ends there: {} from {:g} to {:g}, expected {:g} to {:g} up to TimeMax = {:g} s. That "
            "is "
            "where particles are at the start; give a <simulationdomain> that reaches further "
            "(\"default + 20%\") or shorten the motion",
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
