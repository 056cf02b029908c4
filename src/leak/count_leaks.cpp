#include "leak/leak.h"

#include "fppg/case_def.h"
#include "fppg/error.h"

#include "core/parallel.h"
#include "files/case_facts.h"
#include "files/particle_source.h"
#include "leak/case_solids.h"
#include "leak/closed_housing.h"
#include "leak/part_file.h"
#include "meshes/mesh_library.h"

#include <fmt/format.h>
#include <algorithm>
#include <set>

namespace fppg
{

namespace
{

constexpr double farthest_off_dp = 0.05; // of a rigid body's particles, dp
constexpr std::size_t particles_per_chunk = 256;

class LeakCounter
{
public:
    LeakCounter(const std::string& case_name, const LeakOptions& options)
        : source_(case_name), options_(options)
    {
        if (!source_.is_bi4() || !source_.xml())
            throw IoError(
                fmt::format("'{}': expected a case, of which Case.xml and Case.bi4 were "
                            "given to the solver",
                            case_name));
        facts_ = case_facts(*source_.xml(), source_.xml_path());
        read_definition();
        solids_ = case_solids(make_scene(def_), options_.threads);
        report_.case_name = case_name;
        report_.dp = def_.grid.dp;
        report_.notes = solids_.notes;
        judge_shells();
        find_housing();
        list_bodies();
    }

    LeakReport run(const std::vector<std::string>& parts)
    {
        std::vector<std::pair<double, std::string>> files;
        for (const std::string& path : part_files(parts))
            files.emplace_back(PartFile(path).time(), path);
        std::sort(files.begin(), files.end());
        for (const auto& file : files) count(PartFile(file.second));
        return std::move(report_);
    }

private:
    ParticleSource source_;
    LeakOptions options_;
    CaseFacts facts_;
    CaseDef def_;
    CaseSolids solids_;
    std::optional<ClosedHousing> housing_;
    std::vector<std::size_t> body_of_; ///< per shape, CaseSolids::none where it is no body
    std::vector<Vec3> fluid_;          ///< of the case
    LeakReport report_;
    std::set<std::uint16_t> told_; ///< mks that do not move as rigid bodies
    bool is_open_told_ = false;    ///< that the housing opens

    void read_definition()
    {
        CaseOptions options;
        if (source_.dp() > 0) options.dp = source_.dp();
        options.evars = options_.evars;
        const std::string& path =
            options_.definition.empty() ? source_.xml_path() : options_.definition;
        // The meshes that the case was made with.
        options.meshes = std::make_shared<MeshLibrary>(path, MeshPlaces::DefinitionFirst);
        def_ = read_case(path, options);
        if (!def_.vres.zones.empty())
            throw CaseError(path, 0,
                            "the case has variable resolution, which is not supported; expected a "
                            "case of one resolution");
    }

    /// The type of a particle; what no block has is new fluid of the solver's inlets.
    ParticleType type_of(std::uint32_t id) const
    {
        const IdRange* range = find_range(facts_.ranges, id);
        return range == nullptr ? ParticleType::Fluid : range->type;
    }

    /// Shells that hold fluid at the beginning bound it; open ones bound nothing by themselves.
    void judge_shells()
    {
        for (std::size_t i = 0; i < source_.size(); ++i)
            if (type_of(source_.id(i)) == ParticleType::Fluid)
                fluid_.push_back(source_.position(i));
        report_.fluid = fluid_.size();
        std::vector<std::string> open;
        for (CaseDraw& draw : solids_.draws)
        {
            if (draw.is_combination) continue;
            const CaseShape& shape = solids_.shapes[draw.shapes.front()];
            if (shape.is_filled) continue;
            draw.is_judged = shape.is_closed &&
                             std::none_of(fluid_.begin(), fluid_.end(),
                                          [&](const Vec3& p) { return shape.solid->is_inside(p); });
            if (!shape.is_closed) open.push_back(shape.name);
        }
        if (!open.empty())
            report_.notes.push_back(
                fmt::format("Open surfaces have no inside: {}.", fmt::join(open, ", ")));
    }

    ClosedHousing housing_at(const MotionOfMk& motions) const
    {
        const double plane_y = def_.grid.origin.y;
        return {solids_, motions, def_.grid.dp, def_.grid.is_2d ? &plane_y : nullptr,
                options_.threads};
    }

    void find_housing()
    {
        housing_.emplace(housing_at({}));
        report_.has_housing =
            !fluid_.empty() && std::none_of(fluid_.begin(), fluid_.end(),
                                            [&](const Vec3& p) { return housing_->is_outside(p); });
    }

    /// Whether each place is outside the housing; empty where there is none at that time.
    std::vector<char> outside_housing(const std::vector<Vec3>& places, const MotionOfMk& motions,
                                      const std::set<std::uint16_t>& given_up, double time)
    {
        if (!report_.has_housing) return {};
        const std::set<std::uint16_t>& mks = housing_->mks();
        const auto is_of_housing = [&](std::uint16_t mk) { return mks.contains(mk); };
        if (std::any_of(given_up.begin(), given_up.end(), is_of_housing)) return {};
        const bool moves =
            std::any_of(motions.begin(), motions.end(),
                        [&](const auto& motion) { return mks.contains(motion.first); });
        const bool moves_as_one = moves && mks.size() == 1;
        std::optional<ClosedHousing> moved;
        if (moves && !moves_as_one) moved.emplace(housing_at(motions));
        const ClosedHousing& housing = moved ? *moved : *housing_;
        std::vector<char> is_out(places.size(), 0);
        parallel_for(
            places.size(), options_.threads,
            [&](std::size_t k)
            {
                const Vec3 p =
                    moves_as_one ? motions.at(*mks.begin()).backward(places[k]) : places[k];
                is_out[k] = housing.is_outside(p) ? 1 : 0;
            },
            particles_per_chunk);
        const auto out = static_cast<std::size_t>(std::count(is_out.begin(), is_out.end(), 1));
        if (!moved || 2 * out <= places.size()) return is_out;
        if (!is_open_told_)
            report_.notes.push_back(
                fmt::format("The housing is open at {:g} s: most of the fluid can be reached from "
                            "outside. What is outside is not counted at such times.",
                            time));
        is_open_told_ = true;
        return {};
    }

