#include "fppg/particles.h"

#include "fppg/case_def.h"
#include "fppg/error.h"

#include "helpers/case_text.h"
#include "helpers/dense_grid.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <memory>

namespace fppg
{
namespace
{

using test::CaseText;
using test::Dice;

/// A case that is read, with its nodes chosen by the test.
struct Made
{
    CaseDef def;
    RunField field;
    CaseConstants constants;
    std::vector<std::string> warnings;
    CaseParticles particles;
};

Made make(const CaseText& text, const std::function<std::uint16_t(const Node&)>& mk_of,
          int threads = 1)
{
    const test::TemporaryFolder folder;
    test::write_text(folder / "Case_Def.xml", text.text());
    Made made;
    made.def = read_case(folder / "Case_Def.xml", {});
    test::DenseMks nodes(made.def.grid);
    test::for_each_node(nodes.grid, [&](const Node& n) { nodes.at(n.x, n.y, n.z) = mk_of(n); });
    made.field = test::runs_of(nodes);
    made.particles = make_particles(made.def, made.field, threads, made.constants, made.warnings);
    return made;
}

CaseText small_case()
{
    CaseText text;
    text.pointmin = R"(<pointmin x="-0.37" y="-0.2" z="0.05" />)";
    text.pointmax = R"(<pointmax x="0.53" y="0.5" z="1.15" />)";
    return text;
}

/// mk 1 and 2 are fluid, 10 to 13 bound, in clumps.
std::function<std::uint16_t(const Node&)> any_nodes(std::uint32_t seed)
{
    const auto dice = std::make_shared<Dice>(seed);
    return [dice, last = std::make_shared<std::uint16_t>(0)](const Node&)
    {
        if (dice->whole(0, 2) == 0)
            *last = dice->one_of({std::uint16_t{0}, std::uint16_t{1}, std::uint16_t{1},
                                  std::uint16_t{2}, std::uint16_t{10}, std::uint16_t{11},
                                  std::uint16_t{12}, std::uint16_t{13}});
        return *last;
    };
}

std::vector<Node> nodes_of(const ParticleBlock& block)
{
    std::vector<Node> out;
    for (const ParticleRun& r : block.runs)
        for (std::uint32_t k = 0; k < r.count; ++k)
            out.push_back({r.x, r.y, block.run_descending ? r.z - k : r.z + k});
    return out;
}

/// Densities of the fluid in id order, from either of the two forms.
std::vector<float> densities(const CaseParticles& particles)
{
    if (!particles.rhop.empty()) return particles.rhop;
    std::vector<float> out;
    for (const ParticleBlock& block : particles.blocks)
    {
        if (block.type != ParticleType::Fluid) continue;
        for (const ParticleRun& r : block.runs)
            for (std::uint32_t k = 0; k < r.count; ++k)
                out.push_back(
                    particles
                        .rhop_of_depth[r.depth + (block.run_descending ? k : r.count - 1 - k)]);
    }
    return out;
}

constexpr const char* types_of_all =
    R"(<floatings><floating mkbound="2" rhopbody="500" /></floatings>
<motion><objreal ref="1"><begin mov="1" start="0" /><wait id="1" duration="1" /></objreal></motion>)";

TEST(MakeParticles, OrdersByTypeThenMkThenXYZ)
{
    CaseText text = small_case();
    text.after_geometry = types_of_all;
    const auto mk_of = any_nodes(1);
    test::DenseMks drawn(LatticeGrid{{}, 1, {64, 64, 64}, false});
    const Made made = make(text, [&](const Node& n) { return drawn.at(n.x, n.y, n.z) = mk_of(n); });

    struct Key
    {
        int type;
        std::uint16_t mk;
        Node node;
    };
    std::vector<Key> expected;
    const std::map<std::uint16_t, int> type_of{{10, 0}, {11, 1}, {12, 2}, {13, 0}, {1, 3}, {2, 3}};
    test::for_each_node(made.def.grid,
                        [&](const Node& n)
                        {
                            const std::uint16_t mk = drawn.at(n.x, n.y, n.z);
                            if (mk != 0) expected.push_back({type_of.at(mk), mk, n});
                        });
    std::stable_sort(expected.begin(), expected.end(),
                     [](const Key& a, const Key& b)
                     { return std::pair(a.type, a.mk) < std::pair(b.type, b.mk); });
    std::uint64_t id = 0;
    for (const ParticleBlock& block : made.particles.blocks)
    {
        ASSERT_EQ(block.begin, id);
        for (const Node& n : nodes_of(block))
        {
            ASSERT_LT(id, expected.size());
            EXPECT_EQ(static_cast<int>(block.type), expected[id].type);
            EXPECT_EQ(block.mk, expected[id].mk);
            ASSERT_TRUE(n == expected[id].node) << "id " << id;
            ++id;
        }
    }
    EXPECT_EQ(id, expected.size());
    EXPECT_EQ(made.particles.np, expected.size());
    EXPECT_EQ(made.particles.n_fixed + made.particles.n_moving + made.particles.n_floating +
                  made.particles.n_fluid,
              made.particles.np);
}

TEST(MakeParticles, OrientsAnMkInEveryOrderOfTheAxes)
{
    for (const std::string order :
         {"xyz", "xyZ", "xYz", "Xyz", "yxz", "zyx", "zxy", "YZX", "xzy", "ZYX", "yXZ"})
    {
        CaseText text = small_case();
        text.mkconfig =
            fmt::format(R"(<mkconfig boundcount="240" fluidcount="9"><mkorientbound mk="0" )"
                        R"(orient="{0}" /><mkorientfluid mk="0" orient="{0}" /></mkconfig>)",
                        order);
        const Made made = make(text, any_nodes(2));
        const Made plain = make(small_case(), any_nodes(2));
        ASSERT_EQ(made.particles.blocks.size(), plain.particles.blocks.size());
        for (std::size_t b = 0; b < made.particles.blocks.size(); ++b)
        {
            std::vector<Node> expected = nodes_of(plain.particles.blocks[b]);
            const std::uint16_t mk = plain.particles.blocks[b].mk;
            const auto key = [&](const Node& n)
            {
                std::array<std::int64_t, 3> k{};
                for (std::size_t i = 0; i < 3; ++i)
                {
                    const std::int64_t v = n[(order[i] | 0x20) - 'x'];
                    k[i] = order[i] < 'a' ? -v : v;
                }
                return k;
            };
            if (mk == 10 || mk == 1)
                std::sort(expected.begin(), expected.end(),
                          [&](const Node& p, const Node& q) { return key(p) < key(q); });
            EXPECT_TRUE(nodes_of(made.particles.blocks[b]) == expected) << order << ", mk " << mk;
        }
    }
}

/// The density of a node by the formulas, found by walking from it node by node.
class PlainDensity
{
public:
    explicit PlainDensity(const Made& made) : made_(made), nodes_(test::dense(made.field))
    {
        type_[10] = ParticleType::Fixed;
        type_[11] = ParticleType::Moving;
        type_[12] = ParticleType::Floating;
        type_[13] = ParticleType::Fixed;
        type_[1] = type_[2] = ParticleType::Fluid;
        s_max_ = -1e300;
        s_min_ = 1e300;
        each(
            [&](const Node& n, std::uint16_t mk)
            {
                if (type_.at(mk) != ParticleType::Fluid) return;
                s_max_ = std::max(s_max_, height(n));
                s_min_ = std::min(s_min_, height(n));
            });
    }

