#pragma once

#include "fppg/read_particles.h"

#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

/// Cases of fluid beside fitted walls, run by the program.
namespace fluid_case
{

using namespace fppg::test;
using fppg::ParticleCloud;
using fppg::Vec3;
using nlohmann::json;

inline constexpr double dp = 0.05;
inline constexpr std::uint16_t first_bound = 10; ///< mk of mkbound 0

struct Result
{
    int code = 0;
    std::string output;
    std::string log; ///< Case.out
    ParticleCloud cloud;
    std::vector<json> events;
    double mass_fluid = 0;

    std::vector<Vec3> of_type(bool is_fluid) const
    {
        std::vector<Vec3> out;
        for (std::size_t i = 0; i < cloud.positions.size(); ++i)
            if ((cloud.mk[i] < first_bound) == is_fluid) out.push_back(cloud.positions[i]);
        return out;
    }
    std::vector<Vec3> fluid() const { return of_type(true); }
    std::vector<Vec3> bound() const { return of_type(false); }
    /// Half a step above the highest row, whose place walls in layers choose.
    double level() const
    {
        std::vector<double> heights;
        for (const Vec3& p : fluid()) heights.push_back(p.z);
        std::sort(heights.begin(), heights.end());
        return heights[heights.size() * 49 / 50] + step(2) / 2;
    }
    /// Of the lattice along an axis, metres.
    double step(std::size_t axis) const
    {
        const std::vector<json> moves = all("lattice");
        return moves.empty() ? dp : dp * moves[0]["stretch"][axis].get<double>();
    }
    std::vector<json> all(const std::string& event) const
    {
        std::vector<json> out;
        for (const json& e : events)
            if (e.value("event", "") == event) out.push_back(e);
        return out;
    }
    json one(const std::string& event) const
    {
        const std::vector<json> found = all(event);
        EXPECT_EQ(found.size(), 1u) << event << ": " << output;
        return found.empty() ? json{{"litres", 0}, {"cavity_litres", 0}, {"particles", 0}}
                             : found[0];
    }
};

inline CaseText case_of(const std::string& mainlist, const std::string& fppg)
{
    CaseText text;
    text.dp = "0.05";
    text.pointmin = R"(<pointmin x="-0.4" y="-0.4" z="-0.4" />)";
    text.pointmax = R"(<pointmax x="1.7" y="1.5" z="1.5" />)";
    text.mainlist = R"(<setdrawmode mode="full" />)" + mainlist;
    text.after_geometry = "<fppg>" + fppg + "</fppg>";
    return text;
}

inline Result make(const CaseText& text)
{
    const TemporaryFolder folder;
    write_text(folder / "Case_Def.xml", text.text());
    const RunResult done = run(folder, {"Case_Def", "out/Case", "-log-json"});
    Result out{done.code, done.output, {}, {}, {}, 0};
    if (done.code != 0) return out;
    out.log = read_text(folder / "out/Case.out");
    out.cloud = fppg::read_particles(folder / "out/Case", false, 1);
    std::istringstream lines(done.output);
    for (std::string line; std::getline(lines, line);)
        if (line.starts_with("{")) out.events.push_back(json::parse(line));
    const std::string xml = read_text(folder / "out/Case.xml");
    const std::string name = "<massfluid value=\"";
    out.mass_fluid = std::stod(xml.substr(xml.find(name) + name.size()));
    return out;
}

} // namespace fluid_case
