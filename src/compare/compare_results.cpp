#include "fppg/compare.h"

#include "compare/exact_statistics.h"
#include "compare/first_few.h"
#include "compare/measure.h"
#include "compare/pair_particles.h"
#include "compare/relation.h"
#include "compare/report_words.h"
#include "compare/slabs.h"
#include "compare/value_differences.h"
#include "core/parallel.h"
#include "files/particle_source.h"
#include "files/typical_distance.h"
#include "meshes/mesh_query.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <tuple>

namespace fppg
{

namespace
{

constexpr std::size_t kinds = 8;

struct Larger
{
    bool operator()(const ChangedParticle& x, const ChangedParticle& y) const
    {
        return std::tie(y.size, x.index) < std::tie(x.size, y.index);
    }
};
struct Earlier
{
    bool operator()(const ChangedParticle& x, const ChangedParticle& y) const
    {
        const auto first = [](const ChangedParticle& p)
        { return p.index[p.kind == ChangeKind::Extra ? 1 : 0]; };
        return std::tuple(first(x), x.kind, x.index) < std::tuple(first(y), y.kind, y.index);
    }
};

/// What is counted of one mk.
struct MkTally
{
    std::uint64_t same = 0, moved = 0, missing = 0, extra = 0, mk_changed = 0, mk_gained = 0,
                  id_changed = 0;
    ExactStatistics moved_dp;
    std::array<MkMeasures, 2> measures;
    ArrayDifference density, velocity, normal;
    std::array<std::optional<ChangedParticle>, kinds> foremost; ///< by Larger

    void add(const ChangedParticle& p)
    {
        std::optional<ChangedParticle>& of_kind = foremost[static_cast<std::size_t>(p.kind)];
        if (!of_kind || Larger()(p, *of_kind)) of_kind = p;
    }
    void add(const MkTally& o)
    {
        same += o.same;
        moved += o.moved;
        missing += o.missing;
        extra += o.extra;
        mk_changed += o.mk_changed;
        mk_gained += o.mk_gained;
        id_changed += o.id_changed;
        moved_dp.add(o.moved_dp);
        for (std::size_t f = 0; f < 2; ++f) measures[f].add(o.measures[f]);
        for (auto [to, from] : {std::pair(&density, &o.density), std::pair(&velocity, &o.velocity),
                                std::pair(&normal, &o.normal)})
        {
            to->differing += from->differing;
            to->largest = std::max(to->largest, from->largest);
        }
        for (const auto& p : o.foremost)
            if (p) add(*p);
    }
};

struct Tally
{
    std::vector<MkTally> mks;
    std::vector<FirstFew<ChangedParticle, Larger>> examples;
    FirstFew<ChangedParticle, Earlier> changed;

