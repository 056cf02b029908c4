#include "app/block_check.h"

#include "fppg/files.h"

#include "particles/run_positions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace fppg
{
namespace
{

/// A `<objreal>` and the mkbound that it moves.
struct MotionRef
{
    int mkbound = 0;
    int line = 0;
    std::string movements; ///< its own and those of the objects around it
};

std::string movements_of(const Element& object)
{
    std::string out;
    for (const Element& c : object.children)
        if (c.kind == Element::Kind::Tag && c.name != "objreal" && c.name != "obj")
            out += print_element(c, 0);
    return out;
}

void collect_motions(const Element& e, const std::string& around, std::vector<MotionRef>& out)
{
    for (const Element& c : e.children)
    {
        if (c.name != "objreal" && c.name != "obj") continue;
        const std::string movements = around + movements_of(c);
        if (c.name == "objreal")
            out.push_back({std::stoi(*c.find_attribute("ref")), c.line, movements});
        collect_motions(c, movements, out);
    }
}

std::vector<MotionRef> motions_of(const CaseDef& def)
{
    std::vector<MotionRef> out;
    collect_motions(def.motion, "", out);
    return out;
}

/// "mkbound 0 and 10 have some" or "there is no boundary"
std::string mks_that_are(const CaseDef& def, const std::set<std::uint16_t>& mks)
{
    std::vector<int> bound;
    for (const std::uint16_t mk : mks)
        if (mk >= def.mk_bound_first) bound.push_back(mk - def.mk_bound_first);
    return bound.empty() ? "no mkbound has any"
                         : "those with particles are " + format_ranges(bound);
}

/// What moves a boundary mk: 'f' nothing, 'm' a motion, 'b' it floats; and which one.
struct Role
{
    char kind = 'f';
    int which = 0; ///< of a motion the first mkbound that moves so; of a floating body its mkbound
    bool operator==(const Role&) const = default;
};

Role role_of(const CaseDef& def, const std::vector<MotionRef>& motions, int mkbound)
{
    for (const MotionRef& m : motions)
    {
        if (m.mkbound != mkbound) continue;
        for (const MotionRef& first : motions)
            if (first.movements == m.movements) return {'m', first.mkbound};
    }
    for (const FloatingDef& f : def.floatings)
        if (std::find(f.mkbound.begin(), f.mkbound.end(), mkbound) != f.mkbound.end())
            return {'b', mkbound};
    return {};
}

std::string text_of(const Role& role, int mkbound)
{
    const char* what = role.kind == 'm' ? "moves" : role.kind == 'b' ? "floats" : "is fixed";
    return fmt::format("mkbound {}, which {}", mkbound, what);
}

/// The lowest boundary of columns of cells across gravity.
class Floor
{
public:
    Floor(const CaseDef& def, const CaseParticles& particles, int axis, double up)
        : particles_(particles),
          axis_(axis),
          up_(up),
          a_((axis + 1) % 3),
          b_((axis + 2) % 3),
          low_(particles.pos_min)
    {
        const Vec3 size = particles.pos_max - particles.pos_min;
        // Memory for all columns stays small: wider ones find less.
        cell_ =
            def.grid.dp * std::max(1.0, std::ceil(std::sqrt((size[a_] / def.grid.dp + 3) *
                                                            (size[b_] / def.grid.dp + 3) / 1e7)));
        // With an empty column at each end.
        na_ = static_cast<std::size_t>(size[a_] / cell_) + 4;
        nb_ = static_cast<std::size_t>(size[b_] / cell_) + 4;
        lowest_.assign(na_ * nb_, std::numeric_limits<double>::infinity());
        for (const ParticleBlock& block : particles.blocks)
            if (block.type != ParticleType::Fluid)
                for_each_place(block, [&](const Vec3& p, std::uint64_t)
                               { at(p) = std::min(at(p), height(p)); });
        widen();
    }

    /// Calls f(place, count) for each particle, or for whole runs at their lower end where they
    /// stand along gravity.
    template <typename F>
    void for_each_place(const ParticleBlock& block, const F& f) const
    {
        for (const ParticleRun& run : block.runs)
        {
            if (run.count == 0) continue;
            if (axis_ == 2 && !run.is_off_lattice)
            {
                const bool is_last = block.run_descending == (up_ > 0);
                f(place_in_run(particles_, block, run, is_last ? run.count - 1 : 0),
                  std::uint64_t{run.count});
                continue;
            }
            for (std::uint32_t k = 0; k < run.count; ++k)
                f(place_in_run(particles_, block, run, k), std::uint64_t{1});
        }
    }

    bool is_below(const Vec3& p) const { return lowest_[index(p)] <= height(p); }

private:
    double height(const Vec3& p) const { return up_ * p[axis_]; }
    std::size_t index(const Vec3& p) const
    {
        const auto of = [&](int axis)
        { return static_cast<std::size_t>(std::max(0.0, (p[axis] - low_[axis]) / cell_ + 1.5)); };
        return std::min(of(a_), na_ - 1) * nb_ + std::min(of(b_), nb_ - 1);
    }
    double& at(const Vec3& p) { return lowest_[index(p)]; }

    /// Each column takes the lowest of those around it, first along one axis, then the other.
    void widen()
    {
        const std::vector<double> own = lowest_;
        for (std::size_t i = nb_; i + nb_ < own.size(); ++i)
            lowest_[i] = std::min({own[i - nb_], own[i], own[i + nb_]});
        double before = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i + 1 < lowest_.size(); ++i)
        {
            const double here = lowest_[i];
            lowest_[i] = std::min({before, here, lowest_[i + 1]});
            before = here;
        }
    }

    const CaseParticles& particles_;
    int axis_;
    double up_;
    int a_;
    int b_;
    Vec3 low_;
    double cell_ = 1;
    std::size_t na_ = 0;
    std::size_t nb_ = 0;
    std::vector<double> lowest_;
};

/// Whether the solver puts back or takes away what leaves the domain along an axis: a key such as
/// ZPeriodicIncX or XZPeriodic, or `<inout>`.
bool is_open_along(const Element& e, char axis)
{
    if (e.name == "inout") return true;
    const std::string* key = e.find_attribute("key");
    const std::size_t at = key == nullptr ? std::string::npos : key->find("Periodic");
    if (at != std::string::npos && key->find(axis) < at) return true;
    return std::any_of(e.children.begin(), e.children.end(),
                       [axis](const Element& c) { return is_open_along(c, axis); });
}

/// The lines on which a mk is drawn or filled, each once.
std::string lines_of(const CaseDef& def, std::uint16_t mk, SourceRef& first)
{
    std::set<int> lines;
    const auto add = [&](const SourceRef& source)
    {
        if (lines.empty()) first = source;
        lines.insert(source.line);
    };
    for (const DrawOp& op : def.ops)
        if (op.state != nullptr && op.state->mk.mk == mk && op.state->draw_points) add(op.source);
    for (const PointFile& file : def.point_files)
        if (file.mk.mk == mk) add(file.source);
    return lines.size() < 2 ? "" : fmt::format(" (drawn on the lines {})", fmt::join(lines, ", "));
}

} // namespace

