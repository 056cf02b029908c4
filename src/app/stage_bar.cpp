#include "app/stage_bar.h"

#include "platform/terminal.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <mutex>
#include <thread>

namespace fppg
{

namespace
{

using Clock = std::chrono::steady_clock;
constexpr auto first_drawn = std::chrono::seconds(1);
constexpr auto redrawn = std::chrono::milliseconds(200);
constexpr int width = 24;

/// The bar that exists, guarded by `guard`.
struct State
{
    std::mutex guard;
    std::condition_variable ends;
    std::thread drawer;
    bool is_there = false;
    bool is_drawn = false;
    std::string name;
    std::string text;
    double share = -1;
    Clock::time_point begin;
};

State& state()
{
    static State one;
    return one;
}

void take_off(State& s)
{
    if (s.is_drawn) fmt::print(stderr, "\r\x1b[K");
    s.is_drawn = false;
}

void draw_until_the_end()
{
    State& s = state();
    std::unique_lock lock(s.guard);
    auto next = s.begin + first_drawn;
    while (!s.ends.wait_until(lock, next, [&] { return !s.is_there; }))
    {
        const double seconds = std::chrono::duration<double>(Clock::now() - s.begin).count();
        fmt::print(stderr, "\r{}\x1b[K", bar_line(s.name, seconds, s.share, s.text));
        s.is_drawn = true;
        next = Clock::now() + redrawn;
    }
}

} // namespace

std::string bar_line(const std::string& name, double seconds, double share, const std::string& text)
{
    std::string bar(width, '.');
    std::string left;
    if (share < 0)
    {
        const auto at = static_cast<std::size_t>(seconds * 5) % width;
        bar[at] = '#';
    }
    else
    {
        std::fill_n(bar.begin(), static_cast<int>(std::min(share, 1.0) * width), '#');
        if (share > 0.02 && share < 1)
            left = fmt::format(", about {:.0f} s more", seconds * (1 - share) / share);
    }
    return fmt::format("[{}] {} {:.0f} s{}{}{}", bar, name, seconds, left, text.empty() ? "" : ", ",
                       text);
}

StageBar::StageBar(std::string name, bool is_wanted)
{
    State& s = state();
    const std::lock_guard lock(s.guard);
    if (!is_wanted || s.is_there || !is_terminal(Stream::Error)) return;
    s.is_there = true;
    s.name = std::move(name);
    s.text.clear();
    s.share = -1;
    s.begin = Clock::now();
    s.drawer = std::thread(draw_until_the_end);
}

StageBar::~StageBar()
{
    State& s = state();
    {
        const std::lock_guard lock(s.guard);
        if (!s.is_there) return;
        s.is_there = false;
    }
    s.ends.notify_all();
    s.drawer.join();
    take_off(s);
}

void StageBar::show(double share, std::string text)
{
    State& s = state();
    const std::lock_guard lock(s.guard);
    s.share = share;
    s.text = std::move(text);
}

void StageBar::clear()
{
    State& s = state();
    const std::lock_guard lock(s.guard);
    take_off(s);
}

} // namespace fppg
