#include "fppg/render.h"

#include "files/helpers.h"
#include "fppg/error.h"

#include <gmock/gmock.h>
#include <png.h>
#include <algorithm>
#include <cmath>

namespace fppg
{

namespace
{

using testing::HasSubstr;
using testing::ThrowsMessage;

constexpr Rgb white = {255, 255, 255};

/// Particles of dp 1.
ParticleCloud cloud_of(const std::vector<Vec3>& positions, const std::vector<std::uint16_t>& mk)
{
    ParticleCloud cloud;
    cloud.file = "cloud";
    cloud.dp = 1;
    cloud.positions = positions;
    cloud.mk = mk;
    return cloud;
}

/// A cloud of mk 1 at x = 0 and mk 12 at x = 3.
ParticleCloud two_spheres()
{
    return cloud_of({{0, 0, 0}, {3, 0, 0}}, {1, 12});
}

/// A block of 8 x 7 x 6 particles with a few mk.
ParticleCloud block()
{
    ParticleCloud cloud = cloud_of({}, {});
    for (int i = 0; i < 8 * 7 * 6; ++i)
    {
        const int x = i / 42;
        const int y = i / 6 % 7;
        cloud.positions.push_back({double(x), double(y), double(i % 6)});
        cloud.mk.push_back(static_cast<std::uint16_t>(10 + i % 5));
    }
    return cloud;
}

RenderOptions small_front()
{
    RenderOptions options;
    options.width = 200;
    options.height = 100;
    options.view = parse_view("front");
    return options;
}

/// Whether a pixel has the hue of a colour: the same largest and smallest channel, and not grey.
bool has_hue(const Rgb& pixel, const Rgb& colour)
{
    const auto order = [](const Rgb& c)
    {
        return std::pair(std::max_element(c.begin(), c.end()) - c.begin(),
                         std::min_element(c.begin(), c.end()) - c.begin());
    };
    return pixel != white && order(pixel) == order(colour);
}

std::vector<std::size_t> columns_with_ink(const Image& image)
{
    std::vector<std::size_t> columns;
    for (int x = 0; x < image.width; ++x)
        for (int y = 0; y < image.height; ++y)
            if (image.at(x, y) != white)
            {
                columns.push_back(static_cast<std::size_t>(x));
                break;
            }
    return columns;
}

std::size_t ink(const Image& image)
{
    return static_cast<std::size_t>(std::count_if(image.pixels.begin(), image.pixels.end(),
                                                  [](const Rgb& pixel) { return pixel != white; }));
}

std::vector<Rgb> png_pixels(const std::string& bytes)
{
    png_image png = {};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0)
        throw std::runtime_error(png.message);
    png.format = PNG_FORMAT_RGB;
    std::vector<Rgb> pixels(std::size_t{png.width} * png.height);
    if (png_image_finish_read(&png, nullptr, pixels.data(), 0, nullptr) == 0)
        throw std::runtime_error(png.message);
    return pixels;
}

} // namespace

TEST(RenderParticles, ShowsTwoSpheresWhereTheyAreInTheirColours)
{
    const Image image = render_particles({two_spheres()}, small_front(), 1);
    // 4 m over 94 % of 200 pixels: the centres are 141 pixels apart around the middle.
    EXPECT_TRUE(has_hue(image.at(30, 50), colour_of_mk(1, unknown_type)));
    EXPECT_TRUE(has_hue(image.at(170, 50), colour_of_mk(12, unknown_type)));
    EXPECT_EQ(image.at(100, 50), white);
    EXPECT_EQ(image.at(0, 0), white);
    EXPECT_EQ(image.at(199, 99), white);
}

TEST(RenderParticles, DrawsASphereAsADiscOfItsRadius)
{
    RenderOptions options = small_front();
    options.width = options.height = 200;
    const Image image = render_particles({cloud_of({{5, 6, 7}}, {1})}, options, 1);
    const double radius = 0.94 * 100;
    EXPECT_NEAR(static_cast<double>(ink(image)), 3.14159265 * radius * radius, 0.02 * 31416);
}

