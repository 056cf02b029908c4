#include "casedef/mesh_data.h"

#include "fppg/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

namespace fppg
{
namespace
{

class MeshDataReader
{
public:
    explicit MeshDataReader(const std::string& path) : path_(path), in_(path, std::ios::binary)
    {
        if (!in_) throw IoError(fmt::format("{}: cannot open the file", path));
    }

    MeshData run()
    {
        MeshData data;
        if (next_line().empty() || !cells_[0].starts_with("Format"))
            fail("is no mesh data, expected a first line \"Format;DataName;...\"");
        if (next_line().size() < 23)
            fail(
                fmt::format("has {} columns, expected the 23 that describe a mesh", cells_.size()));
        if (!cells_[0].starts_with("JMeshTDatas"))
            fail(fmt::format("has the format \"{}\", expected JMeshTDatas", cells_[0]));
        data.is_vector = cells_[3] == "float3" || cells_[3] == "double3";
        if (!data.is_vector && cells_[3] != "float" && cells_[3] != "double")
            fail(fmt::format("has values of type \"{}\", expected float or float3", cells_[3]));
        if (cells_[4] != "false" && cells_[4] != "0")
            fail("holds data of two dimensions (Data12), expected three");
        std::size_t nodes = 1;
        for (std::size_t a = 0; a < 3; ++a)
        {
            const double n = number(5 + a);
            if (!(n >= 1 && n <= 1e6) || n != std::floor(n))
                fail(fmt::format("has \"{}\" nodes along axis {}", cells_[5 + a], a + 1));
            data.mesh.n[a] = static_cast<std::uint32_t>(n);
            nodes *= data.mesh.n[a];
        }
        data.mesh.origin = vector(8);
        for (std::size_t a = 0; a < 3; ++a) data.mesh.steps[a] = vector(11 + 3 * a);
        check_steps(data.mesh);
        const std::size_t columns = 1 + nodes * (data.is_vector ? 3 : 1);
        next_line();
        while (!next_line().empty())
        {
            if (cells_.size() != columns)
                fail(fmt::format("has {} columns, expected {}", cells_.size(), columns));
            data.times.push_back(number(0));
            if (data.times.size() > 1 && !(data.times.back() > *(data.times.end() - 2)))
                fail("does not follow the time of the line before");
            auto& values = data.values.emplace_back();
            for (std::size_t c = 1; c < columns; ++c) values.push_back(number(c));
        }
        if (data.times.empty()) fail("is where values are expected");
        return data;
    }

private:
    [[noreturn]] void fail(const std::string& text) const
    {
        throw CaseError(path_, line_, "the line " + text);
    }

    /// Cells of the next line that is not blank; none at the end.
    const std::vector<std::string>& next_line()
    {
        cells_.clear();
        std::string line;
        while (cells_.empty() && std::getline(in_, line))
        {
            ++line_;
            const char separator = line.find(';') != std::string::npos ? ';' : ',';
            while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.pop_back();
            for (std::size_t at = 0; at < line.size();)
            {
                const std::size_t end = std::min(line.find(separator, at), line.size());
                std::string cell = line.substr(at, end - at);
                cell.erase(0, cell.find_first_not_of(" \t"));
                cell.erase(cell.find_last_not_of(" \t") + 1);
                cells_.push_back(std::move(cell));
                at = end + 1;
            }
        }
        return cells_;
    }

    double number(std::size_t column) const
    {
        const std::string& cell = cells_[column];
        const char* begin = cell.data() + (cell.starts_with('+') ? 1 : 0);
        double value = 0;
        const auto [end, error] = std::from_chars(begin, cell.data() + cell.size(), value);
        if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value))
            fail(fmt::format("has \"{}\" in column {}, expected a number", cell, column + 1));
        return value;
    }

    Vec3 vector(std::size_t column) const
    {
        return {number(column), number(column + 1), number(column + 2)};
    }

    void check_steps(const MeshValues& mesh) const
    {
        for (std::size_t a = 0; a < 3; ++a)
        {
            if (mesh.n[a] < 2) continue;
            if (!(norm(mesh.steps[a]) > 0))
                fail(fmt::format("has no step between the nodes of axis {}", a + 1));
            for (std::size_t b = 0; b < a; ++b)
                if (mesh.n[b] > 1 && std::fabs(dot(mesh.steps[a], mesh.steps[b])) >
                                         1e-6 * norm(mesh.steps[a]) * norm(mesh.steps[b]))
                    fail("describes a mesh whose axes are not at right angles");
        }
    }

    std::string path_;
    std::ifstream in_;
    int line_ = 0;
    std::vector<std::string> cells_;
};

} // namespace

MeshData read_mesh_data(const std::string& path)
{
    return MeshDataReader(path).run();
}

std::vector<double> values_at_time(const MeshData& data, double time)
{
    const auto later = std::upper_bound(data.times.begin(), data.times.end(), time);
    if (later == data.times.begin()) return data.values.front();
    if (later == data.times.end()) return data.values.back();
    const auto i = static_cast<std::size_t>(later - data.times.begin());
    const double share = (time - data.times[i - 1]) / (data.times[i] - data.times[i - 1]);
    std::vector<double> values = data.values[i - 1];
    for (std::size_t k = 0; k < values.size(); ++k)
        values[k] += share * (data.values[i][k] - values[k]);
    return values;
}

} // namespace fppg
