#include "fppg/compare.h"

#include "compare/helpers.h"

#include <gmock/gmock.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace fppg
{

namespace
{

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Writes name.bi4 and name.xml.
void write_case(const TestFolder& folder, const std::string& name, const CaseParticles& particles,
                const CaseConstants& constants)
{
    OutputFile bi4(folder / (name + ".bi4"));
    write_bi4(bi4, particles, constants, {}, 1);
    bi4.commit();
    CaseDef def;
    def.casedef.name = "casedef";
    OutputFile xml(folder / (name + ".xml"));
    write_case_xml(xml, def, particles, constants, {}, {});
    xml.commit();
}

const MkComparison& mk_of(const Comparison& comparison, int mk)
{
    for (const MkComparison& of : comparison.mks)
        if (of.mk == mk) return of;
    throw std::runtime_error("no such mk");
}

std::vector<ChangedParticle> examples_of(const Comparison& comparison, ChangeKind kind)
{
    std::vector<ChangedParticle> out;
    for (const ChangedParticle& p : comparison.examples)
        if (p.kind == kind) out.push_back(p);
    return out;
}

void save(const std::string& path, const std::string& bytes)
{
    std::ofstream(path, std::ios::binary) << bytes;
}

/// One facet in the plane z = -0.25 that reaches far beyond the particles.
void write_ground(const std::string& path)
{
    save(path,
         "solid ground\nfacet normal 0 0 1\nouter loop\nvertex -100 -100 -0.25\nvertex 100 -100 "
         "-0.25\nvertex 0 200 -0.25\nendloop\nendfacet\nendsolid ground\n");
}

} // namespace

TEST(CompareResults, FindsACaseEqualToItself)
{
    const TestFolder folder;
    write_case(folder, "a", small_particles(), small_constants());
    const Comparison found = compare_results(folder / "a", folder / "a.bi4", {});
    EXPECT_TRUE(found.is_equal()) << to_text(found);
    EXPECT_EQ(found.dp, 0.1);
    EXPECT_TRUE(found.is_2d);
    EXPECT_EQ(mk_of(found, 15).same, 4U);
    EXPECT_EQ(mk_of(found, 15).type[1], 2);
    EXPECT_TRUE(found.notes.empty());
}

TEST(CompareResults, FindsTheVtkOfACaseEqualWithinWhatFloat32Rounds)
{
    const TestFolder folder;
    write_case(folder, "a", small_particles(), small_constants());
    OutputFile vtk(folder / "b_All.vtk");
    write_particles_vtk(vtk, small_particles(), small_constants(), VtkSelection::All, 1);
    vtk.commit();
    const Comparison found = compare_results(folder / "a", folder / "b", {});
    EXPECT_TRUE(found.is_equal()) << to_text(found);
    EXPECT_EQ(found.notes.size(), 2U) << "neither Case.bi4 nor Case.xml can be compared";
}

TEST(CompareResults, NamesASingleMovedParticleAndHowFarItWent)
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    changed[30].position.x += 0.3;
    const Comparison found = compare_sets(box_of(6, 5, 4), changed);
    ASSERT_EQ(found.findings.size(), 1U) << to_text(found);
    EXPECT_EQ(found.findings[0].category, "moved");
    EXPECT_THAT(found.findings[0].text, HasSubstr("id 30 at (1, 2, 2)"));
    const auto moved = examples_of(found, ChangeKind::Moved);
    ASSERT_EQ(moved.size(), 1U);
    EXPECT_EQ(moved[0].id[1], 30U);
    EXPECT_NEAR(moved[0].size, 0.3, 1e-12);
    EXPECT_NEAR(mk_of(found, 1).moved_dp.mean, 0.3, 1e-9);
}

TEST(CompareResults, CallsAParticleThatWentFartherThanDpMissingAndExtra)
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    changed.back().position.x += 1.5;
    const Comparison found = compare_sets(box_of(6, 5, 4), changed);
    EXPECT_EQ(mk_of(found, 1).missing, 1U);
    EXPECT_EQ(mk_of(found, 1).extra, 1U);
    EXPECT_EQ(mk_of(found, 1).moved, 0U);
}

