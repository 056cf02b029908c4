// fppg convert and -to, run as users run them; FPPG_PROGRAM is the program's path. What the files
// hold is read here byte by byte, and by real readers in check_readers.py.

#include "fppg/element.h"

#include "casedef/xml_document.h"
#include "core/binary_items.h"
#include "files/bi4_view.h"
#include "helpers/case_text.h"
#include "helpers/run_fppg.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace
{

namespace fs = std::filesystem;
using namespace fppg::test;
using fppg::Element;
using testing::HasSubstr;

/// A tank with water, a fitted block of steel and a floating box, some of it with a name.
CaseText tank_with_bodies()
{
    CaseText text = tank();
    text.mainlist +=
        R"(<setmkbound mk="1" name="steel block" />)" +
        box_command(R"(x="0.2" y="0.2" z="0.13")", R"(x="0.34" y="0.3" z="0.27")") +
        R"(<setmkbound mk="2" /><drawbox objname="raft"><boxfill>solid</boxfill>)"
        R"(<point x="0.2" y="0.2" z="0.7" /><size x="0.5" y="0.5" z="0.2" /></drawbox>)";
    text.after_geometry = R"(<floatings><floating mkbound="2" rhopbody="500" /></floatings>)"
                          R"(<initials><velocity mkfluid="0" x="0.5" y="0" z="-0.25" /></initials>)"
                          R"(<fppg><bodyfitted mkbound="1" /></fppg>)";
    return text;
}

void make_case(const TemporaryFolder& folder, const CaseText& text, const Arguments& more = {})
{
    write_text(folder / "Case_Def.xml", text.text());
    Arguments words{"Case_Def", "out/Case", "-save:bi"};
    words.insert(words.end(), more.begin(), more.end());
    const RunResult result = run(folder, words);
    ASSERT_EQ(result.code, 0) << result.output;
}

RunResult convert(const TemporaryFolder& folder, Arguments words)
{
    words.insert(words.begin(), "convert");
    return run(folder, words);
}

template <typename T>
std::vector<T> numbers_at(std::string_view bytes, std::size_t at, std::size_t n)
{
    if (at + n * sizeof(T) > bytes.size()) throw std::runtime_error("the file ends too early");
    std::vector<T> out(n);
    std::memcpy(out.data(), bytes.data() + at, n * sizeof(T));
    return out;
}

template <typename T>
std::vector<T> array_of(std::string_view data)
{
    return numbers_at<T>(data, 0, data.size() / sizeof(T));
}

/// The particles of a .bi4.
struct Reference
{
    std::string bytes;
    std::vector<double> positions;
    std::vector<float> density, velocity;
    std::vector<std::uint32_t> ids;

    explicit Reference(const std::string& path) : bytes(read_text(path))
    {
        const fppg::Bi4View view = fppg::view_bi4(bytes, path);
        positions = array_of<double>(view.posd);
        density = array_of<float>(view.rhop);
        velocity = array_of<float>(view.vel);
        ids = array_of<std::uint32_t>(view.idp);
    }
};

/// A table with a line of names.
struct Table
{
    std::map<std::string, std::vector<std::string>> columns;
    std::size_t rows = 0;

    explicit Table(const std::string& text)
    {
        std::istringstream lines(text);
        std::string line;
        std::getline(lines, line);
        const std::vector<std::string> names = words_of(line);
        while (std::getline(lines, line))
        {
            const std::vector<std::string> words = words_of(line);
            EXPECT_EQ(words.size(), names.size()) << line;
            for (std::size_t i = 0; i < names.size(); ++i) columns[names[i]].push_back(words.at(i));
            ++rows;
        }
    }
    double number(const std::string& name, std::size_t row) const
    {
        return std::stod(columns.at(name).at(row));
    }
    static std::vector<std::string> words_of(const std::string& line)
    {
        std::vector<std::string> words(1);
        for (const char c : line)
            if (c == ',')
                words.emplace_back();
            else
                words.back() += c;
        return words;
    }
};

/// An array of a .vtu with appended raw data, by the name in its head.
template <typename T>
std::vector<T> vtu_array(const std::string& bytes, const std::string& name, const char* type)
{
    const std::size_t begin = bytes.find("encoding=\"raw\">\n_") + 17;
    const std::size_t place = bytes.find("Name=\"" + name + "\"");
    const std::string line = bytes.substr(place - 32, 200);
    EXPECT_THAT(line, HasSubstr(std::string("type=\"") + type + "\"")) << name;
    const std::size_t offset = bytes.find("offset=\"", place) + 8;
    const std::size_t at = begin + std::stoull(bytes.substr(offset, 20));
    const auto size = numbers_at<std::uint64_t>(bytes, at, 1)[0];
    return numbers_at<T>(bytes, at + 8, size / sizeof(T));
}

TEST(Convert, CsvKeepsEveryNumberOfTheParticles)
{
    const TemporaryFolder folder;
    make_case(folder, tank_with_bodies());
    const RunResult result = convert(folder, {"out/Case", "-o", "particles.csv"});
    ASSERT_EQ(result.code, 0) << result.output;
    EXPECT_THAT(result.output, HasSubstr("a .bi4 holds no volumes"));
    const Reference expected(folder / "out/Case.bi4");
    const Table table(read_text(folder / "particles.csv"));
    ASSERT_EQ(table.rows, expected.ids.size());
    for (std::size_t i = 0; i < table.rows; ++i)
    {
        const std::array names{"x", "y", "z"};
        const std::array velocities{"vx", "vy", "vz"};
        for (std::size_t a = 0; a < 3; ++a)
        {
            ASSERT_EQ(table.number(names[a], i), expected.positions[3 * i + a]);
            ASSERT_EQ(static_cast<float>(table.number(velocities[a], i)),
                      expected.velocity[3 * i + a]);
        }
        ASSERT_EQ(static_cast<float>(table.number("density", i)), expected.density[i]);
        ASSERT_EQ(table.number("id", i), expected.ids[i]);
        ASSERT_DOUBLE_EQ(table.number("volume", i), 1e-3);
    }
}

TEST(Convert, BodiesHaveTheNamesThatTheCaseGivesThem)
{
    const TemporaryFolder folder;
    make_case(folder, tank_with_bodies());
    ASSERT_EQ(convert(folder, {"out/Case.xml", "-o", "p.csv"}).code, 0);
    const Table table(read_text(folder / "p.csv"));
    std::map<std::string, std::string> types;
    std::map<std::string, double> masses;
    for (std::size_t i = 0; i < table.rows; ++i)
    {
        types[table.columns.at("body")[i]] = table.columns.at("type")[i];
        masses[table.columns.at("body")[i]] += table.number("mass", i);
    }
    const std::map<std::string, std::string> expected{
        {"bound0", "fixed"}, {"steel_block", "fixed"}, {"raft", "floating"}, {"fluid0", "fluid"}};
    EXPECT_EQ(types, expected);
    // Half of water, of all nodes of a box of 6 x 6 x 3.
    EXPECT_NEAR(masses["raft"], 500 * 108 * 1e-3, 1e-9);
}

TEST(Convert, ARunKnowsVolumesKindsAndNormalsOfFittedWalls)
{
    const TemporaryFolder folder;
    make_case(folder, tank_with_bodies(), {"-to:csv"});
    const Table table(read_text(folder / "out/Case.csv"));
    std::map<std::string, int> kinds;
    double volume = 0;
    for (std::size_t i = 0; i < table.rows; ++i)
    {
        if (table.columns.at("body")[i] != "steel_block") continue;
        volume += table.number("volume", i);
        ++kinds[table.columns.at("kind")[i]];
        if (table.columns.at("kind")[i] == "volume") continue;
        const double length =
            std::hypot(table.number("nx", i), table.number("ny", i), table.number("nz", i));
        ASSERT_NEAR(length, 1, 1e-6);
    }
    EXPECT_NEAR(volume, 0.34 * 0.3 * 0.27, 1e-6);
    EXPECT_EQ(kinds["corner"], 8);
    EXPECT_GT(kinds["edge"], 0);
    EXPECT_GT(kinds["surface"], 0);
}

TEST(Convert, VtuHoldsTheDoublesAsTheyAre)
{
    const TemporaryFolder folder;
    make_case(folder, tank_with_bodies());
    ASSERT_EQ(convert(folder, {"out/Case", "-o", "p.vtu"}).code, 0);
    const Reference expected(folder / "out/Case.bi4");
    const std::string bytes = read_text(folder / "p.vtu");
    EXPECT_EQ(vtu_array<double>(bytes, "Points", "Float64"), expected.positions);
    EXPECT_EQ(vtu_array<float>(bytes, "density", "Float32"), expected.density);
    EXPECT_EQ(vtu_array<float>(bytes, "velocity", "Float32"), expected.velocity);
    EXPECT_EQ(vtu_array<std::uint32_t>(bytes, "id", "UInt32"), expected.ids);
    EXPECT_EQ(vtu_array<std::int32_t>(bytes, "ndims", "Int32"), std::vector<std::int32_t>{3});
    const auto spacing = vtu_array<double>(bytes, "particle_spacing", "Float64");
    EXPECT_EQ(spacing, std::vector<double>(expected.ids.size(), 0.1));
    EXPECT_TRUE(bytes.ends_with("\n</AppendedData>\n</VTKFile>\n"));
}

/// The numbers in a text, by blanks and commas.
std::vector<double> numbers_of(std::string text)
{
    std::replace(text.begin(), text.end(), ',', ' ');
    std::istringstream words(text);
    std::vector<double> out;
    for (std::string word; words >> word;) out.push_back(std::stod(word));
    return out;
}

TEST(Convert, SphinxsysReloadsBodiesByTheirNamesInOneFileOrInMany)
{
    const TemporaryFolder folder;
    make_case(folder, tank_with_bodies(), {"-to:sphinxsys,sphinxsys-bodies"});
    const Reference expected(folder / "out/Case.bi4");
    const Element root = fppg::read_xml(folder / "out/Case_Reload.xml");
    std::vector<std::string> names;
    std::size_t i = 0;
    double volume = 0;
    for (const Element& body : root.children)
    {
        names.push_back(*body.find_attribute("name"));
        const Element old = fppg::read_xml(folder / ("out/" + names.back() + "_rld.xml"));
        ASSERT_EQ(old.children.size(), body.children.size());
        for (std::size_t k = 0; k < body.children.size(); ++k, ++i)
        {
            const Element& particle = body.children[k];
            ASSERT_EQ(particle.name, "particle");
            const std::vector<double> p = numbers_of(*particle.find_attribute("Position"));
            ASSERT_EQ(p.size(), 3U);
            for (std::size_t a = 0; a < 3; ++a) ASSERT_EQ(p[a], expected.positions[3 * i + a]);
            ASSERT_EQ(*old.children[k].find_attribute("Position"),
                      *particle.find_attribute("Position"));
            if (names.back() == "steel_block")
                volume += std::stod(*particle.find_attribute("VolumetricMeasure"));
        }
    }
    EXPECT_EQ(i, expected.ids.size());
    EXPECT_THAT(names, testing::ElementsAre("bound0", "steel_block", "raft", "fluid0"));
    EXPECT_NEAR(volume, 0.34 * 0.3 * 0.27, 1e-6);
}

float big_float(const std::string& bytes, std::size_t at)
{
    std::uint32_t bits = 0;
    for (std::size_t b = 0; b < 4; ++b)
        bits = bits << 8U | static_cast<unsigned char>(bytes.at(at + b));
    return std::bit_cast<float>(bits);
}

TEST(Convert, BgeoIsVersion5WithPositionsFromTheOriginThatIsSaid)
{
    const TemporaryFolder folder;
    make_case(folder, tank());
    const RunResult result = convert(folder, {"out/Case", "-o", "p.bgeo"});
    ASSERT_EQ(result.code, 0);
    EXPECT_THAT(result.output, HasSubstr("relative to the local origin (0.5, 0.5, 0.5)"));
    const Reference expected(folder / "out/Case.bi4");
    const std::size_t n = expected.ids.size();
    const std::string bytes = read_text(folder / "p.bgeo");
    EXPECT_EQ(bytes.substr(0, 5), "BgeoV");
    const auto whole = [&](std::size_t at)
    { return std::bit_cast<std::uint32_t>(big_float(bytes, at)); };
    EXPECT_EQ(whole(5), 5U);
    EXPECT_EQ(whole(9), n);
    const std::uint32_t attributes = whole(25);
    std::size_t at = 41;
    std::size_t row = 16;
    std::vector<std::string> names;
    for (std::uint32_t i = 0; i < attributes; ++i)
    {
        const auto length = static_cast<unsigned char>(bytes[at + 1]);
        names.push_back(bytes.substr(at + 2, length));
        const auto size = static_cast<unsigned char>(bytes[at + 2 + length + 1]);
        at += 2U + length + 2U + 4U + 4U * size;
        row += 4U * size;
    }
    EXPECT_THAT(names, testing::IsSupersetOf({"id", "velocity", "pscale"}));
    ASSERT_EQ(bytes.size(), at + n * row + 2);
    EXPECT_EQ(bytes.substr(bytes.size() - 2), std::string("\0\xff", 2));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t a = 0; a < 3; ++a)
            ASSERT_NEAR(big_float(bytes, at + i * row + 4 * a) + 0.5, expected.positions[3 * i + a],
                        1e-6);
}

