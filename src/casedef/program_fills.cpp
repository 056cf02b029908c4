// Commands that fill and redraw.
#include "casedef/program.h"
#include "shapes/figures.h"

#include <fmt/format.h>

#include <algorithm>

namespace fppg
{

BoxRegion ProgramRunner::box_of(const Element& e) const
{
    BoxRegion box;
    box.corner0 = read_.child_vec3(e, "point");
    if (const Element* end = e.find_child("endpoint"))
        box.corner1 = read_.vec3(*end);
    else
        box.corner1 = box.corner0 + read_.child_vec3(e, "size");
    return box;
}

/// The box of a fill or redraw before the matrix. Only its strict interior counts: to take in its
/// limits (setboxlimitmode full), it grows by dp.
BoxRegion ProgramRunner::limit_box_of(const Element& e, bool with_limits) const
{
    BoxRegion box = box_of(e);
    if (!with_limits) return box;
    for (int axis = 0; axis < 3; ++axis)
    {
        const double low = std::min(box.corner0[axis], box.corner1[axis]);
        const double high = std::max(box.corner0[axis], box.corner1[axis]);
        box.corner0[axis] = low - def_.grid.dp;
        box.corner1[axis] = high + def_.grid.dp;
    }
    return box;
}

void ProgramRunner::keep_picture(const Element& e, bool with_limits, std::optional<Vec3> seed)
{
    std::vector<BoxPicture>& pictures = def_.box_pictures;
    const auto forgotten_end = pictures.begin() + static_cast<std::ptrdiff_t>(pictures_forgotten_);
    const auto kept = std::remove_if(pictures.begin(), forgotten_end,
                                     [&](const BoxPicture& p) { return p.command == e.name; });
    pictures_forgotten_ = static_cast<std::size_t>(kept - pictures.begin());
    pictures.erase(kept, forgotten_end);
    const BoxRegion box = limit_box_of(e, with_limits);
    BoxPicture picture;
    picture.command = e.name;
    picture.mk = state_.mk.kind == MkKind::Void ? 0 : state_.mk.mk;
    picture.seed = seed;
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
        Vec3 p;
        for (int axis = 0; axis < 3; ++axis)
        {
            const double a = box.corner0[axis];
            const double b = box.corner1[axis];
            p[axis] = (corner >> axis & 1U) != 0 ? std::max(a, b) : std::min(a, b);
        }
        picture.corners[corner] = matrix_(p);
    }
    pictures.push_back(std::move(picture));
}

BoxLimits ProgramRunner::limits_of(const Element& e, bool with_limits) const
{
    const BoxRegion box = limit_box_of(e, with_limits);
    if (!keeps_boxes(matrix_)) return turned_box(box.corner0, box.corner1, matrix_);
    return BoxRegion{matrix_(box.corner0), matrix_(box.corner1)};
}

FillFilter ProgramRunner::fill_filter(const Element& e, const std::string& words) const
{
    FillFilter filter;
    const unsigned bits = read_.word_bits(e, words, "modefill",
                                          {{"void", 1}, {"fluid", 2}, {"bound", 4}, {"border", 8}});
    filter.names[static_cast<std::size_t>(MkKind::Void)] = (bits & 1) != 0;
    filter.names[static_cast<std::size_t>(MkKind::Fluid)] = (bits & 2) != 0;
    filter.names[static_cast<std::size_t>(MkKind::Bound)] = (bits & 4) != 0;
    filter.border = (bits & 8) != 0;
    filter.mkbound = absolute_mk(e, "mkbound", MkKind::Bound);
    filter.mkfluid = absolute_mk(e, "mkfluid", MkKind::Fluid);
    if (filter.names[static_cast<std::size_t>(MkKind::Bound)])
        check_mk(e, "mkbound", MkKind::Bound);
    if (filter.names[static_cast<std::size_t>(MkKind::Fluid)])
        check_mk(e, "mkfluid", MkKind::Fluid);
    return filter;
}

void ProgramRunner::check_mk(const Element& e, const char* attribute, MkKind kind) const
{
    const bool is_bound = kind == MkKind::Bound;
    const int count = is_bound ? def_.mkbound_count : def_.mkfluid_count;
    if (e.find_attribute(attribute) == nullptr) return;
    const int number = read_.integer(e, attribute, 0, 65000, false);
    if (number >= count)
        read_.fail(e, fmt::format("{}=\"{}\" is invalid, expected 0 to {} (<mkconfig {}=\"{}\">)",
                                  attribute, number, count - 1,
                                  is_bound ? "boundcount" : "fluidcount", count));
}

