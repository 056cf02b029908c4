#include "leak/leak.h"

#include "core/json.h"
#include "core/text_table.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <functional>

namespace fppg
{

namespace
{

const char* type_name(ParticleType type)
{
    static constexpr const char* names[] = {"fixed", "moving", "floating", "fluid"};
    return names[static_cast<std::size_t>(type)];
}

/// The largest number over time, and when it was first there.
struct Worst
{
    std::uint64_t count = 0;
    double time = 0;
};

Worst worst_in(const LeakReport& report, std::size_t body)
{
    Worst worst;
    for (const LeakInstant& at : report.instants)
        if (at.in_body[body] > worst.count) worst = {at.in_body[body], at.time};
    return worst;
}

/// A step of 1, 2 or 5 times a power of ten that divides the range into about five.
double tick_of(double range)
{
    const double raw = range / 5;
    const double power = std::pow(10, std::floor(std::log10(raw)));
    for (const double step : {1.0, 2.0, 5.0})
        if (raw <= step * power) return step * power;
    return 10 * power;
}

} // namespace

std::string to_text(const LeakReport& report)
{
    std::string text =
        fmt::format("{}: dp {:g} m, {} fluid particles, {} solids, {}\n", report.case_name,
                    report.dp, report.fluid, report.bodies.size(),
                    report.has_housing ? "in a closed housing" : "no closed housing");
    std::vector<std::vector<std::string>> rows{{"time [s]", "step", "dt [s]", "fluid", "inside",
                                                "deeper than dp/2", "deepest [dp]", "outside",
                                                "taken out"}};
    for (const LeakInstant& at : report.instants)
        rows.push_back(
            {fmt::format("{:.6g}", at.time), std::to_string(at.step),
             at.dt_largest > 0 ? fmt::format("{:.3g} to {:.3g}", at.dt_least, at.dt_largest) : "-",
             std::to_string(at.fluid), std::to_string(at.inside), std::to_string(at.deep),
             at.inside > 0 ? fmt::format("{:.3f}", at.deepest_dp) : "-",
             at.outside ? std::to_string(*at.outside) : "-", std::to_string(at.excluded)});
    text += text_table(rows);
    for (std::size_t b = 0; b < report.bodies.size(); ++b)
    {
        const Worst worst = worst_in(report, b);
        if (worst.count > 0)
            text += fmt::format("  {} (mk {}, {}): up to {} inside, at {:g} s\n",
                                report.bodies[b].name, report.bodies[b].mk,
                                type_name(report.bodies[b].type), worst.count, worst.time);
    }
    for (const std::string& note : report.notes) text += "  " + note + "\n";
    text += report.is_tight() ? "No leaks: no fluid is inside solids or outside the housing.\n"
                              : "Leaks: fluid is inside solids or outside the housing.\n";
    return text;
}

std::string to_json(const LeakReport& report)
{
    Json root;
    root["case"] = report.case_name;
    root["dp"] = report.dp;
    root["fluid"] = report.fluid;
    root["has_housing"] = report.has_housing;
    root["is_tight"] = report.is_tight();
    root["bodies"] = Json::array();
    for (const LeakBody& body : report.bodies)
        root["bodies"].push_back(
            {{"name", body.name}, {"mk", body.mk}, {"type", type_name(body.type)}});
    root["outputs"] = Json::array();
    for (const LeakInstant& at : report.instants)
    {
        Json out;
        out["file"] = at.file;
        out["time"] = at.time;
        out["step"] = at.step;
        out["dt_least"] = at.dt_least;
        out["dt_largest"] = at.dt_largest;
        out["fluid"] = at.fluid;
        out["taken_out"] = at.excluded;
        out["inside"] = at.inside;
        out["deeper_than_half_dp"] = at.deep;
        out["deepest_dp"] = at.deepest_dp;
        out["outside"] = at.outside ? Json(*at.outside) : Json(nullptr);
        out["in_body"] = at.in_body;
        root["outputs"].push_back(std::move(out));
    }
    root["notes"] = report.notes;
    return root.text(1) + "\n";
}

namespace
{

/// A plot of counts over time as SVG.
class CountPlot
{
public:
    struct Line
    {
        const char* name;
        const char* colour;
        std::function<std::uint64_t(const LeakInstant&)> value;
    };