TEST(Convert, DecksHaveANodeAndACellWithItsVolumePerParticle)
{
    const TemporaryFolder folder;
    make_case(folder, tank_with_bodies(), {"-to:ls-dyna,radioss"});
    const Reference expected(folder / "out/Case.bi4");
    struct Deck
    {
        const char* name;
        const char* cells;
        std::size_t id_width, real_width;
        double precision;
    };
    for (const Deck& deck : {Deck{"out/Case.k", "*ELEMENT_SPH_VOLUME", 8, 16, 1e-9},
                             Deck{"out/Case.rad", "/SPHCEL/", 10, 20, 1e-12}})
    {
        std::istringstream lines(read_text(folder / deck.name));
        std::size_t nodes = 0;
        std::size_t cells = 0;
        double volume = 0;
        bool is_cell = false;
        for (std::string line; std::getline(lines, line);)
        {
            if (line.starts_with(deck.cells)) is_cell = true;
            if (line[0] != ' ') continue;
            if (is_cell)
            {
                EXPECT_EQ(line.size(), 2 * deck.id_width + deck.real_width);
                volume += std::stod(line.substr(2 * deck.id_width));
                ++cells;
                continue;
            }
            ASSERT_EQ(line.size(), deck.id_width + 3 * deck.real_width);
            ASSERT_EQ(std::stoull(line.substr(0, deck.id_width)), nodes + 1);
            for (std::size_t a = 0; a < 3; ++a)
                ASSERT_NEAR(
                    std::stod(line.substr(deck.id_width + a * deck.real_width, deck.real_width)),
                    expected.positions[3 * nodes + a], deck.precision);
            ++nodes;
        }
        EXPECT_EQ(nodes, expected.ids.size()) << deck.name;
        EXPECT_EQ(cells, nodes) << deck.name;
        EXPECT_GT(volume, 0.34 * 0.3 * 0.27);
    }
}

