#include "generated_cases.h"

#include <fmt/format.h>
#include <unistd.h>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <stdexcept>

namespace
{

using Corner = std::array<float, 3>;

void save(const std::string& path, const std::string& bytes)
{
    std::ofstream file(path, std::ios::binary);
    file << bytes;
    if (!file.flush()) throw std::runtime_error("cannot write " + path);
}

class StlText
{
public:
    explicit StlText(bool is_binary) : is_binary_(is_binary)
    {
        text_ = is_binary ? std::string(84, ' ') : "solid sphere\n";
    }

    void add(const Corner& a, const Corner& b, const Corner& c)
    {
        ++count_;
        if (is_binary_)
        {
            text_.append(12, '\0');
            for (const Corner* corner : {&a, &b, &c})
                text_.append(reinterpret_cast<const char*>(corner->data()), 12);
            text_.append(2, '\0');
            return;
        }
        text_ += "facet normal 0 0 0\nouter loop\n";
        for (const Corner* p : {&a, &b, &c})
            text_ += fmt::format("vertex {:.7e} {:.7e} {:.7e}\n", (*p)[0], (*p)[1], (*p)[2]);
        text_ += "endloop\nendfacet\n";
    }

    std::string finish()
    {
        if (!is_binary_) return text_ + "endsolid sphere\n";
        text_.replace(80, 4, reinterpret_cast<const char*>(&count_), 4);
        return text_;
    }

private:
    bool is_binary_;
    std::uint32_t count_ = 0;
    std::string text_;
};

} // namespace

WorkFolder::WorkFolder()
{
    std::string name = (std::filesystem::temp_directory_path() / "fppg-bench-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
}

WorkFolder::~WorkFolder()
{
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

void write_sphere_stl(const std::string& path, std::size_t rings, bool is_binary)
{
    const std::size_t sectors = 2 * rings;
    const auto corner = [&](std::size_t ring, std::size_t sector)
    {
        const double polar =
            std::numbers::pi * static_cast<double>(ring) / static_cast<double>(rings);
        const double around = 2 * std::numbers::pi * static_cast<double>(sector % sectors) /
                              static_cast<double>(sectors);
        // At the poles all sectors have one corner, to the last bit.
        const double r = ring == 0 || ring == rings ? 0 : 0.4 * std::sin(polar);
        return Corner{static_cast<float>(0.5 + r * std::cos(around)),
                      static_cast<float>(0.5 + r * std::sin(around)),
                      static_cast<float>(0.5 + 0.4 * std::cos(polar))};
    };
    StlText stl(is_binary);
    for (std::size_t ring = 0; ring < rings; ++ring)
        for (std::size_t s = 0; s < sectors; ++s)
        {
            const Corner a = corner(ring, s);
            const Corner b = corner(ring + 1, s);
            const Corner c = corner(ring + 1, s + 1);
            const Corner d = corner(ring, s + 1);
            if (ring + 1 < rings) stl.add(a, b, c);
            if (ring > 0) stl.add(a, c, d);
        }
    save(path, stl.finish());
}

void write_definition(const std::string& path, double dp, const std::string& commands)
{
    save(path, fmt::format(R"(<?xml version="1.0" encoding="UTF-8" ?>
<case>
    <casedef>
        <constantsdef>
            <gravity x="0" y="0" z="-9.81" />
            <rhop0 value="1000" />
            <rhopgradient value="2" />
            <hswl value="0" auto="true" />
            <gamma value="7" />
            <speedsystem value="0" auto="true" />
            <coefsound value="20" />
            <speedsound value="0" auto="true" />
            <coefh value="1" />
            <cflnumber value="0.2" />
        </constantsdef>
        <mkconfig boundcount="240" fluidcount="9" />
        <geometry>
            <definition dp="{}">
                <pointmin x="0" y="0" z="0" />
                <pointmax x="1" y="1" z="1" />
            </definition>
            <commands>
                <mainlist>
                    {}
                </mainlist>
            </commands>
        </geometry>
    </casedef>
    <execution>
        <parameters>
            <parameter key="TimeMax" value="1" />
        </parameters>
    </execution>
</case>
)",
                           dp, commands));
}
