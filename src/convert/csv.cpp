#include "convert/formats.h"
#include "convert/text_lines.h"

namespace fppg
{

void write_csv(const ParticleFeed& feed, const std::string& path, int threads, ConvertedFiles& out)
{
    OutputFile& file = out.files.emplace_back(path);
    say_volumes(feed, out);
    file.append("x,y,z,vx,vy,vz,density,mass,volume,nx,ny,nz,spacing,id,mk,body,type,kind\n");
    constexpr std::array types{"fixed", "moving", "floating", "fluid"};
    constexpr std::array kinds{"corner", "edge", "surface", "volume"};
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k, auto)
                 {
                     const Vec3& p = piece.positions[k];
                     const FeedBody& body = feed.bodies[piece.bodies[k]];
                     put_text(text, "{},{},{},", p.x, p.y, p.z);
                     const auto put_vector = [&](const std::vector<std::array<float, 3>>& vectors)
                     {
                         if (vectors.empty()) return put_text(text, ",,,");
                         const std::array<float, 3>& v = vectors[k];
                         put_text(text, "{},{},{},", v[0], v[1], v[2]);
                     };
                     put_vector(piece.velocities);
                     put_text(text, "{},{},{},", piece.densities[k], feed.mass(piece, k),
                              piece.volumes[k]);
                     put_vector(piece.normals);
                     put_text(text, "{},{},{},{},{},{}\n", feed.dp, piece.ids[k], body.mk,
                              body.name, types[static_cast<std::size_t>(body.type)],
                              piece.kinds.empty() ? "" : kinds[piece.kinds[k]]);
                 });
}

} // namespace fppg