/// A case with `twin` particles of each body turned round in the .bi4: the last come first, as in
/// an output of the solver, where ids stand in any order.
void turn_round(const std::string& path)
{
    std::string bytes = read_text(path);
    const fppg::Bi4View view = fppg::view_bi4(bytes, path);
    const auto turn = [&](std::string_view data, std::size_t width)
    {
        const std::string old(data);
        char* const to = bytes.data() + (data.data() - bytes.data());
        const std::size_t n = data.size() / width;
        for (std::size_t i = 0; i < n; ++i)
            std::memcpy(to + i * width, old.data() + (n - 1 - i) * width, width);
    };
    turn(view.idp, 4);
    turn(view.posd, 24);
    turn(view.rhop, 4);
    turn(view.vel, 12);
    write_text(path, bytes);
}

TEST(Convert, OutputsOfTheSolverFindTheirCaseOneFolderAboveWhateverTheOrderOfIds)
{
    const TemporaryFolder folder;
    make_case(folder, tank_with_bodies());
    ASSERT_EQ(convert(folder, {"out/Case", "-o", "case.xml", "--to", "sphinxsys"}).code, 0);
    fs::create_directories(folder / "out/data");
    fs::copy_file(folder / "out/Case.bi4", folder / "out/data/Part_0007.bi4");
    turn_round(folder / "out/data/Part_0007.bi4");
    const RunResult result =
        convert(folder, {"out/data/Part_0007.bi4", "-o", "part.xml", "--to", "sphinxsys"});
    ASSERT_EQ(result.code, 0) << result.output;
    const Element of_case = fppg::read_xml(folder / "case.xml");
    const Element of_part = fppg::read_xml(folder / "part.xml");
    ASSERT_EQ(of_part.children.size(), of_case.children.size());
    for (std::size_t b = 0; b < of_case.children.size(); ++b)
    {
        std::vector<std::string> places[2];
        for (const Element& p : of_case.children[b].children)
            places[0].push_back(*p.find_attribute("Position"));
        for (const Element& p : of_part.children[b].children)
            places[1].push_back(*p.find_attribute("Position"));
        std::reverse(places[1].begin(), places[1].end());
        EXPECT_EQ(places[0], places[1]);
    }
}

