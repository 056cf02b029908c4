#include "balance/anderson_mixing.h"

#include "balance/small_matrix.h"
#include "core/parallel.h"

#include <vector>

namespace fppg
{
namespace
{

/// Makes changes that are nearly multiples of one another count less, over their products.
constexpr double damping = 1e-8;
constexpr std::size_t chunk_of_products = 4096;

std::array<float, 3> in_floats(const Vec3& v)
{
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

Vec3 vec_of(const std::array<float, 3>& v)
{
    return {double{v[0]}, double{v[1]}, double{v[2]}};
}

} // namespace

AndersonMixing::AndersonMixing(std::size_t n, int threads)
    : threads_(threads), places_(n), forces_(n)
{
    static_assert(window <= SmallMatrix::most_rows);
    for (auto& change : changes_) change.resize(n);
}

void AndersonMixing::add(std::span<const Vec3> places, std::span<const Vec3> forces)
{
    if (has_last_)
    {
        newest_ = count_ < window ? count_ : (newest_ + 1) % window;
        count_ = std::min(count_ + 1, window);
    }
    RawArray<Change>& change = changes_[newest_];
    parallel_for(
        places.size(), threads_,
        [&](std::size_t i)
        {
            if (has_last_)
                change[i] = {in_floats(places[i] - places_[i]), in_floats(forces[i] - forces_[i])};
            places_[i] = places[i];
            forces_[i] = forces[i];
        },
        chunk_of_products);
    if (has_last_)
    {
        const auto [of_newest, with_force] = products();
        for (std::size_t p = 0; p < count_; ++p)
            between_[newest_][p] = between_[p][newest_] = of_newest[p];
        set_shares(with_force);
    }
    has_last_ = true;
}

std::array<AndersonMixing::Products, 2> AndersonMixing::products() const
{
    const std::size_t n = forces_.size();
    std::vector<std::array<Products, 2>> of_chunk((n + chunk_of_products - 1) / chunk_of_products);
    parallel_for(of_chunk.size(), threads_,
                 [&](std::size_t c)
                 {
                     std::array<Products, 2> sums{};
                     for (std::size_t i = c * chunk_of_products;
                          i < std::min(n, (c + 1) * chunk_of_products); ++i)
                     {
                         const Vec3 newest = vec_of(changes_[newest_][i].force);
                         for (std::size_t p = 0; p < count_; ++p)
                         {
                             const Vec3 other = vec_of(changes_[p][i].force);
                             sums[0][p] += dot(newest, other);
                             sums[1][p] += dot(forces_[i], other);
                         }
                     }
                     of_chunk[c] = sums;
                 });
    std::array<Products, 2> out{};
    for (const auto& sums : of_chunk)
        for (std::size_t k = 0; k < 2; ++k)
            for (std::size_t p = 0; p < count_; ++p) out[k][p] += sums[k][p];
    return out;
}

/// Of least squares: between the changes, each over its own size.
void AndersonMixing::set_shares(const Products& with_force)
{
    shares_ = {};
    SmallMatrix matrix, inverse;
    matrix.n = static_cast<int>(count_);
    Products sizes{};
    for (std::size_t p = 0; p < count_; ++p)
    {
        sizes[p] = std::sqrt(between_[p][p]);
        if (!(sizes[p] > 0)) return;
    }
    for (std::size_t p = 0; p < count_; ++p)
        for (std::size_t q = 0; q < count_; ++q)
            matrix.a[p][q] = between_[p][q] / (sizes[p] * sizes[q]) * (p == q ? 1 + damping : 1.0);
    if (invert(matrix, inverse) == 0) return;
    for (std::size_t p = 0; p < count_; ++p)
        for (std::size_t q = 0; q < count_; ++q)
            shares_[p] += inverse.a[p][q] * with_force[q] / (sizes[p] * sizes[q]);
}

Vec3 AndersonMixing::step(std::size_t i, double mobility) const
{
    Vec3 force = forces_[i], step;
    for (std::size_t p = 0; p < count_; ++p)
    {
        force = force - shares_[p] * vec_of(changes_[p][i].force);
        step = step - shares_[p] * vec_of(changes_[p][i].place);
    }
    return step + mobility * force;
}

} // namespace fppg
