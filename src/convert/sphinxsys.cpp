// What SPHinXsys reloads: Position "x, y, z" (two numbers in a plane) and VolumetricMeasure of
// every particle; shells also NormalDirection and Thickness, which others leave unread.

#include "convert/formats.h"
#include "convert/text_lines.h"

#include <filesystem>

namespace fppg
{

namespace
{

/// The particles of a body as elements <particle/>.
void append_particles(OutputFile& file, const ParticleFeed& feed, const BodyOrder& order,
                      std::size_t body, int threads)
{
    append_lines(
        file, feed, threads,
        [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k, auto)
        {
            const Vec3& p = piece.positions[k];
            put_text(text, "<particle Position=\"{}, {}", p.x, p.y);
            if (!feed.is_2d) put_text(text, ", {}", p.z);
            put_text(text, "\" VolumetricMeasure=\"{}\"", piece.volumes[k]);
            if (!piece.normals.empty())
            {
                const std::array<float, 3>& n = piece.normals[k];
                put_text(text, " NormalDirection=\"{}, {}", n[0], n[1]);
                if (!feed.is_2d) put_text(text, ", {}", n[2]);
                put_text(text, "\" Thickness=\"{}\"", feed.dp);
            }
            put_text(text, "/>\n");
        },
        &order, static_cast<std::uint16_t>(body));
}

void say_reload_losses(const ParticleFeed& feed, ConvertedFiles& out)
{
    say_volumes(feed, out);
    out.losses.emplace_back("SPHinXsys takes density and velocity from the program, not the file");
}

} // namespace

void write_sphinxsys(const ParticleFeed& given, const std::string& path, int threads,
                     ConvertedFiles& out)
{
    const ParticleFeed feed = in_xy_plane(given, out);
    say_reload_losses(feed, out);
    const BodyOrder order = order_by_body(feed, threads);
    OutputFile& file = out.files.emplace_back(path);
    file.append("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<reload_data>\n");
    for (std::size_t body = 0; body < feed.bodies.size(); ++body)
    {
        file.append(fmt::format("<body name=\"{}\">\n", feed.bodies[body].name));
        append_particles(file, feed, order, body, threads);
        file.append("</body>\n");
    }
    file.append("</reload_data>\n");
}

void write_sphinxsys_bodies(const ParticleFeed& given, const std::string& path, int threads,
                            ConvertedFiles& out)
{
    const ParticleFeed feed = in_xy_plane(given, out);
    say_reload_losses(feed, out);
    const BodyOrder order = order_by_body(feed, threads);
    const std::filesystem::path folder = std::filesystem::path(path).parent_path();
    for (std::size_t body = 0; body < feed.bodies.size(); ++body)
    {
        OutputFile& file =
            out.files.emplace_back((folder / (feed.bodies[body].name + "_rld.xml")).string());
        file.append("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<particles>\n");
        append_particles(file, feed, order, body, threads);
        file.append("</particles>\n");
    }
}

} // namespace fppg
