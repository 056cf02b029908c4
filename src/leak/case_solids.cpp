#include "leak/case_solids.h"

#include "fppg/error.h"
#include "fppg/shapes.h"

#include "casedef/mesh_path.h"
#include "lattice/draw_checks.h"
#include "lattice/shape_mesh.h"

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>
#include <set>

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
    ShapeReader(const CaseDef& def, CaseSolids& out, int threads)
        : def_(def), out_(out), threads_(threads)
    {
    }

    void run()
    {
        for (std::size_t i = 0; i < def_.ops.size(); ++i)
        {
            const DrawOp& op = def_.ops[i];
            if (std::holds_alternative<ResetOp>(op.what))
            {
                out_.draws.clear();
                out_.shapes.clear();
                continue;
            }
            const BooleanDef* boolean = boolean_with(i);
            if (boolean == nullptr)
                take_in(op);
            else if (boolean->is_drawn && is_last_part(*boolean, i))
                take_in(*boolean);
        }
    }

private:
    const CaseDef& def_;
    CaseSolids& out_;
    int threads_;
    std::set<int> told_; ///< lines of recolouring draws

    const BooleanDef* boolean_with(std::size_t op) const
    {
        for (const BooleanDef& boolean : def_.booleans)
            for (const BooleanDef::Part& part : boolean.parts)
                if (part.op == op) return &boolean;
        return nullptr;
    }

    static bool is_last_part(const BooleanDef& boolean, std::size_t op)
    {
        return std::all_of(boolean.parts.begin(), boolean.parts.end(),
                           [&](const BooleanDef::Part& part) { return part.op <= op; });
    }

    /// Beside the definition first: that is the mesh that the case was made with, even where the
    /// working directory has another one of that name.
    std::string place_of(const DrawOp& op, const std::string& file) const
    {
        std::error_code ignored;
        std::string beside = (std::filesystem::path(def_.file).parent_path() / file).string();
        if (std::filesystem::exists(beside, ignored)) return beside;
        return find_mesh_file(def_, op.source, file);
    }

    std::vector<ShapeMesh> shapes_of(const DrawOp& op) const
    {
        try
        {
            if (const auto* file = std::get_if<MeshFileOp>(&op.what))
            {
                const MeshFile mesh = read_mesh_file(place_of(op, file->file), file->reading);
                if (mesh.soup.vertices.empty()) return {};
                return shape_meshes(op, &mesh.soup, def_.grid.dp);
            }
            if (const auto* figure = std::get_if<FigureOp>(&op.what);
                figure != nullptr && figure->part_count > 0)
            {
                // Parts of a figure, drawn one by one with different mk, are one body.
                if (figure->part > 0) return {};
                DrawOp whole = op;
                std::get<FigureOp>(whole.what).part_count = 0;
                return shape_meshes(whole, nullptr, def_.grid.dp);
            }
            return shape_meshes(op, nullptr, def_.grid.dp);
        }
        catch (const GeometryError& error)
        {
            throw GeometryError(fmt::format("{}:{}: <{}>: {}", def_.file, op.source.line,
                                            op.source.command, error.what()));
        }
    }

    static std::string name_of(const DrawOp& op)
    {
        if (!op.source.name.empty()) return op.source.name;
        const auto* file = std::get_if<MeshFileOp>(&op.what);
        return fmt::format("{} (line {})", file != nullptr ? file->file : op.source.command,
                           op.source.line);
    }

    std::size_t add_shape(const DrawOp& op, ShapeMesh&& mesh, const MkValue& mk)
    {
        CaseShape shape;
        shape.name = name_of(op);
        shape.kind = mk.kind;
        shape.mk = mk.mk;
        shape.is_filled = mesh.is_solid;
        shape.is_closed = open_edge_count(mesh.soup) == 0;
        shape.solid = std::make_unique<Solid>(std::move(mesh.soup), op.state->clips, threads_);
        out_.shapes.push_back(std::move(shape));
        return out_.shapes.size() - 1;
    }

    void take_in(const DrawOp& op)
    {
        if (!op.state->draw_points) return;
        if (std::holds_alternative<RedrawOp>(op.what) ||
            std::holds_alternative<RedrawNearOp>(op.what))
        {
            if (told_.insert(op.source.line).second)
                out_.notes.push_back(
                    fmt::format("<{}> of line {} changes nodes, not shapes, and is "
                                "not followed.",
                                op.source.command, op.source.line));
            return;
        }
        for (ShapeMesh& mesh : shapes_of(op))
        {
            // Void and fluid take away what they fill.
            if (op.state->mk.kind != MkKind::Bound && !mesh.is_solid) continue;
            CaseDraw draw;
            draw.shapes = {add_shape(op, std::move(mesh), op.state->mk)};
            out_.draws.push_back(std::move(draw));
        }
    }

    void take_in(const BooleanDef& boolean)
    {
        CaseDraw draw;
        draw.is_combination = true;
        draw.tree = boolean.tree;
        draw.stays = staying_parts(boolean.tree, boolean.parts.size());
        for (const BooleanDef::Part& part : boolean.parts)
        {
            const DrawOp& op = def_.ops[part.op];
            ShapeMesh joined;
            for (const ShapeMesh& mesh : shapes_of(op))
                joined.soup.vertices.insert(joined.soup.vertices.end(), mesh.soup.vertices.begin(),
                                            mesh.soup.vertices.end());
            if (joined.soup.vertices.empty())
                throw GeometryError(
                    fmt::format("{}:{}: <{}>: has no surface, so that it cannot be "
                                "a part of the <boolean> in line {}",
                                def_.file, op.source.line, op.source.command, boolean.line));
            joined.is_solid = true;
            MkValue mk = op.state->mk;
            if (boolean.mk) mk = {MkKind::Bound, *boolean.mk, 0};
            draw.shapes.push_back(add_shape(op, std::move(joined), mk));
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

CaseSolids case_solids(const CaseDef& def, int threads)
{
    CaseSolids solids;
    ShapeReader(def, solids, threads).run();
    return solids;
}

} // namespace fppg
