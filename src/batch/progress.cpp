#include "batch/progress.h"

#include "core/json.h"
#include "core/text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>

namespace fppg
{
namespace
{

constexpr int bar_width = 30;
constexpr double redraw_seconds = 0.2;

/// 75 as 1:15.
std::string clock_text(double seconds)
{
    const int s = static_cast<int>(std::lround(seconds));
    if (s >= 3600) return fmt::format("{}:{:02}:{:02}", s / 3600, s / 60 % 60, s % 60);
    return fmt::format("{}:{:02}", s / 60, s % 60);
}

void print_json(const Json& json)
{
    fmt::print("{}\n", json.text());
    std::fflush(stdout);
}

std::string first_line(const std::string& text)
{
    return text.substr(0, text.find('\n'));
}

} // namespace

Progress::~Progress()
{
    clear_bar();
}

void Progress::clear_bar()
{
    if (has_bar_) fmt::print(stderr, "\r\x1b[K");
    has_bar_ = false;
}

void Progress::estimated(const BatchRun& run, const RunRecord& record) const
{
    if (style_ == ProgressStyle::Json)
        print_json({{"event", "estimated"},
                    {"run", run.name},
                    {"particles", record.np},
                    {"memory_bytes", record.estimated_memory_bytes},
                    {"seconds", record.estimated_seconds}});
}

void Progress::started(const BatchRun& run) const
{
    if (style_ == ProgressStyle::Json) print_json({{"event", "started"}, {"run", run.name}});
}

void Progress::finished(const BatchRun& run, const RunRecord& record)
{
    ++finished_;
    const bool is_bad = record.state == RunState::Failed || record.state == RunState::Refused;
    if (is_bad) ++failed_;
    if (style_ == ProgressStyle::Json)
    {
        print_json({{"event", "finished"},
                    {"run", run.name},
                    {"state", name_of(record.state)},
                    {"reused", record.is_reused},
                    {"particles", record.np},
                    {"seconds", record.seconds},
                    {"memory_bytes", record.memory_bytes},
                    {"warnings", record.warnings.size()},
                    {"error", record.error}});
        return;
    }
    if (style_ == ProgressStyle::Quiet || (style_ == ProgressStyle::Bar && !is_bad)) return;
    clear_bar();
    std::string text = fmt::format("[{}/{}] {}: ", finished_, runs_, run.name);
    if (record.is_reused)
        text += "done before";
    else if (record.state == RunState::Done)
        text += fmt::format("done, {} particles, {:.2f} s, {:.0f} MB", record.np, record.seconds,
                            record.memory_bytes / 1e6);
    else
        text += name_of(record.state);
    if (!record.warnings.empty())
        text += fmt::format(", {}", counted(record.warnings.size(), "warning", "warnings"));
    if (!record.error.empty()) text += ": " + first_line(record.error);
    fmt::print("{}\n", text);
    std::fflush(stdout);
}

void Progress::tick(std::size_t running, double done)
{
    if (style_ != ProgressStyle::Bar || seconds() < drawn_at_ + redraw_seconds) return;
    drawn_at_ = seconds();
    const int filled = static_cast<int>(done * bar_width);
    std::string text = fmt::format(
        "\r[{}{}] {}/{}, {} running", std::string(static_cast<std::size_t>(filled), '#'),
        std::string(static_cast<std::size_t>(bar_width - filled), '.'), finished_, runs_, running);
    if (failed_ > 0) text += fmt::format(", {} failed", failed_);
    if (done > 0.02) text += ", " + clock_text(seconds() * (1 - done) / done) + " left";
    fmt::print(stderr, "{}\x1b[K", text);
    has_bar_ = true;
}

} // namespace fppg