TEST(CompareResults, RefusesResultsOfOtherCases)
{
    const TestFolder folder;
    write_particles(folder / "a.vtk", box_of(8, 8, 8));
    std::vector<TestParticle> far = box_of(8, 8, 8);
    for (TestParticle& p : far) p.position.x += 100;
    write_particles(folder / "far.vtk", far);
    std::vector<TestParticle> other = box_of(8, 8, 8);
    for (TestParticle& p : other) p.mk = 20;
    write_particles(folder / "other.vtk", other);
    const auto error_of = [&](const char* name)
    {
        try
        {
            compare_results(folder / "a.vtk", folder / name, {});
        }
        catch (const CompareError& error)
        {
            return std::string(error.what());
        }
        return std::string("no error");
    };
    EXPECT_NE(error_of("far.vtk").find("are not comparable, expected two results of one case: the "
                                       "boxes around their particles share 0 %"),
              std::string::npos)
        << error_of("far.vtk");
    EXPECT_NE(error_of("other.vtk").find("they have no mk in common"), std::string::npos)
        << error_of("other.vtk");
}

TEST(CompareResults, SaysWhatMattersBetweenTheLatticeAndAFittedResult)
{
    const TestFolder folder;
    write_particles(folder / "lattice.vtk", box_of(8, 8, 8));
    std::vector<TestParticle> fitted = box_of(8, 8, 8);
    for (TestParticle& p : fitted)
        if (p.mk == 10) p.position.x += 0.3 * std::sin(double(p.id));
    fitted.pop_back();
    write_particles(folder / "fitted.vtk", fitted);
    const Comparison found = compare_results(folder / "lattice.vtk", folder / "fitted.vtk", {});
    EXPECT_TRUE(found.is_of_two_modes());
    const std::string text = to_text(found);
    EXPECT_NE(text.find("A is on the lattice, B is body-fitted or moved off it"), std::string::npos)
        << text;
    EXPECT_NE(text.find("-0.39 %"), std::string::npos) << text;
    EXPECT_EQ(text.find(" moved, by"), std::string::npos) << text;
    const Comparison same = compare_results(folder / "lattice.vtk", folder / "lattice.vtk", {});
    EXPECT_FALSE(same.is_of_two_modes());
}

TEST(CompareResults, NamesSwappedIds)
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    std::swap(changed[3].id, changed[47].id);
    const Comparison found = compare_sets(box_of(6, 5, 4), changed);
    EXPECT_EQ(found.findings.size(), 1U) << to_text(found);
    const auto swapped = examples_of(found, ChangeKind::IdChanged);
    ASSERT_EQ(swapped.size(), 2U);
    EXPECT_EQ(swapped[0].id, (std::array<std::uint32_t, 2>{3, 47}));
    EXPECT_EQ(swapped[1].id, (std::array<std::uint32_t, 2>{47, 3}));
}

TEST(CompareResults, NamesAMissingMk)
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    std::erase_if(changed, [](const TestParticle& p) { return p.mk == 10; });
    const Comparison found = compare_sets(box_of(6, 5, 4), changed);
    ASSERT_FALSE(found.is_equal());
    EXPECT_EQ(found.findings[0].text, "mk 10: 60 in A, 0 in B");
    EXPECT_DOUBLE_EQ(found.findings[0].size, 0.5);
}

TEST(CompareResults, NamesAParticleOfAnotherMk)
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    changed[7].mk = 10; // was 1
    const Comparison found = compare_sets(box_of(6, 5, 4), changed);
    EXPECT_EQ(mk_of(found, 1).mk_changed, 1U);
    EXPECT_EQ(mk_of(found, 10).mk_gained, 1U);
    EXPECT_EQ(mk_of(found, 10).extra, 0U);
    EXPECT_THAT(to_text(found), HasSubstr("id 7 at (0, 1, 3) has mk 1 in A, mk 10 in B"));
}

TEST(CompareResults, PairsTwoParticlesAtOnePlaceWithTheirTwins)
{
    std::vector<TestParticle> particles = box_of(3, 3, 3);
    particles.push_back(particles[13]);
    particles.back().id = 27;
    EXPECT_TRUE(compare_sets(particles, particles).is_equal());
}

TEST(CompareResults, NamesDensitiesAndVelocitiesThatDiffer)
{
    std::vector<TestParticle> changed = box_of(6, 5, 4);
    changed[11].density += 2;
    changed[12].velocity = {0, 0.5F, 0};
    const Comparison found = compare_sets(box_of(6, 5, 4), changed);
    EXPECT_EQ(mk_of(found, 1).density.differing, 1U);
    EXPECT_EQ(mk_of(found, 1).density.largest, 2);
    EXPECT_EQ(examples_of(found, ChangeKind::Density).at(0).id[0], 11U);
    EXPECT_EQ(mk_of(found, 10).velocity.largest, 0.5);
    EXPECT_EQ(found.findings.size(), 2U) << to_text(found);
}