    Tally(std::size_t n_mks, const CompareOptions& options)
        : mks(n_mks),
          examples(kinds, FirstFew<ChangedParticle, Larger>(options.examples)),
          changed(options.changed_at_most)
    {
    }
    void add(const Tally& o)
    {
        for (std::size_t m = 0; m < mks.size(); ++m) mks[m].add(o.mks[m]);
        for (std::size_t k = 0; k < kinds; ++k) examples[k].add(o.examples[k]);
        changed.add(o.changed);
    }
    void add(MkTally& of, const ChangedParticle& p)
    {
        of.add(p);
        examples[static_cast<std::size_t>(p.kind)].add(p);
        if (p.kind <= ChangeKind::MkChanged) changed.add(p);
    }
};

double largest_apart(const std::array<float, 3>& a, const std::array<float, 3>& b)
{
    double apart = 0;
    for (std::size_t c = 0; c < 3; ++c)
    {
        const double d = std::abs(double{a[c]} - double{b[c]});
        if (!(d <= apart)) apart = d; // what is no number differs
    }
    return apart;
}

double size_of(const std::array<float, 3>& v)
{
    return std::sqrt(double{v[0]} * v[0] + double{v[1]} * v[1] + double{v[2]} * v[2]);
}

/// Both files, and what is needed of them everywhere.
class Comparer
{
public:
    Comparer(const std::string& name_a, const std::string& name_b, const CompareOptions& options)
        : sources_{ParticleSource(name_a), ParticleSource(name_b)},
          files_{FileIndex(sources_[0], options.threads), FileIndex(sources_[1], options.threads)}
    {
        out_.options = options;
        describe_files();
        set_frame();
        list_mks();
        if (const std::string why = why_unrelated(out_); !why.empty())
            throw CompareError(
                fmt::format("'{}' and '{}' are not comparable, expected two results "
                            "of one case: {}",
                            sources_[0].path(), sources_[1].path(), why));
        for (std::size_t f = 0; f < 2; ++f)
            out_.is_on_lattice[f] =
                is_on_lattice(sources_[f], out_.files[f].dp > 0 ? out_.files[f].dp : out_.dp);
        TriangleSoup soup = read_geometry(options.geometry, options.threads);
        soup.vertices.insert(soup.vertices.end(), options.surface.vertices.begin(),
                             options.surface.vertices.end());
        out_.has_geometry = soup.size() > 0;
        if (out_.has_geometry)
            geometry_ = std::make_unique<MeshQuery>(std::move(soup), options.threads);
        out_.values = value_differences(sources_[0], sources_[1], options, out_.dp, out_.notes);
        note_arrays();
    }

    Comparison run()
    {
        const CompareOptions& options = out_.options;
        const std::vector<Slab> slabs =
            plan_slabs(frame_, files_[0], files_[1], options.particles_at_once, options.threads);
        out_.blocks = slabs.size();
        Tally total(out_.mks.size(), options);
        for (const Slab& slab : slabs)
        {
            const CellGrid a(frame_, files_[0], slab, options.threads);
            const CellGrid b(frame_, files_[1], slab, options.threads);
            const Partners partners = pair_particles({a, files_[0]}, {b, files_[1]},
                                                     out_.same_place_m, frame_.dp, options.threads);
            tally_columns(a, total,
                          [&](std::size_t c, Tally& tally)
                          { count_pairs(a, c, b, partners, tally); });
            tally_columns(b, total,
                          [&](std::size_t c, Tally& tally)
                          { count_extras(b, c, a, partners, tally); });
            for (const ParticleSource& source : sources_) source.release();
            tally_columns(a, total, [&](std::size_t c, Tally& tally) { measure(a, c, 0, tally); });
            tally_columns(b, total, [&](std::size_t c, Tally& tally) { measure(b, c, 1, tally); });
        }
        take(total);
        return std::move(out_);
    }

private:
    Comparison out_;
    std::array<ParticleSource, 2> sources_;
    std::array<FileIndex, 2> files_;
    CompareFrame frame_;
    std::vector<std::uint16_t> mk_index_;
    std::unique_ptr<MeshQuery> geometry_;

    void describe_files()
    {
        for (std::size_t f = 0; f < 2; ++f)
        {
            out_.files[f].path = sources_[f].path();
            out_.files[f].app_name = maker_of(sources_[f], "app");
            out_.files[f].date = maker_of(sources_[f], "date");
            out_.files[f].dp = sources_[f].dp();
            out_.files[f].np = sources_[f].size();
            out_.files[f].bounds = files_[f].bounds();
        }
    }

