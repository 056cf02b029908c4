#include "casedef/mesh_data.h"

#include "core/binary_items.h"
#include "core/finite_number.h"
#include "core/text.h"
#include "fppg/error.h"
#include "platform/file_map.h"
#include "platform/regular_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <string_view>

namespace fppg
{
namespace
{

constexpr std::uint32_t format_version = 200817;

/// What is wrong with the axes of a mesh; empty: nothing.
std::string wrong_steps(const MeshValues& mesh)
{
    for (std::size_t a = 0; a < 3; ++a)
    {
        if (mesh.n[a] < 2) continue;
        if (!(norm(mesh.steps[a]) > 0))
            return fmt::format("has no step between the nodes of axis {}", a + 1);
        for (std::size_t b = 0; b < a; ++b)
            if (mesh.n[b] > 1 && std::fabs(dot(mesh.steps[a], mesh.steps[b])) >
                                     1e-6 * norm(mesh.steps[a]) * norm(mesh.steps[b]))
                return "describes a mesh whose axes are not at right angles";
    }
    return {};
}

class TextReader
{
public:
    explicit TextReader(const std::string& path) : path_(path)
    {
        expect_regular_file(path);
        in_.open(path, std::ios::binary);
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
        if (cells_[0] != fmt::format("JMeshTDatas-{}", format_version))
            fail(fmt::format("has the format \"{}\", expected JMeshTDatas-{}", cells_[0],
                             format_version));
        data.is_vector = cells_[3] == "float3" || cells_[3] == "double3";
        if (!data.is_vector && cells_[3] != "float" && cells_[3] != "double")
            fail(fmt::format("has values of type \"{}\", expected float or float3", cells_[3]));
        const bool is_flat = cells_[4] == "true" || cells_[4] == "1";
        if (!is_flat && cells_[4] != "false" && cells_[4] != "0")
            fail(fmt::format("has Data12 = \"{}\", expected true or false", cells_[4]));
        std::size_t nodes = 1;
        for (std::size_t a = 0; a < 3; ++a)
        {
            const double n = number(5 + a);
            if (!(n >= 1 && n <= 1e6) || n != std::floor(n))
                fail(fmt::format("has \"{}\" nodes along axis {}", cells_[5 + a], a + 1));
            data.mesh.n[a] = is_flat && a == 2 ? 1 : static_cast<std::uint32_t>(n);
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
            std::vector<std::string_view> parts = split(line, separator);
            if (parts.back().empty()) parts.pop_back();
            for (const std::string_view part : parts) cells_.emplace_back(trimmed(part, " \t"));
        }
        return cells_;
    }

    double number(std::size_t column) const
    {
        const std::string& cell = cells_[column];
        const std::optional<double> value = finite_signed_number(cell);
        if (!value)
            fail(fmt::format("has \"{}\" in column {}, expected a number", cell, column + 1));
        return *value;
    }

    Vec3 vector(std::size_t column) const
    {
        return {number(column), number(column + 1), number(column + 2)};
    }

    void check_steps(const MeshValues& mesh) const
    {
        if (const std::string wrong = wrong_steps(mesh); !wrong.empty()) fail(wrong);
    }

    std::string path_;
    std::ifstream in_;
    int line_ = 0;
    std::vector<std::string> cells_;
};

class BinaryReader
{
public:
    BinaryReader(const std::string& path, std::string name)
        : path_(path), name_(std::move(name)), file_(path)
    {
    }

    MeshData run()
    {
        const std::vector<BinaryItem> items =
            read_binary_items(file_.bytes(), path_, "JMeshTDatas");
        const BinaryItem& head = items.front();
        if (const auto version = number<std::uint32_t>(head, "FormatVer", 8);
            version != format_version)
            fail(fmt::format("has the format version {}, expected {}", version, format_version));
        MeshData data;
        data.mesh.origin = vector(head, "MeshPtRef");
        for (std::size_t a = 0; a < 3; ++a)
        {
            data.mesh.steps[a] = vector(head, fmt::format("MeshVdp{}", a + 1));
            data.mesh.n[a] = number<std::uint32_t>(head, fmt::format("MeshNpt{}", a + 1), 8);
            if (data.mesh.n[a] < 1 || data.mesh.n[a] > 1'000'000)
                fail(fmt::format("has {} nodes along axis {}", data.mesh.n[a], a + 1));
        }
        if (tag_of_data(head) == flat_tag) data.mesh.n[2] = 1;
        if (const std::string wrong = wrong_steps(data.mesh); !wrong.empty()) fail(wrong);
        for (std::size_t i = 1; i < items.size(); ++i) add_time(items[i], data);
        if (data.times.empty()) fail("holds no time");
        return data;
    }

private:
    static constexpr std::int32_t flat_tag = 12;

