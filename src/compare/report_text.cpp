#include "fppg/compare.h"

#include "compare/report_words.h"
#include "core/text_table.h"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

namespace
{

constexpr std::size_t findings_shown = 40;
constexpr std::size_t values_in_text = 40;

std::string whole(std::uint64_t n)
{
    return std::to_string(n);
}

std::string mean_and_deviation(const Statistics& statistics)
{
    return statistics.count == 0
               ? "-"
               : fmt::format("{:.4f} +- {:.4f}", statistics.mean, statistics.deviation);
}

std::string type_of(const MkComparison& of)
{
    const std::string a = particle_type_name(of.type[0]);
    const std::string b = particle_type_name(of.type[1]);
    return a == b || b == "-" ? a : a == "-" ? b : a + "/" + b;
}

std::string counts_table(const Comparison& comparison)
{
    std::vector<std::vector<std::string>> rows{{"mk", "type", "A", "B", "same place", "moved",
                                                "mean dp", "most dp", "missing", "extra",
                                                "other mk", "other id"}};
    for (const MkComparison& of : comparison.mks)
        rows.push_back(
            {whole(of.mk), type_of(of), whole(of.count[0]), whole(of.count[1]), whole(of.same),
             whole(of.moved), of.moved > 0 ? fmt::format("{:.4f}", of.moved_dp.mean) : "-",
             of.moved > 0 ? fmt::format("{:.4f}", of.moved_dp.largest) : "-", whole(of.missing),
             whole(of.extra), whole(of.mk_changed + of.mk_gained), whole(of.id_changed)});
    return text_table(rows, 2, "  ");
}

std::string quality_table(const Comparison& comparison)
{
    const bool has_geometry = comparison.has_geometry;
    std::vector<std::vector<std::string>> rows{{"mk", "", "spacing A", "B", "Shepard A", "B"}};
    if (has_geometry)
        for (const char* name : {"distance A", "B", "most A", "B", "near A", "B"})
            rows.front().emplace_back(name);
    for (const MkComparison& of : comparison.mks)
    {
        rows.push_back({whole(of.mk), type_of(of), mean_and_deviation(of.spacing_dp[0]),
                        mean_and_deviation(of.spacing_dp[1]), mean_and_deviation(of.shepard[0]),
                        mean_and_deviation(of.shepard[1])});
        if (!has_geometry) continue;
        for (const Statistics& d : of.distance_dp) rows.back().push_back(mean_and_deviation(d));
        for (const Statistics& d : of.distance_dp)
            rows.back().push_back(d.count > 0 ? fmt::format("{:.4f}", d.largest) : "-");
        for (const Statistics& d : of.distance_dp) rows.back().push_back(whole(d.count));
    }
    return text_table(rows, 2, "  ");
}

/// What matters of a result on the lattice and one that is body-fitted.
std::string modes_table(const Comparison& comparison)
{
    const bool has_geometry = comparison.has_geometry;
    const double dp = comparison.dp;
    const double cell = comparison.is_2d ? dp * dp : dp * dp * dp;
    std::vector<std::vector<std::string>> rows{{"mk", "type", "A", "B", "B - A",
                                                comparison.is_2d ? "m^2 A" : "m^3 A", "B",
                                                "apart, dp", "at most"}};
    if (has_geometry) rows.front().insert(rows.front().end(), {"to surface, dp A", "B"});
    for (const MkComparison& of : comparison.mks)
    {
        const auto a = static_cast<double>(of.count[0]);
        const auto b = static_cast<double>(of.count[1]);
        const std::uint64_t paired = of.same + of.moved;
        rows.push_back(
            {whole(of.mk), type_of(of), whole(of.count[0]), whole(of.count[1]),
             a > 0 ? fmt::format("{:+.2f} %", 100 * (b / a - 1)) : "-",
             fmt::format("{:.5g}", a * cell), fmt::format("{:.5g}", b * cell),
             paired == 0 ? "-"
                         : fmt::format("{:.3f}", of.moved_dp.mean * static_cast<double>(of.moved) /
                                                     static_cast<double>(paired)),
             of.moved > 0 ? fmt::format("{:.3f}", of.moved_dp.largest) : "-"});
        if (has_geometry)
            for (const Statistics& d : of.distance_dp) rows.back().push_back(mean_and_deviation(d));
    }
    return text_table(rows, 2, "  ");
}

/// Whether a finding says more than that particles of a fitted result stand elsewhere.
bool matters_between_modes(const Finding& finding)
{
    static constexpr std::array<std::string_view, 8> of_places{
        "count", "missing", "extra", "moved", "ids", "density", "normal", "values"};
    return std::find(of_places.begin(), of_places.end(), finding.category) == of_places.end();
}

std::string findings_text(const Comparison& comparison)
{
    std::vector<Finding> findings = comparison.findings;
    std::string text;
    if (comparison.is_of_two_modes())
    {
        std::erase_if(findings, [](const Finding& f) { return !matters_between_modes(f); });
        text = fmt::format(
            "{} is on the lattice, {} is body-fitted or moved off it: their particles stand at "
            "other "
            "places by design. Counts, volumes (particles times dp^{}) and distances "
            "between nearest particles:\n{}",
            comparison.is_on_lattice[0] ? "A" : "B", comparison.is_on_lattice[0] ? "B" : "A",
            comparison.is_2d ? 2 : 3, modes_table(comparison));
        if (findings.empty()) return text;
    }
    text += "Different, largest first (share of the particles, or of the value):\n";
    const std::size_t shown = std::min(findings_shown, findings.size());
    for (std::size_t i = 0; i < shown; ++i)
        text += fmt::format("  {:>8.3g} %  {:<8}  {}\n", 100 * findings[i].size,
                            findings[i].category, findings[i].text);
    if (shown < findings.size()) text += fmt::format("  and {} more\n", findings.size() - shown);
    return text;
}

} // namespace

