#include "files/helpers.h"
#include "fppg/error.h"

#include <map>

namespace fppg
{

namespace
{

struct Bi4Array
{
    std::string name;
    int type = 0;
    std::uint64_t count = 0;
    std::string data;
};

struct Bi4Item
{
    std::string name;
    std::vector<std::pair<std::string, std::string>> values; ///< bytes, a text without its length
    std::vector<Bi4Array> arrays;
    std::vector<Bi4Item> items;

    const std::string& value(const std::string& value_name) const
    {
        for (const auto& [n, bytes] : values)
            if (n == value_name) return bytes;
        throw std::runtime_error("no value " + value_name);
    }
    template <typename T>
    T number(const std::string& value_name) const
    {
        const std::string& bytes = value(value_name);
        if (bytes.size() != sizeof(T)) throw std::runtime_error("wrong type of " + value_name);
        T number;
        std::memcpy(&number, bytes.data(), sizeof number);
        return number;
    }
    template <typename T>
    std::vector<T> array(std::size_t index) const
    {
        const std::string& data = arrays.at(index).data;
        std::vector<T> numbers(data.size() / sizeof(T));
        std::memcpy(numbers.data(), data.data(), data.size());
        return numbers;
    }
};

/// Walks the container and checks every size that it states.
class Bi4Reader
{
public:
    explicit Bi4Reader(std::string bytes) : bytes_(std::move(bytes))
    {
        EXPECT_EQ(take(58), "#FileJBD JPartDataBi4" + std::string(37, ' '));
        EXPECT_EQ(take(2), std::string("\n\0", 2));
        const int order = take(1)[0];
        has_64_bit_sizes = take(1)[0] == 1;
        EXPECT_EQ(order, has_64_bit_sizes ? 10 : 0);
        EXPECT_EQ(take(2), std::string(2, '\0'));
        root = item();
        EXPECT_EQ(at_, bytes_.size()) << "nothing follows the root item";
    }

    Bi4Item root;
    bool has_64_bit_sizes = false;

private:
    std::string bytes_;
    std::size_t at_ = 0;