    [[noreturn]] void fail(const std::string& text) const
    {
        throw CaseError(path_, 0, "the file " + text);
    }

    const BinaryValue& value(const BinaryItem& item, std::string_view name, int type) const
    {
        for (const BinaryValue& v : item.values)
        {
            if (v.name != name) continue;
            if (v.type != type)
                fail(fmt::format("has a value {} of type {}, expected {}", name, v.type, type));
            return v;
        }
        fail(fmt::format("has no value {}", name));
    }

    template <typename T>
    T number(const BinaryItem& item, std::string_view name, int type) const
    {
        T out;
        std::memcpy(&out, value(item, name, type).data.data(), sizeof out);
        return out;
    }

    Vec3 vector(const BinaryItem& item, std::string_view name) const
    {
        const Vec3 out = number<Vec3>(item, name, 23);
        if (!std::isfinite(out.x + out.y + out.z))
            fail(fmt::format("has a value {} that is not finite", name));
        return out;
    }

    /// The tag of the data wanted.
    std::int32_t tag_of_data(const BinaryItem& head) const
    {
        const auto count = number<std::uint32_t>(head, "Data_Count", 8);
        std::string names;
        for (std::uint32_t i = 0; i < std::min<std::uint32_t>(count, 100); ++i)
        {
            const std::string_view found = value(head, fmt::format("DataName_{:02}", i), 1).data;
            if (lower_case(found) == lower_case(name_))
                return number<std::int32_t>(head, fmt::format("DataTag_{:02}", i), 7);
            names += (names.empty() ? "" : ", ") + std::string(found);
        }
        fail(fmt::format("has no data named {}, only {}", name_, names.empty() ? "none" : names));
    }

    void add_time(const BinaryItem& item, MeshData& data) const
    {
        data.times.push_back(number<double>(item, "TimeStep", 12));
        if (!std::isfinite(data.times.back())) fail("has a time that is not finite");
        if (data.times.size() > 1 && !(data.times.back() > *(data.times.end() - 2)))
            fail(fmt::format("has a time {:g} s that does not follow {:g} s", data.times.back(),
                             *(data.times.end() - 2)));
        for (const BinaryArray& array : item.arrays)
        {
            if (lower_case(array.name) != lower_case(name_)) continue;
            const bool is_single = array.type == 11 || array.type == 22;
            data.is_vector = array.type == 22 || array.type == 23;
            if (!is_single && array.type != 12 && array.type != 23)
                fail(fmt::format("has data {} of type {}, expected float or float3", array.name,
                                 array.type));
            const std::uint64_t nodes =
                std::uint64_t{data.mesh.n[0]} * data.mesh.n[1] * data.mesh.n[2];
            const std::size_t n = array.data.size() / (is_single ? 4 : 8);
            if (n != nodes * (data.is_vector ? 3 : 1))
                fail(fmt::format("has {} numbers of {} at {:g} s, expected {} for {} nodes", n,
                                 array.name, data.times.back(), nodes * (data.is_vector ? 3 : 1),
                                 nodes));
            data.values.push_back(is_single ? numbers<float>(array.data, n)
                                            : numbers<double>(array.data, n));
            return;
        }
        fail(fmt::format("has no data {} at {:g} s", name_, data.times.back()));
    }

    template <typename T>
    std::vector<double> numbers(std::string_view bytes, std::size_t n) const
    {
        std::vector<double> out(n);
        for (std::size_t i = 0; i < n; ++i)
        {
            T v;
            std::memcpy(&v, bytes.data() + i * sizeof v, sizeof v);
            if (!std::isfinite(v))
                fail(fmt::format("has a number of {} that is not finite", name_));
            out[i] = static_cast<double>(v);
        }
        return out;
    }

    std::string path_;
    std::string name_;
    FileMap file_;
};

} // namespace

MeshData read_mesh_data(const std::string& path, const std::string& name)
{
    const std::string lower = lower_case(path);
    if (lower.ends_with(".csv")) return TextReader(path).run();
    if (lower.ends_with(".mbi4")) return BinaryReader(path, name).run();
    throw CaseError(path, 0, "the name of a file of mesh data ends in .csv or .mbi4");
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
