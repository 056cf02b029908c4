#pragma once

#include "newcase/plan.h"

#include <initializer_list>
#include <string>
#include <vector>

namespace fppg
{

/// A number and what follows it: "2.5l", "3000deg/s".
struct Quantity
{
    double value = 0;
    std::string unit;
};

/// option    for the message
/// expected  such as "2.5l, 60% or 0.12m"
/// throws    UsageError where it begins with no number
Quantity split_quantity(const std::string& text, const std::string& option,
                        const std::string& expected);

/// Names between commas, without blanks around them.
std::vector<std::string> names_of_list(const std::string& text);

/// "0,1,0". throws UsageError
Vec3 vector_of(const std::string& text, const std::string& option);

/// Whether a name holds one of these words, whatever its capitals.
bool has_word(const std::string& name, std::initializer_list<const char*> words);

/// "y through (0, 0, 0.1) m"
std::string axis_text(const AxisLine& axis);

} // namespace fppg
