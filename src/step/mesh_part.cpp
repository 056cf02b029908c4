#include "step/step_file.h"

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepLProp_SLProps.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GCPnts_AbscissaPoint.hxx>
#include <GProp_GProps.hxx>
#include <Geom2d_Curve.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedDataMapOfShapeListOfShape.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>

#include <array>
#include <cmath>
#include <map>
#include <utility>

namespace fppg::step
{
namespace
{

constexpr std::uint32_t no_point = 0xFFFFFFFF;
constexpr double degree = 3.14159265358979323846 / 180;

/// Facets of the faces of a part. Faces share the points of the edges and vertices that they meet
/// in.
class Facets
{
public:
    explicit Facets(const TopoDS_Shape& shape)
    {
        TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
        TopExp::MapShapes(shape, TopAbs_VERTEX, vertices_);
    }

    /// face_index  for surface()
    bool add(const TopoDS_Face& face, std::uint32_t face_index)
    {
        TopLoc_Location location;
        const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
        if (mesh.IsNull() || !mesh->HasUVNodes()) return false;
        std::vector<std::uint32_t> index(static_cast<std::size_t>(mesh->NbNodes()) + 1, no_point);
        const auto place = [&](int node)
        { return mesh->Node(node).Transformed(location.Transformation()); };
        for (TopExp_Explorer e(face, TopAbs_EDGE); e.More(); e.Next())
            name_points(TopoDS::Edge(e.Current()), mesh, location, place, index);
        for (int i = 1; i <= mesh->NbNodes(); ++i)
            if (index[static_cast<std::size_t>(i)] == no_point)
                index[static_cast<std::size_t>(i)] = add_point(place(i));
        const bool is_reversed = face.Orientation() == TopAbs_REVERSED;
        for (int t = 1; t <= mesh->NbTriangles(); ++t)
        {
            std::array<int, 3> nodes{};
            mesh->Triangle(t).Get(nodes[0], nodes[1], nodes[2]);
            if (is_reversed) std::swap(nodes[1], nodes[2]);
            std::array<std::uint32_t, 3> corners{};
            for (std::size_t c = 0; c < 3; ++c)
                corners[c] = index[static_cast<std::size_t>(nodes[c])];
            if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0])
                continue;
            corners_.insert(corners_.end(), corners.begin(), corners.end());
            faces_.push_back(face_index);
            for (const int node : nodes)
            {
                const gp_Pnt2d uv = mesh->UVNode(node);
                uv_.push_back(uv.X());
                uv_.push_back(uv.Y());
            }
        }
        return true;
    }

    void fill(FppgStepMesh& out) const
    {
        out.points = points_.data();
        out.point_count = points_.size() / 3;
        out.corners = corners_.data();
        out.facet_count = corners_.size() / 3;
        out.faces = faces_.data();
        out.uv = uv_.data();
    }

private:
    template <typename Place>
    void name_points(const TopoDS_Edge& edge, const Handle(Poly_Triangulation) & mesh,
                     const TopLoc_Location& location, const Place& place,
                     std::vector<std::uint32_t>& index)
    {
        const Handle(Poly_PolygonOnTriangulation) polygon =
            BRep_Tool::PolygonOnTriangulation(edge, mesh, location);
        if (polygon.IsNull()) return;
        const TopoDS_Edge along = TopoDS::Edge(edge.Oriented(TopAbs_FORWARD));
        const int first = vertices_.FindIndex(TopExp::FirstVertex(along));
        const int last = vertices_.FindIndex(TopExp::LastVertex(along));
        const int of_edge = edges_.FindIndex(edge);
        const int n = polygon->NbNodes();
        const bool is_point = BRep_Tool::Degenerated(edge);
        for (int i = 1; i <= n; ++i)
        {
            const int node = polygon->Node(i);
            std::pair<int, int> key{of_edge, i};
            if ((i == 1 || is_point) && first > 0)
                key = {-first, 0};
            else if (i == n && last > 0)
                key = {-last, 0};
            const auto [at, is_new] = known_.try_emplace(key, no_point);
            if (is_new) at->second = add_point(place(node));
            index[static_cast<std::size_t>(node)] = at->second;
        }
    }

    std::uint32_t add_point(const gp_Pnt& p)
    {
        points_.insert(points_.end(), {p.X(), p.Y(), p.Z()});
        return static_cast<std::uint32_t>(points_.size() / 3 - 1);
    }

    TopTools_IndexedMapOfShape edges_, vertices_;
    std::map<std::pair<int, int>, std::uint32_t> known_; ///< by edge and node; below 0: by vertex
    std::vector<double> points_;
    std::vector<std::uint32_t> corners_, faces_;
    std::vector<double> uv_;
};