TEST(RenderParticles, LightsTheSphereFromAboveLeft)
{
    RenderOptions options = small_front();
    options.width = options.height = 200;
    const Image image = render_particles({cloud_of({{0, 0, 0}}, {1})}, options, 1);
    EXPECT_GT(image.at(75, 60)[1], image.at(100, 180)[1] + 40);
    EXPECT_GT(image.at(75, 60)[1], image.at(165, 140)[1] + 20);
}

TEST(RenderParticles, ThrowsAShadowOnWhatIsBehind)
{
    RenderOptions options = small_front();
    options.width = options.height = 200;
    options.center = Vec3{0, 0, 0};
    ParticleCloud wall = cloud_of({}, {});
    for (int x = -9; x <= 9; ++x)
        for (int z = -9; z <= 9; ++z) wall.positions.push_back({double(x), 0, double(z)});
    wall.mk.assign(wall.positions.size(), 1);
    const Image lit = render_particles({wall}, options, 1);
    // In front of the wall and out of the picture, towards the light.
    wall.positions.push_back({-0.45 * 4, -0.75 * 4, 0.75 * 4});
    wall.mk.push_back(1);
    const Image shaded = render_particles({wall}, options, 1);
    const auto light = [](const Image& image)
    {
        int sum = 0;
        for (int x = 99; x <= 101; ++x)
            for (int y = 96; y <= 104; ++y) sum += image.at(x, y)[2];
        return sum / 27;
    };
    EXPECT_LT(light(shaded), light(lit) - 20);
}

TEST(RenderParticles, GivesTheSameImageForAnyNumberOfThreads)
{
    RenderOptions options;
    options.width = 333;
    options.height = 251;
    options.samples = 3;
    const Image one = render_particles({block(), two_spheres()}, options, 1);
    for (const int threads : {2, 8})
        EXPECT_EQ(render_particles({block(), two_spheres()}, options, threads).pixels, one.pixels);
}

TEST(RenderParticles, SeesEachSideFromItsPreset)
{
    // One particle on each side of the origin.
    const ParticleCloud faces =
        cloud_of({{0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, -1}},
                 {1, 11, 12, 13, 14, 15});
    const std::vector<std::pair<std::string, std::uint16_t>> expected{
        {"front", 1}, {"back", 11}, {"left", 12}, {"right", 13}, {"top", 14}, {"bottom", 15}};
    for (const auto& [view, mk] : expected)
    {
        RenderOptions options = small_front();
        options.width = 100;
        options.view = parse_view(view);
        const Image image = render_particles({faces}, options, 1);
        EXPECT_TRUE(has_hue(image.at(50, 50), colour_of_mk(mk, unknown_type))) << view;
    }
}

TEST(RenderParticles, HasXToTheRightAndYUpwardsFromAbove)
{
    RenderOptions options = small_front();
    options.height = 200;
    options.view = parse_view("top");
    const Image image =
        render_particles({cloud_of({{0, 0, 0}, {3, 0, 0}, {0, 3, 0}}, {1, 12, 13})}, options, 1);
    EXPECT_TRUE(has_hue(image.at(30, 170), colour_of_mk(1, unknown_type)));
    EXPECT_TRUE(has_hue(image.at(170, 170), colour_of_mk(12, unknown_type)));
    EXPECT_TRUE(has_hue(image.at(30, 30), colour_of_mk(13, unknown_type)));
}

TEST(RenderParticles, KeepsOnlyWhatCutsAndMksLeave)
{
    RenderOptions cut = small_front();
    cut.cuts = {parse_cut("x>1")};
    cut.center = Vec3{1.5, 0, 0};
    RenderOptions by_mk = cut;
    by_mk.cuts.clear();
    by_mk.mks = {12};
    const ParticleCloud alone = cloud_of({{3, 0, 0}}, {12});
    RenderOptions plain = by_mk;
    plain.mks.clear();
    const Image expected = render_particles({alone}, plain, 1);
    EXPECT_EQ(render_particles({two_spheres()}, cut, 1).pixels, expected.pixels);
    EXPECT_EQ(render_particles({two_spheres()}, by_mk, 1).pixels, expected.pixels);
}

