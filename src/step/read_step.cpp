// The plugin that reads STEP files by OpenCASCADE. It is a library of its own, opened where a STEP
// file is read: linked into the program, OpenCASCADE's 60 libraries would make every start 50 ms
// longer.
#include "meshes/step_plugin.h"

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TCollection_AsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace
{

/// Points of faces that share an edge are the same, to this.
constexpr double same_point = 1e-6; // mm

struct Call
{
    double deflection = 0;
    double angle = 0;
    void* to = nullptr;
    FppgTakeStepPart take = nullptr;
};

std::string name_of(const TDF_Label& label)
{
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
    return TCollection_AsciiString(name->Get()).ToCString();
}

class PartMesh
{
public:
    void add(const TopoDS_Face& face)
    {
        TopLoc_Location location;
        const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
        if (mesh.IsNull()) return;
        std::vector<std::uint32_t> index(static_cast<std::size_t>(mesh->NbNodes()) + 1);
        for (int i = 1; i <= mesh->NbNodes(); ++i)
            index[static_cast<std::size_t>(i)] =
                point(mesh->Node(i).Transformed(location.Transformation()));
        const bool is_reversed = face.Orientation() == TopAbs_REVERSED;
        for (int t = 1; t <= mesh->NbTriangles(); ++t)
        {
            int a = 0, b = 0, c = 0;
            mesh->Triangle(t).Get(a, b, c);
            if (is_reversed) std::swap(b, c);
            const std::array<std::uint32_t, 3> corners{index[static_cast<std::size_t>(a)],
                                                       index[static_cast<std::size_t>(b)],
                                                       index[static_cast<std::size_t>(c)]};
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
                continue;
            corners_.insert(corners_.end(), corners.begin(), corners.end());
        }
    }

    void fill(FppgStepPart& part) const
    {
        part.points = points_.data();
        part.point_count = points_.size() / 3;
        part.corners = corners_.data();
        part.facet_count = corners_.size() / 3;
    }

private:
    /// Neighbouring faces have the points of their edge twice, apart by rounding.
    std::uint32_t point(const gp_Pnt& p)
    {
        const std::array<std::int64_t, 3> key{std::llround(p.X() / same_point),
                                              std::llround(p.Y() / same_point),
                                              std::llround(p.Z() / same_point)};
        const auto next = static_cast<std::uint32_t>(points_.size() / 3);
        const auto [at, is_new] = index_.try_emplace(key, next);
        if (is_new) points_.insert(points_.end(), {p.X(), p.Y(), p.Z()});
        return at->second;
    }

    std::vector<double> points_;
    std::vector<std::uint32_t> corners_;
    std::map<std::array<std::int64_t, 3>, std::uint32_t> index_;
};

gp_Dir normal_at(const TopoDS_Edge& edge, const TopoDS_Face& face, bool& is_known)
{
    double first = 0, last = 0;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
    is_known = false;
    if (curve.IsNull()) return {};
    const gp_Pnt2d uv = curve->Value((first + last) / 2);
    BRepLProp_SLProps props(BRepAdaptor_Surface(face), uv.X(), uv.Y(), 1, 1e-9);
    if (!props.IsNormalDefined()) return {};
    is_known = true;
    return face.Orientation() == TopAbs_REVERSED ? props.Normal().Reversed() : props.Normal();
}

void count_edges(const TopoDS_Shape& shape, FppgStepPart& part)
{
    TopTools_IndexedDataMapOfShapeListOfShape faces;
    TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i)
    {
        const TopoDS_Edge edge = TopoDS::Edge(faces.FindKey(i));
        if (BRep_Tool::Degenerated(edge)) continue;
        const TopTools_ListOfShape& beside = faces(i);
        if (beside.Extent() == 1)
        {
            ++part.sharp_edges;
            continue;
        }
        bool knows_a = false, knows_b = false;
        const gp_Dir a = normal_at(edge, TopoDS::Face(beside.First()), knows_a);
        const gp_Dir b = normal_at(edge, TopoDS::Face(beside.Last()), knows_b);
        // A seam, where a face meets itself, is smooth.
        const bool is_smooth =
            beside.First().IsSame(beside.Last()) || (knows_a && knows_b && a.Angle(b) < M_PI / 180);
        ++(is_smooth ? part.smooth_edges : part.sharp_edges);
    }
}