    void set_frame()
    {
        const auto guess = [&](std::size_t f)
        {
            return typical_distance(
                sources_[f].size(), [&](std::size_t i) { return sources_[f].position(i); },
                out_.options.threads);
        };
        out_.dp = sources_[0].dp() > 0   ? sources_[0].dp()
                  : sources_[1].dp() > 0 ? sources_[1].dp()
                                         : guess(sources_[0].size() > 0 ? 0 : 1);
        Box3 both;
        for (const FileIndex& file : files_)
            if (!file.bounds().is_empty())
            {
                both.add(file.bounds().min);
                both.add(file.bounds().max);
            }
        try
        {
            frame_ = frame_around(both, out_.dp);
        }
        catch (const CompareError& error)
        {
            throw CompareError(fmt::format("cannot compare '{}' and '{}': {}", sources_[0].path(),
                                           sources_[1].path(), error.what()));
        }
        out_.is_2d = is_in_plane(both, out_.dp);
        double largest = 0;
        if (!both.is_empty())
            for (int axis = 0; axis < 3; ++axis)
                largest = std::max({largest, std::abs(both.min[axis]), std::abs(both.max[axis])});
        const bool is_single = sources_[0].is_single() || sources_[1].is_single();
        out_.same_place_m = std::min(0.5 * out_.dp, out_.options.same_place_dp * out_.dp +
                                                        (is_single ? 1.2e-7 * largest : 0));
    }

    void list_mks()
    {
        mk_index_.assign(65536, 0);
        for (std::size_t mk = 0; mk < 65536; ++mk)
        {
            if (files_[0].counts()[mk] + files_[1].counts()[mk] == 0) continue;
            mk_index_[mk] = static_cast<std::uint16_t>(out_.mks.size());
            MkComparison of;
            of.mk = static_cast<std::uint16_t>(mk);
            for (std::size_t f = 0; f < 2; ++f)
            {
                of.count[f] = files_[f].counts()[mk];
                of.type[f] = files_[f].types()[mk];
            }
            out_.mks.push_back(of);
        }
    }

    void note_arrays()
    {
        const auto note = [&](const char* name, bool in_a, bool in_b)
        {
            if (in_a == in_b) return;
            out_.notes.push_back(
                fmt::format("{} are not compared: only {} has them.", name, in_a ? "A" : "B"));
        };
        note("Ids", sources_[0].has_ids(), sources_[1].has_ids());
        note("Densities", sources_[0].has_density(), sources_[1].has_density());
        note("Velocities", sources_[0].has_velocity(), sources_[1].has_velocity());
        note("Normals", sources_[0].has_normals(), sources_[1].has_normals());
        for (std::size_t f = 0; f < 2; ++f)
            for (const std::string& name : sources_[f].bi4().others)
                out_.notes.push_back(
                    fmt::format("The array {} of {} is not compared.", name, f == 0 ? "A" : "B"));
    }

    MkTally& of_mk(Tally& tally, std::uint16_t mk) const { return tally.mks[mk_index_[mk]]; }

    /// Calls body(column, tally) for all columns; sums are exact, so their order does not matter.
    template <typename Body>
    void tally_columns(const CellGrid& grid, Tally& total, const Body& body)
    {
        const std::size_t chunks = std::min<std::size_t>(
            grid.columns(), 8 * static_cast<std::size_t>(out_.options.threads));
        std::mutex guard;
        parallel_for(chunks, out_.options.threads,
                     [&](std::size_t chunk)
                     {
                         Tally tally(out_.mks.size(), out_.options);
                         const std::size_t end = grid.columns() * (chunk + 1) / chunks;
                         for (std::size_t c = grid.columns() * chunk / chunks; c < end; ++c)
                             body(c, tally);
                         const std::lock_guard lock(guard);
                         total.add(tally);
                     });
    }

    ChangedParticle change(ChangeKind kind, double size, const SlabParticle* a,
                           const SlabParticle* b) const
    {
        ChangedParticle out;
        out.kind = kind;
        out.size = size;
        const SlabParticle* particles[] = {a, b};
        for (std::size_t f = 0; f < 2; ++f)
        {
            if (particles[f] == nullptr) continue;
            out.index[f] = particles[f]->index;
            out.id[f] = sources_[f].id(particles[f]->index);
            out.mk[f] = particles[f]->mk;
            out.position[f] = particles[f]->position;
        }
        return out;
    }

