#include "core/principal_axes.h"

#include <cmath>

namespace fppg
{
namespace
{

/// Turns a symmetric matrix so that its entry (p, q) vanishes (Jacobi); the columns of `vectors`
/// turn with it.
void turn_away(std::array<Vec3, 3>& a, std::array<Vec3, 3>& vectors, int p, int q)
{
    const auto row = [&](int i) -> Vec3& { return a[static_cast<std::size_t>(i)]; };
    const double off = row(p)[q];
    if (off == 0) return;
    const double theta = (row(q)[q] - row(p)[p]) / (2 * off);
    const double t = (theta >= 0 ? 1 : -1) / (std::fabs(theta) + std::sqrt(theta * theta + 1));
    const double c = 1 / std::sqrt(t * t + 1);
    const double s = t * c;
    for (int k = 0; k < 3; ++k)
    {
        const double at_p = row(k)[p];
        const double at_q = row(k)[q];
        row(k)[p] = c * at_p - s * at_q;
        row(k)[q] = s * at_p + c * at_q;
    }
    for (int k = 0; k < 3; ++k)
    {
        const double at_p = row(p)[k];
        const double at_q = row(q)[k];
        row(p)[k] = c * at_p - s * at_q;
        row(q)[k] = s * at_p + c * at_q;
        Vec3& v = vectors[static_cast<std::size_t>(k)];
        const double of_p = v[p];
        const double of_q = v[q];
        v[p] = c * of_p - s * of_q;
        v[q] = s * of_p + c * of_q;
    }
}

} // namespace

PrincipalAxes principal_axes(std::array<Vec3, 3> rows)
{
    std::array<Vec3, 3> vectors{Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}};
    for (int sweep = 0; sweep < 8; ++sweep)
    {
        turn_away(rows, vectors, 0, 1);
        turn_away(rows, vectors, 0, 2);
        turn_away(rows, vectors, 1, 2);
    }
    PrincipalAxes out;
    out.values = {rows[0].x, rows[1].y, rows[2].z};
    for (int i = 0; i < 3; ++i)
        out.axes[static_cast<std::size_t>(i)] = {vectors[0][i], vectors[1][i], vectors[2][i]};
    return out;
}

} // namespace fppg