std::vector<std::string> check_mks(const CaseDef& def, const std::set<std::uint16_t>& mks)
{
    const auto has = [&](int mkbound)
    { return mks.contains(static_cast<std::uint16_t>(mkbound + def.mk_bound_first)); };
    std::vector<std::string> out;
    for (const FloatingDef& f : def.floatings)
    {
        if (std::any_of(f.mkbound.begin(), f.mkbound.end(), has)) continue;
        out.push_back(fmt::format(
            "{}:{}: <floating>: mkbound {} has no particle, so nothing floats; expected a mkbound "
            "that is drawn, {}",
            def.file, f.line, format_ranges({f.mkbound.begin(), f.mkbound.end()}),
            mks_that_are(def, mks)));
    }
    for (const MotionRef& m : motions_of(def))
        if (!has(m.mkbound))
            out.push_back(
                fmt::format("{}:{}: <objreal ref=\"{}\">: mkbound {} has no particle, so nothing "
                            "moves; expected "
                            "a mkbound that is drawn, {}",
                            def.file, m.line, m.mkbound, m.mkbound, mks_that_are(def, mks)));
    return out;
}

std::vector<std::string> check_unions(const CaseDef& def)
{
    const std::vector<MotionRef> motions = motions_of(def);
    std::vector<std::string> out;
    for (const BooleanDef& b : def.booleans)
    {
        if (!b.is_drawn || b.mk) continue;
        const std::vector<char> stays = staying_parts(b.tree, b.parts.size());
        std::optional<int> first;
        for (std::size_t i = 0; i < b.parts.size(); ++i)
        {
            const MkValue& mk = def.ops[b.parts[i].op].state->mk;
            if (stays[i] == 0 || mk.kind != MkKind::Bound) continue;
            if (!first) first = mk.mk_type;
            const Role a = role_of(def, motions, *first);
            const Role other = role_of(def, motions, mk.mk_type);
            if (a == other) continue;
            out.push_back(fmt::format(
                "{}:{}: <boolean>: it unites {}, and {}: the walls between them drop out, and the "
                "rest is torn open when they move apart; expected parts that move together, or "
                "draws "
                "without <boolean>",
                def.file, b.line, text_of(a, *first), text_of(other, mk.mk_type)));
            break;
        }
    }
    return out;
}

std::vector<std::string> check_floor(const CaseDef& def, const CaseParticles& particles)
{
    const Vec3& g = def.constants.gravity;
    int axis = -1;
    for (int i = 0; i < 3; ++i)
        if (g[i] != 0) axis = axis == -1 ? i : 3;
    const bool has_walls = particles.np > particles.n_fluid;
    if (axis < 0 || axis > 2 || (def.grid.is_2d && axis == 1) || !has_walls ||
        particles.n_fluid == 0 || def.vres.is_active() ||
        std::any_of(def.execution.begin(), def.execution.end(),
                    [axis](const Element& e) { return is_open_along(e, "XYZ"[axis]); }))
        return {};
    const Floor floor(def, particles, axis, g[axis] < 0 ? 1 : -1);
    std::vector<std::string> out;
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.type != ParticleType::Fluid) continue;
        std::uint64_t lost = 0;
        Box3 box;
        floor.for_each_place(block,
                             [&](const Vec3& p, std::uint64_t count)
                             {
                                 if (floor.is_below(p)) return;
                                 lost += count;
                                 box.add(p);
                             });
        if (lost == 0) continue;
        std::string where;
        for (int i = 0; i < 3; ++i)
            if (i != axis && !(def.grid.is_2d && i == 1))
                where += fmt::format("{}{} from {:g} to {:g}", where.empty() ? "" : ", ", "xyz"[i],
                                     box.min[i], box.max[i]);
        SourceRef first;
        const std::string lines = lines_of(def, block.mk, first);
        out.push_back(fmt::format(
            "{}:{}: <{}>: {} of {} particles of mkfluid {}{} have no wall below them ({} m), so "
            "gravity takes them out of the domain; expected walls under all of the fluid",
            def.file, first.line, first.command, lost, block.count, block.mk_type, lines, where));
    }
    return out;
}

} // namespace fppg
