#pragma once

#include <string>
#include <string_view>

namespace fppg
{

/// What a run says: printed at once, kept for Case.out.
class RunLog
{
public:
    void line(std::string_view text = {});
    const std::string& text() const { return text_; }

private:
    std::string text_;
};

} // namespace fppg
