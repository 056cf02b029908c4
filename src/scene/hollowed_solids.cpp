#include "scene/hollowed_solids.h"

#include "fppg/combination.h"
#include "fppg/error.h"

#include "meshes/inside_test.h"
#include "meshes/open_edges.h"
#include "scene/surfaces.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

namespace fppg
{
namespace
{

/// What reaches into a solid by less does not hollow it, dp: voids, fluid.
constexpr double void_reach_dp = 1e-3;
constexpr double fluid_reach_dp = 0.5 + 1e-6;

/// The same of a sheet, metres: on the lattice fluid leaves no wall where it covers all its shells.
double sheet_reach(const Scene& scene, std::size_t step)
{
    const auto shells = static_cast<double>(scene.steps[step].draw->shells);
    return std::max(fluid_reach_dp, shells - 1) * scene.def->grid.dp;
}

/// Solids whose boxes overlap by more than this are one, dp; what touches, too.
constexpr double joins_dp = -1e-3;

/// A step that draws a body or a sheet, and those that are drawn into it or belong to it.
struct Body
{
    std::size_t step = 0;
    Box3 box; ///< empty: nothing
    bool is_closed = true;
    bool is_sheet = false; ///< the draw fills nothing
    TriangleSoup soup{};
    std::vector<std::size_t> drawn_into{};
    std::vector<std::size_t> joined{};
};

/// What a step draws, by its true shape. Surfaces with open edges, whose inside is a guess, cannot
/// be cut exactly, and nor can the sheets of `<layers>`, which are bodies of their own.
Body body_of(const Scene& scene, std::size_t index)
{
    const SceneStep& step = scene.steps[index];
    const DrawState& state = *step.draw->state;
    const auto* file = shape_as<MeshFileOp>(*step.draw);
    Body out{index, {}};
    if (!state.draw_points || state.pattern || state.mk_next_auto || state.off_lattice ||
        state.mode == DrawMode::Wire || (file != nullptr && file->advanced))
        return out;
    try
    {
        const std::vector<ShapeMesh> shapes = surfaces_of(scene, *step.draw, PartsAs::Drawn, 1);
        out.is_sheet = shapes.size() == 1 && !shapes[0].is_solid;
        for (const ShapeMesh& shape : shapes)
        {
            if (!shape.is_solid && !out.is_sheet) continue;
            const std::vector<Vec3>& vertices = shape.soup.vertices;
            for (const Vec3& v : vertices) out.box.add(v);
            out.soup.vertices.insert(out.soup.vertices.end(), vertices.begin(), vertices.end());
            if (!out.is_sheet) out.is_closed = out.is_closed && open_edge_count(shape.soup) == 0;
        }
    }
    catch (const Error&)
    {
        out.box = {}; // drawing it says what is wrong
    }
    return out;
}

/// A fluid that may pass through sheets.
class FluidInSheets
{
public:
    FluidInSheets(const Scene& scene, const Body& fluid) : scene_(scene), fluid_(fluid) {}

    /// Whether a place of a sheet is deeper in the fluid than sheet_reach().
    bool passes(const Body& body)
    {
        depth_ = sheet_reach(scene_, body.step);
        const double dp = scene_.def->grid.dp;
        for (std::size_t f = 0; f < body.soup.size(); ++f)
        {
            const Vec3* c = &body.soup.vertices[3 * f];
            Box3 box;
            for (std::size_t k = 0; k < 3; ++k) box.add(c[k]);
            if (!overlap_by(box, depth_)) continue;
            const double longest =
                std::max({norm(c[1] - c[0]), norm(c[2] - c[1]), norm(c[0] - c[2])});
            const auto n = static_cast<int>(std::clamp(std::ceil(longest / dp), 1.0, most_samples));
            for (int i = 0; i <= n; ++i)
                for (int j = 0; i + j <= n; ++j)
                    if (is_deep(c[0] + (static_cast<double>(i) / n) * (c[1] - c[0]) +
                                (static_cast<double>(j) / n) * (c[2] - c[0])))
                        return true;
        }
        return false;
    }

private:
    static constexpr double most_samples = 1000; ///< along a side of a facet

