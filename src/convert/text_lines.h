#pragma once

#include "convert/columns.h"
#include "core/parallel.h"

#include <fmt/format.h>

#include <iterator>

namespace fppg
{

/// Texts that threads make at once before they are written in order.
inline constexpr std::size_t texts_at_once = 16;

/// Appends the text that line(text, piece, k, number) makes of every particle, in their order; k is
/// the particle's place in the piece, `number` counts them from 0. Memory is that of some pieces.
///
/// order, body  only the particles of this body; order null: all
template <typename Line>
void append_lines(OutputFile& file, const ParticleFeed& feed, int threads, const Line& line,
                  const BodyOrder* order = nullptr, std::uint16_t body = 0)
{
    std::vector<std::pair<std::size_t, std::uint64_t>> pieces; // and the number of the first
    for (std::size_t i = 0; i < feed.pieces(); ++i)
    {
        if (order == nullptr)
        {
            pieces.emplace_back(i, i * feed_piece);
            continue;
        }
        for (const BodyOrder::Part& part : order->pieces[i])
            if (part.body == body) pieces.emplace_back(i, part.first);
    }
    for (std::size_t begin = 0; begin < pieces.size(); begin += texts_at_once)
    {
        const std::size_t n = std::min(texts_at_once, pieces.size() - begin);
        std::vector<fmt::memory_buffer> texts(n);
        parallel_for(n, threads,
                     [&](std::size_t t)
                     {
                         thread_local ParticlePiece piece;
                         const auto [number, first] = pieces[begin + t];
                         feed.read(number, piece);
                         std::uint64_t next = first;
                         for (std::size_t k = 0; k < piece.size(); ++k)
                             if (order == nullptr || piece.bodies[k] == body)
                                 line(texts[t], piece, k, next++);
                     });
        for (const fmt::memory_buffer& text : texts) file.append(text.data(), text.size());
    }
}

/// Appends formatted text to a buffer.
template <typename... Arguments>
void put_text(fmt::memory_buffer& out, fmt::format_string<Arguments...> form,
              Arguments&&... arguments)
{
    fmt::format_to(std::back_inserter(out), form, std::forward<Arguments>(arguments)...);
}

} // namespace fppg