    void count_pairs(const CellGrid& a, std::size_t column, const CellGrid& b,
                     const Partners& partners, Tally& tally) const
    {
        for (std::uint32_t i = a.column(column).begin; i < a.end_of(column); ++i)
        {
            const SlabParticle& p = a.particles()[i];
            if (!p.is_core) continue;
            MkTally& of = of_mk(tally, p.mk);
            if (partners.of_a[i] == no_partner)
            {
                ++of.missing;
                tally.add(of, change(ChangeKind::Missing, 0, &p, nullptr));
                continue;
            }
            const SlabParticle& q = b.particles()[partners.of_a[i]];
            const Vec3 way = q.position - p.position;
            const double apart = std::sqrt(dot(way, way));
            if (p.mk != q.mk)
            {
                ++of.mk_changed;
                tally.add(of, change(ChangeKind::MkChanged, 0, &p, &q));
            }
            else if (dot(way, way) <= out_.same_place_m * out_.same_place_m)
                ++of.same;
            else
            {
                ++of.moved;
                of.moved_dp.add(apart / out_.dp, moved_range);
                tally.add(of, change(ChangeKind::Moved, apart / out_.dp, &p, &q));
            }
            compare_arrays(p, q, of, tally);
        }
    }

    void compare_arrays(const SlabParticle& p, const SlabParticle& q, MkTally& of,
                        Tally& tally) const
    {
        const ParticleSource& a = sources_[0];
        const ParticleSource& b = sources_[1];
        const CompareOptions& options = out_.options;
        const auto judge = [&](ChangeKind kind, double apart, double allowed, ArrayDifference& to)
        {
            if (apart <= allowed) return;
            ++to.differing;
            to.largest = std::max(to.largest, apart);
            tally.add(of, change(kind, apart, &p, &q));
        };
        if (a.has_ids() && b.has_ids() && a.id(p.index) != b.id(q.index))
        {
            ++of.id_changed;
            tally.add(of, change(ChangeKind::IdChanged, 0, &p, &q));
        }
        if (a.has_density() && b.has_density())
        {
            const double x = a.density(p.index);
            const double y = b.density(q.index);
            judge(ChangeKind::Density, std::abs(x - y),
                  options.density * std::max(std::abs(x), std::abs(y)), of.density);
        }
        if (a.has_velocity() && b.has_velocity())
        {
            const auto x = a.velocity(p.index);
            const auto y = b.velocity(q.index);
            judge(ChangeKind::Velocity, largest_apart(x, y),
                  options.velocity + 1e-6 * std::max(size_of(x), size_of(y)), of.velocity);
        }
        if (a.has_normals() && b.has_normals())
            judge(ChangeKind::Normal, largest_apart(a.normal(p.index), b.normal(q.index)) / out_.dp,
                  options.normal_dp, of.normal);
    }

    void count_extras(const CellGrid& b, std::size_t column, const CellGrid& a,
                      const Partners& partners, Tally& tally) const
    {
        for (std::uint32_t j = b.column(column).begin; j < b.end_of(column); ++j)
        {
            const SlabParticle& q = b.particles()[j];
            if (!q.is_core) continue;
            MkTally& of = of_mk(tally, q.mk);
            if (partners.of_b[j] == no_partner)
            {
                ++of.extra;
                tally.add(of, change(ChangeKind::Extra, 0, nullptr, &q));
            }
            else if (a.particles()[partners.of_b[j]].mk != q.mk)
                ++of.mk_gained;
        }
    }

    void measure(const CellGrid& grid, std::size_t column, std::size_t f, Tally& tally) const
    {
        const Measuring measuring{out_.dp, out_.is_2d, geometry_.get()};
        measuring.measure_column(grid, column,
                                 [&](std::uint16_t mk) -> MkMeasures&
                                 { return of_mk(tally, mk).measures[f]; });
    }

