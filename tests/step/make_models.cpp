// Writes the STEP files of the tests by OpenCASCADE: make_step_models FOLDER. Their volumes, areas
// and edges are known by formulas (models.h).
#include "models.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Tool.hxx>
#include <GC_MakeArcOfCircle.hxx>
#include <Interface_Static.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Writer.hxx>
#include <STEPControl_Controller.hxx>
#include <TCollection_ExtendedString.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <TopoDS_Wire.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Ax1.hxx>
#include <gp_Trsf.hxx>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace
{

namespace m = fppg::test;

gp_Pnt at(double radius, double angle)
{
    return {radius * std::cos(angle), radius * std::sin(angle), 0};
}

/// Teeth with flanks along radii, between arcs of two circles, with a hole for the shaft.
TopoDS_Shape gear()
{
    BRepBuilderAPI_MakeWire wire;
    const auto arc = [&](double radius, double from, double to)
    {
        wire.Add(BRepBuilderAPI_MakeEdge(
            GC_MakeArcOfCircle(at(radius, from), at(radius, (from + to) / 2), at(radius, to))
                .Value()));
    };
    const double half = M_PI / m::gear_teeth;
    for (int t = 0; t < m::gear_teeth; ++t)
    {
        const double a = 2 * half * t;
        arc(m::gear_tip, a, a + half);
        wire.Add(BRepBuilderAPI_MakeEdge(at(m::gear_tip, a + half), at(m::gear_root, a + half)));
        arc(m::gear_root, a + half, a + 2 * half);
        wire.Add(
            BRepBuilderAPI_MakeEdge(at(m::gear_root, a + 2 * half), at(m::gear_tip, a + 2 * half)));
    }
    const TopoDS_Shape whole = BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(),
                                                     gp_Vec(0, 0, m::gear_width))
                                   .Shape();
    return BRepAlgoAPI_Cut(whole, BRepPrimAPI_MakeCylinder(m::gear_bore, m::gear_width).Shape())
        .Shape();
}

/// A block whose upright edges are rounded: planes and quarters of cylinders, tangent to one
/// another.
TopoDS_Shape block()
{
    const TopoDS_Shape box = BRepPrimAPI_MakeBox(m::block_x, m::block_y, m::block_z).Shape();
    BRepFilletAPI_MakeFillet fillet(box);
    for (TopExp_Explorer e(box, TopAbs_EDGE); e.More(); e.Next())
    {
        TopoDS_Vertex first, last;
        const TopoDS_Edge edge = TopoDS::Edge(e.Current());
        TopExp::Vertices(edge, first, last);
        if (std::fabs(BRep_Tool::Pnt(first).Z() - BRep_Tool::Pnt(last).Z()) > 1)
            fillet.Add(m::block_radius, edge);
    }
    return fillet.Shape();
}

/// A plate whose upper face bends by 8 degrees along a ridge: no dihedral angle of 15 finds it.
TopoDS_Shape roof()
{
    const double rise = m::roof_x / 2 * std::tan(m::roof_bend / 2);
    BRepBuilderAPI_MakeWire wire;
    const gp_Pnt corners[]{{0, 0, 0},
                           {m::roof_x, 0, 0},
                           {m::roof_x, 0, m::roof_z},
                           {m::roof_x / 2, 0, m::roof_z + rise},
                           {0, 0, m::roof_z}};
    for (int i = 0; i < 5; ++i) wire.Add(BRepBuilderAPI_MakeEdge(corners[i], corners[(i + 1) % 5]));
    return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(),
                                 gp_Vec(0, m::roof_y, 0))
        .Shape();
}

TopoDS_Shape shaft()
{
    return BRepPrimAPI_MakeCylinder(m::shaft_radius, m::shaft_length).Shape();
}

TopoDS_Shape torus()
{
    return BRepPrimAPI_MakeTorus(m::torus_big, m::torus_small).Shape();
}

class Model
{
public:
    Model()
    {
        XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document_);
        shapes_ = XCAFDoc_DocumentTool::ShapeTool(document_->Main());
        colors_ = XCAFDoc_DocumentTool::ColorTool(document_->Main());
    }

    TDF_Label part(const TopoDS_Shape& shape, const char* name, const Quantity_Color& color)
    {
        const TDF_Label label = shapes_->AddShape(shape, Standard_False);
        TDataStd_Name::Set(label, name);
        colors_->SetColor(label, color, XCAFDoc_ColorSurf);
        return label;
    }

    TDF_Label assembly(const char* name)
    {
        const TDF_Label label = shapes_->NewShape();
        TDataStd_Name::Set(label, name);
        return label;
    }

    void put(const TDF_Label& in, const TDF_Label& part, const char* name, const gp_Trsf& place)
    {
        TDataStd_Name::Set(shapes_->AddComponent(in, part, TopLoc_Location(place)), name);
    }

    void write(const std::string& path, const char* unit = "MM")
    {
        shapes_->UpdateAssemblies();
        STEPControl_Controller::Init();
        Interface_Static::SetCVal("write.step.unit", unit);
        STEPCAFControl_Writer writer;
        writer.SetColorMode(true);
        writer.SetNameMode(true);
        writer.Transfer(document_);
        if (writer.Write(path.c_str()) != IFSelect_RetDone)
        {
            std::fprintf(stderr, "cannot write %s\n", path.c_str());
            std::exit(1);
        }
    }

