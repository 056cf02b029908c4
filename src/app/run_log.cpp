#include "app/run_log.h"

#include "app/stage_bar.h"
#include "core/json.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

namespace fppg
{

namespace
{

void print_json(const Json& json)
{
    StageBar::clear();
    fmt::print("{}\n", json.text());
    std::fflush(stdout);
}

} // namespace

void RunLog::keep(std::string_view text, bool is_printed)
{
    text_.append(text);
    text_ += '\n';
    if (!is_printed) return;
    StageBar::clear();
    if (!text.empty()) std::fwrite(text.data(), 1, text.size(), stdout);
    std::fputc('\n', stdout);
    std::fflush(stdout);
}

void RunLog::line(std::string_view text)
{
    keep(text, style_ == LogStyle::Text);
    if (style_ == LogStyle::Json && !text.empty())
        print_json({{"event", "log"}, {"text", std::string(text)}});
}

void RunLog::fact(std::string_view event, const Json& fields) const
{
    if (style_ != LogStyle::Json) return;
    Json json = {{"event", std::string(event)}};
    for (const auto& [name, value] : fields.members()) json[name] = value;
    print_json(json);
}

void RunLog::warning(std::string_view text)
{
    keep(fmt::format("*** WARNING: {}", text),
         style_ == LogStyle::Text || style_ == LogStyle::Quiet);
    if (style_ == LogStyle::Json) print_json({{"event", "warning"}, {"text", std::string(text)}});
}

void RunLog::begin_stage(std::string_view name)
{
    keep({}, style_ == LogStyle::Text);
    keep(fmt::format("[{}]", name), style_ == LogStyle::Text);
    if (style_ == LogStyle::Json) print_json({{"event", "stage"}, {"name", std::string(name)}});
}

void RunLog::end_stage(std::string_view name, double seconds)
{
    keep(fmt::format("[{}-End  time:{:.3f}s]", name, seconds), style_ == LogStyle::Text);
    if (style_ == LogStyle::Json)
        print_json({{"event", "stage_end"}, {"name", std::string(name)}, {"seconds", seconds}});
}

void RunLog::finished(double seconds,
                      const std::vector<std::pair<std::string, std::uint64_t>>& counts)
{
    if (style_ != LogStyle::Json) return;
    Json json = {{"event", "finished"}, {"code", 0}, {"seconds", seconds}};
    for (const auto& [name, count] : counts) json[name] = count;
    print_json(json);
}

void expect_printed()
{
    errno = 0;
    const bool is_flushed = std::fflush(stdout) == 0;
    if (is_flushed && std::ferror(stdout) == 0) return;
    throw IoError(fmt::format("standard output cannot be written: {}",
                              errno != 0 ? std::strerror(errno) : "a part of it is lost"));
}

void print_json_error(std::string_view text, int code)
{
    print_json({{"event", "error"}, {"code", code}, {"text", std::string(text)}});
}

} // namespace fppg