    void list_bodies()
    {
        body_of_.assign(solids_.shapes.size(), CaseSolids::none);
        for (const CaseDraw& draw : solids_.draws)
        {
            if (!draw.is_judged) continue;
            for (const std::size_t s : draw.shapes)
            {
                const CaseShape& shape = solids_.shapes[s];
                if (shape.kind != MkKind::Bound) continue;
                body_of_[s] = report_.bodies.size();
                const auto range = std::find_if(facts_.ranges.begin(), facts_.ranges.end(),
                                                [&](const IdRange& r) { return r.mk == shape.mk; });
                report_.bodies.push_back(
                    {shape.name, shape.mk,
                     range == facts_.ranges.end() ? ParticleType::Fixed : range->type});
            }
        }
    }

    /// The motion of every moving mk; one that is not rigid has none and is in `given_up`.
    MotionOfMk motions_of(const PartFile& part, std::set<std::uint16_t>& given_up)
    {
        std::map<std::uint16_t, std::pair<std::vector<Vec3>, std::vector<Vec3>>> places;
        for (std::size_t i = 0; i < part.size(); ++i)
        {
            const IdRange* range = find_range(facts_.ranges, part.id(i));
            if (range == nullptr || range->type == ParticleType::Fluid) continue;
            const std::uint32_t id = part.id(i);
            if (id >= source_.size() || source_.id(id) != id)
                throw CaseError(
                    fmt::format("'{}' is not an output of '{}': particle {} is not at "
                                "its place in the case",
                                part.path(), report_.case_name, id));
            if (range->type == ParticleType::Fixed) continue;
            auto& [from, to] = places[range->mk];
            from.push_back(source_.position(id));
            to.push_back(part.position(i));
        }
        MotionOfMk motions;
        for (const auto& [mk, of_mk] : places)
        {
            RigidMotion motion = fit_rigid_motion(of_mk.first, of_mk.second);
            if (motion.farthest <= farthest_off_dp * report_.dp)
            {
                motions.emplace(mk, motion);
                continue;
            }
            given_up.insert(mk);
            if (told_.insert(mk).second)
                report_.notes.push_back(
                    fmt::format("mk {} does not move as a rigid body ({:.3g} dp off at {:g} s) and "
                                "is left out at that time.",
                                mk, motion.farthest / report_.dp, part.time()));
        }
        return motions;
    }

    void count(const PartFile& part)
    {
        LeakInstant instant;
        instant.file = part.path();
        instant.time = part.time();
        instant.step = static_cast<std::uint64_t>(part.value("Step", 0));
        instant.dt_least = part.value("dtmin", 0);
        instant.dt_largest = part.value("dtmax", 0);
        instant.in_body.assign(report_.bodies.size(), 0);
        std::set<std::uint16_t> given_up;
        const MotionOfMk motions = motions_of(part, given_up);
        std::vector<Vec3> fluid;
        for (std::size_t i = 0; i < part.size(); ++i)
            if (type_of(part.id(i)) == ParticleType::Fluid) fluid.push_back(part.position(i));
        std::vector<std::size_t> in(fluid.size(), CaseSolids::none);
        std::vector<char> is_in_solid(fluid.size(), 0);
        std::vector<double> depth(fluid.size(), 0);
        const auto judge = [&](std::size_t k)
        {
            const std::size_t s = solids_.find(fluid[k], motions);
            if (s == CaseSolids::none) return;
            is_in_solid[k] = 1;
            const CaseShape& shape = solids_.shapes[s];
            const auto motion = motions.find(shape.mk);
            const Vec3 before =
                motion == motions.end() ? fluid[k] : motion->second.backward(fluid[k]);
            depth[k] = shape.solid->distance(before) / report_.dp;
            if (depth[k] > options_.tolerance_dp && !given_up.contains(shape.mk)) in[k] = s;
        };
        parallel_for(fluid.size(), options_.threads, judge, particles_per_chunk);
        instant.fluid = fluid.size();
        const auto known =
            static_cast<std::uint64_t>(part.value("NpTotal", static_cast<double>(source_.size())));
        if (known >= part.size()) instant.excluded = known - part.size();
        const std::vector<char> is_out = outside_housing(fluid, motions, given_up, instant.time);
        if (report_.has_housing && is_out.size() == fluid.size()) instant.outside = 0;
        for (std::size_t k = 0; k < fluid.size(); ++k)
        {
            if (instant.outside && is_out[k] != 0 && is_in_solid[k] == 0) ++*instant.outside;
            if (in[k] == CaseSolids::none) continue;
            ++instant.inside;
            if (depth[k] > 0.5) ++instant.deep;
            ++instant.in_body[body_of_[in[k]]];
            instant.deepest_dp = std::max(instant.deepest_dp, depth[k]);
        }
        report_.instants.push_back(std::move(instant));
    }
};

} // namespace

bool LeakReport::is_tight() const
{
    return std::all_of(instants.begin(), instants.end(),
                       [](const LeakInstant& at)
                       { return at.inside == 0 && at.outside.value_or(0) == 0; });
}

LeakReport count_leaks(const std::string& case_name, const std::vector<std::string>& parts,
                       const LeakOptions& options)
{
    return LeakCounter(case_name, options).run(parts);
}

} // namespace fppg