    double depth(const Node& n) const
    {
        const Vec3 g = made_.def.constants.gravity;
        if (made_.def.constants.rhop_gradient == 3) return s_max_ - height(n);
        Vec3 d;
        for (int axis = 0; axis < 3; ++axis)
            if (g[axis] != 0) d[axis] = steps(n, axis) * made_.def.grid.dp * g[axis];
        return norm(d) / norm(g);
    }

    double hswl() const
    {
        if (made_.def.constants.rhop_gradient == 3) return s_max_ - s_min_;
        double most = 0;
        each(
            [&](const Node& n, std::uint16_t mk)
            {
                if (is_water(mk)) most = std::max(most, depth(n));
            });
        return most;
    }

    double density(const Node& n) const
    {
        const ConstantsDef& c = made_.def.constants;
        if (c.rhop_gradient == 1) return c.rhop0;
        return c.rhop0 *
               std::pow(1 + c.rhop0 * norm(c.gravity) * depth(n) / made_.constants.b, 1 / c.gamma);
    }

private:
    template <typename Body>
    void each(const Body& body) const
    {
        test::for_each_node(nodes_.grid,
                            [&](const Node& n)
                            {
                                if (const auto mk = nodes_.at(n.x, n.y, n.z)) body(n, mk);
                            });
    }
    bool is_water(std::uint16_t mk) const
    {
        return type_.at(mk) == ParticleType::Fluid || type_.at(mk) == ParticleType::Floating;
    }
    double height(const Node& n) const
    {
        const Vec3 g = made_.def.constants.gravity;
        return -dot(position(n, nodes_.grid), g) / norm(g);
    }
    double steps(Node n, int axis) const
    {
        double count = 0;
        while (true)
        {
            n = {n.x + (axis == 0), n.y + (axis == 1), n.z + (axis == 2)};
            if (!is_inside(n, nodes_.grid)) return count;
            const std::uint16_t mk = nodes_.at(n.x, n.y, n.z);
            if (mk == 0) return count;
            ++count;
            if (!is_water(mk)) return count;
        }
    }

