#include "step/step_file.h"

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <Quantity_Color.hxx>
#include <STEPCAFControl_Reader.hxx>
#include <TCollection_AsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TDocStd_Document.hxx>
#include <TopExp_Explorer.hxx>
#include <XCAFApp_Application.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include <optional>

namespace fppg::step
{
namespace
{

std::string name_of(const TDF_Label& label)
{
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return "";
    return TCollection_AsciiString(name->Get()).ToCString();
}

/// What writers call an instance that has no name of its own.
bool is_no_name(const std::string& name)
{
    return name.empty() || name.rfind("NAUO", 0) == 0 || name.rfind("=>[", 0) == 0;
}

class Reading
{
public:
    Reading(const Handle(TDocStd_Document) & document, File& file)
        : shapes_(XCAFDoc_DocumentTool::ShapeTool(document->Main())),
          colors_(XCAFDoc_DocumentTool::ColorTool(document->Main())),
          file_(file)
    {
    }

    void run()
    {
        TDF_LabelSequence roots;
        shapes_->GetFreeShapes(roots);
        for (int i = 1; i <= roots.Length(); ++i)
            walk(roots.Value(i), shapes_->GetLocation(roots.Value(i)), {});
    }

private:
    /// What a part has from the assemblies above it.
    struct Above
    {
        std::string path;
        std::optional<Quantity_Color> color;
    };

    std::optional<Quantity_Color> color_of(const TDF_Label& label) const
    {
        Quantity_Color color;
        for (const XCAFDoc_ColorType type : {XCAFDoc_ColorSurf, XCAFDoc_ColorGen})
            if (colors_->GetColor(label, type, color)) return color;
        return std::nullopt;
    }

    void walk(const TDF_Label& label, const TopLoc_Location& place, Above above)
    {
        TDF_Label part = label;
        if (shapes_->IsReference(label)) shapes_->GetReferredShape(label, part);
        const std::string of_instance = part == label ? "" : name_of(label);
        const std::string own = name_of(part);
        if (!is_no_name(of_instance)) above.path += of_instance + "\n";
        if (own != of_instance && !own.empty()) above.path += own + "\n";
        if (const auto color = color_of(part)) above.color = color;
        if (const auto color = part == label ? std::nullopt : color_of(label)) above.color = color;
        if (!shapes_->IsAssembly(part))
        {
            add(shapes_->GetShape(part).Moved(place), is_no_name(of_instance) ? own : of_instance,
                above);
            return;
        }
        TDF_LabelSequence members;
        shapes_->GetComponents(part, members);
        for (int i = 1; i <= members.Length(); ++i)
            walk(members.Value(i), place * shapes_->GetLocation(members.Value(i)), above);
    }

    /// Every solid of a shape, and what is in none: shells, and faces in neither.
    void add(const TopoDS_Shape& shape, const std::string& name, const Above& above)
    {
        for (TopExp_Explorer solids(shape, TopAbs_SOLID); solids.More(); solids.Next())
            add_one(solids.Current(), name, above);
        for (TopExp_Explorer shells(shape, TopAbs_SHELL, TopAbs_SOLID); shells.More();
             shells.Next())
            add_one(shells.Current(), name, above);
        for (TopExp_Explorer faces(shape, TopAbs_FACE, TopAbs_SHELL); faces.More(); faces.Next())
            add_one(faces.Current(), name, above);
    }

    void add_one(const TopoDS_Shape& shape, const std::string& name, const Above& above)
    {
        Part part;
        part.shape = shape;
        part.name = name;
        part.path = above.path;
        Quantity_Color own;
        std::optional<Quantity_Color> color = above.color;
        if (colors_->GetColor(shape, XCAFDoc_ColorSurf, own) ||
            colors_->GetColor(shape, XCAFDoc_ColorGen, own))
            color = own;
        part.has_color = color.has_value();
        if (color) color->Values(part.color[0], part.color[1], part.color[2], Quantity_TOC_sRGB);
        file_.parts.push_back(part);
    }

    Handle(XCAFDoc_ShapeTool) shapes_;
    Handle(XCAFDoc_ColorTool) colors_;
    File& file_;
};

} // namespace

std::string read_file(const char* path, File& file)
{
    // The program says itself what is wrong.
    Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
    Handle(TDocStd_Document) document;
    XCAFApp_Application::GetApplication()->NewDocument("MDTV-XCAF", document);
    STEPCAFControl_Reader reader;
    reader.SetNameMode(true);
    reader.SetColorMode(true);
    if (reader.ReadFile(path) != IFSelect_RetDone) return "is no STEP file, or cannot be read";
    if (!reader.Transfer(document)) return "holds no shape";
    Reading(document, file).run();
    XCAFApp_Application::GetApplication()->Close(document);
    if (file.parts.empty()) return "holds no solid and no shell";
    return "";
}

} // namespace fppg::step
