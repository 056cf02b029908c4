// fppg upgrade: the forms of normals.

#include "upgrade/upgrade_cases.h"

namespace
{

using namespace fppg::test;

TEST(UpgradeNormals, WrapsTheOldFormInNorgeometry)
{
    expect_upgrade(definition("        <normals>\r\n"
                              "            <!-- mDBC -->\r\n"
                              "            <distanceh value=\"2.0\" comment=\"far\" />\r\n"
                              "            <geometryfile file=\"[CaseName]_hdp_Actual.vtk\" />"
                              " <!-- c -->\r\n"
                              "            <svshapes value=\"1\" />\r\n"
                              "            <svnormals value=\"1\" />\r\n"
                              "        </normals>\r\n"),
                   definition("        <normals>\r\n"
                              "            <norgeometry>\r\n"
                              "                <!-- mDBC -->\r\n"
                              "                <distanceh v=\"2.0\" comment=\"far\" />\r\n"
                              "                <geometryfile file=\"[CaseName]_hdp_Actual.vtk\" />"
                              " <!-- c -->\r\n"
                              "                <svshapes v=\"1\" />\r\n"
                              "                <_svnormals value=\"1\" />\r\n"
                              "            </norgeometry>\r\n"
                              "        </normals>\r\n"));
    expect_upgrade(
        definition("<normals><maxsizeh value=\"1\"/><geometryfile file=\"a.vtk\"/></normals>"),
        definition("<normals><norgeometry><maxsizeh v=\"1\"/><geometryfile file=\"a.vtk\"/>"
                   "</norgeometry></normals>"));
}

TEST(UpgradeNormals, SwitchesOffWhatV54Refuses)
{
    expect_upgrade(
        definition("\t<normals>\n\t\t<geometryfile file=\"a.vtk\" />\n"
                   "\t\t<dg_svpartsnormal value=\"0\">\n\t\t\t<onlypos xmin=\"1\" />\n"
                   "\t\t</dg_svpartsnormal>\n\t\t<svnormaldata value=\"0\" />\n\t</normals>\n"),
        definition("\t<normals>\n\t\t<norgeometry>\n\t\t\t<geometryfile file=\"a.vtk\" />\n"
                   "\t\t\t<_dg_svpartsnormal value=\"0\">\n\t\t\t\t<onlypos xmin=\"1\" />\n"
                   "\t\t\t</_dg_svpartsnormal>\n\t\t\t<_svnormaldata value=\"0\" />\n"
                   "\t\t</norgeometry>\n\t</normals>\n"));
    const auto out = upgrade(
        definition("<normals><geometryfile file=\"a.vtk\"/><ftsupport value=\"0\"/></normals>"));
    ASSERT_EQ(out.notes.size(), 1U);
    EXPECT_EQ(out.notes[0].text, "<ftsupport>: v5.4 computes the normals of floating bodies too");
}

TEST(UpgradeNormals, TakesOutWhatTheOldFormPassedOver)
{
    expect_upgrade(definition("<normals><distanceh v=\"3\"/><geometryfile file=\"a\"/></normals>"),
                   definition("<normals><norgeometry><distanceh/><geometryfile file=\"a\"/>"
                              "</norgeometry></normals>"));
    expect_upgrade(definition("<normals><distanceh v=\"3\" value=\"1\"/><geometryfile file=\"a\"/>"
                              "</normals>"),
                   definition("<normals><norgeometry><distanceh v=\"1\"/><geometryfile file=\"a\"/>"
                              "</norgeometry></normals>"));
}

TEST(UpgradeNormals, LeavesAMixtureThatV54Refuses)
{
    expect_note(definition("<normals><geometryfile file=\"a\"/>\n<norset mkbound=\"1\"><normal "
                           "x=\"1\" y=\"0\" z=\"0\"/></norset></normals>"),
                5, "<norset>: GenCase v5.4 refuses it here");
    expect_note(definition("<normals><geometryfile file=\"a\"/><geometryfile file=\"b\"/>"
                           "</normals>"),
                4, "<geometryfile>: GenCase v5.4 refuses it here");
    expect_note(definition("<normals><norgeometry><geometryfile file=\"a\"/><distanceh "
                           "value=\"1\"/></norgeometry></normals>"),
                4, "passes over \"value\"");
}

std::string initialize(const std::string& inside)
{
    return "        <special>\n            <initialize>\n" + inside +
           "            </initialize>\n        </special>\n";
}

const char* const plane =
    "                <boundnormal_plane mkbound=\"10\">\n"
    "                    <point auto=\"true\" />\n"
    "                    <normal x=\"1\" y=\"0\" z=\"0\" /> <!-- x -->\n"
    "                </boundnormal_plane>\n";
const char* const moved_plane =
    "            <norplane mkbound=\"10\">\n"
    "                <point auto=\"true\" />\n"
    "                <normal x=\"1\" y=\"0\" z=\"0\" /> <!-- x -->\n"
    "            </norplane>\n";

TEST(UpgradeNormals, MovesNormalsOfTheSolverToGenCase)
{
    const std::string mk = "        <mkconfig boundcount=\"240\" fluidcount=\"9\" />\n";
    const std::string none = "        <special>\n        </special>\n";
    expect_upgrade(
        definition(mk, initialize(plane)),
        definition(mk + "        <normals>\n" + moved_plane + "        </normals>\n", none));
    expect_upgrade(definition("        <normals>\n            <norset />\n        </normals>\n",
                              initialize(plane)),
                   definition("        <normals>\n            <norset />\n" +
                                  std::string(moved_plane) + "        </normals>\n",
                              none));
    expect_upgrade(
        definition("        <normals />\n", initialize(plane)),
        definition("        <normals>\n" + std::string(moved_plane) + "        </normals>\n",
                   none));
}

TEST(UpgradeNormals, MovesThemBehindTheGeometry)
{
    const auto out = upgrade(definition(
        "<normals><geometryfile file=\"a\"/></normals>\n",
        "<special><initialize><boundnormal_sphere><center x=\"0\" y=\"0\" z=\"0\"/><radius "
        "v=\"1\"/><inside v=\"1\"/></boundnormal_sphere></initialize></special>\n"));
    EXPECT_EQ(out.text,
              definition("<normals><norgeometry><geometryfile file=\"a\"/></norgeometry>"
                         "<norsphere><center x=\"0\" y=\"0\" z=\"0\"/><radius v=\"1\"/><inside "
                         "v=\"1\"/></norsphere></normals>\n",
                         "<special></special>\n"));
    ASSERT_EQ(out.changes.size(), 2U);
    EXPECT_EQ(out.changes[1].line, 7);
    EXPECT_EQ(out.changes[1].from, "<initialize> <boundnormal_sphere>");
    EXPECT_EQ(out.changes[1].to, "<normals> <norsphere>");
}

TEST(UpgradeNormals, LeavesWhatElseTheSolverInitializes)
{
    const std::string flow =
        "                <fluidvelocity mkfluid=\"0\" />\n"
        "                <!-- c -->\n";
    const std::string set =
        "                <boundnormal_set mkbound=\"1\"><normal x=\"1\" "
        "y=\"0\" z=\"0\" /></boundnormal_set>\n";
    // The solver sets it after what GenCase computed.
    expect_upgrade(definition("", initialize(set)), definition("", initialize(set)));
    expect_upgrade(
        definition("", initialize(set + flow + plane)),
        definition("        <normals>\n            <norset mkbound=\"1\"><normal x=\"1\" y=\"0\" "
                   "z=\"0\" /></norset>\n" +
                       std::string(moved_plane) + "        </normals>\n",
                   initialize(flow)));
}

TEST(UpgradeNormals, NotesAPointThatV54FindsOtherwise)
{
    const auto notes = [](const std::string& normal)
    {
        return upgrade(definition("", initialize("<boundnormal_plane mkbound=\"1\"><onlypos>"
                                                 "<posmin x=\"1\"/></onlypos><point "
                                                 "auto=\"true\"/><normal " +
                                                 normal + "/></boundnormal_plane>\n")))
            .notes.size();
    };
    EXPECT_EQ(notes("x=\"0\" y=\"0.1\" z=\"1\""), 1U);
    EXPECT_EQ(notes("x=\"0\" y=\"0\" z=\"-1\""), 0U);
}

TEST(UpgradeNormals, LeavesNormalsThatV54DoesNotKnow)
{
    expect_note(
        definition("", initialize(std::string(plane) + "<boundnormal_curved mkbound=\"1\" />\n")),
        12, "<boundnormal_curved>: v5.4 does not know it");
    expect_note(definition("", initialize("<boundnormal_plane><corner v=\"1\" />"
                                          "</boundnormal_plane>\n")),
                8, "<boundnormal_plane>: v5.4 does not know it");
    expect_note(definition("<normals active=\"false\" />\n", initialize(plane)), 9,
                "is switched off");
}

} // namespace
