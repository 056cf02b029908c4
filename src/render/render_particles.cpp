#include "fppg/render.h"

#include "core/parallel.h"
#include "fppg/error.h"
#include "render/labels.h"
#include "render/open_walls.h"
#include "render/sphere_scene.h"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

namespace fppg
{

namespace
{

constexpr int tile_size = 16; ///< pixels
constexpr Rgb background = {255, 255, 255};
constexpr Rgb separator = {160, 160, 160};
/// Part of the picture that stays free at each side.
constexpr double margin = 0.03;

struct Vec3f
{
    float x, y, z;
};
Vec3f operator+(Vec3f a, Vec3f b)
{
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec3f operator-(Vec3f a, Vec3f b)
{
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec3f operator*(float s, Vec3f a)
{
    return {s * a.x, s * a.y, s * a.z};
}
float dot(Vec3f a, Vec3f b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec3f to_float(const Vec3& a)
{
    return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)};
}

/// Sine of an angle in degrees, exact at multiples of 90.
double sine(double angle_deg)
{
    const double quarter = std::round(angle_deg / 90);
    const double rest = (angle_deg - 90 * quarter) * std::numbers::pi / 180;
    switch (static_cast<int>(std::fmod(quarter, 4) + 4) % 4)
    {
        case 0:
            return std::sin(rest);
        case 1:
            return std::cos(rest);
        case 2:
            return -std::sin(rest);
        default:
            return -std::cos(rest);
    }
}

/// Axes of the picture; `towards` points from the particles to the camera.
struct CameraAxes
{
    Vec3 right, up, towards;
};

CameraAxes camera_axes(const ViewDirection& view)
{
    const double sin_a = sine(view.azimuth_deg);
    const double cos_a = sine(view.azimuth_deg + 90);
    const double sin_e = sine(view.elevation_deg);
    const double cos_e = sine(view.elevation_deg + 90);
    CameraAxes axes;
    axes.towards = {sin_a * cos_e, -cos_a * cos_e, sin_e};
    axes.right = {cos_a, sin_a, 0};
    axes.up = cross(axes.towards, axes.right);
    return axes;
}

/// Axes and what they show; lengths in units of `scale` metres around `middle`, so that single
/// precision resolves a case far from the origin.
struct Camera
{
    CameraAxes axes;
    Vec3 middle;      ///< in the middle of a panel
    double scale = 1; ///< metres
    double pixel = 0; ///< side of a pixel, in units
    double reach = 0; ///< all spheres lie within this distance from the middle, in units
};

/// Indices of the particles to draw.
std::vector<std::uint32_t> choose(const ParticleCloud& cloud, const RenderOptions& options)
{
    std::vector<bool> is_wanted(65536, options.mks.empty());
    for (const std::uint16_t mk : options.mks) is_wanted[mk] = true;
    const double room = 1e-6 * cloud.dp;
    const auto is_kept = [&](std::size_t i)
    {
        if (!is_wanted[cloud.mk[i]] || !is_finite(cloud.positions[i])) return false;
        return std::all_of(options.cuts.begin(), options.cuts.end(),
                           [&](const CutPlane& cut)
                           {
                               const double above = cloud.positions[i][cut.axis] - cut.at;
                               return cut.keep_above ? above >= -room : above <= room;
                           });
    };
    std::vector<std::uint32_t> chosen;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i)
        if (is_kept(i)) chosen.push_back(static_cast<std::uint32_t>(i));
    return chosen;
}

void check_options(const std::vector<ParticleCloud>& clouds, const RenderOptions& options)
{
    const auto require = [](bool holds, const std::string& text)
    {
        if (!holds) throw UsageError(text);
    };
    require(clouds.size() == 1 || clouds.size() == 2,
            fmt::format("{} cases to draw, expected one or two", clouds.size()));
    require(options.width >= 16 && options.width <= 16384 && options.height >= 16 &&
                options.height <= 16384,
            fmt::format("a picture of {} x {} pixels, expected 16 to 16384 each", options.width,
                        options.height));
    require(options.zoom > 0 && std::isfinite(options.zoom),
            fmt::format("a zoom of {}, expected a number above 0", options.zoom));
    require(options.radius_dp > 0 && std::isfinite(options.radius_dp),
            fmt::format("a radius of {} dp, expected a number above 0", options.radius_dp));
    require(options.samples >= 1 && options.samples <= 8,
            fmt::format("{} samples, expected 1 to 8", options.samples));
    for (const ParticleCloud& cloud : clouds)
    {
        require(
            options.colour != RenderColour::Kind || !cloud.kind.empty() || cloud.positions.empty(),
            fmt::format("'{}' has no array Kind to colour by; _All.vtk of a body-fitted case "
                        "has one",
                        cloud.file));
        require(options.colour != RenderColour::Layer || !cloud.layer.empty() ||
                    cloud.positions.empty(),
                fmt::format("'{}' has no array Layer to colour by; _All.vtk of a body-fitted case "
                            "has one",
                            cloud.file));
        require(cloud.positions.size() <= std::numeric_limits<std::uint32_t>::max() - 1,
                fmt::format("'{}' has {} particles, a picture takes up to 4,294,967,294",
                            cloud.file, cloud.positions.size()));
    }
}

/// The camera that shows all chosen particles of all clouds in a panel.
Camera place_camera(const std::vector<ParticleCloud>& clouds,
                    const std::vector<std::vector<std::uint32_t>>& chosen,
                    const RenderOptions& options, int panel_width)
{
    Camera camera;
    camera.axes = camera_axes(options.view);
    const CameraAxes& axes = camera.axes;
    Box3 box; // along the axes of the camera
    double radius = 0;
    for (std::size_t c = 0; c < clouds.size(); ++c)
    {
        for (const std::uint32_t i : chosen[c])
        {
            const Vec3& p = clouds[c].positions[i];
            box.add({dot(p, axes.right), dot(p, axes.up), dot(p, axes.towards)});
        }
        if (!chosen[c].empty()) radius = std::max(radius, options.radius_dp * clouds[c].dp);
    }
    const Vec3 half = 0.5 * (box.max - box.min);
    const Vec3 centre = box.min + half;
    const Vec3 middle_of_all = centre.x * axes.right + centre.y * axes.up + centre.z * axes.towards;
    camera.middle = options.center.value_or(middle_of_all);
    camera.scale = norm(half) + radius;
    const double free = 1 - 2 * margin;
    const double pixel_m = std::max(2 * (half.x + radius) / (free * panel_width),
                                    2 * (half.y + radius) / (free * options.height));
    camera.pixel = pixel_m / camera.scale / options.zoom;
    camera.reach = norm(camera.middle - middle_of_all) / camera.scale + 1.01;
    return camera;
}

struct Lights
{
    Vec3f key, fill; ///< unit vectors towards the lights
};

Lights place_lights(const CameraAxes& axes)
{
    const auto direction = [&](double right, double up, double towards)
    {
        const Vec3 d = right * axes.right + up * axes.up + towards * axes.towards;
        return to_float(d / norm(d));
    };
    return {direction(-0.45, 0.75, 0.75), direction(0.8, 0.1, 0.6)};
}

/// One cloud, ready for rays.
struct Panel
{
    const Camera& camera;
    std::vector<SphereScene::Sphere> spheres;
    std::vector<Rgb> colours; ///< of every sphere
    Vec3f right, up, towards;
    Lights lights;
    float start = 0; ///< of rays from the plane through the middle, against their direction
    float room = 0;  ///< that a shadow ray keeps from its sphere