TEST(RenderParticles, KeepsParticlesOnTheCutPlane)
{
    RenderOptions options = small_front();
    options.cuts = {parse_cut("x<3")};
    EXPECT_EQ(render_particles({two_spheres()}, options, 1).pixels,
              render_particles({two_spheres()}, small_front(), 1).pixels);
}

TEST(RenderParticles, ShowsTwoCasesWithOneCamera)
{
    RenderOptions options = small_front();
    options.width = 400;
    const ParticleCloud left = two_spheres();
    const ParticleCloud right = cloud_of({{3, 0, 0}}, {12});
    const Image image = render_particles({left, right}, options, 1);
    const Image alone = render_particles({left}, small_front(), 1);
    for (int y = 0; y < 100; ++y)
        for (int x = 0; x < 200; ++x) ASSERT_EQ(image.at(x, y), alone.at(x, y)) << x << ' ' << y;
    EXPECT_EQ(image.at(370, 50), alone.at(170, 50));
    EXPECT_EQ(image.at(230, 50), white);
}

TEST(RenderParticles, ZoomsAroundTheCenter)
{
    RenderOptions options = small_front();
    options.zoom = 2;
    options.center = Vec3{3, 0, 0};
    const std::vector<std::size_t> columns =
        columns_with_ink(render_particles({two_spheres()}, options, 1));
    EXPECT_NEAR(static_cast<double>(columns.front()), 100 - 47, 1);
    EXPECT_NEAR(static_cast<double>(columns.back()), 99 + 47, 1);
}

TEST(RenderParticles, ColoursByKindWhereTheFileHasIt)
{
    ParticleCloud cloud = two_spheres();
    RenderOptions options = small_front();
    options.colour = RenderColour::Kind;
    EXPECT_THAT([&] { render_particles({cloud}, options, 1); },
                ThrowsMessage<UsageError>(HasSubstr("'cloud' has no array Kind")));
    cloud.kind = {0, 2};
    const Image image = render_particles({cloud}, options, 1);
    EXPECT_TRUE(has_hue(image.at(30, 50), {206, 52, 52}));
    EXPECT_TRUE(has_hue(image.at(170, 50), colour_of_kind(2)));
}

TEST(RenderParticles, PartsOfCadModelsHaveTheirColourUnlessRolesAreAskedFor)
{
    ParticleCloud cloud = two_spheres();
    cloud.type = {3, 0};
    cloud.colours[12] = {20, 160, 40};
    RenderOptions options = small_front();
    options.has_legend = true;
    Image image = render_particles({cloud}, options, 1);
    EXPECT_TRUE(has_hue(image.at(30, 50), colour_of_mk(1, 3)));
    EXPECT_TRUE(has_hue(image.at(170, 50), {20, 160, 40}));
    EXPECT_THAT(image.pixels, testing::Contains(Rgb{20, 160, 40})); // the legend, without shade
    options.colour = RenderColour::Role;
    image = render_particles({cloud}, options, 1);
    EXPECT_THAT(image.pixels, testing::Not(testing::Contains(Rgb{20, 160, 40})));
    EXPECT_FALSE(has_hue(image.at(170, 50), {20, 160, 40}));
}

TEST(RenderParticles, SeesASmallCaseFarFromTheOrigin)
{
    ParticleCloud near = two_spheres();
    ParticleCloud far = near;
    for (Vec3& p : far.positions) p = p + Vec3{1 << 20, 1 << 21, 1 << 19};
    EXPECT_EQ(render_particles({far}, small_front(), 1).pixels,
              render_particles({near}, small_front(), 1).pixels);
}

TEST(RenderParticles, SaysWhatIsWrongWithItsOptions)
{
    RenderOptions options = small_front();
    options.mks = {99};
    EXPECT_THAT([&] { render_particles({two_spheres()}, options, 1); },
                ThrowsMessage<UsageError>(HasSubstr("no particle is left")));
    options = small_front();
    options.zoom = 0;
    EXPECT_THROW(render_particles({two_spheres()}, options, 1), UsageError);
    options = small_front();
    options.width = 5;
    EXPECT_THAT([&] { render_particles({two_spheres()}, options, 1); },
                ThrowsMessage<UsageError>(HasSubstr("5 x 100 pixels")));
}