std::optional<std::uint16_t> ProgramRunner::absolute_mk(const Element& e, const char* attribute,
                                                        MkKind kind) const
{
    if (e.find_attribute(attribute) == nullptr) return std::nullopt;
    const int first = kind == MkKind::Bound ? def_.mk_bound_first : def_.mk_fluid_first;
    return static_cast<std::uint16_t>(read_.integer(e, attribute, 0, 65000 - first, false) + first);
}

MkFilter ProgramRunner::near_filter(const Element& e, const char* type, const char* mk) const
{
    std::string word = read_.text(e, type);
    for (char& c : word) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
    MkFilter filter;
    if (word == "void")
        filter.kind = MkKind::Void;
    else if (word == "bound")
        filter.kind = MkKind::Bound;
    else if (word == "fluid")
        filter.kind = MkKind::Fluid;
    else
        read_.fail(e, fmt::format("attribute {}=\"{}\" is invalid, expected void, fluid or bound",
                                  type, word));
    if (filter.kind == MkKind::Void) return filter;
    check_mk(e, mk, filter.kind);
    filter.mk = absolute_mk(e, mk, filter.kind);
    return filter;
}

bool ProgramRunner::run_fill_or_redraw(const Element& e)
{
    const std::string& name = e.name;
    if (name == "fillpoint" || name == "fillvoidpoint" || name == "fillbox" ||
        name == "fillfigure" || name == "fillprism")
    {
        FillOp op;
        op.seed = matrix_(read_.vec3(e));
        op.filter =
            fill_filter(e, name == "fillvoidpoint" ? "void" : read_.child(e, "modefill").text);
        if (name == "fillbox")
        {
            keep_picture(e, state_.box_limit_full, op.seed);
            op.region = limits_of(e, state_.box_limit_full);
        }
        if (name == "fillfigure")
        {
            FigureOp figure = figure_of(e);
            figure.solid = SolidKind::Faces;
            transform_figure(figure, matrix_);
            op.region = std::move(figure);
        }
        if (name == "fillprism") op.region = prism_limits(transformed_points(e, 6, 100'000'000));
        add(e, std::move(op));
    }
    else if (name == "redraw" || name == "redrawbox")
    {
        RedrawOp op;
        // With both attributes mkbound alone counts. A mkfluid beyond those of <mkconfig> is the
        // number of a boundary: with six of them mkfluid="6" recolours mkbound 0 (GenCase
        // v5.4.354, which refuses such a number in fills and redrawnear).
        const auto mkbound = absolute_mk(e, "mkbound", MkKind::Bound);
        const auto mk = mkbound ? mkbound : absolute_mk(e, "mkfluid", MkKind::Fluid);
        if (mk)
            op.filters.push_back({*mk >= def_.mk_bound_first ? MkKind::Bound : MkKind::Fluid, mk});
        if (name == "redrawbox")
        {
            // Without an mk it is for void nodes alone (seen with GenCase v5.4).
            if (op.filters.empty()) op.filters.push_back({MkKind::Void, std::nullopt});
            op.region = limits_of(e, false);
            keep_picture(e, false, std::nullopt);
        }
        add(e, std::move(op));
    }
    else if (name == "redrawnear" || name == "redrawnearbox")
    {
        RedrawNearOp op;
        op.target = near_filter(e, "targettp", "targetmk");
        op.border = near_filter(e, "bordertp", "bordermk");
        if (e.find_attribute("times") != nullptr)
            op.times = read_.integer(e, "times", 0, 1'000'000, true);
        if (const Element* filter = e.find_child("dirfilter"))
        {
            const unsigned bits = read_.word_bits(e, filter->text, "direction",
                                                  {{"all", 63},
                                                   {"top", 1},
                                                   {"bottom", 2},
                                                   {"right", 4},
                                                   {"left", 8},
                                                   {"back", 16},
                                                   {"front", 32}});
            for (std::size_t d = 0; d < 6; ++d) op.directions[d] = (bits >> d & 1) != 0;
        }
        if (name == "redrawnearbox")
        {
            op.region = limits_of(e, state_.box_limit_full);
            keep_picture(e, state_.box_limit_full, std::nullopt);
        }
        add(e, op);
    }
    else
        return false;
    return true;
}

} // namespace fppg
