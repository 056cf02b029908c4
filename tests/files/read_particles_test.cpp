#include "fppg/read_particles.h"

#include "files/helpers.h"
#include "files/vtk.h"
#include "fppg/error.h"

#include <gmock/gmock.h>

namespace fppg
{

namespace
{

using testing::HasSubstr;
using testing::ThrowsMessage;

void save(const std::string& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
}

/// Writes name.bi4, name.xml and name_All.vtk.
void write_case(const TestFolder& folder, const std::string& name, const CaseParticles& particles)
{
    const CaseConstants constants = small_constants();
    OutputFile bi4(folder / (name + ".bi4"));
    write_bi4(bi4, particles, constants, {}, 1);
    bi4.commit();
    OutputFile vtk(folder / (name + "_All.vtk"));
    write_particles_vtk(vtk, particles, constants, VtkSelection::All, 1);
    vtk.commit();
    CaseDef def;
    def.casedef.name = "casedef";
    OutputFile xml(folder / (name + ".xml"));
    write_case_xml(xml, def, particles, constants, {}, {});
    xml.commit();
}

/// What a reader must find, made from the runs one node at a time.
ParticleCloud expected_cloud(const CaseParticles& particles)
{
    ParticleCloud cloud;
    const LatticeGrid& grid = particles.grid;
    for (const ParticleBlock& block : particles.blocks)
        for (const ParticleRun& run : block.runs)
            for (std::uint32_t k = 0; k < run.count; ++k)
            {
                const std::uint32_t z = block.run_descending ? run.z - k : run.z + k;
                cloud.positions.push_back(
                    run.is_off_lattice
                        ? particles.off_lattice.positions[run.off_lattice_begin() + k]
                        : grid.origin + grid.dp * Vec3{double(run.x), double(run.y), double(z)});
                cloud.mk.push_back(block.mk);
                cloud.type.push_back(static_cast<std::uint8_t>(block.type));
            }
    return cloud;
}

void expect_same(const ParticleCloud& found, const ParticleCloud& expected, double largest_distance)
{
    ASSERT_EQ(found.positions.size(), expected.positions.size());
    for (std::size_t i = 0; i < found.positions.size(); ++i)
        EXPECT_LE(norm(found.positions[i] - expected.positions[i]), largest_distance) << i;
    EXPECT_EQ(found.mk, expected.mk);
    EXPECT_EQ(found.type, expected.type);
}

/// A VTK file of points at (0, 0, i * 0.5) with these kinds.
std::string vtk_with_kinds(const std::vector<std::uint8_t>& kinds)
{
    const std::size_t n = kinds.size();
    std::string bytes = std::string(vtk_head) + "POINTS " + std::to_string(n) + " float\n";
    for (std::size_t i = 0; i < n; ++i)
        for (const float x : {0.0f, 0.0f, 0.5f * static_cast<float>(i)})
            append_big_endian(bytes, x);
    bytes += "\nPOINT_DATA " + std::to_string(n) + "\nFIELD FieldData 2\nMk 1 " +
             std::to_string(n) + " unsigned_char\n";
    bytes += std::string(n, '\x0a') + "\nKind 1 " + std::to_string(n) + " unsigned_char\n";
    for (const std::uint8_t kind : kinds) bytes += static_cast<char>(kind);
    return bytes + "\n";
}

} // namespace

TEST(ReadParticles, FindsInBi4AndCaseXmlWhatWasWritten)
{
    const TestFolder folder;
    const CaseParticles particles = small_particles();
    write_case(folder, "Case", particles);
    for (const char* name : {"Case", "Case.bi4", "Case.xml"})
    {
        const ParticleCloud cloud = read_particles(folder / name, false, 2);
        EXPECT_EQ(cloud.file, folder / "Case.bi4");
        EXPECT_EQ(cloud.dp, 0.1);
        expect_same(cloud, expected_cloud(particles), 1e-15);
    }
}

TEST(ReadParticles, FindsInVtkWhatWasWritten)
{
    const TestFolder folder;
    const CaseParticles particles = small_particles();
    write_case(folder, "Case", particles);
    const ParticleCloud cloud = read_particles(folder / "Case", true, 2);
    EXPECT_EQ(cloud.file, folder / "Case_All.vtk");
    EXPECT_EQ(cloud.dp, 0.1);
    EXPECT_TRUE(cloud.kind.empty());
    expect_same(cloud, expected_cloud(particles), 1e-6);
}

TEST(ReadParticles, FindsTheParticlesOffTheLatticeThatWereWritten)
{
    const TestFolder folder;
    const CaseParticles particles = walled_particles();
    write_case(folder, "Case", particles);
    expect_same(read_particles(folder / "Case.bi4", false, 2), expected_cloud(particles), 1e-15);
    EXPECT_TRUE(read_particles(folder / "Case.bi4", false, 2).positions[5] ==
                particles.off_lattice.positions[1]);
    const ParticleCloud cloud = read_particles(folder / "Case", true, 2);
    EXPECT_EQ(cloud.file, folder / "Case_All.vtk");
    expect_same(cloud, expected_cloud(particles), 1e-6);
    ASSERT_EQ(cloud.kind.size(), 28U);
    EXPECT_EQ(cloud.kind[4], 0);
    EXPECT_EQ(cloud.kind[5], 1);
    EXPECT_EQ(cloud.kind[25], 2);
    ASSERT_EQ(cloud.normals.size(), 28U);
    EXPECT_EQ(cloud.normals[25], particles.off_lattice.normals[2]);
    EXPECT_EQ(cloud.normals[0], (std::array<float, 3>{0, 0, 0}));
    CaseParticles with_normals = particles;
    with_normals.bound_normals.assign(11, {0, 0, 7});
    OutputFile bound(folder / "Case_Bound.vtk");
    write_particles_vtk(bound, with_normals, small_constants(), VtkSelection::Bound, 1);
    bound.commit();
    EXPECT_EQ(read_particles(folder / "Case_Bound.vtk", true, 2).normals.at(5),
              particles.off_lattice.normals[1]);
    ASSERT_EQ(cloud.distances.size(), 28U);
    EXPECT_EQ(cloud.distances[26], 0.1F);
    EXPECT_EQ(cloud.distances[6], distance_of_nodes);
}

TEST(ReadParticles, RefusesEveryVtkWithWallsWhoseArraysAreCutShort)
{
    const TestFolder folder;
    write_case(folder, "Case", walled_particles());
    const std::string path = folder / "Case_All.vtk";
    const std::string whole = read_whole(path);
    for (std::size_t size = whole.find("\nKind") + 1; size + 1 < whole.size(); ++size)
    {
        save(path, whole.substr(0, size));
        EXPECT_THROW(read_particles(path, true, 1), IoError) << size;
    }
}

TEST(ReadParticles, ReadsMkAbove255FromBothFormats)
{
    const TestFolder folder;
    const CaseParticles particles = make_particles(
        {columns(ParticleType::Fixed, 300, 0, 2, 3), columns(ParticleType::Fluid, 2, 4, 1, 2)});
    write_case(folder, "Case", particles);
    for (const bool has_kind_first : {false, true})
        expect_same(read_particles(folder / "Case", has_kind_first, 1), expected_cloud(particles),
                    1e-6);
}

TEST(ReadParticles, ReadsBi4With64BitSizes)
{
    const TestFolder folder;
    const CaseParticles particles = small_particles();
    write_case(folder, "Case", particles);
    save(folder / "Case.bi4",
         written([&](OutputFile& file)
                 { write_bi4(file, particles, small_constants(), {}, 1, 1); }));
    expect_same(read_particles(folder / "Case", false, 1), expected_cloud(particles), 1e-15);
}

TEST(ReadParticles, FindsKindAndGuessesDpOfALoneVtk)
{
    const TestFolder folder;
    save(folder / "lone.vtk", vtk_with_kinds({0, 1, 2, 3}));
    const ParticleCloud cloud = read_particles(folder / "lone.vtk", false, 1);
    EXPECT_EQ(cloud.kind, (std::vector<std::uint8_t>{0, 1, 2, 3}));
    EXPECT_TRUE(cloud.type.empty());
    EXPECT_EQ(cloud.dp, 0.5);
}

TEST(ReadParticles, RefusesWhatIsNotThereByName)
{
    const TestFolder folder;
    EXPECT_THAT([&] { read_particles(folder / "Case", false, 1); },
                ThrowsMessage<IoError>(HasSubstr("neither '" + (folder / "Case.bi4"))));
    EXPECT_THAT([&] { read_particles(folder / "a.vtk", false, 1); },
                ThrowsMessage<IoError>(HasSubstr("a.vtk': there is no such file")));
    save(folder / "b.bi4", "");
    EXPECT_THAT([&] { read_particles(folder / "b", false, 1); },
                ThrowsMessage<IoError>(HasSubstr("b.xml', which has, is not there")));
}

TEST(ReadParticles, RefusesEveryBi4ThatIsCutShort)
{
    const TestFolder folder;
    write_case(folder, "Case", small_particles());
    const std::string whole = read_whole(folder / "Case.bi4");
    for (std::size_t size = 0; size < whole.size(); size += 7)
    {
        save(folder / "Case.bi4", whole.substr(0, size));
        EXPECT_THROW(read_particles(folder / "Case", false, 1), IoError) << size;
    }
}

TEST(ReadParticles, RefusesEveryVtkWhoseArraysAreCutShort)
{
    const TestFolder folder;
    const std::string whole = vtk_with_kinds({3, 2, 1, 0});
    for (std::size_t size = 0; size + 1 < whole.size(); ++size)
    {
        save(folder / "a.vtk", whole.substr(0, size));
        // Cut just behind an array the file is whole, only poorer.
        try
        {
            EXPECT_TRUE(read_particles(folder / "a.vtk", false, 1).kind.empty()) << size;
        }
        catch (const IoError&)
        {
        }
    }
}

TEST(ReadParticles, SurvivesEveryChangedByteOfABi4)
{
    const TestFolder folder;
    write_case(folder, "Case", small_particles());
    const std::string whole = read_whole(folder / "Case.bi4");
    for (std::size_t i = 0; i < whole.size(); i += 7)
    {
        std::string bytes = whole;
        bytes[i] = static_cast<char>(~bytes[i]);
        save(folder / "Case.bi4", bytes);
        try
        {
            read_particles(folder / "Case", false, 1);
        }
        catch (const Error&)
        {
        }
    }
}

TEST(ReadParticles, NamesAnIdThatNoBlockHolds)
{
    const TestFolder folder;
    write_case(folder, "Case", small_particles());
    std::string xml = read_whole(folder / "Case.xml");
    const std::size_t place = xml.find("begin=\"", xml.rfind("<floating"));
    ASSERT_NE(place, std::string::npos);
    save(folder / "Case.xml", xml.insert(place + 7, "9"));
    EXPECT_THAT([&] { read_particles(folder / "Case", false, 1); },
                ThrowsMessage<CaseError>(HasSubstr("no block of <particles> holds the id ")));
}

TEST(ReadParticles, RefusesACaseOfOtherCounts)
{
    const TestFolder folder;
    write_case(folder, "Case", small_particles());
    std::string xml = read_whole(folder / "Case.xml");
    const std::size_t place = xml.find("count=\"4\"", xml.rfind("<floating"));
    ASSERT_NE(place, std::string::npos);
    save(folder / "Case.xml", xml.replace(place, 9, "count=\"2\""));
    EXPECT_THAT([&] { read_particles(folder / "Case", false, 1); },
                ThrowsMessage<IoError>(HasSubstr("are not of one run: ")));
}

TEST(ReadParticles, RefusesAsciiVtkAndVtkWithoutMk)
{
    const TestFolder folder;
    save(folder / "a.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n");
    EXPECT_THAT([&] { read_particles(folder / "a.vtk", false, 1); },
                ThrowsMessage<IoError>(HasSubstr("only binary VTK")));
    save(folder / "b.vtk", std::string(vtk_head) + "POINTS 0 float\n");
    EXPECT_THAT([&] { read_particles(folder / "b.vtk", false, 1); },
                ThrowsMessage<IoError>(HasSubstr("no point data Mk")));
}

} // namespace fppg