/// A tank of fixed walls around a block of fluid, as seen from (-x, -y, +z); dp 1.
ParticleCloud tank_of_water()
{
    ParticleCloud cloud = cloud_of({}, {});
    for (int x = 0; x < 21; ++x)
        for (int y = 0; y < 21; ++y)
            for (int z = 0; z < 21; ++z)
            {
                const bool is_wall = x == 0 || x == 20 || y == 0 || y == 20 || z == 0;
                if (!is_wall && (x < 6 || x > 14 || y < 6 || y > 14 || z > 8)) continue;
                cloud.positions.push_back({double(x), double(y), double(z)});
                cloud.mk.push_back(static_cast<std::uint16_t>(is_wall ? 10 : 1));
                cloud.type.push_back(static_cast<std::uint8_t>(is_wall ? 0 : 3));
            }
    return cloud;
}

TEST(RenderParticles, OpensTheWallsInFrontOfTheFluid)
{
    const auto blue = [](const Image& image)
    {
        return std::count_if(image.pixels.begin(), image.pixels.end(),
                             [](const Rgb& p) { return p[2] > p[0] + 30; });
    };
    for (const char* view : {"front", "left", "iso"})
    {
        RenderOptions options = small_front();
        options.view = parse_view(view);
        const auto closed = blue(render_particles({tank_of_water()}, options, 1));
        options.opens_walls = true;
        const auto open = blue(render_particles({tank_of_water()}, options, 1));
        EXPECT_GT(open, 300) << view;
        EXPECT_GT(open, 2 * closed) << view;
    }
    // Without types nothing is known to be a wall.
    RenderOptions options = small_front();
    ParticleCloud cloud = tank_of_water();
    cloud.type.clear();
    const Image plain = render_particles({cloud}, options, 1);
    options.opens_walls = true;
    EXPECT_EQ(render_particles({cloud}, options, 1).pixels, plain.pixels);
}

TEST(RenderParticles, LeavesAFixedPartThatStandsInTheFluidWhole)
{
    ParticleCloud cloud = tank_of_water();
    for (int i = 0; i < 27; ++i) // between the front wall and the water
    {
        const int x = i / 9;
        const int y = i / 3 % 3;
        cloud.positions.push_back({9.0 + x, 2.0 + y, 3.0 + i % 3});
        cloud.mk.push_back(11);
        cloud.type.push_back(0);
    }
    cloud.colours[11] = {20, 160, 40};
    RenderOptions options = small_front();
    const auto green = [&]
    {
        const Image image = render_particles({cloud}, options, 1);
        return std::count_if(image.pixels.begin(), image.pixels.end(),
                             [](const Rgb& p) { return p[1] > p[0] + 30 && p[1] > p[2] + 30; });
    };
    EXPECT_EQ(green(), 0); // behind the wall
    options.opens_walls = true;
    EXPECT_GT(green(), 50);
}

TEST(RenderParticles, CutsFluidThatHidesAllParts)
{
    ParticleCloud cloud = tank_of_water();
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    {
        const Vec3& p = cloud.positions[i];
        const bool is_inner = p.x > 8 && p.x < 12 && p.y > 8 && p.y < 12 && p.z > 3 && p.z < 6;
        if (!is_inner) continue;
        cloud.mk[i] = 11;
        cloud.type[i] = 1;
    }
    cloud.colours[11] = {20, 160, 40};
    for (const char* view : {"front", "iso"})
    {
        RenderOptions options = small_front();
        options.view = parse_view(view);
        const auto count = [&](auto&& has)
        {
            const Image image = render_particles({cloud}, options, 1);
            return std::count_if(image.pixels.begin(), image.pixels.end(), has);
        };
        const auto is_green = [](const Rgb& p) { return p[1] > p[0] + 30 && p[1] > p[2] + 30; };
        EXPECT_EQ(count(is_green), 0) << view;
        options.opens_walls = true;
        EXPECT_GT(count(is_green), 50) << view;
        EXPECT_GT(count([](const Rgb& p) { return p[2] > p[0] + 30; }), 200) << view;
    }
}