void send(const TopoDS_Shape& shape, const std::string& name, const Call& call)
{
    BRepMesh_IncrementalMesh(shape, call.deflection, Standard_False, call.angle, Standard_False);
    FppgStepPart part{};
    part.name = name.c_str();
    PartMesh mesh;
    for (TopExp_Explorer faces(shape, TopAbs_FACE); faces.More(); faces.Next())
        mesh.add(TopoDS::Face(faces.Current()));
    mesh.fill(part);
    if (part.facet_count == 0) return;
    GProp_GProps volume, area;
    BRepGProp::SurfaceProperties(shape, area, 1e-9);
    part.area = area.Mass();
    if (shape.ShapeType() == TopAbs_SOLID)
    {
        BRepGProp::VolumeProperties(shape, volume, 1e-9);
        part.volume = std::abs(volume.Mass());
    }
    count_edges(shape, part);
    call.take(call.to, &part);
}

/// Every solid of a shape, and what is in none: shells.
void send_all(const TopoDS_Shape& shape, const std::string& name, const Call& call)
{
    for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next())
        send(solids.Current(), name, call);
    for (TopExp_Explorer shells(shape, TopAbs_SHELL, TopAbs_SOLID); shells.More(); shells.Next())
        send(shells.Current(), name, call);
}

void walk(const Handle(XCAFDoc_ShapeTool) & tool, const TDF_Label& label,
          const TopLoc_Location& place, const std::string& name, const Call& call)
{
    TDF_Label part = label;
    if (tool->IsReference(label)) tool->GetReferredShape(label, part);
    const std::string own = name_of(part);
    // What writers call an instance that has no name of its own.
    const bool is_unnamed = name.empty() || name.rfind("NAUO", 0) == 0 || name.rfind("=>[", 0) == 0;
    const std::string called = is_unnamed ? own : name;
    if (tool->IsAssembly(part))
    {
        TDF_LabelSequence members;
        tool->GetComponents(part, members);
        for (int i = 1; i <= members.Length(); ++i)
            walk(tool, members.Value(i), place * tool->GetLocation(members.Value(i)),
                 name_of(members.Value(i)), call);
        return;
    }
    send_all(tool->GetShape(part).Moved(place), called, call);
}

std::string read(const char* path, const Call& call)
{
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
    STEPCAFControl_Reader reader;
    reader.SetNameMode(true);
    if (reader.ReadFile(path) != IFSelect_RetDone) return "is no STEP file, or cannot be read";
    if (!reader.Transfer(document)) return "holds no shape";
    const Handle(XCAFDoc_ShapeTool) tool = XCAFDoc_DocumentTool::ShapeTool(document->Main());
    TDF_LabelSequence free;
    tool->GetFreeShapes(free);
    for (int i = 1; i <= free.Length(); ++i)
        walk(tool, free.Value(i), tool->GetLocation(free.Value(i)), "", call);
    XCAFApp_Application::GetApplication()->Close(document);
    return "";
}

} // namespace

extern "C" __attribute__((visibility("default"))) const char* fppg_read_step(const char* path,
                                                                             double deflection,
                                                                             double angle, void* to,
                                                                             FppgTakeStepPart take)
{
    static std::string fault;
    try
    {
        fault = read(path, {deflection, angle, to, take});
    }
    catch (const Standard_Failure& failure)
    {
        fault = std::string("OpenCASCADE: ") + failure.GetMessageString();
    }
    return fault.c_str();
}
