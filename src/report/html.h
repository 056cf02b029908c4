#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fppg
{

/// Text as it may stand between tags and in attributes.
std::string escaped_html(std::string_view text);

std::string base64(std::string_view bytes);

/// 1234567 as 1,234,567.
std::string grouped_digits(std::uint64_t n);

/// From the doctype to the opened body, with the style of all report pages.
std::string page_head(std::string_view title);

/// A picture whose bytes (PNG) are part of the page.
std::string picture_html(std::string_view png, std::string_view caption);

struct HistogramSeries
{
    std::string_view css_class; ///< "a" or "b" of the page's style
    std::span<const std::uint64_t> counts;
};

/// Bars of the series side by side as SVG; heights are shares of the largest number of all.
///
/// begin, end  of the stretch that the bins cut, for the scale below
std::string histogram_svg(std::string_view title, const std::vector<HistogramSeries>& series,
                          double begin, double end);

} // namespace fppg
