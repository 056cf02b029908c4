#include "fppg/compare.h"

#include "compare/report_words.h"

#include <fmt/format.h>
#include <algorithm>
#include <string_view>

namespace fppg
{

namespace
{

constexpr std::size_t values_shown = 300;
constexpr std::size_t mks_with_histograms = 12;

constexpr std::string_view style = R"(
body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:1240px;padding:0 1em;color:#222}
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.8em}
table{border-collapse:collapse;font-size:13px}td,th{padding:3px 9px;border-bottom:1px solid #ddd;text-align:right}
td:nth-child(-n+2),th:nth-child(-n+2),table.left td,table.left th{text-align:left}
.scroll{overflow-x:auto}img{max-width:100%;border:1px solid #ddd}figure{margin:1em 0}
figcaption{font-size:13px;color:#555}.equal{color:#17692a}.different{color:#a33}
.a{fill:#2b6cb0}.b{fill:#dd6b20}svg text{font:11px system-ui,sans-serif;fill:#444}
.histograms{display:flex;flex-wrap:wrap;gap:14px}code{font-size:12px}
)";

std::string escaped(std::string_view text)
{
    std::string out;
    for (const char c : text) switch (c)
        {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            default:
                out += c;
        }
    return out;
}

std::string base64(std::string_view bytes)
{
    static constexpr std::string_view digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve(4 * (bytes.size() + 2) / 3);
    for (std::size_t i = 0; i < bytes.size(); i += 3)
    {
        const std::size_t n = std::min<std::size_t>(3, bytes.size() - i);
        std::uint32_t bits = 0;
        for (std::size_t b = 0; b < 3; ++b)
            bits = bits << 8U | (b < n ? static_cast<unsigned char>(bytes[i + b]) : 0U);
        for (std::size_t d = 0; d < 4; ++d)
            out += d <= n ? digits[bits >> (18 - 6 * d) & 63U] : '=';
    }
    return out;
}

/// Bars of A and B side by side; heights as shares of the larger number of particles.
std::string histogram(const std::string& title, const Spread* a, const Spread* b,
                      const HistogramRange& range)
{
    constexpr double width = 300;
    constexpr double height = 110;
    constexpr double left = 6;
    constexpr double top = 20;
    std::uint64_t most = 1;
    for (const Spread* spread : {a, b})
        if (spread != nullptr)
            most = std::max(most,
                            *std::max_element(spread->histogram.begin(), spread->histogram.end()));
    std::string svg = fmt::format(
        "<svg width=\"{:g}\" height=\"{:g}\" role=\"img\" aria-label=\"{}\"><text x=\"{:g}\" "
        "y=\"13\">{}</text>",
        width + 2 * left, height + top + 18, escaped(title), left, escaped(title));
    const double bin = width / Spread::bins;
    const int shown = (a != nullptr ? 1 : 0) + (b != nullptr ? 1 : 0);
    int at = 0;
    for (const Spread* spread : {a, b})
    {
        if (spread == nullptr) continue;
        svg += fmt::format("<g class=\"{}\">", spread == a ? "a" : "b");
        for (std::size_t i = 0; i < Spread::bins; ++i)
        {
            const auto n = static_cast<double>(spread->histogram[i]);
            if (n == 0) continue;
            const double tall = std::max(1.0, height * n / static_cast<double>(most));
            svg +=
                fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>",
                            left + bin * (static_cast<double>(i) + 1.0 * at / shown),
                            top + height - tall, bin / shown, tall);
        }
        svg += "</g>";
        ++at;
    }
    svg +=
        fmt::format("<line x1=\"{0:g}\" y1=\"{1:g}\" x2=\"{2:g}\" y2=\"{1:g}\" stroke=\"#888\"/>",
                    left, top + height, left + width);
    for (const int tick : {0, 1, 2, 3})
    {
        const double share = tick / 3.0;
        svg += fmt::format("<text x=\"{:g}\" y=\"{:g}\" text-anchor=\"{}\">{:.3g}</text>",
                           left + share * width, top + height + 14,
                           tick == 0   ? "start"
                           : tick == 3 ? "end"
                                       : "middle",
                           range.begin + share * (range.end - range.begin));
    }
    return svg + "</svg>\n";
}

std::string spread_cells(const Spread& spread)
{
    return spread.count == 0
               ? "<td>-</td>"
               : fmt::format("<td>{:.4f} &plusmn; {:.4f}</td>", spread.mean, spread.deviation);
}

std::string particles_table(const Comparison& comparison)
{
    const bool has_geometry = !comparison.options.geometry.empty();
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
            for (const Spread& spread : *pair) html += spread_cells(spread);
        if (has_geometry)
            for (const Spread& spread : of.distance_dp) html += spread_cells(spread);
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
        if (!comparison.options.geometry.empty())
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
    for (std::size_t i = 0; i < std::min(values_shown, comparison.values.size()); ++i)
    {
        const ValueDifference& value = comparison.values[i];
        html += fmt::format("<tr><td><code>{}</code></td><td>{}</td><td>{}</td></tr>\n",
                            escaped(value.place), escaped(value.a.value_or("none")),
                            escaped(value.b.value_or("none")));
    }
    html += "</table></div>\n";
    if (comparison.values.size() > values_shown)
        html += fmt::format("<p>And {} more.</p>\n", comparison.values.size() - values_shown);
    return html;
}

} // namespace

std::string to_html(const Comparison& comparison, const std::vector<ComparePicture>& pictures)
{
    std::string html =
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>fppg "
        "compare</title><style>";
    html += style;
    html += "</style></head><body>\n";
    html += comparison.is_equal() ? "<h1 class=\"equal\">Equal</h1>\n"
                                  : "<h1 class=\"different\">Different</h1>\n";
    html += "<table class=\"left\">\n";
    for (std::size_t f = 0; f < 2; ++f)
    {
        const ComparedFile& file = comparison.files[f];
        html +=
            fmt::format("<tr><td>{}</td><td>{}</td><td>{} particles</td><td>{}</td></tr>\n",
                        f == 0 ? "A" : "B", escaped(file.path), file.np, escaped(file.app_name));
    }
    html += "</table>\n";
    if (!comparison.is_equal())
    {
        html += "<h2>Differences, largest first</h2>\n<div class=\"scroll\"><table class=\"left\">";
        for (const Finding& finding : comparison.findings)
            html +=
                fmt::format("<tr><td>{:.3g} %</td><td>{}</td><td>{}</td></tr>\n",
                            100 * finding.size, escaped(finding.category), escaped(finding.text));
        html += "</table></div>\n";
    }
    if (!pictures.empty()) html += "<h2>Pictures</h2>\n";
    for (const ComparePicture& picture : pictures)
    {
        html += fmt::format(
            "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}",
            escaped(picture.caption), base64(picture.png));
        for (const auto& [colour, meaning] : picture.legend)
            html += fmt::format(
                " <svg width=\"12\" height=\"12\"><circle cx=\"6\" cy=\"6\" r=\"6\" "
                "fill=\"{}\"/></svg> {}",
                escaped(colour), escaped(meaning));
        html += "</figcaption></figure>\n";
    }
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
            html +=
                fmt::format("<tr><td>{}</td><td>mk {}</td><td>{}</td></tr>\n", change_name(p.kind),
                            p.mk[p.kind == ChangeKind::Extra ? 1 : 0], escaped(describe_change(p)));
        html += "</table></div>\n";
    }
    html +=
        "<h2>Values in Case.bi4 and Case.xml, constants first</h2>\n" + values_table(comparison);
    for (const std::string& note : comparison.notes)
        html += fmt::format("<p>{}</p>\n", escaped(note));
    return html + "</body></html>\n";
}

} // namespace fppg