    void take(const Tally& total)
    {
        for (std::size_t m = 0; m < out_.mks.size(); ++m)
        {
            MkComparison& to = out_.mks[m];
            const MkTally& from = total.mks[m];
            to.same = from.same;
            to.moved = from.moved;
            to.missing = from.missing;
            to.extra = from.extra;
            to.mk_changed = from.mk_changed;
            to.mk_gained = from.mk_gained;
            to.id_changed = from.id_changed;
            to.moved_dp = from.moved_dp.statistics();
            for (std::size_t f = 0; f < 2; ++f)
            {
                to.alone[f] = from.measures[f].alone;
                to.spacing_dp[f] = from.measures[f].spacing.statistics();
                to.shepard[f] = from.measures[f].shepard.statistics();
                to.distance_dp[f] = from.measures[f].distance.statistics();
            }
            to.density = from.density;
            to.velocity = from.velocity;
            to.normal = from.normal;
        }
        for (const auto& of_kind : total.examples)
            for (const ChangedParticle& p : of_kind.sorted()) out_.examples.push_back(p);
        out_.changed = total.changed.sorted();
        note_far_geometry();
        find_differences(total);
    }

    /// A mesh that stands elsewhere, as where the case scales or turns it, is near no boundary.
    void note_far_geometry()
    {
        if (!out_.has_geometry) return;
        for (const MkComparison& of : out_.mks)
            for (std::size_t f = 0; f < 2; ++f)
                if (of.count[f] > 0 && of.type[f] != static_cast<int>(ParticleType::Fluid) &&
                    of.distance_dp[f].count == 0)
                    out_.notes.push_back(fmt::format(
                        "No particle of mk {} in {} is within 2 dp of the geometry: it has none "
                        "of this mk, or the case puts it elsewhere (--definition takes it as the "
                        "case draws it).",
                        of.mk, f == 0 ? "A" : "B"));
    }

    void add_finding(double size, const char* category, std::string text)
    {
        out_.findings.push_back({std::min(size, 1.0), category, std::move(text)});
    }