    bool overlap_by(const Box3& box, double depth) const
    {
        for (int axis = 0; axis < 3; ++axis)
            if (box.max[axis] <= fluid_.box.min[axis] + depth ||
                box.min[axis] >= fluid_.box.max[axis] - depth)
                return false;
        return true;
    }

    bool is_deep(const Vec3& p)
    {
        if (!fluid_.box.has(p, -depth_)) return false;
        if (test_ == nullptr)
        {
            test_ = std::make_unique<InsideTest>(fluid_.soup);
            test_->query().prepare_nearest();
        }
        return test_->query().closest_point(p).distance > depth_ && test_->is_inside(p);
    }

    const Scene& scene_;
    const Body& fluid_;
    double depth_ = 0; ///< metres
    std::unique_ptr<InsideTest> test_;
};

bool overlap(const Box3& a, const Box3& b, double reach_dp, const LatticeGrid& grid)
{
    for (int axis = 0; axis < 3; ++axis)
    {
        const double common =
            std::min(a.max[axis], b.max[axis]) - std::max(a.min[axis], b.min[axis]);
        if (!(grid.is_2d && axis == 1) && !(common > reach_dp * grid.dp)) return false;
    }
    return true;
}

/// Takes a part into a tree: a difference or a union of what it was and the part.
void combine(BooleanOp op, std::uint32_t part, BooleanNode& tree)
{
    if (tree.op != op) tree = {op, 0, {std::move(tree)}};
    tree.operands.push_back({BooleanOp::Part, part, {}});
}

/// A body with what is drawn into it taken away and what belongs to it added, in their order.
std::shared_ptr<const Combination> combined(const Scene& scene, const Body& body)
{
    std::vector<std::size_t> steps{body.step};
    steps.insert(steps.end(), body.drawn_into.begin(), body.drawn_into.end());
    steps.insert(steps.end(), body.joined.begin(), body.joined.end());
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end()); // drawn into several
    auto hollowed = std::make_shared<HollowedSolid>();
    auto out = std::make_shared<Combination>();
    for (const std::size_t step : steps) hollowed->parts.push_back(*scene.steps[step].draw);
    const DrawOp& first = hollowed->parts.front();
    out->whole.source = first.source;
    out->whole.state = first.state;
    hollowed->boolean.line = first.source.line;
    for (std::size_t i = 0; i < steps.size(); ++i)
    {
        const DrawOp& part = hollowed->parts[i];
        const auto index = static_cast<std::uint32_t>(i);
        const bool stays = part.state->mk.kind == MkKind::Bound;
        BooleanDef::Part& kind = hollowed->boolean.parts.emplace_back();
        if (body.is_sheet) kind.is_surface = stays;
        if (body.is_sheet && !stays) kind.least_depth = sheet_reach(scene, body.step);
        if (!stays) hollowed->by.push_back(&scene.steps[steps[i]].draw->source);
        if (i > 0)
            combine(stays ? BooleanOp::Union : BooleanOp::Difference, index,
                    hollowed->boolean.tree);
        out->parts.push_back(&part);
        out->mks.push_back(first.state->mk); // the cavity moves with the solid
        out->stays.push_back(stays ? 1 : 0);
    }
    out->boolean = &hollowed->boolean;
    out->hollowed = std::move(hollowed);
    return out;
}

/// Finds the bodies of a scene that something is drawn into, or that several draws make.
class BodyFinder
{
public:
    explicit BodyFinder(const Scene& scene) : scene_(scene), def_(*scene.def) {}

    void find()
    {
        // Meshes are not looked at where nothing is drawn behind them.
        std::size_t end = scene_.steps.size();
        while (end > scene_.first_remaining && !may_hollow(scene_.steps[end - 1]) &&
               !may_join(scene_.steps[end - 1]))
            --end;
        for (std::size_t i = scene_.first_remaining; i < end; ++i)
        {
            const bool is_bound = fit_of(scene_.steps[i]) != nullptr;
            if (!is_bound && (bodies_.empty() || !may_hollow(scene_.steps[i]))) continue;
            Body here = body_of(scene_, i);
            if (here.box.is_empty() || !here.is_closed) continue;
            if (is_bound)
                add(std::move(here));
            else if (!here.is_sheet)
                hollow(here);
        }
    }