gp_Dir normal_at(const TopoDS_Edge& edge, const TopoDS_Face& face, double share, bool& is_known)
{
    double first = 0, last = 0;
    const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face, first, last);
    is_known = false;
    if (curve.IsNull()) return {};
    const gp_Pnt2d uv = curve->Value(first + share * (last - first));
    BRepLProp_SLProps props(BRepAdaptor_Surface(face), uv.X(), uv.Y(), 1, 1e-9);
    if (!props.IsNormalDefined()) return {};
    is_known = true;
    return face.Orientation() == TopAbs_REVERSED ? props.Normal().Reversed() : props.Normal();
}

/// Whether the faces on both sides are tangent all along an edge. A face that meets itself has the
/// edge twice, once each way.
bool is_smooth(const TopoDS_Edge& edge, const TopoDS_Face& a, const TopoDS_Face& b)
{
    const bool is_seam = a.IsSame(b);
    const TopoDS_Edge other = is_seam ? TopoDS::Edge(edge.Reversed()) : edge;
    for (const double share : {0.2, 0.5, 0.8})
    {
        bool knows_a = false, knows_b = false;
        const gp_Dir of_a = normal_at(edge, a, share, knows_a);
        const gp_Dir of_b = normal_at(other, b, share, knows_b);
        if (!knows_a || !knows_b || of_a.Angle(of_b) > degree) return false;
    }
    return true;
}

void count_edges(const TopoDS_Shape& shape, FppgStepMesh& out)
{
    TopTools_IndexedDataMapOfShapeListOfShape faces;
    TopExp::MapShapesAndAncestors(shape, TopAbs_EDGE, TopAbs_FACE, faces);
    for (int i = 1; i <= faces.Extent(); ++i)
    {
        const TopoDS_Edge edge = TopoDS::Edge(faces.FindKey(i));
        if (BRep_Tool::Degenerated(edge)) continue;
        const TopTools_ListOfShape& beside = faces(i);
        if (beside.Extent() == 2 &&
            is_smooth(edge, TopoDS::Face(beside.First()), TopoDS::Face(beside.Last())))
        {
            ++out.smooth_edges;
            continue;
        }
        ++out.sharp_edges;
        out.sharp_length += GCPnts_AbscissaPoint::Length(BRepAdaptor_Curve(edge));
    }
}

void measure(const TopoDS_Shape& shape, FppgStepMesh& out)
{
    GProp_GProps area;
    BRepGProp::SurfaceProperties(shape, area, 1e-9);
    out.area = area.Mass();
    if (shape.ShapeType() != TopAbs_SOLID) return;
    GProp_GProps volume;
    BRepGProp::VolumeProperties(shape, volume, 1e-9);
    const double sign = volume.Mass() < 0 ? -1 : 1;
    out.volume = sign * volume.Mass();
    const gp_Pnt center = volume.CentreOfMass();
    out.center[0] = center.X();
    out.center[1] = center.Y();
    out.center[2] = center.Z();
    const gp_Mat m = volume.MatrixOfInertia();
    const std::array<std::pair<int, int>, 6> entries{
        {{1, 1}, {2, 2}, {3, 3}, {1, 2}, {2, 3}, {1, 3}}};
    for (std::size_t e = 0; e < entries.size(); ++e)
        out.inertia[e] = sign * m(entries[e].first, entries[e].second);
}

} // namespace

void mesh_part(File& file, std::size_t index, double deflection, double angle, void* to,
               void (*take)(void* to, const FppgStepMesh* mesh))
{
    const TopoDS_Shape& shape = file.parts[index].shape;
    // Facets made before, for another deflection, would stay where they are finer.
    BRepTools::Clean(shape);
    if (!(deflection > 0))
    {
        Bnd_Box box;
        BRepBndLib::Add(shape, box, Standard_False);
        deflection = box.IsVoid() ? 1 : std::sqrt(box.SquareExtent()) / 2000;
    }
    const BRepMesh_IncrementalMesh mesher(shape, deflection, Standard_False, angle, Standard_False);
    Facets facets(shape);
    for (TopExp_Explorer e(shape, TopAbs_FACE); e.More(); e.Next())
    {
        const TopoDS_Face& face = TopoDS::Face(e.Current());
        if (facets.add(face, static_cast<std::uint32_t>(file.faces.size())))
            file.faces.push_back(BRep_Tool::Surface(face));
    }
    FppgStepMesh out{};
    facets.fill(out);
    measure(shape, out);
    count_edges(shape, out);
    take(to, &out);
}

} // namespace fppg::step
