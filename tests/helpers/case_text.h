#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace fppg::test
{

/// A folder of its own for a test, removed afterwards.
class TemporaryFolder
{
public:
    TemporaryFolder()
    {
        std::string name = (std::filesystem::temp_directory_path() / "fppg-test-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
        path_ = name;
    }
    ~TemporaryFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::string operator/(const std::string& name) const { return (path_ / name).string(); }
    const std::filesystem::path& path() const { return path_; }

private:
    std::filesystem::path path_;
};

inline void write_text(const std::string& path, const std::string& text)
{
    std::ofstream out(path, std::ios::binary);
    out << text;
    if (!out.flush()) throw std::runtime_error("cannot write " + path);
}

inline std::string read_text(const std::string& path)
{
    std::ifstream in(path, std::ios::binary);
    if (!in) throw std::runtime_error("cannot read " + path);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// The text of a case definition, part by part; every part has a value that works.
struct CaseText
{
    std::string gravity = R"(<gravity x="0" y="0" z="-9.81" />)";
    std::string constants =
        R"(<rhop0 value="1000" /><hswl value="0" auto="true" /><gamma value="7" /><coefsound value="20" /><coefh value="1" /><cflnumber value="0.2" />)";
    std::string rhopgradient = R"(<rhopgradient value="2" />)";
    std::string mkconfig = R"(<mkconfig boundcount="240" fluidcount="9" />)";
    std::string predefinition;
    std::string dp = "0.1";
    std::string pointmin = R"(<pointmin x="-0.5" y="-0.5" z="-0.5" />)";
    std::string pointmax = R"(<pointmax x="1.5" y="1.5" z="1.5" />)";
    std::string lists;
    std::string mainlist;
    std::string after_geometry; ///< floatings, motion, properties and the like
    std::string execution = R"(<parameters><parameter key="TimeMax" value="1" /></parameters>)";

    std::string text() const
    {
        std::string out =
            "<?xml version=\"1.0\" encoding=\"UTF-8\" ?>\n<case><casedef>\n<constantsdef>";
        out += gravity + constants + rhopgradient + "</constantsdef>\n" + mkconfig +
               "\n<geometry>" + predefinition;
        out += "<definition dp=\"" + dp + "\">" + pointmin + pointmax +
               "</definition>\n<commands>" + lists;
        out += "<mainlist>\n" + mainlist + "\n</mainlist></commands></geometry>\n" + after_geometry;
        out += "\n</casedef>\n<execution>" + execution + "</execution></case>\n";
        return out;
    }
    /// The line of the file on which the first line of `mainlist` stands, when no part above has a
    /// line end.
    static constexpr int mainlist_line = 7;
};

/// A command for a solid box from (x0, y0, z0) with the size (sx, sy, sz).
inline std::string box_command(const std::string& point, const std::string& size,
                               const std::string& fill = "solid")
{
    return "<drawbox><boxfill>" + fill + "</boxfill><point " + point + " /><size " + size +
           " /></drawbox>";
}

/// A tank with water: floor and walls of mkbound 0, fluid of mkfluid 0.
inline CaseText tank()
{
    CaseText out;
    out.mainlist = R"(<setdrawmode mode="full" /><setmkfluid mk="0" />)" +
                   box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="0.6")") +
                   R"(<setmkbound mk="0" />)" +
                   box_command(R"(x="0" y="0" z="0")", R"(x="1" y="1" z="1")",
                               "bottom | left | right | front | back");
    return out;
}

} // namespace fppg::test