    const std::vector<Body>& bodies() const { return bodies_; }

private:
    const FitSettings* fit_of(const SceneStep& step) const
    {
        const MkValue& mk = step.draw->state->mk;
        return step.shape() != nullptr && mk.kind == MkKind::Bound ? fit_settings(def_.fit, mk.mk)
                                                                   : nullptr;
    }

    bool may_hollow(const SceneStep& step) const
    {
        const DrawState& state = *step.draw->state;
        return step.shape() != nullptr && state.mk.kind != MkKind::Bound && state.clips.empty() &&
               !def_.solver.inout.fluids.contains(state.mk.mk);
    }

    /// Particles of bodies that are all inside stand for dp^3: those of several solids would be
    /// too few where these meet. A number of sheets is that of each solid.
    bool may_join(const SceneStep& step) const
    {
        const FitSettings* settings = fit_of(step);
        return settings != nullptr && settings->place == Placement::Inside && !settings->across &&
               step.draw->state->clips.empty();
    }

    /// Whether a solid belongs to a body that is there.
    bool belongs(const Body& here, const Body& body) const
    {
        const SceneStep& step = scene_.steps[here.step];
        const SceneStep& other = scene_.steps[body.step];
        return !here.is_sheet && !body.is_sheet &&
               other.draw->state->mk.mk == step.draw->state->mk.mk &&
               overlap(body.box, here.box, joins_dp, def_.grid) && may_join(step) &&
               may_join(other);
    }

    void add(Body&& here)
    {
        if (!here.is_sheet) here.soup = {}; // it is large, and its box does
        const auto joined = std::stable_partition(
            bodies_.begin(), bodies_.end(), [&](const Body& body) { return !belongs(here, body); });
        if (joined == bodies_.end())
        {
            bodies_.push_back(std::move(here));
            return;
        }
        // Those that it bridges are one with it.
        for (auto other = joined + 1; other != bodies_.end(); ++other) join(*other, *joined);
        join(here, *joined);
        bodies_.erase(joined + 1, bodies_.end());
    }

    static void join(const Body& other, Body& body)
    {
        body.box.add(other.box.min);
        body.box.add(other.box.max);
        body.joined.push_back(other.step);
        body.joined.insert(body.joined.end(), other.joined.begin(), other.joined.end());
        body.drawn_into.insert(body.drawn_into.end(), other.drawn_into.begin(),
                               other.drawn_into.end());
    }

    void hollow(const Body& here)
    {
        const bool is_void = scene_.steps[here.step].draw->state->mk.kind == MkKind::Void;
        FluidInSheets fluid(scene_, here);
        for (Body& body : bodies_)
            if (overlap(body.box, here.box, is_void ? void_reach_dp : fluid_reach_dp, def_.grid) &&
                (!body.is_sheet || (!is_void && fluid.passes(body))))
                body.drawn_into.push_back(here.step);
    }

    const Scene& scene_;
    const CaseDef& def_;
    std::vector<Body> bodies_;
};

} // namespace

void hollow_solids(Scene& scene)
{
    if (scene.def->fit.is_empty()) return;
    BodyFinder finder(scene);
    finder.find();
    for (const Body& body : finder.bodies())
    {
        if (body.drawn_into.empty() && body.joined.empty()) continue;
        std::shared_ptr<const Combination> combination = combined(scene, body);
        const DrawOp* whole = &combination->whole;
        scene.steps[body.step].is_part = true;
        std::size_t last = body.step;
        for (const std::size_t step : body.joined)
        {
            scene.steps[step].is_part = true;
            last = std::max(last, step);
        }
        scene.steps[last] = {whole, std::move(combination), false};
    }
}

} // namespace fppg
