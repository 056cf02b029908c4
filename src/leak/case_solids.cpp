#include "leak/case_solids.h"

#include "meshes/open_edges.h"
#include "walls/step_surfaces.h"

#include <fmt/format.h>

#include <set>
#include <utility>

namespace fppg
{

namespace
{

Vec3 place_before(const Vec3& p, std::uint16_t mk, const MotionOfMk& motions)
{
    const auto motion = motions.find(mk);
    return motion == motions.end() ? p : motion->second.backward(p);
}

class ShapeReader
{
public:
    ShapeReader(const Scene& scene, CaseSolids& out, int threads)
        : scene_(scene), out_(out), threads_(threads)
    {
    }

    void run()
    {
        for (const SceneStep& step : scene_.remaining())
        {
            if (step.combination && !step.combination->boolean->parts[0].is_surface)
                take_in(*step.combination);
            else if (step.draw->state->draw_points)
                take_in(step);
        }
    }

private:
    const Scene& scene_;
    CaseSolids& out_;
    int threads_;
    std::set<int> told_; ///< lines of recolouring draws

    static std::string name_of_shape(const DrawOp& op)
    {
        if (!op.source.name.empty()) return op.source.name;
        const auto* file = shape_as<MeshFileOp>(op);
        return fmt::format("{} (line {})", file != nullptr ? file->file : op.source.command,
                           op.source.line);
    }

    std::size_t add_shape(const DrawOp& op, ShapeMesh&& mesh, const MkValue& mk)
    {
        CaseShape shape;
        shape.name = name_of_shape(op);
        shape.kind = mk.kind;
        shape.mk = mk.mk;
        shape.is_filled = mesh.is_solid;
        shape.is_closed = open_edge_count(mesh.soup) == 0;
        shape.solid = std::make_unique<Solid>(std::move(mesh.soup), op.state->clips, threads_);
        out_.shapes.push_back(std::move(shape));
        return out_.shapes.size() - 1;
    }

    void take_in(const SceneStep& step)
    {
        const DrawOp& op = *step.draw;
        const Edit* edit = step.edit();
        if (edit != nullptr && is_redraw(*edit) && told_.insert(op.source.line).second)
            out_.notes.push_back(
                fmt::format("<{}> of line {} changes nodes, not shapes, and is ignored.",
                            op.source.command, op.source.line));
        for (StepSurface& surface : step_surfaces(scene_, step, threads_))
        {
            // Void and fluid take away what they fill.
            if (op.state->mk.kind != MkKind::Bound && !surface.shape.is_solid) continue;
            CaseDraw draw;
            draw.shapes = {add_shape(op, std::move(surface.shape), op.state->mk)};
            out_.draws.push_back(std::move(draw));
        }
    }

    void take_in(const Combination& combination)
    {
        CaseDraw draw;
        draw.is_combination = true;
        draw.tree = combination.boolean->tree;
        draw.stays = combination.stays;
        for (std::size_t p = 0; p < combination.parts.size(); ++p)
        {
            ShapeMesh surface = surface_of_part(scene_, combination, p, PartsAs::One, threads_);
            surface.is_solid = true;
            draw.shapes.push_back(
                add_shape(*combination.parts[p], std::move(surface), combination.mks[p]));
        }
        out_.draws.push_back(std::move(draw));
    }
};

} // namespace

std::size_t CaseSolids::find(const Vec3& p, const MotionOfMk& motions) const
{
    std::size_t hit = none;
    for (const CaseDraw& draw : draws)
    {
        if (!draw.is_judged) continue;
        if (draw.is_combination)
        {
            std::vector<char> is_in(draw.shapes.size());
            std::size_t first = none;
            for (std::size_t k = 0; k < draw.shapes.size(); ++k)
            {
                const CaseShape& shape = shapes[draw.shapes[k]];
                is_in[k] = shape.solid->is_inside(place_before(p, shape.mk, motions)) ? 1 : 0;
                if (first == none && is_in[k] != 0 && draw.stays[k] != 0) first = draw.shapes[k];
            }
            if (first != none && evaluate(draw.tree, is_in)) hit = first;
            continue;
        }
        const CaseShape& shape = shapes[draw.shapes.front()];
        if (shape.kind == MkKind::Bound)
        {
            if (shape.solid->is_inside(place_before(p, shape.mk, motions)))
                hit = draw.shapes.front();
        }
        else if (hit != none && shape.solid->is_inside(place_before(p, shapes[hit].mk, motions)))
            hit = none;
    }
    return hit;
}

CaseSolids case_solids(const Scene& scene, int threads)
{
    CaseSolids solids;
    ShapeReader(scene, solids, threads).run();
    return solids;
}

} // namespace fppg
