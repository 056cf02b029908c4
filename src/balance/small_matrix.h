#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

namespace fppg
{

/// A square matrix of up to four rows.
struct SmallMatrix
{
    static constexpr int most_rows = 4;

    int n = most_rows;
    std::array<std::array<double, most_rows>, most_rows> a{};

    double largest_row_sum() const
    {
        double out = 0;
        for (int i = 0; i < n; ++i)
        {
            double sum = 0;
            for (int j = 0; j < n; ++j) sum += std::abs(at(i, j));
            out = std::max(out, sum);
        }
        return out;
    }
    double at(int i, int j) const
    {
        return a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
    double& at(int i, int j) { return a[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)]; }
};

/// Gauss-Jordan with pivots. The determinant; 0 where there is no inverse.
inline double invert(SmallMatrix m, SmallMatrix& inverse)
{
    inverse = {};
    inverse.n = m.n;
    for (int i = 0; i < m.n; ++i) inverse.at(i, i) = 1;
    double determinant = 1;
    for (int c = 0; c < m.n; ++c)
    {
        int pivot = c;
        for (int r = c + 1; r < m.n; ++r)
            if (std::abs(m.at(r, c)) > std::abs(m.at(pivot, c))) pivot = r;
        if (m.at(pivot, c) == 0) return 0;
        if (pivot != c)
        {
            std::swap(m.a[static_cast<std::size_t>(pivot)], m.a[static_cast<std::size_t>(c)]);
            std::swap(inverse.a[static_cast<std::size_t>(pivot)],
                      inverse.a[static_cast<std::size_t>(c)]);
            determinant = -determinant;
        }
        const double diagonal = m.at(c, c);
        determinant *= diagonal;
        for (int j = 0; j < m.n; ++j)
        {
            m.at(c, j) /= diagonal;
            inverse.at(c, j) /= diagonal;
        }
        for (int r = 0; r < m.n; ++r)
        {
            const double factor = m.at(r, c);
            if (r == c || factor == 0) continue;
            for (int j = 0; j < m.n; ++j)
            {
                m.at(r, j) -= factor * m.at(c, j);
                inverse.at(r, j) -= factor * inverse.at(c, j);
            }
        }
    }
    return determinant;
}

} // namespace fppg