TEST(Convert, AnOutputWithoutItsCaseSaysWhatIsMissing)
{
    const TemporaryFolder folder;
    make_case(folder, tank());
    fs::create_directories(folder / "elsewhere");
    fs::copy_file(folder / "out/Case.bi4", folder / "elsewhere/Part_0000.bi4");
    const RunResult failed = convert(folder, {"elsewhere/Part_0000.bi4", "-o", "p.csv"});
    EXPECT_EQ(failed.code, 4);
    EXPECT_THAT(failed.output, HasSubstr("Part_0000.xml', which has, is not there"));
    const RunResult result =
        convert(folder, {"elsewhere/Part_0000.bi4", "--case-xml", "out/Case.xml", "-o", "p.csv"});
    EXPECT_EQ(result.code, 0) << result.output;
}

TEST(Convert, TheSameBytesComeFromAnyNumberOfThreads)
{
    const TemporaryFolder folder;
    CaseText text = tank_with_bodies();
    text.dp = "0.02"; // several pieces
    make_case(folder, text);
    for (const char* ending : {"csv", "vtu", "hdf5", "bgeo", "data", "k", "rad", "xdmf", "txt"})
    {
        std::vector<std::string> files;
        for (const char* threads : {"1", "2", "16"})
        {
            const std::string name = std::string("p.") + ending;
            ASSERT_EQ(convert(folder, {"out/Case", "-o", name, "--threads", threads}).code, 0);
            files.push_back(read_text(folder / name));
            if (std::string(ending) == "xdmf") files.back() += read_text(folder / "p.h5");
        }
        EXPECT_EQ(files[0], files[1]) << ending;
        EXPECT_EQ(files[0], files[2]) << ending;
    }
}

