#pragma once

#include "fppg/vec.h"
#include "helpers/case_text.h"

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace fppg::test
{

/// An output of the solver: its time and particles.
struct PartText
{
    double time = 0;
    std::uint32_t step = 0;
    std::uint64_t total = 0; ///< particles of the case
    bool has_time = true;
    std::vector<std::uint32_t> ids;
    std::vector<Vec3> positions;

    void add(std::uint32_t id, const Vec3& position)
    {
        ids.push_back(id);
        positions.push_back(position);
    }

    /// The bytes of Part_XXXX.bi4, with positions in single precision.
    std::string bytes() const
    {
        std::string values;
        std::uint32_t count = 0;
        const auto value = [&](std::string_view name, std::int32_t type, auto number)
        {
            put_text(values, name);
            put(values, type);
            put(values, number);
            ++count;
        };
        if (has_time) value("TimeStep", 12, time);
        value("Step", 8, step);
        value("NpTotal", 10, total);
        value("dtmin", 12, 1e-5);
        value("dtmax", 12, 2e-5);
        std::string points;
        for (const Vec3& p : positions)
            for (int axis = 0; axis < 3; ++axis) put(points, static_cast<float>(p[axis]));
        std::string id_bytes;
        for (const std::uint32_t id : ids) put(id_bytes, id);
        const std::string part = item("PART_0001", count, values,
                                      array("Idp", 8, id_bytes) + array("Pos", 22, points), 2, 0);
        std::string head = "#FileJBD JPartDataBi4";
        head.resize(58, ' ');
        head += std::string("\n\0\0\0\0\0", 6);
        return head + item("JPartDataBi4", 0, {}, part, 0, 1);
    }

private:
    template <typename T>
    static void put(std::string& out, T number)
    {
        char raw[sizeof number];
        std::memcpy(raw, &number, sizeof number);
        out.append(raw, sizeof number);
    }
    static void put_text(std::string& out, std::string_view text)
    {
        put(out, static_cast<std::uint32_t>(text.size()));
        out += text;
    }
    static std::string item(std::string_view name, std::uint32_t value_count,
                            const std::string& values, const std::string& inside,
                            std::uint32_t arrays, std::uint32_t items)
    {
        std::string content;
        put_text(content, "\nVALUES");
        put(content, value_count);
        content += values;
        std::string definition;
        put_text(definition, "\nITEM\n");
        put_text(definition, name);
        put(definition, std::int32_t{0});
        put(definition, std::int32_t{0});
        put_text(definition, "%.7E");
        put_text(definition, "%.15E");
        put(definition, arrays);
        put(definition, items);
        put(definition, static_cast<std::uint32_t>(content.size()));
        std::string out;
        put(out, static_cast<std::uint32_t>(definition.size()));
        return out + definition + content + inside;
    }
    std::string array(std::string_view name, std::int32_t type, const std::string& data) const
    {
        std::string definition;
        put_text(definition, "\nARRAY");
        put_text(definition, name);
        put(definition, std::int32_t{0});
        put(definition, type);
        put(definition, static_cast<std::uint32_t>(ids.size()));
        put(definition, static_cast<std::uint32_t>(data.size()));
        std::string out;
        put(out, static_cast<std::uint32_t>(definition.size()));
        return out + definition + data;
    }
};

} // namespace fppg::test
