#pragma once

#include "core/json.h"

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace fppg
{

/// What a run prints.
enum class LogStyle : std::uint8_t
{
    Text,  ///< what GenCase prints
    Quiet, ///< warnings only
    None,  ///< nothing
    /// A JSON object a line. Its "event" is stage, stage_end, warning, finished, error; domain,
    /// fill, particles, limits, file with the numbers as fields; or log, a line of text.
    Json,
};

/// What a run says: printed at once, kept for Case.out.
class RunLog
{
public:
    explicit RunLog(LogStyle style = LogStyle::Text) : style_(style) {}

    void line(std::string_view text = {});
    /// A line whose content a fact has as fields: not for JSON.
    void text_line(std::string_view text = {}) { keep(text, style_ == LogStyle::Text); }
    /// An event with its fields, an object: for JSON only.
    void fact(std::string_view event, const Json& fields) const;
    void warning(std::string_view text);
    void begin_stage(std::string_view name);
    void end_stage(std::string_view name, double seconds);
    /// The last event of a run that went well; prints nothing but in JSON.
    void finished(double seconds, const std::vector<std::pair<std::string, std::uint64_t>>& counts);

    LogStyle style() const { return style_; }
    const std::string& text() const { return text_; }

private:
    void keep(std::string_view text, bool is_printed);

    LogStyle style_;
    std::string text_;
};

/// throws  IoError if what was printed up to now did not reach standard output, as on a full disk
void expect_printed();

/// Prints the event of a run that failed. For callers that asked for JSON.
void print_json_error(std::string_view text, int code);

} // namespace fppg