/// The sum that tools/bench/README.md describes, over the particles of a .bi4.
std::uint64_t checksum_of(const Reference& particles)
{
    std::uint64_t all = 0;
    for (std::size_t i = 0; i < particles.ids.size(); ++i)
    {
        std::uint64_t one = 0x9E3779B97F4A7C15;
        const double* at = &particles.positions[3 * i];
        for (const std::uint64_t word :
             {std::uint64_t{particles.ids[i]}, std::bit_cast<std::uint64_t>(at[0]),
              std::bit_cast<std::uint64_t>(at[1]), std::bit_cast<std::uint64_t>(at[2]),
              std::uint64_t{std::bit_cast<std::uint32_t>(particles.density[i])}})
        {
            one = (one ^ word) * 0xD6E8FEB86659FD93;
            one ^= one >> 32;
        }
        all += one;
    }
    return all;
}

TEST(Convert, ATallyIsThatOfTheParticlesWhetherTheyAreWrittenOrNot)
{
    const TemporaryFolder folder;
    CaseText text = tank_with_bodies();
    text.dp = "0.02"; // several pieces
    make_case(folder, text, {"-to:tally"});
    const std::string with_file = read_text(folder / "out/Case_tally.json");
    const Reference particles(folder / "out/Case.bi4");
    EXPECT_THAT(with_file, HasSubstr(fmt::format("\"particles\": {},", particles.ids.size())));
    EXPECT_THAT(with_file,
                HasSubstr(fmt::format("\"checksum\": \"{:016x}\"", checksum_of(particles))));
    EXPECT_THAT(with_file, HasSubstr("\"ids_in_order\": true"));
    EXPECT_THAT(with_file, HasSubstr("\"not_finite\": 0"));
    EXPECT_THAT(with_file, HasSubstr("\"name\": \"raft\", \"mk\": 12, \"type\": \"floating\""));
    for (const char* threads : {"-threads:1", "-threads:3", "-threads:16"})
    {
        fs::remove_all(folder / "out");
        make_case(folder, text, {"-save:-all", "-to:tally", threads});
        EXPECT_EQ(read_text(folder / "out/Case_tally.json"), with_file) << threads;
        EXPECT_FALSE(fs::exists(folder / "out/Case.bi4"));
    }
}

