#include "files/result_pair.h"

#include "core/binary_items.h"
#include "files/output_lock.h"
#include "fppg/error.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>

namespace fppg
{

namespace
{

/// Of dp: limits in Case.xml may have few digits.
constexpr double same_limits = 0.01;

[[noreturn]] void fail(const ResultPair& pair, const std::string& difference)
{
    throw IoError(fmt::format("'{}' and '{}' are not of one run: {}; make the case again", pair.bi4,
                              pair.xml, difference));
}

std::optional<Vec3> find_point(const Bi4View& bi4, std::string_view name)
{
    const BinaryValue* value = find_value(bi4.items, name);
    std::array<double, 3> p{};
    if (value == nullptr || value->type != 23 || value->data.size() != sizeof p) return {};
    std::memcpy(p.data(), value->data.data(), sizeof p);
    return Vec3{p[0], p[1], p[2]};
}

void expect_same_limit(const ResultPair& pair, const char* name, const std::optional<Vec3>& in_bi4,
                       const Vec3& in_xml, double dp)
{
    if (!in_bi4) return;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs((*in_bi4)[axis] - in_xml[axis]) > same_limits * dp)
            fail(pair,
                 fmt::format("{} of all particles is ({:g}, {:g}, {:g}) in the one and "
                             "({:g}, {:g}, {:g}) in the other",
                             name, in_bi4->x, in_bi4->y, in_bi4->z, in_xml.x, in_xml.y, in_xml.z));
}

} // namespace

void expect_case_xml(const ResultPair& pair)
{
    namespace fs = std::filesystem;
    std::error_code ignored;
    if (fs::is_regular_file(pair.xml, ignored)) return;
    std::string text = fmt::format("'{}' has no mk of its own, and '{}', which has, is not there",
                                   pair.bi4, pair.xml);
    const std::string stem = pair.xml.substr(0, pair.xml.size() - std::strlen(".xml"));
    if (fs::exists(output_lock_path(stem), ignored))
        text += "; a run that replaced both was killed or still works: make the case again";
    throw IoError(text);
}

void expect_one_run(const ResultPair& pair, const CaseFacts& facts, const Bi4View& bi4)
{
    constexpr std::array names{"fixed", "moving", "floating", "fluid"};
    constexpr std::array values{"CaseNfixed", "CaseNmoving", "CaseNfloat", "CaseNfluid"};
    std::array<std::uint64_t, 4> counts{};
    for (const IdRange& range : facts.ranges)
        counts[static_cast<std::size_t>(range.type)] += range.end - range.begin;
    for (std::size_t type = 0; type < counts.size(); ++type)
    {
        const std::optional<double> n = find_number(bi4.items, values[type]);
        if (n && *n != static_cast<double>(counts[type]))
            fail(pair, fmt::format("{:.0f} {} particles in the one, {} in the other", *n,
                                   names[type], counts[type]));
    }
    if (facts.limits.is_empty() || !(facts.dp > 0)) return;
    expect_same_limit(pair, "the least place", find_point(bi4, "CasePosMin"), facts.limits.min,
                      facts.dp);
    expect_same_limit(pair, "the greatest place", find_point(bi4, "CasePosMax"), facts.limits.max,
                      facts.dp);
}

} // namespace fppg