    Panel(const ParticleCloud& cloud, const std::vector<std::uint32_t>& chosen,
          const Camera& seen_by, const RenderOptions& options)
        : camera(seen_by),
          right(to_float(camera.axes.right)),
          up(to_float(camera.axes.up)),
          towards(to_float(camera.axes.towards)),
          lights(place_lights(camera.axes))
    {
        const double radius = options.radius_dp * cloud.dp / camera.scale;
        spheres.reserve(chosen.size());
        colours.reserve(chosen.size());
        for (const std::uint32_t i : chosen)
        {
            const Vec3f p = to_float((cloud.positions[i] - camera.middle) / camera.scale);
            spheres.push_back({p.x, p.y, p.z, static_cast<float>(radius)});
            colours.push_back(colour_of(cloud, i, options.colour));
        }
        start = static_cast<float>(camera.reach);
        room = static_cast<float>(std::max(0.02 * radius, 1e-6 * camera.reach));
    }
};

/// Sums of the samples of a pixel.
struct PixelSum
{
    float red = 0;
    float green = 0;
    float blue = 0;
};

void set_rays(RTCRay8& rays)
{
    for (int k = 0; k < 8; ++k)
    {
        rays.tnear[k] = 0;
        rays.tfar[k] = std::numeric_limits<float>::infinity();
        rays.time[k] = 0;
        rays.mask[k] = 0xffffffffU;
        rays.id[k] = 0;
        rays.flags[k] = 0;
    }
}

/// Sends eight rays from the camera, and one from every place they meet to the key light.
///
/// from  where the rays pass the plane through the middle
/// out   the colour of each, 0 to 255
void trace(const Panel& panel, RTCScene scene, const Vec3f (&from)[8], PixelSum (&out)[8])
{
    RTCRayHit8 rays;
    set_rays(rays.ray);
    alignas(32) int valid[8];
    for (int k = 0; k < 8; ++k)
    {
        const Vec3f origin = from[k] + panel.start * panel.towards;
        rays.ray.org_x[k] = origin.x;
        rays.ray.org_y[k] = origin.y;
        rays.ray.org_z[k] = origin.z;
        rays.ray.dir_x[k] = -panel.towards.x;
        rays.ray.dir_y[k] = -panel.towards.y;
        rays.ray.dir_z[k] = -panel.towards.z;
        rays.hit.geomID[k] = RTC_INVALID_GEOMETRY_ID;
        rays.hit.instID[0][k] = RTC_INVALID_GEOMETRY_ID;
        valid[k] = -1;
        out[k] = {background[0], background[1], background[2]};
    }
    embree_intersect8(valid, scene, rays);

    RTCRay8 shadow{}; // rays that are not sent have places too: Embree of arm64 looks at them
    set_rays(shadow);
    Vec3f normals[8];
    bool is_any_lit = false;
    for (int k = 0; k < 8; ++k)
    {
        valid[k] = 0;
        normals[k] = {};
        if (rays.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
        const SphereScene::Sphere& sphere = panel.spheres[rays.hit.primID[k]];
        const Vec3f centre = {sphere.x, sphere.y, sphere.z};
        const Vec3f to_hit = from[k] + (panel.start - rays.ray.tfar[k]) * panel.towards - centre;
        normals[k] = (1 / std::sqrt(std::max(dot(to_hit, to_hit), 1e-30f))) * to_hit;
        if (dot(normals[k], panel.lights.key) <= 0) continue;
        const Vec3f origin = centre + (sphere.radius + panel.room) * normals[k];
        shadow.org_x[k] = origin.x;
        shadow.org_y[k] = origin.y;
        shadow.org_z[k] = origin.z;
        shadow.dir_x[k] = panel.lights.key.x;
        shadow.dir_y[k] = panel.lights.key.y;
        shadow.dir_z[k] = panel.lights.key.z;
        valid[k] = -1;
        is_any_lit = true;
    }
    if (is_any_lit) embree_occluded8(valid, scene, shadow);

    for (int k = 0; k < 8; ++k)
    {
        if (rays.hit.geomID[k] == RTC_INVALID_GEOMETRY_ID) continue;
        const Vec3f& normal = normals[k];
        const bool is_lit = valid[k] != 0 && shadow.tfar[k] >= 0;
        const float key = is_lit ? dot(normal, panel.lights.key) : 0.0f;
        const float fill = std::max(dot(normal, panel.lights.fill), 0.0f);
        // Light from all around: less where the sphere turns away from the camera, which is where
        // its neighbours stand.
        const float around =
            0.40f + 0.16f * dot(normal, panel.towards) + 0.1f * dot(normal, panel.up);
        const float light = around + 0.48f * key + 0.20f * fill;
        const Rgb& colour = panel.colours[rays.hit.primID[k]];
        const auto shade = [&](std::uint8_t part)
        { return std::min(light * static_cast<float>(part), 255.0f); };
        out[k] = {shade(colour[0]), shade(colour[1]), shade(colour[2])};
    }
}

/// A tile of a panel.
struct Tile
{
    int panel_x = 0; ///< first pixel of the panel in the picture
    int panel_width = 0;
    int x = 0; ///< first pixel of the tile in the panel
    int y = 0;
};

/// What a colour stands for, by colour_value().
using Legend = std::map<unsigned, std::pair<Rgb, std::string>>;

Legend legend_of(const std::vector<ParticleCloud>& clouds,
                 const std::vector<std::vector<std::uint32_t>>& chosen, RenderColour colour)
{
    Legend legend;
    for (std::size_t c = 0; c < clouds.size(); ++c)
        for (const std::uint32_t i : chosen[c])
        {
            const ParticleCloud& cloud = clouds[c];
            const unsigned value = colour_value(cloud, i, colour);
            if (!legend.contains(value))
                legend.emplace(
                    value, std::pair(colour_of(cloud, i, colour), colour_name(cloud, i, colour)));
        }
    return legend;
}

/// Pixels of a dot of a letter.
int letter_size(const Image& image)
{
    return std::max(1, std::min(image.width, image.height) / 350);
}

void draw_legend(Image& image, const Legend& legend)
{
    const int size = letter_size(image);
    const int row = (letter_rows + 4) * size;
    int y = row / 2;
    std::size_t drawn = 0;
    for (const auto& [value, entry] : legend)
    {
        if (y + 2 * row > image.height)
        {
            draw_text(image, row / 2, y, size, fmt::format("and {} more", legend.size() - drawn));
            return;
        }
        fill_rectangle(image, row / 2, y, letter_rows * size, letter_rows * size, entry.first);
        draw_text(image, row / 2 + row, y, size, entry.second);
        y += row;
        ++drawn;
    }
}

/// A length of 1, 2 or 5 times a power of ten, a sixth to a third of the picture.
void draw_scale_bar(Image& image, const Camera& camera)
{
    const double pixel_m = camera.pixel * camera.scale;
    const double most = pixel_m * image.width / 4;
    const double power = std::pow(10, std::floor(std::log10(most)));
    const double length = power * (most >= 5 * power ? 5 : most >= 2 * power ? 2 : 1);
    const int size = letter_size(image);
    const auto width = static_cast<int>(std::lround(length / pixel_m));
    const int x = 4 * size;
    const int y = image.height - 6 * size;
    fill_rectangle(image, x, y, width, size, {0, 0, 0});
    for (const int end : {x, x + width - size})
        fill_rectangle(image, end, y - 2 * size, size, 5 * size, {0, 0, 0});
    const bool is_small = length < 0.0999;
    draw_text(image, x + 2 * size, y - (letter_rows + 3) * size, size,
              fmt::format("{:g} {}", is_small ? 1000 * length : length, is_small ? "mm" : "m"));
}

void draw_tile(const Panel& panel, RTCScene scene, const RenderOptions& options, const Tile& tile,
               Image& image)
{
    const auto [panel_x, panel_width, tile_x, tile_y] = tile;
    const int s = options.samples;
    const int width = std::min(tile_size, panel_width - tile_x);
    const int height = std::min(tile_size, options.height - tile_y);
    std::vector<PixelSum> sums(std::size_t{tile_size} * tile_size);
    const auto step = static_cast<float>(panel.camera.pixel / s);
    // Packets of 4 x 2 samples.
    for (int y = 0; y < height * s; y += 2)
        for (int x = 0; x < width * s; x += 4)
        {
            Vec3f from[8];
            PixelSum colours[8];
            for (int k = 0; k < 8; ++k)
            {
                const int sx = tile_x * s + x + k % 4;
                const int sy = tile_y * s + y + k / 4;
                const float right =
                    (static_cast<float>(sx) + 0.5f - 0.5f * static_cast<float>(panel_width * s)) *
                    step;
                const float up = (0.5f * static_cast<float>(options.height * s) -
                                  static_cast<float>(sy) - 0.5f) *
                                 step;
                from[k] = right * panel.right + up * panel.up;
            }
            trace(panel, scene, from, colours);
            for (int k = 0; k < 8; ++k)
            {
                const int px = (x + k % 4) / s;
                const int py = (y + k / 4) / s;
                if (px >= width || py >= height) continue;
                PixelSum& sum =
                    sums[static_cast<std::size_t>(py) * tile_size + static_cast<std::size_t>(px)];
                sum.red += colours[k].red;
                sum.green += colours[k].green;
                sum.blue += colours[k].blue;
            }
        }
    const float share = 1.0f / static_cast<float>(s * s);
    const auto level = [&](float sum)
    { return static_cast<std::uint8_t>(std::lround(sum * share)); };
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
        {
            const PixelSum& sum =
                sums[static_cast<std::size_t>(y) * tile_size + static_cast<std::size_t>(x)];
            image.pixels[static_cast<std::size_t>(tile_y + y) *
                             static_cast<std::size_t>(image.width) +
                         static_cast<std::size_t>(panel_x + tile_x + x)] = {
                level(sum.red), level(sum.green), level(sum.blue)};
        }
}

} // namespace

Image render_particles(const std::vector<ParticleCloud>& clouds, const RenderOptions& options,
                       int threads)
{
    check_options(clouds, options);
    std::vector<std::vector<std::uint32_t>> chosen;
    bool has_any = false;
    for (const ParticleCloud& cloud : clouds)
    {
        chosen.push_back(choose(cloud, options));
        if (options.opens_walls)
        {
            const CameraAxes axes = camera_axes(options.view);
            open_walls(cloud, axes.towards, axes.right, axes.up, chosen.back());
        }
        has_any = has_any || !chosen.back().empty();
    }
    if (!has_any)
        throw UsageError(fmt::format("'{}': no particle is left to draw", clouds.front().file));

    Image image;
    image.width = options.width;
    image.height = options.height;
    image.pixels.assign(
        static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height),
        background);
    const int n_panels = static_cast<int>(clouds.size());
    const int panel_width = options.width / n_panels;
    const Camera camera = place_camera(clouds, chosen, options, panel_width);
    for (int c = 0; c < n_panels; ++c)
    {
        const auto index = static_cast<std::size_t>(c);
        if (chosen[index].empty()) continue;
        const Panel panel(clouds[index], chosen[index], camera, options);
        const SphereScene scene(panel.spheres, threads);
        const int tiles_x = (panel_width + tile_size - 1) / tile_size;
        const int tiles_y = (options.height + tile_size - 1) / tile_size;
        parallel_for(static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y), threads,
                     [&](std::size_t tile)
                     {
                         const int t = static_cast<int>(tile);
                         draw_tile(panel, scene.handle(), options,
                                   {c * panel_width, panel_width, t % tiles_x * tile_size,
                                    t / tiles_x * tile_size},
                                   image);
                     });
    }
    for (int c = 1; c < n_panels; ++c)
        for (int y = 0; y < options.height; ++y)
            image.pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(options.width) +
                         static_cast<std::size_t>(c * panel_width)] = separator;
    if (options.has_scale_bar) draw_scale_bar(image, camera);
    if (options.has_legend) draw_legend(image, legend_of(clouds, chosen, options.colour));
    return image;
}

} // namespace fppg
