// Keyword decks: nodes in fields of fixed width and a cell of SPH a node, its volume with it.
//   LS-DYNA  *NODE I8 3xF16 in short form, I20 3xE20 in long; *ELEMENT_SPH_VOLUME I8 I8 F16
//   Radioss  /NODE I10 3xF20; /SPHCEL/part I10 I10 F20, its type 2 is a volume, which the
//            part's material turns into a mass (Altair's reference guide)

#include "convert/formats.h"
#include "convert/text_lines.h"
#include "fppg/error.h"

namespace fppg
{

namespace
{

/// Fields of eight and ten digits hold node numbers up to here.
constexpr std::uint64_t most_ls_dyna_nodes = 99999999;
constexpr std::uint64_t most_radioss_nodes = 4294967294;

void expect_at_most(const ParticleFeed& feed, std::uint64_t most, const std::string& path)
{
    if (feed.count > most)
        throw IoError(
            fmt::format("cannot write '{}': {} particles, but its fields hold node "
                        "numbers up to {}",
                        path, feed.count, most));
}

void say_deck_losses(const ParticleFeed& feed, int digits, ConvertedFiles& out)
{
    say_volumes(feed, out);
    out.losses.emplace_back(
        fmt::format("positions have {} digits; density is that of the part's material", digits));
    say_no_walls(feed, out);
}

} // namespace

void write_ls_dyna(const ParticleFeed& feed, const std::string& path, int threads,
                   ConvertedFiles& out)
{
    expect_at_most(feed, most_ls_dyna_nodes, path);
    say_deck_losses(feed, 10, out);
    OutputFile& file = out.files.emplace_back(path);
    file.append(fmt::format("*KEYWORD\n$ particles of {} by fppg, dp {}; SI units\n",
                            feed.case_name, feed.dp));
    for (std::size_t body = 0; body < feed.bodies.size(); ++body)
        file.append(fmt::format("$ part {}: {}\n", body + 1, feed.bodies[body].name));
    file.append("*NODE\n");
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k,
                     std::uint64_t number)
                 {
                     const Vec3& p = piece.positions[k];
                     put_text(text, "{:8}{:16.9e}{:16.9e}{:16.9e}\n", number + 1, p.x, p.y, p.z);
                 });
    file.append("*ELEMENT_SPH_VOLUME\n");
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k,
                     std::uint64_t number) {
                     put_text(text, "{:8}{:8}{:16.9e}\n", number + 1, piece.bodies[k] + 1,
                              piece.volumes[k]);
                 });
    file.append("*END\n");
}

void write_radioss(const ParticleFeed& feed, const std::string& path, int threads,
                   ConvertedFiles& out)
{
    expect_at_most(feed, most_radioss_nodes, path);
    say_deck_losses(feed, 13, out);
    OutputFile& file = out.files.emplace_back(path);
    file.append(fmt::format("# particles of {} by fppg, dp {}; SI units\n/NODE\n", feed.case_name,
                            feed.dp));
    append_lines(file, feed, threads,
                 [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k,
                     std::uint64_t number)
                 {
                     const Vec3& p = piece.positions[k];
                     put_text(text, "{:10}{:20.12e}{:20.12e}{:20.12e}\n", number + 1, p.x, p.y,
                              p.z);
                 });
    const BodyOrder order = order_by_body(feed, threads);
    for (std::size_t body = 0; body < feed.bodies.size(); ++body)
    {
        file.append(fmt::format("# {}\n/SPHCEL/{}\n", feed.bodies[body].name, body + 1));
        append_lines(
            file, feed, threads,
            [&](fmt::memory_buffer& text, const ParticlePiece& piece, std::size_t k, auto)
            { put_text(text, "{:10}{:10}{:20.12e}\n", piece.first + k + 1, 2, piece.volumes[k]); },
            &order, static_cast<std::uint16_t>(body));
    }
}

} // namespace fppg
