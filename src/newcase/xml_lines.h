#pragma once

#include "newcase/plan.h"

#include <fmt/format.h>

#include <string>
#include <utility>

namespace fppg
{

/// A number as definitions have it, to eight digits.
inline std::string xml_number(double value)
{
    return short_number(value, 8);
}

/// Attributes x, y and z.
inline std::string xml_place(const Vec3& v)
{
    return fmt::format("x=\"{}\" y=\"{}\" z=\"{}\"", xml_number(v.x), xml_number(v.y),
                       xml_number(v.z));
}

/// Lines of XML with their indent.
class XmlLines
{
public:
    template <typename... Args>
    void line(fmt::format_string<Args...> text, Args&&... args)
    {
        out_ += std::string(4 * static_cast<std::size_t>(depth_), ' ') +
                fmt::format(text, std::forward<Args>(args)...) + '\n';
    }
    template <typename... Args>
    void open(fmt::format_string<Args...> text, Args&&... args)
    {
        line("<{}>", fmt::format(text, std::forward<Args>(args)...));
        ++depth_;
    }
    void close(const char* name)
    {
        --depth_;
        line("</{}>", name);
    }
    void comment(const std::string& text) { line("<!-- {} -->", text); }
    std::string take() { return std::move(out_); }

private:
    std::string out_;
    int depth_ = 0;
};

/// Chooses how far before its face each zone stands.
///
/// throws  GeometryError where walls leave no room for its layers
void place_inlets(CasePlan& plan);

/// The zones of the solver where fluid comes in, <special> and all; nothing where it does not.
void write_inlet_zones(const CasePlan& plan, XmlLines& xml);

} // namespace fppg