    void find_differences(const Tally& total)
    {
        const double np =
            std::max(1.0, static_cast<double>(std::max(sources_[0].size(), sources_[1].size())));
        const auto share = [&](std::uint64_t n) { return static_cast<double>(n) / np; };
        const bool has_equal_counts =
            std::all_of(out_.mks.begin(), out_.mks.end(),
                        [](const MkComparison& of) { return of.count[0] == of.count[1]; });
        for (std::size_t m = 0; m < out_.mks.size(); ++m)
        {
            const MkComparison& of = out_.mks[m];
            const MkTally& from = total.mks[m];
            if (of.count[0] == 0 || of.count[1] == 0)
            {
                add_finding(
                    share(of.count[0] + of.count[1]), "mk",
                    fmt::format("mk {}: {} in A, {} in B", of.mk, of.count[0], of.count[1]));
                continue;
            }
            if (of.type[0] >= 0 && of.type[1] >= 0 && of.type[0] != of.type[1])
                add_finding(
                    share(of.count[0]), "type",
                    fmt::format("mk {}: {} in A, {} in B", of.mk, particle_type_name(of.type[0]),
                                particle_type_name(of.type[1])));
            if (of.count[0] != of.count[1])
                add_finding(share(of.count[0] > of.count[1] ? of.count[0] - of.count[1]
                                                            : of.count[1] - of.count[0]),
                            "count",
                            fmt::format("mk {}: {} particles in A, {} in B", of.mk, of.count[0],
                                        of.count[1]));
            if (of.missing > 0)
                add_finding(share(of.missing), "missing",
                            fmt::format("mk {}: {} missing in B{}", of.mk, of.missing,
                                        place_of(from, ChangeKind::Missing)));
            if (of.extra > 0)
                add_finding(share(of.extra), "extra",
                            fmt::format("mk {}: {} only in B{}", of.mk, of.extra,
                                        place_of(from, ChangeKind::Extra)));
            if (of.moved > 0)
                add_finding(share(of.moved), "moved",
                            fmt::format("mk {}: {} moved, by {:.4g} dp on average and {:.4g} dp at "
                                        "most{}",
                                        of.mk, of.moved, of.moved_dp.mean, of.moved_dp.largest,
                                        place_of(from, ChangeKind::Moved)));
            if (of.mk_changed > 0)
                add_finding(share(of.mk_changed), "mk",
                            fmt::format("mk {}: {} have another mk in B{}", of.mk, of.mk_changed,
                                        place_of(from, ChangeKind::MkChanged)));
            // Where counts differ, the ids behind them are others.
            if (of.id_changed > 0)
                add_finding(has_equal_counts ? share(of.id_changed) : 0, "ids",
                            fmt::format("mk {}: {} have another id in B{}", of.mk, of.id_changed,
                                        place_of(from, ChangeKind::IdChanged)));
            const auto add_array = [&](const char* name, const ArrayDifference& array,
                                       const char* unit, ChangeKind kind)
            {
                if (array.differing > 0)
                    add_finding(share(array.differing), name,
                                fmt::format("mk {}: {} differ in {}, by {:.4g} {} at most{}", of.mk,
                                            array.differing, name, array.largest, unit,
                                            place_of(from, kind)));
            };
            add_array("density", of.density, "kg/m^3", ChangeKind::Density);
            add_array("velocity", of.velocity, "m/s", ChangeKind::Velocity);
            add_array("normal", of.normal, "dp", ChangeKind::Normal);
        }
        for (std::size_t f = 0; f < 2; ++f)
            if (sources_[0].is_bi4() && sources_[1].is_bi4() && sources_[f].has_normals() &&
                !sources_[1 - f].has_normals())
                add_finding(1, "normal", fmt::format("only {} has normals", f == 0 ? "A" : "B"));
        add_value_findings();
        std::stable_sort(out_.findings.begin(), out_.findings.end(),
                         [](const Finding& x, const Finding& y) { return x.size > y.size; });
    }

    void add_value_findings()
    {
        std::size_t others = 0;
        for (const ValueDifference& value : out_.values)
        {
            if (!value.is_constant)
            {
                ++others;
                continue;
            }
            add_finding(value.size, "constant",
                        fmt::format("{}: {} in A, {} in B", value.place, value.a.value_or("none"),
                                    value.b.value_or("none")));
        }
        if (others > 0)
            add_finding(0, "values",
                        fmt::format("{} other values in Case.bi4 and Case.xml differ", others));
        const double dp_a = out_.files[0].dp;
        const double dp_b = out_.files[1].dp;
        if (dp_a > 0 && dp_b > 0 && std::abs(dp_a - dp_b) > out_.options.constants * dp_a &&
            (!sources_[0].is_bi4() || !sources_[1].is_bi4()))
            add_finding(std::abs(dp_a - dp_b) / std::max(dp_a, dp_b), "constant",
                        fmt::format("dp: {} in A, {} in B", dp_a, dp_b));
    }

    /// "; id 5 at (...)" of the foremost one of an mk.
    static std::string place_of(const MkTally& of, ChangeKind kind)
    {
        const std::optional<ChangedParticle>& p = of.foremost[static_cast<std::size_t>(kind)];
        return p ? "; " + describe_change(*p) : "";
    }
};

} // namespace

Comparison compare_results(const std::string& name_a, const std::string& name_b,
                           const CompareOptions& options)
{
    try
    {
        return Comparer(name_a, name_b, options).run();
    }
    catch (const CompareError&)
    {
        throw;
    }
    catch (const Interrupted&)
    {
        throw;
    }
    catch (const Error& error)
    {
        throw CompareError(error.what());
    }
}

} // namespace fppg
