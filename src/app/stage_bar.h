#pragma once

#include <string>

namespace fppg
{

/// While one exists, a line on the terminal (standard error) shows from the first second on which
/// stage runs, for how long, and how far it is. Nothing where standard error is no terminal.
/// One at a time.
class StageBar
{
public:
    /// is_wanted  false: nothing is shown
    explicit StageBar(std::string name, bool is_wanted = true);
    ~StageBar();
    StageBar(const StageBar&) = delete;
    StageBar& operator=(const StageBar&) = delete;

    /// What the bar that exists now shows; nothing where there is none. From any thread.
    ///
    /// share  of the stage, 0 to 1
    /// text   behind the bar
    static void show(double share, std::string text = {});

    /// Takes the line off the terminal, so that something else can be printed; it comes back.
    static void clear();
};

/// The line: a bar that is filled by the share, or that wanders with time where the share is below
/// 0, the name, the seconds, those that are left, and the text.
std::string bar_line(const std::string& name, double seconds, double share,
                     const std::string& text);

} // namespace fppg