TEST(CompareResults, NamesNormalsThatDiffer)
{
    const TestFolder folder;
    CaseParticles particles = small_particles();
    particles.bound_normals.assign(9, {0, 0, 0.05F});
    write_case(folder, "a", particles, small_constants());
    particles.bound_normals[4] = {0, 0.05F, 0};
    write_case(folder, "b", particles, small_constants());
    const Comparison found = compare_results(folder / "a", folder / "b", {});
    ASSERT_EQ(found.findings.size(), 1U) << to_text(found);
    EXPECT_EQ(found.findings[0].category, "normal");
    EXPECT_NEAR(mk_of(found, 11).normal.largest, 0.5, 1e-6);
    write_case(folder, "c", small_particles(), small_constants());
    EXPECT_THAT(to_text(compare_results(folder / "a", folder / "c", {})),
                HasSubstr("only A has normals"));
}

TEST(CompareResults, NamesOtherConstants)
{
    const TestFolder folder;
    CaseConstants other = small_constants();
    other.gamma = 8;
    other.h *= 1 + 1e-7;
    write_case(folder, "a", small_particles(), small_constants());
    write_case(folder, "b", small_particles(), other);
    const Comparison found = compare_results(folder / "a", folder / "b", {});
    ASSERT_EQ(found.findings.size(), 3U) << to_text(found);
    EXPECT_EQ(found.findings[0].text, "Case.bi4 Gamma: 7 in A, 8 in B");
    EXPECT_EQ(found.findings[1].text, "execution/constants/gamma@value: 7 in A, 8 in B");
    EXPECT_DOUBLE_EQ(found.findings[1].size, 0.125);
    EXPECT_THAT(found.findings[2].text, HasSubstr("Case.bi4 H"));
}

TEST(CompareResults, NamesElementsThatOneXmlLacks)
{
    const TestFolder folder;
    write_case(folder, "a", small_particles(), small_constants());
    write_case(folder, "b", small_particles(), small_constants());
    std::string xml = read_whole(folder / "b.xml");
    xml.replace(xml.find("</execution>"), 0, "<beside key=\"Visco\" />");
    save(folder / "b.xml", xml);
    const Comparison found = compare_results(folder / "a", folder / "b", {});
    ASSERT_EQ(found.values.size(), 1U) << to_text(found);
    EXPECT_EQ(found.values[0].place, "execution/beside[key=Visco]");
    EXPECT_FALSE(found.values[0].a.has_value());
}

TEST(CompareResults, CutsSpaceIntoSlabsWithoutChangingTheResult)
{
    for (const auto& [nx, ny, nz] :
         {std::tuple(60, 6, 5), std::tuple(5, 60, 6), std::tuple(6, 5, 60)})
    {
        const std::vector<TestParticle> a = shaken(box_of(nx, ny, nz), 0.05);
        const std::vector<TestParticle> b = shaken(box_of(nx, ny, nz), 0.6);
        CompareOptions options;
        options.changed_at_most = 100;
        const Comparison whole = compare_sets(a, b, options);
        EXPECT_EQ(whole.blocks, 1U);
        EXPECT_GT(mk_of(whole, 1).moved, 100U);
        EXPECT_GT(mk_of(whole, 10).missing, 10U);
        std::size_t blocks = 1;
        for (const std::uint64_t most : {3000, 2000, 1})
            for (const int threads : {1, 8})
            {
                options.particles_at_once = most;
                options.threads = threads;
                const Comparison cut = compare_sets(a, b, options);
                EXPECT_GE(cut.blocks, blocks);
                blocks = cut.blocks;
                // Paths name the folder of the test, the rest must be equal to the last digit.
                const auto text = [](Comparison of)
                {
                    of.files[0].path = of.files[1].path = "";
                    of.options.threads = 1;
                    return to_text(of) + to_json(of);
                };
                EXPECT_EQ(text(cut), text(whole)) << most << " particles, " << threads;
                ASSERT_EQ(cut.changed.size(), whole.changed.size());
                for (std::size_t i = 0; i < cut.changed.size(); ++i)
                    EXPECT_EQ(cut.changed[i].index, whole.changed[i].index);
            }
        EXPECT_GE(blocks, 40U);
    }
}

TEST(CompareResults, CountsEveryParticleOnce)
{
    const Comparison found =
        compare_sets(shaken(box_of(12, 8, 9), 0.4), shaken(box_of(12, 9, 8), 0.5));
    for (const MkComparison& of : found.mks)
    {
        EXPECT_EQ(of.count[0], of.same + of.moved + of.missing + of.mk_changed);
        EXPECT_EQ(of.count[1], of.same + of.moved + of.extra + of.mk_gained);
        EXPECT_EQ(of.spacing_dp[1].count + of.alone[1], of.count[1]);
    }
}