std::string to_text(const Comparison& comparison)
{
    std::string text;
    for (std::size_t f = 0; f < 2; ++f)
    {
        const ComparedFile& file = comparison.files[f];
        text += fmt::format("{}  {}: {} particles", f == 0 ? "A" : "B", file.path, file.np);
        if (file.dp > 0) text += fmt::format(", dp {} m", file.dp);
        if (!file.app_name.empty()) text += ", by " + file.app_name;
        text += "\n";
    }
    if (comparison.is_equal())
        text += fmt::format(
            "Equal: every particle of A has one of B within {:.3g} m, and all that both files say "
            "of "
            "them and of the case is the same.\n",
            comparison.same_place_m);
    else
        text += findings_text(comparison);
    if (!comparison.mks.empty())
    {
        if (!comparison.is_of_two_modes()) text += "Particles:\n" + counts_table(comparison);
        text += fmt::format(
            "Distance to the nearest particle in dp, and Shepard sum ({}, h = 1.3 dp){}; mean and "
            "standard deviation:\n",
            comparison.is_2d ? "2-D" : "3-D",
            !comparison.has_geometry
                ? ""
                : "; distance in dp to the geometry of those within 2 dp of it");
        text += quality_table(comparison);
    }
    bool has_alone = false;
    for (const MkComparison& of : comparison.mks)
        for (std::size_t f = 0; f < 2; ++f)
            if (of.alone[f] > 0)
            {
                text += fmt::format("{}mk {} in {}: {} particles",
                                    has_alone ? ", " : "Without another within 2.6 dp: ", of.mk,
                                    f == 0 ? "A" : "B", of.alone[f]);
                has_alone = true;
            }
    if (has_alone) text += "\n";
    if (!comparison.examples.empty() && !comparison.is_of_two_modes())
    {
        text += "Examples:\n";
        for (const ChangedParticle& p : comparison.examples)
            text += fmt::format("  {:<8}  mk {}: {}\n", change_name(p.kind),
                                p.mk[p.kind == ChangeKind::Extra ? 1 : 0], describe_change(p));
    }
    if (!comparison.values.empty()) text += "Values in Case.bi4 and Case.xml, constants first:\n";
    const std::size_t values = std::min(values_in_text, comparison.values.size());
    for (std::size_t i = 0; i < values; ++i)
    {
        const ValueDifference& value = comparison.values[i];
        text += fmt::format("  {}: {} in A, {} in B\n", value.place, value.a.value_or("none"),
                            value.b.value_or("none"));
    }
    if (values < comparison.values.size())
        text += fmt::format("  and {} more\n", comparison.values.size() - values);
    for (const std::string& note : comparison.notes) text += "Note: " + note + "\n";
    return text;
}

} // namespace fppg