    CountPlot(const std::vector<LeakInstant>& instants, std::vector<Line> lines)
        : instants_(instants), lines_(std::move(lines))
    {
        for (const LeakInstant& at : instants_)
        {
            time_end_ = std::max(time_end_, at.time);
            for (const Line& line : lines_)
                most_ = std::max(most_, static_cast<double>(line.value(at)));
        }
        if (!(time_end_ > 0)) time_end_ = 1;
        count_tick_ = std::max(1.0, tick_of(most_));
        count_end_ = std::ceil(most_ / count_tick_) * count_tick_;
    }

    std::string svg()
    {
        svg_ = fmt::format(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:g}\" height=\"{1:g}\" "
            "viewBox=\"0 0 {0:g} {1:g}\" font-family=\"sans-serif\" font-size=\"13\">\n"
            "<rect width=\"{0:g}\" height=\"{1:g}\" fill=\"white\"/>\n",
            width, height);
        draw_axes();
        double legend = left;
        for (const Line& line : lines_)
        {
            draw_line(line, legend);
            legend += 220;
        }
        return std::move(svg_) + "</svg>\n";
    }

private:
    double x_of(double t) const { return left + (width - left - right) * t / time_end_; }
    double y_of(double n) const
    {
        return height - bottom - (height - top - bottom) * n / count_end_;
    }

    void text_at(double x, double y, const char* anchor, const std::string& text)
    {
        svg_ += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y,
                            anchor, text);
    }

    void rule(double x0, double y0, double x1, double y1)
    {
        svg_ += fmt::format(
            "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" "
            "stroke=\"#dddddd\"/>\n",
            x0, y0, x1, y1);
    }

    void draw_axes()
    {
        for (int i = 0; i * count_tick_ <= count_end_ * (1 + 1e-9); ++i)
        {
            const double y = y_of(i * count_tick_);
            rule(left, y, width - right, y);
            text_at(left - 8, y + 4, "end", fmt::format("{:g}", i * count_tick_));
        }
        const double time_tick = tick_of(time_end_);
        for (int i = 0; i * time_tick <= time_end_ * (1 + 1e-9); ++i)
        {
            const double x = x_of(i * time_tick);
            rule(x, top, x, height - bottom);
            text_at(x, height - bottom + 18, "middle", fmt::format("{:g}", i * time_tick));
        }
        text_at(0.5 * (left + width - right), height - 12, "middle", "time [s]");
    }

    void draw_line(const Line& line, double legend)
    {
        std::string points;
        for (const LeakInstant& at : instants_)
            points += fmt::format("{:.1f},{:.1f} ", x_of(at.time),
                                  y_of(static_cast<double>(line.value(at))));
        svg_ += fmt::format(
            "<polyline points=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"2\"/>\n", points,
            line.colour);
        svg_ += fmt::format("<rect x=\"{:.1f}\" y=\"16\" width=\"18\" height=\"4\" fill=\"{}\"/>\n",
                            legend, line.colour);
        text_at(legend + 24, 23, "start", line.name);
    }

    static constexpr double width = 760;
    static constexpr double height = 380;
    static constexpr double left = 70;
    static constexpr double right = 20;
    static constexpr double top = 46;
    static constexpr double bottom = 50;
    const std::vector<LeakInstant>& instants_;
    std::vector<Line> lines_;
    double time_end_ = 0;
    double most_ = 1;
    double count_tick_ = 1;
    double count_end_ = 1;
    std::string svg_;
};

} // namespace

std::string to_svg(const LeakReport& report)
{
    std::vector<CountPlot::Line> lines{
        {"inside solids", "#c44e4a", [](const auto& at) { return at.inside; }}};
    if (report.has_housing)
        lines.push_back({"outside the housing", "#3e89ca",
                         [](const auto& at) { return at.outside.value_or(0); }});
    lines.push_back(
        {"taken out by the solver", "#807a72", [](const auto& at) { return at.excluded; }});
    return CountPlot(report.instants, std::move(lines)).svg();
}

} // namespace fppg