TEST(CompareResults, MeasuresSpacingAndShepardSumsAsAPlainLoopDoes)
{
    const std::vector<TestParticle> particles = shaken(box_of(7, 6, 5), 0.3);
    const Comparison found = compare_sets(particles, particles);
    double spacing = 0;
    double shepard = 0;
    double n = 0;
    for (const TestParticle& p : particles)
    {
        if (p.mk != 1) continue;
        double nearest = 1e9;
        for (const TestParticle& o : particles)
        {
            const double r = norm(o.position - p.position);
            if (&o != &p) nearest = std::min(nearest, r);
            const double q = r / (1.3 * found.dp);
            if (q < 2)
                shepard +=
                    21 / (16 * M_PI * 1.3 * 1.3 * 1.3) * std::pow(1 - q / 2, 4) * (2 * q + 1);
        }
        spacing += nearest / found.dp;
        ++n;
    }
    EXPECT_NEAR(mk_of(found, 1).spacing_dp[0].mean, spacing / n, 1e-8);
    EXPECT_NEAR(mk_of(found, 1).shepard[0].mean, shepard / n, 1e-8);
}

TEST(CompareResults, MeasuresTheDistanceToTheGeometryOfWhatIsNear)
{
    const TestFolder folder;
    write_ground(folder / "ground.stl");
    CompareOptions options;
    options.geometry = {folder / "ground.stl"};
    const Comparison found = compare_sets(box_of(6, 5, 4), box_of(6, 5, 4), options);
    const Statistics& distance = mk_of(found, 10).distance_dp[0];
    EXPECT_EQ(distance.count, 60U) << "layers z = 0 and z = 1";
    EXPECT_NEAR(distance.mean, 0.75, 1e-9);
    EXPECT_NEAR(distance.deviation, 0.5, 1e-8);
    EXPECT_EQ(mk_of(found, 1).distance_dp[1].count, 0U);
}

TEST(CompareResults, SaysWhichParticlesStandAlone)
{
    std::vector<TestParticle> particles = box_of(6, 5, 4);
    particles.push_back({{50, 0, 0}, 120, 10});
    const Comparison found = compare_sets(particles, particles);
    EXPECT_EQ(mk_of(found, 10).alone[0], 1U);
    EXPECT_THAT(to_text(found), HasSubstr("mk 10 in A: 1 particles"));
}

TEST(CompareResults, ComparesFilesWithoutParticles)
{
    EXPECT_TRUE(compare_sets({}, {}).is_equal());
    const Comparison found = compare_sets({}, box_of(2, 2, 2));
    EXPECT_EQ(mk_of(found, 10).extra, 4U);
}

TEST(CompareResults, RefusesEveryCaseWhoseFilesAreCutShort)
{
    const TestFolder folder;
    write_case(folder, "a", small_particles(), small_constants());
    write_case(folder, "b", small_particles(), small_constants());
    for (const char* file : {"b.bi4", "b.xml"})
    {
        const std::string whole = read_whole(folder / file);
        for (std::size_t size = 0; size + 2 < whole.size(); size += 13)
        {
            save(folder / file, whole.substr(0, size));
            EXPECT_THROW(compare_results(folder / "a", folder / "b", {}), CompareError) << size;
        }
        save(folder / file, whole);
    }
}

TEST(CompareResults, RefusesAParticleThatIsNowhere)
{
    std::vector<TestParticle> particles = box_of(2, 2, 2);
    particles[5].position.y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THAT([&] { compare_sets(box_of(2, 2, 2), particles); },
                ThrowsMessage<CompareError>(HasSubstr("particle 5 is at (1, nan, 1)")));
}

TEST(CompareResults, RefusesParticlesTooFarApartForCells)
{
    std::vector<TestParticle> particles = box_of(2, 2, 2);
    particles[5].position.y = 1e300;
    EXPECT_THAT([&] { compare_sets(box_of(2, 2, 2), particles); },
                ThrowsMessage<CompareError>(HasSubstr("they reach over 1e+300 m")));
}

TEST(CloudsForPicture, TakeOneParticleOfEveryCubeWhereThereAreTooMany)
{
    const TestFolder folder;
    write_particles(folder / "a.vtk", box_of(8, 8, 8));
    const Comparison found = compare_results(folder / "a.vtk", folder / "a.vtk", {});
    EXPECT_EQ(clouds_for_picture(found, 512)[0].positions.size(), 512U);
    const auto clouds = clouds_for_picture(found, 511);
    EXPECT_EQ(clouds[1].positions.size(), 64U);
    EXPECT_EQ(clouds[1].dp, 2);
}

} // namespace fppg
