#include "fppg/compare.h"

#include "compare/report_words.h"
#include "report/html.h"
#include "report/run_facts.h"

#include <fmt/format.h>
#include <algorithm>
#include <string_view>

namespace fppg
{

namespace
{

constexpr std::size_t values_in_page = 300;
constexpr std::size_t mks_with_histograms = 12;

/// Bars of A and B side by side; either may be missing.
std::string histogram(const std::string& title, const Statistics* a, const Statistics* b,
                      const HistogramRange& range)
{
    std::vector<HistogramSeries> series;
    if (a != nullptr) series.push_back({"a", a->histogram});
    if (b != nullptr) series.push_back({"b", b->histogram});
    return histogram_svg(title, series, range.begin, range.end);
}

std::string statistics_cells(const Statistics& statistics)
{
    return statistics.count == 0 ? "<td>-</td>"
                                 : fmt::format("<td>{:.4f} &plusmn; {:.4f}</td>", statistics.mean,
                                               statistics.deviation);
}

std::string particles_table(const Comparison& comparison)
{
    const bool has_geometry = comparison.has_geometry;
    std::string html =
        "<div class=\"scroll\"><table><tr><th>mk</th><th>type</th><th>A</th><th>B</th><th>same "
        "place</th><th>moved</th><th>mean dp</th><th>most dp</th><th>missing</th><th>extra</th>"
        "<th>other mk</th><th>other id</th><th>spacing A</th><th>spacing B</th><th>Shepard "
        "A</th><th>Shepard B</th>";
    if (has_geometry) html += "<th>to geometry A</th><th>to geometry B</th>";
    html += "</tr>\n";
    for (const MkComparison& of : comparison.mks)
    {
        html +=
            fmt::format("<tr><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td>",
                        of.mk, particle_type_name(of.count[0] > 0 ? of.type[0] : of.type[1]),
                        of.count[0], of.count[1], of.same, of.moved);
        html += of.moved > 0 ? fmt::format("<td>{:.4f}</td><td>{:.4f}</td>", of.moved_dp.mean,
                                           of.moved_dp.largest)
                             : "<td>-</td><td>-</td>";
        html += fmt::format("<td>{}</td><td>{}</td><td>{}</td><td>{}</td>", of.missing, of.extra,
                            of.mk_changed + of.mk_gained, of.id_changed);
        for (const auto* pair : {&of.spacing_dp, &of.shepard})
            for (const Statistics& statistics : *pair) html += statistics_cells(statistics);
        if (has_geometry)
            for (const Statistics& statistics : of.distance_dp)
                html += statistics_cells(statistics);
        html += "</tr>\n";
    }
    return html + "</table></div>\n";
}

std::string histograms(const Comparison& comparison)
{
    std::vector<const MkComparison*> order;
    for (const MkComparison& of : comparison.mks) order.push_back(&of);
    const auto changes = [](const MkComparison* of)
    { return of->moved + of->missing + of->extra + of->mk_changed + of->mk_gained; };
    std::stable_sort(order.begin(), order.end(),
                     [&](const MkComparison* x, const MkComparison* y)
                     { return changes(x) > changes(y); });
    std::string html;
    for (std::size_t i = 0; i < std::min(order.size(), mks_with_histograms); ++i)
    {
        const MkComparison& of = *order[i];
        html += fmt::format("<h3>mk {}</h3><div class=\"histograms\">\n", of.mk);
        html +=
            histogram("nearest particle, dp", &of.spacing_dp[0], &of.spacing_dp[1], spacing_range);
        html += histogram("Shepard sum", &of.shepard[0], &of.shepard[1], shepard_range);
        if (comparison.has_geometry)
            html += histogram("distance to the geometry, dp", &of.distance_dp[0],
                              &of.distance_dp[1], distance_range);
        if (of.moved > 0) html += histogram("moved by, dp", nullptr, &of.moved_dp, moved_range);
        html += "</div>\n";
    }
    if (order.size() > mks_with_histograms)
        html += fmt::format("<p>{} more mks have no histogram here; the JSON has them.</p>\n",
                            order.size() - mks_with_histograms);
    return html;
}

std::string values_table(const Comparison& comparison)
{
    if (comparison.values.empty()) return "<p>None.</p>\n";
    std::string html =
        "<div class=\"scroll\"><table class=\"left\"><tr><th>where</th><th>A</th><th>B</th></tr>\n";
    for (std::size_t i = 0; i < std::min(values_in_page, comparison.values.size()); ++i)
    {
        const ValueDifference& value = comparison.values[i];
        html += fmt::format("<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>\n",
                            escaped_html(value.place), escaped_html(value.a.value_or("none")),
                            escaped_html(value.b.value_or("none")));
    }
    html += "</table></div>\n";
    if (comparison.values.size() > values_in_page)
        html += fmt::format("<p>And {} more.</p>\n", comparison.values.size() - values_in_page);
    return html;
}

/// How long the runs took and what they warned of, where Case.out stands beside a result.
std::string runs(const Comparison& comparison)
{
    std::string html;
    for (std::size_t f = 0; f < 2; ++f)
    {
        const std::optional<RunFacts> facts = facts_of_result(comparison.files[f].path);
        if (!facts) continue;
        html += fmt::format("<h3>{}</h3>\n{}", f == 0 ? "A" : "B", run_facts_html(*facts));
    }
    return html.empty() ? "" : "<h2>Timings and warnings</h2>\n" + html;
}

} // namespace

std::string to_html(const Comparison& comparison, const std::vector<ComparePicture>& pictures,
                    const std::string& view)
{
    std::string html = page_head("fppg compare");
    html += comparison.is_equal() ? "<h1 class=\"equal\">Equal</h1>\n"
                                  : "<h1 class=\"different\">Different</h1>\n";
    html += "<table class=\"left\">\n";
    for (std::size_t f = 0; f < 2; ++f)
    {
        const ComparedFile& file = comparison.files[f];
        html += fmt::format("<tr><td>{}</td><td>{}</td><td>{} particles</td><td>{}</td></tr>\n",
                            f == 0 ? "A" : "B", escaped_html(file.path), file.np,
                            escaped_html(file.app_name));
    }
    html += "</table>\n";
    if (!comparison.is_equal())
    {
        html += "<h2>Differences, largest first</h2>\n<div class=\"scroll\"><table class=\"left\">";
        for (const Finding& finding : comparison.findings)
            html += fmt::format("<tr><td>{:.3g} %</td><td>{}</td><td>{}</td></tr>\n",
                                100 * finding.size, escaped_html(finding.category),
                                escaped_html(finding.text));
        html += "</table></div>\n";
    }
    if (!pictures.empty()) html += "<h2>Pictures</h2>\n";
    for (const ComparePicture& picture : pictures)
    {
        html += fmt::format("<figure>{}<figcaption>{}", picture_html(picture.png, picture.caption),
                            escaped_html(picture.caption));
        for (const auto& [colour, meaning] : picture.legend)
            html += fmt::format(
                " <svg width=\"12\" height=\"12\"><circle cx=\"6\" cy=\"6\" r=\"6\" "
                "fill=\"{}\"/></svg> {}",
                escaped_html(colour), escaped_html(meaning));
        html += "</figcaption></figure>\n";
    }
    if (!view.empty()) html += "<h2>In space</h2>\n" + view;
    html += "<h2>Particles</h2>\n" + particles_table(comparison);
    html +=
        "<h2>Histograms</h2>\n<p><svg width=\"12\" height=\"12\"><rect class=\"a\" width=\"12\" "
        "height=\"12\"/></svg> A <svg width=\"12\" height=\"12\"><rect class=\"b\" width=\"12\" "
        "height=\"12\"/></svg> B</p>\n" +
        histograms(comparison);
    if (!comparison.examples.empty())
    {
        html += "<h2>Examples</h2>\n<div class=\"scroll\"><table class=\"left\">";
        for (const ChangedParticle& p : comparison.examples)
            html += fmt::format("<tr><td>{}</td><td>mk {}</td><td>{}</td></tr>\n",
                                change_name(p.kind), p.mk[p.kind == ChangeKind::Extra ? 1 : 0],
                                escaped_html(describe_change(p)));
        html += "</table></div>\n";
    }
    html +=
        "<h2>Values in Case.bi4 and Case.xml, constants first</h2>\n" + values_table(comparison);
    html += runs(comparison);
    for (const std::string& note : comparison.notes)
        html += fmt::format("<p>{}</p>\n", escaped_html(note));
    return html + "</body></html>\n";
}

} // namespace fppg