    const Made& made_;
    test::DenseMks nodes_;
    std::map<std::uint16_t, ParticleType> type_;
    double s_max_ = 0;
    double s_min_ = 0;
};

struct DensityCase
{
    const char* gravity;
    int gradient;
};

class Densities : public testing::TestWithParam<DensityCase>
{
};

TEST_P(Densities, FollowTheFormulaNodeByNode)
{
    for (const char* order : {"", R"(<mkorientfluid mk="0" orient="xyZ" />)",
                              R"(<mkorientfluid mk="0" orient="zYx" />)"})
    {
        CaseText text = small_case();
        text.after_geometry = types_of_all;
        text.gravity = std::string("<gravity ") + GetParam().gravity + " />";
        text.rhopgradient =
            "<rhopgradient value=\"" + std::to_string(GetParam().gradient) + "\" />";
        text.mkconfig =
            std::string(R"(<mkconfig boundcount="240" fluidcount="9">)") + order + "</mkconfig>";
        const Made made = make(text, any_nodes(3));
        const PlainDensity plain(made);
        EXPECT_NEAR(made.constants.hswl, plain.hswl(), 1e-9);
        const std::vector<float> found = densities(made.particles);
        ASSERT_EQ(found.size(), made.particles.n_fluid);
        std::size_t i = 0;
        for (const ParticleBlock& block : made.particles.blocks)
        {
            if (block.type != ParticleType::Fluid) continue;
            for (const Node& n : nodes_of(block))
                ASSERT_NEAR(found[i++], plain.density(n), 1e-4) << order;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(
    Gravity, Densities,
    testing::Values(
        DensityCase{R"(x="0" y="0" z="-9.81")", 1}, DensityCase{R"(x="0" y="0" z="-9.81")", 2},
        DensityCase{R"(x="0" y="0" z="-9.81")", 3}, DensityCase{R"(x="0" y="0" z="9.81")", 2},
        DensityCase{R"(x="0" y="0" z="9.81")", 3}, DensityCase{R"(x="3" y="0" z="-9")", 2},
        DensityCase{R"(x="3" y="0" z="-9")", 3}, DensityCase{R"(x="-1" y="2" z="-9")", 2},
        DensityCase{R"(x="-1" y="2" z="-9")", 3}, DensityCase{R"(x="9.81" y="0" z="0")", 2},
        DensityCase{R"(x="0" y="9.81" z="0")", 1}, DensityCase{R"(x="9.81" y="0" z="0")", 3}));

TEST(MakeParticles, GivesRhop0WithoutGravity)
{
    CaseText text = small_case();
    text.gravity = R"(<gravity x="0" y="0" z="0" />)";
    const Made made = make(text, any_nodes(3));
    for (const float rhop : densities(made.particles)) EXPECT_EQ(rhop, 1000.0f);
    EXPECT_EQ(made.constants.hswl, 0);
}

TEST(MakeParticles, GivesFloatingBodiesTheMassCentreAndInertiaOfTheirParticles)
{
    CaseText text = small_case();
    text.after_geometry = types_of_all;
    const Made made = make(text, any_nodes(4));
    ASSERT_EQ(made.particles.floatings.size(), 1u);
    const FloatingBody& body = made.particles.floatings[0];
    const std::vector<Node> nodes = nodes_of(made.particles.blocks[body.block]);
    const auto n = static_cast<double>(nodes.size());
    EXPECT_NEAR(body.mass_body, 500 * n * 0.1 * 0.1 * 0.1, 1e-9);
    EXPECT_EQ(body.mass_part, made.def.mass_bound);
    Vec3 mean;
    for (const Node& node : nodes) mean = mean + position(node, made.def.grid) / n;
    for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(body.center[axis], mean[axis], 1e-12);
    const double m = body.mass_body / n;
    for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c)
        {
            double sum = 0;
            for (const Node& node : nodes)
            {
                const Vec3 d = position(node, made.def.grid) - mean;
                sum += m * ((r == c ? dot(d, d) : 0) - d[r] * d[c]);
            }
            EXPECT_NEAR(body.inertia[static_cast<std::size_t>(r)][c], sum, 1e-9) << r << c;
        }
}

TEST(MakeParticles, MeasuresInertiaFromTheGivenCentre)
{
    CaseText text = small_case();
    text.after_geometry =
        R"(<floatings><floating mkbound="2"><massbody value="7" /><center x="1" y="2" z="3" /></floating></floatings>)";
    const Made made = make(text, any_nodes(4));
    const FloatingBody& body = made.particles.floatings.at(0);
    EXPECT_EQ(body.mass_body, 7);
    EXPECT_TRUE(body.center == (Vec3{1, 2, 3}));
    double sum = 0;
    const std::vector<Node> nodes = nodes_of(made.particles.blocks[body.block]);
    for (const Node& node : nodes)
    {
        const Vec3 d = position(node, made.def.grid) - body.center;
        sum += 7 / static_cast<double>(nodes.size()) * (d.x * d.x + d.z * d.z);
    }
    EXPECT_NEAR(body.inertia[1].y, sum, 1e-9);
}

TEST(MakeParticles, GivesTheSameWithOneAndEightThreads)
{
    for (const char* gravity :
         {R"(<gravity x="0" y="0" z="-9.81" />)", R"(<gravity x="1" y="1" z="-9" />)"})
    {
        CaseText text = small_case();
        text.gravity = gravity;
        const Made one = make(text, any_nodes(5), 1);
        const Made many = make(text, any_nodes(5), 8);
        EXPECT_EQ(densities(one.particles), densities(many.particles));
        ASSERT_EQ(one.particles.blocks.size(), many.particles.blocks.size());
        for (std::size_t b = 0; b < one.particles.blocks.size(); ++b)
            EXPECT_TRUE(nodes_of(one.particles.blocks[b]) == nodes_of(many.particles.blocks[b]));
    }
}

TEST(MakeParticles, MovesOnlyWhatAMotionBegins)
{
    CaseText text = small_case();
    text.after_geometry =
        R"(<motion><objreal ref="0"><begin mov="1" start="0" /><wait id="1" duration="1" /></objreal><objreal ref="1" /></motion>)";
    const Made made = make(text, any_nodes(6));
    for (const ParticleBlock& block : made.particles.blocks)
        if (block.type != ParticleType::Fluid)
        {
            EXPECT_EQ(block.type, block.mk_type == 0 ? ParticleType::Moving : ParticleType::Fixed);
        }
}

TEST(MakeParticles, RefusesAFloatingBodyThatIsMoved)
{
    CaseText text = small_case();
    text.after_geometry = R"(<floatings><floating mkbound="1" rhopbody="500" /></floatings>
<motion><objreal ref="1"><begin mov="1" start="0" /></objreal></motion>)";
    EXPECT_THROW(make(text, any_nodes(7)), CaseError);
}

TEST(MakeParticles, SaysThatThereAreNoParticles)
{
    const Made made = make(small_case(), [](const Node&) { return std::uint16_t{0}; });
    EXPECT_EQ(made.particles.np, 0u);
    ASSERT_FALSE(made.warnings.empty());
    EXPECT_NE(made.warnings[0].find("No particles were created"), std::string::npos);
}

TEST(MakeParticles, JoinsThePropertiesOfABlock)
{
    CaseText text = small_case();
    text.after_geometry =
        R"(<properties><links><link mkbound="0,2-3" property="steel" /><link mkbound="0" property="wet" />
<link mkfluid="1" property="oil" /></links><property name="steel" /><property name="wet" />
<property name="oil" /></properties>)";
    const Made made = make(text, any_nodes(8));
    const std::map<std::uint16_t, std::string> expected{{10, "steel+wet"}, {11, ""}, {12, "steel"},
                                                        {13, "steel"},     {1, ""},  {2, "oil"}};
    for (const ParticleBlock& block : made.particles.blocks)
        EXPECT_EQ(block.property, expected.at(block.mk)) << block.mk;
}

} // namespace
} // namespace fppg