private:
    Handle(TDocStd_Document) document_;
    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colors_;
};

gp_Trsf moved(double x, double y, double z, const gp_Dir& axis = gp_Dir(0, 0, 1), double angle = 0)
{
    gp_Trsf turn, move;
    turn.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), axis), angle);
    move.SetTranslation(gp_Vec(x, y, z));
    return move * turn;
}

const Quantity_Color red(0.8, 0.1, 0.1, Quantity_TOC_sRGB);
const Quantity_Color green(0.1, 0.6, 0.2, Quantity_TOC_sRGB);
const Quantity_Color blue(0.1, 0.2, 0.9, Quantity_TOC_sRGB);

void write_one(const TopoDS_Shape& shape, const char* name, const std::string& folder,
               const char* unit = "MM")
{
    Model model;
    model.part(shape, name, red);
    model.write(folder + "/" + name + ".step", unit);
}

void write_assembly(const std::string& folder)
{
    Model model;
    const TDF_Label of_gear = model.part(gear(), "gear", red);
    const TDF_Label of_shaft = model.part(shaft(), "shaft", green);
    const TDF_Label of_torus = model.part(torus(), "seal", blue);
    const TDF_Label of_block = model.part(block(), "housing", green);
    const TDF_Label of_roof = model.part(roof(), "roof", blue);
    const TDF_Label drive = model.assembly("drive");
    model.put(drive, of_gear, "wheel", moved(0, 0, 0));
    model.put(drive, of_shaft, "axle", moved(0, 0, -m::shaft_length / 2));
    const TDF_Label all = model.assembly("machine");
    model.put(all, drive, "drive1", moved(100, 20, 30, gp_Dir(1, 2, 3), 0.7));
    model.put(all, of_torus, "ring", moved(-80, 0, 10, gp_Dir(1, 0, 0), 0.4));
    model.put(all, of_block, "housing1", moved(0, 150, 0, gp_Dir(0, 0, 1), 0.3));
    model.put(all, of_roof, "lid", moved(0, -150, 5, gp_Dir(0, 1, 0), -0.2));
    model.write(folder + "/assembly.step");
}

/// What the formulas say, as JSON, for the scripts.
void write_known(const std::string& folder)
{
    std::FILE* file = std::fopen((folder + "/known.json").c_str(), "w");
    if (file == nullptr) std::exit(1);
    const auto part = [&](const char* name, const m::KnownPart& known, const char* behind)
    {
        std::fprintf(file,
                     "\"%s\": {\"volume\": %.17g, \"area\": %.17g, \"sharp_edges\": %d, "
                     "\"smooth_edges\": %d, \"sharp_length\": %.17g}%s\n",
                     name, known.volume, known.area, known.sharp_edges, known.smooth_edges,
                     known.sharp_length, behind);
    };
    std::fprintf(file, "{\n");
    part("cylinder", m::known_cylinder(), ",");
    part("torus", m::known_torus(), ",");
    part("gear", m::known_gear(), ",");
    part("block", m::known_block(), ",");
    part("roof", m::known_roof(), ",");
    std::fprintf(file,
                 "\"cylinder_radius\": %g, \"cylinder_length\": %g, \"torus_big\": %g, "
                 "\"torus_small\": %g, \"gear_tip\": %g, \"gear_root\": %g, \"gear_bore\": %g, "
                 "\"gear_teeth\": %d, \"gear_width\": %g\n}\n",
                 m::shaft_radius, m::shaft_length, m::torus_big, m::torus_small, m::gear_tip,
                 m::gear_root, m::gear_bore, m::gear_teeth, m::gear_width);
    std::fclose(file);
}

} // namespace

int main(int argc, char** argv)
{
    if (argc != 2) return 2;
    const std::string folder = argv[1];
    write_one(shaft(), "cylinder", folder);
    write_one(torus(), "torus", folder, "INCH");
    write_one(gear(), "gear", folder);
    write_one(block(), "block", folder);
    write_one(roof(), "roof", folder);
    write_assembly(folder);
    write_known(folder);
    return 0;
}