    std::string take(std::uint64_t n)
    {
        if (n > bytes_.size() - at_) throw std::runtime_error("overflow at " + std::to_string(at_));
        at_ += n;
        return bytes_.substr(at_ - n, n);
    }
    template <typename T>
    T number()
    {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    std::string text() { return take(number<std::uint32_t>()); }

    Bi4Item item()
    {
        Bi4Item result;
        const auto definition_size = number<std::uint32_t>();
        const std::size_t definition = at_;
        EXPECT_EQ(text(), "\nITEM\n");
        result.name = text();
        EXPECT_EQ(number<std::int32_t>(), 0);
        EXPECT_EQ(number<std::int32_t>(), 0);
        EXPECT_EQ(text(), "%.7E");
        EXPECT_EQ(text(), "%.15E");
        const auto arrays = number<std::uint32_t>();
        const auto items = number<std::uint32_t>();
        const auto values_size = number<std::uint32_t>();
        EXPECT_EQ(at_ - definition, definition_size);
        const std::size_t values = at_;
        EXPECT_EQ(text(), "\nVALUES");
        for (auto count = number<std::uint32_t>(); count > 0; --count)
        {
            std::string name = text();
            result.values.emplace_back(std::move(name), value(number<std::int32_t>()));
        }
        EXPECT_EQ(at_ - values, values_size);
        for (std::uint32_t i = 0; i < arrays; ++i) result.arrays.push_back(array());
        for (std::uint32_t i = 0; i < items; ++i) result.items.push_back(item());
        return result;
    }
    std::string value(int type)
    {
        if (type == 1) return text();
        static const std::map<int, std::uint64_t> sizes{{2, 4},  {7, 4},  {8, 4},
                                                        {10, 8}, {12, 8}, {23, 24}};
        return take(sizes.at(type));
    }
    Bi4Array array()
    {
        Bi4Array result;
        const auto definition_size = number<std::uint32_t>();
        const std::size_t definition = at_;
        EXPECT_EQ(text(), "\nARRAY");
        result.name = text();
        EXPECT_EQ(number<std::int32_t>(), 0);
        result.type = number<std::int32_t>();
        result.count = has_64_bit_sizes ? number<std::uint64_t>() : number<std::uint32_t>();
        const std::uint64_t bytes =
            has_64_bit_sizes ? number<std::uint64_t>() : number<std::uint32_t>();
        EXPECT_EQ(at_ - definition, definition_size);
        static const std::map<int, std::uint64_t> sizes{{8, 4}, {23, 24}, {22, 12}, {11, 4}};
        EXPECT_EQ(bytes, result.count * sizes.at(result.type));
        result.data = take(bytes);
        return result;
    }
};

const FileOrigin test_origin{"GenCase v5.4 (fppg)", "01-02-2026 03:04:05", "small"};

std::string bi4_of(const CaseParticles& particles, const CaseConstants& constants, int threads = 1,
                   std::uint64_t limit = bi4_limit_of_32_bit_sizes)
{
    return written([&](OutputFile& file)
                   { write_bi4(file, particles, constants, test_origin, threads, limit); });
}

TEST(WriteBi4, HasTheValuesOfGenCaseInTheirOrder)
{
    const Bi4Reader file(bi4_of(small_particles(), small_constants()));
    EXPECT_EQ(file.root.name, "JPartDataBi4");
    EXPECT_TRUE(file.root.arrays.empty());
    std::string names;
    for (const auto& [name, value] : file.root.values) names += name + " ";
    EXPECT_EQ(names,
              "Piece Npiece RunCode Date AppName CaseName Data2d Data2dPosY MapPosMin MapPosMax "
              "PeriMode PeriXinc PeriYinc PeriZinc AxisDiv CaseNp CaseNfixed CaseNmoving "
              "CaseNfloat CaseNfluid CasePosMin CasePosMax NpDynamic ReuseIds Dp H B Rhop0 Gamma "
              "MassBound MassFluid ");
    EXPECT_EQ(file.root.value("AppName"), test_origin.app_name);
    EXPECT_EQ(file.root.value("Date"), "???");
    EXPECT_EQ(file.root.number<std::uint64_t>("CaseNp"), 23U);
    EXPECT_EQ(file.root.number<std::uint64_t>("CaseNfluid"), 14U);
    EXPECT_EQ(file.root.number<double>("H"), small_constants().h);
}

TEST(WriteBi4, HasOnePartWithFourArrays)
{
    const Bi4Reader file(bi4_of(small_particles(), small_constants()));
    ASSERT_EQ(file.root.items.size(), 1U);
    const Bi4Item& part = file.root.items[0];
    EXPECT_EQ(part.name, "PART_0000");
    EXPECT_EQ(part.values.size(), 8U);
    EXPECT_EQ(part.number<std::uint32_t>("Npok"), 23U);
    std::string arrays;
    for (const Bi4Array& array : part.arrays)
        arrays +=
            array.name + " " + std::to_string(array.type) + " " + std::to_string(array.count) + " ";
    EXPECT_EQ(arrays, "Idp 8 23 Posd 23 23 Vel 22 23 Rhop 11 23 ");
}

TEST(WriteBi4, MakesPositionsFromRunsInIdOrder)
{
    const CaseParticles particles = small_particles();
    const Bi4Reader file(bi4_of(particles, small_constants()));
    const auto idp = file.root.items[0].array<std::uint32_t>(0);
    const auto pos = file.root.items[0].array<double>(1);
    std::vector<double> expected;
    for (const ParticleBlock& block : particles.blocks)
        for (const ParticleRun& run : block.runs)
            for (std::uint32_t k = 0; k < run.count; ++k)
            {
                const std::uint32_t z = block.run_descending ? run.z - k : run.z + k;
                expected.insert(expected.end(),
                                {-0.1 + run.x * 0.1, 0.25 + run.y * 0.1, 0.3 + z * 0.1});
            }
    EXPECT_EQ(pos, expected);
    for (std::uint32_t i = 0; i < idp.size(); ++i) EXPECT_EQ(idp[i], i);
}

TEST(WriteBi4, TakesDensitiesFromTheDepthOfTheNode)
{
    const Bi4Reader file(bi4_of(small_particles(), small_constants()));
    const auto rhop = file.root.items[0].array<float>(3);
    const std::vector<float> expected{
        999,  999,  999,  999,  999,  999,  999,  999,  999, // not fluid
        1001, 1000, 1001, 1000, 1001, 1000, 1001, 1000,      // upwards, two a column
        1000, 1001, 1002, 1004, 1005, 1006};                 // downwards, then 4 below a top
    EXPECT_EQ(rhop, expected);
    for (const float v : file.root.items[0].array<float>(2)) EXPECT_EQ(v, 0.0f);
}

TEST(WriteBi4, TakesDensitiesFromTheListWhereThereIsOne)
{
    CaseParticles particles = small_particles();
    particles.rhop_of_depth.clear();
    for (int i = 0; i < 14; ++i) particles.rhop.push_back(static_cast<float>(2000 + i));
    const Bi4Reader file(bi4_of(particles, small_constants()));
    const auto rhop = file.root.items[0].array<float>(3);
    EXPECT_EQ(rhop[8], 999.0f);
    for (std::size_t i = 0; i < 14; ++i) EXPECT_EQ(rhop[9 + i], static_cast<float>(2000 + i));
}

TEST(WriteBi4, RunsTheInitialsOfABlockAndLeavesTheOthers)
{
    CaseParticles particles = small_particles();
    Transform up;
    up.offset = {0, 0, 0.05};
    PositionFilter high;
    high.min.z = 0.5;
    particles.blocks[3].initials = {{1, 1, {}, MoveParticles{up}},
                                    {2, 1, {}, UniformDensity{1200}},
                                    {3, 1, high, UniformVelocity{{1, 2, 3}}}};
    const Bi4Reader file(bi4_of(particles, small_constants()));
    const auto pos = file.root.items[0].array<double>(1);
    const auto vel = file.root.items[0].array<float>(2);
    const auto rhop = file.root.items[0].array<float>(3);
    // Particle 9 stood at z = 0.4, particle 10 at 0.5.
    EXPECT_NEAR(pos[3 * 9 + 2], 0.45, 1e-12);
    EXPECT_NEAR(pos[3 * 10 + 2], 0.55, 1e-12);
    EXPECT_EQ(vel[3 * 9 + 1], 0.0f);
    EXPECT_EQ(vel[3 * 10 + 1], 2.0f);
    EXPECT_EQ(rhop[9], 1200.0f);
    EXPECT_EQ(rhop[17], 1000.0f);
    EXPECT_EQ(vel[3 * 17 + 1], 0.0f);
}

TEST(WriteBi4, RunsTheInitialsOnParticlesOffTheLattice)
{
    CaseParticles particles = walled_particles();
    PositionFilter far;
    far.min.x = 2.15;
    Transform up;
    up.offset = {0, 0, 0.5};
    particles.blocks[4].initials = {{1, 2, far, UniformVelocity{{1, 2, 3}}},
                                    {2, 2, far, UniformDensity{1200}},
                                    {3, 2, {}, MoveParticles{up}}};
    const Bi4Reader file(bi4_of(particles, small_constants()));
    const auto pos = file.root.items[0].array<double>(1);
    const auto vel = file.root.items[0].array<float>(2);
    const auto rhop = file.root.items[0].array<float>(3);
    // The last three are those off the lattice, at x = 2.1, 2.2 and 2.3.
    EXPECT_EQ(rhop[25], 1010.0f);
    EXPECT_EQ(rhop[26], 1200.0f);
    EXPECT_EQ(vel[3 * 25 + 1], 0.0f);
    EXPECT_EQ(vel[3 * 27 + 1], 2.0f);
    EXPECT_EQ(pos[3 * 25 + 2], 1.0);
    EXPECT_EQ(pos[3 * 27], 2.3);
}

TEST(WriteBi4, AddsTheNormalsOfTheBoundaryAsAFifthArray)
{
    CaseParticles particles = small_particles();
    for (int i = 0; i < 9; ++i) particles.bound_normals.push_back({0, 0.5f, static_cast<float>(i)});
    const Bi4Reader file(bi4_of(particles, small_constants()));
    const Bi4Item& part = file.root.items[0];
    ASSERT_EQ(part.arrays.size(), 5U);
    EXPECT_EQ(part.arrays[4].name, "BoundNor");
    EXPECT_EQ(part.arrays[4].type, 22);
    EXPECT_EQ(part.arrays[4].count, 9U);
    EXPECT_EQ(part.array<float>(4)[3 * 8 + 2], 8.0f);
}

TEST(WriteBi4, KeepsTheYOfATwoDimensionalCaseExactly)
{
    CaseConstants constants = small_constants();
    constants.is_2d = true;
    constants.y_2d = 0.12345678901234567;
    const Bi4Reader file(bi4_of(small_particles(), constants));
    EXPECT_EQ(file.root.number<std::int32_t>("Data2d"), 1);
    EXPECT_EQ(file.root.number<double>("Data2dPosY"), 0.12345678901234567);
}

TEST(WriteBi4, WritesEmptyArraysWithoutParticles)
{
    const Bi4Reader file(bi4_of(CaseParticles{}, small_constants()));
    EXPECT_EQ(file.root.number<std::uint64_t>("CaseNp"), 0U);
    EXPECT_EQ(file.root.items[0].arrays.size(), 4U);
}

TEST(WriteBi4, UsesSizesOf64BitsFromTheLimitOn)
{
    const std::string small = bi4_of(small_particles(), small_constants());
    const std::uint64_t size = small.size();
    EXPECT_EQ(bi4_of(small_particles(), small_constants(), 1, size + 1), small);
    const Bi4Reader wide(bi4_of(small_particles(), small_constants(), 1, size));
    EXPECT_TRUE(wide.has_64_bit_sizes);
    const Bi4Reader narrow(small);
    EXPECT_FALSE(narrow.has_64_bit_sizes);
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(wide.root.items[0].arrays[i].data, narrow.root.items[0].arrays[i].data);
}

TEST(WriteBi4, GivesTheSameBytesForAnyNumberOfThreads)
{
    // Runs of uneven length, so that pieces begin inside runs and blocks.
    std::vector<ParticleBlock> blocks{columns(ParticleType::Fixed, 10, 0, 100, 777),
                                      columns(ParticleType::Fluid, 1, 100, 90, 1001),
                                      columns(ParticleType::Fluid, 2, 200, 1, 40000)};
    blocks[2].run_descending = true;
    blocks[2].runs[0].z = 50000;
    const CaseParticles particles = make_particles(std::move(blocks));
    const std::string one = bi4_of(particles, small_constants(), 1);
    EXPECT_TRUE(one == bi4_of(particles, small_constants(), 8));
    const Bi4Reader file(one);
    const auto pos = file.root.items[0].array<double>(1);
    EXPECT_EQ(pos.size(), 3 * particles.np);
    EXPECT_EQ(pos.back(), 0.3 + 10001 * 0.1);
    const auto rhop = file.root.items[0].array<float>(3);
    EXPECT_EQ(rhop.back(), 1000.0f + 39999.0f);
    EXPECT_EQ(rhop[100 * 777 + 90 * 1001 - 1], 1000.0f);
}

TEST(WriteBi4, HasTheParticlesOffTheLatticeBetweenTheNodes)
{
    const CaseParticles particles = walled_particles();
    const std::string one = bi4_of(particles, small_constants(), 1);
    EXPECT_TRUE(one == bi4_of(particles, small_constants(), 8));
    const Bi4Reader file(one);
    EXPECT_EQ(file.root.number<std::uint64_t>("CaseNmoving"), 4U);
    const auto pos = file.root.items[0].array<double>(1);
    ASSERT_EQ(pos.size(), 84U);
    EXPECT_EQ(pos[3 * 3 + 2], 0.3 + 1 * 0.1);
    EXPECT_EQ(pos[3 * 4 + 2], 0.41);
    EXPECT_EQ(pos[3 * 5 + 2], 1.0 / 3);
    EXPECT_EQ(pos[3 * 6 + 2], 0.3 + 2 * 0.1);
    const auto rhop = file.root.items[0].array<float>(3);
    EXPECT_EQ(rhop[5], 999);
    EXPECT_EQ(rhop[27], 1012);
}

TEST(WriteBi4, RefusesMoreParticlesThanIds)
{
    CaseParticles particles;
    particles.np = 4294967295U;
    try
    {
        bi4_of(particles, small_constants());
        FAIL() << "no error";
    }
    catch (const IoError& error)
    {
        EXPECT_NE(std::string(error.what()).find("at most 4294967294"), std::string::npos)
            << error.what();
    }
}

} // namespace

} // namespace fppg
