#include "report/html.h"

#include <fmt/format.h>
#include <algorithm>
#include <cstddef>

namespace fppg
{

namespace
{

constexpr std::string_view style = R"(
body{font:15px/1.45 system-ui,sans-serif;margin:2em auto;max-width:1240px;padding:0 1em;color:#222;background:#fff}
h1{font-size:1.5em}h2{font-size:1.15em;margin-top:1.8em}
table{border-collapse:collapse;font-size:13px}td,th{padding:3px 9px;border-bottom:1px solid #ddd;text-align:right;vertical-align:top}
td:nth-child(-n+2),th:nth-child(-n+2),table.left td,table.left th,td.text,th.text{text-align:left}
td{font-variant-numeric:tabular-nums}
.scroll{overflow-x:auto}img{max-width:100%;border:1px solid #ddd}figure{margin:1em 0}
figcaption{font-size:13px;color:#555}.equal,.done{color:#17692a}.different,.failed,.refused{color:#a33}
.stopped,.waiting{color:#8a5a00}.small{font-size:13px;max-width:40em;white-space:pre-wrap}
.a{fill:#2b6cb0}.b{fill:#dd6b20}svg text{font:11px system-ui,sans-serif;fill:#444}
.histograms,.runs{display:flex;flex-wrap:wrap;gap:14px}.runs figure{margin:0;width:240px}
.runs button{padding:0;border:0;background:none;cursor:pointer;font:inherit;color:inherit;text-align:left}
code{font-size:12px}
#fppg-view{margin:1em 0}#fppg-view .bar,#fppg-view .legend{display:flex;flex-wrap:wrap;gap:6px;margin:6px 0;align-items:center}
#fppg-view .bar{font-size:13px}#fppg-view button,#fppg-view select{font:13px system-ui,sans-serif;padding:2px 8px;border:1px solid #bbb;border-radius:4px;background:#f6f6f6;color:#222;cursor:pointer}
#fppg-view .canvas{position:relative;height:560px;border:1px solid #ddd;touch-action:none;cursor:grab}
#fppg-view canvas{display:block}#fppg-view .titles{position:absolute;left:0;right:0;top:4px;display:flex;pointer-events:none}
#fppg-view .titles span{flex:1;padding:0 8px;font-size:13px;color:#444;overflow:hidden;text-overflow:ellipsis;white-space:nowrap}
#fppg-view .legend i{display:inline-block;width:11px;height:11px;border-radius:50%;margin-right:5px;vertical-align:-1px}
#fppg-view .legend button[aria-pressed=false]{opacity:.45;text-decoration:line-through}
)";

} // namespace

std::string escaped_html(std::string_view text)
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

std::string grouped_digits(std::uint64_t n)
{
    std::string text = std::to_string(n);
    for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3)
        text.insert(static_cast<std::size_t>(at), 1, ',');
    return text;
}

std::string page_head(std::string_view title)
{
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{}</title>"
        "<style>{}</style></head><body>\n",
        escaped_html(title), style);
}

std::string picture_html(std::string_view png, std::string_view caption)
{
    return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", escaped_html(caption),
                       base64(png));
}

std::string histogram_svg(std::string_view title, const std::vector<HistogramSeries>& series,
                          double begin, double end)
{
    constexpr double width = 300;
    constexpr double height = 110;
    constexpr double left = 6;
    constexpr double top = 20;
    std::uint64_t most = 1;
    for (const HistogramSeries& one : series)
        most = std::max(most, *std::max_element(one.counts.begin(), one.counts.end()));
    std::string svg = fmt::format(
        "<svg width=\"{:g}\" height=\"{:g}\" role=\"img\" aria-label=\"{}\"><text x=\"{:g}\" "
        "y=\"13\">{}</text>",
        width + 2 * left, height + top + 18, escaped_html(title), left, escaped_html(title));
    for (std::size_t at = 0; at < series.size(); ++at)
    {
        const std::span<const std::uint64_t> counts = series[at].counts;
        const double bin = width / static_cast<double>(counts.size());
        const double bar = bin / static_cast<double>(series.size());
        svg += fmt::format("<g class=\"{}\">", series[at].css_class);
        for (std::size_t i = 0; i < counts.size(); ++i)
        {
            if (counts[i] == 0) continue;
            const double tall =
                std::max(1.0, height * static_cast<double>(counts[i]) / static_cast<double>(most));
            svg +=
                fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\"/>",
                            left + bin * static_cast<double>(i) + bar * static_cast<double>(at),
                            top + height - tall, bar, tall);
        }
        svg += "</g>";
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
                           begin + share * (end - begin));
    }
    return svg + "</svg>\n";
}

} // namespace fppg
