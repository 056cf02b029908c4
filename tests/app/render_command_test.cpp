#include "app/render_command.h"

#include "app/subcommands.h"
#include "files/helpers.h"
#include "fppg/error.h"

#include <gmock/gmock.h>

namespace fppg
{

namespace
{

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Writes Case_All.vtk of a few particles.
void write_case(const TestFolder& folder)
{
    OutputFile vtk(folder / "Case_All.vtk");
    write_particles_vtk(vtk, small_particles(), small_constants(), VtkSelection::All, 1);
    vtk.commit();
}

} // namespace

TEST(RenderCommand, WritesAPicture)
{
    const TestFolder folder;
    write_case(folder);
    EXPECT_EQ(run_render({folder / "Case", "-o", folder / "a.png", "--size", "160x120", "--mk",
                          "1-2,10", "--cut", "x>0", "--cut", "z<9", "--view", "front", "--zoom",
                          "1.5", "--center", "0.5,0.25,0.4", "--threads", "1"}),
              0);
    EXPECT_EQ(read_whole(folder / "a.png").substr(1, 3), "PNG");
}

TEST(RenderCommand, TakesTwoCasesBeforeOrAfterTheOptions)
{
    const TestFolder folder;
    write_case(folder);
    const std::string name = folder / "Case";
    EXPECT_EQ(run_render({name, name, "-o", folder / "a.png", "--size", "160x120"}), 0);
    EXPECT_EQ(run_render({"-o", folder / "b.png", "--size", "160x120", "--cut", "x>0", name, name}),
              0);
    EXPECT_THROW(run_render({name, name, name, "-o", folder / "c.png"}), UsageError);
}

/// One colour a layer, named under the picture; fluid and what has no layer have their own.
TEST(RenderCommand, ColoursTheLayersOfWalls)
{
    const TestFolder folder;
    {
        OutputFile vtk(folder / "Case_All.vtk");
        write_particles_vtk(vtk, walled_particles(), small_constants(), VtkSelection::All, 1);
        vtk.commit();
    }
    testing::internal::CaptureStdout();
    EXPECT_EQ(run_render({folder / "Case", "-o", folder / "layers.png", "--size", "160x120",
                          "--color", "layer"}),
              0);
    const std::string said = testing::internal::GetCapturedStdout();
    for (const char* name : {"layer 1\n", "layer 2\n", "layer 3\n", "no layer\n", "fluid\n"})
        EXPECT_THAT(said, HasSubstr(name));
    ASSERT_EQ(run_render({folder / "Case", "-o", folder / "mks.png", "--size", "160x120"}), 0);
    EXPECT_NE(read_whole(folder / "layers.png"), read_whole(folder / "mks.png"));
    EXPECT_THROW(run_render({folder / "Case", "-o", folder / "a.png", "--color", "layers"}),
                 UsageError);
}

TEST(RenderCommand, NamesWhatHasNoLayersToColourBy)
{
    const TestFolder folder;
    write_case(folder);
    EXPECT_THAT(
        [&] {
            run_render({folder / "Case", "-o", folder / "a.png", "--color", "layer"});
        },
        ThrowsMessage<Error>(HasSubstr("has no array Layer to colour by")));
}

TEST(RenderCommand, ExplainsAnUnknownView)
{
    EXPECT_THAT(
        [] {
            run_render({"Case", "-o", "a.png", "--view", "sideways"});
        },
        ThrowsMessage<UsageError>(HasSubstr("the view \"sideways\" is unknown")));
}

TEST(RenderCommand, RefusesANameOfAnotherFormat)
{
    EXPECT_THAT(
        [] {
            run_render({"Case", "-o", "a.jpg"});
        },
        ThrowsMessage<UsageError>(HasSubstr("ends in .png, the format that is written")));
}

TEST(RenderCommand, NamesAMissingCaseAndLeavesNoFile)
{
    const TestFolder folder;
    EXPECT_THAT(
        [&] {
            run_render({folder / "None", "-o", folder / "a.png"});
        },
        ThrowsMessage<IoError>(HasSubstr("None.bi4")));
    EXPECT_TRUE(folder.names().empty());
}

TEST(RenderCommand, RefusesWhatItCannotRead)
{
    const std::vector<std::vector<std::string>> wrong{
        {},
        {"Case"},
        {"-o", "a.png"},
        {"Case", "-o", "a.png", "--size", "10"},
        {"Case", "-o", "a.png", "--size", "10xx"},
        {"Case", "-o", "a.png", "--zoom", "large"},
        {"Case", "-o", "a.png", "--mk", "1,,2"},
        {"Case", "-o", "a.png", "--mk", "70000"},
        {"Case", "-o", "a.png", "--center", "1,2"},
        {"Case", "-o", "a.png", "--color", "rainbow"},
        {"Case", "-o", "a.png", "--threads", "-1"},
        {"Case", "-o", "a.png", "--unknown"},
    };
    for (const std::vector<std::string>& arguments : wrong)
        EXPECT_THROW(run_render(arguments), UsageError) << testing::PrintToString(arguments);
}

TEST(FindSubcommand, KnowsRenderAndLeavesTheRestToGenCasesForm)
{
    EXPECT_EQ(find_subcommand("render"), &run_render);
    EXPECT_EQ(find_subcommand("CaseDambreak_Def"), nullptr);
    EXPECT_EQ(find_subcommand("./render"), nullptr);
}

} // namespace fppg