TEST(Convert, APlaneCaseLiesInXyForCodesThatHaveNoXz)
{
    const TemporaryFolder folder;
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.5" y="0.25" z="-0.5" />)";
    text.pointmax = R"(<pointmax x="1.5" y="0.25" z="1.5" />)";
    text.mainlist = R"(<setdrawmode mode="full" /><setmkfluid mk="0" />)" +
                    box_command(R"(x="0" y="0" z="0")", R"(x="0.5" y="1" z="1")");
    make_case(folder, text, {"-to:sphinxsys,trixi,vtu"});
    const Reference expected(folder / "out/Case.bi4");
    const Element root = fppg::read_xml(folder / "out/Case_Reload.xml");
    const Element& first = root.children[0].children[1];
    const std::vector<double> place{expected.positions[3], expected.positions[5]};
    EXPECT_EQ(numbers_of(*first.find_attribute("Position")), place);
    EXPECT_DOUBLE_EQ(std::stod(*first.find_attribute("VolumetricMeasure")), 0.01);
    const std::string trixi = read_text(folder / "out/Case_trixi_fluid0.vtu");
    EXPECT_EQ(vtu_array<std::int32_t>(trixi, "ndims", "Int32"), std::vector<std::int32_t>{2});
    const auto points = vtu_array<double>(trixi, "Points", "Float64");
    EXPECT_EQ(points[4], expected.positions[5]);
    EXPECT_EQ(points[5], 0);
    // ParaView shows the case as it is.
    EXPECT_EQ(vtu_array<double>(read_text(folder / "out/Case.vtu"), "Points", "Float64"),
              expected.positions);
}

TEST(Convert, WrongCallsSayWhatIsExpected)
{
    const TemporaryFolder folder;
    make_case(folder, tank());
    const RunResult ending = convert(folder, {"out/Case", "-o", "p.abc"});
    EXPECT_EQ(ending.code, 2);
    EXPECT_THAT(ending.output, HasSubstr("the ending of 'p.abc' means no format, expected --to"));
    const RunResult name = convert(folder, {"out/Case", "-o", "p.abc", "--to", "pyshp"});
    EXPECT_EQ(name.code, 2);
    EXPECT_THAT(name.output, HasSubstr("\"pyshp\" is unknown (did you mean pysph?)"));
    const RunResult run_option = run(folder, {"Case_Def", "out/Case", "-to:vtuu"});
    EXPECT_EQ(run_option.code, 2);
    EXPECT_THAT(run_option.output, HasSubstr("did you mean vtu?"));
    const std::string xml = read_text(folder / "out/Case.xml");
    const RunResult over = convert(folder, {"out/Case", "-o", "out/Case.xml"});
    EXPECT_EQ(over.code, 2);
    EXPECT_THAT(over.output, HasSubstr("'out/Case.xml' is a file of the case"));
    EXPECT_EQ(read_text(folder / "out/Case.xml"), xml);
    EXPECT_EQ(convert(folder, {"out/Nothing", "-o", "p.csv"}).code, 4);
}

TEST(Convert, AnOlderFileStaysWhereAParticleHasNoBody)
{
    const TemporaryFolder folder;
    make_case(folder, tank());
    write_text(folder / "p.csv", "older\n");
    std::string bytes = read_text(folder / "out/Case.bi4");
    const fppg::Bi4View view = fppg::view_bi4(bytes, "Case.bi4");
    const std::uint32_t stray = 1000000;
    std::memcpy(bytes.data() + (view.idp.data() - bytes.data()) + 40, &stray, sizeof stray);
    write_text(folder / "out/Case.bi4", bytes);
    const RunResult result = convert(folder, {"out/Case", "-o", "p.csv"});
    EXPECT_EQ(result.code, 3);
    EXPECT_THAT(result.output, HasSubstr("no block of <particles> holds the id 1000000"));
    EXPECT_EQ(read_text(folder / "p.csv"), "older\n");
    for (const auto& entry : fs::directory_iterator(folder.path()))
        EXPECT_THAT(entry.path().filename().string(), testing::Not(HasSubstr(".part-")));
}

} // namespace