TEST(RenderParticles, ColoursByRoleFirst)
{
    const auto [r, g, b] = colour_of_mk(14, 3);
    EXPECT_GT(b, r + 50) << "fluid is blue";
    for (const auto mk : std::initializer_list<std::uint16_t>{1, 11, 12, 90})
    {
        const Rgb grey = colour_of_mk(mk, 0);
        EXPECT_LT(std::abs(grey[0] - grey[2]), 20) << "fixed is grey";
        for (const auto type : std::initializer_list<std::uint8_t>{1, 2})
            EXPECT_GT(colour_of_mk(mk, type)[0], colour_of_mk(mk, type)[2] + 50) << "warm";
    }
}

TEST(RenderParticles, HasAScaleBarOfARoundLengthAndALegend)
{
    RenderOptions options = small_front();
    const Image bare = render_particles({two_spheres()}, options, 1);
    options.has_scale_bar = true;
    const Image barred = render_particles({two_spheres()}, options, 1);
    // 4 m of spheres fill 188 of 200 pixels; the bar is 1 m.
    int black = 0;
    for (int x = 0; x < 200; ++x)
        black += static_cast<int>(barred.at(x, 94) == Rgb{0, 0, 0} && bare.at(x, 94) == white);
    EXPECT_NEAR(black, 47, 2);
    options.has_scale_bar = false;
    options.has_legend = true;
    const Image named = render_particles({two_spheres()}, options, 1);
    EXPECT_EQ(named.at(7, 8), colour_of_mk(1, unknown_type));
    EXPECT_EQ(named.at(7, 19), colour_of_mk(12, unknown_type));
}

TEST(ParseView, ListsTheViewsWhenOneIsUnknown)
{
    for (const char* text : {"", "sideways", "1", "1,2,3", "0,91", "nan,0"})
        EXPECT_THAT([&] { parse_view(text); },
                    ThrowsMessage<UsageError>(HasSubstr("expected iso, front, back, left")))
            << text;
    EXPECT_EQ(parse_view("-30,12.5").azimuth_deg, -30);
    EXPECT_EQ(parse_view("-30,12.5").elevation_deg, 12.5);
}

TEST(ParseCut, ReadsAnAxisASideAndAPlace)
{
    const CutPlane cut = parse_cut("z<-1.5e-1");
    EXPECT_EQ(cut.axis, 2);
    EXPECT_FALSE(cut.keep_above);
    EXPECT_EQ(cut.at, -0.15);
    for (const char* text : {"", "y", "y>", "w>1", "y=1", "y>1m", "y>inf"})
        EXPECT_THROW(parse_cut(text), UsageError) << text;
}

TEST(WritePng, IsReadBackAsTheSameImage)
{
    const Image image = render_particles({block()}, small_front(), 1);
    EXPECT_EQ(png_pixels(written([&](OutputFile& file) { write_png(file, image); })), image.pixels);
}

TEST(WritePng, KeepsColoursNearlyWithAPalette)
{
    const Image image = render_particles({block()}, small_front(), 1);
    const std::vector<Rgb> pixels =
        png_pixels(written([&](OutputFile& file) { write_png(file, image, true); }));
    ASSERT_EQ(pixels.size(), image.pixels.size());
    double squares = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i)
    {
        EXPECT_EQ(pixels[i] == white, image.pixels[i] == white);
        for (std::size_t c = 0; c < 3; ++c)
            squares += std::pow(double(pixels[i][c]) - double(image.pixels[i][c]), 2);
    }
    EXPECT_LT(std::sqrt(squares / static_cast<double>(3 * pixels.size())), 3);
}

TEST(WritePng, KeepsFewColoursExactlyWithAPalette)
{
    Image image;
    image.width = 16;
    image.height = 8;
    for (int i = 0; i < 128; ++i)
        image.pixels.push_back({static_cast<std::uint8_t>(4 * (i % 64)), 7,
                                static_cast<std::uint8_t>(200 + 8 * (i / 64))});
    EXPECT_EQ(png_pixels(written([&](OutputFile& file) { write_png(file, image, true); })),
              image.pixels);
    image.pixels.assign(128, white);
    EXPECT_EQ(png_pixels(written([&](OutputFile& file) { write_png(file, image, true); })),
              image.pixels);
}

} // namespace fppg
